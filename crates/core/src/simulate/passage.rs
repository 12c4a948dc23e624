//! A step of the flight, and the motion inside it, which is computed when somebody looks there.

use std::cell::OnceCell;

use num_dual::Dual64;

use crate::coordinates::PlanetFixed;
use crate::integrate::{Interpolant, Step};
use crate::motion::{Formulation, moving};

/// A step that was flown.
pub(super) struct Passage<'a, F> {
    pub(super) step: &'a Step<6>,
    motion: &'a F,
    interpolant: OnceCell<Interpolant<6>>,
}

impl<'a, F: Formulation> Passage<'a, F> {
    pub(super) fn new(motion: &'a F, step: &'a Step<6>) -> Self {
        Self { step, motion, interpolant: OnceCell::new() }
    }

    /// The state at the given part of the step, moving along the flow.
    pub(super) fn inside(&self, part: f64) -> PlanetFixed<Dual64> {
        let state = self.interpolant.get_or_init(|| self.step.interpolant(self.motion)).state(part);
        F::planet_fixed(&moving(&state, &self.motion.derivative(&state)))
    }

    /// The state at the end, moving along the flow.
    pub(super) fn end(&self) -> PlanetFixed<Dual64> {
        F::planet_fixed(&moving(&self.step.end, &self.step.end_derivative))
    }

    /// What looking inside has cost: evaluations of the derivative for the interpolation.
    pub(super) fn evaluations(&self) -> usize {
        if self.interpolant.get().is_some() { Interpolant::<6>::EVALUATIONS } else { 0 }
    }
}
