//! The flights of a search: flown, and counted.

use std::time::Instant;

use reentry::Interrupt;
use reentry::integrate::Statistics;
use reentry::scenario::Scenario;
use reentry::simulate::{BodyError, SimulationError, simulate};
use reentry::solve::flight::{Extent, SearchFlight};
use reentry::trajectory::Trajectory;

use super::Work;
use crate::error::ApiError;
use crate::wire::columns::AvailableQuantities;
use crate::wire::search::{FailedFlights, FlightSummary, FlightsOfSearch};
use crate::wire::vary::MovingCase;

/// What became of a flight: it is finished, and so much is known of it; none where it is of no sound case, or cannot be finished.
pub(super) type Flight = Option<Box<(AvailableQuantities, SearchFlight)>>;

/// So many flights are read and flown at once: enough for lanes, and few enough to be held.
const TOGETHER: usize = 96;

/// Whoever asked for a search that must come to its end in time.
#[derive(Debug)]
struct Limited<'a> {
    interrupt: &'a dyn Interrupt,
    until: Option<Instant>,
}

impl Interrupt for Limited<'_> {
    fn is_raised(&self) -> bool {
        self.interrupt.is_raised() || self.until.is_some_and(|until| Instant::now() >= until)
    }

    fn may_hold(&self, bytes: usize) -> bool {
        self.interrupt.may_hold(bytes)
    }
}

/// The flights of a search so far.
pub(super) struct Flights<'a> {
    interrupt: &'a dyn Interrupt,
    /// When it must come to its end.
    until: Option<Instant>,
    start: Instant,
    count: u64,
    failed: Vec<FailedFlights>,
    work: Work,
}

impl<'a> Flights<'a> {
    pub(super) fn new(interrupt: &'a dyn Interrupt, until: Option<Instant>) -> Self {
        Self { interrupt, until, start: Instant::now(), count: 0, failed: Vec::new(), work: Work::default() }
    }

    /// Flies a case with all of several numbers set, one after the other, at a tolerance, or at that of the case where that is coarser. Gives fewer
    /// flights where the search must come to its end.
    ///
    /// # Errors
    /// When the flag is raised, or there is no memory.
    pub(super) fn fly_all(
        &mut self,
        relative_tolerance: f64,
        case: &mut MovingCase,
        values: &[Vec<f64>],
        extent: Extent,
    ) -> Result<Vec<Flight>, ApiError> {
        let mut flights = Vec::with_capacity(values.len());
        for together in values.chunks(TOGETHER) {
            let mut scenarios = Vec::with_capacity(together.len());
            let mut known = Vec::with_capacity(together.len());
            for values in together {
                self.begin();
                let (of_flight, scenario) = case.scenario(values).unzip();
                known.push(of_flight);
                scenarios.extend(scenario.map(|scenario: Scenario| scenario.no_finer_than(relative_tolerance)));
            }
            let limited = Limited { interrupt: self.interrupt, until: self.until };
            let mut flown = SearchFlight::fly_all(&scenarios, extent, &limited).into_iter();
            for known in known {
                let Some(known) = known else {
                    self.fail(ApiError::Invalid(Vec::new()).problem().kind);
                    flights.push(None);
                    continue;
                };
                // Of every sound case there is one.
                let Some(flown) = flown.next() else { return Ok(flights) };
                match flown {
                    Ok(flown) => {
                        self.took(flown.statistics());
                        flights.push(Some(Box::new((known, flown))));
                    }
                    Err(BodyError { error: SimulationError::Interrupted { .. }, .. })
                        if !self.interrupt.is_raised() =>
                    {
                        return Ok(flights);
                    }
                    Err(error) => {
                        self.failed(error)?;
                        flights.push(None);
                    }
                }
            }
        }
        Ok(flights)
    }

    /// Flies a case with its numbers set, whole, and takes of it what is wanted; none where it is no sound case, cannot be finished or held, or the
    /// search must come to its end.
    ///
    /// # Errors
    /// When the flag is raised.
    pub(super) fn of_whole<T>(
        &mut self,
        case: &mut MovingCase,
        values: &[f64],
        wanted: impl FnOnce(AvailableQuantities, &Trajectory, &dyn Interrupt) -> Result<T, SimulationError>,
    ) -> Result<Option<T>, ApiError> {
        self.begin();
        let Some((known, scenario)) = case.scenario(values) else { return Ok(None) };
        let limited = Limited { interrupt: self.interrupt, until: self.until };
        let flown = simulate(&scenario, &limited);
        if let Ok(flight) = &flown {
            self.took(flight.statistics());
        }
        let found = flown.and_then(|flight| wanted(known, &flight, &limited));
        if self.interrupt.is_raised() { Err(ApiError::Interrupted) } else { Ok(found.ok()) }
    }

    /// Counts a flight.
    fn begin(&mut self) {
        self.count += 1;
        self.interrupt.begins_flight(self.count);
    }

    /// Counts a flight that failed.
    ///
    /// # Errors
    /// When that is not for a reason of its own.
    fn failed(&mut self, error: BodyError) -> Result<(), ApiError> {
        match error.error {
            SimulationError::Interrupted { .. } | SimulationError::NoRoom { .. } => Err(error.into()),
            _ => {
                self.fail(ApiError::from(error).problem().kind);
                Ok(())
            }
        }
    }

    /// Flies a case with its numbers set, whatever the time, and tells of its flight; none where that is no sound case, or the flight cannot be
    /// finished.
    ///
    /// # Errors
    /// When the flag is raised, or there is no memory.
    pub(super) fn summary(&mut self, case: &mut MovingCase, values: &[f64]) -> Result<Option<FlightSummary>, ApiError> {
        self.begin();
        let Ok((request, scenario)) = case.read(values) else {
            self.fail(ApiError::Invalid(Vec::new()).problem().kind);
            return Ok(None);
        };
        let flight = match simulate(&scenario, self.interrupt) {
            Ok(flight) => flight,
            Err(error) => return self.failed(error.into()).map(|()| None),
        };
        if !flight.measure_ground_track(self.interrupt) {
            return Err(ApiError::Interrupted);
        }
        self.took(flight.statistics());
        Ok(Some(FlightSummary::new(&request, &flight)))
    }

    fn took(&mut self, Statistics { steps, rejected_steps, evaluations }: Statistics) {
        self.work.flights += 1;
        self.work.steps += steps as u64;
        self.work.rejected_steps += rejected_steps as u64;
        self.work.evaluations += evaluations as u64;
    }

    fn fail(&mut self, kind: &'static str) {
        match self.failed.iter_mut().find(|failed| failed.kind == kind) {
            Some(failed) => failed.count += 1,
            None => self.failed.push(FailedFlights { kind, count: 1 }),
        }
    }

    /// What the search has taken so far.
    pub(super) fn so_far(&self) -> FlightsOfSearch {
        FlightsOfSearch {
            flights: self.count,
            failed: self.failed.clone(),
            elapsed: self.start.elapsed().as_secs_f64(),
        }
    }

    /// What the flights cost.
    pub(super) fn work(&self) -> Work {
        self.work
    }
}
