//! How long the steps are, and of which method.

use std::array::from_fn;

use super::{IntegrationError, Limits, Statistics, StepBounds, radau, step};
use crate::elementary::pow;
use crate::scalar::{Lanes, Real};

/// The control of the length of the steps: each as long as the tolerance allows.
#[derive(Debug)]
pub(super) struct StepControl<'a, const N: usize> {
    limits: Limits<'a>,
    tolerances: Tolerances<f64, N>,
    /// Of the last accepted step's end, s.
    pub(super) time: f64,
    /// Proposed for the next step, s.
    pub(super) length: f64,
    /// Proposed before the end cut the present step short, s; 0 where it does not.
    stride: f64,
    /// By how much the next accepted step may lengthen it: not at all after a rejected one.
    growth: f64,
    /// Where the next step ends if it would go beyond, or nearly as far, s.
    aim: f64,
    /// Of the last accepted step, as a multiple of the tolerance.
    pub(super) error: f64,
    predictive: PredictiveControl,
    corners: CornerSteps,
    pub(super) stiffness: Stiffness,
    pub(super) statistics: Statistics,
}

/// What errors of a state are measured by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerances<S, const N: usize> {
    /// Relative to the size of a number.
    relative: S,
    /// The least size that each number counts as having.
    magnitudes: [S; N],
    /// How many numbers of the state have errors that count: those of a finite magnitude.
    counted: S,
}

/// The error of an explicit trial step.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrialError<S> {
    /// As a multiple of the tolerance.
    error: S,
    /// How many times as long a step would have the tolerance as its error.
    fitting: S,
}

impl<S: Real, const N: usize> Tolerances<S, N> {
    /// The size of a number of the state, to which its error is relative.
    #[inline(always)]
    fn size_of(&self, i: usize, start: &[S; N], end: &[S; N]) -> S {
        start[i].abs().max(end[i].abs()).max(self.magnitudes[i])
    }

    /// The error of an explicit trial step of a length, s: the estimate of order 5, damped by that of order 3.
    #[inline(always)]
    pub(super) fn error(&self, length: S, start: &[S; N], trial: &step::Outcome<S, N>) -> TrialError<S> {
        let [mut fifth, mut third] = [S::zero(); 2];
        for i in 0..N {
            let weight = (self.relative * self.size_of(i, start, &trial.end)).recip();
            let [of_fifth, of_third] = [trial.error_fifth[i] * weight, trial.error_third[i] * weight];
            fifth += of_fifth * of_fifth;
            third += of_third * of_third;
        }
        let denominator = ((fifth + third * 0.01) * self.counted).sqrt();
        // Only the root of 0 is so small.
        let is_exact = denominator.less_than(f64::MIN_POSITIVE);
        let error = S::select(is_exact, S::from(f64::MIN_POSITIVE), length * fifth / denominator);
        TrialError { error, fitting: error.sqrt().sqrt().sqrt().recip() }
    }
}

impl<const N: usize, const L: usize> Tolerances<Lanes<L>, N> {
    /// Those of none.
    pub(super) fn none() -> Self {
        let none = Lanes([0.0; L]);
        Self { relative: none, magnitudes: [none; N], counted: none }
    }

    /// Puts those of an integrator into a lane.
    pub(super) fn put(&mut self, lane: usize, control: &StepControl<N>) {
        let Tolerances { relative, magnitudes, counted } = &control.tolerances;
        self.relative.0[lane] = *relative;
        self.counted.0[lane] = *counted;
        for (lanes, magnitude) in self.magnitudes.iter_mut().zip(magnitudes) {
            lanes.0[lane] = *magnitude;
        }
    }
}

impl<const L: usize> TrialError<Lanes<L>> {
    /// That of none.
    pub(super) fn none() -> Self {
        Self { error: Lanes([0.0; L]), fitting: Lanes([0.0; L]) }
    }

    pub(super) fn of_lane(&self, lane: usize) -> TrialError<f64> {
        TrialError { error: self.error.0[lane], fitting: self.fitting.0[lane] }
    }
}

/// Predictive control of the step length: the length at which the error would be the tolerance changes from step to step, and the next change is
/// expected to be like the last one.
#[derive(Debug)]
struct PredictiveControl {
    /// That length at the last step, s; 0 where the error of that step was too small to tell.
    last: f64,
    /// Whether it has only grown since the integration started.
    only_grew: bool,
}

impl PredictiveControl {
    const START: Self = Self { last: 0.0, only_grew: true };

    /// The factor by which that length is expected to change, after a step of a length, s, and an error; `fitting`: how many times as long a step
    /// would have had the tolerance as its error.
    ///
    /// Where the length falls, as on the way into denser air, control by the last error alone makes every step too long, and it is rejected. Where
    /// the length rises, the factor is used only if it has risen since the start, as while a transient decays: elsewhere it may fall next.
    ///
    /// # Reference
    /// K. Gustafsson, Control-theoretic techniques for stepsize selection in implicit Runge-Kutta methods, ACM Transactions on
    /// Mathematical Software 20 (1994), 496-517; Hairer and Wanner, section IV.8, on the selection of the step size.
    fn change(&mut self, length: f64, error: f64, fitting: f64) -> f64 {
        if error < SIGNIFICANT_ERROR {
            self.last = 0.0;
            return 1.0;
        }
        let now = length * fitting;
        let last = std::mem::replace(&mut self.last, now);
        let change = if last > 0.0 { now / last } else { 1.0 };
        self.only_grew = self.only_grew && change >= 1.0;
        change.clamp(LEAST_CHANGE, if self.only_grew { GREATEST_CHANGE } else { 1.0 })
    }
}

/// Steps that end at corners of the rates, and are not tried across them first: where one corner had a step rejected, the next one mostly does too.
#[derive(Debug)]
struct CornerSteps {
    /// So many are still to come.
    left: u32,
    /// So many follow the next rejection: more each time, so that corners between which steps are much shorter than without them cost little.
    granted: u32,
}

/// What the explicit steps tell of stiffness.
#[derive(Debug)]
pub(super) struct Stiffness {
    /// Whether implicit steps are taken.
    pub(super) is_found: bool,
    /// Explicit steps, one after the other, for which accuracy would have had the longest one, or nearly so.
    restrained: usize,
    /// So many of them make the system stiff; more after implicit steps that did not pay.
    patience: usize,
}

impl Default for Stiffness {
    fn default() -> Self {
        Self { is_found: false, restrained: 0, patience: PATIENCE }
    }
}

impl<'a, const N: usize> StepControl<'a, N> {
    pub(super) fn new<F: StepBounds<N>>(
        system: &F,
        time: f64,
        state: &[f64; N],
        derivative: &[f64; N],
        limits: Limits<'a>,
    ) -> Self {
        let magnitudes = system.magnitudes();
        #[expect(clippy::cast_precision_loss, reason = "N is a handful")]
        let counted = magnitudes.iter().filter(|magnitude| magnitude.is_finite()).count() as f64;
        let statistics = Statistics { evaluations: 2, ..Statistics::default() };
        let mut control = Self {
            limits,
            tolerances: Tolerances { relative: limits.relative_tolerance, magnitudes, counted },
            time,
            length: 0.0,
            stride: 0.0,
            growth: GREATEST_GROWTH,
            aim: f64::INFINITY,
            error: 1.0,
            predictive: PredictiveControl::START,
            corners: CornerSteps { left: 0, granted: 1 },
            stiffness: Stiffness::default(),
            statistics,
        };
        control.length = control.first_step(system, state, derivative);
        control
    }

    /// Where the next trial step ends, s.
    pub(super) fn trial_end(&mut self, end: f64) -> Result<f64, IntegrationError> {
        let Limits { steps: limit, interrupt, .. } = self.limits;
        let time = self.time;
        if interrupt.is_raised() {
            return Err(IntegrationError::Interrupted { time });
        }
        if self.statistics.steps + self.statistics.rejected_steps >= limit {
            return Err(IntegrationError::StepLimit { time, limit });
        }
        let aim = self.aim.min(end);
        let is_aimed = aim <= time + self.length * LONGEST_AIMED_STEP;
        let trial_end = if is_aimed { aim } else { time + self.length };
        self.stride = if is_aimed { self.length } else { 0.0 };
        self.length = trial_end - time;
        if self.length.is_nan() || self.length <= LEAST_LENGTH * end {
            return Err(IntegrationError::StepTooSmall { time });
        }
        Ok(trial_end)
    }

    /// Goes on where the system or the state changes: with a first step, where that changes the rates much.
    pub(super) fn restart<F: StepBounds<N>>(
        &mut self,
        system: &F,
        state: &[f64; N],
        slope: &[f64; N],
        slope_before: &[f64; N],
    ) {
        let jump = self.size(&from_fn(|i| slope[i] - slope_before[i]), state, state);
        if jump > JUMP * self.size(slope, state, state) {
            self.statistics.evaluations += 1;
            self.length = self.length.min(self.first_step(system, state, slope));
            self.growth = GREATEST_GROWTH;
            self.predictive = PredictiveControl::START;
        }
        self.stiffness = Stiffness::default();
    }

    /// The next step ends at a time, s, if it would go beyond, or nearly as far.
    pub(super) fn aim_at(&mut self, time: f64) {
        self.aim = self.aim.min(time);
    }

    /// After a rejected step of a length, s, the next one is to end at a corner of the rates that lies within, in a time, s: the steps beyond may
    /// be as long as that was.
    pub(super) fn end_at_corner(&mut self, length: f64, time: f64) {
        if time < AT_END * length {
            self.length = length;
            self.aim_at(self.time + time);
            let CornerSteps { left, granted } = &mut self.corners;
            *left = *granted;
            *granted = (*granted * 2).min(MOST_CORNER_STEPS);
        }
    }

    /// Whether the next step, before its first trial, is to end at a corner, if there is one within.
    pub(super) fn expects_corner(&self) -> bool {
        self.corners.left > 0 && self.growth > 1.0
    }

    /// The next step ends at the next corner, in a time, s, if that is within.
    pub(super) fn go_to_corner(&mut self, time: f64) {
        if time < AT_END * self.length {
            self.aim_at(self.time + time);
            self.corners.left -= 1;
        }
    }

    /// Keeps the next step within a length.
    pub(super) fn shorten(&mut self, longest: f64) {
        self.length = self.length.min(longest);
    }

    /// Keeps the next step within the longest explicit one. Where it is not accuracy that has long held the steps back, it is an implicit one, if that
    /// may be much longer.
    pub(super) fn limit(&mut self, longest: f64, longest_implicit: impl FnOnce() -> f64) {
        let Stiffness { is_found, restrained, patience } = &mut self.stiffness;
        *restrained = if self.length > NEARLY * longest { *restrained + 1 } else { 0 };
        self.length = self.length.min(longest);
        if *restrained >= *patience {
            *restrained = 0;
            *is_found = longest_implicit() > ADVANTAGE * longest;
            if *is_found {
                self.length *= FIRST_IMPLICIT;
                self.predictive = PredictiveControl { only_grew: false, ..PredictiveControl::START };
            }
        }
    }

    /// Keeps the next implicit step within the longest one. Where it would hardly be longer than an explicit one, it is that.
    pub(super) fn limit_implicit(&mut self, longest_explicit: f64, longest: impl FnOnce() -> f64) {
        if self.length < LEAST_ADVANTAGE * longest_explicit {
            let patience = self.stiffness.patience * 2;
            self.stiffness = Stiffness { patience, ..Stiffness::default() };
            self.length = self.length.min(longest_explicit);
        } else {
            self.length = self.length.min(longest());
        }
    }

    /// The error of an explicit trial step from a start.
    pub(super) fn error(&self, start: &[f64; N], trial: &step::Outcome<f64, N>) -> TrialError<f64> {
        self.tolerances.error(self.length, start, trial)
    }

    /// Whether the error of an explicit trial step is small enough; proposes the length of the next one.
    pub(super) fn accepts(&mut self, TrialError { error, fitting }: TrialError<f64>) -> bool {
        self.statistics.evaluations += step::TRIAL_EVALUATIONS;
        let accepted = self.decide(error, fitting);
        self.statistics.evaluations += usize::from(accepted);
        accepted
    }

    /// Whether the error of the implicit trial step is small enough; proposes the length of the next one.
    pub(super) fn accepts_implicit(&mut self, start: &[f64; N], trial: &radau::Trial<N>) -> bool {
        let error = self.size(&trial.error, start, &trial.end);
        self.decide(error, 1.0 / error.sqrt().sqrt())
    }

    /// Whether an error, as a multiple of the tolerance, is small enough; `fitting`: how many times as long a step would have the tolerance as
    /// its error.
    fn decide(&mut self, error: f64, fitting: f64) -> bool {
        let accepted = error < 1.0;
        if accepted {
            self.statistics.steps += 1;
            // A step that was cut short, and has hardly an error, says nothing about longer ones.
            let is_significant = self.stride == 0.0 || error > SIGNIFICANT_ERROR_OF_CUT_STEPS;
            let change = if is_significant { self.predictive.change(self.length, error, fitting) } else { 1.0 };
            let growth = SAFETY * fitting * change;
            let bounded = self.length * self.growth.min(growth).max(LEAST_GROWTH);
            self.length = if is_significant && growth < self.growth { bounded } else { bounded.max(self.stride) };
            self.growth = GREATEST_GROWTH;
            self.aim = f64::INFINITY;
            self.error = error;
        } else {
            self.reject(if error.is_finite() { (SAFETY * fitting).max(LEAST_GROWTH) } else { NOT_FINITE_SHRINK });
        }
        accepted
    }

    /// Makes the next trial shorter.
    pub(super) fn reject(&mut self, shrink: f64) {
        self.statistics.rejected_steps += 1;
        self.length *= shrink;
        self.growth = 1.0;
    }

    /// The size of a change of the state in a step, as a multiple of the tolerance.
    pub(super) fn size(&self, change: &[f64; N], start: &[f64; N], end: &[f64; N]) -> f64 {
        let Tolerances { relative, counted, .. } = self.tolerances;
        let part = |i: usize| change[i] / (relative * self.tolerances.size_of(i, start, end));
        ((0..N).map(|i| part(i).powi(2)).sum::<f64>() / counted).sqrt()
    }

    /// The length of the first step, from the sizes of the first and second derivative: their ratio is the time in which the rates change, and
    /// with all higher derivatives the error grows as if they went on like a geometric series.
    ///
    /// The usual estimate (Hairer, Nørsett, Wanner, section II.4) takes the first two for that of the order of the method, in seconds: for
    /// flights it came hundreds of times too short.
    fn first_step<F: StepBounds<N>>(&self, system: &F, state: &[f64; N], slope: &[f64; N]) -> f64 {
        let norm = |vector: &[f64; N]| {
            let component =
                |i: usize| vector[i] / (self.tolerances.relative * self.tolerances.size_of(i, state, state));
            (0..N).map(component).map(|x| x * x).sum::<f64>().sqrt()
        };
        let first = norm(slope);
        let guess = if first > 0.0 { 0.01 * norm(state) / first } else { 1e-6 };
        let guess = guess.min(system.longest_step(self.time, state));
        let euler = from_fn(|i| state[i] + slope[i] * guess);
        let next_slope = system.derivative(self.time + guess, &euler);
        let second = norm(&from_fn(|i| next_slope[i] - slope[i])) / guess;
        // At least that in which the state changes by the tolerance: from rest, or near it, the rates change at once.
        let time = (first / second).max(1.0 / second.sqrt());
        let part = pow(first * time, -1.0 / (ORDER + 1.0));
        let refined = part.min(LONGEST_FIRST_STEP) * time;
        // Where the trial overflowed, the guess shrinks until a step is accepted.
        if refined > 0.0 && refined.is_finite() { refined.min(guess * 100.0) } else { guess }
    }
}

const ORDER: f64 = 8.0;
const SAFETY: f64 = 0.9;
const LEAST_GROWTH: f64 = 1.0 / 3.0;
const GREATEST_GROWTH: f64 = 6.0;
const NOT_FINITE_SHRINK: f64 = 0.1;
/// Bounds of the factor of predictive control.
const LEAST_CHANGE: f64 = 0.5;
const GREATEST_CHANGE: f64 = 1.3;
/// The least error, as a multiple of the tolerance, that tells how long a step might be: smaller ones are near the rounding.
const SIGNIFICANT_ERROR: f64 = 1e-4;
/// The same of a step that was cut short.
const SIGNIFICANT_ERROR_OF_CUT_STEPS: f64 = 3e-3;
/// In parts of the time in which the rates change: where the tolerance is loose, the series says little.
const LONGEST_FIRST_STEP: f64 = 0.1;
/// A part of the rates of change; a jump by more makes a new start.
const JUMP: f64 = 0.03;
/// A step that would end just before a given end is made so many times as long, to end there: what was left would cost a step of its own. The error,
/// which aims at 0.43 of the tolerance, becomes 0.74 of it.
const LONGEST_AIMED_STEP: f64 = 1.07;
/// Up to this part of a step a corner of the rates is within it, and not at its end.
const AT_END: f64 = 0.95;
/// So many steps end at corners before one is tried across.
const MOST_CORNER_STEPS: u32 = 8;
pub(super) const NOT_CONVERGED_SHRINK: f64 = 0.3;
/// How many times as long as a stable explicit step another has to be to count as much longer: an implicit one costs as much as one and a half.
const ADVANTAGE: f64 = 3.0;
/// How many times as long as the explicit step before the first implicit one is tried.
const FIRST_IMPLICIT: f64 = 5.0;
/// Implicit steps go on as long as they are so many times as long as explicit ones.
const LEAST_ADVANTAGE: f64 = 2.0;
/// Accuracy that asks for steps of this part of the longest one does so for the sake of stability: there the estimate of the error grows.
const NEARLY: f64 = 0.75;
/// Explicit steps that are restrained before implicit ones are tried: what decays fast is to be gone by then.
const PATIENCE: usize = 3;
/// A step shorter than this part of the end time would hardly ever get there, and at the end not advance the time at all.
const LEAST_LENGTH: f64 = 1e-18;
