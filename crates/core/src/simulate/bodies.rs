//! The flights of the bodies that leave a vehicle, and of those that leave them.

use super::{SimulationError, simulate};
use crate::interrupt::Interrupt;
use crate::part::Part;
use crate::scenario::{BodyCase, Case, Scenario, Solver, Stop};
use crate::trajectory::{SeparationRecord, Trajectory};

/// A flight, and the flights of all that left the vehicle.
#[derive(Clone, Debug)]
pub struct Flights {
    /// Of the vehicle that remains.
    pub vehicle: Trajectory,
    /// Of the bodies, in the order of their separations; the clock of the vehicle is theirs.
    pub bodies: Vec<SeparatedBody>,
}

/// A body that left a vehicle or another body, and its flight.
#[derive(Clone, Debug)]
pub struct SeparatedBody {
    /// The place in the list of the body that it left; none where it left the vehicle.
    pub parent: Option<usize>,
    /// The place of the event of its parent that separated it.
    pub event: usize,
    /// The place of the separation in the effect of that event.
    pub separation: usize,
    /// When, s.
    pub time: f64,
    /// Its flight.
    pub trajectory: Trajectory,
}

impl Flights {
    /// A flight whose bodies are not flown.
    pub fn of_vehicle(vehicle: Trajectory) -> Self {
        Self { vehicle, bodies: Vec::new() }
    }

    /// All flights, that of the vehicle first.
    pub fn all(&self) -> impl Iterator<Item = &Trajectory> {
        std::iter::once(&self.vehicle).chain(self.bodies.iter().map(|body| &body.trajectory))
    }

    /// The places of event and separation of the body of a place in the list, after those of the bodies from which it comes.
    pub fn path(&self, body: usize) -> Vec<(usize, usize)> {
        path(&self.bodies, Some(body))
    }
}

/// Why a flight or that of a body could not be finished.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{error}")]
pub struct BodyError {
    /// The places of event and separation of the body, after those of the bodies from which it comes; empty for the vehicle itself.
    pub body: Vec<(usize, usize)>,
    /// What happened to it.
    pub error: SimulationError,
}

impl From<SimulationError> for BodyError {
    fn from(error: SimulationError) -> Self {
        Self { body: Vec::new(), error }
    }
}

/// Flies a scenario as [`simulate`] does, and then all bodies that leave the vehicle, and that leave them. The limit on the steps is that of
/// all flights together.
///
/// # Errors
/// Those of [`simulate`], of the first flight that has one.
pub fn simulate_with_bodies(scenario: &Scenario, interrupt: &dyn Interrupt) -> Result<Flights, BodyError> {
    let vehicle = simulate(scenario, interrupt)?;
    let mut held = vehicle.held();
    let limit = scenario.case().solver.step_limit;
    let mut left = limit.saturating_sub(taken(&vehicle));
    let mut waiting: Vec<(Option<usize>, SeparationRecord)> = separations(&vehicle, None).collect();
    let mut bodies: Vec<SeparatedBody> = Vec::new();
    // Whoever leaves first flies first: what leaves it does so later.
    while let Some(next) = first(&waiting) {
        let (parent, record) = waiting.remove(next);
        let parent_flight = parent.map_or(&vehicle, |parent| &bodies[parent].trajectory);
        let mut case = set_free(&parent_flight.case, &record);
        case.solver = Solver { step_limit: left, ..scenario.case().solver };
        let already = Already { held, interrupt };
        let of_body = |error| {
            // The limit is that of all.
            let error = match error {
                SimulationError::StepLimit { time, .. } => SimulationError::StepLimit { time, limit },
                other => other,
            };
            let mut body = path(&bodies, parent);
            body.push((record.event, record.place));
            BodyError { body, error }
        };
        let trajectory = simulate(&Scenario::unchecked(case), &already).map_err(of_body)?;
        held += trajectory.held();
        left = left.saturating_sub(taken(&trajectory));
        waiting.extend(separations(&trajectory, Some(bodies.len())));
        let SeparationRecord { event, place: separation, time, .. } = record;
        bodies.push(SeparatedBody { parent, event, separation, time, trajectory });
    }
    Ok(Flights { vehicle, bodies })
}

/// The steps that a flight took, accepted and rejected.
fn taken(flight: &Trajectory) -> usize {
    let statistics = flight.statistics();
    statistics.steps + statistics.rejected_steps
}

/// What left in a flight, whose body has this place.
fn separations(
    flight: &Trajectory,
    parent: Option<usize>,
) -> impl Iterator<Item = (Option<usize>, SeparationRecord)> + use<> {
    let records = flight.flown.separations.clone();
    records.into_iter().map(move |record| (parent, record))
}

/// The place of the first that left.
fn first(waiting: &[(Option<usize>, SeparationRecord)]) -> Option<usize> {
    let times = waiting.iter().map(|(_, record)| record.time).enumerate();
    times.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// The events and separations that led to the body of a place in the list; none to the vehicle.
fn path(bodies: &[SeparatedBody], mut body: Option<usize>) -> Vec<(usize, usize)> {
    let mut path = Vec::new();
    while let Some(SeparatedBody { parent, event, separation, .. }) = body.and_then(|place| bodies.get(place)) {
        path.push((*event, *separation));
        body = *parent;
    }
    path.reverse();
    path
}

/// The case of a body that is set free.
fn set_free(parent: &Case, record: &SeparationRecord) -> Case {
    let BodyCase { case, stop_time } = &parent.bodies[record.body];
    let mut case = case.clone();
    for (part, propellant) in case.parts.iter_mut().zip(&record.propellant) {
        part.propellant = propellant / f64::from(part.count);
    }
    case.vehicle = case.vehicle.with_mass(case.parts.iter().map(Part::mass).sum());
    let time = stop_time.unwrap_or(record.time + BodyCase::TIME);
    Case {
        start_time: record.time,
        initial_state: record.state,
        hold_down: false,
        origin: Some(*parent.track_start()),
        stop: Stop { time, ..case.stop.clone() },
        ..case
    }
}

/// Whoever asked for all flights, some of which are flown already.
#[derive(Debug)]
struct Already<'a> {
    /// What those hold, bytes.
    held: usize,
    interrupt: &'a dyn Interrupt,
}

impl Interrupt for Already<'_> {
    fn is_raised(&self) -> bool {
        self.interrupt.is_raised()
    }

    fn may_hold(&self, bytes: usize) -> bool {
        self.interrupt.may_hold(self.held.saturating_add(bytes))
    }
}
