//! Solves y' = f(y) with the method of Dormand and Prince of order 8(5,3), its error kept below a tolerance step by step.
//!
//! This module knows nothing of flight: a [`System`] says how the state changes, an [`Integrator`] takes steps,
//! the [`Interpolant`] of a [`Step`] gives the state at every instant inside it, and [`event`] looks there for falls through zero and
//! for maxima.

mod any_step;
pub mod event;
mod step;
mod tableau;

pub use step::{Interpolant, Step, follow};

pub(crate) use any_step::AnyStep;

use std::array::from_fn;

use crate::interrupt::Interrupt;
use crate::scalar::Lanes;

/// A system of `N` ordinary differential equations.
pub trait System<S, const N: usize> {
    /// The rate of change of each component of the state at a time, s.
    fn derivative(&self, time: S, state: &[S; N]) -> [S; N];
}

/// What a system says about the length of its steps.
pub trait StepBounds<const N: usize>: System<f64, N> {
    /// The typical size of each component; a component's tolerance is relative to the larger of its size and this.
    fn magnitudes(&self) -> [f64; N];

    /// The longest step that may start here, in seconds: a step must not jump over something that it cannot see.
    fn longest_step(&self, _time: f64, _state: &[f64; N]) -> f64 {
        f64::INFINITY
    }
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
    /// Evaluations of the derivative.
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

    /// Takes one step, which ends at `end` at the latest.
    ///
    /// # Errors
    /// When the limit of steps is reached, no step meets the tolerance, or the flag is raised.
    pub fn advance<F: StepBounds<N>>(&mut self, system: &F, end: f64) -> Result<Step<N>, IntegrationError> {
        loop {
            let trial_end = self.control.trial_end(end)?;
            let trial = step::attempt(system, self.control.time, &self.state, &self.derivative, self.control.length);
            if self.control.accepts(&self.state, &trial) {
                let end_derivative = system.derivative(trial_end, &trial.end);
                return Ok(self.take(system, trial, trial_end, end_derivative));
            }
        }
    }

    /// Repeats the beginning of a step, so that it ends exactly at `end`; the state there is more accurate than the dense output.
    pub fn shorten<F: StepBounds<N>>(&mut self, system: &F, step: &Step<N>, end: f64) -> Step<N> {
        (self.control.time, self.state, self.derivative) = (step.start_time, step.start, step.start_derivative);
        let trial = step::attempt(system, self.control.time, &self.state, &self.derivative, end - step.start_time);
        self.control.statistics.evaluations += step::TRIAL_EVALUATIONS + 1;
        let end_derivative = system.derivative(end, &trial.end);
        self.take(system, trial, end, end_derivative)
    }

    /// Goes on from the end of a step with a system, or a state, that changes there.
    pub fn restart<F: StepBounds<N>>(&mut self, system: &F, time: f64, state: [f64; N]) {
        (self.control.time, self.state) = (time, state);
        self.derivative = system.derivative(self.control.time, &self.state);
        self.control.statistics.evaluations += 1;
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
        (self.control.time, self.state, self.derivative) = (end_time, step.end, end_derivative);
        self.control.shorten(system.longest_step(end_time, &self.state));
        step
    }
}

/// Tries a step of each integrator, all computed at once by the `system` of their lanes, to the ends at the latest.
///
/// Each lane has an integrator, its own system, and its end, s. A lane whose trial meets its tolerance advances by it; the others will
/// try a shorter one the next time. A lane without an integrator is idle. The steps are those that the integrators would take alone,
/// to the last digit.
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
    statistics: Statistics,
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
        let mut control =
            Self { limits, magnitudes, counted, time, length: 0.0, stride: 0.0, growth: GREATEST_GROWTH, statistics };
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

    /// Whether the error of the trial step is small enough; proposes the length of the next one.
    fn accepts(&mut self, start: &[f64; N], trial: &step::Trial<f64, N>) -> bool {
        let error = self.error(start, trial);
        self.statistics.evaluations += step::TRIAL_EVALUATIONS;
        // The eighth root.
        let fitting = SAFETY / error.sqrt().sqrt().sqrt();
        let accepted = error < 1.0;
        if accepted {
            self.statistics.evaluations += 1;
            self.statistics.steps += 1;
            self.length = (self.length * self.growth.min(fitting).max(LEAST_GROWTH)).max(self.stride);
            self.growth = GREATEST_GROWTH;
        } else {
            self.statistics.rejected_steps += 1;
            self.length *= if error.is_finite() { fitting.max(LEAST_GROWTH) } else { NOT_FINITE_SHRINK };
            self.growth = 1.0;
        }
        accepted
    }

    /// The error of the trial step as a multiple of the tolerance: the estimate of order 5, damped by that of order 3.
    fn error(&self, start: &[f64; N], trial: &step::Trial<f64, N>) -> f64 {
        let [mut fifth, mut third] = [0.0; 2];
        for (i, magnitude) in self.magnitudes.iter().enumerate() {
            let size = start[i].abs().max(trial.end[i].abs()).max(*magnitude);
            let weight = 1.0 / (self.limits.relative_tolerance * size);
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
/// A step shorter than this part of the end time would hardly ever get there, and at the end not advance the time at all.
const LEAST_LENGTH: f64 = 1e-18;
