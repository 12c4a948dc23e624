//! Speed and angles relative to the planet: the thesis's vehicle-pointing system.

use nalgebra::Vector3;

use super::{LocalHorizon, PlanetFixed, longitude_and_latitude, wrap_to_half_turns};
use crate::scalar::{Scalar, length};

/// Place and motion relative to the rotating planet, against the geocentric local horizontal (the plane normal to the radius).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightPath<S> {
    /// r, distance from the planet's centre, m.
    pub radius: S,
    /// θ, east positive, in (-π, π].
    pub longitude: S,
    /// φ, geocentric, in [-π/2, π/2].
    pub geocentric_latitude: S,
    /// V, relative to the rotating planet, m/s.
    pub speed: S,
    /// γ, of the relative velocity above the local horizontal, in [-π/2, π/2].
    pub flight_path_angle: S,
    /// ψ, from the local parallel of latitude (east 0) towards north (π/2), in (-π, π].
    pub heading: S,
}

impl<S: Scalar> FlightPath<S> {
    /// The same state in the planet-fixed frame.
    #[inline(always)]
    pub fn to_planet_fixed(&self) -> PlanetFixed<S> {
        let horizon = LocalHorizon::new(self.longitude, self.geocentric_latitude);
        PlanetFixed {
            position: horizon.up.map(|component| component * self.radius),
            velocity: horizon.velocity(self.speed, self.flight_path_angle, self.heading),
        }
    }

    /// The state of a planet-fixed position and velocity.
    #[inline(always)]
    pub fn from_planet_fixed(state: &PlanetFixed<S>) -> Self {
        let (longitude, geocentric_latitude) = longitude_and_latitude(&state.position);
        let horizon = LocalHorizon::new(longitude, geocentric_latitude);
        let (speed, flight_path_angle, heading) = horizon.speed_and_angles(&state.velocity);
        Self { radius: length(&state.position), longitude, geocentric_latitude, speed, flight_path_angle, heading }
    }
}

impl FlightPath<f64> {
    /// The same state with longitude and heading in (-π, π].
    #[must_use]
    pub fn wrapped(self) -> Self {
        Self { longitude: wrap_to_half_turns(self.longitude), heading: wrap_to_half_turns(self.heading), ..self }
    }
}

impl<S: Scalar> From<[S; 6]> for FlightPath<S> {
    #[inline(always)]
    fn from([radius, longitude, geocentric_latitude, speed, flight_path_angle, heading]: [S; 6]) -> Self {
        Self { radius, longitude, geocentric_latitude, speed, flight_path_angle, heading }
    }
}

impl<S> From<FlightPath<S>> for [S; 6] {
    #[inline(always)]
    fn from(state: FlightPath<S>) -> Self {
        let FlightPath { radius, longitude, geocentric_latitude, speed, flight_path_angle, heading } = state;
        [radius, longitude, geocentric_latitude, speed, flight_path_angle, heading]
    }
}

impl<S: Scalar> From<[S; 6]> for PlanetFixed<S> {
    #[inline(always)]
    fn from([x, y, z, vx, vy, vz]: [S; 6]) -> Self {
        Self { position: Vector3::new(x, y, z), velocity: Vector3::new(vx, vy, vz) }
    }
}

impl<S: Scalar> From<PlanetFixed<S>> for [S; 6] {
    #[inline(always)]
    fn from(PlanetFixed { position, velocity }: PlanetFixed<S>) -> Self {
        [position.x, position.y, position.z, velocity.x, velocity.y, velocity.z]
    }
}
