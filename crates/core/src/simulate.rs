//! The flight: from a scenario to a trajectory.

mod abreast;
mod descent;
mod extremes;
mod flight;
mod passage;
mod watch;

pub use abreast::arrivals;

use std::sync::atomic::AtomicBool;

use crate::motion::{Cartesian, Formulation, Singularity, Spherical, Switch};
use crate::scenario::{Equations, Plain, Scenario};
use crate::trajectory::{Arrival, Leg, Trajectory};
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
    /// On either side of a boundary the motion leads back across it.
    #[error(
        "{} switches back and forth from t = {} s on: on either side of one of its entries the flight is led back to it",
        name(*.switch), Plain(*.time)
    )]
    Chatter {
        /// The instant reached, s.
        time: f64,
        /// What switches.
        switch: Switch,
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

fn name(switch: Switch) -> &'static str {
    match switch {
        Switch::Atmosphere => "the atmosphere",
        Switch::Wind => "the wind",
        Switch::Mach | Switch::TableAngleOfAttack => "the table of aerodynamics",
        Switch::BankAngle => "the schedule of the bank angle",
        Switch::AngleOfAttack => "the schedule of the angle of attack",
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
        Equations::Cartesian => record(scenario, Cartesian(forces), interrupt),
        Equations::Spherical => record(scenario, Spherical(forces), interrupt),
    }
}

/// Flies the scenario like [`simulate`], but keeps nothing of the flight except its end, and allocates no memory.
///
/// # Errors
/// Those of [`simulate`], except that loads beyond all numbers go unnoticed.
pub fn arrival(scenario: &Scenario, interrupt: &AtomicBool) -> Result<Arrival, SimulationError> {
    let forces = scenario.case().forces();
    match scenario.case().solver.equations {
        Equations::Cartesian => fly(scenario, &mut Flight::start(scenario, Cartesian(forces), interrupt)?, |_| Ok(())),
        Equations::Spherical => fly(scenario, &mut Flight::start(scenario, Spherical(forces), interrupt)?, |_| Ok(())),
    }
}

fn record<F: Formulation>(
    scenario: &Scenario,
    motion: F,
    interrupt: &AtomicBool,
) -> Result<Trajectory, SimulationError> {
    let mut flight = Flight::start(scenario, motion, interrupt)?;
    let mut legs = Vec::with_capacity(TYPICAL_STEPS);
    let mut extremes = Extremes::new(&flight.motion, &flight.integrator, scenario.case().vehicle.has_lift())?;
    let first_regime = flight.motion.forces().regime();
    let arrival = fly(scenario, &mut flight, |passage| {
        extremes.observe(passage)?;
        legs.push(Leg { step: passage.step.clone(), regime: passage.motion.forces().regime() });
        Ok(())
    })?;
    let case = scenario.case().clone();
    let start = F::planet_fixed(&F::coordinates(&case.initial_state));
    let regimes = [first_regime, flight.motion.forces().regime()];
    Ok(Trajectory::new(case, start, regimes, legs, arrival, extremes.peaks, extremes.warnings))
}

/// Flies to the end and shows every step on the way.
fn fly<F: Formulation>(
    scenario: &Scenario,
    flight: &mut Flight<F>,
    mut observe: impl FnMut(&Passage<F>) -> Result<(), SimulationError>,
) -> Result<Arrival, SimulationError> {
    if scenario.ends_at_start() {
        return Ok(flight.at_start());
    }
    loop {
        let step = flight.advance()?;
        if let Some(arrival) = flight.pass(step, &mut observe)? {
            return Ok(arrival);
        }
    }
}

/// Steps for which room is made at once: more than most flights take.
const TYPICAL_STEPS: usize = 64;
