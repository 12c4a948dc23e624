//! A step of the flight, and the motion inside it, which is computed when somebody looks there.

use std::cell::OnceCell;

use num_dual::Dual64;

use crate::coordinates::PlanetFixed;
use crate::integrate::{Interpolant, Step};
use crate::motion::{Formulation, moving};

/// A time and the state then, both moving along the flow: what is computed from them comes with its rate of change.
pub(super) struct Moment {
    pub(super) time: Dual64,
    pub(super) state: PlanetFixed<Dual64>,
}

impl Moment {
    /// Of a formulation's six numbers and their rates.
    pub(super) fn of<F: Formulation>(time: f64, state: &[f64; 6], derivative: &[f64; 6]) -> Self {
        Self { time: Dual64::new(time, 1.0), state: F::planet_fixed(&moving(state, derivative)) }
    }
}

/// A step that was flown.
pub(super) struct Passage<'a, F> {
    pub(super) step: &'a Step<6>,
    pub(super) motion: &'a F,
    interpolant: OnceCell<Interpolant<6>>,
}

impl<'a, F: Formulation> Passage<'a, F> {
    pub(super) fn new(motion: &'a F, step: &'a Step<6>) -> Self {
        Self { step, motion, interpolant: OnceCell::new() }
    }

    /// The state at the start, moving along the flow.
    pub(super) fn start(&self) -> Moment {
        Moment::of::<F>(self.step.start_time, &self.step.start, &self.step.start_derivative)
    }

    /// The state at the given part of the step, moving along the flow.
    pub(super) fn inside(&self, part: f64) -> Moment {
        let time = self.step.time(part);
        let state = self.interpolant.get_or_init(|| self.step.interpolant(self.motion)).state(part);
        Moment::of::<F>(time, &state, &self.motion.derivative(time, &state))
    }

    /// The state at the end, moving along the flow.
    pub(super) fn end(&self) -> Moment {
        Moment::of::<F>(self.step.end_time, &self.step.end, &self.step.end_derivative)
    }

    /// What looking inside has cost: evaluations of the derivative for the interpolation.
    pub(super) fn evaluations(&self) -> usize {
        if self.interpolant.get().is_some() { Interpolant::<6>::EVALUATIONS } else { 0 }
    }
}
