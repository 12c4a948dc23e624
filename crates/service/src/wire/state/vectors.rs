//! The types `ecef` and `eci`.

use reentry::coordinates::{Inertial, PlanetFixed};
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::sidereal_time;
use crate::wire::epoch::SiderealTime;
use crate::wire::reader::Object;

/// Planet-fixed vectors, relative to the rotating planet: x through longitude 0 on the equator, z along the pole.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Ecef {
    /// The kind of state.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Position [x, y, z], m, each within ±1e12.
    pub position: [f64; 3],
    /// Velocity [x, y, z] relative to the rotating planet, m/s; its magnitude at most 1e6.
    pub velocity: [f64; 3],
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned. Default 0, or from the `epoch`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
}

/// Inertial vectors: the planet-fixed frame at `sidereal_time` 0; with an `epoch`, the equator and origin of date, not J2000.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Eci {
    /// The kind of state.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Position [x, y, z], m, each within ±1e12.
    pub position: [f64; 3],
    /// Inertial velocity [x, y, z], m/s; relative to the rotating planet at most 1e6.
    pub velocity: [f64; 3],
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned. Default 0, or from the `epoch`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
}

impl Ecef {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let (position, velocity, sidereal_time) = vectors(object, Bound::VELOCITY);
        Some(Self { kind: "ecef", position: position?, velocity: velocity?, sidereal_time })
    }

    /// The planet-fixed vectors.
    pub fn from_core(state: &PlanetFixed<f64>, sidereal_time: f64) -> Self {
        // The speed was checked, and a part of it may exceed it by a rounding: the answer can be sent back.
        let velocity =
            <[f64; 3]>::from(state.velocity).map(|part| part.clamp(Bound::VELOCITY.minimum, Bound::VELOCITY.maximum));
        Self {
            kind: "ecef",
            position: state.position.into(),
            velocity,
            sidereal_time: Some(SiderealTime(sidereal_time)),
        }
    }
}

impl Eci {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let (position, velocity, sidereal_time) = vectors(object, Bound::FINITE);
        Some(Self { kind: "eci", position: position?, velocity: velocity?, sidereal_time })
    }

    /// The inertial vectors.
    pub fn from_core(state: &Inertial, sidereal_time: f64) -> Self {
        Self {
            kind: "eci",
            position: state.position.into(),
            velocity: state.velocity.into(),
            sidereal_time: Some(SiderealTime(sidereal_time)),
        }
    }
}

/// Position, velocity and sidereal time.
fn vectors(object: &mut Object, velocity: Bound) -> (Option<[f64; 3]>, Option<[f64; 3]>, Option<SiderealTime>) {
    let position = object.vector("position", Bound::DISTANCE);
    let velocity = object.vector("velocity", velocity);
    (position, velocity, sidereal_time(object))
}
