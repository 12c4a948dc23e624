//! The types `ecef` and `eci`.

use reentry::coordinates::{Inertial, PlanetFixed};
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::{Frame, Sidereal};
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
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned, within ±1e9. Default 0, or from the
    /// `epoch`. At most one of `sidereal_time` and `sidereal_angle`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
    /// The same as an angle: from the inertial frame to the planet-fixed one, eastwards, within ±2π (±360°).
    #[schema(minimum = -360, maximum = 360)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_angle: Option<f64>,
}

/// Inertial vectors, in the `frame`: by default the planet-fixed one at `sidereal_time` 0, with an `epoch` the equator and origin of date.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Eci {
    /// The kind of state.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The inertial frame. `teme` and `gcrf` need an `epoch` from 1900 to 2100 and an Earth, and no sidereal time or angle; they are good
    /// to 10 m at the surface, but for polar motion (18 m at most) and UT1-UTC (0.9 s at most, 420 m), which are neglected.
    #[schema(required = false, default = "date")]
    pub frame: Frame,
    /// Position [x, y, z], m, each within ±1e12.
    pub position: [f64; 3],
    /// Inertial velocity [x, y, z], m/s; relative to the rotating planet at most 1e6.
    pub velocity: [f64; 3],
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned, within ±1e9. Default 0, or from the
    /// `epoch`. At most one of `sidereal_time` and `sidereal_angle`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
    /// The same as an angle: from the inertial frame to the planet-fixed one, eastwards, within ±2π (±360°).
    #[schema(minimum = -360, maximum = 360)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_angle: Option<f64>,
}

impl Ecef {
    pub(super) fn read(object: &mut Object, has_epoch: bool) -> Option<Self> {
        let (position, velocity) = vectors(object, Bound::VELOCITY);
        let Sidereal { time, angle } = Sidereal::read(object, has_epoch)?;
        Some(Self {
            kind: "ecef",
            position: position?,
            velocity: velocity?,
            sidereal_time: time,
            sidereal_angle: angle,
        })
    }

    /// The planet-fixed vectors.
    pub fn from_core(state: &PlanetFixed<f64>, sidereal: Sidereal) -> Self {
        // The speed was checked, and a part of it may exceed it by a rounding: the answer can be sent back.
        let velocity =
            <[f64; 3]>::from(state.velocity).map(|part| part.clamp(Bound::VELOCITY.minimum, Bound::VELOCITY.maximum));
        Self {
            kind: "ecef",
            position: state.position.into(),
            velocity,
            sidereal_time: sidereal.time,
            sidereal_angle: sidereal.angle,
        }
    }
}

impl Eci {
    pub(super) fn read(object: &mut Object, has_epoch: bool) -> Option<Self> {
        let (position, velocity) = vectors(object, Bound::FINITE);
        let (frame, sidereal) = Frame::read(object, has_epoch);
        Some(Self {
            kind: "eci",
            frame: frame?,
            position: position?,
            velocity: velocity?,
            sidereal_time: sidereal?.time,
            sidereal_angle: sidereal?.angle,
        })
    }

    /// The inertial vectors.
    pub fn from_core(state: &Inertial, frame: Frame, sidereal: Sidereal) -> Self {
        Self {
            kind: "eci",
            frame,
            position: state.position.into(),
            velocity: state.velocity.into(),
            sidereal_time: sidereal.time,
            sidereal_angle: sidereal.angle,
        }
    }
}

/// Position and velocity.
fn vectors(object: &mut Object, velocity: Bound) -> (Option<[f64; 3]>, Option<[f64; 3]>) {
    let position = object.vector("position", Bound::DISTANCE);
    let velocity = object.vector("velocity", velocity);
    (position, velocity)
}
