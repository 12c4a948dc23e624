//! The slopes of outputs of a flight by numbers of its case, beside the differences of flights in which the numbers are moved.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::event::{Condition, Direction, Effect, Event, Quantity, ThrustCommand, Trigger};
use reentry::heating::Heating;
use reentry::parachute::Parachute;
use reentry::planet::{Gravity, Zonal};
use reentry::propulsion::{Impulse, Thrust, ThrustAxis};
use reentry::sensitivity::{Moment, Moved, Output, Slopes, Variation, slopes};
use reentry::trajectory::FlightPoint;
use reentry::vehicle::{AlphaMachTable, MachTable};
use reentry::wind::WindTable;
use reentry::{Aerodynamics, Atmosphere, Case, Control, FlightPath, Planet, Stop, Trajectory, Vehicle, Wind};

use super::flights::{capsule, fly, spherical, target_2, with_tolerance};

/// Moves a number of a case by an offset.
type Move = dyn Fn(&mut Case, f64);

/// A number of a case, the size in which it is moved, and how.
struct Number {
    name: &'static str,
    size: f64,
    moved: Box<Move>,
}

fn number(name: &'static str, size: f64, moved: impl Fn(&mut Case, f64) + 'static) -> Number {
    Number { name, size, moved: Box::new(moved) }
}

impl Number {
    fn case(&self, case: &Case, offset: f64) -> Case {
        let mut case = case.clone();
        (self.moved)(&mut case, offset);
        case
    }

    fn variation(&self, case: &Case) -> Variation {
        Variation::new(1e-3 * self.size, |offset| Some(self.case(case, offset))).unwrap()
    }
}

type Value = fn(&FlightPoint) -> Option<f64>;

const TIME: Value = |point| Some(point.time);
const SPEED: Value = |point| Some(point.loads.speed);
const ALTITUDE: Value = |point| Some(point.loads.altitude);
const LOAD_FACTOR: Value = |point| Some(point.loads.load_factor);
const HEAT_FLUX: Value = |point| Some(point.loads.heat_flux?.total());

/// What is looked at in every flight: its end, its start, its peaks, a time, and both sides of its first event.
fn outputs() -> Vec<(&'static str, Moment, Value)> {
    let first = |after| Moment::Event { event: 0, after };
    vec![
        ("time", Moment::End, TIME),
        ("longitude", Moment::End, |point| Some(point.flight_path.longitude)),
        ("geodetic latitude", Moment::End, |point| Some(point.geodetic_latitude)),
        ("geodetic altitude", Moment::End, |point| Some(point.geodetic_altitude)),
        ("speed", Moment::End, SPEED),
        ("flight-path angle", Moment::End, |point| Some(point.flight_path.flight_path_angle)),
        ("inertial speed", Moment::End, |point| Some(point.inertial_speed)),
        ("specific energy", Moment::End, |point| Some(point.specific_energy)),
        ("downrange", Moment::End, |point| point.downrange),
        ("crossrange", Moment::End, |point| point.crossrange),
        ("ground range", Moment::End, |point| Some(point.ground_range)),
        ("ground distance", Moment::End, |point| Some(point.ground_distance)),
        ("mass", Moment::End, |point| Some(point.mass)),
        ("load factor", Moment::End, LOAD_FACTOR),
        ("density", Moment::End, |point| Some(point.loads.density)),
        ("heat load", Moment::End, |point| point.heat_load),
        ("bank angle", Moment::End, |point| Some(point.bank_angle)),
        ("speed", Moment::Start, SPEED),
        ("load factor", Moment::Start, LOAD_FACTOR),
        ("altitude", Moment::Time(61.0), ALTITUDE),
        ("ground distance", Moment::Time(61.0), |point| Some(point.ground_distance)),
        ("dynamic pressure", Moment::Time(61.0), |point| Some(point.loads.dynamic_pressure)),
        ("time", first(false), TIME),
        ("speed", first(false), SPEED),
        ("speed", first(true), SPEED),
        ("load factor", first(true), LOAD_FACTOR),
        ("load factor", Moment::Peak, LOAD_FACTOR),
        ("dynamic pressure", Moment::Peak, |point| Some(point.loads.dynamic_pressure)),
        ("heat flux", Moment::Peak, HEAT_FLUX),
        ("wall temperature", Moment::Peak, |point| point.wall_temperature),
        ("speed", Moment::Peak, SPEED),
        ("altitude", Moment::Lowest, ALTITUDE),
    ]
}

fn slopes_of(flight: &Trajectory, variations: &[Variation]) -> Vec<Slopes> {
    let values: Vec<_> = outputs()
        .into_iter()
        .map(|(_, at, value)| (at, move |point: &FlightPoint, _: Option<Moved>| value(point)))
        .collect();
    let outputs: Vec<_> =
        values.iter().map(|(at, value)| Output { at: *at, value, turn: None, takes_ground_distance: true }).collect();
    slopes(flight, variations, &outputs, &AtomicBool::new(false)).unwrap()
}

/// Every slope beside central differences of flights at 1e-13, by two steps: the coarser one tells how far the finer one is off by its order.
fn agree_with_differences(what: &str, case: &Case, numbers: &[Number]) {
    let case = with_tolerance(case.clone(), 1e-13);
    let variations: Vec<_> = numbers.iter().map(|number| number.variation(&case)).collect();
    let slopes = slopes_of(&fly(&case), &variations);
    let values = |number: &Number, offset: f64| slopes_of(&fly(&number.case(&case, offset)), &[]);
    for (column, number) in numbers.iter().enumerate() {
        let differences = [2e-5, 1e-5].map(|part| {
            let step = part * number.size;
            let [above, below] = [step, -step].map(|offset| values(number, offset));
            let slope = |(above, below): (&Slopes, &Slopes)| Some((above.value? - below.value?) / (2.0 * step));
            above.iter().zip(&below).map(slope).collect::<Vec<_>>()
        });
        for (row, (output, at, _)) in outputs().into_iter().enumerate() {
            let what = format!("{what}: {output} at {at:?} by {}", number.name);
            let [coarse, fine] = [&differences[0], &differences[1]].map(|differences| differences[row]);
            let slope = slopes[row].slopes[column];
            let (Some(coarse), Some(fine), Some(value)) = (coarse, fine, slopes[row].value) else {
                assert!(slope.is_nan(), "{what}: {slope} of what is not there");
                continue;
            };
            // The difference is off by about a third of the change that halving the step made, and by the noise of flights at 1e-13, some
            // 1e-11 of the output or of its unit, of an altitude of a kilometre: it is a difference of radii.
            let least = if output.ends_with("altitude") { 1e3 } else { 1.0 };
            let noise = 3e-11 * value.abs().max(least) / (1e-5 * number.size);
            let allowed = (fine - coarse).abs() + 1e-6 * fine.abs() + noise;
            assert!((slope - fine).abs() <= allowed, "{what}: {slope}, by differences {fine} ± {allowed}");
        }
    }
}

fn set_state(index: usize) -> impl Fn(&mut Case, f64) {
    move |case, offset| {
        let mut path: [f64; 6] = FlightPath::from_planet_fixed(&case.initial_state).into();
        path[index] += offset;
        case.initial_state = FlightPath::from(path).to_planet_fixed();
    }
}

fn at_altitude(value: f64, then: Effect) -> Event {
    let (quantity, direction) = (Quantity::Altitude, Direction::Falling);
    Event { when: Condition { quantity, value, direction }.into(), then }
}

fn thrust(case: &mut Case, event: usize) -> &mut Thrust {
    match &mut case.events[event].then.thrust {
        Some(ThrustCommand::On(thrust)) => thrust,
        other => panic!("{other:?}"),
    }
}

fn trigger(case: &mut Case, event: usize) -> &mut f64 {
    match &mut case.events[event].when {
        Trigger::Condition(condition) => &mut condition.value,
        Trigger::After { delay, .. } | Trigger::AfterBurnout { delay, .. } => delay,
    }
}

fn heating() -> Heating {
    Heating { emissivity: 0.9, ..Heating::default() }
}

/// TARGET case 2 with a burn, an impulse after it, a change of mass and a parachute, heated.
fn eventful() -> Case {
    let burn =
        Thrust { along: ThrustAxis::Velocity, force: -9000.0, specific_impulse: Some(250.0), propellant: Some(80.0) };
    let push = Impulse { along: ThrustAxis::inertial([1.0, -2.0, 0.7]).unwrap(), speed_change: -40.0 };
    let aerodynamics = Some(Aerodynamics::Constant { lift_coefficient: 0.1, drag_coefficient: 0.9 });
    let parachute = Parachute { drag_area: 0.4, inflation_time: 6.0, delay: 1.5 };
    let when = Trigger::After { event: 0, delay: 4.0 };
    Case {
        vehicle: Vehicle { nose_radius: Some(0.3), ..target_2().vehicle },
        heating: Some(heating()),
        events: vec![
            at_altitude(70e3, Effect { thrust: Some(ThrustCommand::On(burn)), ..Effect::default() }),
            Event { when, then: Effect { impulse: Some(push), ..Effect::default() } },
            at_altitude(30e3, Effect { aerodynamics, mass: Some(550.0), ..Effect::default() }),
            at_altitude(12e3, Effect { deploy: Some(parachute), ..Effect::default() }),
        ],
        stop: Stop { altitude: 500.0, ..Stop::default() },
        ..target_2()
    }
}

#[test]
fn slopes_by_the_numbers_of_the_flight_are_differences() {
    let numbers = [
        number("mass", 700.0, |case, offset| case.vehicle.mass += offset),
        number("reference area", 0.2, |case, offset| case.vehicle.reference_area += offset),
        number("density factor", 1.0, |case, offset| case.density_factor += offset),
        number("radius", 1e5, set_state(0)),
        number("latitude", 0.1, set_state(2)),
        number("speed", 1e3, set_state(3)),
        number("flight-path angle", 0.1, set_state(4)),
        number("the altitude of the burn", 1e4, |case, offset| *trigger(case, 0) += offset),
        number("the delay of the impulse", 1.0, |case, offset| *trigger(case, 1) += offset),
        number("thrust", 9000.0, |case, offset| thrust(case, 0).force += offset),
        number("specific impulse", 250.0, |case, offset| *thrust(case, 0).specific_impulse.as_mut().unwrap() += offset),
        number("propellant", 80.0, |case, offset| *thrust(case, 0).propellant.as_mut().unwrap() += offset),
        number("impulse", 40.0, |case, offset| case.events[1].then.impulse.as_mut().unwrap().speed_change += offset),
        number("mass left", 550.0, |case, offset| *case.events[2].then.mass.as_mut().unwrap() += offset),
        number("drag area", 0.4, |case, offset| case.events[3].then.deploy.as_mut().unwrap().drag_area += offset),
        number("inflation time", 6.0, |case, offset| {
            case.events[3].then.deploy.as_mut().unwrap().inflation_time += offset;
        }),
        number("delay", 1.5, |case, offset| case.events[3].then.deploy.as_mut().unwrap().delay += offset),
        number("stop altitude", 1e3, |case, offset| case.stop.altitude += offset),
    ];
    let case = eventful();
    for number in &numbers {
        assert!(!number.variation(&case).changes_models(&case), "{} is no number of a model", number.name);
    }
    agree_with_differences("Cartesian", &case, &numbers);
    let stopped = Case { stop: Stop { time: 100.0, ..case.stop.clone() }, ..spherical(case) };
    let until = number("stop time", 100.0, |case, offset| case.stop.time += offset);
    agree_with_differences("spherical, to a given time", &stopped, &[until]);
}

#[test]
fn slopes_by_the_numbers_of_the_models_are_differences() {
    let winds = |offset: f64| {
        let altitudes = [0.0, 8e3, 15e3, 40e3];
        Wind::Table(Arc::new(
            WindTable::new(&altitudes, &[3.0, 12.0, 30.0 + offset, -5.0], &[0.0, 4.0, 8.0, 1.0]).unwrap(),
        ))
    };
    let drags = |offset: f64| {
        let (mach, drag) = ([0.5, 1.1, 3.0, 12.0], [0.9, 1.4 + offset, 1.3, 1.2]);
        Aerodynamics::MachTable(Arc::new(MachTable::new(&mach, &[0.0, 0.1, 0.2, 0.3], &drag).unwrap()))
    };
    let banks = |at: f64, value: f64, interpolation| {
        let schedule =
            Schedule::new(Against::Altitude, &[10e3, 30e3 + at, 60e3], &[0.3, 1.0 + value, -0.4], interpolation);
        Control { bank_angle: Command::Schedule(Arc::new(schedule.unwrap())), ..Control::banked(0.0) }
    };
    let case = Case {
        planet: Planet {
            gravity: Gravity::Zonal(Zonal { coefficients: [1.08e-3, -2.5e-6, -1.6e-6] }),
            ..Planet::EARTH_WGS84
        },
        wind: winds(0.0),
        vehicle: Vehicle { aerodynamics: drags(0.0), nose_radius: Some(0.8), ..capsule().vehicle },
        heating: Some(heating()),
        control: banks(0.0, 0.0, Interpolation::Step),
        events: vec![at_altitude(50e3, Effect::default())],
        ..capsule()
    };
    let numbers = [
        number("gravitational parameter", 1e14, |case, offset| {
            case.planet =
                Planet { gravitational_parameter: case.planet.gravitational_parameter + offset, ..case.planet };
        }),
        number("rotation rate", 1e-5, |case, offset| case.planet.rotation_rate += offset),
        number("wind", 10.0, move |case, offset| case.wind = winds(offset)),
        number("drag coefficient", 1.0, move |case, offset| case.vehicle.aerodynamics = drags(offset)),
        number("bank angle", 1.0, move |case, offset| case.control = banks(0.0, offset, Interpolation::Step)),
        number("altitude of the bank", 1e4, move |case, offset| case.control = banks(offset, 0.0, Interpolation::Step)),
        number("nose radius", 0.8, |case, offset| *case.vehicle.nose_radius.as_mut().unwrap() += offset),
        number("emissivity", 0.5, |case, offset| case.heating.as_mut().unwrap().emissivity += offset),
        number("mass", 3000.0, |case, offset| case.vehicle.mass += offset),
    ];
    for (index, number) in numbers.iter().enumerate() {
        assert_eq!(number.variation(&case).changes_models(&case), index < 8, "{}", number.name);
    }
    agree_with_differences("tables", &case, &numbers);
    let scale = number("scale height", 6935.0, |case, offset| match &mut case.atmosphere {
        Atmosphere::Exponential { scale_height, .. } => *scale_height += offset,
        other => panic!("{other:?}"),
    });
    agree_with_differences("exponential, spherical", &spherical(eventful()), &[scale]);
}

/// The corners of a schedule against the energy come sooner or later with whatever the energy depends on, the planet's numbers included.
#[test]
fn slopes_by_a_schedule_against_energy_are_differences() {
    for interpolation in [Interpolation::Linear, Interpolation::Step] {
        let banks = move |at: f64, value: f64| {
            let at = [-6.4e7, -6.1e7 + at, -4e7];
            let schedule = Schedule::new(Against::Energy, &at, &[0.3, 1.0 + value, -0.4], interpolation);
            Control { bank_angle: Command::Schedule(Arc::new(schedule.unwrap())), ..Control::banked(0.0) }
        };
        let gravity = Gravity::Zonal(Zonal { coefficients: [1.08e-3, -2.5e-6, -1.6e-6] });
        let aerodynamics = Aerodynamics::Constant { lift_coefficient: 0.4, drag_coefficient: 1.3 };
        let case = Case {
            planet: Planet { gravity, ..Planet::EARTH_WGS84 },
            vehicle: Vehicle { aerodynamics, nose_radius: Some(0.8), ..capsule().vehicle },
            heating: Some(heating()),
            control: banks(0.0, 0.0),
            events: vec![at_altitude(50e3, Effect::default())],
            ..capsule()
        };
        let numbers = [
            number("entry of energy", 1e6, move |case, offset| case.control = banks(offset, 0.0)),
            number("bank angle", 1.0, move |case, offset| case.control = banks(0.0, offset)),
            number("gravitational parameter", 1e14, |case, offset| case.planet.gravitational_parameter += offset),
            number("rotation rate", 1e-5, |case, offset| case.planet.rotation_rate += offset),
            number("speed", 1e3, set_state(3)),
            number("latitude", 0.1, set_state(2)),
            number("mass", 3000.0, |case, offset| case.vehicle.mass += offset),
        ];
        agree_with_differences(&format!("{interpolation:?} in energy"), &case, &numbers);
        agree_with_differences(&format!("{interpolation:?} in energy, spherical"), &spherical(case), &numbers[..5]);
    }
}

/// A schedule since an event goes with the event.
#[test]
fn slopes_by_a_schedule_since_an_event_are_differences() {
    for interpolation in [Interpolation::Linear, Interpolation::Step] {
        let schedule = move |event: usize, at: f64, value: f64| {
            let at = [2.0, 15.0 + at, 40.0];
            let schedule = Schedule::new(Against::Since(event), &at, &[0.3, 1.0 + value, -0.4], interpolation);
            Command::Schedule(Arc::new(schedule.unwrap()))
        };
        let control = move |at: f64, value: f64| Control {
            bank_angle: schedule(1, at, value),
            angle_of_attack: schedule(0, 0.0, value),
        };
        let alpha = [-0.5, 0.0, 0.5, 1.1];
        let lift = alpha.map(|alpha: f64| vec![0.6 * alpha.sin(); 2]);
        let drag = alpha.map(|alpha: f64| vec![0.9 + alpha * alpha; 2]);
        let table = AlphaMachTable::new(&alpha, &[1.0, 10.0], &lift, &drag).unwrap();
        let case = Case {
            atmosphere: Atmosphere::Us76,
            vehicle: Vehicle { aerodynamics: Aerodynamics::AlphaMachTable(Arc::new(table)), ..eventful().vehicle },
            control: control(0.0, 0.0),
            events: vec![
                at_altitude(80e3, Effect::default()),
                Event { when: Trigger::After { event: 0, delay: 3.0 }, then: Effect::default() },
            ],
            ..eventful()
        };
        let numbers = [
            number("the altitude of the event", 1e4, |case, offset| *trigger(case, 0) += offset),
            number("the delay of the event", 1.0, |case, offset| *trigger(case, 1) += offset),
            number("entry of time", 1.0, move |case, offset| case.control = control(offset, 0.0)),
            number("angle", 1.0, move |case, offset| case.control = control(0.0, offset)),
            number("speed", 1e3, set_state(3)),
            number("mass", 700.0, |case, offset| case.vehicle.mass += offset),
        ];
        agree_with_differences(&format!("{interpolation:?} since an event"), &case, &numbers);
        agree_with_differences(&format!("{interpolation:?} since an event, spherical"), &spherical(case), &numbers);
    }
}

/// A peak that lies just beside the end of a step, where no look at the step is nearer than that end, is found all the same.
#[test]
fn a_peak_beside_the_end_of_a_step_is_found() {
    let plain = Case { stop: Stop { time: 400.0, ..Stop::default() }, ..with_tolerance(capsule(), 1e-13) };
    let [of_load] =
        [outputs().into_iter().find(|(name, at, _)| (*name, *at) == ("load factor", Moment::Peak)).unwrap()];
    let peak = fly(&plain).peaks().load_factor;
    // A mark ends a step; the steps here are seconds long.
    for beside in [-0.2, -0.02, -1e-3, 1e-3, 0.02, 0.2] {
        let (quantity, direction) = (Quantity::Time, Direction::Rising);
        let when = Condition { quantity, value: peak.time + beside, direction }.into();
        let flight = fly(&Case { events: vec![Event { when, then: Effect::default() }], ..plain.clone() });
        let value = move |point: &FlightPoint, _: Option<Moved>| of_load.2(point);
        let output = Output { at: Moment::Peak, value: &value, turn: None, takes_ground_distance: false };
        let found = slopes(&flight, &[], &[output], &AtomicBool::new(false)).unwrap();
        let off = found[0].time.unwrap() - peak.time;
        // By differences over a part of a step the time of the peak is known to a part in 10^6 of the step, or so.
        assert!(off.abs() < 1e-5, "{beside} s beside the peak: {off} s");
    }
}
