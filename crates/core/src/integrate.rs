//! Solves y' = f(y) with the method of Dormand and Prince of order 8(5,3), and where it is stiff with the implicit method Radau IIA of order 5;
//! the error is kept below a tolerance step by step.
//!
//! This module knows nothing of flight: a [`System`] says how the state changes, an [`Integrator`] takes steps,
//! the [`Interpolant`] of a [`Step`] gives the state at every instant inside it, and [`event`] looks there for falls through zero and
//! for maxima.

mod any_step;
mod elimination;
pub mod event;
mod lanes;
mod radau;
mod step;
mod step_control;
mod tableau;

pub use lanes::{LaneBounds, LaneInstructions, LaneJob, LaneSteps, lane_instructions, use_lanes};
pub use radau::follow_implicitly;
pub use step::{Interpolant, Step, follow};

pub(crate) use any_step::AnyStep;

use std::array::from_fn;

use nalgebra::Const;
use num_dual::DualSVec64;

use crate::interrupt::Interrupt;
use step::Inside;
use step_control::{NOT_CONVERGED_SHRINK, StepControl, TrialError};

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

    /// The time to the next corner of the rates of change that is not nearer than `least`, s, as the present rates have it: a step across a
    /// corner may miss the tolerance for that alone.
    fn time_to_corner(&self, _time: f64, _state: &[f64; N], _derivative: &[f64; N], _least: f64) -> f64 {
        f64::INFINITY
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

/// The end of an explicit trial step.
#[derive(Debug)]
struct TrialEnd<const N: usize> {
    /// s.
    time: f64,
    state: [f64; N],
    derivative: [f64; N],
    /// What the step keeps.
    slopes: step::KeptSlopes<N>,
    /// That may start here, s.
    longest_step: f64,
}

impl<const N: usize> TrialEnd<N> {
    #[inline]
    fn of<F: StepBounds<N>>(system: &F, time: f64, trial: &step::Trial<f64, N>) -> Self {
        let state = trial.outcome.end;
        let (derivative, slopes) = (system.derivative(time, &state), trial.kept_slopes());
        Self { time, state, derivative, slopes, longest_step: system.longest_step(time, &state) }
    }
}

/// Advances the state of a system step by step.
///
/// Every call is given the system, which may change from one step to the next; then comes [`restart`](Self::restart).
#[derive(Debug)]
pub struct Integrator<'a, const N: usize> {
    control: StepControl<'a, N>,
    state: [f64; N],
    derivative: [f64; N],
    /// The last step, where it was an implicit one from whose end the next one starts.
    previous: Option<radau::PreviousStep<N>>,
}

impl<'a, const N: usize> Integrator<'a, N> {
    /// Starts at a time, s, with the given state.
    pub fn new<F: StepBounds<N>>(system: &F, time: f64, state: [f64; N], limits: Limits<'a>) -> Self {
        let derivative = system.derivative(time, &state);
        let mut control = StepControl::new(system, time, &state, &derivative, limits);
        control.shorten(system.longest_step(time, &state));
        Self { control, state, derivative, previous: None }
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
            let trial_end = self.prepare(system, end)?;
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
                let Self { control, state, derivative, .. } = self;
                let trial = step::attempt(system, control.time, state, derivative, control.length);
                let error = control.error(state, &trial.outcome);
                if self.accepts(system, error) {
                    return Ok(self.take(system, &TrialEnd::of(system, trial_end, &trial)));
                }
            }
        }
    }

    /// Makes the next trial step ready, which ends at `end` at the latest; returns when it ends, s.
    fn prepare<F: StepBounds<N>>(&mut self, system: &F, end: f64) -> Result<f64, IntegrationError> {
        if !self.is_stiff() && self.control.expects_corner() {
            let corner = self.time_to_corner(system, self.control.length);
            self.control.go_to_corner(corner);
        }
        self.control.trial_end(end)
    }

    /// Whether an explicit trial step of an error is exact enough; otherwise the next one will be shorter.
    #[inline]
    fn accepts<F: StepBounds<N>>(&mut self, system: &F, error: TrialError<f64>) -> bool {
        let length = self.control.length;
        let is_accepted = self.control.accepts(error);
        if !is_accepted {
            let corner = self.time_to_corner(system, length);
            self.control.end_at_corner(length, corner);
        }
        is_accepted
    }

    /// The time to the next corner of the rates that is not just at the start of a step of a length, s.
    fn time_to_corner<F: StepBounds<N>>(&self, system: &F, length: f64) -> f64 {
        system.time_to_corner(self.control.time, &self.state, &self.derivative, LEAST_WAY_TO_CORNER * length)
    }

    /// Repeats the beginning of a step, so that it ends exactly at `end`; the state there is more accurate than the dense output.
    pub fn shorten<F: StepBounds<N>>(&mut self, system: &F, step: &Step<N>, end: f64) -> Step<N> {
        (self.control.time, self.state, self.derivative) = (step.start_time, step.start, step.start_derivative);
        self.previous = None;
        let length = end - step.start_time;
        if step.is_implicit()
            && let Some(trial) = self.attempt_implicit(system, length)
        {
            return self.take_implicit(system, &trial, end);
        }
        let trial = step::attempt(system, self.control.time, &self.state, &self.derivative, length);
        self.control.statistics.evaluations += step::TRIAL_EVALUATIONS + 1;
        self.take(system, &TrialEnd::of(system, end, &trial))
    }

    /// Ends the step that was taken last inside it, at a part of it, as its interpolant has the state there: which costs one evaluation. None
    /// where that is not as exact as the step.
    pub(crate) fn end_inside<F: System<f64, N>>(
        &mut self,
        system: &F,
        step: &Step<N>,
        interpolant: &Interpolant<N>,
        part: f64,
    ) -> Option<Step<N>> {
        // The interpolant has state and rates of the step at both ends, so that its error inside goes with θ² (1-θ)².
        let error = self.control.error * (4.0 * part * (1.0 - part)).powi(2);
        if error > if step.is_implicit() { IMPLICIT_INTERPOLANT } else { EXPLICIT_INTERPOLANT } {
            return None;
        }
        let beginning = step.beginning(system, interpolant, part);
        self.control.statistics.evaluations += 1;
        self.previous = None;
        self.go_to_end(&beginning);
        Some(beginning)
    }

    /// The length of the next step, s, as it is proposed.
    pub(crate) fn proposed_length(&self) -> f64 {
        self.control.length
    }

    /// The next step ends at a time, s, if it would go beyond, or nearly as far: where something is predicted that will cut it.
    pub(crate) fn aim_at(&mut self, time: f64) {
        self.control.aim_at(time);
    }

    /// Goes on from the end of a step with a system, or a state, that changes there. What decays fast there is to be followed first.
    pub fn restart<F: StepBounds<N>>(&mut self, system: &F, time: f64, state: [f64; N]) {
        self.control.statistics.evaluations += 1;
        self.restart_with(system, time, state, system.derivative(time, &state));
    }

    /// The same, where the rate of change is known.
    pub(crate) fn restart_with<F: StepBounds<N>>(
        &mut self,
        system: &F,
        time: f64,
        state: [f64; N],
        derivative: [f64; N],
    ) {
        let before = std::mem::replace(&mut self.derivative, derivative);
        (self.control.time, self.state) = (time, state);
        self.previous = None;
        self.control.restart(system, &self.state, &self.derivative, &before);
        self.control.shorten(system.longest_step(time, &self.state));
    }

    /// Goes to the end of an explicit trial step.
    #[inline]
    fn take<F: StepBounds<N>>(&mut self, system: &F, trial: &TrialEnd<N>) -> Step<N> {
        let TrialEnd { time, state, derivative, slopes, longest_step } = *trial;
        let step = Step {
            start_time: self.control.time,
            end_time: time,
            start: self.state,
            end: state,
            start_derivative: self.derivative,
            end_derivative: derivative,
            inside: Inside::Explicit(slopes),
        };
        self.go_to(system, time, state, derivative, longest_step);
        step
    }

    /// Goes to the end of an explicit step: its time, s, its state, and the rate of change there. `longest_step`: that of the next one, s.
    #[inline]
    fn go_to<F: StepBounds<N>>(
        &mut self,
        system: &F,
        time: f64,
        state: [f64; N],
        derivative: [f64; N],
        longest_step: f64,
    ) {
        self.previous = None;
        (self.control.time, self.state, self.derivative) = (time, state, derivative);
        self.control.limit(longest_step, || system.longest_implicit_step(time, &self.state));
    }

    /// Tries an implicit step of a length, s.
    fn attempt_implicit<F: StepBounds<N>>(&mut self, system: &F, length: f64) -> Option<radau::Trial<N>> {
        let Self { control, state, derivative, previous } = self;
        let start = radau::Start { time: control.time, state, derivative };
        let size = |change: &[f64; N]| control.size(change, state, state);
        let mut evaluations = 0;
        let trial = radau::attempt(system, &start, length, previous.as_ref(), size, &mut evaluations);
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
        self.previous = Some(radau::PreviousStep::of(trial, &step));
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

/// A corner nearer than this part of a rejected step is not why it was rejected.
const LEAST_WAY_TO_CORNER: f64 = 0.05;
/// The greatest error inside a step, as a multiple of the tolerance, with which an end inside it counts as exact as its end. Without the factor that
/// goes with the place, the interpolant of an explicit step is about as exact as the step, and that of an implicit one has a hundred times the error.
const EXPLICIT_INTERPOLANT: f64 = 1e-3;
const IMPLICIT_INTERPOLANT: f64 = 5e-4;
