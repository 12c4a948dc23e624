//! The vehicle of a request, and how it is flown.

use reentry::scenario::Bound;
use reentry::vehicle::{Aerodynamics as CoreAerodynamics, Vehicle as CoreVehicle};
use serde::Serialize;
use utoipa::ToSchema;

use super::reader::Object;

/// A point mass with lift and drag.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Vehicle {
    /// kg.
    #[schema(exclusive_minimum = 0)]
    pub mass: f64,
    /// The area to which the coefficients refer, m².
    #[schema(minimum = 0)]
    pub reference_area: f64,
    /// Lift and drag.
    pub aerodynamics: Aerodynamics,
}

/// Lift and drag coefficients.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(("constant" = "#/components/schemas/ConstantAerodynamics"))))]
pub enum Aerodynamics {
    /// The same at every speed.
    Constant(ConstantAerodynamics),
}

/// Coefficients that are the same at every speed.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct ConstantAerodynamics {
    /// The kind of aerodynamics.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Negative lift points down at zero bank. Lift fades out within 0.001 rad of the vertical, where the bank angle is undefined.
    #[schema(required = false, default = 0)]
    pub lift_coefficient: f64,
    /// Drag acts against the velocity relative to the rotating planet.
    #[schema(minimum = 0)]
    pub drag_coefficient: f64,
}

/// How the vehicle is flown.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Control {
    /// 0: lift upward in the plane of radius and velocity; positive tilts it to the left of the flight direction. Within ±2π (±360°).
    #[schema(required = false, minimum = -360, maximum = 360, default = 0)]
    pub bank_angle: f64,
}

impl Vehicle {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let mass = object.number("mass", Bound::POSITIVE);
        let reference_area = object.number("reference_area", Bound::NON_NEGATIVE);
        let aerodynamics = object.object("aerodynamics", Aerodynamics::read);
        Some(Self { mass: mass?, reference_area: reference_area?, aerodynamics: aerodynamics? })
    }

    pub(super) fn to_core(self) -> CoreVehicle {
        let Aerodynamics::Constant(ConstantAerodynamics { lift_coefficient, drag_coefficient, .. }) = self.aerodynamics;
        CoreVehicle {
            mass: self.mass,
            reference_area: self.reference_area,
            aerodynamics: CoreAerodynamics::Constant { lift_coefficient, drag_coefficient },
        }
    }
}

impl Aerodynamics {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        object.choice("type", &[("constant", ())])?;
        let lift_coefficient = object.number_or("lift_coefficient", Bound::FINITE, 0.0);
        let drag_coefficient = object.number("drag_coefficient", Bound::NON_NEGATIVE);
        Some(Self::Constant(ConstantAerodynamics {
            kind: "constant",
            lift_coefficient: lift_coefficient?,
            drag_coefficient: drag_coefficient?,
        }))
    }
}

impl Control {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        Some(Self { bank_angle: object.angle_or("bank_angle", Bound::TURN, 0.0)? })
    }
}
