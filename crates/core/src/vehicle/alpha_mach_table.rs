//! Coefficients by angle of attack and Mach number.

use crate::interpolation::{self, TableError};

/// Lift and drag coefficients by angle of attack and Mach number.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaMachTable {
    angle_of_attack_range: [f64; 2],
    mach_range: [f64; 2],
}

impl AlphaMachTable {
    /// The table of angles of attack, rad, and Mach numbers, both ascending, and coefficients, a row an angle of attack;
    /// those of drag are not negative.
    ///
    /// # Errors
    /// When these are not a table.
    pub fn new(
        angle_of_attack: &[f64],
        mach: &[f64],
        lift_coefficient: &[Vec<f64>],
        drag_coefficient: &[Vec<f64>],
    ) -> Result<Self, TableError> {
        interpolation::check(angle_of_attack, &[])?;
        for row in lift_coefficient.iter().chain(drag_coefficient) {
            interpolation::check(mach, &[row])?;
        }
        Ok(Self {
            angle_of_attack_range: [angle_of_attack[0], angle_of_attack[angle_of_attack.len() - 1]],
            mach_range: [mach[0], mach[mach.len() - 1]],
        })
    }

    /// Its least and greatest angle of attack, rad.
    pub fn angle_of_attack_range(&self) -> &[f64; 2] {
        &self.angle_of_attack_range
    }

    /// Its least and greatest Mach number.
    pub fn mach_range(&self) -> &[f64; 2] {
        &self.mach_range
    }
}

impl AlphaMachTable {
    /// stub
    pub fn coefficients<S: crate::scalar::Scalar>(&self, _: [usize; 2], _: S, _: S, _: [&interpolation::Hint; 2]) -> super::Coefficients<S> {
        super::Coefficients { lift: S::zero(), drag: S::zero() }
    }
}
