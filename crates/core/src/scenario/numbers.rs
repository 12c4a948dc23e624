//! The numbers of a case, as a flight uses them: plain, or with derivatives.

use super::Case;

/// Where a flight gets the numbers of its case: from the case itself, or from one whose numbers vary, with derivatives by what varies.
///
/// What a phase of the flight is made of asks for every number here, so that flights and their derivatives share one code.
pub(crate) trait Numbers<P> {
    /// The case as it flies; what is not a number comes from here.
    fn case(&self) -> &Case;

    /// A number of the case.
    fn number(&self, of: impl Fn(&Case) -> f64) -> P;

    /// What is added to the lift and the drag coefficient of the vehicle's table and to the bank angle, rad: zero, with derivatives where
    /// those vary as a whole.
    fn offsets(&self) -> [P; 3];
}

impl Numbers<f64> for Case {
    fn case(&self) -> &Case {
        self
    }

    fn number(&self, of: impl Fn(&Case) -> f64) -> f64 {
        of(self)
    }

    fn offsets(&self) -> [f64; 3] {
        [0.0; 3]
    }
}
