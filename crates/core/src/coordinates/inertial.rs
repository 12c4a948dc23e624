//! The inertial frame, from which the planet turns away.

use nalgebra::Vector3;

use super::{PlanetFixed, Rotation, rotation_about};
use crate::planet::Planet;

/// Position and velocity in an inertial frame (ECI): in that of date the planet's pole is z, and x is where longitude 0 was at
/// `sidereal_time` 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// Position, m.
    pub position: Vector3<f64>,
    /// Inertial velocity, m/s.
    pub velocity: Vector3<f64>,
}

impl Inertial {
    /// The same state relative to the planet, `sidereal_time` seconds after the frames were aligned.
    pub fn to_planet_fixed(&self, planet: &Planet, sidereal_time: f64) -> PlanetFixed<f64> {
        self.to_planet_fixed_by(planet, &about_pole(planet.rotation_rate * sidereal_time))
    }

    /// The inertial state of a planet-fixed one, `sidereal_time` seconds after the frames were aligned.
    pub fn from_planet_fixed(state: &PlanetFixed<f64>, planet: &Planet, sidereal_time: f64) -> Self {
        Self::from_planet_fixed_by(state, planet, &about_pole(planet.rotation_rate * sidereal_time))
    }

    /// The same state relative to the planet, by the rotation Q that takes inertial components to planet-fixed ones.
    ///
    /// ```text
    /// r = Q r_i,   v = Q v_i - ω × r
    /// ```
    pub fn to_planet_fixed_by(&self, planet: &Planet, rotation: &Rotation) -> PlanetFixed<f64> {
        let position = rotation * self.position;
        let velocity = rotation * self.velocity - rotation_vector(planet).cross(&position);
        PlanetFixed { position, velocity }
    }

    /// The inertial state of a planet-fixed one, by the rotation that takes inertial components to planet-fixed ones.
    pub fn from_planet_fixed_by(state: &PlanetFixed<f64>, planet: &Planet, rotation: &Rotation) -> Self {
        let inertial = state.velocity + rotation_vector(planet).cross(&state.position);
        let from_planet = rotation.inverse();
        Self { position: from_planet * state.position, velocity: from_planet * inertial }
    }
}

/// The rotation that takes inertial components to planet-fixed ones, where the planet is turned from its own pole's inertial frame by
/// the angle.
pub fn about_pole(angle: f64) -> Rotation {
    rotation_about(2, -angle)
}

/// ω, rad/s: along the pole.
pub(super) fn rotation_vector(planet: &Planet) -> Vector3<f64> {
    Vector3::z() * planet.rotation_rate
}
