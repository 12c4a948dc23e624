//! Flights for the tests of the core: the thesis's TARGET case 2, and random ones.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::atomic::AtomicBool;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use reentry::planet::{Gravity, Zonal};
use reentry::scenario::Equations;
use reentry::simulate::SimulationError;
use reentry::{
    Aerodynamics, Atmosphere, Case, Control, FlightPath, Planet, Scenario, Solver, Stop, Trajectory, Vehicle, simulate,
};

/// Jameson 2006, Table 2.
#[expect(clippy::approx_constant, reason = "the angle is as printed")]
pub(crate) fn target_2() -> Case {
    let initial_state = FlightPath {
        radius: 6_500_140.0,
        longitude: -1.347_32,
        geocentric_latitude: 0.651_76,
        speed: 3_007.2,
        flight_path_angle: -0.523_599,
        heading: 1.195_427,
    };
    Case {
        planet: Planet::EARTH_WGS84.spherical(),
        control: Control::banked(0.8),
        ..Case::new(vehicle(700.0, 0.216_419, 0.2, 0.2), initial_state.to_planet_fixed())
    }
}

/// A lifting entry at 7.5 km/s over an Earth with zonal gravity.
pub(crate) fn glide() -> Case {
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

/// A capsule comes home without lift, in standard air.
pub(crate) fn capsule() -> Case {
    let start = FlightPath {
        radius: 6_498_137.0,
        longitude: 0.3,
        geocentric_latitude: 0.4,
        speed: 7500.0,
        flight_path_angle: -0.05,
        heading: 0.4,
    };
    Case {
        atmosphere: Atmosphere::Us76,
        vehicle: vehicle(3000.0, 4.0, 0.0, 1.3),
        control: Control::banked(0.0),
        initial_state: start.to_planet_fixed(),
        ..target_2()
    }
}

pub(crate) fn vehicle(mass: f64, reference_area: f64, lift_coefficient: f64, drag_coefficient: f64) -> Vehicle {
    let aerodynamics = Aerodynamics::Constant { lift_coefficient, drag_coefficient };
    Vehicle { mass, reference_area, aerodynamics, nose_radius: None }
}

/// The case without air.
pub(crate) fn in_vacuum(case: Case) -> Case {
    Case { atmosphere: Atmosphere::Exponential { surface_density: 0.0, scale_height: 6935.0 }, ..case }
}

pub(crate) fn with_tolerance(case: Case, relative_tolerance: f64) -> Case {
    Case { solver: Solver { relative_tolerance, ..case.solver }, ..case }
}

pub(crate) fn spherical(case: Case) -> Case {
    Case { solver: Solver { equations: Equations::Spherical, ..case.solver }, ..case }
}

/// Flies a sound case.
#[track_caller]
pub(crate) fn fly(case: &Case) -> Trajectory {
    try_to_fly(case).unwrap_or_else(|error| panic!("{error} in {case:?}"))
}

#[track_caller]
pub(crate) fn try_to_fly(case: &Case) -> Result<Trajectory, SimulationError> {
    let scenario = Scenario::new(case.clone()).unwrap_or_else(|error| panic!("{error} in {case:?}"));
    simulate(&scenario, &AtomicBool::new(false))
}

/// The distance between the ends of two flights, m.
pub(crate) fn miss(a: &Trajectory, b: &Trajectory) -> f64 {
    let place = |flight: &Trajectory| flight.last().flight_path.to_planet_fixed().position;
    (place(a) - place(b)).norm()
}

/// Entries from 40 to 150 km, steep and shallow, ballistic and lifting, light and heavy, on the sphere and the ellipsoid,
/// away from the singularities of the spherical formulation.
pub(crate) fn random_entry() -> impl Strategy<Value = Case> {
    let state = (40e3..150e3, -PI..PI, -1.4..1.4, 500.0..12e3, -1.3..0.2, -PI..PI);
    let body = (10.0..20e3, 0.01..30.0, -0.3..0.6, 0.05..1.6, -FRAC_PI_2..FRAC_PI_2);
    (state, body, any::<bool>()).prop_map(|(state, (mass, area, lift, drag, bank_angle), round)| {
        let (altitude, longitude, geocentric_latitude, speed, flight_path_angle, heading) = state;
        let radius = 6_378_137.0 + altitude;
        let state = FlightPath { radius, longitude, geocentric_latitude, speed, flight_path_angle, heading };
        Case {
            planet: if round { Planet::EARTH_WGS84.spherical() } else { Planet::EARTH_WGS84 },
            vehicle: vehicle(mass, area, lift, drag),
            control: Control::banked(bank_angle),
            initial_state: state.to_planet_fixed(),
            stop: Stop { altitude: 0.0, time: 1000.0, ..Stop::default() },
            ..target_2()
        }
    })
}

/// So many random cases.
pub(crate) fn config(cases: u32) -> ProptestConfig {
    // The same flights in every run: the gate must not depend on chance.
    ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() }
}
