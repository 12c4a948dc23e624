//! The coefficients of lift and drag of a request.

use std::sync::Arc;

use reentry::scenario::Bound;
use reentry::vehicle::{Aerodynamics, AlphaMachTable, MachTable};

use super::description::{Object, variant};
use super::reader::{MOST_COLUMNS, MOST_ENTRIES, MOST_ROWS};

/// The coefficients of a vehicle.
pub(super) fn aerodynamics(object: &mut Object) -> Option<Aerodynamics> {
    object.named("Aerodynamics", "Lift and drag coefficients.");
    object.variants(
        "Kind of aerodynamics.",
        &[
            variant("constant", "Constant coefficients", "Coefficients that do not depend on speed.", &constant),
            variant(
                "ballistic",
                "Ballistic coefficient",
                "Ballistic coefficient and lift-to-drag ratio that do not depend on speed.",
                &ballistic,
            ),
            variant("mach_table", "Mach number table", "Coefficients by Mach number.", &mach_table),
            variant(
                "alpha_mach_table",
                "Alpha–Mach table",
                "Coefficients by angle of attack and Mach number.",
                &alpha_mach_table,
            ),
        ],
    )
}

/// The `type` of coefficients.
pub(super) fn kind(aerodynamics: &Aerodynamics) -> &'static str {
    match aerodynamics {
        Aerodynamics::Constant { .. } => "constant",
        Aerodynamics::Ballistic { .. } => "ballistic",
        Aerodynamics::MachTable(_) => "mach_table",
        Aerodynamics::AlphaMachTable(_) => "alpha_mach_table",
    }
}

fn constant(object: &mut Object) -> Option<Aerodynamics> {
    object.named("ConstantAerodynamics", "Coefficients that do not depend on speed.");
    let lift_coefficient = object
        .field("lift_coefficient", "Lift coefficient")
        .doc(
            "Lift coefficient; negative lift points down at zero bank angle. Lift fades out within 0.001 rad of the \
             vertical, where the bank angle is undefined.",
        )
        .default(0.0)
        .number(Bound::FINITE);
    let drag_coefficient = object
        .field("drag_coefficient", "Drag coefficient")
        .doc("Drag coefficient. Drag acts against the velocity relative to the air.")
        .number(Bound::NON_NEGATIVE);
    Some(Aerodynamics::Constant { lift_coefficient: lift_coefficient?, drag_coefficient: drag_coefficient? })
}

fn ballistic(object: &mut Object) -> Option<Aerodynamics> {
    object.named("BallisticAerodynamics", "Ballistic coefficient and lift-to-drag ratio that do not depend on speed.");
    let ballistic_coefficient = object
        .field("ballistic_coefficient", "Ballistic coefficient")
        .doc("Mass over the product of drag coefficient and reference area, kg/m².")
        .unit("kg/m²")
        .number(Bound::POSITIVE);
    let lift_to_drag = object
        .field("lift_to_drag", "Lift-to-drag ratio")
        .doc("Lift-to-drag ratio; negative lift points down at zero bank angle.")
        .default(0.0)
        .number(Bound::FINITE);
    Some(Aerodynamics::Ballistic { ballistic_coefficient: ballistic_coefficient?, lift_to_drag: lift_to_drag? })
}

/// Mach numbers of a table.
fn mach_numbers(object: &mut Object, title: &'static str, most: usize) -> Option<Vec<f64>> {
    object
        .field("mach", title)
        .doc("Mach numbers (air speed over speed of sound), ascending.")
        .ascending()
        .numbers(Bound::NON_NEGATIVE, [1, most])
}

fn mach_table(object: &mut Object) -> Option<Aerodynamics> {
    object.named(
        "MachTable",
        "Coefficients by Mach number, interpolated smoothly; outside the table, the values at its ends are used. All \
         lists must have the same length. The atmosphere must have a speed of sound.",
    );
    let mach = mach_numbers(object, "Mach", MOST_ENTRIES);
    let lift_coefficient = object
        .field("lift_coefficient", "Lift coefficient")
        .doc("Lift coefficients; negative lift points down at zero bank angle.")
        .numbers(Bound::FINITE, [1, MOST_ENTRIES]);
    let drag_coefficient = object
        .field("drag_coefficient", "Drag coefficient")
        .doc("Drag coefficients, at least 0.")
        .numbers(Bound::NON_NEGATIVE, [1, MOST_ENTRIES]);
    let sound = object.equally_long("mach", &["lift_coefficient", "drag_coefficient"]);
    let (mach, lift_coefficient, drag_coefficient) = (mach?, lift_coefficient?, drag_coefficient?);
    let table = sound.then(|| MachTable::new(&mach, &lift_coefficient, &drag_coefficient))?;
    Some(Aerodynamics::MachTable(Arc::new(object.sound(table)?)))
}

fn alpha_mach_table(object: &mut Object) -> Option<Aerodynamics> {
    object.named(
        "AlphaMachTable",
        "Coefficients by angle of attack and Mach number, interpolated smoothly; outside the table, the values at its \
         edges are used. Each coefficient has one row per angle of attack, with one number per Mach number. The \
         atmosphere must have a speed of sound.",
    );
    let angle_of_attack = object
        .field("angle_of_attack", "Angles of attack (rows)")
        .doc("Angles of attack, ascending, within ±2π (±360°).")
        .ascending()
        .angles(Bound::TURN, MOST_ROWS);
    let mach = mach_numbers(object, "Mach numbers (columns)", MOST_COLUMNS);
    let lift_coefficient = object
        .field("lift_coefficient", "Lift coefficients")
        .doc("Lift coefficients; negative lift points down at zero bank angle.")
        .matrix(Bound::FINITE, "mach");
    let drag_coefficient = object
        .field("drag_coefficient", "Drag coefficients")
        .doc("Drag coefficients, at least 0.")
        .matrix(Bound::NON_NEGATIVE, "mach");
    let sound = object.equally_long("angle_of_attack", &["lift_coefficient", "drag_coefficient"]);
    let (angle_of_attack, mach) = (angle_of_attack?, mach?);
    let (lift_coefficient, drag_coefficient) = (lift_coefficient?, drag_coefficient?);
    let table = sound.then(|| AlphaMachTable::new(&angle_of_attack, &mach, &lift_coefficient, &drag_coefficient))?;
    Some(Aerodynamics::AlphaMachTable(Arc::new(object.sound(table)?)))
}
