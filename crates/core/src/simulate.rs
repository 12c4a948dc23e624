//! The flight: from a scenario to a trajectory.

mod watch;

use std::sync::atomic::AtomicBool;

use crate::integrate::{IntegrationError, Integrator, Limits, Step};
use crate::motion::{Cartesian, Formulation, Singularity, Spherical};
use crate::scenario::{Equations, Plain, Scenario};
use crate::trajectory::{Termination, Trajectory};
use watch::Watch;

/// Why a flight could not be finished.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The limit on the number of steps was reached.
    #[error("the flight took more than {limit} integration steps; it got to t = {} s", Plain(*.time))]
    StepLimit {
        /// The instant reached, s.
        time: f64,
        /// The limit.
        limit: usize,
    },
    /// The spherical equations of motion break down.
    #[error("the spherical equations of motion are singular {}, reached at t = {} s", place(*.at), Plain(*.time))]
    Singularity {
        /// The instant reached, s.
        time: f64,
        /// Which of the singularities.
        at: Singularity,
    },
    /// No step that advances the time meets the tolerance.
    #[error("the motion changes too fast to be followed at t = {} s", Plain(*.time))]
    TooStiff {
        /// The instant reached, s.
        time: f64,
    },
    /// A quantity of the flight is too large for a floating-point number.
    #[error("the loads at t = {} s are too large for a floating-point number", Plain(*.time))]
    Overflow {
        /// The instant reached, s.
        time: f64,
    },
    /// The flag was raised.
    #[error("interrupted at t = {} s", Plain(*.time))]
    Interrupted {
        /// The instant reached, s.
        time: f64,
    },
}

fn place(singularity: Singularity) -> &'static str {
    match singularity {
        Singularity::Pole => "at the poles",
        Singularity::VerticalFlight => "in vertical flight",
        Singularity::Rest => "at rest",
    }
}

/// Flies the scenario until it crosses the stop altitude downwards or its time is over.
///
/// `interrupt` is looked at before every step; once it is true, the flight ends with an error.
///
/// # Errors
/// When the flight needs too many or too small steps, when it reaches a singularity of the spherical equations, and when interrupted.
pub fn simulate(scenario: &Scenario, interrupt: &AtomicBool) -> Result<Trajectory, SimulationError> {
    let forces = scenario.case().forces();
    match scenario.case().solver.equations {
        Equations::Cartesian => fly(scenario, &Cartesian(forces), interrupt),
        Equations::Spherical => fly(scenario, &Spherical(forces), interrupt),
    }
}

fn fly<F: Formulation>(scenario: &Scenario, motion: &F, interrupt: &AtomicBool) -> Result<Trajectory, SimulationError> {
    let case = scenario.case();
    let limits =
        Limits { relative_tolerance: case.solver.relative_tolerance, steps: case.solver.step_limit, interrupt };
    let start = F::coordinates(&case.initial_state);
    regular(motion, 0.0, &start)?;
    let mut integrator = Integrator::new(motion, start, limits);
    let mut watch = Watch::new(motion, case.stop.altitude, &start, integrator.derivative())?;
    if scenario.rises_from_stop_altitude() {
        watch.start_upward();
    }

    let mut steps: Vec<Step<f64, 6>> = Vec::new();
    let mut termination = scenario.ends_at_start().then_some(Termination::SurfaceImpact);
    while termination.is_none() {
        let mut step = integrator.advance(case.stop.time).map_err(|error| {
            let last = steps.last().map_or(&start, |step| &step.end);
            failure(motion, error, last)
        })?;
        if let Some(part) = watch.impact(&step) {
            step = land(&mut integrator, &watch, &step, step.time(part));
            termination = Some(Termination::SurfaceImpact);
        } else if step.end_time >= case.stop.time {
            termination = Some(Termination::TimeLimit);
        }
        regular(motion, step.end_time, &step.end)?;
        watch.observe(&step)?;
        steps.push(step);
    }
    Ok(Trajectory {
        case: *case,
        start,
        steps,
        termination: termination.unwrap_or(Termination::TimeLimit),
        peaks: watch.peaks,
        warnings: watch.warnings,
        statistics: integrator.statistics(),
    })
}

/// Repeats the step so that it ends on the stop altitude, which the dense output crosses at `time`.
///
/// The repeated step is more accurate than the dense output: its own crossing is found by Newton's method.
fn land<F: Formulation>(
    integrator: &mut Integrator<'_, F, f64, 6>,
    watch: &Watch<'_, F>,
    step: &Step<f64, 6>,
    mut time: f64,
) -> Step<f64, 6> {
    let mut landing = integrator.shorten(step, time);
    for _ in 0..5 {
        let late = watch.lateness(&landing);
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

/// Refuses a state in which the equations break down.
fn regular<F: Formulation>(motion: &F, time: f64, state: &[f64; 6]) -> Result<(), SimulationError> {
    match motion.singularity(state, SINGULAR) {
        Some(at) => Err(SimulationError::Singularity { time, at }),
        None => Ok(()),
    }
}

/// What an integration error after the `last` state means for the flight: near a singularity, that is the reason.
fn failure<F: Formulation>(motion: &F, error: IntegrationError, last: &[f64; 6]) -> SimulationError {
    let (time, otherwise) = match error {
        IntegrationError::StepLimit { time, limit } => (time, SimulationError::StepLimit { time, limit }),
        IntegrationError::StepTooSmall { time } => (time, SimulationError::TooStiff { time }),
        IntegrationError::Interrupted { time } => return SimulationError::Interrupted { time },
    };
    match motion.singularity(last, NEARLY_SINGULAR) {
        Some(at) => SimulationError::Singularity { time, at },
        None => otherwise,
    }
}

/// Closer to a singularity than this (rad, or parts of the circular speed) rounding costs more digits than the tolerances allow.
const SINGULAR: f64 = 1e-8;
/// An integration that fails this close to a singularity fails because of it.
const NEARLY_SINGULAR: f64 = 1e-2;
