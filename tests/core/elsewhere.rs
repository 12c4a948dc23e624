//! Random flights at other bodies, beside another integration: in an inertial frame, with the numbers of the bodies' files, gravity as the gradient
//! of its potential, and an interpolation of the air of its own.

use std::f64::consts::PI;

use nalgebra::{SVector, Vector3};
use num_dual::{DualNum, DualSVec64, gradient};
use proptest::prelude::*;
use reentry::body::{BODIES, Body};
use reentry::planet::Gravity;
use reentry::trajectory::Warning;
use reentry::{Case, Control, FlightPath, Planet, Stop, Trajectory};
use serde_json::Value;

use crate::core::flights::{config, fly, target_2, vehicle, with_tolerance};

/// A body as its file has it.
struct Elsewhere {
    gravitational_parameter: f64,
    equatorial_radius: f64,
    polar_radius: f64,
    rotation_rate: f64,
    zonal: [f64; 3],
    air: Air,
}

/// The logarithm of the density by altitude: cubics with given slopes, and straight lines outside.
struct Air {
    altitude: Vec<f64>,
    logarithm: Vec<f64>,
    slope: Vec<f64>,
    least_scale_height: f64,
}

impl Air {
    fn new(altitude: Vec<f64>, density: &[f64]) -> Self {
        let logarithm: Vec<f64> = density.iter().copied().map(f64::ln).collect();
        let last = altitude.len() - 1;
        let width = |cell: usize| altitude[cell + 1] - altitude[cell];
        let secant = |cell: usize| (logarithm[cell + 1] - logarithm[cell]) / width(cell);
        let mut slope: Vec<f64> = (0..=last)
            .map(|entry| {
                if entry == 0 || entry == last {
                    return 0.0;
                }
                let [before, after] = [secant(entry - 1), secant(entry)];
                let [left, right] = [width(entry - 1), width(entry)];
                let unlike = (after - before) / (after + before);
                let parabola = (before * right + after * left) / (left + right);
                if unlike.abs() < 1.0 {
                    parabola * (1.0 - unlike.powi(2)).powi(2) * (1.0 + 2.0 * unlike.powi(2))
                } else {
                    0.0
                }
            })
            .collect();
        // Of no curvature at the ends.
        slope[0] = 1.5 * secant(0) - 0.5 * slope[1];
        slope[last] = 1.5 * secant(last - 1) - 0.5 * slope[last - 1];
        let least_scale_height =
            (0..last).map(|cell| -1.0 / secant(cell)).filter(|height| *height > 0.0).fold(f64::MAX, f64::min);
        Self { altitude, logarithm, slope, least_scale_height }
    }

    fn density(&self, altitude: f64) -> f64 {
        let last = self.altitude.len() - 1;
        let line = |entry: usize| self.logarithm[entry] + self.slope[entry] * (altitude - self.altitude[entry]);
        if altitude <= self.altitude[0] {
            return line(0).exp();
        }
        if altitude >= self.altitude[last] {
            return line(last).exp();
        }
        let cell = self.altitude.partition_point(|entry| *entry <= altitude) - 1;
        let width = self.altitude[cell + 1] - self.altitude[cell];
        let t = (altitude - self.altitude[cell]) / width;
        // By the four polynomials of Hermite.
        let value = (1.0 + 2.0 * t) * (1.0 - t).powi(2) * self.logarithm[cell]
            + t * (1.0 - t).powi(2) * width * self.slope[cell]
            + t.powi(2) * (3.0 - 2.0 * t) * self.logarithm[cell + 1]
            + t.powi(2) * (t - 1.0) * width * self.slope[cell + 1];
        value.exp()
    }
}

impl Elsewhere {
    fn new(body: &Body) -> Self {
        let file: Value = serde_json::from_str(body.source).unwrap();
        let number = |pointer: &str| file.pointer(pointer).and_then(Value::as_f64).unwrap();
        let list = |pointer: &str| -> Vec<f64> {
            file.pointer(pointer).unwrap().as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
        };
        Self {
            gravitational_parameter: number("/gravitational_parameter/value"),
            equatorial_radius: number("/equatorial_radius/value"),
            polar_radius: number("/polar_radius/value"),
            rotation_rate: number("/rotation_rate/value"),
            zonal: ["j2", "j3", "j4"].map(|name| number(&format!("/zonal/{name}"))),
            air: Air::new(list("/atmosphere/altitude"), &list("/atmosphere/density")),
        }
    }

    /// GM/r (1 - Σ Jₙ (a/r)ⁿ Pₙ(z/r)).
    fn potential(&self, position: &SVector<DualSVec64<3>, 3>) -> DualSVec64<3> {
        let [x, y, z] = [position[0], position[1], position[2]];
        let radius = (x * x + y * y + z * z).sqrt();
        let sine = z / radius;
        let near = radius.recip() * self.equatorial_radius;
        let square = sine * sine;
        let legendre = [
            (square * 3.0 - 1.0) / 2.0,
            sine * (square * 5.0 - 3.0) / 2.0,
            (square * square * 35.0 - square * 30.0 + 3.0) / 8.0,
        ];
        let powers = [near * near, near * near * near, near * near * near * near];
        let terms = (0..3).map(|n| legendre[n] * powers[n] * self.zonal[n]);
        (terms.fold(DualSVec64::from(1.0), |sum, term| sum - term)) * self.gravitational_parameter / radius
    }

    /// Above the ellipse, along the radius.
    fn altitude(&self, position: &Vector3<f64>) -> f64 {
        let direction = position.normalize();
        let across = direction.xy().norm() / self.equatorial_radius;
        position.norm() - 1.0 / across.hypot(direction.z / self.polar_radius)
    }

    /// Of an inertial position and velocity.
    fn acceleration(&self, lander: &Lander, position: Vector3<f64>, velocity: Vector3<f64>) -> Vector3<f64> {
        let (_, gravity) = gradient(|position| self.potential(&position), &position);
        let air = velocity - Vector3::z().cross(&position) * self.rotation_rate;
        let forward = air.normalize();
        let left = position.cross(&forward).normalize();
        let up = forward.cross(&left);
        let pressure = self.air.density(self.altitude(&position)) * air.norm_squared() / 2.0;
        let lift = (up * lander.bank_angle.cos() + left * lander.bank_angle.sin()) * lander.lift_to_drag;
        gravity + (lift - forward) * (pressure / lander.ballistic_coefficient)
    }

    /// A time in which the air, and the direction of the lift, change by a fiftieth of what they could.
    fn step(&self, lander: &Lander, position: Vector3<f64>, velocity: Vector3<f64>) -> f64 {
        let air = velocity - Vector3::z().cross(&position) * self.rotation_rate;
        let speed = air.norm();
        let lift = self.air.density(self.altitude(&position)) * speed.powi(2) / 2.0 * lander.lift_to_drag
            / lander.ballistic_coefficient;
        // Near the vertical the horizontal speed is small, and its direction is that of the lift.
        let horizontal = position.normalize().cross(&air).norm();
        let turns = horizontal / (lift + 1e-3);
        0.02 * (self.air.least_scale_height / speed).min(turns).clamp(0.05, 20.0)
    }

    /// The planet-fixed position after a time, by the classical Runge-Kutta method.
    fn fly(&self, lander: &Lander, start: &FlightPath<f64>, end: f64) -> Vector3<f64> {
        let start = start.to_planet_fixed();
        let mut position = start.position;
        let mut velocity = start.velocity + Vector3::z().cross(&position) * self.rotation_rate;
        let mut time = 0.0;
        while time < end {
            let step = self.step(lander, position, velocity).min(end - time);
            let rates = |dt: f64, (v, a): (Vector3<f64>, Vector3<f64>)| {
                let velocity = velocity + a * dt;
                (velocity, self.acceleration(lander, position + v * dt, velocity))
            };
            let k1 = rates(0.0, (velocity, Vector3::zeros()));
            let k2 = rates(step / 2.0, k1);
            let k3 = rates(step / 2.0, k2);
            let k4 = rates(step, k3);
            position += (k1.0 + (k2.0 + k3.0) * 2.0 + k4.0) * (step / 6.0);
            velocity += (k1.1 + (k2.1 + k3.1) * 2.0 + k4.1) * (step / 6.0);
            time += step;
        }
        let (sin, cos) = (self.rotation_rate * end).sin_cos();
        Vector3::new(cos * position.x + sin * position.y, cos * position.y - sin * position.x, position.z)
    }
}

#[derive(Clone, Copy, Debug)]
struct Lander {
    ballistic_coefficient: f64,
    lift_to_drag: f64,
    bank_angle: f64,
}

/// Entries at a body, from altitudes, m, at speeds, m/s: steep and shallow, ballistic and lifting, in every direction.
fn random_entry(altitude: [f64; 2], speed: [f64; 2]) -> impl Strategy<Value = (FlightPath<f64>, Lander)> {
    let state = (altitude[0]..altitude[1], -PI..PI, -1.3..1.3, speed[0]..speed[1], -1.2..-0.05, -PI..PI);
    let lander = (20.0..400.0, 0.0..0.4, -PI..PI);
    (state, lander).prop_map(|(state, (ballistic_coefficient, lift_to_drag, bank_angle))| {
        let (radius, longitude, geocentric_latitude, speed, flight_path_angle, heading) = state;
        let start = FlightPath { radius, longitude, geocentric_latitude, speed, flight_path_angle, heading };
        (start, Lander { ballistic_coefficient, lift_to_drag, bank_angle })
    })
}

/// Flies both, for at most some time, s; the radius of the start is its altitude.
fn fly_both(
    name: &str,
    (start, lander): (FlightPath<f64>, Lander),
    longest: f64,
    floor: f64,
) -> Result<(), TestCaseError> {
    let body = BODIES.iter().find(|body| body.name == name).unwrap();
    let elsewhere = Elsewhere::new(body);
    let (sin, cos) = start.geocentric_latitude.sin_cos();
    let surface = 1.0 / (cos / elsewhere.equatorial_radius).hypot(sin / elsewhere.polar_radius);
    let start = FlightPath { radius: surface + start.radius, ..start };
    let case = Case {
        planet: Planet { gravity: Gravity::Zonal(body.zonal()), ..body.planet() },
        atmosphere: body.atmosphere(),
        // Of one square metre and a drag coefficient of 1.
        vehicle: vehicle(lander.ballistic_coefficient, 1.0, lander.lift_to_drag, 1.0),
        control: Control::banked(lander.bank_angle),
        initial_state: start.to_planet_fixed(),
        stop: Stop { altitude: floor, time: longest, ..Stop::default() },
        ..target_2()
    };
    let flight = fly(&case);
    // Near the vertical the lift has no direction, and fades: that is a test of its own.
    prop_assume!(!flight.warnings().iter().any(|warning| matches!(warning, Warning::LiftFadedNearVertical { .. })));
    let finer = fly(&with_tolerance(case, 1e-12));
    let apart = |flight: &Trajectory| {
        let other = elsewhere.fly(&lander, &start, flight.end_time());
        (flight.last().flight_path.to_planet_fixed().position - other).norm()
    };
    // The promise at the default tolerance, and what the other integration is off by.
    prop_assert!(apart(&flight) < 1.0, "{} m after {} s", apart(&flight), flight.end_time());
    prop_assert!(apart(&finer) < 0.05, "{} m after {} s at 1e-12", apart(&finer), finer.end_time());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 0, ..config(8) })]

    #[test]
    fn flights_at_mars_are_those_of_another_integration(entry in random_entry([90e3, 150e3], [3000.0, 7500.0])) {
        fly_both("mars", entry, 600.0, 0.0)?;
    }

    #[test]
    fn flights_at_venus_are_those_of_another_integration(entry in random_entry([120e3, 190e3], [7000.0, 12e3])) {
        fly_both("venus", entry, 300.0, 40e3)?;
    }

    #[test]
    fn flights_at_titan_are_those_of_another_integration(entry in random_entry([500e3, 1200e3], [1500.0, 7000.0])) {
        fly_both("titan", entry, 1000.0, 50e3)?;
    }

    #[test]
    fn flights_at_jupiter_are_those_of_another_integration(entry in random_entry([250e3, 500e3], [40e3, 58e3])) {
        fly_both("jupiter", entry, 300.0, -50e3)?;
    }
}
