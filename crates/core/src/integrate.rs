//! Solves y' = f(y) with the method of Dormand and Prince of order 8(5,3), and where y' = f(y) is stiff with the implicit method Radau IIA of order
//! 5, the error kept below a tolerance step by step.
//!
//! This module knows nothing of flight: a [`System`] says how the state changes, an [`Integrator`] takes steps,
//! the [`Interpolant`] of a [`Step`] gives the state at every instant inside it, and [`event`] looks there for falls through zero and
//! for maxima.

mod any_step;
mod elimination;
pub mod event;
mod radau;
mod step;
mod tableau;

pub use radau::follow_implicitly;
pub use step::{Interpolant, Step, follow};

pub(crate) use any_step::AnyStep;

use std::array::from_fn;

use nalgebra::Const;
use num_dual::DualSVec64;

use crate::interrupt::Interrupt;
use crate::scalar::Lanes;
use step::Inside;

/// A system of `N` ordinary differential equations.
pub trait System<S, const N: usize> {
    /// The rate of change of each component of the state at a time, s.
    fn derivative(&self, time: S, state: &[S; N]) -> [S; N];
}

/// What a system says about the length of its steps.
pub trait StepBounds<const N: usize>: System<f64, N> {
    /// The typical size of each component; a component's tolerance is relative to the larger of its size and this.
    fn magnitudes(&self) -> [f64; N];

    /// The longest step that may start here, in seconds: a step must not jump over something that it cannot see, and an explicit one must
    /// not be so long that it is unstable.
    fn longest_step(&self, _time: f64, _state: &[f64; N]) -> f64 {
        f64::INFINITY
    }

    /// The longest implicit step that may start here, in seconds. Where it is much longer than the longest explicit one, and that is
    /// shorter than accuracy asks for, the system is stiff.
    fn longest_implicit_step(&self, time: f64, state: &[f64; N]) -> f64 {
        self.longest_step(time, state)
    }

    /// How the rates of change depend on the state: row by row ∂fᵢ/∂yⱼ. Implicit steps need it, for their iterations alone: columns by which
    /// nothing changes fast may be left 0.
    fn jacobian(&self, _time: f64, _state: &[f64; N]) -> [[f64; N]; N] {
        [[0.0; N]; N]
    }
}

/// The first `K` columns of the Jacobian of a system, in dual numbers; the others are left 0.
pub fn jacobian<F: System<DualSVec64<K>, N>, const N: usize, const K: usize>(
    system: &F,
    time: f64,
    state: &[f64; N],
) -> [[f64; N]; N] {
    let variables = from_fn(|i| {
        let number = DualSVec64::<K>::from_re(state[i]);
        if i < K { number.derivative(i) } else { number }
    });
    system.derivative(time.into(), &variables).map(|rate| {
        let slopes = rate.eps.unwrap_generic(Const::<K>, Const::<1>);
        from_fn(|j| if j < K { slopes[j] } else { 0.0 })
    })
}

/// Why the integration cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum IntegrationError {
    /// The limit on the number of steps was reached.
    #[error("the limit of {limit} steps was reached at t = {time} s")]
    StepLimit {
        /// The instant reached, s.
        time: f64,
        /// The limit on accepted and rejected steps together.
        limit: usize,
    },
    /// No step that advances the time meets the tolerance, or the rate of change is not finite.
    #[error("no step from t = {time} s meets the tolerance")]
    StepTooSmall {
        /// The instant reached, s.
        time: f64,
    },
    /// The cancellation flag was raised.
    #[error("interrupted at t = {time} s")]
    Interrupted {
        /// The instant reached, s.
        time: f64,
    },
}

/// What the integration cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Accepted steps.
    pub steps: usize,
    /// Steps that were tried and missed the tolerance.
    pub rejected_steps: usize,
    /// Evaluations of the derivative; a Jacobian counts as one, and one for each of its columns that is not 0.
    pub evaluations: usize,
}

/// What bounds an integration.
#[derive(Clone, Copy, Debug)]
pub struct Limits<'a> {
    /// The error allowed in one step, relative to the state.
    pub relative_tolerance: f64,
    /// The number of steps, accepted and rejected together.
    pub steps: usize,
    /// Looked at before every step; once true, the integration ends.
    pub interrupt: &'a dyn Interrupt,
}

/// Advances the state of a system step by step.
///
/// Every call is given the system, which may change from one step to the next; then comes [`restart`](Self::restart).
#[derive(Debug)]
pub struct Integrator<'a, const N: usize> {
    control: StepControl<'a, N>,
    state: [f64; N],
    derivative: [f64; N],
}

impl<'a, const N: usize> Integrator<'a, N> {
    /// Starts at a time, s, with the given state.
    pub fn new<F: StepBounds<N>>(system: &F, time: f64, state: [f64; N], limits: Limits<'a>) -> Self {
        let derivative = system.derivative(time, &state);
        let mut control = StepControl::new(system, time, &state, &derivative, limits);
        control.shorten(system.longest_step(time, &state));
        Self { control, state, derivative }
    }

    /// What the steps so far cost.
    pub fn statistics(&self) -> Statistics {
        self.control.statistics
    }

    /// The present time, s.
    pub fn time(&self) -> f64 {
        self.control.time
    }

    /// The present state.
    pub fn state(&self) -> &[f64; N] {
        &self.state
    }

    /// The rate of change at the present state.
    pub fn derivative(&self) -> &[f64; N] {
        &self.derivative
    }

    /// Whether the next step is an implicit one, since the system is stiff here.
    pub fn is_stiff(&self) -> bool {
        self.control.stiffness.is_found
    }

    /// Takes one step, which ends at `end` at the latest.
    ///
    /// # Errors
    /// When the limit of steps is reached, no step meets the tolerance, or the flag is raised.
    pub fn advance<F: StepBounds<N>>(&mut self, system: &F, end: f64) -> Result<Step<N>, IntegrationError> {
        loop {
            let trial_end = self.control.trial_end(end)?;
            if self.is_stiff() {
                match self.attempt_implicit(system, self.control.length) {
                    Some(trial) if self.control.accepts_implicit(&self.state, &trial) => {
                        return Ok(self.take_implicit(system, &trial, trial_end));
                    }
                    Some(_) => {}
                    None => self.control.reject(NOT_CONVERGED_SHRINK),
                }
                self.limit_implicit(system);
            } else {
                let Self { control, state, derivative } = self;
                let trial = step::attempt(system, control.time, state, derivative, control.length);
                if control.accepts(state, &trial) {
                    let end_derivative = system.derivative(trial_end, &trial.end);
                    return Ok(self.take(system, trial, trial_end, end_derivative));
                }
            }
        }
    }

    /// Repeats the beginning of a step, so that it ends exactly at `end`; the state there is more accurate than the dense output.
    pub fn shorten<F: StepBounds<N>>(&mut self, system: &F, step: &Step<N>, end: f64) -> Step<N> {
        (self.control.time, self.state, self.derivative) = (step.start_time, step.start, step.start_derivative);
        let length = end - step.start_time;
        if step.is_implicit()
            && let Some(trial) = self.attempt_implicit(system, length)
        {
            return self.take_implicit(system, &trial, end);
        }
        let trial = step::attempt(system, self.control.time, &self.state, &self.derivative, length);
        self.control.statistics.evaluations += step::TRIAL_EVALUATIONS + 1;
        let end_derivative = system.derivative(end, &trial.end);
        self.take(system, trial, end, end_derivative)
    }

    /// Goes on from the end of a step with a system, or a state, that changes there. What decays fast there is to be followed first.
    pub fn restart<F: StepBounds<N>>(&mut self, system: &F, time: f64, state: [f64; N]) {
        (self.control.time, self.state) = (time, state);
        self.derivative = system.derivative(self.control.time, &self.state);
        self.control.statistics.evaluations += 1;
        self.control.stiffness = Stiffness::default();
        self.control.shorten(system.longest_step(self.control.time, &self.state));
    }

    /// Goes to the end of a trial step.
    fn take<F: StepBounds<N>>(
        &mut self,
        system: &F,
        trial: step::Trial<f64, N>,
        end_time: f64,
        end_derivative: [f64; N],
    ) -> Step<N> {
        let step = trial.into_step(self.control.time, end_time, &self.state, end_derivative);
        self.go_to_end(&step);
        let longest = system.longest_step(end_time, &self.state);
        self.control.limit(longest, || system.longest_implicit_step(end_time, &self.state));
        step
    }

    /// Tries an implicit step of a length, s.
    fn attempt_implicit<F: StepBounds<N>>(&mut self, system: &F, length: f64) -> Option<radau::Trial<N>> {
        let Self { control, state, derivative } = self;
        let start = radau::Start { time: control.time, state, derivative };
        let size = |change: &[f64; N]| control.size(change, state, state);
        let mut evaluations = 0;
        let trial = radau::attempt(system, &start, length, size, &mut evaluations);
        control.statistics.evaluations += evaluations;
        trial
    }

    /// Goes to the end of an implicit trial step.
    fn take_implicit<F: StepBounds<N>>(&mut self, system: &F, trial: &radau::Trial<N>, end_time: f64) -> Step<N> {
        let step = Step {
            start_time: self.control.time,
            end_time,
            start: self.state,
            end: trial.end,
            start_derivative: self.derivative,
            end_derivative: system.derivative(end_time, &trial.end),
            inside: Inside::Implicit(trial.inside),
        };
        self.control.statistics.evaluations += 1;
        self.go_to_end(&step);
        self.limit_implicit(system);
        step
    }

    /// Keeps the next implicit step within its bounds, or goes back to explicit ones.
    fn limit_implicit<F: StepBounds<N>>(&mut self, system: &F) {
        let Self { control, state, .. } = self;
        let time = control.time;
        control.limit_implicit(system.longest_step(time, state), || system.longest_implicit_step(time, state));
    }

    fn go_to_end(&mut self, step: &Step<N>) {
        (self.control.time, self.state, self.derivative) = (step.end_time, step.end, step.end_derivative);
    }
}

/// Tries a step of each integrator, all computed at once by the `system` of their lanes, to the ends at the latest.
///
/// Each lane has an integrator, its own system, and its end, s. A lane whose trial meets its tolerance advances by it; the others will
/// try a shorter one the next time. A lane without an integrator is idle. The steps are those that the integrators would take alone,
/// to the last digit; explicit ones: an integrator whose system [is stiff](Integrator::is_stiff) has to take its next step alone.
///
/// # Errors
/// Lane by lane those of [`Integrator::advance`].
pub fn try_in_lanes<M: System<Lanes<L>, N>, F: StepBounds<N>, const N: usize, const L: usize>(
    system: &M,
    mut lanes: [Option<(&mut Integrator<'_, N>, &F, f64)>; L],
) -> [Option<Result<Step<N>, IntegrationError>>; L] {
    let trial_ends = lanes.each_mut().map(|lane| {
        let (integrator, _, end) = lane.as_mut()?;
        Some(integrator.control.trial_end(*end))
    });
    let state = from_fn(|i| packed(&lanes, |integrator| integrator.state[i]));
    let derivative = from_fn(|i| packed(&lanes, |integrator| integrator.derivative[i]));
    let time = packed(&lanes, |integrator| integrator.control.time);
    let length = packed(&lanes, |integrator| integrator.control.length);
    let trial = step::attempt(&step::Once(system), time, &state, &derivative, length);
    let ends = Lanes(from_fn(|lane| match trial_ends[lane] {
        Some(Ok(end)) => end,
        _ => 0.0,
    }));
    let end_derivative = system.derivative(ends, &trial.end);
    let mut index = 0..;
    lanes.map(|lane| {
        let index = index.next()?;
        let (integrator, own, _) = lane?;
        let trial_end = match trial_ends[index]? {
            Ok(trial_end) => trial_end,
            Err(error) => return Some(Err(error)),
        };
        let trial = trial.lane(index);
        let accepted = integrator.control.accepts(&integrator.state, &trial);
        accepted.then(|| Ok(integrator.take(own, trial, trial_end, end_derivative.map(|rate| rate.0[index]))))
    })
}

/// A number of each integrator.
fn packed<F, const N: usize, const L: usize>(
    lanes: &[Option<(&mut Integrator<'_, N>, &F, f64)>; L],
    number: impl Fn(&Integrator<'_, N>) -> f64,
) -> Lanes<L> {
    Lanes(from_fn(|lane| lanes[lane].as_ref().map_or(0.0, |(integrator, ..)| number(integrator))))
}

/// The control of the length of the steps: each as long as the tolerance allows.
#[derive(Debug)]
struct StepControl<'a, const N: usize> {
    limits: Limits<'a>,
    magnitudes: [f64; N],
    /// How many numbers of the state have errors that count: those of a finite magnitude.
    counted: f64,
    /// Of the last accepted step's end, s.
    time: f64,
    /// Proposed for the next step, s.
    length: f64,
    /// Proposed before the end cut the present step short, s; 0 where it does not.
    stride: f64,
    /// By how much the next accepted step may lengthen it: not at all after a rejected one.
    growth: f64,
    stiffness: Stiffness,
    statistics: Statistics,
}

/// What the explicit steps tell of stiffness.
#[derive(Debug)]
struct Stiffness {
    /// Whether implicit steps are taken.
    is_found: bool,
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
    fn new<F: StepBounds<N>>(
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
            magnitudes,
            counted,
            time,
            length: 0.0,
            stride: 0.0,
            growth: GREATEST_GROWTH,
            stiffness: Stiffness::default(),
            statistics,
        };
        control.length = control.first_step(system, state, derivative);
        control
    }

    /// Where the next trial step ends, s.
    fn trial_end(&mut self, end: f64) -> Result<f64, IntegrationError> {
        let Limits { steps: limit, interrupt, .. } = self.limits;
        let time = self.time;
        if interrupt.is_raised() {
            return Err(IntegrationError::Interrupted { time });
        }
        if self.statistics.steps + self.statistics.rejected_steps >= limit {
            return Err(IntegrationError::StepLimit { time, limit });
        }
        // A remainder below one per cent of a step is taken along.
        let last = time + self.length * 1.01 >= end;
        let trial_end = if last { end } else { time + self.length };
        self.stride = if last { self.length } else { 0.0 };
        self.length = trial_end - time;
        if self.length.is_nan() || self.length <= LEAST_LENGTH * end {
            return Err(IntegrationError::StepTooSmall { time });
        }
        Ok(trial_end)
    }

    /// Keeps the next step within a length.
    fn shorten(&mut self, longest: f64) {
        self.length = self.length.min(longest);
    }

    /// Keeps the next step within the longest explicit one. Where it is not accuracy that has long held the steps back, it is an implicit one, if that
    /// may be much longer.
    fn limit(&mut self, longest: f64, longest_implicit: impl FnOnce() -> f64) {
        let Stiffness { is_found, restrained, patience } = &mut self.stiffness;
        *restrained = if self.length > NEARLY * longest { *restrained + 1 } else { 0 };
        self.length = self.length.min(longest);
        if *restrained >= *patience {
            *restrained = 0;
            *is_found = longest_implicit() > ADVANTAGE * longest;
            self.length *= if *is_found { ADVANTAGE } else { 1.0 };
        }
    }

    /// Keeps the next implicit step within the longest one. Where it would hardly be longer than an explicit one, it is that.
    fn limit_implicit(&mut self, longest_explicit: f64, longest: impl FnOnce() -> f64) {
        if self.length < LEAST_ADVANTAGE * longest_explicit {
            let patience = self.stiffness.patience * 2;
            self.stiffness = Stiffness { patience, ..Stiffness::default() };
            self.length = self.length.min(longest_explicit);
        } else {
            self.length = self.length.min(longest());
        }
    }

    /// Whether the error of the trial step is small enough; proposes the length of the next one.
    fn accepts(&mut self, start: &[f64; N], trial: &step::Trial<f64, N>) -> bool {
        let error = self.error(start, trial);
        self.statistics.evaluations += step::TRIAL_EVALUATIONS;
        // The eighth root.
        let accepted = self.decide(error, SAFETY / error.sqrt().sqrt().sqrt());
        self.statistics.evaluations += usize::from(accepted);
        accepted
    }

    /// Whether the error of the implicit trial step is small enough; proposes the length of the next one.
    fn accepts_implicit(&mut self, start: &[f64; N], trial: &radau::Trial<N>) -> bool {
        let error = self.size(&trial.error, start, &trial.end);
        self.decide(error, SAFETY / error.sqrt().sqrt())
    }

    /// Whether an error, as a multiple of the tolerance, is small enough; `fitting`: how many times as long a step would have the tolerance as
    /// its error.
    fn decide(&mut self, error: f64, fitting: f64) -> bool {
        let accepted = error < 1.0;
        if accepted {
            self.statistics.steps += 1;
            self.length = (self.length * self.growth.min(fitting).max(LEAST_GROWTH)).max(self.stride);
            self.growth = GREATEST_GROWTH;
        } else {
            self.reject(if error.is_finite() { fitting.max(LEAST_GROWTH) } else { NOT_FINITE_SHRINK });
        }
        accepted
    }

    /// Makes the next trial shorter.
    fn reject(&mut self, shrink: f64) {
        self.statistics.rejected_steps += 1;
        self.length *= shrink;
        self.growth = 1.0;
    }

    /// The size of a change of the state in a step, as a multiple of the tolerance.
    fn size(&self, change: &[f64; N], start: &[f64; N], end: &[f64; N]) -> f64 {
        let part = |i: usize| change[i] / (self.limits.relative_tolerance * self.size_of(i, start, end));
        ((0..N).map(|i| part(i).powi(2)).sum::<f64>() / self.counted).sqrt()
    }

    /// The size of a number of the state, to which its error is relative.
    fn size_of(&self, i: usize, start: &[f64; N], end: &[f64; N]) -> f64 {
        start[i].abs().max(end[i].abs()).max(self.magnitudes[i])
    }

    /// The error of the trial step as a multiple of the tolerance: the estimate of order 5, damped by that of order 3.
    fn error(&self, start: &[f64; N], trial: &step::Trial<f64, N>) -> f64 {
        let [mut fifth, mut third] = [0.0; 2];
        for i in 0..N {
            let weight = 1.0 / (self.limits.relative_tolerance * self.size_of(i, start, &trial.end));
            fifth += (trial.error_fifth[i] * weight).powi(2);
            third += (trial.error_third[i] * weight).powi(2);
        }
        if fifth == 0.0 && third == 0.0 {
            return f64::MIN_POSITIVE;
        }
        let denominator = ((fifth + third * 0.01) * self.counted).sqrt();
        self.length * fifth / denominator
    }

    /// The length of the first step, from the sizes of the first and second derivative (Hairer, Nørsett, Wanner, section II.4).
    fn first_step<F: StepBounds<N>>(&self, system: &F, state: &[f64; N], slope: &[f64; N]) -> f64 {
        let norm = |vector: &[f64; N]| {
            let size = |i: usize| state[i].abs().max(self.magnitudes[i]);
            let component = |i: usize| vector[i] / (self.limits.relative_tolerance * size(i));
            (0..N).map(component).map(|x| x * x).sum::<f64>().sqrt()
        };
        let first = norm(slope);
        let guess = if first > 0.0 { 0.01 * norm(state) / first } else { 1e-6 };
        let guess = guess.min(system.longest_step(self.time, state));
        let euler = from_fn(|i| state[i] + slope[i] * guess);
        let next_slope = system.derivative(self.time + guess, &euler);
        let second = norm(&from_fn(|i| next_slope[i] - slope[i])) / guess;
        let steepest = first.max(second);
        let refined = if steepest > 1e-15 { (0.01 / steepest).powf(1.0 / ORDER) } else { guess };
        // Where the trial overflowed, the guess shrinks until a step is accepted.
        if refined.is_finite() { refined.min(guess * 100.0) } else { guess }
    }
}

const ORDER: f64 = 8.0;
const SAFETY: f64 = 0.9;
const LEAST_GROWTH: f64 = 1.0 / 3.0;
const GREATEST_GROWTH: f64 = 6.0;
const NOT_FINITE_SHRINK: f64 = 0.1;
const NOT_CONVERGED_SHRINK: f64 = 0.3;
/// How many times as long as a stable explicit step another has to be to count as much longer: an implicit one costs as much as one and a half.
const ADVANTAGE: f64 = 3.0;
/// Implicit steps go on as long as they are so many times as long as explicit ones.
const LEAST_ADVANTAGE: f64 = 2.0;
/// Accuracy that asks for steps of this part of the longest one does so for the sake of stability: there the estimate of the error grows.
const NEARLY: f64 = 0.75;
/// Explicit steps that are restrained before implicit ones are tried: what decays fast is to be gone by then.
const PATIENCE: usize = 4;
/// A step shorter than this part of the end time would hardly ever get there, and at the end not advance the time at all.
const LEAST_LENGTH: f64 = 1e-18;
