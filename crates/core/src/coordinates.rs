//! The frames in which a state can be written, and the ways between them.
//!
//! ```text
//!   orbital elements ── inertial ── planet-fixed ── flight path (planet-relative)
//!                                     │      │
//!                              geodetic      inertial flight path
//! ```
//!
//! Everything passes through [`PlanetFixed`]: position and velocity relative to the rotating planet, x through longitude 0
//! on the equator, z along the pole. The [`Inertial`] frame of date shares its z axis; at `sidereal_time` Δt after the two were
//! aligned the planet-fixed frame is turned by ωΔt to the east (Jameson 2006, equation 1). Those of SGP4 and of J2000 lie beside it
//! as the Earth is turned at an instant ([`teme_to_planet_fixed`], [`gcrf_to_planet_fixed`]).
//!
//! Angles are in radians. The angles of a zero velocity are 0, as is the heading of one that has no horizontal part.

mod earth;
mod flight_path;
mod geodetic;
mod great_circle;
mod horizon;
mod inertial;
mod inertial_flight_path;
mod orbital_elements;
mod site;

pub use earth::{
    TESTED_YEARS, earth_rotation_angle, gcrf_to_planet_fixed, greenwich_mean_sidereal_time, teme_to_planet_fixed,
};
pub use flight_path::FlightPath;
pub use geodetic::{Geodetic, latitude_and_altitude};
pub use great_circle::{GreatCircle, ground_rate};
pub use horizon::{horizon, launch_horizon};
pub use inertial::{Inertial, about_pole};
pub use inertial_flight_path::InertialFlightPath;
pub use orbital_elements::{NoElements, OrbitShape, OrbitalElements, UndefinedElements, true_anomaly};
pub use site::Site;

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::elementary::sin_cos;
use crate::scalar::{Scalar, length};

/// Position and velocity relative to the rotating planet, in its own frame (ECEF for the Earth).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanetFixed<S: nalgebra::Scalar> {
    /// Position, m.
    pub position: Vector3<S>,
    /// Velocity relative to the rotating planet, m/s.
    pub velocity: Vector3<S>,
}

/// A rotation of components from one frame to another.
pub type Rotation = Rotation3<f64>;

/// The rotation by an angle, rad, about an axis: x, y or z by its number from 0.
fn rotation_about(axis: usize, angle: f64) -> Rotation {
    let (sine, cosine) = sin_cos(angle);
    let [next, last] = [(axis + 1) % 3, (axis + 2) % 3];
    let mut matrix = Matrix3::identity();
    (matrix[(next, next)], matrix[(next, last)]) = (cosine, -sine);
    (matrix[(last, next)], matrix[(last, last)]) = (sine, cosine);
    Rotation3::from_matrix_unchecked(matrix)
}

/// The directions east, north and up at a place.
#[derive(Clone, Copy, Debug)]
struct LocalHorizon<S: nalgebra::Scalar> {
    east: Vector3<S>,
    north: Vector3<S>,
    up: Vector3<S>,
}

impl<S: Scalar> LocalHorizon<S> {
    /// The horizon whose normal has the given longitude and latitude.
    #[inline(always)]
    fn new(longitude: S, latitude: S) -> Self {
        let (sin_lon, cos_lon) = longitude.sin_cos();
        let (sin_lat, cos_lat) = latitude.sin_cos();
        Self {
            east: Vector3::new(-sin_lon, cos_lon, S::zero()),
            north: Vector3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat),
            up: Vector3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat),
        }
    }

    /// The velocity of the given speed, angle above the horizon, and heading from east towards north.
    #[inline(always)]
    fn velocity(&self, speed: S, flight_path_angle: S, heading: S) -> Vector3<S> {
        let (sin_gamma, cos_gamma) = flight_path_angle.sin_cos();
        let (sin_psi, cos_psi) = heading.sin_cos();
        let along = |axis: &Vector3<S>, component: S| axis.map(|x| x * component);
        along(&self.up, speed * sin_gamma)
            + along(&self.east, speed * cos_gamma * cos_psi)
            + along(&self.north, speed * cos_gamma * sin_psi)
    }

    /// Speed, angle above the horizon, and heading from east towards north; the angles of a zero velocity are 0.
    #[inline(always)]
    fn speed_and_angles(&self, velocity: &Vector3<S>) -> (S, S, S) {
        let [east, north, up] = [&self.east, &self.north, &self.up].map(|axis| axis.dot(velocity));
        let level = (east * east + north * north).sqrt();
        let speed = length(velocity);
        // The arc tangent of signed zeros may be π.
        let or_zero = |angle: S, of: S| S::select(of.less_than(f64::MIN_POSITIVE), S::zero(), angle);
        (speed, or_zero(up.atan2(level), speed), or_zero(north.atan2(east), level))
    }
}

/// Longitude and latitude of a direction.
#[inline(always)]
fn longitude_and_latitude<S: Scalar>(direction: &Vector3<S>) -> (S, S) {
    let [x, y, z] = [direction.x, direction.y, direction.z];
    (y.atan2(x), z.atan2((x * x + y * y).sqrt()))
}

/// The same angle in [0, 2π).
pub fn wrap_to_turn(angle: f64) -> f64 {
    let wrapped = angle.rem_euclid(TAU);
    if wrapped < TAU { wrapped } else { 0.0 }
}

/// The same angle in (-π, π].
pub fn wrap_to_half_turns(angle: f64) -> f64 {
    if -PI < angle && angle <= PI {
        return angle;
    }
    let wrapped = wrap_to_turn(angle);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}
