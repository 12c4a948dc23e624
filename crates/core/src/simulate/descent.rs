//! The end of the flight: where the altitude falls to the stop altitude.

use num_dual::Dual64;

use super::passage::Passage;
use crate::integrate::{Integrator, Step, event};
use crate::motion::{Formulation, Moment};
use crate::planet::Shape;

/// The height above the stop altitude, with its rate, at the end of the last step.
#[derive(Clone, Copy)]
pub(super) struct Descent {
    shape: Shape,
    stop_altitude: f64,
    above: Dual64,
}

impl Descent {
    pub(super) fn new(shape: Shape, stop_altitude: f64, start: &Moment) -> Self {
        let mut descent = Self { shape, stop_altitude, above: Dual64::from(0.0) };
        descent.above = descent.height(start);
        descent
    }

    /// The flight leaves the stop altitude upward, even where rounding gives it no rate, or a falling one.
    pub(super) fn start_upward(&mut self) {
        self.above.eps = self.above.eps.max(f64::MIN_POSITIVE);
    }

    /// The part of a step at which it crosses the stop altitude for the first time downwards, a dip inside the step included.
    pub(super) fn impact<F: Formulation<N>, const N: usize>(&self, passage: &Passage<F, N>) -> Option<f64> {
        let end = self.height(&passage.end());
        event::first_fall(self.above, end, passage.step.length(), |part| self.height(&passage.inside(part)))
    }

    /// Goes to the end of a step.
    pub(super) fn follow<F: Formulation<N>, const N: usize>(&mut self, passage: &Passage<F, N>) {
        self.go_to(&passage.end());
    }

    /// Goes to a moment.
    pub(super) fn go_to(&mut self, moment: &Moment) {
        self.above = self.height(moment);
    }

    pub(super) fn height(&self, moment: &Moment) -> Dual64 {
        self.shape.altitude(&moment.state.position) - self.stop_altitude
    }
}

/// Repeats a step so that it ends where a quantity is zero, which the dense output crosses at `time`.
///
/// The repeated step is more accurate than the dense output: its own crossing is found by Newton's method.
pub(super) fn land<F: Formulation<N>, const N: usize>(
    integrator: &mut Integrator<'_, N>,
    motion: &F,
    step: &Step<N>,
    mut time: f64,
    quantity: impl Fn(&Moment) -> Dual64,
) -> Step<N> {
    let mut landing = integrator.shorten(motion, step, time);
    for _ in 0..5 {
        let end = Moment::of::<F, N>(landing.end_time, &landing.end, &landing.end_derivative);
        let above = quantity(&end);
        // How long before the end of the step its tangent there passes zero.
        let late = above.re / above.eps;
        if late.abs() <= 1e-6 * landing.length() {
            // So near, the motion is a straight line to rounding.
            landing.move_end(-late);
            break;
        }
        if late.abs() > 0.5 * landing.length() || !late.is_finite() {
            break;
        }
        time -= late;
        landing = integrator.shorten(motion, step, time);
    }
    landing
}
