//! Coefficients by Mach number.

use crate::interpolation::{self, TableError};

/// Lift and drag coefficients by Mach number.
#[derive(Clone, Debug, PartialEq)]
pub struct MachTable {
    range: [f64; 2],
}

impl MachTable {
    /// The table of Mach numbers, ascending, and coefficients; those of drag are not negative.
    ///
    /// # Errors
    /// When these are not a table.
    pub fn new(mach: &[f64], lift_coefficient: &[f64], drag_coefficient: &[f64]) -> Result<Self, TableError> {
        interpolation::check(mach, &[lift_coefficient, drag_coefficient])?;
        Ok(Self { range: [mach[0], mach[mach.len() - 1]] })
    }

    /// Its least and greatest Mach number.
    pub fn range(&self) -> &[f64; 2] {
        &self.range
    }
}

impl MachTable {
    /// stub
    pub fn coefficients<S: crate::scalar::Scalar>(&self, _: usize, _: S, _: &interpolation::Hint) -> super::Coefficients<S> {
        super::Coefficients { lift: S::zero(), drag: S::zero() }
    }
}
