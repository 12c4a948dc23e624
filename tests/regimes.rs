//! Changes of formula on the way: layers of the air, corners and steps of schedules, wind.

use std::sync::Arc;

use nalgebra::Vector3;
use proptest::prelude::*;
use reentry::atmosphere::{Layer, Layers};
use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::planet::{Gravity, Zonal};
use reentry::trajectory::Termination;
use reentry::wind::WindTable;
use reentry::{Atmosphere, Case, Control, FlightPath, Planet, Stop, Trajectory, Wind};

use crate::check::near;
use crate::flights::{config, fly, miss, random_entry, spherical, target_2, vehicle, with_tolerance};

fn schedule(against: Against, at: &[f64], value: &[f64], interpolation: Interpolation) -> Command {
    Command::Schedule(Arc::new(Schedule::new(against, at, value, interpolation).unwrap()))
}

fn banked_by(bank_angle: Command, case: Case) -> Case {
    Case { control: Control { bank_angle, ..Control::banked(0.0) }, ..case }
}

/// A lifting entry at 7.5 km/s over the flattened Earth.
fn glide() -> Case {
    let state = FlightPath {
        radius: 6_498_137.0,
        longitude: 0.3,
        geocentric_latitude: 0.5,
        speed: 7500.0,
        flight_path_angle: -0.03,
        heading: 0.7,
    };
    let planet = Planet { gravity: Gravity::Zonal(Zonal::EARTH), ..Planet::EARTH_WGS84 };
    Case { planet, vehicle: vehicle(5000.0, 12.0, 0.35, 1.2), initial_state: state.to_planet_fixed(), ..target_2() }
}

fn end(flight: &Trajectory) -> Case {
    Case { initial_state: flight.arrival().state, ..glide() }
}

/// A step of a schedule is the end of one flight and the start of another.
#[test]
fn a_step_in_time_is_two_flights() {
    let steps = banked_by(schedule(Against::Time, &[0.0, 150.0, 400.0], &[0.9, -0.6, 0.2], Interpolation::Step), glide());
    let whole = fly(with_tolerance(steps, 1e-12));
    let leg = |case: Case, bank: f64, time: f64| {
        let stop = Stop { time, ..Stop::default() };
        fly(with_tolerance(Case { control: Control::banked(bank), stop, ..case }, 1e-12))
    };
    let first = leg(glide(), 0.9, 150.0);
    let second = leg(end(&first), -0.6, 250.0);
    let third = leg(end(&second), 0.2, 1e4);
    near("time", whole.end_time(), 400.0 + third.end_time(), 1e-6);
    // A thousand steps' worth of 1e-12 of the Earth's radius, magnified by the flight.
    assert!(miss(&whole, &third) < 1e-4, "{} m", miss(&whole, &third));
}

#[test]
fn a_step_in_altitude_is_two_flights() {
    let steps = banked_by(schedule(Against::Altitude, &[0.0, 50e3], &[0.2, 0.9], Interpolation::Step), glide());
    let whole = fly(with_tolerance(steps, 1e-12));
    let stop = Stop { altitude: 50e3, ..Stop::default() };
    let first = fly(with_tolerance(Case { control: Control::banked(0.9), stop, ..glide() }, 1e-12));
    assert_eq!(first.termination(), Termination::SurfaceImpact);
    let second = fly(with_tolerance(Case { control: Control::banked(0.2), ..end(&first) }, 1e-12));
    near("time", whole.end_time(), first.end_time() + second.end_time(), 1e-6);
    assert!(miss(&whole, &second) < 1e-4, "{} m", miss(&whole, &second));
}

/// Between its entries a line, outside them their values.
#[test]
fn angles_follow_their_schedule() {
    let (at, value) = ([1000.0, 3000.0, 6000.0], [0.1, 0.9, -0.5]);
    let angle = |speed: f64, interpolation| match interpolation {
        Interpolation::Linear if speed <= at[0] => value[0],
        Interpolation::Linear if speed >= at[2] => value[2],
        Interpolation::Linear if speed < at[1] => value[0] + (speed - at[0]) / 2000.0 * 0.8,
        Interpolation::Linear => value[1] + (speed - at[1]) / 3000.0 * -1.4,
        Interpolation::Step => value[at.iter().filter(|at| **at <= speed).count().max(1) - 1],
    };
    for interpolation in [Interpolation::Linear, Interpolation::Step] {
        let flight = fly(banked_by(schedule(Against::Speed, &at, &value, interpolation), glide()));
        let mut seen = Vec::new();
        for second in 0..900 {
            let point = flight.at(f64::from(second));
            let speed = point.flight_path.speed;
            if at.iter().all(|at| (speed - at).abs() > 1e-3) {
                near(&format!("{interpolation:?} at {speed} m/s"), point.bank_angle, angle(speed, interpolation), 1e-12);
            }
            seen.push(at.iter().filter(|at| **at < speed).count());
        }
        seen.dedup();
        assert_eq!(seen, [3, 2, 1, 0], "the flight passes every entry once");
    }
}

/// However many changes there are, no more steps are rejected than on a flight with none, but one a jump to find its new stride;
/// and the end is as exact.
#[test]
fn changes_are_met_and_not_ground_down() {
    let smooth = fly(glide()).statistics();
    for against in [Against::Time, Against::Altitude, Against::Speed] {
        let (first, last) = match against {
            Against::Time => (50.0, 800.0),
            Against::Altitude => (5e3, 100e3),
            _ => (300.0, 7400.0),
        };
        let at: Vec<f64> = (0..20).map(|i| first + (last - first) * f64::from(i) / 19.0).collect();
        let value: Vec<f64> = (0..20).map(|i| 0.6 + 0.3 * f64::from(i % 2)).collect();
        for interpolation in [Interpolation::Step, Interpolation::Linear] {
            let case = banked_by(schedule(against, &at, &value, interpolation), glide());
            let flight = fly(case.clone());
            let exact = fly(with_tolerance(case, 1e-13));
            let what = format!("{against:?} {interpolation:?}");
            let rejected = flight.statistics().rejected_steps;
            assert!(rejected <= smooth.rejected_steps + 20, "{what}: {rejected} after {}", smooth.rejected_steps);
            assert!(miss(&flight, &exact) < 0.05, "{what}: {} m", miss(&flight, &exact));
        }
    }
}

/// Where the air grows denser at once, the loads jump, and the peak is on the dense side.
#[test]
fn a_jump_of_the_density_is_met_exactly() {
    let layer = |base_altitude: f64, density: f64| Layer { base_altitude, density, scale_height: 7000.0 };
    let layers = Layers::new(vec![layer(0.0, 1.2), layer(60e3, 1e-5)]).unwrap();
    let case = Case { atmosphere: Atmosphere::Layers(Arc::new(layers)), ..glide() };
    let flight = fly(case.clone());
    let exact = fly(with_tolerance(case.clone(), 1e-13));
    assert!(miss(&flight, &exact) < 0.01, "{} m", miss(&flight, &exact));
    let jump = 1.2 * (-60.0_f64 / 7.0).exp() / 1e-5;
    let crossing = flight.points(&flight.instants(&reentry::trajectory::Sampling::PerStep(1), 1000).unwrap());
    let after = crossing.iter().position(|point| (point.loads.altitude - 60e3).abs() < 1e-6).expect("a step ends there");
    let density = |point: usize| crossing[point].loads.density;
    // The instant of the change belongs to what follows.
    near("below", density(after), 1.2 * (-60.0_f64 / 7.0).exp(), 1e-12);
    assert!(jump > 2.0 && density(after - 1) < 1e-5);
}

/// Air that turns faster than the planet is a planet that turns faster: a flight over the equator, seen from space.
#[test]
fn a_wind_that_turns_with_the_air_is_a_faster_planet() {
    let excess = 2e-5;
    let planet = Planet::EARTH_WGS84.spherical();
    let radius = 6_498_137.0;
    let state = |speed: f64| FlightPath {
        radius,
        longitude: 0.0,
        geocentric_latitude: 0.0,
        speed,
        flight_path_angle: -0.05,
        heading: 0.0,
    };
    let level = 7000.0_f64;
    let slow = state(level);
    // The same inertial velocity, relative to the faster planet.
    let (up, east) = (level * slow.flight_path_angle.sin(), level * slow.flight_path_angle.cos() - excess * radius);
    let fast = FlightPath { speed: up.hypot(east), flight_path_angle: up.atan2(east), ..slow };
    let altitude = [-1e3, 30e3, 90e3, 150e3];
    let table = WindTable::new(&altitude, &altitude.map(|h| excess * (h + 6_378_137.0)), &[0.0; 4]).unwrap();
    let stop = Stop { time: 400.0, ..Stop::default() };
    let base = Case { planet, vehicle: vehicle(2000.0, 5.0, 0.3, 1.0), control: Control::banked(0.0), stop, ..target_2() };
    let windy = Case { wind: Wind::Table(Arc::new(table)), initial_state: slow.to_planet_fixed(), ..base.clone() };
    let turning = Planet { rotation_rate: planet.rotation_rate + excess, ..planet };
    let still = Case { planet: turning, initial_state: fast.to_planet_fixed(), ..base };
    for formulation in [|case: Case| case, spherical] {
        let windy = fly(with_tolerance(formulation(windy.clone()), 1e-12));
        let still = fly(with_tolerance(formulation(still.clone()), 1e-12));
        for time in [50.0, 150.0, 250.0, 350.0] {
            let (a, b) = (windy.at(time), still.at(time));
            assert!(a.loads.load_factor > 1e-4);
            // 7 digits of the loads, whose density falls by e in 7 km.
            near("altitude", a.loads.altitude, b.loads.altitude, 1e-3);
            near("inertial speed", a.inertial_speed, b.inertial_speed, 1e-6);
            near("air speed", a.loads.air_speed, b.flight_path.speed, 1e-6);
            near("load factor", a.loads.load_factor, b.loads.load_factor, 1e-6 * b.loads.load_factor);
            near("longitude", a.flight_path.longitude, b.flight_path.longitude + excess * time, 1e-9);
        }
    }
}

/// On a vehicle at rest the wind acts by itself: at 30° N, to the east and to the north.
#[test]
fn wind_carries_a_body_at_rest_along() {
    let (latitude, longitude): (f64, f64) = (0.5, 1.0);
    let state = FlightPath {
        radius: 6_388_137.0,
        longitude,
        geocentric_latitude: latitude,
        speed: 0.0,
        flight_path_angle: 0.0,
        heading: 0.0,
    };
    let planet = Planet { rotation_rate: 0.0, ..Planet::EARTH_WGS84.spherical() };
    let (mass, area, drag) = (10.0, 0.5, 1.0);
    let case = Case { planet, vehicle: vehicle(mass, area, 0.0, drag), initial_state: state.to_planet_fixed(), ..target_2() };
    let (east, north) = (30.0, -20.0);
    let windy = Case { wind: Wind::Constant { east, north }, ..case.clone() };
    let [still, windy] = [case, windy].map(|case| case.forces().acceleration(0.0, &case.initial_state));
    let speed = 1300.0_f64.sqrt();
    let density = 1.547_93 * (-10_000.0_f64 / 6935.0).exp();
    let push = 0.5 * density * speed * area * drag / mass;
    let to_east = Vector3::new(-longitude.sin(), longitude.cos(), 0.0);
    let to_north =
        Vector3::new(-latitude.sin() * longitude.cos(), -latitude.sin() * longitude.sin(), latitude.cos());
    let expected = (to_east * east + to_north * north) * push;
    assert!(((windy - still) - expected).norm() < 1e-12 * expected.norm() + 1e-14, "{windy} {still} {expected}");
}

/// Air, wind, gravity and angles of every kind.
fn random_models() -> impl Strategy<Value = Case> {
    let wind = (-80.0..80.0, -80.0..80.0).prop_map(|(east, north)| Wind::Constant { east, north });
    let against = prop::sample::select(vec![
        (Against::Time, [20.0, 60.0, 150.0]),
        (Against::Altitude, [10e3, 35e3, 60e3]),
        (Against::Speed, [500.0, 2000.0, 5000.0]),
        (Against::Mach, [2.0, 6.0, 15.0]),
    ]);
    let interpolation = prop::sample::select(vec![Interpolation::Linear, Interpolation::Step]);
    let bank = (against, interpolation, prop::array::uniform3(-1.5..1.5))
        .prop_map(|((against, at), interpolation, value)| schedule(against, &at, &value, interpolation));
    (random_entry(), wind, bank, 2..5_usize).prop_map(|(case, wind, bank_angle, degree)| {
        let gravity = Gravity::Zonal(Zonal::EARTH.up_to(degree));
        let planet = Planet { gravity, ..case.planet };
        banked_by(bank_angle, Case { planet, wind, atmosphere: Atmosphere::Us76, ..case })
    })
}

proptest! {
    #![proptest_config(config(40))]

    /// The equations of the thesis, with forces of any direction, against those in planet-fixed coordinates.
    #[test]
    fn twin_formulations_agree_under_every_model(case in random_models()) {
        let cartesian = fly(with_tolerance(case.clone(), 1e-12));
        let spherical = reentry::simulate(
            &reentry::Scenario::new(spherical(with_tolerance(case, 1e-12))).unwrap(),
            &std::sync::atomic::AtomicBool::new(false),
        );
        // Near its singularities the spherical one gives up by name.
        if let Ok(spherical) = spherical {
            prop_assert_eq!(cartesian.termination(), spherical.termination());
            prop_assert!(miss(&cartesian, &spherical) < 0.01, "{} m", miss(&cartesian, &spherical));
        }
    }

    #[test]
    fn energy_is_balanced_under_every_model(case in random_models()) {
        let scenario = reentry::Scenario::new(case.clone()).unwrap();
        let flight = fly(case);
        let verification =
            reentry::verification::verify(&scenario, &flight, &std::sync::atomic::AtomicBool::new(false)).unwrap();
        // 1e-10 of the energies of 6e7 J/kg, a hundred steps.
        prop_assert!(verification.energy_drift < 0.6, "{verification:?}");
        prop_assert!(verification.distance < 0.1, "{verification:?}");
    }
}
