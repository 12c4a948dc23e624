//! Schedules against the energy, and against the time since an event.

use std::sync::Arc;

use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::coordinates::Inertial;
use reentry::event::{Condition, Direction, Effect, Event, Quantity, Trigger};
use reentry::propulsion::{Impulse, ThrustAxis};
use reentry::scenario::Fault;
use reentry::trajectory::{FlightPoint, Sampling, Termination};
use reentry::{Atmosphere, Case, Control, FlightPath, Planet, Scenario, Stop, Trajectory};

use crate::check::near;
use crate::core::flights::{fly, glide, miss, spherical, with_tolerance};

fn banked(against: Against, at: &[f64], value: &[f64], interpolation: Interpolation, case: &Case) -> Case {
    let schedule = Schedule::new(against, at, value, interpolation).unwrap();
    let control = Control { bank_angle: Command::Schedule(Arc::new(schedule)), ..case.control.clone() };
    Case { control, ..case.clone() }
}

fn falls(quantity: Quantity, value: f64) -> Condition {
    Condition { quantity, value, direction: Direction::Falling }
}

/// The energy in another form, that of Jacobi: the inertial energy less ω times the angular momentum about the axis.
fn jacobi(planet: &Planet, point: &FlightPoint) -> f64 {
    let Inertial { position, velocity } =
        Inertial::from_planet_fixed(&point.flight_path.to_planet_fixed(), planet, 0.0);
    point.specific_energy - planet.rotation_rate * (position.x * velocity.y - position.y * velocity.x)
}

fn rows(flight: &Trajectory) -> Vec<FlightPoint> {
    flight.points(&flight.instants(&Sampling::Interval(1.0), 100_000).unwrap())
}

/// On a planet that does not turn, the energy is that of conditions: a step in it is the end of one flight and the start of another.
#[test]
fn a_step_in_energy_is_two_flights() {
    let still = Case { planet: Planet { rotation_rate: 0.0, ..glide().planet }, ..glide() };
    let value = -4.5e7;
    let whole =
        fly(&with_tolerance(banked(Against::Energy, &[-1e9, value], &[0.2, 0.9], Interpolation::Step, &still), 1e-12));
    let stop = Stop { when: vec![falls(Quantity::SpecificEnergy, value).into()], ..Stop::default() };
    let leg = |bank: f64, case: Case| fly(&with_tolerance(Case { control: Control::banked(bank), ..case }, 1e-12));
    let first = leg(0.9, Case { stop, ..still.clone() });
    assert_eq!(first.termination(), Termination::Condition(0));
    let second = leg(0.2, Case { initial_state: first.arrival().state, ..still });
    near("time", whole.end_time(), first.end_time() + second.end_time(), 1e-6);
    assert!(miss(&whole, &second) < 1e-4, "{} m", miss(&whole, &second));
}

/// Between its entries a line, outside them their values; the flight goes down through them, and through each once.
#[test]
fn angles_follow_the_energy() {
    let (at, value) = ([-6.2e7, -5.5e7, -4e7], [0.1, 0.9, -0.5]);
    let angle = |energy: f64, interpolation| match interpolation {
        Interpolation::Linear if energy <= at[0] => value[0],
        Interpolation::Linear if energy >= at[2] => value[2],
        Interpolation::Linear if energy < at[1] => value[0] + (energy - at[0]) / 7e6 * 0.8,
        Interpolation::Linear => value[1] + (energy - at[1]) / 1.5e7 * -1.4,
        Interpolation::Step => value[at.iter().filter(|at| **at <= energy).count().max(1) - 1],
    };
    for interpolation in [Interpolation::Linear, Interpolation::Step] {
        for case in [glide(), spherical(glide())] {
            let case = banked(Against::Energy, &at, &value, interpolation, &case);
            let flight = fly(&case);
            let mut seen = Vec::new();
            for point in rows(&flight) {
                let energy = jacobi(&case.planet, &point);
                // Two terms of 1e8 J/kg cancel.
                near("energy", point.energy, energy, 1e-6);
                if at.iter().all(|at| (energy - at).abs() > 0.01) {
                    let what = format!("{interpolation:?} at {energy} J/kg");
                    near(&what, point.bank_angle, angle(energy, interpolation), 1e-12);
                }
                seen.push(at.iter().filter(|at| **at < energy).count());
            }
            seen.dedup();
            assert_eq!(seen, [3, 2, 1, 0], "the flight passes every entry once");
        }
    }
}

/// A step ends where the energy is that of an entry.
#[test]
fn corners_in_energy_are_met() {
    let at = [-6e7, -5e7, -4e7];
    for interpolation in [Interpolation::Linear, Interpolation::Step] {
        let flight = fly(&banked(Against::Energy, &at, &[0.1, 0.9, -0.5], interpolation, &glide()));
        let ends = flight.points(&flight.instants(&Sampling::PerStep(1), 1000).unwrap());
        // The first entry of steps turns nothing.
        for at in at.iter().skip(usize::from(interpolation == Interpolation::Step)) {
            let nearest = ends.iter().map(|point| (point.energy - at).abs()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.01, "{interpolation:?}: no step ends within {nearest} J/kg of {at}");
        }
    }
}

/// In still air the energy never grows, and without air it stays what it is; the inertial energy does not, where the planet turns.
#[test]
fn the_energy_never_grows_in_still_air() {
    let case = banked(Against::Energy, &[-6e7, -5e7], &[1.2, -0.9], Interpolation::Linear, &glide());
    let flight = fly(&case);
    let energies: Vec<_> = rows(&flight).iter().map(|point| point.energy).collect();
    // Up there a second takes less than the noise of the dense output.
    assert!(energies.windows(2).all(|pair| pair[1] < pair[0] + 0.01), "{energies:?}");
    assert!(energies[0] - energies[energies.len() - 1] > 2e7);
    let stop = Stop { time: 3000.0, altitude: -5e5, ..Stop::default() };
    let up = FlightPath { flight_path_angle: 0.3, ..FlightPath::from_planet_fixed(&glide().initial_state) };
    let free = with_tolerance(
        Case { atmosphere: Atmosphere::Vacuum, initial_state: up.to_planet_fixed(), stop, ..glide() },
        1e-12,
    );
    let points = rows(&fly(&free));
    let spread = |of: fn(&FlightPoint) -> f64| {
        let values: Vec<_> = points.iter().map(of).collect();
        values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min)
    };
    // 1e-12 of 6e7 J/kg, a few hundred steps.
    assert!(spread(|point| point.energy) < 1e-2, "{} J/kg", spread(|point| point.energy));
    assert!(spread(|point| point.flight_path.speed) > 100.0);
}

fn mark(when: impl Into<Trigger>) -> Event {
    Event { when: when.into(), then: Effect::default() }
}

fn at_time(value: f64) -> Condition {
    Condition { quantity: Quantity::Time, value, direction: Direction::Rising }
}

fn push() -> Effect {
    let impulse = Some(Impulse { along: ThrustAxis::Normal, speed_change: 30.0 });
    Effect { impulse, ..Effect::default() }
}

const AT: [f64; 3] = [0.0, 130.0, 400.0];
const VALUE: [f64; 3] = [0.9, -0.6, 0.2];

/// What is flown at an instant, whatever the number of its phase.
fn digits(point: &FlightPoint) -> ([u64; 6], [u64; 4]) {
    let path: [f64; 6] = point.flight_path.into();
    let loads = [point.bank_angle, point.loads.load_factor, point.loads.deceleration, point.ground_distance];
    (path.map(f64::to_bits), loads.map(f64::to_bits))
}

/// Since an event of a known time, a schedule is one against the time, later by that; bit for bit.
#[test]
fn time_since_an_event_is_time_from_there() {
    // A number of 2, so that sums are not rounded.
    let start = 64.5;
    for interpolation in [Interpolation::Linear, Interpolation::Step] {
        for case in [glide(), spherical(glide())] {
            for then in [Effect::default(), push()] {
                let case = Case { events: vec![Event { when: at_time(start).into(), then }], ..case.clone() };
                let since = fly(&banked(Against::Since(0), &AT, &VALUE, interpolation, &case));
                let later = AT.map(|at| at + start);
                let timed = fly(&banked(Against::Time, &later, &VALUE, interpolation, &case));
                assert_eq!(since.end_time().to_bits(), timed.end_time().to_bits());
                assert_eq!(digits(&since.last()), digits(&timed.last()));
                for (since, timed) in rows(&since).iter().zip(rows(&timed)) {
                    assert_eq!(digits(since), digits(&timed), "at {} s", timed.time);
                }
            }
        }
    }
}

/// Since a place that the flight passes, and since an event that waits for another; until then the value of the first entry holds.
#[test]
fn time_since_a_place_begins_there() {
    let delay = 20.0;
    let events = vec![mark(Trigger::After { event: 1, delay }), mark(falls(Quantity::Altitude, 80e3))];
    let case = with_tolerance(Case { events, ..glide() }, 1e-12);
    let held = fly(&Case { control: Control::banked(VALUE[0]), ..case.clone() });
    let passed = held.events().find(|event| event.event == 1).unwrap().before.time;
    for (event, start) in [(0, passed + delay), (1, passed)] {
        let since = fly(&banked(Against::Since(event), &AT, &VALUE, Interpolation::Step, &case));
        let timed = fly(&banked(Against::Time, &AT.map(|at| at + start), &VALUE, Interpolation::Step, &case));
        near("time", since.end_time(), timed.end_time(), 1e-6);
        assert!(miss(&since, &timed) < 1e-3, "{} m", miss(&since, &timed));
        near("before", since.at(start - 1.0).bank_angle, VALUE[0], 0.0);
        near("before the step", since.at(start + 129.9).bank_angle, VALUE[0], 0.0);
        near("after the step", since.at(start + 130.1).bank_angle, VALUE[1], 0.0);
        let ends = since.points(&since.instants(&Sampling::PerStep(1), 1000).unwrap());
        for at in &AT[1..] {
            let corner = start + at;
            assert!(ends.iter().any(|point| (point.time - corner).abs() < 1e-6), "no step ends at {corner} s");
        }
    }
}

/// Both angles may run since events, each since its own.
#[test]
fn each_angle_has_its_own_event() {
    let schedule = |event, value: &[f64]| {
        Command::Schedule(Arc::new(
            Schedule::new(Against::Since(event), &[5.0, 25.0], value, Interpolation::Linear).unwrap(),
        ))
    };
    let control = Control { bank_angle: schedule(1, &[0.1, 0.5]), angle_of_attack: schedule(0, &[0.3, 0.7]) };
    let events = vec![mark(at_time(40.0)), mark(at_time(100.0)), mark(falls(Quantity::Speed, 0.0))];
    let flight = fly(&Case { control, events, ..glide() });
    for (time, bank, attack) in [
        (0.0, 0.1, 0.3),
        (40.0, 0.1, 0.3),
        (45.0, 0.1, 0.3),
        (55.0, 0.1, 0.5),
        (65.0, 0.1, 0.7),
        (104.0, 0.1, 0.7),
        (110.0, 0.2, 0.7),
        (130.0, 0.5, 0.7),
    ] {
        let point = flight.at(time);
        near(&format!("bank at {time} s"), point.bank_angle, bank, 1e-12);
        near(&format!("attack at {time} s"), point.angle_of_attack, attack, 1e-12);
    }
    assert_eq!(flight.phases().len(), 1, "an event since which an angle runs does not change the vehicle");
}

/// Where the event never happens, the value of the first entry holds to the end.
#[test]
fn without_its_event_a_schedule_keeps_its_first_value() {
    let case = Case { events: vec![mark(at_time(9e4))], ..glide() };
    let never = fly(&banked(Against::Since(0), &[10.0, 20.0], &[0.4, -1.0], Interpolation::Linear, &case));
    let held = fly(&Case { control: Control::banked(0.4), ..case });
    assert_eq!(never.events().count(), 0);
    assert_eq!(never.last().bank_angle.to_bits(), 0.4_f64.to_bits());
    assert!(miss(&never, &held) < 1e-3, "{} m", miss(&never, &held));
}

/// An event that happens at the start, and one at the end.
#[test]
fn a_schedule_may_begin_with_the_flight_or_end_with_it() {
    let case = |value: f64| {
        let stop = Stop { time: 300.0, ..Stop::default() };
        let case = Case { events: vec![mark(at_time(value))], stop, ..glide() };
        fly(&banked(Against::Since(0), &AT, &VALUE, Interpolation::Step, &case))
    };
    let stop = Stop { time: 300.0, ..Stop::default() };
    let timed = fly(&banked(Against::Time, &AT, &VALUE, Interpolation::Step, &Case { stop, ..glide() }));
    let from_start = case(0.0);
    assert_eq!(from_start.last().flight_path, timed.last().flight_path);
    assert_eq!(from_start.initial().bank_angle.to_bits(), VALUE[0].to_bits());
    let at_end = case(300.0);
    assert_eq!((at_end.events().count(), at_end.termination()), (1, Termination::TimeLimit));
    assert_eq!(at_end.last().bank_angle.to_bits(), VALUE[0].to_bits());
}

/// However late the event is, the flight goes on beyond every corner.
#[test]
fn corners_long_after_the_start_are_passed() {
    let stop = Stop { time: 1e9, ..Stop::default() };
    let orbit = FlightPath {
        radius: 4e7,
        speed: 2.9e3,
        flight_path_angle: 0.0,
        ..FlightPath::from_planet_fixed(&glide().initial_state)
    };
    let late = 3.3e7 + 0.1;
    let case = Case {
        atmosphere: Atmosphere::Vacuum,
        events: vec![mark(at_time(late))],
        initial_state: orbit.to_planet_fixed(),
        stop: Stop { time: late + 10.0, ..stop },
        ..glide()
    };
    let at = [0.1, 0.2, 0.7, 1.3];
    let flight =
        fly(&banked(Against::Since(0), &at, &[0.1, 0.2, 0.3, 0.4], Interpolation::Step, &with_tolerance(case, 1e-6)));
    assert_eq!(flight.last().bank_angle.to_bits(), 0.4_f64.to_bits());
}

#[test]
fn an_event_that_is_not_there_is_refused() {
    let case = banked(
        Against::Since(1),
        &AT,
        &VALUE,
        Interpolation::Step,
        &Case { events: vec![mark(at_time(1.0))], ..glide() },
    );
    let attack = Control { angle_of_attack: case.control.bank_angle.clone(), ..case.control.clone() };
    let error = Scenario::new(Case { control: attack, ..case }).unwrap_err();
    let missing = ["bank_angle", "angle_of_attack"]
        .map(|name| Fault::NoSuchEvent { field: format!("control.{name}.against.since") });
    assert_eq!(error.0, missing);
}
