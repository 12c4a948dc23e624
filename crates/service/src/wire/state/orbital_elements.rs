//! The type `orbital_elements`.

use reentry::coordinates::{self, OrbitShape};
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::{Frame, Sidereal};
use crate::wire::AngleUnit;
use crate::wire::epoch::SiderealTime;
use crate::wire::reader::{Fault, Object};

/// Classical orbital elements in the inertial frame `frame`.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct OrbitalElements {
    /// The kind of state.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The inertial frame. `teme` and `gcrf` need an `epoch` from 1900 to 2100 and an Earth, and no sidereal time or angle; they are good
    /// to 10 m at the surface, but for polar motion (18 m at most) and UT1-UTC (0.9 s at most, 420 m), which are neglected.
    #[schema(required = false, default = "date")]
    pub frame: Frame,
    /// m; positive below eccentricity 1, negative above. Exactly one of `semi_major_axis` and `semi_latus_rectum`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub semi_major_axis: Option<f64>,
    /// m; the only size that a parabola has. Exactly one of `semi_major_axis` and `semi_latus_rectum`.
    #[schema(exclusive_minimum = 0)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub semi_latus_rectum: Option<f64>,
    /// 0 a circle, below 1 an ellipse, 1 a parabola, above a hyperbola.
    #[schema(minimum = 0)]
    pub eccentricity: f64,
    /// Of the orbit's angular momentum to the pole, in [0, π] (180°).
    #[schema(minimum = 0, maximum = 180)]
    pub inclination: f64,
    /// Right ascension of the ascending node, within ±2π (±360°); answers give [0, 2π).
    #[schema(minimum = -360, maximum = 360)]
    pub raan: f64,
    /// From the ascending node to the periapsis, within ±2π (±360°); answers give [0, 2π).
    #[schema(minimum = -360, maximum = 360)]
    pub argument_of_periapsis: f64,
    /// From the periapsis to the vehicle, within ±2π (±360°); answers give [0, 2π). Exactly one of `true_anomaly` and `mean_anomaly`.
    #[schema(minimum = -360, maximum = 360)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub true_anomaly: Option<f64>,
    /// The time since the periapsis as a part of that of a revolution, as an angle within ±2π (±360°); of bound orbits (eccentricity
    /// below 1). Exactly one of `true_anomaly` and `mean_anomaly`.
    #[schema(minimum = -360, maximum = 360)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_anomaly: Option<f64>,
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned, within ±1e9. Default 0, or from the
    /// `epoch`. At most one of `sidereal_time` and `sidereal_angle`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
    /// The same as an angle: from the inertial frame to the planet-fixed one, eastwards, within ±2π (±360°).
    #[schema(minimum = -360, maximum = 360)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_angle: Option<f64>,
}

impl OrbitalElements {
    pub(super) fn read(object: &mut Object, has_epoch: bool) -> Option<Self> {
        let semi_major_axis = object.optional_number("semi_major_axis", Bound::FINITE);
        let semi_latus_rectum = object.optional_number("semi_latus_rectum", Bound::POSITIVE);
        let size = object.exactly_one(&["semi_major_axis", "semi_latus_rectum"]);
        let eccentricity = object.number("eccentricity", Bound::NON_NEGATIVE);
        let inclination = object.angle("inclination", Bound::HALF_TURN);
        let raan = object.angle("raan", Bound::TURN);
        let argument_of_periapsis = object.angle("argument_of_periapsis", Bound::TURN);
        let true_anomaly = object.optional_angle("true_anomaly", Bound::TURN);
        let mean_anomaly = object.optional_angle("mean_anomaly", Bound::TURN);
        let anomaly = object.exactly_one(&["true_anomaly", "mean_anomaly"]);
        let (frame, sidereal) = Frame::read(object, has_epoch);
        size?;
        anomaly?;
        Some(Self {
            kind: "orbital_elements",
            frame: frame?,
            semi_major_axis,
            semi_latus_rectum,
            eccentricity: eccentricity?,
            inclination: inclination?,
            raan: raan?,
            argument_of_periapsis: argument_of_periapsis?,
            true_anomaly,
            mean_anomaly,
            sidereal_time: sidereal?.time,
            sidereal_angle: sidereal?.angle,
        })
    }

    /// The orbit's size must go with its eccentricity, and the vehicle must be on it.
    pub(super) fn faults(&self, pointer: &str, unit: AngleUnit) -> Vec<Fault> {
        let e = self.eccentricity;
        let mut faults = Vec::new();
        match self.semi_major_axis {
            Some(_) if e.total_cmp(&1.0).is_eq() => {
                let detail = "a parabola (eccentricity 1) has no semi-major axis; give semi_latus_rectum in its place";
                faults.push(Fault::new(format!("{pointer}/semi_major_axis"), detail));
            }
            Some(a) if a * (1.0 - e) <= 0.0 => {
                let sign = if e < 1.0 { "positive" } else { "negative" };
                let detail = format!("must be {sign} where the eccentricity is {e}, got {a}");
                faults.push(Fault::new(format!("{pointer}/semi_major_axis"), detail));
            }
            _ => {}
        }
        let reach = self.true_anomaly.map(|anomaly| 1.0 + e * unit.to_radians(anomaly).cos());
        if let Some(reach) = reach.filter(|reach| *reach <= 0.0) {
            let detail =
                format!("lies beyond the asymptote of the orbit: 1 + e cos ν must be greater than 0, got {reach}");
            faults.push(Fault::new(format!("{pointer}/true_anomaly"), detail));
        }
        if self.mean_anomaly.is_some() && e >= 1.0 {
            let detail =
                format!("needs a bound orbit, of an eccentricity below 1, got {e}; give true_anomaly in its place");
            faults.push(Fault::new(format!("{pointer}/mean_anomaly"), detail));
        }
        faults
    }

    pub(super) fn to_core(&self, unit: AngleUnit) -> coordinates::OrbitalElements {
        let shape = match (self.semi_latus_rectum, self.semi_major_axis) {
            (Some(p), _) => OrbitShape::SemiLatusRectum(p),
            (None, a) => OrbitShape::SemiMajorAxis(a.unwrap_or(f64::NAN)),
        };
        let true_anomaly = self.true_anomaly.map(|anomaly| unit.to_radians(anomaly));
        let from_mean =
            self.mean_anomaly.map(|mean| coordinates::true_anomaly(unit.to_radians(mean), self.eccentricity));
        coordinates::OrbitalElements {
            shape,
            eccentricity: self.eccentricity,
            inclination: unit.to_radians(self.inclination),
            raan: unit.to_radians(self.raan),
            argument_of_periapsis: unit.to_radians(self.argument_of_periapsis),
            true_anomaly: true_anomaly.or(from_mean).unwrap_or(f64::NAN),
        }
    }

    /// The elements in the given unit of angles.
    pub fn from_core(
        elements: &coordinates::OrbitalElements,
        unit: AngleUnit,
        frame: Frame,
        sidereal: Sidereal,
    ) -> Self {
        let (semi_major_axis, semi_latus_rectum) = match elements.shape {
            OrbitShape::SemiMajorAxis(a) => (Some(a), None),
            OrbitShape::SemiLatusRectum(p) => (None, Some(p)),
        };
        Self {
            kind: "orbital_elements",
            frame,
            semi_major_axis,
            semi_latus_rectum,
            eccentricity: elements.eccentricity,
            inclination: unit.from_radians(elements.inclination),
            raan: unit.turn_from_radians(elements.raan),
            argument_of_periapsis: unit.turn_from_radians(elements.argument_of_periapsis),
            true_anomaly: Some(unit.turn_from_radians(elements.true_anomaly)),
            mean_anomaly: None,
            sidereal_time: sidereal.time,
            sidereal_angle: sidereal.angle,
        }
    }
}
