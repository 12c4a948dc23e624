//! Speed and angles of the inertial velocity at a planet-fixed place: the entry interface as flight reports quote it.

use super::inertial::rotation_vector;
use super::{LocalHorizon, PlanetFixed, longitude_and_latitude, wrap_to_half_turns};
use crate::planet::Planet;

/// A place on the rotating planet, and the inertial velocity there against the geocentric local horizontal (the plane normal to
/// the radius).
///
/// The velocity is that of the [`Inertial`](super::Inertial) frame, written by east, north and up at the place. On a planet that
/// does not rotate these are the quantities of the [`FlightPath`](super::FlightPath).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialFlightPath {
    /// r, distance from the planet's centre, m.
    pub radius: f64,
    /// θ, planet-fixed, east positive, in (-π, π].
    pub longitude: f64,
    /// φ, geocentric, in [-π/2, π/2].
    pub geocentric_latitude: f64,
    /// Magnitude of the inertial velocity, m/s.
    pub inertial_speed: f64,
    /// Of the inertial velocity above the local horizontal, in [-π/2, π/2].
    pub inertial_flight_path_angle: f64,
    /// Of the inertial velocity, from the local parallel of latitude (east 0) towards north (π/2), in (-π, π].
    pub inertial_heading: f64,
}

impl InertialFlightPath {
    /// The same state in the planet-fixed frame.
    ///
    /// ```text
    /// v = v_i - ω × r
    /// ```
    pub fn to_planet_fixed(&self, planet: &Planet) -> PlanetFixed<f64> {
        let horizon = LocalHorizon::new(self.longitude, self.geocentric_latitude);
        let position = horizon.up * self.radius;
        let inertial = horizon.velocity(self.inertial_speed, self.inertial_flight_path_angle, self.inertial_heading);
        PlanetFixed { position, velocity: inertial - rotation_vector(planet).cross(&position) }
    }

    /// The state of a planet-fixed position and velocity.
    pub fn from_planet_fixed(state: &PlanetFixed<f64>, planet: &Planet) -> Self {
        let (longitude, geocentric_latitude) = longitude_and_latitude(&state.position);
        let horizon = LocalHorizon::new(longitude, geocentric_latitude);
        let inertial = state.velocity + rotation_vector(planet).cross(&state.position);
        let (inertial_speed, inertial_flight_path_angle, heading) = horizon.speed_and_angles(&inertial);
        Self {
            radius: state.position.norm(),
            longitude: wrap_to_half_turns(longitude),
            geocentric_latitude,
            inertial_speed,
            inertial_flight_path_angle,
            inertial_heading: wrap_to_half_turns(heading),
        }
    }
}
