//! Coefficients by angle of attack and Mach number.

use super::Coefficients;
use crate::interpolation::{Hint, Surfaces, TableError};
use crate::scalar::Scalar;

/// Lift and drag coefficients by angle of attack and Mach number; outside the table they are those of its nearest edge.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaMachTable {
    /// `C_L` and `C_D`.
    coefficients: Surfaces,
    has_lift: bool,
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
        let coefficients = Surfaces::new(angle_of_attack, mach, [lift_coefficient, drag_coefficient])?;
        match drag_coefficient.iter().flatten().position(|drag| *drag < 0.0) {
            Some(index) => Err(TableError::OutOfBounds { index }),
            None => Ok(Self { coefficients, has_lift: lift_coefficient.iter().flatten().any(|lift| *lift != 0.0) }),
        }
    }

    /// Its least and greatest angle of attack, rad.
    pub fn angle_of_attack_range(&self) -> &[f64; 2] {
        self.coefficients.ranges()[0]
    }

    /// Its least and greatest Mach number.
    pub fn mach_range(&self) -> &[f64; 2] {
        self.coefficients.ranges()[1]
    }

    /// The angles of attack, rad, and the Mach numbers between them.
    pub fn inner(&self) -> [&[f64]; 2] {
        self.coefficients.inner()
    }

    /// Whether there is any lift.
    pub fn has_lift(&self) -> bool {
        self.has_lift
    }

    /// The coefficients at an angle of attack, rad, and a Mach number, by the formulas of a segment of each: 0 below the table, 1 inside,
    /// 2 above.
    #[inline(always)]
    pub fn coefficients<S: Scalar>(
        &self,
        segments: [usize; 2],
        angle_of_attack: S,
        mach: S,
        hints: &[Hint; 2],
    ) -> Coefficients<S> {
        let [lift, drag] = self.coefficients.at(segments, [angle_of_attack, mach], hints);
        Coefficients { lift, drag }
    }
}
