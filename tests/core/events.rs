//! Events, and conditions that end a flight: where they are met, in which order, and what they change.

use std::sync::atomic::AtomicBool;

use reentry::coordinates::{Inertial, OrbitalElements};
use reentry::event::{Condition, Direction, Effect, Event, Quantity, Trigger};
use reentry::heating::Heating;
use reentry::propulsion::{Impulse, ThrustAxis};
use reentry::scenario::{Fault, ScenarioError};
use reentry::simulate::{arrival, ends_of_all};
use reentry::trajectory::{EventPoint, FlightPoint, Sampling, Termination};
use reentry::{Aerodynamics, Atmosphere, Case, FlightPath, Planet, Scenario, Stop, Trajectory, Vehicle};

use crate::check::{near, relative};
use crate::core::flights::{capsule, fly, in_vacuum, miss, spherical, target_2, vehicle, with_tolerance};

fn falls(quantity: Quantity, value: f64) -> Condition {
    Condition { quantity, value, direction: Direction::Falling }
}

fn rises(quantity: Quantity, value: f64) -> Condition {
    Condition { quantity, value, direction: Direction::Rising }
}

fn mark(when: Condition) -> Event {
    Event { when: when.into(), then: Effect::default() }
}

fn push(along: ThrustAxis, speed_change: f64) -> Effect {
    Effect { impulse: Some(Impulse { along, speed_change }), ..Effect::default() }
}

/// TARGET case 2, which dips to 214 m, climbs to 4 km and lands, in the air of the standard, which has a Mach number.
fn skip() -> Case {
    Case { atmosphere: Atmosphere::Us76, vehicle: vehicle(700.0, 0.216_419, 0.5, 0.2), ..target_2() }
}

fn parachute() -> Effect {
    let aerodynamics = Some(Aerodynamics::Constant { lift_coefficient: 0.0, drag_coefficient: 0.7 });
    Effect { mass: Some(2500.0), reference_area: Some(100.0), aerodynamics, ..Effect::default() }
}

fn events(flight: &Trajectory) -> Vec<EventPoint> {
    flight.events().collect()
}

fn of(quantity: Quantity, point: &FlightPoint) -> f64 {
    match quantity {
        Quantity::Time => point.time,
        Quantity::Altitude => point.loads.altitude,
        Quantity::Speed => point.flight_path.speed,
        Quantity::Mach => point.loads.mach.unwrap(),
        Quantity::DynamicPressure => point.loads.dynamic_pressure,
        Quantity::LoadFactor => point.loads.load_factor,
        Quantity::FlightPathAngle => point.flight_path.flight_path_angle,
        Quantity::Mass => point.mass,
        Quantity::AirSpeed => point.loads.air_speed,
        Quantity::InertialSpeed => point.inertial_speed,
        Quantity::SpecificEnergy => point.specific_energy,
        Quantity::ApoapsisAltitude => orbit(point).semi_major_axis() * (1.0 + orbit(point).0.eccentricity) - RADIUS,
        Quantity::PeriapsisAltitude => orbit(point).semi_major_axis() * (1.0 - orbit(point).0.eccentricity) - RADIUS,
        Quantity::Eccentricity => orbit(point).0.eccentricity,
        Quantity::Inclination => orbit(point).0.inclination,
        Quantity::HeatFlux => point.loads.heat_flux.unwrap().total(),
        Quantity::HeatLoad => point.heat_load.unwrap(),
        Quantity::WallTemperature => point.wall_temperature.unwrap(),
        Quantity::Downrange => point.downrange.unwrap(),
        Quantity::GroundRange => {
            let [along, across] = [point.downrange, point.crossrange].map(|range| range.unwrap() / RADIUS);
            RADIUS * (along.cos() * across.cos()).acos()
        }
        Quantity::Deceleration => point.loads.deceleration,
        Quantity::Density => point.loads.density,
        Quantity::UpwardAcceleration => unreachable!("it is of the ground alone"),
    }
}

const RADIUS: f64 = 6_378_137.0;

/// The orbit by the conversion of the state, a computation of its own.
struct Orbit(OrbitalElements);

fn orbit(point: &FlightPoint) -> Orbit {
    let planet = Planet::EARTH_WGS84;
    let inertial = Inertial::from_planet_fixed(&point.flight_path.to_planet_fixed(), &planet, 0.0);
    Orbit(OrbitalElements::from_inertial(&inertial, planet.gravitational_parameter).unwrap().0)
}

impl Orbit {
    fn semi_major_axis(&self) -> f64 {
        self.0.semi_latus_rectum() / (1.0 - self.0.eccentricity.powi(2))
    }
}

const QUANTITIES: [Quantity; 7] = [
    Quantity::Time,
    Quantity::Altitude,
    Quantity::Speed,
    Quantity::Mach,
    Quantity::DynamicPressure,
    Quantity::LoadFactor,
    Quantity::FlightPathAngle,
];

/// Those beside these that change on every flight with heating.
const OTHER_QUANTITIES: [Quantity; 14] = [
    Quantity::AirSpeed,
    Quantity::InertialSpeed,
    Quantity::SpecificEnergy,
    Quantity::ApoapsisAltitude,
    Quantity::PeriapsisAltitude,
    Quantity::Eccentricity,
    Quantity::Inclination,
    Quantity::HeatFlux,
    Quantity::HeatLoad,
    Quantity::WallTemperature,
    Quantity::Downrange,
    Quantity::GroundRange,
    Quantity::Deceleration,
    Quantity::Density,
];

/// The capsule with a heat shield, from a higher orbit down to where its orbit is still one.
fn heated() -> Case {
    let start = FlightPath { speed: 7700.0, ..FlightPath::from_planet_fixed(&capsule().initial_state) };
    Case {
        vehicle: Vehicle { nose_radius: Some(1.2), ..capsule().vehicle },
        heating: Some(Heating { emissivity: 0.8, ..Heating::default() }),
        initial_state: start.to_planet_fixed(),
        stop: Stop { when: vec![falls(Quantity::Speed, 1000.0).into()], ..Stop::default() },
        ..capsule()
    }
}

/// Against dense rows of the flight without events: each quantity, at a hundred values, each way. A mark leaves the flight as it is.
#[test]
fn every_crossing_is_found_where_it_first_is() {
    let (mut met, mut missed) = (0, 0);
    let all = [(skip(), &QUANTITIES[..]), (spherical(capsule()), &QUANTITIES), (heated(), &OTHER_QUANTITIES)];
    for (case, quantities) in all {
        let plain = fly(&case);
        let rows = plain.points(&plain.instants(&Sampling::Count(20_001), 20_001).unwrap());
        for quantity in quantities.iter().copied() {
            let values: Vec<_> = rows.iter().map(|row| of(quantity, row)).collect();
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let mut marks = Vec::new();
            for part in 1..50 {
                let value = least + (greatest - least) * f64::from(part) / 50.3;
                marks.push(mark(rises(quantity, value)));
                if quantity != Quantity::Time {
                    marks.push(mark(falls(quantity, value)));
                }
            }
            let flight = fly(&Case { events: marks.clone(), ..case.clone() });
            let happened = events(&flight);
            assert!(miss(&plain, &flight) < 0.5, "{quantity:?}: marks moved the end by {} m", miss(&plain, &flight));
            for (index, Event { when, .. }) in marks.iter().enumerate() {
                let when = when.condition().unwrap();
                let beyond = |value: f64| when.before(value) <= 0.0;
                let first = values.windows(2).position(|pair| !beyond(pair[0]) && beyond(pair[1]));
                let found = happened.iter().find(|event| event.event == index);
                let what = format!("{when:?}");
                match (first, found) {
                    (Some(row), Some(event)) => {
                        let (from, to) = (rows[row].time, rows[row + 1].time);
                        // The two flights are off by the other steps that they take.
                        let off = 1e-4;
                        assert!(
                            (from - off..=to + off).contains(&event.before.time),
                            "{what} at {} s, not in {from} to {to}",
                            event.before.time
                        );
                        near(&what, of(quantity, &event.before), when.value, 1e-9 * greatest.abs().max(1.0));
                        met += 1;
                    }
                    (None, None) => missed += 1,
                    // Between two rows a peak may pass a value and come back.
                    (None, Some(event)) => {
                        near(&what, of(quantity, &event.before), when.value, 1e-9 * greatest.abs().max(1.0));
                    }
                    (Some(row), None) => panic!("{what} is met at {} s", rows[row].time),
                }
            }
            assert!(happened.windows(2).all(|pair| pair[0].before.time <= pair[1].before.time), "{quantity:?}");
        }
    }
    assert!(met > 1200 && missed > 20, "{met} met, {missed} not");
}

/// An unbound orbit has no apoapsis: no condition on it is met, until the air has made an ellipse of the orbit.
#[test]
fn an_unbound_orbit_never_meets_a_condition_on_its_apoapsis() {
    let start = FlightPath {
        speed: 12_000.0,
        flight_path_angle: -0.12,
        ..FlightPath::from_planet_fixed(&capsule().initial_state)
    };
    let values = [-6e6, 1e5, 4e5, 1e9, 1e12];
    let marks = |values: &[f64]| {
        let both = |value: &f64| [rises, falls].map(|way| mark(way(Quantity::ApoapsisAltitude, *value)));
        values.iter().flat_map(both).collect::<Vec<_>>()
    };
    let stop = Stop { time: 20_000.0, ..Stop::default() };
    let away = FlightPath { flight_path_angle: 0.1, ..start };
    let [past, captured] = [away, start].map(|state| Case {
        events: marks(&values),
        initial_state: state.to_planet_fixed(),
        stop: stop.clone(),
        ..capsule()
    });
    let past = fly(&in_vacuum(past));
    assert!(orbit(&past.last()).0.eccentricity > 1.0);
    assert_eq!(events(&past).len(), 0, "{:?}", events(&past));
    let captured = fly(&captured);
    assert!(orbit(&captured.initial()).0.eccentricity > 1.0);
    let met: Vec<_> = events(&captured);
    // Downward through each, the farthest first; that at the centre is behind the ground.
    assert_eq!(met.iter().map(|event| event.event).collect::<Vec<_>>(), [9, 7, 5, 3]);
    for event in &met {
        assert!(orbit(&event.before).0.eccentricity < 1.0);
        let apoapsis = of(Quantity::ApoapsisAltitude, &event.before);
        // 1 - e of 1e12 m is 7e-6, of which the conversion knows ten digits.
        near("apoapsis", apoapsis, values[event.event / 2], 1e-8 * apoapsis.abs() + 1e-8 * RADIUS);
    }
}

/// A quantity that passes a value and comes back within a step is seen: here peaks by a part in 10^4, and the dip over the ground.
#[test]
fn what_comes_back_within_a_step_is_met() {
    let plain = fly(&skip());
    let peaks = plain.peaks();
    for (quantity, peak) in
        [(Quantity::DynamicPressure, peaks.dynamic_pressure), (Quantity::LoadFactor, peaks.load_factor)]
    {
        let nearly = peak.value * (1.0 - 1e-4);
        let flight =
            fly(&Case { events: vec![mark(falls(quantity, nearly)), mark(rises(quantity, nearly))], ..skip() });
        let [up, down] = events(&flight)[..] else { panic!("{quantity:?}: {:?}", events(&flight)) };
        assert_eq!([up.event, down.event], [1, 0]);
        assert!(up.before.time < peak.time && peak.time < down.before.time && down.before.time - up.before.time < 1.0);
    }
    let rows = plain.points(&plain.instants(&Sampling::Interval(0.01), 100_000).unwrap());
    let dip = rows.windows(2).position(|pair| pair[1].loads.altitude > pair[0].loads.altitude).unwrap();
    let bottom = rows[dip].loads.altitude;
    let flight = fly(&Case { events: vec![mark(falls(Quantity::Altitude, bottom + 0.5))], ..skip() });
    let [event] = events(&flight)[..] else { panic!("the dip is missed") };
    assert!((event.before.time - rows[dip].time).abs() < 1.0, "{} s and {}", event.before.time, rows[dip].time);
}

/// A flight with an event is two flights, one after the other.
#[test]
fn a_flight_goes_on_as_another_one_from_the_event() {
    let condition = falls(Quantity::Mach, 0.9);
    for case in [capsule(), spherical(capsule())] {
        let whole = fly(&Case { events: vec![Event { when: condition.into(), then: parachute() }], ..case.clone() });
        let first = fly(&Case { stop: Stop { when: vec![condition.into()], ..Stop::default() }, ..case.clone() });
        assert_eq!(first.termination(), Termination::Condition(0));
        let [event] = events(&whole)[..] else { panic!("no parachute") };
        near("time", event.before.time, first.end_time(), 1e-9);
        let opened = Vehicle { mass: 2500.0, ..vehicle(2500.0, 100.0, 0.0, 0.7) };
        let second = fly(&Case { vehicle: opened, initial_state: first.last().flight_path.to_planet_fixed(), ..case });
        near("time", whole.end_time(), first.end_time() + second.end_time(), 1e-5);
        // Each is off by its own steps.
        assert!(miss(&whole, &second) < 1e-2, "{} m", miss(&whole, &second));
        relative("opening shock", event.after.loads.load_factor, second.initial().loads.load_factor, 1e-9);
        relative(
            "the shock is the peak",
            whole.peaks().load_factor.value,
            event.after.loads.load_factor.max(first.peaks().load_factor.value),
            1e-9,
        );
        assert!(event.after.loads.load_factor > 10.0 * event.before.loads.load_factor);
        // The row of the instant is that of what follows.
        let row = whole.at(event.before.time);
        assert_eq!(row.loads.load_factor.to_bits(), event.after.loads.load_factor.to_bits());
        relative("mass", whole.last().mass, 2500.0, 1e-15);
        relative("mass", whole.initial().mass, 3000.0, 1e-15);
    }
}

#[test]
fn events_of_one_instant_happen_in_the_order_of_their_list() {
    let mass = |mass: f64| Effect { mass: Some(mass), ..Effect::default() };
    // Five ways to the same instant: by the time, twice by an altitude that is passed then, and by what the first ones make of the loads.
    let plain = fly(&capsule());
    let then = plain.at(200.0);
    let altitude = then.loads.altitude;
    let list = vec![
        Event { when: rises(Quantity::LoadFactor, then.loads.load_factor * 1.5).into(), then: mass(1.0) },
        Event { when: falls(Quantity::Altitude, altitude).into(), then: mass(2000.0) },
        Event { when: falls(Quantity::Altitude, altitude).into(), then: mass(1000.0) },
        mark(rises(Quantity::LoadFactor, then.loads.load_factor * 2.9)),
        mark(rises(Quantity::LoadFactor, then.loads.load_factor * 3.1)),
    ];
    let flight = fly(&Case { events: list, stop: Stop { time: 201.0, ..Stop::default() }, ..capsule() });
    let happened = events(&flight);
    // The first makes the second's load, of which the list's first is due then: after the one before it has happened.
    assert_eq!(happened.iter().map(|event| event.event).collect::<Vec<_>>(), [1, 0, 2, 3, 4]);
    let masses: Vec<_> = happened.iter().map(|event| event.after.mass).collect();
    assert_eq!(masses, [2000.0, 1.0, 1000.0, 1000.0, 1000.0]);
    assert!(happened.iter().all(|event| event.before.time.to_bits() == happened[0].before.time.to_bits()));
    near("the instant", happened[0].before.time, 200.0, 1e-4);
}

#[test]
fn what_holds_at_the_start_must_come_back_first() {
    let plain = skip();
    let start = fly(&plain).initial();
    let happened = |events: Vec<Event>| {
        let flight = fly(&Case { events, ..skip() });
        flight.events().map(|event| (event.event, event.before.time)).collect::<Vec<_>>()
    };
    let altitude = start.loads.altitude;
    // It starts sinking at 122 km: below 200 km already, on its own altitude and going down, and above 100 km.
    assert_eq!(happened(vec![mark(falls(Quantity::Altitude, 200e3))]), []);
    assert_eq!(happened(vec![mark(falls(Quantity::Altitude, altitude))]), [(0, 0.0)]);
    assert_eq!(happened(vec![mark(rises(Quantity::Altitude, altitude))]), []);
    assert_eq!(happened(vec![mark(rises(Quantity::Time, 0.0))]), [(0, 0.0)]);
    // It starts below 50°, and above -50°: what it passes on its way, it passes once each way, downwards first.
    let level = FlightPath { flight_path_angle: -0.1, ..FlightPath::from_planet_fixed(&skip().initial_state) };
    let through = |events: Vec<Event>| {
        let flight = fly(&Case { events, initial_state: level.to_planet_fixed(), ..skip() });
        flight.events().map(|event| event.event).collect::<Vec<_>>()
    };
    let [below, above] = [falls, rises].map(|passes| mark(passes(Quantity::FlightPathAngle, -0.2)));
    assert_eq!(through(vec![above.clone(), below.clone()]), [1, 0]);
    assert_eq!(
        through(vec![mark(rises(Quantity::FlightPathAngle, -0.11))]).len(),
        1,
        "it begins beyond, and comes back"
    );
}

#[test]
fn an_event_happens_once_whatever_its_effect_does() {
    // Each undoes its condition, and those of the others.
    let list = vec![
        Event { when: falls(Quantity::Speed, 2500.0).into(), then: push(ThrustAxis::Velocity, 200.0) },
        Event { when: rises(Quantity::Speed, 2600.0).into(), then: push(ThrustAxis::Velocity, -200.0) },
        Event { when: falls(Quantity::Speed, 2000.0).into(), then: push(ThrustAxis::Radial, 2000.0) },
    ];
    for case in [skip(), spherical(skip())] {
        let flight = fly(&Case { events: list.clone(), ..case });
        let happened = events(&flight);
        assert_eq!(happened.iter().map(|event| event.event).collect::<Vec<_>>(), [0, 1, 2], "{happened:?}");
        assert_eq!(
            happened[0].before.time.to_bits(),
            happened[1].before.time.to_bits(),
            "the first sets off the second"
        );
        near("and back", happened[1].after.flight_path.speed, 2500.0, 1e-9);
        let climbs = |point: &FlightPoint| point.flight_path.speed * point.flight_path.flight_path_angle.sin();
        near("pushed up", climbs(&happened[2].after) - climbs(&happened[2].before), 2000.0, 1e-6);
        assert!(flight.peaks().altitude.value > 100e3, "it climbs again");
        assert_eq!(flight.termination(), Termination::SurfaceImpact);
    }
}

#[test]
fn a_flight_ends_at_its_ceiling_and_at_its_conditions() {
    let up = FlightPath {
        radius: 6_398_137.0,
        speed: 4000.0,
        flight_path_angle: 0.8,
        ..FlightPath::from_planet_fixed(&skip().initial_state)
    };
    let thrown = Case { initial_state: up.to_planet_fixed(), ..in_vacuum(skip()) };
    let with = |ceiling: Option<f64>, when: Vec<Condition>, events: Vec<Event>| {
        let when = when.into_iter().map(Trigger::from).collect();
        fly(&Case { stop: Stop { ceiling, when, ..Stop::default() }, events, ..thrown.clone() })
    };
    let apex = with(None, vec![], vec![]).peaks().altitude.value;
    let out = with(Some(100e3), vec![], vec![]);
    assert_eq!(out.termination(), Termination::AtmosphereExit);
    near("ceiling", out.last().loads.altitude, 100e3, 1e-6);
    assert_eq!(with(Some(apex + 1.0), vec![], vec![]).termination(), Termination::SurfaceImpact);
    assert_eq!(with(Some(apex - 1.0), vec![], vec![]).termination(), Termination::AtmosphereExit);
    // From above, a ceiling is passed on the way down, and ends nothing.
    assert_eq!(
        fly(&Case { stop: Stop { ceiling: Some(100e3), ..Stop::default() }, ..skip() }).termination(),
        Termination::SurfaceImpact
    );
    let apex_condition = falls(Quantity::FlightPathAngle, 0.0);
    let level = with(None, vec![rises(Quantity::Speed, 1e5), apex_condition, apex_condition], vec![]);
    assert_eq!(level.termination(), Termination::Condition(1));
    near("apex", level.last().loads.altitude, apex, 1e-3);
    // What happens at the end happens, and the end sees it; the end comes all the same.
    let stop = rises(Quantity::Time, 10.0);
    let pushed = with(None, vec![stop], vec![Event { when: stop.into(), then: push(ThrustAxis::Velocity, 500.0) }]);
    assert_eq!((pushed.termination(), events(&pushed).len()), (Termination::Condition(0), 1));
    let [event] = events(&pushed)[..] else { unreachable!() };
    assert_eq!(pushed.last().flight_path.speed.to_bits(), event.after.flight_path.speed.to_bits());
    near("pushed", event.after.flight_path.speed - event.before.flight_path.speed, 500.0, 1e-9);
    // What is felt at the end counts.
    let mach = falls(Quantity::Mach, 0.9);
    let stop = Stop { when: vec![mach.into()], ..Stop::default() };
    let opened = fly(&Case { events: vec![Event { when: mach.into(), then: parachute() }], stop, ..capsule() });
    assert_eq!(opened.peaks().load_factor.value.to_bits(), opened.last().loads.load_factor.to_bits());
    assert!(opened.last().loads.load_factor > 10.0);
    // On the ground, both at once.
    let landed = fly(&Case { events: vec![mark(falls(Quantity::Altitude, 0.0))], ..skip() });
    assert_eq!((landed.termination(), events(&landed).len()), (Termination::SurfaceImpact, 1));
    assert_eq!(events(&landed)[0].before.time.to_bits(), landed.end_time().to_bits());
    // At the start.
    let at_once = with(None, vec![rises(Quantity::Time, 0.0)], vec![]);
    assert_eq!((at_once.termination(), at_once.end_time().to_bits()), (Termination::Condition(0), 0));
    assert_eq!(at_once.instants(&Sampling::Count(5), 10).unwrap(), [0.0]);
}

/// The end alone is that of the recorded flight, to the last digit, alone or beside others.
#[test]
fn arrivals_with_events_are_the_ends_of_the_flights() {
    let list = vec![
        Event { when: falls(Quantity::Mach, 0.9).into(), then: parachute() },
        mark(rises(Quantity::LoadFactor, 3.0)),
    ];
    let cases = [
        Case { events: list, ..capsule() },
        capsule(),
        Case {
            stop: Stop { ceiling: Some(3e5), when: vec![falls(Quantity::Speed, 300.0).into()], ..Stop::default() },
            ..capsule()
        },
    ];
    let scenarios: Vec<_> = cases.iter().map(|case| Scenario::new(case.clone()).unwrap()).collect();
    let never = AtomicBool::new(false);
    let in_lanes = ends_of_all(&scenarios, &never);
    for ((scenario, case), in_lanes) in scenarios.iter().zip(&cases).zip(in_lanes) {
        let flight = fly(case);
        for end in [arrival(scenario, &never).unwrap(), *in_lanes.unwrap().arrival()] {
            assert_eq!(end.time.to_bits(), flight.end_time().to_bits());
            assert_eq!((end.state, end.termination), (flight.arrival().state, flight.termination()));
        }
    }
}

#[test]
fn errors_shrink_with_the_tolerance_across_events() {
    let case = Case { events: vec![Event { when: falls(Quantity::Mach, 1.4).into(), then: parachute() }], ..capsule() };
    let exact = fly(&with_tolerance(case.clone(), 1e-14));
    let off = |tolerance: f64| miss(&fly(&with_tolerance(case.clone(), tolerance)), &exact);
    assert!(off(1e-10) < 0.1 && off(1e-12) < 1e-3, "{} m and {} m", off(1e-10), off(1e-12));
    assert!(off(1e-5) > 10.0 * off(1e-10), "the test cannot tell: {} m", off(1e-5));
}

#[test]
fn faults_of_events_name_their_place() {
    let faults = |case: Case| -> Vec<String> {
        let ScenarioError(faults) = Scenario::new(case).unwrap_err();
        faults
            .iter()
            .map(|fault| match fault {
                Fault::OutOfBounds { field, .. } | Fault::NoTemperature { field } => field.to_string(),
                Fault::TimeFalls { field } => field.clone(),
                other => other.to_string(),
            })
            .collect()
    };
    let numbers = vec![
        mark(rises(Quantity::Mach, -1.0)),
        Event {
            when: rises(Quantity::FlightPathAngle, 2.0).into(),
            then: Effect {
                mass: Some(0.0),
                reference_area: Some(-1.0),
                impulse: Some(Impulse { along: ThrustAxis::Radial, speed_change: 2e6 }),
                ..Effect::default()
            },
        },
    ];
    let stop = Stop { ceiling: Some(f64::NAN), when: vec![rises(Quantity::Time, 1e10).into()], ..Stop::default() };
    assert_eq!(
        faults(Case { events: numbers, stop, ..skip() }),
        [
            "stop.ceiling",
            "events.0.when.value",
            "events.1.when.value",
            "stop.when.0.value",
            "events.1.then.mass",
            "events.1.then.reference_area",
            "events.1.then.impulse.speed_change"
        ]
    );
    let stop = Stop { ceiling: Some(-5.0), when: vec![falls(Quantity::Time, 10.0).into()], ..Stop::default() };
    assert_eq!(
        faults(Case { events: vec![mark(rises(Quantity::Mach, 1.0))], stop, ..target_2() }),
        ["events.0.when.quantity", "stop.when.0.falls_through", "must be greater than the stop altitude, 0 m, got -5"]
    );
}
