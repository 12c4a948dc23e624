//! Parachutes: an integration of the tests' own, the load of the opening, and what deploys and releases them.

use std::sync::atomic::AtomicBool;

use nalgebra::Vector3;
use reentry::coordinates::Inertial;
use reentry::event::{Condition, Direction, Effect, Event, Quantity, Trigger};
use reentry::parachute::Parachute;
use reentry::propulsion::{STANDARD_GRAVITY, Thrust, ThrustAxis};
use reentry::scenario::{Bound, Fault, ScenarioError};
use reentry::trajectory::Warning;
use reentry::vehicle::MachTable;
use reentry::verification::verify;
use reentry::{Aerodynamics, Atmosphere, Case, Control, FlightPath, Planet, Scenario, Stop, Vehicle, Wind};

use crate::check::{near, relative};
use crate::core::flights::{fly, miss, spherical, target_2, vehicle, with_tolerance};
use crate::core::propulsion::{at, switch_on};

/// A capsule of 1500 kg, which falls at 40° through the air of the thesis.
fn capsule() -> Case {
    let start = FlightPath {
        radius: 6_378_137.0 + 12e3,
        longitude: 0.3,
        geocentric_latitude: 0.4,
        speed: 220.0,
        flight_path_angle: -0.7,
        heading: 0.5,
    };
    Case {
        atmosphere: Atmosphere::EARTH_JAMESON,
        vehicle: vehicle(1500.0, 4.0, 0.0, 1.2),
        control: Control::banked(0.0),
        initial_state: start.to_planet_fixed(),
        stop: Stop { time: 20.0, ..Stop::default() },
        ..target_2()
    }
}

const DROGUE: Parachute = Parachute { drag_area: 60.0, inflation_time: 1.0, delay: 0.0 };

fn deploy(parachute: Parachute) -> Effect {
    Effect { deploy: Some(parachute), ..Effect::default() }
}

fn release(parachutes: &[usize]) -> Effect {
    Effect { release: parachutes.to_vec(), ..Effect::default() }
}

fn falls(quantity: Quantity, value: f64) -> Trigger {
    Condition { quantity, value, direction: Direction::Falling }.into()
}

/// The end of a fall in the thesis's air, and the greatest load factor on the way from a time, with the time of that.
struct Fall {
    position: Vector3<f64>,
    speed: f64,
    load: f64,
    load_at: f64,
}

/// Runge and Kutta's fourth-order method in inertial space, with parachutes that are deployed at given times, to an end; `steps` of
/// equal length between the instants at which one of them begins to fill or is full.
fn fall(case: &Case, parachutes: &[(f64, Parachute)], end: f64, steps: u32) -> Fall {
    let planet = case.planet;
    let turning = Vector3::z() * planet.rotation_rate;
    let Aerodynamics::Constant { drag_coefficient, .. } = case.vehicle.aerodynamics else { unreachable!() };
    let area = |time: f64| {
        let of = |(deployed, Parachute { drag_area, inflation_time, delay }): &(f64, Parachute)| {
            let filled = time - deployed - delay;
            match filled {
                _ if filled < 0.0 => 0.0,
                _ if filled < *inflation_time => drag_area * (filled / inflation_time).powi(2),
                _ => *drag_area,
            }
        };
        case.vehicle.reference_area * drag_coefficient + parachutes.iter().map(of).sum::<f64>()
    };
    let drag = |[position, velocity]: &[Vector3<f64>; 2], time: f64| {
        let relative = velocity - turning.cross(position);
        let density = 1.547_93 * (-(position.norm() - 6_378_137.0) / 6935.0).exp();
        relative * (-0.5 * density * relative.norm() * area(time) / case.vehicle.mass)
    };
    let rates = |state: &[Vector3<f64>; 2], time: f64| {
        let gravity = state[0] * (-planet.gravitational_parameter / state[0].norm().powi(3));
        [state[1], gravity + drag(state, time)]
    };
    let corners = parachutes.iter().flat_map(|(deployed, parachute)| {
        let opens = deployed + parachute.delay;
        [opens, opens + parachute.inflation_time]
    });
    let mut corners: Vec<f64> = corners.filter(|corner| *corner < end).chain([end]).collect();
    corners.sort_by(f64::total_cmp);
    let start = Inertial::from_planet_fixed(&case.initial_state, &planet, 0.0);
    let mut state = [start.position, start.velocity];
    let (mut from, mut load, mut load_at) = (0.0, 0.0, 0.0);
    for corner in corners {
        if corner <= from {
            continue;
        }
        let h = (corner - from) / f64::from(steps);
        for step in 0..steps {
            // A little inside the piece, so that its own formula holds at both ends.
            let within = |time: f64| time.clamp(from + 1e-12, corner - 1e-12);
            let time = from + h * f64::from(step);
            let moved = |rate: &[Vector3<f64>; 2], h: f64| [state[0] + rate[0] * h, state[1] + rate[1] * h];
            let one = rates(&state, within(time));
            let two = rates(&moved(&one, h / 2.0), within(time + h / 2.0));
            let three = rates(&moved(&two, h / 2.0), within(time + h / 2.0));
            let four = rates(&moved(&three, h), within(time + h));
            let now = drag(&state, within(time)).norm();
            if now > load {
                (load, load_at) = (now, time);
            }
            state = [0, 1].map(|i| state[i] + (one[i] + (two[i] + three[i]) * 2.0 + four[i]) * (h / 6.0));
        }
        from = corner;
    }
    let relative = state[1] - turning.cross(&state[0]);
    let last = Inertial { position: state[0], velocity: state[1] };
    let position = last.to_planet_fixed(&planet, end).position;
    Fall { position, speed: relative.norm(), load: load / STANDARD_GRAVITY, load_at }
}

/// The end of the flight and the load of the opening, by either formulation, of one parachute and of several at once.
#[test]
fn parachutes_open_as_in_an_integration_of_their_own() {
    let main = Parachute { drag_area: 300.0, inflation_time: 3.0, delay: 0.5 };
    let cases: [&[(f64, Parachute)]; 6] = [
        &[(4.0, Parachute { inflation_time: 0.0, ..DROGUE })],
        &[(4.0, DROGUE)],
        &[(4.0, Parachute { inflation_time: 3.0, ..DROGUE })],
        &[(4.0, Parachute { inflation_time: 3.0, delay: 1.5, ..DROGUE })],
        // The second is deployed while the first fills.
        &[(4.0, Parachute { inflation_time: 3.0, ..DROGUE }), (5.0, main)],
        &[(0.0, Parachute { inflation_time: 40.0, ..DROGUE }), (4.0, DROGUE), (4.0, DROGUE)],
    ];
    for parachutes in cases {
        let events = parachutes.iter().map(|(time, parachute)| at(*time, deploy(*parachute))).collect();
        let case = Case { events, ..capsule() };
        let expected = fall(&case, parachutes, 20.0, 20_000);
        for case in [with_tolerance(case.clone(), 1e-12), spherical(with_tolerance(case, 1e-12))] {
            let flight = fly(&case);
            let last = flight.last();
            let off = (last.flight_path.to_planet_fixed().position - expected.position).norm();
            // Steps of a millisecond, of fourth order, and the rounding of an inertial place.
            assert!(off < 1e-5, "{parachutes:?}: {off} m");
            relative("speed", last.flight_path.speed, expected.speed, 1e-8);
            let peak = flight.peaks().load_factor;
            // A sample a millisecond from the peak is below it by a part of 1e-6; a jump is met exactly.
            relative(&format!("{parachutes:?}: load"), peak.value, expected.load, 2e-6);
            near(&format!("{parachutes:?}: its time"), peak.time, expected.load_at, 2e-3);
        }
    }
}

/// The faster a canopy fills, the nearer is the flight to one whose parachute opens at once, and its load to that of the jump.
#[test]
fn a_fast_inflation_tends_to_an_opening_at_once() {
    let with = |inflation_time: f64| {
        let events = vec![at(4.0, deploy(Parachute { inflation_time, ..DROGUE }))];
        fly(&with_tolerance(Case { events, ..capsule() }, 1e-12))
    };
    let at_once = with(0.0);
    for inflation_time in [1e-2, 1e-4, 1e-6, 1e-9] {
        let flight = with(inflation_time);
        // For a third of the time the canopy is as good as not there: at 150 m/s.
        assert!(
            miss(&flight, &at_once) < 200.0 * inflation_time + 1e-6,
            "{inflation_time}: {}",
            miss(&flight, &at_once)
        );
        let loads = [&flight, &at_once].map(|flight| flight.peaks().load_factor.value);
        // The instants are rounded to 9e-16 s, a part of 1e-6 of the shortest inflation.
        assert!(loads[0] <= loads[1] * (1.0 + 1e-6), "{inflation_time}: {loads:?}");
        relative("load", loads[0], loads[1], 3.0 * inflation_time + 1e-6);
    }
    // A time that is less than the rounding of the instant is none.
    assert!(miss(&with(1e-300), &at_once) < 1e-9);
}

/// Opened at once, a parachute is a vehicle of a greater drag area; released, it is the old one again.
#[test]
fn a_full_parachute_is_a_greater_drag_area() {
    let open = Parachute { inflation_time: 0.0, ..DROGUE };
    let by_parachute = vec![
        at(3.0, deploy(open)),
        at(5.0, deploy(Parachute { drag_area: 6.0, ..open })),
        at(8.0, release(&[0])),
        at(12.0, release(&[1])),
    ];
    let areas = [(3.0, 64.8), (5.0, 70.8), (8.0, 10.8), (12.0, 4.8)];
    let area = |drag_area: f64| Effect { reference_area: Some(drag_area / 1.2), ..Effect::default() };
    let by_area = areas.map(|(time, drag_area)| at(time, area(drag_area))).to_vec();
    for case in [capsule(), spherical(capsule())] {
        let [one, other] =
            [&by_parachute, &by_area].map(|events| fly(&Case { events: events.clone(), ..case.clone() }));
        assert!(miss(&one, &other) < 1e-6, "{} m", miss(&one, &other));
        let [one, other] = [one, other].map(|flight| flight.peaks().load_factor.value);
        relative("load", one, other, 1e-12);
    }
}

/// The drag area adds to m/β of a ballistic vehicle, whatever its mass becomes, and to the coefficients of a table.
#[test]
fn a_parachute_adds_to_every_kind_of_aerodynamics() {
    let thrust =
        Thrust { along: ThrustAxis::Velocity, force: -4000.0, specific_impulse: Some(200.0), propellant: Some(10.0) };
    let events = vec![
        at(2.0, deploy(Parachute { inflation_time: 4.0, ..DROGUE })),
        at(3.0, switch_on(thrust)),
        at(9.0, Effect { mass: Some(900.0), ..Effect::default() }),
    ];
    let constant = Case { events, atmosphere: Atmosphere::Us76, ..capsule() };
    let by = |aerodynamics: Aerodynamics| {
        fly(&Case { vehicle: Vehicle { aerodynamics, ..constant.vehicle.clone() }, ..constant.clone() })
    };
    let expected = fly(&constant);
    let ballistic = by(Aerodynamics::Ballistic { ballistic_coefficient: 1500.0 / 4.8, lift_to_drag: 0.0 });
    assert!(miss(&ballistic, &expected) < 1e-6, "{} m", miss(&ballistic, &expected));
    let table = MachTable::new(&[0.1, 3.0], &[0.0, 0.0], &[1.2, 1.2]).unwrap();
    let table = by(Aerodynamics::MachTable(table.into()));
    assert!(miss(&table, &expected) < 1e-3, "{} m", miss(&table, &expected));
    relative("load", ballistic.peaks().load_factor.value, expected.peaks().load_factor.value, 1e-12);
    // Without a drag of its own, the vehicle has that of the parachute alone.
    let alone = fly(&Case { vehicle: vehicle(1500.0, 0.0, 0.0, 1.2), ..constant.clone() });
    assert!(alone.last().loads.load_factor > 0.1 && miss(&alone, &expected) > 1.0);
}

/// In wind, over the ellipsoid, with lift: the twin formulations agree, energy is balanced, and a finer flight is where it was.
#[test]
fn parachutes_keep_the_balance_of_energy() {
    let events = vec![
        at(2.0, deploy(Parachute { inflation_time: 3.0, delay: 0.3, ..DROGUE })),
        Event { when: falls(Quantity::Altitude, 9e3), then: release(&[0]) },
        Event {
            when: falls(Quantity::Altitude, 8.9e3),
            then: deploy(Parachute { drag_area: 400.0, inflation_time: 5.0, delay: 0.0 }),
        },
    ];
    let case = Case {
        planet: Planet::EARTH_WGS84,
        atmosphere: Atmosphere::Us76,
        wind: Wind::Constant { east: 20.0, north: -8.0 },
        vehicle: vehicle(1500.0, 4.0, 0.3, 1.2),
        events,
        stop: Stop::default(),
        ..capsule()
    };
    let flight = fly(&case);
    assert_eq!(flight.events().count(), 3);
    let verification = verify(&Scenario::new(case.clone()).unwrap(), &flight, &AtomicBool::new(false)).unwrap();
    assert!(verification.energy_drift < 1e-7 * verification.drag_work.abs(), "{verification:?}");
    assert!(verification.distance < 1e-2, "{verification:?}");
    assert!(miss(&flight, &fly(&spherical(case.clone()))) < 1e-2);
    // On its canopy it sinks at √(2mg/(ρ C_D S)), and drifts with the wind.
    let last = flight.last();
    let sinks = f64::sqrt(2.0 * 1500.0 * 9.79 / (1.225 * 404.8));
    let rate = -last.flight_path.speed * last.flight_path.flight_path_angle.sin();
    relative("sinks", rate, sinks, 0.01);
    let level = last.flight_path.speed * last.flight_path.flight_path_angle.cos();
    relative("drifts", level, 20.0_f64.hypot(8.0), 0.02);
}

/// The peak of a fast inflation lies inside it, between a flight that decelerates less and less and one that does again.
#[test]
fn the_peak_of_the_opening_is_found_inside_it() {
    let parachute = Parachute { drag_area: 300.0, inflation_time: 6.0, delay: 0.0 };
    for tolerance in [1e-5, 1e-10] {
        let case = with_tolerance(Case { events: vec![at(1.0, deploy(parachute))], ..capsule() }, tolerance);
        let flight = fly(&case);
        let peak = flight.peaks().load_factor;
        let instants = (0..=60_000).map(|step| 1.0 + f64::from(step) * 1e-4);
        let sampled = instants.map(|time| flight.at(time).loads.load_factor).fold(0.0, f64::max);
        assert!(peak.time > 1.5 && peak.time < 6.5, "{peak:?}");
        // The slope that locates the peak is that of the equations, which the dense output has to the tolerance.
        assert!(peak.value >= sampled - 1e-7 * sampled, "{} below {sampled}", peak.value);
        relative("peak", peak.value, sampled, 1e-6);
    }
}

/// Released before it is deployed, or twice, a parachute stays as it is, with a warning; released before it fills, it never does.
#[test]
fn a_release_of_what_is_not_deployed_is_told() {
    let plain = fly(&capsule());
    let early = vec![at(2.0, release(&[1])), at(4.0, deploy(DROGUE)), at(6.0, release(&[1])), at(7.0, release(&[1]))];
    let flight = fly(&Case { events: early, ..capsule() });
    assert!(
        matches!(
            flight.warnings(),
            [
                Warning::NotDeployed { event: 0, parachute: 1, time: 2.0 },
                Warning::NotDeployed { event: 3, parachute: 1, time: 7.0 }
            ]
        ),
        "{:?}",
        flight.warnings()
    );
    let once = fly(&Case { events: vec![at(4.0, deploy(DROGUE)), at(6.0, release(&[0]))], ..capsule() });
    assert!(miss(&flight, &once) < 1e-6);
    let unopened = vec![at(4.0, deploy(Parachute { delay: 2.0, ..DROGUE })), at(5.0, release(&[0]))];
    let unopened = fly(&Case { events: unopened, ..capsule() });
    assert!(unopened.warnings().is_empty() && miss(&unopened, &plain) < 1e-6);
    // One event may change parachutes: it cuts one off and deploys another.
    let changes = Effect { release: vec![0], ..deploy(Parachute { drag_area: 200.0, ..DROGUE }) };
    let changed = fly(&Case { events: vec![at(3.0, deploy(DROGUE)), at(6.0, changes)], ..capsule() });
    assert!(changed.warnings().is_empty());
    let open = |area: f64, load: f64, speed: f64| area * load * speed * speed;
    let last = changed.last();
    relative(
        "drag of one canopy",
        last.loads.load_factor * STANDARD_GRAVITY * 1500.0,
        open(204.8, last.loads.density / 2.0, last.loads.air_speed),
        1e-12,
    );
}

#[test]
fn faults_of_parachutes_name_their_place() {
    let faults = |events: Vec<Event>| {
        let ScenarioError(faults) = Scenario::new(Case { events, ..capsule() }).unwrap_err();
        faults
    };
    let wrong = Parachute { drag_area: -1.0, inflation_time: 1e10, delay: f64::NAN };
    let fields = faults(vec![at(1.0, deploy(wrong))]).into_iter().map(|fault| match fault {
        Fault::OutOfBounds { field, bound, .. } => (field.into_owned(), bound),
        other => panic!("{other}"),
    });
    let expected = [("drag_area", Bound::DRAG_AREA), ("inflation_time", Bound::TIME), ("delay", Bound::TIME)];
    assert!(fields.eq(expected.map(|(name, bound)| (format!("events.0.then.deploy.{name}"), bound))));
    let unknown = faults(vec![at(1.0, deploy(DROGUE)), at(2.0, release(&[0, 1, 7]))]);
    let places = ["events.1.then.release.1", "events.1.then.release.2"];
    assert!(
        unknown
            .iter()
            .zip(places)
            .all(|(fault, place)| matches!(fault, Fault::NoParachute { field, .. } if field == place))
            && unknown.len() == 2,
        "{unknown:?}"
    );
    let thrust = Thrust { along: ThrustAxis::Radial, force: 1.0, specific_impulse: None, propellant: Some(1.0) };
    let unburnt = faults(vec![at(1.0, switch_on(thrust))]);
    assert!(
        matches!(&unburnt[..], [Fault::PropellantUnused { field }] if field == "events.0.then.thrust.propellant"),
        "{unburnt:?}"
    );
}
