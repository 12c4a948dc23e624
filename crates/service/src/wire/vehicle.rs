//! The vehicle of a request.

use std::sync::Arc;

use reentry::scenario::Bound;
use reentry::vehicle::{
    Aerodynamics as CoreAerodynamics, AlphaMachTable as CoreAlphaMachTable, MachTable as CoreMachTable,
    Vehicle as CoreVehicle,
};
use serde::Serialize;
use utoipa::ToSchema;

use super::reader::{MOST_COLUMNS, MOST_ENTRIES, MOST_ROWS, Object};

/// A point mass with lift and drag.
#[derive(Clone, Debug, ToSchema)]
pub struct Vehicle {
    /// kg.
    #[schema(exclusive_minimum = 0)]
    pub mass: f64,
    /// The area to which the coefficients refer, m²; required, but with `ballistic` aerodynamics, which take none.
    #[schema(required = false, value_type = f64, minimum = 0)]
    pub reference_area: Option<f64>,
    /// Lift and drag.
    pub aerodynamics: Aerodynamics,
    /// Of the nose at its stagnation point, m; required with `heating`.
    #[schema(required = false, value_type = f64, exclusive_minimum = 0)]
    pub nose_radius: Option<f64>,
}

/// Lift and drag coefficients.
#[derive(Clone, Debug, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(
    ("constant" = "#/components/schemas/ConstantAerodynamics"),
    ("ballistic" = "#/components/schemas/BallisticAerodynamics"),
    ("mach_table" = "#/components/schemas/MachTable"),
    ("alpha_mach_table" = "#/components/schemas/AlphaMachTable"),
)))]
pub enum Aerodynamics {
    /// The same at every speed.
    Constant(ConstantAerodynamics),
    /// The same at every speed, by ratios.
    Ballistic(BallisticAerodynamics),
    /// By Mach number.
    MachTable(MachTable),
    /// By angle of attack and Mach number.
    AlphaMachTable(AlphaMachTable),
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
    /// Drag acts against the velocity relative to the air.
    #[schema(minimum = 0)]
    pub drag_coefficient: f64,
}

/// Coefficients that are the same at every speed, by the ratios on which the flight depends.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct BallisticAerodynamics {
    /// The kind of aerodynamics.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Mass over drag coefficient and reference area, kg/m².
    #[schema(exclusive_minimum = 0)]
    pub ballistic_coefficient: f64,
    /// Lift over drag; negative lift points down at zero bank.
    #[schema(required = false, default = 0)]
    pub lift_to_drag: f64,
}

/// Coefficients by Mach number, smooth between the entries; beyond the first and the last their values hold. All lists have as many.
/// Needs an atmosphere that has a speed of sound.
// The numbers stand here for the schema; what flies is `core`.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct MachTable {
    /// The kind of aerodynamics.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The speed relative to the air over that of sound, ascending.
    #[schema(min_items = 1, max_items = 10_000)]
    pub mach: Vec<f64>,
    /// Negative lift points down at zero bank.
    #[schema(min_items = 1, max_items = 10_000)]
    pub lift_coefficient: Vec<f64>,
    /// At least 0.
    #[schema(min_items = 1, max_items = 10_000)]
    pub drag_coefficient: Vec<f64>,
    /// The same, for the core.
    #[serde(skip)]
    #[schema(ignore)]
    pub core: Arc<CoreMachTable>,
}

/// Coefficients by angle of attack and Mach number, smooth between the entries; beyond the first and the last their values hold.
/// Of each coefficient a row for every angle of attack, with a number for every Mach number.
/// Needs an atmosphere that has a speed of sound.
// The numbers stand here for the schema; what flies is `core`.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct AlphaMachTable {
    /// The kind of aerodynamics.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Ascending, within ±2π (±360°).
    #[schema(min_items = 1, max_items = 100)]
    pub angle_of_attack: Vec<f64>,
    /// The speed relative to the air over that of sound, ascending.
    #[schema(min_items = 1, max_items = 1000)]
    pub mach: Vec<f64>,
    /// Negative lift points down at zero bank.
    #[schema(min_items = 1, max_items = 100)]
    pub lift_coefficient: Vec<Vec<f64>>,
    /// At least 0.
    #[schema(min_items = 1, max_items = 100)]
    pub drag_coefficient: Vec<Vec<f64>>,
    /// The same, for the core.
    #[serde(skip)]
    #[schema(ignore)]
    pub core: Arc<CoreAlphaMachTable>,
}

impl Vehicle {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let mass = object.number("mass", Bound::POSITIVE);
        let by_area = !object.is_of_kind("aerodynamics", "ballistic");
        let reference_area = by_area.then(|| object.number("reference_area", Bound::NON_NEGATIVE));
        let aerodynamics = object.object("aerodynamics", Aerodynamics::read);
        let nose_radius = object.optional_number("nose_radius", Bound::POSITIVE);
        let reference_area = if by_area { Some(reference_area.flatten()?) } else { None };
        Some(Self { mass: mass?, reference_area, aerodynamics: aerodynamics?, nose_radius })
    }

    pub(super) fn to_core(&self) -> CoreVehicle {
        CoreVehicle {
            mass: self.mass,
            // With ratios alone, any area does.
            reference_area: self.reference_area.unwrap_or(1.0),
            aerodynamics: self.aerodynamics.to_core(),
            nose_radius: self.nose_radius,
        }
    }
}

impl Aerodynamics {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let read = object.choice::<fn(&mut Object) -> Option<Self>>(
            "type",
            &[
                ("constant", |object| ConstantAerodynamics::read(object).map(Self::Constant)),
                ("ballistic", |object| BallisticAerodynamics::read(object).map(Self::Ballistic)),
                ("mach_table", |object| MachTable::read(object).map(Self::MachTable)),
                ("alpha_mach_table", |object| AlphaMachTable::read(object).map(Self::AlphaMachTable)),
            ],
        )?;
        read(object)
    }

    pub(super) fn to_core(&self) -> CoreAerodynamics {
        match self {
            Self::Constant(ConstantAerodynamics { lift_coefficient, drag_coefficient, .. }) => {
                CoreAerodynamics::Constant { lift_coefficient: *lift_coefficient, drag_coefficient: *drag_coefficient }
            }
            Self::Ballistic(BallisticAerodynamics { ballistic_coefficient, lift_to_drag, .. }) => {
                CoreAerodynamics::Ballistic {
                    ballistic_coefficient: *ballistic_coefficient,
                    lift_to_drag: *lift_to_drag,
                }
            }
            Self::MachTable(table) => CoreAerodynamics::MachTable(Arc::clone(&table.core)),
            Self::AlphaMachTable(table) => CoreAerodynamics::AlphaMachTable(Arc::clone(&table.core)),
        }
    }

    /// Its `type`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Constant(ConstantAerodynamics { kind, .. })
            | Self::Ballistic(BallisticAerodynamics { kind, .. })
            | Self::MachTable(MachTable { kind, .. })
            | Self::AlphaMachTable(AlphaMachTable { kind, .. }) => kind,
        }
    }
}

impl ConstantAerodynamics {
    fn read(object: &mut Object) -> Option<Self> {
        let lift_coefficient = object.number_or("lift_coefficient", Bound::FINITE, 0.0);
        let drag_coefficient = object.number("drag_coefficient", Bound::NON_NEGATIVE);
        Some(Self { kind: "constant", lift_coefficient: lift_coefficient?, drag_coefficient: drag_coefficient? })
    }
}

impl BallisticAerodynamics {
    fn read(object: &mut Object) -> Option<Self> {
        let ballistic_coefficient = object.number("ballistic_coefficient", Bound::POSITIVE);
        let lift_to_drag = object.number_or("lift_to_drag", Bound::FINITE, 0.0);
        Some(Self { kind: "ballistic", ballistic_coefficient: ballistic_coefficient?, lift_to_drag: lift_to_drag? })
    }
}

/// Mach numbers, ascending.
fn read_mach(object: &mut Object, most: usize) -> Option<Vec<f64>> {
    let mach = object.entries("mach", Bound::NON_NEGATIVE, [1, most]);
    mach.filter(|mach| object.ascending("mach", "", mach))
}

impl MachTable {
    fn read(object: &mut Object) -> Option<Self> {
        let mach = read_mach(object, MOST_ENTRIES);
        let lift_coefficient = object.entries("lift_coefficient", Bound::FINITE, [1, MOST_ENTRIES]);
        let drag_coefficient = object.entries("drag_coefficient", Bound::NON_NEGATIVE, [1, MOST_ENTRIES]);
        let sound = object.equally_long("mach", &["lift_coefficient", "drag_coefficient"]);
        let (mach, lift_coefficient, drag_coefficient) = (mach?, lift_coefficient?, drag_coefficient?);
        if !sound {
            return None;
        }
        let core = CoreMachTable::new(&mach, &lift_coefficient, &drag_coefficient);
        let core = Arc::new(object.sound(core)?);
        Some(Self { kind: "mach_table", mach, lift_coefficient, drag_coefficient, core })
    }
}

impl AlphaMachTable {
    fn read(object: &mut Object) -> Option<Self> {
        let angle_of_attack = object.angles("angle_of_attack", Bound::TURN, MOST_ROWS);
        let angle_of_attack = angle_of_attack.filter(|angles| object.ascending("angle_of_attack", "", angles));
        let mach = read_mach(object, MOST_COLUMNS);
        let lift_coefficient = object.matrix("lift_coefficient", Bound::FINITE, "mach");
        let drag_coefficient = object.matrix("drag_coefficient", Bound::NON_NEGATIVE, "mach");
        let sound = object.equally_long("angle_of_attack", &["lift_coefficient", "drag_coefficient"]);
        let (angle_of_attack, mach) = (angle_of_attack?, mach?);
        let (lift_coefficient, drag_coefficient, unit) = (lift_coefficient?, drag_coefficient?, object.unit()?);
        if !sound {
            return None;
        }
        let radians: Vec<_> = angle_of_attack.iter().map(|angle| unit.to_radians(*angle)).collect();
        let core = CoreAlphaMachTable::new(&radians, &mach, &lift_coefficient, &drag_coefficient);
        let core = Arc::new(object.sound(core)?);
        Some(Self { kind: "alpha_mach_table", angle_of_attack, mach, lift_coefficient, drag_coefficient, core })
    }
}
