//! What `verification` says of a flight is true.

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use proptest::prelude::*;
use reentry::coordinates::{OrbitShape, OrbitalElements};
use reentry::event::{Condition, Direction, Quantity};
use reentry::simulate::SimulationError;
use reentry::verification::{Verification, verify};
use reentry::{Atmosphere, Case, FlightPath, Planet, Scenario, Solver, Stop};

use crate::check::{near, relative};
use crate::core::flights::{config, fly, in_vacuum, miss, random_entry, spherical, target_2, vehicle, with_tolerance};

fn verified(case: &Case) -> Verification {
    verify(&Scenario::new(case.clone()).unwrap(), &fly(case), &AtomicBool::new(false)).unwrap()
}

#[test]
fn the_distance_from_the_finer_flight_is_the_error() {
    for case in [target_2(), spherical(target_2())] {
        let exact = fly(&with_tolerance(case.clone(), 1e-14));
        for tolerance in [1e-5, 1e-7, 1e-9] {
            let case = with_tolerance(case.clone(), tolerance);
            let (flight, verification) = (fly(&case), verified(&case));
            relative("the tolerance of the finer flight", verification.relative_tolerance, tolerance / 100.0, 1e-15);
            // The finer flight has some hundredths of the error.
            relative("distance", verification.distance, miss(&flight, &exact), 0.2);
            let late = flight.end_time() - exact.end_time();
            near("time", verification.time_difference, late, 0.2 * late.abs() + 1e-10);
        }
    }
    relative(
        "there is no finer tolerance",
        verified(&with_tolerance(target_2(), 1e-13)).relative_tolerance,
        1e-14,
        1e-15,
    );
}

/// A vehicle of 1000 kg and 11 m² of drag area in standard air, from an orbit with these altitudes, m, from its highest place on.
fn from_orbit(apoapsis: f64, periapsis: f64, lift_coefficient: f64, relative_tolerance: f64) -> Case {
    let planet = Planet::EARTH_WGS84;
    let [apoapsis, periapsis] = [apoapsis, periapsis].map(|altitude| planet.equatorial_radius() + altitude);
    let semi_major_axis = 0.5 * (apoapsis + periapsis);
    let elements = OrbitalElements {
        shape: OrbitShape::SemiMajorAxis(semi_major_axis),
        eccentricity: 1.0 - periapsis / semi_major_axis,
        inclination: 0.9,
        raan: 0.2,
        argument_of_periapsis: 0.4,
        true_anomaly: PI,
    };
    let inertial = elements.to_inertial(planet.gravitational_parameter);
    with_tolerance(
        Case {
            planet,
            atmosphere: Atmosphere::Us76,
            vehicle: vehicle(1000.0, 5.0, lift_coefficient, 2.2),
            initial_state: inertial.to_planet_fixed(&planet, 0.0),
            stop: Stop { time: 1e8, ..Stop::default() },
            ..target_2()
        },
        relative_tolerance,
    )
}

/// What the documents say of the default tolerance, and when the answer warns: entries from orbit, ballistic and lifting, and orbits, of up
/// to two hours.
#[test]
fn the_default_tolerance_keeps_two_hours_within_a_metre() {
    let mut longest = 0.0_f64;
    for apoapsis in [130e3, 200e3, 300e3, 400e3] {
        for periapsis in [-40e3, 0.0, 40e3, 70e3, 85e3, 130e3] {
            for lift_coefficient in [0.0, 0.4] {
                let case = from_orbit(apoapsis, periapsis, lift_coefficient, Solver::default().relative_tolerance);
                let case = Case { stop: Stop { time: 7200.0, ..Stop::default() }, ..case };
                let Verification { distance, .. } = verified(&case);
                assert!(distance < 1.0, "{distance} m from {apoapsis} and {periapsis} m");
                longest = longest.max(fly(&case).end_time());
            }
        }
    }
    near("some last that long", longest, 7200.0, 0.0);
}

/// Errors grow with the days of a decay, and fall with the tolerance: metres, as documented, to a factor of 4.
#[test]
fn the_end_of_a_decay_is_as_exact_as_documented() {
    for (altitude, days, relative_tolerance, error) in [
        (160e3, 0.44, 1e-10, 2.0),
        (200e3, 2.7, 1e-10, 10.0),
        (220e3, 5.7, 1e-10, 60.0),
        (220e3, 5.7, 1e-12, 0.25),
        (240e3, 11.0, 1e-12, 1.3),
    ] {
        let case = from_orbit(altitude, altitude, 0.0, relative_tolerance);
        relative("days", fly(&case).end_time() / 86_400.0, days, 0.1);
        let Verification { distance, .. } = verified(&case);
        assert!(
            (0.25 * error..4.0 * error).contains(&distance),
            "{distance} m after {days} days, {relative_tolerance:e}"
        );
    }
}

#[test]
fn the_drift_of_the_energy_falls_with_the_tolerance() {
    let mut before = f64::INFINITY;
    for tolerance in [1e-5, 1e-7, 1e-9, 1e-11] {
        let Verification { energy_drift, drag_work, .. } = verified(&with_tolerance(target_2(), tolerance));
        // The work of 3 km/s and 120 km, but for the 130 m/s at the end: 4.5e6 + 1.2e6 J/kg.
        relative("work of the drag", drag_work, 5.6e6, 0.02);
        assert!(energy_drift < 0.1 * before, "{energy_drift:e} at {tolerance:e} after {before:e}");
        before = energy_drift;
    }
    assert!(before < 1e-9 * 5.6e6, "{before:e}");
}

/// Dropped from rest, a condition on the angle is met at once: a leg without length.
#[test]
fn a_flight_that_is_over_at_once_is_in_balance() {
    let condition = Condition { quantity: Quantity::FlightPathAngle, value: -0.05, direction: Direction::Falling };
    let start =
        FlightPath { speed: 0.0, flight_path_angle: 0.0, ..FlightPath::from_planet_fixed(&target_2().initial_state) };
    let stop = Stop { when: vec![condition.into()], ..Stop::default() };
    let Verification { energy_drift, drag_work, thrust_work, .. } =
        verified(&Case { initial_state: start.to_planet_fixed(), stop, ..target_2() });
    assert!([energy_drift, drag_work, thrust_work].iter().all(|work| work.abs() < 1e-6));
}

proptest! {
    #![proptest_config(config(60))]

    #[test]
    fn energy_is_balanced_on_every_flight(case in random_entry()) {
        for case in [case.clone(), in_vacuum(case.clone()), spherical(case)] {
            let verification = verified(&case);
            // The tolerance of 1e-10 counts per step and against the circular speed, whose energy is 6e7 J/kg; the dense output, on
            // which the work is summed, is less exact.
            let allowed = 1e-9 * 6e7 + 1e-6 * verification.drag_work;
            prop_assert!(verification.energy_drift < allowed, "{verification:?}");
        }
    }
}

#[test]
fn the_flag_ends_the_finer_flight_as_well() {
    let interrupted = verify(&Scenario::new(target_2()).unwrap(), &fly(&target_2()), &AtomicBool::new(true));
    assert!(matches!(interrupted, Err(SimulationError::Interrupted { .. })));
}

/// An orbit that takes nearly all the steps that a flight may have: the finer one takes more, and may.
#[test]
fn the_finer_flight_may_take_more_steps() {
    let orbit = reentry::FlightPath {
        radius: 7_378_137.0,
        longitude: 0.0,
        geocentric_latitude: 0.2,
        speed: 7000.0,
        flight_path_angle: 0.0,
        heading: 0.5,
    };
    let case = Case {
        initial_state: orbit.to_planet_fixed(),
        stop: Stop { altitude: 0.0, time: 2e5, ..Stop::default() },
        ..target_2()
    };
    let steps = fly(&case).statistics().steps;
    let case = Case { solver: Solver { step_limit: steps + 100, ..case.solver }, ..case };
    assert!(fly(&with_tolerance(case.clone(), 1e-10)).statistics().steps <= steps);
    assert!(verified(&case).distance > 0.0);
}
