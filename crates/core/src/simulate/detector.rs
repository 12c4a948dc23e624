//! What ends a step early: the stop altitude, a boundary between formulas of the models, or a condition of an event or of a stop.

use num_dual::Dual64;

use super::step_view::StepView;
use crate::integrate::event::PredictedCrossing;
use crate::integrate::{Integrator, Step};
use crate::motion::{Forces, Formulation, StateRate};

/// Locates the first place of its kind in a step.
///
/// A detector keeps what it read at the end of the last step, and compares it with the end of the next one.
pub(super) trait Detector {
    /// Which place was located, where there are several.
    type Located: Copy;

    /// The part of a step at which its first place lies, and which place that is.
    fn locate<F: Formulation<N>, const N: usize>(&self, step: &StepView<F, N>) -> Option<(f64, Self::Located)>;

    /// A function of the flight with its rate per second: positive before the place, zero on it.
    fn ahead(&self, located: Self::Located, forces: &Forces, now: &StateRate) -> Dual64;

    /// When it expects its first place, if that may be within a time, s.
    fn predict(&self, forces: &Forces, within: f64) -> Option<PredictedCrossing>;

    /// Keeps what it reads at the end of a step.
    fn follow<F: Formulation<N>, const N: usize>(&mut self, step: &StepView<F, N>);
}

/// Cuts a step at the first place that a detector locates in it; returns which one, and adds to the evaluations that looking inside
/// has cost. Where the dense output is good enough, as near the end of a step that was aimed at the place, it ends there; elsewhere its beginning is
/// repeated. A place at the end of a step that is cut already does not cut it again.
pub(super) fn cut_at_first<D: Detector, F: Formulation<N>, const N: usize>(
    step: &mut StepView<'_, F, N>,
    detector: &D,
    integrator: &mut Integrator<'_, N>,
    evaluations: &mut usize,
) -> Option<D::Located> {
    let (part, located) = detector.locate(step).filter(|(part, _)| !step.is_cut() || *part < AT_END)?;
    let is_whole = !step.is_cut();
    let beginning =
        is_whole.then(|| integrator.end_inside(step.motion, &step.step, step.interpolant(), part)).flatten();
    *evaluations += step.evaluations();
    if let Some(beginning) = beginning {
        step.replace(beginning);
        return Some(located);
    }
    let forces = step.motion.forces();
    let ahead = |now: &StateRate| detector.ahead(located, forces, now);
    let shorter = cut_at(integrator, step.motion, &step.step, step.step.time(part), ahead);
    step.replace(shorter);
    Some(located)
}

/// Repeats a step so that it ends where a quantity is zero, which the dense output crosses at `time`, s.
///
/// The repeated step is more accurate than the dense output: its own crossing is found by Newton's method.
fn cut_at<F: Formulation<N>, const N: usize>(
    integrator: &mut Integrator<'_, N>,
    motion: &F,
    step: &Step<N>,
    mut time: f64,
    quantity: impl Fn(&StateRate) -> Dual64,
) -> Step<N> {
    let mut shorter = integrator.shorten(motion, step, time);
    for _ in 0..5 {
        let end = StateRate::of::<F, N>(shorter.end_time, &shorter.end, &shorter.end_derivative);
        let left = quantity(&end);
        // How long before the end of the step its tangent there passes zero.
        let late = left.re / left.eps;
        if late.abs() <= 1e-6 * shorter.length() {
            // Over so short a time the motion is a straight line, to rounding.
            shorter.move_end(-late);
            break;
        }
        if late.abs() > 0.5 * shorter.length() || !late.is_finite() {
            break;
        }
        time -= late;
        shorter = integrator.shorten(motion, step, time);
    }
    shorter
}

/// From this part of a step on, a place counts as its end.
pub(super) const AT_END: f64 = 1.0 - 1e-9;
