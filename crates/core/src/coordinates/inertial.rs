//! The inertial frame, from which the planet turns away.

use std::f64::consts::TAU;

use nalgebra::{Rotation3, Vector3};

use super::PlanetFixed;
use crate::planet::Planet;

/// Position and velocity in the inertial frame (ECI): the planet's pole is z, and x is where longitude 0 was at `sidereal_time` 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// Position, m.
    pub position: Vector3<f64>,
    /// Inertial velocity, m/s.
    pub velocity: Vector3<f64>,
}

impl Inertial {
    /// The same state relative to the planet, `sidereal_time` seconds after the frames were aligned.
    ///
    /// ```text
    /// r = R_z(-ωΔt) r_i,   v = R_z(-ωΔt) (v_i - ω × r_i)
    /// ```
    pub fn to_planet_fixed(&self, planet: &Planet, sidereal_time: f64) -> PlanetFixed<f64> {
        let to_planet = rotation(planet, sidereal_time).inverse();
        let relative = self.velocity - rotation_vector(planet).cross(&self.position);
        PlanetFixed { position: to_planet * self.position, velocity: to_planet * relative }
    }

    /// The inertial state of a planet-fixed one, `sidereal_time` seconds after the frames were aligned.
    pub fn from_planet_fixed(state: &PlanetFixed<f64>, planet: &Planet, sidereal_time: f64) -> Self {
        let from_planet = rotation(planet, sidereal_time);
        let inertial = state.velocity + rotation_vector(planet).cross(&state.position);
        Self { position: from_planet * state.position, velocity: from_planet * inertial }
    }
}

/// The rotation that takes planet-fixed components to inertial ones.
fn rotation(planet: &Planet, sidereal_time: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), planet.rotation_rate * sidereal_time)
}

/// ω, rad/s: along the pole.
pub(super) fn rotation_vector(planet: &Planet) -> Vector3<f64> {
    Vector3::z() * planet.rotation_rate
}

/// The angle by which the Earth is turned against the celestial intermediate origin of date, in [0, 2π),
/// `days` (of 86 400 s of UT1) after 2000 January 1, 12 h UT1.
///
/// ```text
/// ERA = 2π (0.7790572732640 + 1.00273781191135448 D)
/// ```
///
/// # Reference
/// IERS Conventions (2010), equation 5.15.
pub fn earth_rotation_angle(days: f64) -> f64 {
    // The whole turns of D fall out first, so that the digits of its fraction remain.
    let turns = days.fract() + 0.779_057_273_264_0 + 0.002_737_811_911_354_48 * days;
    super::wrap_to_turn(TAU * turns.fract())
}
