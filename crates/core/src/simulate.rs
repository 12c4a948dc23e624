//! The flight: from a scenario to a trajectory.

mod abreast;
mod descent;
mod extremes;
mod flight;
mod passage;

pub use abreast::arrivals;

use std::sync::atomic::AtomicBool;

use crate::integrate::Step;
use crate::motion::{Cartesian, Formulation, Singularity, Spherical};
use crate::scenario::{Equations, Plain, Scenario};
use crate::trajectory::{Arrival, Trajectory};
use extremes::Extremes;
use flight::Flight;
use passage::Passage;

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
        Equations::Cartesian => record(scenario, &Cartesian(forces), interrupt),
        Equations::Spherical => record(scenario, &Spherical(forces), interrupt),
    }
}

/// Flies the scenario like [`simulate`], but keeps nothing of the flight except its end, and allocates no memory.
///
/// # Errors
/// Those of [`simulate`], except that loads beyond all numbers go unnoticed.
pub fn arrival(scenario: &Scenario, interrupt: &AtomicBool) -> Result<Arrival, SimulationError> {
    let forces = scenario.case().forces();
    match scenario.case().solver.equations {
        Equations::Cartesian => fly(scenario, &Cartesian(forces), interrupt, |_| Ok(())),
        Equations::Spherical => fly(scenario, &Spherical(forces), interrupt, |_| Ok(())),
    }
}

fn record<F: Formulation>(
    scenario: &Scenario,
    motion: &F,
    interrupt: &AtomicBool,
) -> Result<Trajectory, SimulationError> {
    let case = scenario.case();
    let start = F::coordinates(&case.initial_state);
    flight::regular(motion, 0.0, &start)?;
    let mut steps: Vec<Step<6>> = Vec::with_capacity(TYPICAL_STEPS);
    let mut extremes = Extremes::new(motion, case.vehicle.has_lift(), &start)?;
    let arrival = fly(scenario, motion, interrupt, |passage| {
        extremes.observe(motion, passage)?;
        steps.push(passage.step.clone());
        Ok(())
    })?;
    Ok(Trajectory { case: case.clone(), start, steps, arrival, peaks: extremes.peaks, warnings: extremes.warnings })
}

/// Flies to the end and shows every step on the way.
fn fly<F: Formulation>(
    scenario: &Scenario,
    motion: &F,
    interrupt: &AtomicBool,
    mut observe: impl FnMut(&Passage<F>) -> Result<(), SimulationError>,
) -> Result<Arrival, SimulationError> {
    let mut flight = Flight::start(scenario, motion, interrupt)?;
    if scenario.ends_at_start() {
        return Ok(flight.at_start());
    }
    loop {
        let step = flight.integrator.advance(scenario.case().stop.time).map_err(|error| flight.failure(error))?;
        if let Some(arrival) = flight.pass(step, &mut observe)? {
            return Ok(arrival);
        }
    }
}

/// Steps for which room is made at once: more than most flights take.
const TYPICAL_STEPS: usize = 64;
