//! What begins on the value of a condition, or on the ground: where it goes decides, however slowly it starts.

use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::atomic::AtomicBool;

use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::event::{Condition, Direction, Effect, Event, Quantity, ThrustCommand, Trigger};
use reentry::heating::Heating;
use reentry::propulsion::{Impulse, Thrust, ThrustAxis};
use reentry::sensitivity::sensitivities;
use reentry::trajectory::Termination;
use reentry::{Atmosphere, Case, Control, FlightPath, Planet, Stop, Trajectory};

use crate::check::{near, relative};
use crate::core::flights::{config, fly, in_vacuum, random_entry, target_2, try_to_fly, vehicle, with_tolerance};

fn rises(quantity: Quantity, value: f64) -> Condition {
    Condition { quantity, value, direction: Direction::Rising }
}

fn falls(quantity: Quantity, value: f64) -> Condition {
    Condition { quantity, value, direction: Direction::Falling }
}

fn event(when: impl Into<Trigger>, then: Effect) -> Event {
    Event { when: when.into(), then }
}

fn mark(when: impl Into<Trigger>) -> Event {
    event(when, Effect::default())
}

/// Events of a flight, as their places in the list and their times.
fn times(flight: &Trajectory) -> Vec<(usize, f64)> {
    flight.events().map(|event| (event.event, event.before.time)).collect()
}

/// A load of 500 kg in standard air, at an altitude, m, a latitude, rad, and a level speed, m/s.
fn load(altitude: f64, geocentric_latitude: f64, speed: f64) -> Case {
    let planet = Planet::EARTH_WGS84;
    let surface = planet.shape.surface_radius(geocentric_latitude.sin(), geocentric_latitude.cos());
    let state = FlightPath {
        radius: surface + altitude,
        longitude: 0.14,
        geocentric_latitude,
        speed,
        flight_path_angle: 0.0,
        heading: 0.0,
    };
    Case {
        planet,
        atmosphere: Atmosphere::Us76,
        vehicle: vehicle(500.0, 1.0, 0.0, 1.0),
        control: Control::banked(0.0),
        initial_state: state.to_planet_fixed(),
        ..target_2()
    }
}

/// Level flight has no vertical rate but a rounding, of either sign: at every latitude the parachute opens at once.
#[test]
fn a_load_opens_its_parachute_at_the_altitude_of_its_release_at_every_latitude() {
    let opens = Effect { reference_area: Some(100.0), ..Effect::default() };
    for latitude in 0..90 {
        let dropped = load(3000.0, f64::from(latitude).to_radians(), 70.0);
        let events = vec![event(falls(Quantity::Altitude, 3000.0), opens.clone())];
        let flight = fly(&Case { events, ..dropped });
        assert_eq!(times(&flight), [(0, 0.0)], "at {latitude}°");
        // m g = ½ ρ V² S C_D with 1.225 kg/m³ and 9.8 m/s².
        near("terminal speed", flight.last().flight_path.speed, (2.0 * 500.0 * 9.8 / 122.5_f64).sqrt(), 0.1);
    }
}

#[test]
fn from_rest_what_grows_with_the_speed_grows_at_once() {
    let quantities = [Quantity::Speed, Quantity::Mach, Quantity::DynamicPressure, Quantity::LoadFactor];
    let marks: Vec<_> = quantities.map(|quantity| mark(rises(quantity, 0.0))).into();
    let flight = fly(&Case { events: marks, ..load(3000.0, 0.7, 0.0) });
    assert_eq!(times(&flight), [(0, 0.0), (1, 0.0), (2, 0.0), (3, 0.0)]);
}

/// An orbit of an eccentricity, which starts `after` its perigee, s, in a vacuum.
fn orbit(eccentricity: f64) -> Case {
    let planet = Planet { rotation_rate: 0.0, ..Planet::EARTH_WGS84.spherical() };
    let radius: f64 = 6_778_137.0;
    let state = FlightPath {
        radius,
        longitude: 0.0,
        geocentric_latitude: 0.3,
        speed: (planet.gravitational_parameter / radius * (1.0 + eccentricity)).sqrt(),
        flight_path_angle: 0.0,
        heading: 0.5,
    };
    let stop = Stop { time: 2e4, ..Stop::default() };
    in_vacuum(Case { planet, initial_state: state.to_planet_fixed(), stop, ..target_2() })
}

#[test]
fn at_an_apsis_the_altitude_leaves_its_value_at_once_to_the_side_of_the_orbit() {
    for eccentricity in [0.3, 1e-2, 1e-4, 1e-6] {
        for (eccentricity, quantities) in [(eccentricity, [0, 1]), (-eccentricity, [1, 0])] {
            let marks = vec![mark(rises(Quantity::Altitude, 4e5)), mark(falls(Quantity::Altitude, 4e5))];
            let flight = fly(&Case { events: marks, ..orbit(eccentricity) });
            assert_eq!(times(&flight)[0], (quantities[0], 0.0), "e = {eccentricity}");
            // The other way it comes back a revolution later, if the start is an apsis that it passes again.
            assert!(
                times(&flight)[1..].iter().all(|(_, time)| *time > 1e3),
                "e = {eccentricity}: {:?}",
                times(&flight)
            );
        }
    }
}

/// On a circle the altitude does not change, and no rounding is a crossing.
#[test]
fn on_a_circle_no_rounding_of_the_altitude_is_a_crossing() {
    let marks = vec![mark(rises(Quantity::Altitude, 4e5)), mark(falls(Quantity::Altitude, 4e5))];
    // The error of the integration stays below what counts as on the value.
    let flight = fly(&with_tolerance(Case { events: marks, ..orbit(0.0) }, 1e-13));
    assert_eq!(times(&flight), []);
}

/// Events of t = 0 change the motion before it is told where it goes.
#[test]
fn an_impulse_of_the_start_decides_where_the_altitude_goes() {
    for (speed_change, goes) in [(20.0, 1), (-20.0, 2)] {
        let then = Effect { impulse: Some(Impulse { along: ThrustAxis::Radial, speed_change }), ..Effect::default() };
        let events = vec![
            event(rises(Quantity::Time, 0.0), then),
            mark(rises(Quantity::Altitude, 3000.0)),
            mark(falls(Quantity::Altitude, 3000.0)),
        ];
        let flight = fly(&Case { events, ..load(3000.0, 0.7, 50.0) });
        assert_eq!(times(&flight)[..2], [(0, 0.0), (goes, 0.0)], "{speed_change} m/s");
    }
}

/// A vehicle of 100 kg at rest on a pad at sea level.
fn pad() -> Case {
    Case { vehicle: vehicle(100.0, 1.0, 0.0, 1.0), ..load(0.0, 0.498, 0.0) }
}

fn ignition(force: f64) -> Effect {
    let thrust = Thrust { along: ThrustAxis::Radial, force, specific_impulse: Some(250.0), propellant: Some(40.0) };
    Effect { thrust: Some(ThrustCommand::On(thrust)), ..Effect::default() }
}

/// A thrust of five weights lifts it; of less than one it does not. The reference is an independent integration: `SciPy`'s DOP853 at 1e-12 of
/// the same forces in ECEF coordinates.
#[test]
fn a_thrust_of_the_start_lifts_a_vehicle_off_its_pad() {
    let geodetic = reentry::coordinates::Geodetic {
        geodetic_altitude: 0.0,
        longitude: (-80.6_f64).to_radians(),
        geodetic_latitude: 28.6_f64.to_radians(),
        speed: 0.0,
        flight_path_angle: FRAC_PI_2,
        azimuth: FRAC_PI_2,
    };
    let initial_state = geodetic.to_planet_fixed(&Planet::EARTH_WGS84.shape);
    let launch = |force: f64| {
        let events = vec![event(rises(Quantity::Time, 0.0), ignition(force)), mark(rises(Quantity::Speed, 0.0))];
        fly(&Case { initial_state, events, ..pad() })
    };
    let flight = launch(5000.0);
    near("highest point", flight.peaks().altitude.value, 1689.48, 0.005);
    near("end", flight.end_time(), 78.429, 5e-4);
    near("speed", flight.last().flight_path.speed, 31.037, 5e-4);
    assert_eq!((flight.termination(), times(&flight)), (Termination::SurfaceImpact, vec![(0, 0.0), (1, 0.0)]));
    // It does not move, and so no speed rises.
    let held = launch(900.0);
    assert_eq!((held.end_time(), held.termination(), times(&held)), (0.0, Termination::SurfaceImpact, vec![(0, 0.0)]));
}

#[test]
fn an_impulse_from_rest_on_the_ground_throws_it_up() {
    let throw = |along: ThrustAxis, speed_change: f64| {
        let then = Effect { impulse: Some(Impulse { along, speed_change }), ..Effect::default() };
        fly(&Case { events: vec![event(rises(Quantity::Time, 0.0), then)], ..pad() })
    };
    let flight = throw(ThrustAxis::Radial, 100.0);
    // By the same independent integration at a latitude of 28.6°, which changes gravity by less than these.
    near("end", flight.end_time(), 11.612, 2e-3);
    near("speed", flight.last().flight_path.speed, 37.191, 2e-3);
    for down in [throw(ThrustAxis::Radial, -100.0), throw(ThrustAxis::Velocity, 100.0)] {
        assert_eq!((down.end_time(), down.termination()), (0.0, Termination::SurfaceImpact));
    }
}

/// ω² r > g: at rest on the equator it is thrown off, and flies away along a straight line but for gravity.
#[test]
fn what_rests_on_a_planet_that_spins_too_fast_is_thrown_off() {
    let spinning = |rotation_rate: f64| {
        let planet = Planet { rotation_rate, ..Planet::EARTH_WGS84.spherical() };
        let state = FlightPath {
            radius: planet.equatorial_radius(),
            longitude: 0.0,
            geocentric_latitude: 0.0,
            speed: 0.0,
            flight_path_angle: 0.0,
            heading: 0.0,
        };
        let stop = Stop { time: 100.0, ..Stop::default() };
        fly(&in_vacuum(Case { planet, initial_state: state.to_planet_fixed(), stop, ..target_2() }))
    };
    let planet = Planet::EARTH_WGS84;
    let breaking = (planet.gravitational_parameter / planet.equatorial_radius().powi(3)).sqrt();
    let off = spinning(1.1 * breaking);
    assert_eq!(off.termination(), Termination::TimeLimit);
    // The conserved energy of its orbit, v²/2 - μ/r, and its angular momentum give the radius after a while:
    // r̈ = h²/r³ - μ/r², from rest in r, by the series r₀ + a t²/2 with a = (1.21 - 1) μ/r₀².
    let acceleration = 0.21 * planet.gravitational_parameter / planet.equatorial_radius().powi(2);
    relative("height", off.last().loads.altitude, acceleration * 100.0_f64.powi(2) / 2.0, 0.02);
    let stays = spinning(0.9 * breaking);
    assert_eq!((stays.termination(), stays.end_time()), (Termination::SurfaceImpact, 0.0));
}

/// The second event happens a delay after the first, wherever that is; a third waits for it in turn, and a stop ends the flight.
#[test]
fn events_and_the_end_wait_for_other_events() {
    let after = |event, delay| Trigger::After { event, delay };
    let opens = Effect { reference_area: Some(2.0), ..Effect::default() };
    let events = vec![
        mark(after(2, 0.0)),
        mark(falls(Quantity::Altitude, 50e3)),
        event(after(1, 7.25), opens),
        mark(after(3, 1.0)),
        mark(rises(Quantity::Speed, 1e5)),
        mark(after(4, 1.0)),
    ];
    // The fourth waits for itself, which is refused; with another in its place the chain runs.
    let circle = Case { events: events.clone(), ..target_2() };
    let faults = reentry::Scenario::new(circle).unwrap_err().0;
    assert_eq!(faults.len(), 1, "{faults:?}");
    let mut events = events;
    events[3] = mark(after(0, 1.0));
    let stop = Stop { when: vec![after(3, 0.5)], ..Stop::default() };
    let flight = fly(&Case { events, stop, ..target_2() });
    let [(1, first), (2, second), (0, third), (3, fourth)] = times(&flight)[..] else { panic!("{:?}", times(&flight)) };
    near("after the first", second, first + 7.25, 1e-9);
    near("with the second", third, second, 0.0);
    near("after the third", fourth, third + 1.0, 1e-9);
    near("the end", flight.end_time(), fourth + 0.5, 1e-9);
    assert_eq!(flight.termination(), Termination::Condition(0));
}

/// The derivative of the time of flight by the mass, and the difference of two flights over that of their masses.
fn slope_and_difference(case: &Case) -> [f64; 2] {
    let case = with_tolerance(case.clone(), 1e-13);
    let of = |change: f64| {
        let mut case = case.clone();
        case.vehicle.mass *= 1.0 + change;
        fly(&case).end_time()
    };
    let slope = sensitivities(&fly(&case), &AtomicBool::new(false)).unwrap().time.mass;
    [slope, (of(1e-4) - of(-1e-4)) / (2e-4 * case.vehicle.mass)]
}

/// Where the first event comes later as the mass varies, the second does as well.
#[test]
fn derivatives_pass_through_a_delay() {
    let opens = Effect { reference_area: Some(2.0), ..Effect::default() };
    let events = vec![mark(falls(Quantity::Altitude, 20e3)), event(Trigger::After { event: 0, delay: 4.0 }, opens)];
    let [slope, difference] = slope_and_difference(&Case { events, ..target_2() });
    // The difference is off by the square of the change of 1e-4.
    relative("slope", slope, difference, 1e-6);
}

/// The heat load is a quantity that the derivatives follow where a condition waits for it.
#[test]
fn derivatives_pass_through_a_condition_on_the_heat_load() {
    let opens = Effect { reference_area: Some(2.0), ..Effect::default() };
    let mut case = target_2();
    case.vehicle.nose_radius = Some(0.5);
    case.heating = Some(Heating { emissivity: 0.8, ..Heating::default() });
    let total = fly(&case).last().heat_load.unwrap();
    case.events = vec![event(rises(Quantity::HeatLoad, 0.5 * total), opens)];
    let [slope, difference] = slope_and_difference(&case);
    relative("slope", slope, difference, 1e-6);
}

/// The mass falls along a straight line of time while the engine burns.
#[test]
fn a_condition_on_the_mass_ends_a_burn() {
    let thrust = Thrust { along: ThrustAxis::Velocity, force: -2e4, specific_impulse: Some(300.0), propellant: None };
    let events = vec![
        event(rises(Quantity::Time, 5.0), Effect { thrust: Some(ThrustCommand::On(thrust)), ..Effect::default() }),
        event(falls(Quantity::Mass, 650.0), Effect { thrust: Some(ThrustCommand::Off), ..Effect::default() }),
    ];
    let flight = fly(&Case { events, ..target_2() });
    let burnt = 50.0 / (2e4 / (9.806_65 * 300.0));
    near("burnout", times(&flight)[1].1, 5.0 + burnt, 1e-9);
    near("mass", flight.last().mass, 650.0, 1e-9);
}

/// A flight once and a half round the globe: the downrange goes on, and is met where the flight is then.
#[test]
fn a_condition_on_the_downrange_is_met_beyond_half_the_globe() {
    let radius = 6_378_137.0;
    let values = [0.4, 0.9, 1.3, 2.2].map(|turns: f64| turns * 2.0 * PI * radius);
    let case = Case { events: values.map(|value| mark(rises(Quantity::Downrange, value))).into(), ..orbit(0.0) };
    for tolerance in [1e-3, 1e-10] {
        let flight = fly(&with_tolerance(case.clone(), tolerance));
        assert_eq!(flight.events().count(), 4);
        // The column counts whole turns by itself; a step at the coarser tolerance is a good part of one.
        for (event, value) in flight.events().zip(values) {
            near("column", event.before.downrange.unwrap(), value, 1e-3);
        }
    }
    let flight = fly(&case);
    let rate = (Planet::EARTH_WGS84.gravitational_parameter / 6_778_137.0_f64.powi(3)).sqrt() * radius;
    for ((index, time), value) in times(&flight).into_iter().zip(values) {
        relative(&format!("event {index}"), time, value / rate, 1e-8);
    }
}

fn loads_of(flight: &Trajectory) -> [(Quantity, f64, f64, f64); 4] {
    let (first, last, peaks) = (flight.initial(), flight.last(), flight.peaks());
    [
        (Quantity::LoadFactor, first.loads.load_factor, last.loads.load_factor, peaks.load_factor.value),
        (
            Quantity::DynamicPressure,
            first.loads.dynamic_pressure,
            last.loads.dynamic_pressure,
            peaks.dynamic_pressure.value,
        ),
        (Quantity::Deceleration, first.loads.deceleration, last.loads.deceleration, peaks.deceleration.value),
        (Quantity::Altitude, first.loads.altitude, last.loads.altitude, peaks.altitude.value),
    ]
}

/// The case by itself, or banked by a table against the speed, between whose entries the lift turns more often.
fn tabulated(case: Case, by_table: bool) -> Case {
    let at: Vec<f64> = (0..12).map(|step| 1000.0 * f64::from(step)).collect();
    let value: Vec<f64> = (0..12).map(|step| if step % 2 == 0 { -0.9 } else { 0.9 }).collect();
    let schedule = Schedule::new(Against::Speed, &at, &value, Interpolation::Linear).unwrap();
    let bank_angle = Command::Schedule(std::sync::Arc::new(schedule));
    if by_table { Case { control: Control { bank_angle, ..case.control }, ..case } } else { case }
}

/// The load of a light body, which at this tolerance rises above the value and falls again within a step.
#[test]
fn a_peak_inside_a_long_step_meets_the_value_that_it_passes() {
    let state = FlightPath {
        radius: 6_378_137.0 + 120e3,
        longitude: 0.0,
        geocentric_latitude: FRAC_PI_2 / 3.0,
        speed: 793.0,
        flight_path_angle: (-48.5_f64).to_radians(),
        heading: FRAC_PI_2 * 2.0 / 3.0,
    };
    let plain = Case {
        planet: Planet::EARTH_WGS84.spherical(),
        atmosphere: Atmosphere::Us76,
        // m/(C_D S) = 88.7 kg/m²
        vehicle: vehicle(88.7, 1.0, 0.0, 1.0),
        initial_state: state.to_planet_fixed(),
        ..target_2()
    };
    let mut crossed = 0;
    for tolerance in [1e-3, 1e-4, 1e-5] {
        let case = with_tolerance(plain.clone(), tolerance);
        let peak = fly(&case).peaks().load_factor.value;
        for below in [0.1, 0.03, 0.005, 1e-3, 1e-4] {
            let events = vec![mark(rises(Quantity::LoadFactor, peak * (1.0 - below)))];
            let flight = fly(&Case { events, ..case.clone() });
            assert_eq!(flight.events().count(), 1, "{below} below {peak} at {tolerance}");
            crossed += 1;
        }
    }
    assert_eq!(crossed, 15);
}

/// At loose tolerances steps are long, and a peak that the answer tells lies inside one: what waits for a value below it happens.
#[test]
fn a_value_between_start_end_and_peak_is_met_at_every_tolerance() {
    let (met, failed) = (Cell::new(0), Cell::new(0));
    // Just below the peak, by a third to a hundred-thousandth of the way: there the ends of a step tell least of what is inside.
    let inputs = (random_entry(), 3.0..6.0_f64, 0.5..5.0_f64, any::<bool>());
    TestRunner::new(config(150))
        .run(&inputs, |(case, exponent, below, by_table)| {
            let part = 1.0 - 10.0_f64.powf(-below);
            let case = tabulated(with_tolerance(case, 10.0_f64.powf(-exponent)), by_table);
            let Ok(plain) = try_to_fly(&case) else {
                failed.set(failed.get() + 1);
                return Ok(());
            };
            for (quantity, first, last, peak) in loads_of(&plain) {
                for (from, direction) in [(first, Direction::Rising), (last, Direction::Falling)] {
                    let value = from + part * (peak - from);
                    // Nearer than this to an end, a rounding decides on which side it is.
                    let near = 1e-6 * peak.abs();
                    if peak - value < near || value - from < near || !quantity.bound().admits(value) {
                        continue;
                    }
                    let condition = Condition { quantity, value, direction };
                    let flight = fly(&Case { events: vec![mark(condition)], ..case.clone() });
                    prop_assert_eq!(flight.events().count(), 1, "{:?} from {} to {}", condition, from, peak);
                    met.set(met.get() + 1);
                }
            }
            Ok(())
        })
        .unwrap();
    assert!(met.get() > 600 && failed.get() < 5, "{} met, {} flights failed", met.get(), failed.get());
}
