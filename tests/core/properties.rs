//! Invariants, and the same flight computed in two ways.

use std::f64::consts::PI;

use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use reentry::coordinates::{FlightPath, PlanetFixed};
use reentry::planet::Shape;
use reentry::propulsion::STANDARD_GRAVITY;
use reentry::trajectory::Sampling;
use reentry::{Aerodynamics, Case, Control, Planet, Stop, Trajectory, Vehicle};

use crate::check::{angle, near, relative};
use crate::core::flights::{config, fly, in_vacuum, miss, random_entry, spherical, target_2, with_tolerance};

/// V²/2 - ω²r²cos²φ/2 - g₀r₀²/r: constant where nothing but gravity acts (Jameson 2006, equations 29 to 31 integrated once).
fn jacobi_integral(case: &Case, state: &FlightPath<f64>) -> f64 {
    let from_axis = state.radius * state.geocentric_latitude.cos() * case.planet.rotation_rate;
    state.speed.powi(2) / 2.0 - from_axis.powi(2) / 2.0 - case.planet.gravitational_parameter / state.radius
}

fn evenly(flight: &Trajectory, count: usize) -> Vec<FlightPath<f64>> {
    let times = flight.instants(&Sampling::Count(count), count).unwrap();
    flight.points(&times).into_iter().map(|point| point.flight_path).collect()
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn the_vacuum_invariant_is_constant_in_both_formulations(case in random_entry()) {
        for case in [in_vacuum(case.clone()), spherical(in_vacuum(case))] {
            // The tolerance counts per step; a flight has some tens of steps, and the invariant terms of 6e7 J/kg.
            let flight = fly(&with_tolerance(case.clone(), 1e-12));
            let start = jacobi_integral(&case, &flight.initial().flight_path);
            for state in evenly(&flight, 20) {
                near("V²/2 - ω²r²cos²φ/2 - GM/r", jacobi_integral(&case, &state), start, 1e-9 * 6e7);
            }
        }
    }

    #[test]
    fn twin_formulations_agree(case in random_entry()) {
        let case = with_tolerance(case, 1e-12);
        // The spherical one may meet the vertical, where the other one has its fade: that is a test of its own.
        let flight = fly(&case);
        prop_assume!(flight.warnings().is_empty());
        let nearly_vertical = evenly(&flight, 200).iter().any(|state| state.flight_path_angle.cos() < 0.02);
        prop_assume!(!nearly_vertical);
        let twin = fly(&spherical(case));
        prop_assert_eq!(flight.termination(), twin.termination());
        // A centimetre at 1e-12 is the promise, to both.
        prop_assert!(miss(&flight, &twin) < 0.02, "{} m", miss(&flight, &twin));
        relative("end time", twin.end_time(), flight.end_time(), 1e-7);
    }

    #[test]
    fn turning_the_start_about_the_pole_turns_the_flight(case in random_entry(), turn in -PI..PI) {
        let rotation = Rotation3::from_axis_angle(&Vector3::z_axis(), turn);
        let PlanetFixed { position, velocity } = case.initial_state;
        let turned = Case {
            initial_state: PlanetFixed { position: rotation * position, velocity: rotation * velocity },
            ..case.clone()
        };
        let (flight, turned) = (fly(&with_tolerance(case, 1e-12)).last(), fly(&with_tolerance(turned, 1e-12)).last());
        let (a, b) = (flight.flight_path, turned.flight_path);
        near("time", turned.time, flight.time, 1e-6);
        // A centimetre each.
        angle("longitude", b.longitude, a.longitude + turn, 4e-9 / a.geocentric_latitude.cos());
        near("latitude", b.geocentric_latitude, a.geocentric_latitude, 4e-9);
        near("speed", b.speed, a.speed, 1e-4 + 1e-6 * a.speed);
    }

    #[test]
    fn rows_do_not_change_the_flight(case in random_entry(), count in 2_usize..50) {
        let flight = fly(&case);
        for sampling in [Sampling::Count(count), Sampling::PerStep(count), Sampling::Interval(7.0)] {
            let times = flight.instants(&sampling, usize::MAX).unwrap();
            prop_assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
            prop_assert!(times[0].to_bits() == 0 && times[times.len() - 1].to_bits() == flight.end_time().to_bits());
            let points = flight.points(&times);
            prop_assert_eq!(points[0], flight.initial());
            prop_assert_eq!(points[points.len() - 1], flight.last());
            for (point, time) in points.iter().zip(&times) {
                prop_assert_eq!(*point, flight.at(*time));
            }
        }
    }

    #[test]
    fn loads_follow_from_their_definitions(case in random_entry()) {
        let flight = fly(&with_tolerance(case.clone(), 1e-12));
        let Vehicle { mass, reference_area, aerodynamics, .. } = case.vehicle;
        let Aerodynamics::Constant { lift_coefficient, drag_coefficient } = aerodynamics else {
            panic!("{aerodynamics:?}")
        };
        let end = flight.end_time();
        for part in [0.1, 0.5, 0.9] {
            let time = part * end;
            let point = flight.at(time);
            let loads = point.loads;
            let expected_density = 1.547_93 * (-loads.altitude / 6935.0).exp();
            near("ρ₀ e^(-h/H)", loads.density, expected_density, 1e-12 * expected_density + 1e-300);
            let pressure = loads.density * point.flight_path.speed.powi(2) / 2.0;
            // Subnormal numbers have fewer digits.
            near("½ρV²", loads.dynamic_pressure, pressure, 1e-12 * pressure + 1e-300);
            let fade = (point.flight_path.flight_path_angle.cos() / 1e-3).min(1.0);
            if fade >= 1.0 {
                let force = pressure * reference_area * lift_coefficient.hypot(drag_coefficient);
                let expected = force / (mass * STANDARD_GRAVITY);
                near("F/(m g)", loads.load_factor, expected, 1e-12 * expected + 1e-300);
            }
            // The rate of the speed along the flight, by a central difference.
            let step = 1e-3 * end.min(1.0);
            let speed = |time: f64| flight.at(time).flight_path.speed;
            let rate = (speed(time + step) - speed(time - step)) / (2.0 * step);
            let scale = loads.load_factor * STANDARD_GRAVITY + 10.0;
            near("-dV/dt", loads.deceleration, -rate, 2e-3 * scale);
        }
    }
}

/// The altitude against another form of the same ellipse, and the surface against its equation.
#[test]
fn the_altitude_is_the_distance_from_the_ellipse_along_the_radius() {
    let (a, b) = Planet::EARTH_WGS84.shape.semi_axes();
    for degrees in -90..=90 {
        let latitude = f64::from(degrees).to_radians();
        let (sin, cos) = latitude.sin_cos();
        let surface = Planet::EARTH_WGS84.shape.surface_radius(sin, cos);
        let on_ellipse = (surface * cos / a).powi(2) + (surface * sin / b).powi(2);
        near("x²/a² + z²/b²", on_ellipse, 1.0, 1e-15 * 4.0);
        let position = Vector3::new(0.6 * cos, -0.8 * cos, sin) * (surface + 1e5);
        near("altitude", Planet::EARTH_WGS84.shape.altitude(&position), 1e5, 1e-8);
        let sphere = Shape::Sphere { radius: a };
        near("on the sphere", sphere.altitude(&position), surface + 1e5 - a, 1e-8);
    }
}

/// Bank turns the lift to the left, towards growing heading (Jameson 2006, equation 22).
#[test]
fn positive_bank_turns_the_flight_to_the_left() {
    let heading = |bank_angle: f64| {
        let planet = Planet { rotation_rate: 0.0, ..Planet::EARTH_WGS84.spherical() };
        let case = Case {
            planet,
            control: Control::banked(bank_angle),
            stop: Stop { altitude: 0.0, time: 60.0, ..Stop::default() },
            ..target_2()
        };
        fly(&case).last().flight_path.heading
    };
    let straight = heading(0.0);
    assert!(heading(0.8) > straight + 0.01);
    near("mirrored", heading(0.8) - straight, straight - heading(-0.8), 1e-2 * (heading(0.8) - straight));
}

/// Lift that points up carries a shallow entry back out of the air.
#[test]
fn upward_lift_makes_a_shallow_entry_skip() {
    let shallow = FlightPath {
        radius: 6_478_137.0,
        longitude: 0.0,
        geocentric_latitude: 0.5,
        speed: 7600.0,
        flight_path_angle: -0.05,
        heading: 0.0,
    };
    let with_lift = |lift_coefficient: f64| {
        let aerodynamics = Aerodynamics::Constant { lift_coefficient, drag_coefficient: 0.5 };
        let vehicle = Vehicle { mass: 2000.0, reference_area: 10.0, aerodynamics, nose_radius: None };
        let case =
            Case { vehicle, control: Control::banked(0.0), initial_state: shallow.to_planet_fixed(), ..target_2() };
        let flight = fly(&case);
        // Rows of a second: does it ever climb?
        let times = flight.instants(&Sampling::Interval(1.0), 100_000).unwrap();
        flight.points(&times).windows(2).any(|pair| pair[1].loads.altitude > pair[0].loads.altitude)
    };
    assert!(with_lift(1.0) && !with_lift(0.0));
}
