//! The six forms of a state in answers: each can be sent back as it is.

use reentry::coordinates::{
    FlightPath, Geodetic, Inertial, InertialFlightPath, OrbitShape, OrbitalElements, PlanetFixed,
};
use reentry::scenario::Bound;
use serde_json::{Value, json};

use super::fields::FRAMES;
use super::{Frame, Sidereal};
use crate::wire::AngleUnit;

impl Sidereal {
    /// The form of a state, with the time or the angle beside it.
    fn beside(self, mut state: Value) -> Value {
        if let Some(time) = self.time {
            state["sidereal_time"] = json!(time);
        }
        if let Some(angle) = self.angle {
            state["sidereal_angle"] = json!(angle);
        }
        state
    }
}

/// The form `planet_relative`.
pub fn planet_relative(state: &FlightPath<f64>, unit: AngleUnit, sidereal: Sidereal) -> Value {
    sidereal.beside(json!({
        "type": "planet_relative",
        "radius": within(Bound::RADIUS, state.radius),
        "longitude": unit.from_radians(state.longitude),
        "geocentric_latitude": unit.from_radians(state.geocentric_latitude),
        "speed": within(Bound::SPEED, state.speed),
        "flight_path_angle": unit.from_radians(state.flight_path_angle),
        "heading": unit.from_radians(state.heading),
    }))
}

/// The form `geodetic`.
pub fn geodetic(state: &Geodetic, unit: AngleUnit, sidereal: Sidereal) -> Value {
    sidereal.beside(json!({
        "type": "geodetic",
        "geodetic_altitude": state.geodetic_altitude,
        "longitude": unit.from_radians(state.longitude),
        "geodetic_latitude": unit.from_radians(state.geodetic_latitude),
        "speed": within(Bound::SPEED, state.speed),
        "flight_path_angle": unit.from_radians(state.flight_path_angle),
        "azimuth": unit.turn_from_radians(state.azimuth),
    }))
}

/// The form `ecef`.
pub fn ecef(state: &PlanetFixed<f64>, sidereal: Sidereal) -> Value {
    // The speed was checked, and a part of it may exceed it by a rounding: the answer can be sent back.
    let velocity =
        <[f64; 3]>::from(state.velocity).map(|part| part.clamp(Bound::VELOCITY.minimum, Bound::VELOCITY.maximum));
    sidereal.beside(json!({"type": "ecef", "position": <[f64; 3]>::from(state.position), "velocity": velocity}))
}

/// The form `eci`.
pub fn eci(state: &Inertial, frame: Frame, sidereal: Sidereal) -> Value {
    sidereal.beside(json!({
        "type": "eci",
        "frame": FRAMES.of(frame),
        "position": <[f64; 3]>::from(state.position),
        "velocity": <[f64; 3]>::from(state.velocity),
    }))
}

/// The form `orbital_elements`.
pub fn orbital_elements(elements: &OrbitalElements, unit: AngleUnit, frame: Frame, sidereal: Sidereal) -> Value {
    let (name, size) = match elements.shape {
        OrbitShape::SemiMajorAxis(size) => ("semi_major_axis", size),
        OrbitShape::SemiLatusRectum(size) => ("semi_latus_rectum", size),
    };
    sidereal.beside(json!({
        "type": "orbital_elements",
        "frame": FRAMES.of(frame),
        (name): size,
        "eccentricity": elements.eccentricity,
        "inclination": unit.from_radians(elements.inclination),
        "raan": unit.turn_from_radians(elements.raan),
        "argument_of_periapsis": unit.turn_from_radians(elements.argument_of_periapsis),
        "true_anomaly": unit.turn_from_radians(elements.true_anomaly),
    }))
}

/// The form `inertial_flight_path`.
pub fn inertial_flight_path(state: &InertialFlightPath, unit: AngleUnit, sidereal: Sidereal) -> Value {
    sidereal.beside(json!({
        "type": "inertial_flight_path",
        "radius": within(Bound::RADIUS, state.radius),
        "longitude": unit.from_radians(state.longitude),
        "geocentric_latitude": unit.from_radians(state.geocentric_latitude),
        "inertial_speed": state.inertial_speed,
        "inertial_flight_path_angle": unit.from_radians(state.inertial_flight_path_angle),
        "inertial_heading": unit.from_radians(state.inertial_heading),
    }))
}

/// The length of a vector that was checked against the bound, and may exceed it by a rounding: the answer can be sent back.
fn within(bound: Bound, length: f64) -> f64 {
    length.min(bound.maximum)
}
