//! Solves y' = f(y) with the method of Dormand and Prince of order 8(5,3), its error kept below a tolerance step by step.
//!
//! This module knows nothing of flight: a [`System`] says how the state changes, an [`Integrator`] takes steps,
//! a [`Step`] gives the state at every instant inside it, and [`event`] looks there for falls through zero and for maxima.

pub mod event;
mod step;
mod tableau;

pub use step::Step;

use std::sync::atomic::{AtomicBool, Ordering};

use crate::scalar::Scalar;

/// A system of `N` ordinary differential equations that do not depend on time.
pub trait System<const N: usize> {
    /// The rate of change of each component of the state.
    fn derivative<S: Scalar>(&self, state: &[S; N]) -> [S; N];

    /// The typical size of each component; a component's tolerance is relative to the larger of its size and this.
    fn magnitudes(&self) -> [f64; N];

    /// The longest step that may start here, in seconds: a step must not jump over something that it cannot see.
    fn longest_step(&self, _state: &[f64; N], _derivative: &[f64; N]) -> f64 {
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
    pub interrupt: &'a AtomicBool,
}

/// Advances a state step by step.
#[derive(Debug)]
pub struct Integrator<'a, F, S, const N: usize> {
    system: &'a F,
    limits: Limits<'a>,
    time: f64,
    state: [S; N],
    derivative: [S; N],
    proposal: f64,
    statistics: Statistics,
}

impl<'a, F: System<N>, S: Scalar, const N: usize> Integrator<'a, F, S, N> {
    /// Starts at t = 0 with the given state.
    pub fn new(system: &'a F, state: [S; N], limits: Limits<'a>) -> Self {
        let derivative = system.derivative(&state);
        let mut integrator =
            Self { system, limits, time: 0.0, state, derivative, proposal: 0.0, statistics: Statistics::default() };
        integrator.proposal = integrator.first_step();
        integrator.statistics.evaluations = 2;
        integrator
    }

    /// What the steps so far cost.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// The rate of change at the present state.
    pub fn derivative(&self) -> &[S; N] {
        &self.derivative
    }

    /// Takes one step, which ends at `end` at the latest.
    ///
    /// # Errors
    /// When the limit of steps is reached, no step meets the tolerance, or the flag is raised.
    pub fn advance(&mut self, end: f64) -> Result<Step<S, N>, IntegrationError> {
        let longest = self.system.longest_step(&values(&self.state), &values(&self.derivative));
        let mut length = self.proposal.min(longest);
        let mut growth = GREATEST_GROWTH;
        loop {
            self.check_limits()?;
            // A remainder below one per cent of a step is taken along.
            let step_end = if self.time + length * 1.01 >= end { end } else { self.time + length };
            length = step_end - self.time;
            if length.is_nan() || length <= LEAST_LENGTH * end {
                return Err(IntegrationError::StepTooSmall { time: self.time });
            }

            let trial = step::attempt(self.system, &self.state, &self.derivative, length);
            self.statistics.evaluations += step::TRIAL_EVALUATIONS;
            let error = self.error(&trial, length);
            if error < 1.0 {
                let accepted = step::complete(self.system, self.time, step_end, &self.state, &trial);
                self.statistics.evaluations += step::COMPLETION_EVALUATIONS;
                self.statistics.steps += 1;
                self.proposal = length * growth.min(SAFETY * error.powf(-1.0 / ORDER)).max(LEAST_GROWTH);
                self.time = step_end;
                self.state = accepted.end;
                self.derivative = accepted.end_derivative;
                return Ok(accepted);
            }
            self.statistics.rejected_steps += 1;
            growth = 1.0;
            length *= if error.is_finite() {
                (SAFETY * error.powf(-1.0 / ORDER)).max(LEAST_GROWTH)
            } else {
                NOT_FINITE_SHRINK
            };
        }
    }

    /// Repeats the beginning of a step, so that it ends exactly at `end`; the state there is more accurate than the dense output.
    pub fn shorten(&mut self, step: &Step<S, N>, end: f64) -> Step<S, N> {
        let trial = step::attempt(self.system, &step.start, &step.start_derivative, end - step.start_time);
        self.statistics.evaluations += step::TRIAL_EVALUATIONS + step::COMPLETION_EVALUATIONS;
        let shorter = step::complete(self.system, step.start_time, end, &step.start, &trial);
        self.time = end;
        self.state = shorter.end;
        self.derivative = shorter.end_derivative;
        shorter
    }

    fn check_limits(&self) -> Result<(), IntegrationError> {
        let Limits { steps: limit, interrupt, .. } = self.limits;
        if interrupt.load(Ordering::Relaxed) {
            return Err(IntegrationError::Interrupted { time: self.time });
        }
        if self.statistics.steps + self.statistics.rejected_steps >= limit {
            return Err(IntegrationError::StepLimit { time: self.time, limit });
        }
        Ok(())
    }

    /// The error of the trial step as a multiple of the tolerance: the estimate of order 5, damped by that of order 3.
    fn error(&self, trial: &step::Trial<S, N>, length: f64) -> f64 {
        let magnitudes = self.system.magnitudes();
        let [mut fifth, mut third] = [0.0; 2];
        for (i, magnitude) in magnitudes.iter().enumerate() {
            let size = self.state[i].value().abs().max(trial.end[i].value().abs()).max(*magnitude);
            let tolerance = self.limits.relative_tolerance * size;
            fifth += (trial.error_fifth[i].value() / tolerance).powi(2);
            third += (trial.error_third[i].value() / tolerance).powi(2);
        }
        if fifth == 0.0 && third == 0.0 {
            return f64::MIN_POSITIVE;
        }
        #[expect(clippy::cast_precision_loss, reason = "N is a handful")]
        let denominator = ((fifth + third * 0.01) * N as f64).sqrt();
        length * fifth / denominator
    }

    /// The length of the first step, from the sizes of the first and second derivative (Hairer, Nørsett, Wanner, section II.4).
    fn first_step(&self) -> f64 {
        let magnitudes = self.system.magnitudes();
        let state = values(&self.state);
        let slope = values(&self.derivative);
        let norm = |vector: &[f64; N]| {
            let component = |i: usize| vector[i] / (self.limits.relative_tolerance * state[i].abs().max(magnitudes[i]));
            (0..N).map(component).map(|x| x * x).sum::<f64>().sqrt()
        };
        let first = norm(&slope);
        let guess = if first > 0.0 { 0.01 * norm(&state) / first } else { 1e-6 };
        let guess = guess.min(self.system.longest_step(&state, &slope));
        let euler = std::array::from_fn(|i| state[i] + slope[i] * guess);
        let next_slope: [f64; N] = self.system.derivative(&euler);
        let second = norm(&std::array::from_fn(|i| next_slope[i] - slope[i])) / guess;
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

fn values<S: Scalar, const N: usize>(state: &[S; N]) -> [f64; N] {
    state.map(Scalar::value)
}
