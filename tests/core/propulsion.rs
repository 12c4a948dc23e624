//! Impulses and thrust: the rocket equation, the balance of energy, vis-viva, and an integration of the tests' own in inertial space.

use std::sync::atomic::AtomicBool;

use nalgebra::Vector3;
use reentry::coordinates::{Inertial, OrbitalElements};
use reentry::event::{Condition, Direction, Effect, Event, Quantity, ThrustCommand};
use reentry::planet::Shape;
use reentry::propulsion::{Impulse, STANDARD_GRAVITY, Thrust, ThrustAxis};
use reentry::simulate::SimulationError;
use reentry::trajectory::{Termination, Warning};
use reentry::verification::verify;
use reentry::{
    Aerodynamics, Atmosphere, Case, Control, FlightPath, Planet, PlanetFixed, Scenario, Solver, Stop, Vehicle, Wind,
};

use crate::check::{near, relative};
use crate::core::flights::{fly, in_vacuum, miss, spherical, target_2, try_to_fly, vehicle, with_tolerance};

const THRUST: Thrust =
    Thrust { along: ThrustAxis::Velocity, force: -20_000.0, specific_impulse: Some(300.0), propellant: None };

pub(crate) fn at(time: f64, then: Effect) -> Event {
    let when = Condition { quantity: Quantity::Time, value: time, direction: Direction::Rising };
    Event { when: when.into(), then }
}

pub(crate) fn switch_on(thrust: Thrust) -> Effect {
    Effect { thrust: Some(ThrustCommand::On(thrust)), ..Effect::default() }
}

pub(crate) fn switch_off() -> Effect {
    Effect { thrust: Some(ThrustCommand::Off), ..Effect::default() }
}

fn push(along: ThrustAxis, speed_change: f64) -> Effect {
    Effect { impulse: Some(Impulse { along, speed_change }), ..Effect::default() }
}

/// 300 km up, at circular speed, over an Earth that does not turn.
fn orbit() -> Case {
    let radius: f64 = 6_678_137.0;
    let planet = Planet { rotation_rate: 0.0, ..Planet::EARTH_WGS84.spherical() };
    let start = FlightPath {
        radius,
        longitude: 0.2,
        geocentric_latitude: 0.3,
        speed: (planet.gravitational_parameter / radius).sqrt(),
        flight_path_angle: 0.0,
        heading: 0.5,
    };
    Case {
        planet,
        vehicle: vehicle(5000.0, 10.0, 0.0, 1.2),
        control: Control::banked(0.0),
        initial_state: start.to_planet_fixed(),
        stop: Stop { time: 600.0, ..Stop::default() },
        ..in_vacuum(target_2())
    }
}

/// Where nothing else acts.
fn empty_space() -> Case {
    let planet = Planet { gravitational_parameter: 1e-6, orbital_gravitational_parameter: 1e-6, ..orbit().planet };
    Case { planet, ..orbit() }
}

fn elements(case: &Case, state: &PlanetFixed<f64>) -> OrbitalElements {
    let inertial = Inertial::from_planet_fixed(state, &case.planet, 0.0);
    OrbitalElements::from_inertial(&inertial, case.planet.gravitational_parameter).unwrap().0
}

/// Tsiolkovsky: Δv = g₀ `I_sp` ln(m₀/m), along each direction; ahead and outward the way is straight.
#[test]
fn thrust_changes_the_speed_by_the_rocket_equation() {
    let seconds = 500.0;
    for (along, direction) in [(ThrustAxis::Velocity, 1.0), (ThrustAxis::Velocity, -1.0), (ThrustAxis::Radial, 1.0)] {
        let thrust = Thrust { along, force: direction * 20_000.0, ..THRUST };
        let mut case = empty_space();
        if along == ThrustAxis::Radial {
            let rising = FlightPath {
                flight_path_angle: std::f64::consts::FRAC_PI_2,
                ..FlightPath::from_planet_fixed(&case.initial_state)
            };
            case.initial_state = rising.to_planet_fixed();
        }
        let case = Case { events: vec![at(50.0, switch_on(thrust)), at(50.0 + seconds, switch_off())], ..case };
        let [before, after] = [50.0, 550.0].map(|time| fly(&case).at(time));
        let mass = 5000.0 - seconds * 20_000.0 / (300.0 * STANDARD_GRAVITY);
        relative("mass", after.mass, mass, 1e-14);
        relative("the mass stays after", fly(&case).last().mass, mass, 1e-14);
        let change = direction * 300.0 * STANDARD_GRAVITY * (5000.0 / mass).ln();
        // A tolerance of 1e-10 in a handful of steps, of the speed of 7.7 km/s.
        near("speed", after.flight_path.speed - before.flight_path.speed, change, 1e-6);
        relative("load factor", before.loads.load_factor, 20_000.0 / 5000.0 / STANDARD_GRAVITY, 1e-12);
        relative(
            "and at the end",
            fly(&case).at(549.999_999).loads.load_factor,
            20_000.0 / mass / STANDARD_GRAVITY,
            1e-8,
        );
    }
}

/// Across the way, thrust turns it and leaves the speed: by the rocket equation's Δv over the speed.
#[test]
fn thrust_across_the_velocity_turns_it_to_the_left() {
    let start = FlightPath { radius: 1e12, ..FlightPath::from_planet_fixed(&orbit().initial_state) };
    let thrust = Thrust { along: ThrustAxis::Normal, force: 20_000.0, ..THRUST };
    let case =
        Case { initial_state: start.to_planet_fixed(), events: vec![at(0.0, switch_on(thrust))], ..empty_space() };
    let (first, last) = (fly(&case).initial(), fly(&case).last());
    let change = 300.0 * STANDARD_GRAVITY * (5000.0 / last.mass).ln();
    // So far out the level plane turns by 5e-6 on the way.
    relative("speed", last.flight_path.speed, first.flight_path.speed, 1e-9);
    near("heading", last.flight_path.heading - first.flight_path.heading, change / first.flight_path.speed, 1e-5);
}

fn every_axis() -> [ThrustAxis; 5] {
    [
        ThrustAxis::Velocity,
        ThrustAxis::Radial,
        ThrustAxis::Normal,
        ThrustAxis::Horizontal,
        ThrustAxis::inertial([3.0, -2.0, 1.5]).unwrap(),
    ]
}

/// Runge and Kutta's fourth-order method in inertial space, with the mass as a seventh number.
fn inertial_flight(case: &Case, thrust: Thrust, end: f64) -> (Vector3<f64>, f64) {
    let planet = case.planet;
    let turning = Vector3::z() * planet.rotation_rate;
    let rates = |[position, velocity]: [Vector3<f64>; 2], mass: f64| {
        let radius = position.norm();
        let relative = velocity - turning.cross(&position);
        let gravity = position * (-planet.gravitational_parameter / radius.powi(3));
        let density = 1.547_93 * (-(radius - 6_378_137.0) / 6935.0).exp();
        let Aerodynamics::Constant { drag_coefficient, .. } = case.vehicle.aerodynamics else { unreachable!() };
        let drag =
            relative * (-0.5 * density * relative.norm() * case.vehicle.reference_area * drag_coefficient / mass);
        let direction = match thrust.along {
            ThrustAxis::Velocity => relative.normalize(),
            ThrustAxis::Radial => position.normalize(),
            ThrustAxis::Normal => position.cross(&relative).normalize(),
            ThrustAxis::Horizontal => {
                let up = position.normalize();
                (relative - up * up.dot(&relative)).normalize()
            }
            // The frames are aligned at the start.
            ThrustAxis::Inertial(direction) => *direction,
        };
        [velocity, gravity + drag + direction * (thrust.force / mass)]
    };
    let flow = thrust.specific_impulse.map_or(0.0, |seconds| thrust.force.abs() / (seconds * STANDARD_GRAVITY));
    let start = Inertial::from_planet_fixed(&case.initial_state, &planet, 0.0);
    let (mut state, mut mass) = ([start.position, start.velocity], case.vehicle.mass);
    let steps = 20_000_u32;
    let h = end / f64::from(steps);
    let moved = |state: [Vector3<f64>; 2], rate: [Vector3<f64>; 2], time: f64| {
        [state[0] + rate[0] * time, state[1] + rate[1] * time]
    };
    for _ in 0..steps {
        let one = rates(state, mass);
        let two = rates(moved(state, one, h / 2.0), mass - flow * h / 2.0);
        let three = rates(moved(state, two, h / 2.0), mass - flow * h / 2.0);
        let four = rates(moved(state, three, h), mass - flow * h);
        for i in 0..2 {
            state[i] += (one[i] + (two[i] + three[i]) * 2.0 + four[i]) * (h / 6.0);
        }
        mass -= flow * h;
    }
    let inertial = Inertial { position: state[0], velocity: state[1] };
    (inertial.to_planet_fixed(&planet, end).position, mass)
}

#[test]
fn thrust_flies_as_in_an_integration_of_mass_and_motion_in_inertial_space() {
    let start = FlightPath {
        flight_path_angle: -0.1,
        radius: 6_500_000.0,
        ..FlightPath::from_planet_fixed(&orbit().initial_state)
    };
    let planet = Planet::EARTH_WGS84.spherical();
    for (along, specific_impulse) in every_axis().into_iter().zip([Some(300.0), None].into_iter().cycle()) {
        for force in [-15_000.0, 10_000.0] {
            let thrust = Thrust { along, force, specific_impulse, ..THRUST };
            let case = Case {
                planet,
                atmosphere: Atmosphere::EARTH_JAMESON,
                initial_state: start.to_planet_fixed(),
                events: vec![at(0.0, switch_on(thrust))],
                stop: Stop { time: 100.0, ..Stop::default() },
                ..orbit()
            };
            let (position, mass) = inertial_flight(&case, thrust, 100.0);
            for case in [with_tolerance(case.clone(), 1e-12), spherical(with_tolerance(case, 1e-12))] {
                let last = fly(&case).last();
                let off = (last.flight_path.to_planet_fixed().position - position).norm();
                // 20 000 steps of fourth order round to some 1e-6 m.
                assert!(off < 1e-4, "{along:?} {force}: {off} m");
                relative("mass", last.mass, mass, 1e-11);
            }
        }
    }
}

/// The formulations are the same, and the energy that thrust gives is there in the end.
#[test]
fn energy_is_balanced_under_thrust_and_impulses() {
    let start = FlightPath {
        flight_path_angle: -0.05,
        radius: 6_500_000.0,
        ..FlightPath::from_planet_fixed(&orbit().initial_state)
    };
    for along in every_axis() {
        let case = Case {
            planet: Planet::EARTH_WGS84,
            atmosphere: Atmosphere::Us76,
            initial_state: start.to_planet_fixed(),
            events: vec![
                at(10.0, switch_on(Thrust { along, propellant: Some(300.0), ..THRUST })),
                at(20.0, push(along, 50.0)),
                at(120.0, Effect { mass: Some(3000.0), reference_area: Some(8.0), ..Effect::default() }),
            ],
            stop: Stop { time: 3000.0, ..Stop::default() },
            ..orbit()
        };
        let verification = verify(&Scenario::new(case.clone()).unwrap(), &fly(&case), &AtomicBool::new(false)).unwrap();
        let scale = verification.drag_work.abs() + verification.thrust_work.abs();
        // The quadrature is on the dense output, at 1e-10.
        assert!(verification.energy_drift < 1e-8 * scale, "{along:?}: {verification:?}");
        assert!(verification.distance < 1.0, "{along:?}: {verification:?}");
        let works = verification.thrust_work;
        match along {
            ThrustAxis::Velocity | ThrustAxis::Horizontal => assert!(works < -1e5, "{along:?}: {works}"),
            ThrustAxis::Radial | ThrustAxis::Normal => assert!(works.abs() < 2e5, "{along:?}: {works}"),
            ThrustAxis::Inertial(_) => assert!(works.abs() > 1e4, "{along:?}: {works}"),
        }
        assert!(miss(&fly(&case), &fly(&spherical(case.clone()))) < 0.1, "{along:?}");
    }
}

/// Vis-viva: ahead on a circular orbit, Δv moves the other apsis alone; across, it tilts the orbit.
#[test]
fn impulses_change_the_orbit_as_the_textbooks_say() {
    let after = |effect: Effect| {
        let case = Case { events: vec![at(100.0, effect)], ..orbit() };
        let flight = fly(&case);
        let event = flight.events().next().unwrap();
        let state = event.after.flight_path.to_planet_fixed();
        (elements(&case, &state), event)
    };
    let (radius, mu): (f64, f64) = (6_678_137.0, orbit().planet.gravitational_parameter);
    let circular = (mu / radius).sqrt();
    let (retro, event) = after(push(ThrustAxis::Velocity, -100.0));
    let semi_major_axis = 1.0 / (2.0 / radius - (circular - 100.0).powi(2) / mu);
    relative("semi-major axis", retro.semi_latus_rectum() / (1.0 - retro.eccentricity.powi(2)), semi_major_axis, 1e-10);
    near("the burn is at the apoapsis", retro.true_anomaly, std::f64::consts::PI, 1e-6);
    near("speed", event.after.flight_path.speed - event.before.flight_path.speed, -100.0, 1e-9);
    assert_eq!(event.after.mass.to_bits(), event.before.mass.to_bits());
    let (tilted, event) = after(push(ThrustAxis::Normal, 200.0));
    relative(
        "speed",
        tilted.semi_latus_rectum(),
        (radius * (circular.powi(2) + 200.0_f64.powi(2)).sqrt()).powi(2) / mu,
        1e-10,
    );
    let turn = event.after.flight_path.heading - event.before.flight_path.heading;
    near("turned to the left", turn, (200.0 / circular).atan(), 1e-9);
    let (_, event) = after(push(ThrustAxis::Radial, 30.0));
    near("climb", event.after.flight_path.flight_path_angle, (30.0 / circular).atan(), 1e-9);
}

#[test]
fn thrust_ends_where_its_propellant_is_spent() {
    let thrust = Thrust { propellant: Some(100.0), ..THRUST };
    let burn = 100.0 / thrust.mass_flow();
    let limited = Case { events: vec![at(30.0, switch_on(thrust))], ..orbit() };
    let switched = Case { events: vec![at(30.0, switch_on(THRUST)), at(30.0 + burn, switch_off())], ..orbit() };
    let flight = fly(&limited);
    // Both end the burn at the same time, but for the rounding of its length: the steps are nearly the same.
    assert!(miss(&flight, &fly(&switched)) < 1e-4, "{} m", miss(&flight, &fly(&switched)));
    relative("mass", flight.last().mass, 4900.0, 1e-15);
    assert!(
        matches!(flight.warnings(), [Warning::PropellantSpent { time }] if (time - 30.0 - burn).abs() < 1e-9),
        "{:?}",
        flight.warnings()
    );
    // What happens during the burn leaves the rest to burn.
    let marked = Case {
        events: [limited.events.clone(), vec![at(35.0, Effect { reference_area: Some(5.0), ..Effect::default() })]]
            .concat(),
        ..limited
    };
    assert!(miss(&flight, &fly(&marked)) < 1e-2);
    relative("mass", fly(&marked).last().mass, 4900.0, 1e-15);
}

/// So little that its burn is less than the rounding of the time.
#[test]
fn propellant_for_no_time_at_all_is_spent_at_once() {
    let thrust = Thrust { propellant: Some(1e-20), ..THRUST };
    let flight = fly(&Case { events: vec![at(30.0, switch_on(thrust))], ..orbit() });
    assert!(matches!(flight.warnings(), [Warning::PropellantSpent { .. }]), "{:?}", flight.warnings());
    assert!(miss(&flight, &fly(&orbit())) < 1e-2);
}

#[test]
fn thrust_that_burns_the_whole_vehicle_is_an_error() {
    for propellant in [None, Some(1e6)] {
        let case = Case {
            events: vec![at(0.0, switch_on(Thrust { force: 20_000.0, propellant, ..THRUST }))],
            stop: Stop::default(),
            ..orbit()
        };
        let gone = 5000.0 / THRUST.mass_flow();
        for case in [
            case.clone(),
            Case { vehicle: Vehicle { mass: 1e-3, ..case.vehicle.clone() }, ..case.clone() },
            in_vacuum(spherical(case)),
        ] {
            let gone = gone * case.vehicle.mass / 5000.0;
            let error = try_to_fly(&case).unwrap_err();
            assert!(
                matches!(error, SimulationError::NothingLeft { time } if time <= gone && time > 0.9 * gone),
                "{error:?}"
            );
        }
    }
}

/// At rest there is no velocity, straight down nothing is across it.
#[test]
fn an_impulse_without_a_direction_does_nothing_and_says_so() {
    let still = FlightPath { speed: 0.0, ..FlightPath::from_planet_fixed(&orbit().initial_state) };
    let down = FlightPath { speed: 100.0, flight_path_angle: -std::f64::consts::FRAC_PI_2, ..still };
    for (start, along) in [
        (still, ThrustAxis::Velocity),
        (still, ThrustAxis::Normal),
        (still, ThrustAxis::Horizontal),
        (down, ThrustAxis::Normal),
        (down, ThrustAxis::Horizontal),
    ] {
        let plain = Case { initial_state: start.to_planet_fixed(), ..orbit() };
        let pushed = fly(&Case { events: vec![at(0.0, push(along, 10.0))], ..plain.clone() });
        assert!(
            matches!(pushed.warnings(), [Warning::NoDirection { event: 0, .. }]),
            "{along:?}: {:?}",
            pushed.warnings()
        );
        assert!(miss(&pushed, &fly(&plain)) < 1e-6);
    }
    let outward = fly(&Case {
        initial_state: still.to_planet_fixed(),
        events: vec![at(0.0, push(ThrustAxis::Radial, 10.0))],
        ..orbit()
    });
    assert!(outward.warnings().is_empty());
}

/// A lander 1 km above the Moon, which does not turn.
fn lander(speed: f64, flight_path_angle: f64) -> Case {
    let planet = Planet {
        gravitational_parameter: 4.9028e12,
        rotation_rate: 0.0,
        shape: Shape::Sphere { radius: MOON },
        ..Planet::EARTH_WGS84.spherical()
    };
    let start = FlightPath {
        radius: MOON + 1000.0,
        longitude: 0.1,
        geocentric_latitude: 0.2,
        speed,
        flight_path_angle,
        heading: 0.3,
    };
    Case {
        planet,
        vehicle: vehicle(15_000.0, 0.0, 0.0, 0.0),
        control: Control::banked(0.0),
        initial_state: start.to_planet_fixed(),
        stop: Stop { time: 3000.0, ..Stop::default() },
        ..in_vacuum(target_2())
    }
}

const MOON: f64 = 1_737_400.0;
const BRAKE: Thrust =
    Thrust { along: ThrustAxis::Velocity, force: -45_000.0, specific_impulse: Some(311.0), propellant: None };

/// A lander that a braking thrust, at once, brings to rest: when, and how high above the start; by Runge and Kutta's fourth-order method,
/// with steps of a hundredth of the time to rest.
fn braked_to_rest(case: &Case, thrust: Thrust) -> (f64, f64) {
    let rates = |[position, velocity]: [Vector3<f64>; 2], time: f64| {
        let mass = case.vehicle.mass - thrust.mass_flow() * time;
        let gravity = position * (-case.planet.gravitational_parameter / position.norm().powi(3));
        [velocity, gravity + velocity.normalize() * (thrust.force / mass)]
    };
    let PlanetFixed { position, velocity } = case.initial_state;
    let (mut state, mut time) = ([position, velocity], 0.0);
    while state[1].norm() > 1e-7 {
        let h = 0.01 * state[1].norm() / (thrust.force.abs() / case.vehicle.mass);
        let moved = |rate: [Vector3<f64>; 2], h: f64| [state[0] + rate[0] * h, state[1] + rate[1] * h];
        let one = rates(state, time);
        let two = rates(moved(one, h / 2.0), time + h / 2.0);
        let three = rates(moved(two, h / 2.0), time + h / 2.0);
        let four = rates(moved(three, h), time + h);
        state = [0, 1].map(|i| state[i] + (one[i] + (two[i] + three[i]) * 2.0 + four[i]) * (h / 6.0));
        time += h;
    }
    (time, state[0].norm() - position.norm())
}

/// A burn that brakes a lander to rest ends there, at once and by its name: its thrust has no direction any more.
#[test]
fn a_braking_burn_to_rest_ends_by_its_name() {
    let down = -std::f64::consts::FRAC_PI_2;
    let mut oblique = 0;
    for (speed, flight_path_angle) in [(20.0, down), (30.0, down + 0.3), (60.0, -0.7), (50.0, 0.0), (40.0, 0.8)] {
        let plain = lander(speed, flight_path_angle);
        let (time, climb) = braked_to_rest(&plain, BRAKE);
        let events = vec![at(0.0, Effect { mass: Some(15_000.0), ..Effect::default() }), at(0.0, switch_on(BRAKE))];
        let case = Case { events, solver: Solver { step_limit: 200, ..plain.solver }, ..plain };
        for tolerance in [1e-14, 1e-10, 1e-7, 1e-5] {
            let case = with_tolerance(case.clone(), tolerance);
            let ways = if (flight_path_angle - down).abs() < f64::EPSILON {
                vec![case]
            } else {
                vec![case.clone(), spherical(case)]
            };
            oblique += ways.len() - 1;
            for case in ways {
                let Err(SimulationError::NoDirection { event: 1, time: found, altitude }) = try_to_fly(&case) else {
                    panic!("{speed} m/s at {flight_path_angle}, {tolerance}: {:?}", try_to_fly(&case).map(|_| ()))
                };
                // Rest is where the steps resolve no more speed: a part of the circular speed of 1680 m/s, in a deceleration of 1 m/s².
                let off = 1e-4 + 1680.0 * tolerance;
                near("time", found, time, 10.0 * off);
                near("altitude", altitude, 1000.0 + climb, 100.0 * off);
            }
        }
    }
    assert!(oblique > 10);
}

/// In air, over a planet that turns, falling from high up: the thrust brakes as long as there is a direction.
#[test]
fn a_braking_burn_in_air_over_a_turning_planet_ends_at_rest() {
    let start = FlightPath {
        radius: 6_379_137.0,
        speed: 90.0,
        flight_path_angle: -1.2,
        ..FlightPath::from_planet_fixed(&orbit().initial_state)
    };
    let brake = Thrust { force: -80_000.0, ..BRAKE };
    for wind in [Wind::Still, Wind::Constant { east: 10.0, north: -5.0 }] {
        let case = Case {
            planet: Planet::EARTH_WGS84,
            atmosphere: Atmosphere::Us76,
            wind,
            initial_state: start.to_planet_fixed(),
            events: vec![at(0.0, switch_on(brake))],
            solver: Solver { step_limit: 300, ..orbit().solver },
            stop: Stop { altitude: -2e4, ..Stop::default() },
            ..orbit()
        };
        for case in [case.clone(), spherical(case.clone()), with_tolerance(case, 1e-4)] {
            let error = try_to_fly(&case).map(|_| ()).unwrap_err();
            assert!(matches!(error, SimulationError::NoDirection { event: 0, .. }), "{error:?}");
        }
    }
}

/// Rest is the place to switch the engine off: a condition on the speed 0 is met there.
#[test]
fn a_burn_may_end_where_the_vehicle_is_at_rest() {
    let plain = lander(20.0, -std::f64::consts::FRAC_PI_2);
    let (time, climb) = braked_to_rest(&plain, BRAKE);
    let when = Condition { quantity: Quantity::Speed, value: 0.0, direction: Direction::Falling }.into();
    let burning = vec![at(0.0, switch_on(BRAKE))];
    let stopped =
        fly(&Case { events: burning.clone(), stop: Stop { when: vec![when], ..Stop::default() }, ..plain.clone() });
    assert_eq!(stopped.termination(), Termination::Condition(0));
    near("time", stopped.end_time(), time, 1e-6);
    near("speed", stopped.last().flight_path.speed, 0.0, 0.0);
    let off = vec![burning[0].clone(), Event { when, then: switch_off() }];
    let dropped = fly(&Case { events: off, ..plain });
    assert_eq!(dropped.termination(), Termination::SurfaceImpact);
    // From rest at the height h: v²/2 = μ (1/r - 1/(r + h)).
    let height = 1000.0 + climb;
    let speed = (2.0 * 4.9028e12 * (1.0 / MOON - 1.0 / (MOON + height))).sqrt();
    near("speed at the ground", dropped.last().flight_path.speed, speed, 1e-6);
}

/// A burn that ends a moment before rest, and one that is too weak for it, go on.
#[test]
fn a_burn_that_passes_near_rest_goes_on() {
    let plain = lander(20.0, -std::f64::consts::FRAC_PI_2);
    let (time, _) = braked_to_rest(&plain, BRAKE);
    for before in [1e-1, 1e-4, 1e-6] {
        let events = vec![at(0.0, switch_on(BRAKE)), at(time - before, switch_off())];
        let flight = fly(&Case { events, ..plain.clone() });
        assert_eq!(flight.termination(), Termination::SurfaceImpact, "{before} s before rest");
    }
    // Thrown upward under half its weight, it turns, and the thrust with it: up and down by hand, in a field that hardly changes.
    let up = lander(20.0, std::f64::consts::FRAC_PI_2);
    let gravity = 4.9028e12 / MOON.powi(2);
    let weak = Thrust { force: -0.5 * gravity * 15_000.0, specific_impulse: None, ..BRAKE };
    for case in [up.clone(), with_tolerance(up, 1e-5)] {
        let solver = Solver { step_limit: 1000, ..case.solver };
        let flight = fly(&Case { events: vec![at(0.0, switch_on(weak))], solver, ..case });
        let climb = 20.0 * 20.0 / (2.0 * 1.5 * gravity);
        relative("climb", flight.peaks().altitude.value - 1000.0, climb, 2e-3);
        let speed = (2.0 * 0.5 * gravity * (1000.0 + climb)).sqrt();
        relative("speed at the ground", flight.last().flight_path.speed, speed, 2e-3);
    }
}

/// The level part of the velocity is braked away, in vertical flight the thrust fades, and the vehicle falls on.
#[test]
fn a_level_burn_fades_in_vertical_flight_and_the_flight_goes_on() {
    let brake = Thrust { along: ThrustAxis::Horizontal, ..BRAKE };
    for rotation_rate in [0.0, 2.66e-6] {
        for flight_path_angle in [0.3, 0.0, -0.5] {
            let plain = lander(50.0, flight_path_angle);
            let planet = Planet { rotation_rate, ..plain.planet };
            let solver = Solver { step_limit: 1000, ..plain.solver };
            let case = Case { planet, solver, events: vec![at(0.0, switch_on(brake))], ..plain };
            for case in [case.clone(), with_tolerance(case.clone(), 1e-6), spherical(case)] {
                let flight = fly(&case);
                let last = flight.last().flight_path;
                assert_eq!(flight.termination(), Termination::SurfaceImpact);
                let level = last.speed * last.flight_path_angle.cos();
                assert!(level < 1.1e-3 * last.speed, "{flight_path_angle}: {level} of {} m/s", last.speed);
                assert!(
                    flight.warnings().iter().any(|warning| matches!(warning, Warning::LiftFadedNearVertical { .. })),
                    "{:?}",
                    flight.warnings()
                );
            }
        }
    }
}

/// A thrust that is switched on where it has no direction says so, and acts as soon as it has one.
#[test]
fn a_thrust_from_rest_says_that_it_has_no_direction_yet() {
    let still = lander(0.0, 0.0);
    let gravity = 4.9028e12 / (MOON + 1000.0).powi(2);
    let ahead = Thrust { force: 15_000.0, specific_impulse: None, ..BRAKE };
    let stop = Stop { time: 5.0, ..Stop::default() };
    let flight = fly(&Case { events: vec![at(0.0, switch_on(ahead))], stop, ..still.clone() });
    assert!(
        matches!(flight.warnings(), [Warning::ThrustWithoutDirection { event: 0, time: 0.0 }]),
        "{:?}",
        flight.warnings()
    );
    // It falls, and the thrust with it.
    relative("speed", flight.last().flight_path.speed, 5.0 * (gravity + 1.0), 1e-4);
    // A braking thrust stops whatever begins.
    let brakes = Case { events: vec![at(0.0, switch_on(BRAKE))], ..still.clone() };
    let Err(SimulationError::NoDirection { event: 0, time, altitude }) = try_to_fly(&brakes) else {
        panic!("{:?}", try_to_fly(&brakes).map(|_| ()))
    };
    near("at once", time, 0.0, 0.0);
    near("altitude", altitude, 1000.0, 1e-6);
    // Upward there is a direction at rest, and in inertial space.
    for along in [ThrustAxis::Radial, ThrustAxis::inertial([0.0, 0.0, 1.0]).unwrap()] {
        let stop = Stop { time: 5.0, ..Stop::default() };
        let events = vec![at(0.0, switch_on(Thrust { along, ..ahead }))];
        assert!(fly(&Case { events, stop, ..still.clone() }).warnings().is_empty());
    }
}

/// An impulse in inertial space is one in inertial components, whenever it comes; an orbit has no other memory of the frame.
#[test]
fn an_inertial_impulse_changes_the_inertial_velocity() {
    let planet = Planet::EARTH_WGS84.spherical();
    let direction = Vector3::new(1.0, -2.0, 0.5);
    let along = ThrustAxis::inertial(direction.into()).unwrap();
    let case = Case { planet, events: vec![at(300.0, push(along, 80.0))], ..orbit() };
    let flight = fly(&case);
    let event = flight.events().next().unwrap();
    let [before, after] = [event.before, event.after]
        .map(|point| Inertial::from_planet_fixed(&point.flight_path.to_planet_fixed(), &planet, point.time).velocity);
    assert!((after - before - direction.normalize() * 80.0).norm() < 1e-8, "{}", after - before);
    // On axes that are turned from the inertial ones, the same direction has other components.
    let to_others = nalgebra::Rotation3::from_euler_angles(0.3, -1.2, 0.4);
    let ThrustAxis::Inertial(rotated) = along.rotated_by(&to_others) else { unreachable!() };
    assert!((to_others.inverse() * rotated.into_inner() - direction.normalize()).norm() < 1e-15);
    assert_eq!(ThrustAxis::Normal.rotated_by(&to_others), ThrustAxis::Normal);
}

/// A ballistic coefficient is of the mass: as it burns, the drag area stays.
#[test]
fn a_ballistic_vehicle_burns_like_the_same_with_coefficients() {
    let start = FlightPath {
        flight_path_angle: -0.1,
        radius: 6_450_000.0,
        ..FlightPath::from_planet_fixed(&orbit().initial_state)
    };
    let events = vec![
        at(5.0, switch_on(Thrust { propellant: Some(200.0), ..THRUST })),
        at(40.0, Effect { mass: Some(2000.0), ..Effect::default() }),
    ];
    let constant =
        Case { atmosphere: Atmosphere::EARTH_JAMESON, initial_state: start.to_planet_fixed(), events, ..orbit() };
    let aerodynamics = Aerodynamics::Ballistic { ballistic_coefficient: 5000.0 / 12.0, lift_to_drag: 0.0 };
    let ballistic =
        Case { vehicle: Vehicle { aerodynamics, reference_area: 1.0, ..constant.vehicle.clone() }, ..constant.clone() };
    let [constant, ballistic] = [fly(&constant), fly(&ballistic)];
    assert!(miss(&constant, &ballistic) < 1e-5, "{} m", miss(&constant, &ballistic));
    relative("mass", ballistic.last().mass, 2000.0, 1e-15);
}

/// Out of orbit, where nothing falls, thrust must not carry a long step over the atmosphere, nor through the planet.
#[test]
fn thrust_out_of_orbit_meets_the_atmosphere() {
    for (along, force, propellant) in [
        (ThrustAxis::Velocity, -6000.0, Some(900.0)),
        (ThrustAxis::Velocity, -20_000.0, Some(2000.0)),
        (ThrustAxis::Radial, -20_000.0, Some(1500.0)),
    ] {
        let case = Case {
            planet: Planet::EARTH_WGS84,
            atmosphere: Atmosphere::Us76,
            events: vec![at(100.0, switch_on(Thrust { along, force, propellant, ..THRUST }))],
            stop: Stop { time: 20_000.0, ..Stop::default() },
            ..orbit()
        };
        for tolerance in [1e-3, 1e-4, 1e-7, 1e-10] {
            let flight = fly(&with_tolerance(case.clone(), tolerance));
            assert_eq!(flight.termination(), Termination::SurfaceImpact);
            let speed = flight.last().flight_path.speed;
            assert!(speed < 200.0, "{along:?} {force} at {tolerance}: {speed} m/s");
        }
    }
}
