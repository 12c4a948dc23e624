//! Coefficients by Mach number.

use super::Coefficients;
use crate::interpolation::{Cubics, Hint, TableError};
use crate::scalar::Scalar;

/// Lift and drag coefficients by Mach number; below the first and above the last they stay as they are there.
#[derive(Clone, Debug, PartialEq)]
pub struct MachTable {
    /// `C_L` and `C_D`.
    coefficients: Cubics<2>,
    has_lift: bool,
}

impl MachTable {
    /// The table of Mach numbers, ascending, and coefficients; those of drag are not negative.
    ///
    /// # Errors
    /// When these are not a table.
    pub fn new(mach: &[f64], lift_coefficient: &[f64], drag_coefficient: &[f64]) -> Result<Self, TableError> {
        let coefficients = Cubics::new(mach, [lift_coefficient, drag_coefficient])?;
        match drag_coefficient.iter().position(|drag| *drag < 0.0) {
            Some(index) => Err(TableError::OutOfBounds { index }),
            None => Ok(Self { coefficients, has_lift: lift_coefficient.iter().any(|lift| *lift != 0.0) }),
        }
    }

    /// Its least and greatest Mach number.
    pub fn range(&self) -> &[f64; 2] {
        self.coefficients.range()
    }

    /// The Mach numbers between them.
    pub fn inner(&self) -> &[f64] {
        self.coefficients.inner()
    }

    /// Whether there is any lift.
    pub fn has_lift(&self) -> bool {
        self.has_lift
    }

    /// The coefficients at a Mach number, by the formula of a segment: 0 below the table, 1 inside, 2 above.
    #[inline(always)]
    pub fn coefficients<S: Scalar>(&self, segment: usize, mach: S, hint: &Hint) -> Coefficients<S> {
        let [lift, drag] = self.coefficients.at(segment, mach, hint);
        Coefficients { lift, drag }
    }
}
