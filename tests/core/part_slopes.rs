//! The slopes of ascents by the numbers of parts, engines and steering, beside the differences of whole flights in which these are moved.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use nalgebra::Rotation3;
use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::event::{Effect, Quantity, Separation, Throttle, Tilt, Trigger};
use reentry::part::{Part, ThrustEntry, ThrustProfile};
use reentry::scenario::{BodyCase, Case, Stop};
use reentry::sensitivity::{Moment, Moved, Output, Variation, slopes};
use reentry::steering::{Program, ProgramAxes, Steering};
use reentry::trajectory::{FlightPoint, Trajectory};
use reentry::vehicle::{Aerodynamics, AlphaMachTable};

use super::flights::{fly, with_tolerance};
use super::rockets::{
    at, earth, engine, ignite, launch_axes, lift_off, load, motor, on, rises, shut_down, stage, steer, vehicle_of,
    weighed,
};

/// A number of a case: its name, the size in which it is moved, and how.
struct Number(&'static str, f64, Box<Move>);

/// Moves a number of a case by an offset.
type Move = dyn Fn(&mut Case, f64);

fn number(name: &'static str, size: f64, moved: impl Fn(&mut Case, f64) + 'static) -> Number {
    Number(name, size, Box::new(moved))
}

impl Number {
    fn case(&self, case: &Case, offset: f64) -> Case {
        let mut case = case.clone();
        (self.2)(&mut case, offset);
        weighed(case)
    }
}

type Value = fn(&FlightPoint) -> f64;

/// What is looked at: the end, a time late in the flight, and both sides of every event, as many as there are.
fn outputs(events: usize) -> Vec<(&'static str, Moment, Value)> {
    let of_end: [(&str, Value); 6] = [
        ("time", |point| point.time),
        ("altitude", |point| point.loads.altitude),
        ("speed", |point| point.loads.speed),
        ("flight-path angle", |point| point.flight_path.flight_path_angle),
        ("longitude", |point| point.flight_path.longitude),
        ("mass", |point| point.mass),
    ];
    let of_event = [of_end[0], of_end[1], of_end[2], of_end[5]];
    let mut outputs: Vec<_> = of_end.into_iter().map(|(name, value)| (name, Moment::End, value)).collect();
    outputs.extend(of_end.into_iter().map(|(name, value)| (name, Moment::Time(70.0), value)));
    for event in 0..events {
        for after in [false, true] {
            outputs.extend(of_event.map(|(name, value)| (name, Moment::Event { event, after }, value)));
        }
    }
    outputs
}

/// Of an output the value, and its slopes.
type ValueAndSlopes = (f64, Vec<f64>);

/// Those of every output.
fn slopes_of(flight: &Trajectory, events: usize, variations: &[Variation]) -> Vec<ValueAndSlopes> {
    let values: Vec<_> = outputs(events)
        .into_iter()
        .map(|(_, at, value)| (at, move |point: &FlightPoint, _: Option<Moved>| Some(value(point))))
        .collect();
    let outputs: Vec<_> =
        values.iter().map(|(at, value)| Output { at: *at, value, turn: None, takes_ground_distance: false }).collect();
    let slopes = slopes(flight, variations, &outputs, &AtomicBool::new(false)).unwrap();
    slopes.into_iter().map(|slopes| (slopes.value.unwrap_or(f64::NAN), slopes.slopes)).collect()
}

/// Every slope beside central differences of flights at 1e-13, by two steps: the coarser one tells how far the finer one is off by its order.
#[track_caller]
fn agree_with_differences(what: &str, case: &Case, numbers: &[Number]) {
    let case = with_tolerance(case.clone(), 1e-13);
    let flight = fly(&case);
    let happened: Vec<_> = flight.events().map(|event| event.event).collect();
    assert_eq!(happened.len(), case.events.len(), "{what}: {happened:?} at {}", flight.end_time());
    let events = happened.len();
    let variations: Vec<_> =
        numbers.iter().map(|of| Variation::new(1e-3 * of.1, |offset| Some(of.case(&case, offset))).unwrap()).collect();
    let slopes = slopes_of(&flight, events, &variations);
    let mut wrong = Vec::new();
    for (column, number) in numbers.iter().enumerate() {
        let Number(name, size, _) = number;
        let differences = [2e-4, 1e-4].map(|part| {
            let step = part * size;
            let [above, below] = [step, -step].map(|offset| slopes_of(&fly(&number.case(&case, offset)), events, &[]));
            let slope = |(above, below): (&ValueAndSlopes, &ValueAndSlopes)| (above.0 - below.0) / (2.0 * step);
            above.iter().zip(&below).map(slope).collect::<Vec<_>>()
        });
        for (row, (output, at, _)) in outputs(events).into_iter().enumerate() {
            let [coarse, fine] = [differences[0][row], differences[1][row]];
            let (value, slope) = (slopes[row].0, slopes[row].1[column]);
            // The difference is off by about a third of the change that halving the step made, and by the noise of flights at 1e-13, some
            // 1e-11 of the output or of its unit, of an altitude of 100 km: it is a difference of radii.
            let least = if output == "altitude" { 1e5 } else { 1.0 };
            let noise = 4e-11 * value.abs().max(least) / (1e-4 * size);
            let allowed = (fine - coarse).abs() + 1e-6 * fine.abs() + noise;
            // What is no number is not within.
            if (slope - fine).abs() <= allowed {
                continue;
            }
            wrong.push(format!("{output} at {at:?} by {name}: {slope}, by differences {fine} ± {allowed}"));
        }
    }
    assert!(wrong.is_empty(), "{what}: {} are wrong\n{}", wrong.len(), wrong.join("\n"));
}

fn entry(case: &mut Case, part: usize, place: usize) -> &mut ThrustEntry {
    match &mut engine(&mut case.parts[part]).thrust {
        ThrustProfile::Table(entries) => &mut Arc::make_mut(entries)[place],
        ThrustProfile::Constant(_) => panic!("it has a table"),
    }
}

fn constant(part: &mut Part) -> &mut f64 {
    match &mut engine(part).thrust {
        ThrustProfile::Constant(thrust) => thrust,
        ThrustProfile::Table(_) => panic!("it has none"),
    }
}

fn number_of(trigger: &mut Trigger) -> &mut f64 {
    match trigger {
        Trigger::Condition(condition) => &mut condition.value,
        Trigger::After { delay, .. } | Trigger::AfterBurnout { delay, .. } => delay,
    }
}

fn drop(parts: &[usize], body: usize) -> Effect {
    Effect { separate: vec![Separation { parts: parts.to_vec(), push: None, body }], ..Effect::default() }
}

/// A held vehicle that is too heavy at first, with a core, a pair of boosters by time, and an upper stage.
fn launcher() -> Case {
    let profile = [(0.0, 10e3), (2.0, 60e3), (18.0, 70e3), (24.0, 0.0)];
    let boosters = Part { count: 2, ..motor(90.0, 900.0, &profile, 270.0, 0.03) };
    let parts = vec![
        stage(1100.0, 9000.0, 250e3, 290.0, 0.3),
        boosters,
        stage(250.0, 1500.0, 30e3, 340.0, 0.05),
        load(10_700.0),
        load(150.0),
    ];
    let case = vehicle_of(earth(), parts);
    let body = |part: usize| BodyCase {
        case: Case { parts: vec![case.parts[part].clone()], hold_down: false, ..case.clone() },
        stop_time: None,
    };
    let bodies = vec![body(1), body(0)];
    let axes = launch_axes(&case.planet, &case.initial_state.position, 1.2);
    let tangent = Steering::LinearTangent { axes: Rotation3::from_matrix_unchecked(axes), a: 1.5, b: 0.012 };
    let tilt = Some(Tilt { angle: 0.008, azimuth: 1.2 });
    let throttle = vec![Throttle { part: 0, value: 0.95 }];
    let events = vec![
        at(0.5, ignite(&[0, 1])),
        lift_off(),
        on(rises(Quantity::Speed, 50.0), Effect { tilt, steer: Some(Steering::Velocity), ..Effect::default() }),
        on(Trigger::AfterBurnout { part: 1, delay: 1.5 }, drop(&[1], 0)),
        on(rises(Quantity::Altitude, 3e3), Effect { throttle, ..Effect::default() }),
        on(Trigger::AfterBurnout { part: 0, delay: 0.0 }, drop(&[0], 1)),
        on(Trigger::After { event: 5, delay: 2.5 }, Effect { ignite: vec![2], ..steer(tangent) }),
    ];
    weighed(Case { events, bodies, stop: Stop { time: 200.0, ..Stop::default() }, ..case })
}

#[test]
fn slopes_of_a_launch_with_boosters_and_stages() {
    let numbers = [
        number("dry mass", 1e3, |case, offset| case.parts[0].dry_mass += offset),
        number("payload", 1e3, |case, offset| case.parts[4].dry_mass += offset),
        number("propellant", 1e3, |case, offset| case.parts[0].propellant += offset),
        number("upper propellant", 1e3, |case, offset| case.parts[2].propellant += offset),
        number("booster's propellant", 100.0, |case, offset| case.parts[1].propellant += offset),
        number("thrust", 1e5, |case, offset| *constant(&mut case.parts[0]) += offset),
        number("upper thrust", 1e4, |case, offset| *constant(&mut case.parts[2]) += offset),
        number("specific impulse", 300.0, |case, offset| engine(&mut case.parts[0]).specific_impulse += offset),
        number("booster's impulse", 300.0, |case, offset| engine(&mut case.parts[1]).specific_impulse += offset),
        number("exit area", 0.1, |case, offset| engine(&mut case.parts[0]).exit_area += offset),
        number("entry's time", 2.0, |case, offset| entry(case, 1, 1).time += offset),
        number("entry's thrust", 6e4, |case, offset| entry(case, 1, 1).thrust += offset),
        number("first entry's thrust", 1e4, |case, offset| entry(case, 1, 0).thrust += offset),
        number("last entry's time", 2.0, |case, offset| entry(case, 1, 3).time += offset),
        number("throttle", 0.7, |case, offset| case.events[4].then.throttle[0].value += offset),
        number("time of ignition", 1.0, |case, offset| *number_of(&mut case.events[0].when) += offset),
        number("speed of the tilt", 50.0, |case, offset| *number_of(&mut case.events[2].when) += offset),
        number("tilt", 0.01, |case, offset| case.events[2].then.tilt.as_mut().unwrap().angle += offset),
        number("azimuth", 1.0, |case, offset| case.events[2].then.tilt.as_mut().unwrap().azimuth += offset),
        number("delay after burnout", 1.0, |case, offset| *number_of(&mut case.events[3].when) += offset),
        number("altitude of the throttling", 3e3, |case, offset| *number_of(&mut case.events[4].when) += offset),
        number("delay after an event", 1.0, |case, offset| *number_of(&mut case.events[6].when) += offset),
        number("a", 1.0, |case, offset| *tangent(case)[0] += offset),
        number("b", 0.01, |case, offset| *tangent(case)[1] += offset),
        number("density", 1.0, |case, offset| case.density_factor += offset),
        number("area", 1.0, |case, offset| case.vehicle.reference_area += offset),
    ];
    agree_with_differences("launch", &launcher(), &numbers);
}

fn tangent(case: &mut Case) -> [&mut f64; 2] {
    match case.events[6].then.steer.as_mut().unwrap() {
        Steering::LinearTangent { a, b, .. } => [a, b],
        other => panic!("{other:?}"),
    }
}

/// From rest in the air at once, with a program by time and altitude, and a load limit that is reached.
fn limited(boosted: bool) -> Case {
    let parts = vec![stage(800.0, 2700.0, 90e3, 280.0, 0.12), stage(50.0, 300.0, 20e3, 250.0, 0.02), load(500.0)];
    let case = vehicle_of(earth(), parts);
    let axes = launch_axes(&case.planet, &case.initial_state.position, 0.8);
    let schedule = |against, at: &[f64], value: &[f64]| {
        Command::Schedule(Arc::new(Schedule::new(against, at, value, Interpolation::Linear).unwrap()))
    };
    let pitch = schedule(Against::Time, &[10.0, 25.0, 60.0], &[1.5, 1.3, 0.6]);
    let yaw = schedule(Against::Altitude, &[2e3, 9e3], &[0.15, 0.25]);
    let program =
        Steering::Program(Program { axes: ProgramAxes::Inertial(Rotation3::from_matrix_unchecked(axes)), pitch, yaw });
    let events = vec![
        at(0.0, Effect { load_limit: Some(Some(2.6)), ..ignite(if boosted { &[0, 1] } else { &[0] }) }),
        lift_off(),
        at(10.0, steer(program)),
        on(Trigger::AfterBurnout { part: 0, delay: 1.0 }, Effect { load_limit: Some(None), ..Effect::default() }),
    ];
    Case { events, stop: Stop { time: 110.0, ..Stop::default() }, ..case }
}

fn program(case: &mut Case) -> &mut Program {
    match case.events[2].then.steer.as_mut().unwrap() {
        Steering::Program(program) => program,
        other => panic!("{other:?}"),
    }
}

fn pitch_with(at: [f64; 3], value: [f64; 3]) -> Command {
    Command::Schedule(Arc::new(Schedule::new(Against::Time, &at, &value, Interpolation::Linear).unwrap()))
}

#[test]
fn slopes_of_an_ascent_by_a_program_under_a_load_limit() {
    let numbers = || {
        [
            number("dry mass", 1e3, |case, offset| case.parts[0].dry_mass += offset),
            number("propellant", 1e3, |case, offset| case.parts[0].propellant += offset),
            number("thrust", 1e5, |case, offset| *constant(&mut case.parts[0]) += offset),
            number("specific impulse", 300.0, |case, offset| engine(&mut case.parts[0]).specific_impulse += offset),
            number("exit area", 0.1, |case, offset| engine(&mut case.parts[0]).exit_area += offset),
            number("limit", 1.0, |case, offset| {
                case.events[0].then.load_limit = Some(Some(2.6 + offset));
            }),
            number("value of a knot", 0.1, |case, offset| {
                program(case).pitch = pitch_with([10.0, 25.0, 60.0], [1.5, 1.3 + offset, 0.6]);
            }),
            number("time of a knot", 10.0, |case, offset| {
                program(case).pitch = pitch_with([10.0, 25.0 + offset, 60.0], [1.5, 1.3, 0.6]);
            }),
            number("value of the last knot", 0.1, |case, offset| {
                program(case).pitch = pitch_with([10.0, 25.0, 60.0], [1.5, 1.3, 0.6 + offset]);
            }),
            number("altitude of a knot", 1e3, |case, offset| {
                let at = [2e3, 9e3 + offset];
                let yaw = Schedule::new(Against::Altitude, &at, &[0.15, 0.25], Interpolation::Linear).unwrap();
                program(case).yaw = Command::Schedule(Arc::new(yaw));
            }),
            number("density", 1.0, |case, offset| case.density_factor += offset),
        ]
    };
    for boosted in [false, true] {
        agree_with_differences(if boosted { "two engines" } else { "one engine" }, &limited(boosted), &numbers());
    }
    // The angle of attack is that of the axis, from rest on, where there is none; later the yaw keeps it from 0, where the drag has a
    // corner, but not far, so that the knots are moved by little.
    let entries = [0.0, 0.1, 0.3, 0.7];
    let lift: Vec<_> = entries.iter().map(|angle| vec![2.0 * angle; 2]).collect();
    let drag: Vec<_> = entries.iter().map(|angle| vec![0.3 + 0.5 * angle; 2]).collect();
    let table = AlphaMachTable::new(&entries, &[0.0, 10.0], &lift, &drag).unwrap();
    let mut lifting = limited(false);
    lifting.vehicle.aerodynamics = Aerodynamics::AlphaMachTable(Arc::new(table));
    agree_with_differences("lift", &lifting, &numbers());
}

#[test]
fn slopes_of_an_ascent_that_ends_with_its_burn() {
    // Shut down and lit again, and the end of the flight is the burnout itself.
    let case = vehicle_of(earth(), vec![stage(800.0, 2700.0, 90e3, 280.0, 0.12), load(500.0)]);
    let events = vec![
        at(0.0, ignite(&[0])),
        lift_off(),
        at(20.0, shut_down(&[0])),
        on(rises(Quantity::Time, 22.0), ignite(&[0])),
    ];
    for delay in [0.0, 2.0] {
        let stop = Stop { when: vec![Trigger::AfterBurnout { part: 0, delay }], ..Stop::default() };
        let case = Case { events: events.clone(), stop, ..case.clone() };
        let numbers = [
            number("propellant", 1e3, |case, offset| case.parts[0].propellant += offset),
            number("thrust", 1e5, |case, offset| *constant(&mut case.parts[0]) += offset),
            number("time of the cut", 10.0, |case, offset| *number_of(&mut case.events[2].when) += offset),
            number("time of the second ignition", 10.0, |case, offset| *number_of(&mut case.events[3].when) += offset),
        ];
        agree_with_differences("burn", &case, &numbers);
    }
}

#[test]
fn slopes_where_several_engines_change_at_one_time() {
    // Two motors with the same knots, of which one is burnt out when the other is; and a throttling at the time of a knot.
    let profile = [(0.0, 50e3), (10.0, 70e3), (20.0, 40e3), (60.0, 40e3)];
    let motors = || motor(200.0, 700.0, &profile, 270.0, 0.03);
    let case = vehicle_of(earth(), vec![motors(), motors(), stage(100.0, 500.0, 20e3, 250.0, 0.0), load(2000.0)]);
    let throttle = vec![Throttle { part: 2, value: 0.5 }];
    let turn = Effect { tilt: Some(Tilt { angle: 0.02, azimuth: 1.2 }), ..steer(Steering::Velocity) };
    let events = vec![
        at(0.0, ignite(&[0, 1, 2])),
        lift_off(),
        on(rises(Quantity::Speed, 50.0), turn),
        at(20.0, Effect { throttle, ..Effect::default() }),
    ];
    let case = weighed(Case { events, stop: Stop { time: 100.0, ..Stop::default() }, ..case });
    let numbers = [
        number("time of an entry", 3.0, |case, offset| entry(case, 0, 1).time += offset),
        number("time of an entry of the other", 3.0, |case, offset| entry(case, 1, 1).time += offset),
        number("thrust of an entry", 5e4, |case, offset| entry(case, 1, 2).thrust += offset),
        number("time of an entry at an event", 3.0, |case, offset| entry(case, 0, 2).time += offset),
        number("time of the event", 3.0, |case, offset| *number_of(&mut case.events[3].when) += offset),
        number("propellant", 100.0, |case, offset| case.parts[0].propellant += offset),
        number("propellant of the other", 100.0, |case, offset| case.parts[1].propellant += offset),
        number("impulse of the other", 100.0, |case, offset| engine(&mut case.parts[1]).specific_impulse += offset),
    ];
    agree_with_differences("motors", &case, &numbers);
}
