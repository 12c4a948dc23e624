//! Parts, engines and separations against closed forms, and against other ways to say the same.

use std::sync::atomic::AtomicBool;

use nalgebra::Vector3;
use proptest::prelude::*;
use reentry::event::{Direction, Effect, Event, Quantity, Separation, Throttle, Tilt, Trigger};
use reentry::part::Part;
use reentry::planet::Planet;
use reentry::propulsion::{Impulse, ThrustAxis};
use reentry::scenario::{BodyCase, Case, Scenario, Solver, Stop};
use reentry::simulate::{SimulationError, simulate_with_bodies};
use reentry::steering::Steering;
use reentry::trajectory::{FlightPoint, Termination, Trajectory, Warning};
use reentry::vehicle::{Aerodynamics, Vehicle};
use reentry::{Atmosphere, Control, PlanetFixed};

use super::flights::{config, fly, try_to_fly};
use super::rockets::{
    G0, at, earth, fly_all, ignite, lift_off, load, local_axes, motor, on, pad, rises, shut_down, sounding_rocket,
    stage, steer, still, vehicle_of, weighed, when,
};

/// A planet whose gravity is the same everywhere: 9.80665 m/s² to the millionth.
fn plain() -> Planet {
    let radius = 1e11;
    still(radius, G0 * radius * radius)
}

/// Held in vacuum on the plain.
fn on_plain(parts: Vec<Part>) -> Case {
    Case { atmosphere: Atmosphere::Vacuum, initial_state: pad(&plain(), 0.0, 0.0), ..vehicle_of(plain(), parts) }
}

fn separate(parts: &[usize], body: usize) -> Effect {
    Effect { separate: vec![Separation { parts: parts.to_vec(), push: None, body }], ..Effect::default() }
}

fn throttle(part: usize, value: f64) -> Effect {
    Effect { throttle: vec![Throttle { part, value }], ..Effect::default() }
}

/// The case of a body of some parts of another.
fn body_of(case: &Case, parts: &[usize]) -> BodyCase {
    let parts = parts.iter().map(|part| case.parts[*part].clone()).collect();
    let (events, bodies, stop) = (Vec::new(), Vec::new(), Stop::default());
    BodyCase { case: weighed(Case { parts, events, bodies, stop, hold_down: false, ..case.clone() }), stop_time: None }
}

fn place(point: &FlightPoint) -> PlanetFixed<f64> {
    point.flight_path.to_planet_fixed()
}

/// That two flights are at one place with one velocity at a time, and as heavy, to a part of the planet's radius, of the speed and of the mass.
#[track_caller]
fn same(a: &FlightPoint, b: &FlightPoint, part: f64) {
    let [a_state, b_state] = [place(a), place(b)];
    assert!((a.time - b.time).abs() <= part * a.time.max(1.0), "{} {}", a.time, b.time);
    let radius = a_state.position.norm();
    assert!((a_state.position - b_state.position).norm() <= part * radius, "{a_state:?} {b_state:?}");
    let speed = a_state.velocity.norm().max(1.0);
    // A velocity that is a difference of places.
    assert!((a_state.velocity - b_state.velocity).norm() <= 10.0 * part * speed, "{a_state:?} {b_state:?}");
    assert!((a.mass - b.mass).abs() <= part * a.mass, "{} {}", a.mass, b.mass);
}

fn time_of(flight: &Trajectory, event: usize) -> Option<f64> {
    flight.events().find(|point| point.event == event).map(|point| point.before.time)
}

#[test]
fn a_vertical_ascent_loses_what_gravity_takes() {
    let events = vec![at(0.0, ignite(&[0])), lift_off()];
    let stop = Stop { when: vec![Trigger::AfterBurnout { part: 0, delay: 0.0 }], ..Stop::default() };
    let end = fly(&Case { events, stop, ..on_plain(vec![sounding_rocket()]) }).last();
    // c ln(m₀/m₁) - g t_b
    assert!((end.time - 78.4532).abs() < 1e-9, "{}", end.time);
    assert!((end.loads.speed - 3_965.595_217).abs() < 1e-3, "{}", end.loads.speed);
    assert!((end.mass - 200.0).abs() < 1e-9);
}

/// A stage under a carrier with a capsule, and a payload on top; the carrier leaves with the capsule, which leaves it in turn.
fn nested(push: Option<Impulse>) -> Case {
    let parts = vec![stage(500.0, 3000.0, 90e3, 290.0, 0.1), load(300.0), load(60.0), load(150.0)];
    let case = Case { stop: Stop { time: 200.0, ..Stop::default() }, ..vehicle_of(earth(), parts) };
    let mut carrier = body_of(&case, &[1, 2]);
    let mut capsule = body_of(&carrier.case, &[1]);
    capsule.case.vehicle.reference_area = 0.3;
    carrier.case.vehicle.reference_area = 2.0;
    let out = Separation { parts: vec![1], push, body: 0 };
    carrier.case.events = vec![on(
        when(Quantity::FlightPathAngle, 0.0, Direction::Falling),
        Effect { separate: vec![out], ..Effect::default() },
    )];
    carrier.case.bodies = vec![capsule];
    let stage = body_of(&case, &[0]);
    let off = Separation { parts: vec![1, 2], push, body: 0 };
    let turn = Effect { tilt: Some(Tilt { angle: 0.05, azimuth: 1.2 }), ..steer(Steering::Velocity) };
    let events = vec![
        at(0.0, ignite(&[0])),
        lift_off(),
        on(rises(Quantity::Speed, 40.0), turn),
        at(60.0, Effect { separate: vec![off], ..Effect::default() }),
        on(Trigger::AfterBurnout { part: 0, delay: 2.0 }, separate(&[0], 1)),
    ];
    Case { events, bodies: vec![carrier, stage], ..case }
}

#[test]
fn a_body_flies_as_it_would_by_itself() {
    let push = Some(Impulse { along: ThrustAxis::Normal, speed_change: 3.0 });
    for push in [None, push] {
        let case = nested(push);
        let flights = fly_all(&case);
        let parents: Vec<_> = flights.bodies.iter().map(|body| (body.parent, body.event, body.separation)).collect();
        assert_eq!(parents, [(None, 3, 0), (None, 4, 0), (Some(0), 0, 0)]);
        assert!(flights.bodies.is_sorted_by(|a, b| a.time <= b.time));
        let cases = [&case.bodies[0], &case.bodies[1], &case.bodies[0].case.bodies[0]];
        for (body, BodyCase { case: of_body, .. }) in flights.bodies.iter().zip(cases) {
            let flight = &body.trajectory;
            let parent = body.parent.map_or(&flights.vehicle, |parent| &flights.bodies[parent].trajectory);
            let separation = parent.events().find(|event| event.event == body.event).unwrap();
            assert!((body.time - separation.before.time).abs() < 1e-12);
            assert!((flight.initial().time - body.time).abs() < 1e-12);
            assert_eq!(flight.termination(), Termination::SurfaceImpact);
            // From where its parent was, as fast but for the push, with an own clock that begins then.
            let from = place(&separation.before);
            let off = place(&flight.initial());
            assert!((off.position - from.position).norm() < 1e-6);
            let pushed = off.velocity - from.velocity;
            let expected = match push.filter(|_| (body.parent, body.event) != (None, 4)) {
                None => Vector3::zeros(),
                Some(_) => from.position.cross(&from.velocity).normalize() * 3.0,
            };
            assert!((pushed - expected).norm() < 1e-6, "{pushed} {expected}");
            let parts = of_body.parts.iter().enumerate().map(|(place, part)| Part {
                propellant: flight.propellant(&flight.initial(), place).unwrap() / f64::from(part.count),
                ..part.clone()
            });
            let alone = weighed(Case {
                parts: parts.collect(),
                start_time: body.time,
                initial_state: off,
                origin: Some(case.initial_state),
                stop: Stop { time: body.time + BodyCase::TIME, ..of_body.stop.clone() },
                ..of_body.clone()
            });
            let alone = fly(&alone);
            // The state comes back from angles to a few units in the last place.
            same(&alone.last(), &flight.last(), 1e-9);
            same(&alone.at(body.time + 30.0), &flight.at(body.time + 30.0), 1e-9);
            assert!((alone.last().ground_range - flight.last().ground_range).abs() < 1e-2);
        }
        mass_is_kept(&case);
    }
}

/// Vehicle, bodies and what was burnt are the mass of the start, on both sides of every event.
fn mass_is_kept(case: &Case) {
    let flights = fly_all(case);
    let mut steps: Vec<(f64, f64)> = Vec::new();
    for flight in std::iter::once(&flights.vehicle).chain(flights.bodies.iter().map(|body| &body.trajectory)) {
        for event in flight.events() {
            let left: f64 = flights
                .bodies
                .iter()
                .filter(|body| body.event == event.event && (body.time - event.before.time).abs() < 1e-12)
                .map(|body| body.trajectory.initial().mass)
                .sum();
            let change = event.before.mass - event.after.mass;
            steps.push((change, left));
        }
    }
    for (change, left) in steps {
        assert!((change - left).abs() < 1e-9 * case.vehicle.mass, "{change} {left}");
    }
    let of_last = |flight: &Trajectory| flight.last().mass;
    let all = of_last(&flights.vehicle) + flights.bodies.iter().map(|body| of_last(&body.trajectory)).sum::<f64>();
    let dry: f64 = case.parts.iter().map(|part| f64::from(part.count) * part.dry_mass).sum();
    assert!((all - dry).abs() < 1e-9 * case.vehicle.mass, "{all} {dry}");
}

#[test]
fn bodies_leave_in_any_direction() {
    let case = nested(None);
    let direction = ThrustAxis::inertial([1.0, -2.0, 0.5]).unwrap();
    let axes = [ThrustAxis::Velocity, ThrustAxis::Radial, ThrustAxis::Normal, ThrustAxis::Horizontal, direction];
    for along in axes {
        let mut case = case.clone();
        case.events[3].then.separate[0].push = Some(Impulse { along, speed_change: -2.5 });
        let flights = fly_all(&case);
        let event = flights.vehicle.events().find(|event| event.event == 3).unwrap();
        let [before, after, body] = [&event.before, &event.after, &flights.bodies[0].trajectory.initial()].map(place);
        // Nothing pushes back.
        assert_eq!(before, after);
        let [up, ahead] = [before.position.normalize(), before.velocity.normalize()];
        let level = up.cross(&ahead).normalize();
        let turn =
            nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), -case.planet.rotation_rate * event.before.time);
        let expected = match along {
            ThrustAxis::Velocity => ahead,
            ThrustAxis::Radial => up,
            ThrustAxis::Normal => level,
            ThrustAxis::Horizontal => level.cross(&up),
            ThrustAxis::Inertial(direction) => turn * direction.into_inner(),
        };
        let push = body.velocity - before.velocity;
        assert!((push + expected * 2.5).norm() < 1e-6, "{along:?}: {push}");
    }
}

#[test]
fn all_bodies_share_a_limit_of_steps() {
    let case = nested(None);
    let flights = fly_all(&case);
    let taken = |flight: &Trajectory| flight.statistics().steps + flight.statistics().rejected_steps;
    let bodies: Vec<_> = flights.bodies.iter().map(|body| taken(&body.trajectory)).collect();
    let all = taken(&flights.vehicle) + bodies.iter().sum::<usize>();
    let limited = |step_limit: usize| {
        let solver = Solver { step_limit, ..case.solver };
        simulate_with_bodies(&Scenario::new(Case { solver, ..case.clone() }).unwrap(), &AtomicBool::new(false))
    };
    assert!(limited(all).is_ok());
    for (limit, path) in [
        (all - 1, vec![(3, 0), (0, 0)]),
        (all - bodies[2] - 1, vec![(4, 0)]),
        (all - bodies[2] - bodies[1] - 1, vec![(3, 0)]),
        (taken(&flights.vehicle) - 1, vec![]),
    ] {
        let error = limited(limit).unwrap_err();
        assert_eq!(error.body, path);
        assert!(matches!(error.error, SimulationError::StepLimit { limit: told, .. } if told == limit), "{error}");
    }
}

#[test]
fn a_body_whose_time_is_over_ends_where_it_begins() {
    let mut case = nested(None);
    case.bodies[0].stop_time = Some(10.0);
    let body = &fly_all(&case).bodies[0];
    assert_eq!((body.trajectory.termination(), body.trajectory.end_time()), (Termination::TimeLimit, 60.0));
}

/// A rise of 60 s in air, held at first, of one stage or of what does the same.
fn rise(parts: Vec<Part>, events: Vec<Event>) -> Trajectory {
    let turn = Effect { tilt: Some(Tilt { angle: 0.05, azimuth: 1.2 }), ..steer(Steering::Velocity) };
    let events = events.into_iter().chain([lift_off(), on(rises(Quantity::Speed, 40.0), turn)]).collect();
    fly(&Case { events, stop: Stop { time: 60.0, ..Stop::default() }, ..vehicle_of(earth(), parts) })
}

#[test]
fn two_engines_of_half_the_thrust_fly_as_one() {
    let whole = || stage(600.0, 2400.0, 90e3, 290.0, 0.1);
    let half = || stage(300.0, 1200.0, 45e3, 290.0, 0.05);
    let one = rise(vec![whole(), load(100.0)], vec![at(0.0, ignite(&[0]))]);
    let two = rise(vec![half(), half(), load(100.0)], vec![at(0.0, ignite(&[0, 1]))]);
    let pair = rise(vec![Part { count: 2, ..half() }, load(100.0)], vec![at(0.0, ignite(&[0]))]);
    // Burnt out before the end, since 2400 kg last 75 s, of which a throttle of a half in all would leave some.
    same(&one.last(), &two.last(), 1e-9);
    same(&one.last(), &pair.last(), 1e-12);
    // At once, a moment apart, and in one event.
    let relit = rise(
        vec![whole(), load(100.0)],
        vec![at(0.0, ignite(&[0])), at(20.0, shut_down(&[0])), at(20.0, ignite(&[0]))],
    );
    let both = Effect { shut_down: vec![0], ..ignite(&[0]) };
    let in_one = rise(vec![whole(), load(100.0)], vec![at(0.0, ignite(&[0])), at(20.0, both)]);
    for relit in [relit, in_one] {
        same(&one.last(), &relit.last(), 1e-9);
        assert!(relit.warnings().is_empty(), "{:?}", relit.warnings());
    }
    // Half the throttle for twice the thrust; the pressure acts on the whole of the exit.
    let strong = stage(600.0, 2400.0, 180e3, 290.0, 0.1);
    let throttled = rise(vec![strong, load(100.0)], vec![at(0.0, Effect { ignite: vec![0], ..throttle(0, 0.5) })]);
    same(&one.last(), &throttled.last(), 1e-9);
    assert!((throttled.at(30.0).throttle - 0.5).abs() < 1e-12);
    // A table of one value is a constant thrust.
    let by_time = motor(600.0, 2400.0, &[(0.0, 90e3), (30.0, 90e3), (200.0, 90e3)], 290.0, 0.1);
    same(&one.last(), &rise(vec![by_time, load(100.0)], vec![at(0.0, ignite(&[0]))]).last(), 1e-9);
}

/// Standing still with engines that burn, so that masses alone tell what burns.
fn standing(parts: Vec<Part>, events: Vec<Event>, time: f64) -> Trajectory {
    let parts = parts.into_iter().chain([load(1e6)]).collect();
    fly(&Case { events, stop: Stop { time, ..Stop::default() }, ..on_plain(parts) })
}

#[test]
fn an_engine_by_time_begins_anew_when_it_is_lit_again() {
    let profile = [(0.0, 0.0), (10.0, 20e3), (20.0, 30e3), (30.0, 10e3)];
    let part = || motor(100.0, 1000.0, &profile, 200.0, 0.0);
    let exhaust = 200.0 * G0;
    let events = vec![
        at(1.0, ignite(&[0])),
        at(16.0, shut_down(&[0])),
        at(20.0, ignite(&[0])),
        on(Trigger::AfterBurnout { part: 0, delay: 2.5 }, Effect::default()),
    ];
    let flight = standing(vec![part()], events, 60.0);
    assert!(matches!(flight.warnings(), [Warning::NeverLifted { .. }]), "{:?}", flight.warnings());
    assert_eq!(time_of(&flight, 3), Some(52.5));
    // 15 s: 100 kN s and 5 s at 22.5 kN in the mean; then all of it.
    let burnt = [100e3 + 112.5e3, 100e3 + 250e3 + 200e3].map(|impulse| impulse / exhaust);
    for (time, burnt) in [(1.0, 0.0), (6.0, 25e3 / exhaust), (18.0, burnt[0]), (60.0, burnt[0] + burnt[1])] {
        let left = flight.propellant(&flight.at(time), 0).unwrap();
        assert!((left - (1000.0 - burnt)).abs() < 1e-9, "{time}: {left}");
        assert!((flight.at(time).mass - (1e6 + 100.0 + left)).abs() < 1e-6);
    }
    assert!((flight.at(26.0).thrust - 12e3).abs() < 1e-6, "{}", flight.at(26.0).thrust);
    assert!((flight.at(26.0).throttle - 1.0).abs() < 1e-12 && flight.at(55.0).throttle == 0.0);
    // Less propellant than the profile burns: it is spent at 212.5 kN s.
    let spent = motor(100.0, 212.5e3 / exhaust, &profile, 200.0, 0.0);
    let events = vec![at(1.0, ignite(&[0])), on(Trigger::AfterBurnout { part: 0, delay: 0.0 }, Effect::default())];
    let flight = standing(vec![spent], events, 60.0);
    let [end] = [time_of(&flight, 1).unwrap()];
    assert!((end - 16.0).abs() < 1e-9, "{end}");
    assert!((flight.last().mass - 1e6 - 100.0).abs() < 1e-9);
}

#[test]
fn a_burnout_counts_once() {
    // Lit again after its propellant is spent, it burns out at once, once more, and what waited for the first does not happen again.
    let part = stage(100.0, 500.0, 50e3, 250.0, 0.0);
    let burn_time = 500.0 * 250.0 * G0 / 50e3;
    let events = vec![
        at(0.0, ignite(&[0])),
        on(Trigger::AfterBurnout { part: 0, delay: 1.0 }, Effect::default()),
        at(40.0, ignite(&[0])),
        at(50.0, shut_down(&[0])),
        on(Trigger::AfterBurnout { part: 0, delay: 30.0 }, Effect::default()),
    ];
    let flight = standing(vec![part], events, 80.0);
    let happened: Vec<_> = flight.events().map(|event| event.event).collect();
    assert_eq!(happened, [0, 1, 2, 3, 4]);
    assert!((time_of(&flight, 1).unwrap() - burn_time - 1.0).abs() < 1e-9);
    assert!((time_of(&flight, 4).unwrap() - burn_time - 30.0).abs() < 1e-9);
    assert!((flight.last().mass - 1e6 - 100.0).abs() < 1e-9);
}

#[test]
fn throttles_scale_what_is_burnt_and_not_what_the_air_takes() {
    let part = stage(100.0, 1e4, 100e3, 250.0, 0.2);
    let events = vec![at(0.0, ignite(&[0])), at(10.0, throttle(0, 0.0)), at(20.0, throttle(0, 0.3))];
    let case = vehicle_of(earth(), vec![part, load(1e6)]);
    let flight = fly(&Case { events, stop: Stop { time: 30.0, ..Stop::default() }, ..case });
    let flow = 100e3 / (250.0 * G0);
    for (time, throttle, burnt) in [(5.0, 1.0, 5.0), (15.0, 0.0, 10.0), (25.0, 0.3, 11.5)] {
        let point = flight.at(time);
        assert!((point.throttle - throttle).abs() < 1e-12);
        let thrust = throttle * 100e3 - 0.2 * point.pressure.unwrap();
        assert!((point.thrust - thrust.abs()).abs() < 1e-6, "{time}: {} {thrust}", point.thrust);
        let left = flight.propellant(&point, 0).unwrap();
        assert!((left - (1e4 - burnt * flow)).abs() < 1e-9, "{time}: {left}");
    }
    // Of two engines by time the throttle is the share of the thrusts of the moment.
    let [rising, falling] = [[(0.0, 0.0), (40.0, 40e3)], [(0.0, 40e3), (40.0, 0.0)]];
    let parts = vec![motor(10.0, 1e3, &rising, 250.0, 0.0), motor(10.0, 1e3, &falling, 250.0, 0.0)];
    let events = vec![at(0.0, Effect { ignite: vec![0, 1], ..throttle(0, 0.5) })];
    let flight = standing(parts, events, 50.0);
    for time in [1.0, 10.0, 30.0] {
        let share = (0.5 * time + 40.0 - time) / 40.0;
        assert!((flight.at(time).throttle - share).abs() < 1e-9, "{time}: {}", flight.at(time).throttle);
    }
}

#[test]
fn a_load_limit_does_not_know_the_shares_of_several_engines_by_time() {
    let profile = [(0.0, 60e3), (20.0, 70e3), (30.0, 0.0)];
    let parts = vec![stage(100.0, 2000.0, 40e3, 250.0, 0.0), motor(100.0, 1000.0, &profile, 250.0, 0.0)];
    let limit = Effect { load_limit: Some(Some(3.0)), ..Effect::default() };
    let events = vec![at(0.0, ignite(&[0, 1])), lift_off(), at(5.0, limit)];
    let case = Case { events, ..on_plain(parts) };
    let error = try_to_fly(&case).unwrap_err();
    assert!(matches!(error, SimulationError::UnknownShares { time } if (time - 5.0).abs() < 1e-12), "{error}");
}

#[test]
fn a_load_limit_throttles_an_engine_whose_thrust_rises_from_nothing() {
    let profile = [(0.0, 0.0), (10.0, 40e3), (20.0, 0.0)];
    let parts = vec![motor(400.0, 1000.0, &profile, 250.0, 0.0), load(100.0)];
    let events = vec![at(0.0, Effect { load_limit: Some(Some(2.0)), ..ignite(&[0]) }), lift_off()];
    let flight = fly(&Case { events, stop: Stop { time: 30.0, ..Stop::default() }, ..on_plain(parts) });
    let last = flight.last();
    let left = flight.propellant(&last, 0).unwrap();
    assert!((last.mass - 500.0 - left).abs() < 1e-9, "{} {left}", last.mass);
    // 400 kN s less what the limit took.
    assert!(last.mass < 1490.0 && left > 1000.0 - 400e3 / (250.0 * G0) + 1.0, "{} {left}", last.mass);
    assert!(flight.peaks().load_factor.value < 2.0 + 1e-9);
}

#[test]
fn engines_under_a_load_limit_burn_out_one_after_the_other() {
    let parts = vec![stage(100.0, 300.0, 40e3, 250.0, 0.0), stage(100.0, 700.0, 30e3, 300.0, 0.0), load(200.0)];
    let events = vec![
        at(0.0, Effect { load_limit: Some(Some(2.5)), ..ignite(&[0, 1]) }),
        lift_off(),
        on(Trigger::AfterBurnout { part: 0, delay: 0.0 }, Effect::default()),
        on(Trigger::AfterBurnout { part: 1, delay: 0.0 }, Effect::default()),
    ];
    let flight = fly(&Case { events, stop: Stop { time: 200.0, ..Stop::default() }, ..on_plain(parts) });
    let burnouts: Vec<_> = flight.events().filter(|event| event.event > 1).collect();
    assert_eq!(burnouts.len(), 2);
    // The first has burnt its 300 kg while the other burnt in proportion of the flows.
    let burnt = 300.0 * (30e3 / 300.0) / (40e3 / 250.0);
    assert!((burnouts[0].before.mass - (1400.0 - 300.0 - burnt)).abs() < 1e-6, "{}", burnouts[0].before.mass);
    assert!((burnouts[1].before.mass - 400.0).abs() < 1e-6);
    assert!((flight.last().mass - 400.0).abs() < 1e-9);
    // A mass in vacuum under a constant load burns as m₀ exp(-n t/I), from where the limit acts on.
    let limited = flight.peaks().load_factor.value;
    assert!((limited - 2.5).abs() < 1e-9, "{limited}");
}

#[test]
fn what_cannot_be_lit_is_warned_of() {
    let parts = vec![sounding_rocket(), sounding_rocket(), load(1000.0)];
    let case = Case { stop: Stop { time: 30.0, ..Stop::default() }, ..on_plain(parts) };
    let bodies = vec![body_of(&case, &[1])];
    let with = |events: Vec<Event>| fly(&Case { events, bodies: bodies.clone(), ..case.clone() });
    let unlit = |flight: &Trajectory| -> Vec<_> {
        let of = |warning: &Warning| match *warning {
            Warning::NotLit { event, part, is_there, time } => Some((event, part, is_there, time)),
            _ => None,
        };
        flight.warnings().iter().filter_map(of).collect()
    };
    let lit = with(vec![at(0.0, ignite(&[0])), at(1.0, ignite(&[0])), at(2.0, shut_down(&[0]))]);
    assert_eq!(unlit(&lit), [(1, 0, true, 1.0)]);
    let gone = with(vec![at(1.0, separate(&[1], 0)), at(2.0, ignite(&[1]))]);
    assert_eq!(unlit(&gone), [(1, 1, false, 2.0)]);
    let going = with(vec![at(1.0, Effect { ignite: vec![1], ..separate(&[1], 0) })]);
    assert_eq!(unlit(&going), [(0, 1, false, 1.0)]);
    let again = with(vec![at(0.0, ignite(&[0])), at(1.0, Effect { shut_down: vec![0], ..ignite(&[0]) })]);
    assert_eq!(unlit(&again), []);
}

#[test]
fn what_cannot_lift_stays_where_it_is() {
    let heavy = vec![sounding_rocket(), load(1e4)];
    let case = Case { stop: Stop { time: 100.0, ..Stop::default() }, ..vehicle_of(earth(), heavy) };
    let flight = fly(&Case { events: vec![at(0.0, ignite(&[0])), lift_off()], ..case.clone() });
    assert_eq!((flight.termination(), flight.end_time()), (Termination::TimeLimit, 100.0));
    assert!(flight.warnings().contains(&Warning::NeverLifted { time: 100.0 }), "{:?}", flight.warnings());
    assert!((place(&flight.last()).position - case.initial_state.position).norm() < 1e-8);
    // What nothing holds and nothing lifts is on the ground.
    for events in [vec![], vec![at(0.0, ignite(&[0]))]] {
        let flight = fly(&Case { hold_down: false, events, ..case.clone() });
        assert_eq!((flight.termination(), flight.end_time()), (Termination::SurfaceImpact, 0.0));
    }
    // So is what is set free without thrust.
    let free = Effect { lift_off: true, ..Effect::default() };
    let flight = fly(&Case { events: vec![at(3.0, free)], ..case.clone() });
    assert_eq!((flight.termination(), flight.end_time()), (Termination::SurfaceImpact, 3.0));
    // And what is held takes no push.
    let push = Effect { impulse: Some(Impulse { along: ThrustAxis::Radial, speed_change: 10.0 }), ..Effect::default() };
    let flight = fly(&Case { events: vec![at(3.0, push)], ..case.clone() });
    assert!((place(&flight.last()).position - case.initial_state.position).norm() < 1e-8);
}

#[test]
fn a_vehicle_that_burns_all_of_itself_has_an_end_with_a_name() {
    let parts = vec![stage(0.0, 800.0, 30e3, 300.0, 0.0)];
    let events = vec![at(0.0, ignite(&[0])), lift_off()];
    for atmosphere in [Atmosphere::Vacuum, Atmosphere::Us76] {
        let error = try_to_fly(&Case { events: events.clone(), atmosphere, ..vehicle_of(earth(), parts.clone()) });
        assert!(matches!(error, Err(SimulationError::NothingLeft { .. })), "{:?}", error.map(|it| it.end_time()));
    }
    // A body that has nothing left.
    let parts = vec![stage(0.0, 100.0, 30e3, 300.0, 0.0), load(500.0)];
    let case = vehicle_of(earth(), parts);
    let bodies = vec![body_of(&case, &[0])];
    let drop = on(Trigger::AfterBurnout { part: 0, delay: 1.0 }, separate(&[0], 0));
    let case = Case { events: vec![at(0.0, ignite(&[0])), lift_off(), drop], bodies, ..case };
    let error = simulate_with_bodies(&Scenario::new(case).unwrap(), &AtomicBool::new(false)).unwrap_err();
    assert_eq!(error.body, [(2, 0)]);
    assert!(matches!(error.error, SimulationError::NothingLeft { .. }), "{error}");
}

/// What an event of a random case does.
fn random_effect() -> impl Strategy<Value = Effect> {
    let part = 0_usize..3;
    let steering = prop_oneof![
        Just(Steering::Vertical),
        Just(Steering::Velocity),
        (-2.0..2.0, -0.1..0.1).prop_map(|(a, b)| Steering::LinearTangent {
            axes: nalgebra::Rotation3::identity(),
            a,
            b
        })
    ];
    prop_oneof![
        4 => part.clone().prop_map(|part| ignite(&[part])),
        1 => Just(ignite(&[0, 1, 2])),
        2 => part.clone().prop_map(|part| shut_down(&[part])),
        2 => (part.clone(), 0.0..1.0).prop_map(|(part, value)| throttle(part, value)),
        1 => part.prop_map(|part| throttle(part, 0.0)),
        2 => (0.1..8.0).prop_map(|limit| Effect { load_limit: Some(Some(limit)), ..Effect::default() }),
        1 => Just(Effect { load_limit: Some(None), ..Effect::default() }),
        2 => steering.prop_map(steer),
        1 => (-1.0..1.0, -3.0..3.0)
            .prop_map(|(angle, azimuth)| Effect { tilt: Some(Tilt { angle, azimuth }), ..Effect::default() }),
        1 => Just(Effect { lift_off: true, ..Effect::default() }),
        2 => (0_usize..4).prop_map(|part| separate(&[part], 0)),
    ]
}

fn random_part() -> impl Strategy<Value = Part> {
    let profile = prop::collection::vec((0.01..30.0, prop_oneof![Just(0.0), 0.0..150e3]), 2..6).prop_map(|pieces| {
        let mut time = 0.0;
        let mut entries: Vec<(f64, f64)> = Vec::new();
        for (length, thrust) in pieces {
            entries.push((time, thrust));
            time += length;
        }
        entries
    });
    let mass = || prop_oneof![Just(0.0), 1.0..2000.0];
    let engine = (prop_oneof![Just(0.0), 0.0..0.5], 150.0..450.0);
    (1_u32..4, mass(), mass(), prop_oneof![Just(None), profile.prop_map(Some)], 0.0..150e3, engine).prop_map(
        |(count, dry_mass, propellant, profile, thrust, (area, impulse))| {
            let part = match profile {
                None => stage(dry_mass, propellant, thrust, impulse, area),
                Some(profile) => motor(dry_mass, propellant, &profile, impulse, area),
            };
            Part { count, ..part }
        },
    )
}

fn random_trigger(events: usize) -> impl Strategy<Value = Trigger> {
    prop_oneof![
        3 => (0.0..100.0).prop_map(|time| rises(Quantity::Time, time)),
        1 => Just(rises(Quantity::Time, 0.0)),
        1 => (0.0..500.0).prop_map(|speed| rises(Quantity::Speed, speed)),
        1 => (0.0..50e3).prop_map(|altitude| rises(Quantity::Altitude, altitude)),
        1 => (0.1..5.0).prop_map(|load| rises(Quantity::LoadFactor, load)),
        1 => (0.0..4000.0).prop_map(|mass| when(Quantity::Mass, mass, Direction::Falling)),
        2 => ((0_usize..3), prop_oneof![Just(0.0), 0.0..20.0])
            .prop_map(|(part, delay)| Trigger::AfterBurnout { part, delay }),
        1 => (0..events, prop_oneof![Just(0.0), 0.0..20.0]).prop_map(|(event, delay)| Trigger::After { event, delay }),
    ]
}

fn random_case() -> impl Strategy<Value = Case> {
    let parts = prop::collection::vec(random_part(), 3..4);
    let events = prop::collection::vec((random_trigger(6), random_effect()), 1..7);
    (parts, events, any::<bool>(), any::<bool>(), 0.0..1e3, prop_oneof![Just(0.0), 0.0..3.0]).prop_map(
        |(mut parts, events, hold_down, in_air, altitude, lift_coefficient)| {
            parts.push(load(200.0));
            let case = vehicle_of(earth(), parts);
            let events: Vec<_> = [at(0.0, ignite(&[0])), lift_off()]
                .into_iter()
                .chain(events.into_iter().map(|(when, then)| on(when, then)))
                .collect();
            let body = |part: usize| body_of(&case, &[part]);
            let mut bodies = Vec::new();
            let events = events
                .into_iter()
                .map(|mut event| {
                    for separation in &mut event.then.separate {
                        bodies.push(body(separation.parts[0]));
                        separation.body = bodies.len() - 1;
                    }
                    event
                })
                .collect();
            let mut initial_state = case.initial_state;
            if in_air {
                let [north, _, up] = local_axes(&initial_state.position);
                initial_state.position += up * altitude;
                initial_state.velocity = up * 100.0 + north * altitude;
            }
            let aerodynamics = Aerodynamics::Constant { lift_coefficient, drag_coefficient: 0.5 };
            let vehicle = Vehicle { aerodynamics, ..case.vehicle.clone() };
            let hold_down = hold_down && !in_air;
            let stop = Stop { time: 300.0, ..Stop::default() };
            let solver = Solver { step_limit: 20_000, relative_tolerance: 1e-8, ..case.solver };
            Case {
                events,
                bodies,
                vehicle,
                initial_state,
                hold_down,
                stop,
                solver,
                control: Control::banked(0.3),
                ..case
            }
        },
    )
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn random_vehicles_of_parts_fly_or_say_why_not(case in random_case()) {
        let Ok(scenario) = Scenario::new(case.clone()) else { return Ok(()) };
        let flights = match simulate_with_bodies(&scenario, &AtomicBool::new(false)) {
            Ok(flights) => flights,
            Err(error) => {
                let named = matches!(
                    error.error,
                    SimulationError::NothingLeft { .. } | SimulationError::UnknownShares { .. }
                );
                prop_assert!(named, "{error}: {case:?}");
                return Ok(());
            }
        };
        let of_bodies = flights.bodies.iter().map(|body| {
            let parts = &case.bodies[case.events[body.event].then.separate[body.separation].body].case.parts;
            (&body.trajectory, parts)
        });
        for (flight, parts) in std::iter::once((&flights.vehicle, &case.parts)).chain(of_bodies) {
            let [start, end] = [flight.initial().time, flight.end_time()];
            let times: Vec<_> = (0..=20).map(|step| start + (end - start) * f64::from(step) / 20.0).collect();
            for point in flight.points(&times) {
                prop_assert!(point.is_finite() && point.mass > 0.0 && point.thrust >= 0.0, "{point:?}: {case:?}");
                let parts = mass_of(parts, flight, &point);
                // The mass of the parts is that of the vehicle.
                prop_assert!((parts - point.mass).abs() <= 1e-6 * point.mass, "{parts} {}: {case:?}", point.mass);
                prop_assert!((0.0..=1.0 + 1e-9).contains(&point.throttle), "{}: {case:?}", point.throttle);
            }
            // An event happens at most once.
            let mut happened: Vec<_> = flight.events().map(|event| event.event).collect();
            happened.sort_unstable();
            prop_assert!(happened.windows(2).all(|pair| pair[0] < pair[1]), "{happened:?}: {case:?}");
        }
    }
}

/// The mass of those of some parts that a flight has at a point.
fn mass_of(parts: &[Part], flight: &Trajectory, point: &FlightPoint) -> f64 {
    let of_part = |(place, part): (usize, &Part)| {
        flight.propellant(point, place).map_or(0.0, |left| f64::from(part.count) * part.dry_mass + left)
    };
    parts.iter().enumerate().map(of_part).sum()
}
