//! Propagation of a scenario to its end: the trajectory, its end with events and peaks, or the arrival alone.

mod bodies;
mod conditions;
mod detector;
mod flight;
mod lanes;
mod model_boundaries;
mod peak_tracker;
mod step_view;
mod stop_altitude;

pub use bodies::{BodyError, Flights, SeparatedBody, simulate_with_bodies};
pub use lanes::{ends_of_all, extremes_of_all};

use std::mem::take;

use crate::integrate::{AnyStep, Step};
use crate::interrupt::Interrupt;
use crate::motion::{EndReadings, Forces, Formulation, Singularity, Switch};
use crate::number_text::NumberText;
use crate::scenario::{ForFormulation, FormulationIn, Phase, Scenario, dispatch};
use crate::trajectory::{Arrival, Ends, Extremes, Flown, Instant, StoredStep, Trajectory, Warning};
use flight::{Flight, FlightLog};
use peak_tracker::PeakTracker;
use step_view::StepView;

/// Why a flight could not be finished.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The limit on the number of steps was reached.
    #[error("the flight needs more than {limit} integration steps; it reached t = {} s", NumberText(*.time))]
    StepLimit {
        /// The instant reached, s.
        time: f64,
        /// The limit.
        limit: usize,
    },
    /// The spherical equations of motion break down.
    #[error("the spherical equations of motion are singular {}, reached at t = {} s", place(*.at), NumberText(*.time))]
    Singularity {
        /// The instant reached, s.
        time: f64,
        /// The singularity that was reached.
        at: Singularity,
    },
    /// No step that advances the time meets the tolerance.
    #[error("the motion changes too fast to be integrated at t = {} s", NumberText(*.time))]
    TooStiff {
        /// The instant reached, s.
        time: f64,
    },
    /// A quantity of the flight is too large for a floating-point number.
    #[error("the loads at t = {} s are too large for a floating-point number", NumberText(*.time))]
    Overflow {
        /// The instant reached, s.
        time: f64,
    },
    /// On either side of a boundary the motion leads back across it.
    #[error(
        "{} switches back and forth from t = {} s on: the flight returns to one of its entries from both sides",
        name(*.switch), NumberText(*.time)
    )]
    Chatter {
        /// The instant reached, s.
        time: f64,
        /// The model that changes its formula.
        switch: Switch,
    },
    /// The thrust has burnt the vehicle up.
    #[error("the thrust has burnt the entire mass by t = {} s", NumberText(*.time))]
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
    /// A load limit throttles several engines of which one has a profile by time: the share of each in the propellant that is burnt is not known.
    #[error(
        "from t = {} s on a load limit throttles several engines, and the thrust of one changes by time: the propellant that each burns is not \
         known", NumberText(*.time)
    )]
    UnknownShares {
        /// The instant reached, s.
        time: f64,
    },
    /// The steps that the flight keeps have no room in memory.
    #[error("no memory for the steps after t = {} s", NumberText(*.time))]
    NoRoom {
        /// The instant reached, s.
        time: f64,
    },
    /// Whoever asked for the flight ended it.
    #[error("interrupted at t = {} s", NumberText(*.time))]
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
        Switch::Pitch => "the schedule of the pitch",
        Switch::Yaw => "the schedule of the yaw",
        Switch::LoadLimit => "the load limit",
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
    record(scenario, Kept::Steps, interrupt).map(|flown| Trajectory::new(scenario.shared_case(), flown))
}

/// Flies the scenario like [`simulate`], but keeps nothing of the flight except its start, its end, its events and its peaks.
///
/// # Errors
/// Those of [`simulate`].
pub fn extremes(scenario: &Scenario, interrupt: &dyn Interrupt) -> Result<Extremes, SimulationError> {
    record(scenario, Kept::Extremes, interrupt).map(|flown| Extremes::new(scenario.shared_case(), flown))
}

/// Flies the scenario like [`simulate`], but keeps nothing of the flight except its start, its end and its events.
///
/// # Errors
/// Those of [`simulate`], except that loads beyond all numbers go unnoticed.
pub fn ends(scenario: &Scenario, interrupt: &dyn Interrupt) -> Result<Ends, SimulationError> {
    record(scenario, Kept::Ends, interrupt).map(|flown| Ends::new(scenario.shared_case(), flown))
}

/// Flies the scenario like [`simulate`], but keeps nothing of the flight except its end, and, but for events, allocates no memory.
///
/// # Errors
/// Those of [`simulate`], except that loads beyond all numbers go unnoticed.
pub fn arrival(scenario: &Scenario, interrupt: &dyn Interrupt) -> Result<Arrival, SimulationError> {
    let case = scenario.case();
    dispatch(case.solver.equations, case.state_layout(), End { scenario, interrupt })
}

/// A flight of which the end alone is wanted.
struct End<'a> {
    scenario: &'a Scenario,
    interrupt: &'a dyn Interrupt,
}

impl ForFormulation for End<'_> {
    type Number = f64;
    type Output = Result<Arrival, SimulationError>;

    fn with<F: FormulationIn<f64, N>, const N: usize>(self) -> Self::Output
    where
        AnyStep: From<Step<N>>,
    {
        let motion = F::of_plain(self.scenario.case().forces());
        fly(&mut Flight::start(self.scenario, motion, self.interrupt)?, &mut |_| Ok(()))
    }
}

/// What is kept of a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kept {
    /// Its steps as well.
    Steps,
    /// Its start, its end, its events and its peaks alone.
    Extremes,
    /// The same without its peaks, for which those of its start stand.
    Ends,
}

fn record(scenario: &Scenario, kept: Kept, interrupt: &dyn Interrupt) -> Result<Flown, SimulationError> {
    let case = scenario.case();
    dispatch(case.solver.equations, case.state_layout(), Record { scenario, kept, interrupt })
}

/// A flight that is kept.
struct Record<'a> {
    scenario: &'a Scenario,
    kept: Kept,
    interrupt: &'a dyn Interrupt,
}

impl ForFormulation for Record<'_> {
    type Number = f64;
    type Output = Result<Flown, SimulationError>;

    fn with<F: FormulationIn<f64, N>, const N: usize>(self) -> Self::Output
    where
        AnyStep: From<Step<N>>,
    {
        let Self { scenario, kept, interrupt } = self;
        let mut flight = Flight::start(scenario, F::of_plain(scenario.case().forces()), interrupt)?;
        let mut recorder = Recorder::new(&flight, kept, interrupt)?;
        let arrival = fly(&mut flight, &mut |view| recorder.observe(view))?;
        recorder.finish(&mut flight, arrival)
    }
}

/// A step in which nothing happens.
struct QuietStep<'a> {
    forces: &'a Forces,
    /// The number of the phase to which it belongs.
    phase: usize,
    /// s.
    start_time: f64,
    /// s.
    end_time: f64,
    read: &'a EndReadings,
}

/// Keeps a flight.
struct Recorder<'a> {
    kept: Kept,
    interrupt: &'a dyn Interrupt,
    start: Instant,
    steps: Vec<StoredStep>,
    peak_tracker: PeakTracker,
}

impl<'a> Recorder<'a> {
    /// At the start of a flight.
    fn new<F: Formulation<N>, const N: usize>(
        flight: &Flight<F, N>,
        kept: Kept,
        interrupt: &'a dyn Interrupt,
    ) -> Result<Self, SimulationError> {
        let may_lift = flight.scenario.case().may_lift();
        Ok(Self {
            kept,
            interrupt,
            start: flight.instant(),
            steps: Vec::with_capacity(if kept == Kept::Steps { TYPICAL_STEPS } else { 0 }),
            peak_tracker: PeakTracker::new(&flight.motion, &flight.integrator, may_lift)?,
        })
    }

    /// Whether it takes the loads at the ends of steps.
    fn takes_loads(&self) -> bool {
        self.kept != Kept::Ends
    }

    /// Notes a step in which nothing happens, if that is all that it needs of it.
    fn observe_quietly(&mut self, step: &QuietStep) -> bool {
        match self.kept {
            Kept::Ends => true,
            Kept::Extremes => self.peak_tracker.observe_quietly(step),
            Kept::Steps => false,
        }
    }

    /// Notes a step.
    fn observe<F: Formulation<N>, const N: usize>(&mut self, view: &StepView<F, N>) -> Result<(), SimulationError>
    where
        AnyStep: From<Step<N>>,
    {
        let Self { kept, interrupt, steps, peak_tracker, .. } = self;
        if *kept == Kept::Ends {
            return Ok(());
        }
        peak_tracker.observe(view)?;
        if *kept == Kept::Extremes {
            return Ok(());
        }
        let mode = view.motion.forces().mode();
        steps.push(StoredStep { step: Step::clone(&view.step).into(), phase: view.phase, mode });
        let held = steps.capacity() * size_of::<StoredStep>();
        if steps.len() % STEPS_BETWEEN_LOOKS == 0 && !interrupt.may_hold(held) {
            return Err(SimulationError::NoRoom { time: view.step.end_time });
        }
        Ok(())
    }

    /// What is kept of the flight, which has ended.
    fn finish<F: Formulation<N>, const N: usize>(
        &mut self,
        flight: &mut Flight<F, N>,
        arrival: Arrival,
    ) -> Result<Flown, SimulationError> {
        let Self { kept, start, steps, peak_tracker, .. } = self;
        let end = flight.instant();
        if *kept != Kept::Ends {
            peak_tracker.end(flight.motion.forces(), &end)?;
        }
        let never_lifted = flight.is_held().then_some(Warning::NeverLifted { time: end.time });
        let PeakTracker { peaks_of_flight: peaks, peaks_of_phases, warnings, .. } = peak_tracker;
        let (steps, peaks_of_phases, mut warnings) = (take(steps), take(peaks_of_phases), take(warnings));
        let FlightLog { mut phases, event_records, separations, warnings: others } = take(&mut flight.log);
        phases.insert(0, Phase::first(flight.scenario.case()));
        warnings.extend(others);
        warnings.extend(never_lifted);
        Ok(Flown {
            start: *start,
            steps,
            phases,
            event_records,
            separations,
            end,
            arrival,
            peaks: *peaks,
            peaks_of_phases,
            warnings,
        })
    }
}

/// What looks at every step of a flight. Not a parameter: the code of flights is long, and is compiled once for each formulation.
type Observe<'a, F, const N: usize> = dyn FnMut(&StepView<F, N>) -> Result<(), SimulationError> + 'a;

/// Flies to the end and shows every step on the way.
fn fly<F: Formulation<N>, const N: usize>(
    flight: &mut Flight<F, N>,
    observe: &mut Observe<F, N>,
) -> Result<Arrival, SimulationError> {
    if let Some(arrival) = flight.begin()? {
        return Ok(arrival);
    }
    loop {
        let step = flight.advance()?;
        if let Some(arrival) = flight.pass(&step, None, observe)? {
            return Ok(arrival);
        }
    }
}

/// Steps for which room is made at once: more than most flights take.
const TYPICAL_STEPS: usize = 64;

/// Steps that are kept between two looks at what may be held: less than a megabyte.
const STEPS_BETWEEN_LOOKS: usize = 1024;
