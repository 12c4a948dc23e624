//! The end of the flight: where the altitude falls to the stop altitude.

use num_dual::Dual64;

use super::passage::Passage;
use crate::coordinates::PlanetFixed;
use crate::integrate::{Integrator, Step, event};
use crate::motion::{Formulation, moving};
use crate::planet::Shape;

/// The height above the stop altitude, with its rate, at the end of the last step.
#[derive(Clone, Copy)]
pub(super) struct Descent {
    shape: Shape,
    stop_altitude: f64,
    above: Dual64,
}

impl Descent {
    pub(super) fn new<F: Formulation>(motion: &F, stop_altitude: f64, state: &[f64; 6], derivative: &[f64; 6]) -> Self {
        let shape = motion.forces().planet().shape;
        let mut descent = Self { shape, stop_altitude, above: Dual64::from(0.0) };
        descent.above = descent.height(&F::planet_fixed(&moving(state, derivative)));
        descent
    }

    /// The flight leaves the stop altitude upward, even where rounding gives it no rate, or a falling one.
    pub(super) fn start_upward(&mut self) {
        self.above.eps = self.above.eps.max(f64::MIN_POSITIVE);
    }

    /// The time at which a step crosses the stop altitude for the first time downwards, a dip inside the step included.
    pub(super) fn impact<F: Formulation>(&mut self, passage: &Passage<F>) -> Option<f64> {
        let step = passage.step;
        let end = self.height(&passage.end());
        let start = std::mem::replace(&mut self.above, end);
        let part = event::first_fall(start, end, step.length(), |part| self.height(&passage.inside(part)));
        part.map(|part| step.time(part))
    }

    /// Repeats the step so that it ends on the stop altitude, which the dense output crosses at `time`.
    ///
    /// The repeated step is more accurate than the dense output: its own crossing is found by Newton's method.
    pub(super) fn land<F: Formulation>(
        &self,
        integrator: &mut Integrator<'_, F, 6>,
        step: &Step<6>,
        mut time: f64,
    ) -> Step<6> {
        let mut landing = integrator.shorten(step, time);
        for _ in 0..5 {
            let above = self.height(&F::planet_fixed(&moving(&landing.end, &landing.end_derivative)));
            // How long before the end of the step its tangent there passes the stop altitude.
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
            landing = integrator.shorten(step, time);
        }
        landing
    }

    fn height(&self, state: &PlanetFixed<Dual64>) -> Dual64 {
        self.shape.altitude(&state.position) - self.stop_altitude
    }
}
