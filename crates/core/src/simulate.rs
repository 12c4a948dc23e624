//! The flight: from a scenario to a trajectory.

mod abreast;
mod alarms;
mod descent;
mod extremes;
mod flight;
mod passage;
mod watch;

pub use abreast::arrivals;

use crate::integrate::Step;
use crate::interrupt::Interrupt;
use crate::motion::{Cartesian, Formulation, Singularity, Spherical, Switch};
use crate::plain::Plain;
use crate::scenario::{Equations, Phase, Scenario};
use crate::trajectory::{Arrival, Flown, Leg, LegStep, Trajectory};
use extremes::Extremes;
use flight::{Flight, Log};
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
    /// The thrust has burnt the vehicle up.
    #[error("by t = {} s the thrust has burnt all the mass that there was", Plain(*.time))]
    NothingLeft {
        /// The instant reached, s.
        time: f64,
    },
    /// A braking thrust has brought the vehicle to rest, where it has no direction.
    #[error(
        "the thrust of event {event} has no direction from t = {time:.3} s on, at an altitude of {altitude:.2} m: it acts along the velocity, \
         and the vehicle is at rest"
    )]
    NoDirection {
        /// The number of the event that switched the thrust on.
        event: usize,
        /// The instant reached, s.
        time: f64,
        /// Along the radius vector, m.
        altitude: f64,
    },
    /// The steps that the flight keeps have no room in memory.
    #[error("no room in memory for the steps after t = {} s", Plain(*.time))]
    NoRoom {
        /// The instant reached, s.
        time: f64,
    },
    /// Whoever asked for the flight ended it.
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
        Switch::Radiation => "the radiation of the air",
    }
}

/// Flies the scenario until it crosses the stop altitude downwards, its time is over, or a condition for its end is met.
///
/// `interrupt` is asked before every step; once it is raised, the flight ends with an error.
///
/// # Errors
/// When the flight needs too many or too small steps, when it reaches a singularity of the spherical equations, when thrust burns all
/// of the vehicle or brakes it to rest, and when interrupted.
pub fn simulate(scenario: &Scenario, interrupt: &dyn Interrupt) -> Result<Trajectory, SimulationError> {
    let case = scenario.case();
    match (case.solver.equations, case.heating) {
        (Equations::Cartesian, None) => record(scenario, Cartesian(case.forces()), LegStep::Plain, interrupt),
        (Equations::Spherical, None) => record(scenario, Spherical(case.forces()), LegStep::Plain, interrupt),
        (Equations::Cartesian, Some(_)) => record(scenario, Cartesian(case.forces()), LegStep::Heated, interrupt),
        (Equations::Spherical, Some(_)) => record(scenario, Spherical(case.forces()), LegStep::Heated, interrupt),
    }
}

/// Flies the scenario like [`simulate`], but keeps nothing of the flight except its end, and, but for events, allocates no memory.
///
/// # Errors
/// Those of [`simulate`], except that loads beyond all numbers go unnoticed.
pub fn arrival(scenario: &Scenario, interrupt: &dyn Interrupt) -> Result<Arrival, SimulationError> {
    fn end<F: Formulation<N>, const N: usize>(
        scenario: &Scenario,
        motion: F,
        interrupt: &dyn Interrupt,
    ) -> Result<Arrival, SimulationError> {
        fly(&mut Flight::start(scenario, motion, interrupt)?, |_| Ok(()))
    }
    let case = scenario.case();
    match (case.solver.equations, case.heating) {
        (Equations::Cartesian, None) => end::<_, 6>(scenario, Cartesian(case.forces()), interrupt),
        (Equations::Spherical, None) => end::<_, 6>(scenario, Spherical(case.forces()), interrupt),
        (Equations::Cartesian, Some(_)) => end::<_, 7>(scenario, Cartesian(case.forces()), interrupt),
        (Equations::Spherical, Some(_)) => end::<_, 7>(scenario, Spherical(case.forces()), interrupt),
    }
}

fn record<F: Formulation<N>, const N: usize>(
    scenario: &Scenario,
    motion: F,
    keep: impl Fn(Step<N>) -> LegStep,
    interrupt: &dyn Interrupt,
) -> Result<Trajectory, SimulationError> {
    let case = scenario.case();
    let mut flight = Flight::start(scenario, motion, interrupt)?;
    let mut legs = Vec::with_capacity(TYPICAL_STEPS);
    let mut extremes = Extremes::new(&flight.motion, &flight.integrator, case.may_lift())?;
    let start = flight.instant();
    let arrival = fly(&mut flight, |passage| {
        extremes.observe(passage)?;
        let regime = passage.motion.forces().regime();
        legs.push(Leg { step: keep(passage.step.clone()), phase: passage.phase, regime });
        if legs.len() % STEPS_BETWEEN_LOOKS == 0 && !interrupt.may_hold(legs.capacity() * size_of::<Leg>()) {
            return Err(SimulationError::NoRoom { time: passage.step.end_time });
        }
        Ok(())
    })?;
    let end = flight.instant();
    extremes.end(flight.motion.forces(), &end)?;
    let Extremes { peaks_of_flight: peaks, peaks_of_phases, mut warnings, .. } = extremes;
    let Log { mut phases, happenings, warnings: others } = flight.log;
    phases.insert(0, Phase::first(case));
    warnings.extend(others);
    Ok(Trajectory::new(
        case.clone(),
        Flown { start, legs, phases, happenings, end, arrival, peaks, peaks_of_phases, warnings },
    ))
}

/// Flies to the end and shows every step on the way.
fn fly<F: Formulation<N>, const N: usize>(
    flight: &mut Flight<F, N>,
    mut observe: impl FnMut(&Passage<F, N>) -> Result<(), SimulationError>,
) -> Result<Arrival, SimulationError> {
    if let Some(arrival) = flight.begin()? {
        return Ok(arrival);
    }
    loop {
        let step = flight.advance()?;
        if let Some(arrival) = flight.pass(&step, &mut observe)? {
            return Ok(arrival);
        }
    }
}

/// Steps for which room is made at once: more than most flights take.
const TYPICAL_STEPS: usize = 64;

/// Steps that are kept between two looks at what may be held: less than a megabyte.
const STEPS_BETWEEN_LOOKS: usize = 1024;
