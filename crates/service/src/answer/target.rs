//! A target: numbers of a case with which a flight achieves what is wanted.

use std::rc::Rc;
use std::time::Instant;

use reentry::Interrupt;
use reentry::simulate::SimulationError;
use reentry::solve::flight::Extent;
use reentry::solve::target::{Accuracy, Derivatives, Flights as FlightsOfTarget, Outcome, target as search_for};
use reentry::trajectory::Trajectory;
use serde_json::Value;

use super::search::{Flight, Flights};
use super::{Answer, HeldMemory, Work, Written, slopes_of};
use crate::error::ApiError;
use crate::wire::columns::AvailableQuantities;
use crate::wire::numbers::Varied;
use crate::wire::outputs::AvailableWhereMoved;
use crate::wire::requirements::WantedNumber;
use crate::wire::target::{TargetRequest, TargetResponse};

/// Searches for numbers with which a flight achieves what is wanted, until `until` at the latest; `interrupt` ends it early, wherever it is.
///
/// # Errors
/// When the request is not sound, or is interrupted.
pub fn target(tree: Value, until: Option<Instant>, interrupt: &dyn Interrupt) -> Result<Answer, ApiError> {
    let mut asked = TargetRequest::try_from_tree(tree).map_err(ApiError::Invalid)?;
    let mut flights = Flights::new(interrupt, until);
    let (numbers, goals, options) = (asked.numbers(), asked.goals(), asked.options);
    let mut fly = Flying { asked: &mut asked, flights: &mut flights, interrupt };
    let found = search_for(&numbers, &goals, options, &mut fly)?;
    let cost = std::cell::RefCell::new(flights);
    let summary = |case: &mut _, values: &[f64]| cost.borrow_mut().summary(case, values);
    let response = TargetResponse::new(asked, found, summary, || cost.borrow().so_far())?;
    let search = Some(response.outcome.word());
    let mut out = Written::new(HeldMemory::nothing(interrupt));
    let written = serde_json::to_writer(&mut out, &response);
    let work = cost.borrow().work();
    Ok(Answer { body: out.whole(written)?, work: Work { search, ..work } })
}

/// The flights of a target.
struct Flying<'a, 'b> {
    asked: &'a mut TargetRequest,
    flights: &'a mut Flights<'b>,
    interrupt: &'b dyn Interrupt,
}

/// Along the way, derivatives by so few numbers cost more than flights beside.
const FEW: usize = 2;

impl FlightsOfTarget<ApiError> for Flying<'_, '_> {
    fn fly(&mut self, values: &[Vec<f64>], accuracy: Accuracy) -> Result<Vec<Outcome>, ApiError> {
        let Self { asked, flights, interrupt } = self;
        let extent = asked.extent;
        let case = if accuracy == Accuracy::Fine { &mut asked.fine } else { &mut asked.case };
        let flown = flights.fly_all(0.0, case, values, extent)?;
        flown.into_iter().map(|flight| outcome(asked, flight, *interrupt)).collect()
    }

    fn derivatives(&mut self, values: &[f64], accuracy: Accuracy) -> Result<Option<Derivatives>, ApiError> {
        let Self { asked, flights, interrupt } = self;
        let is_fine = accuracy == Accuracy::Fine;
        if asked.extent == Extent::WithBodies || !is_fine && values.len() <= FEW {
            return Ok(None);
        }
        let case = if is_fine { &mut asked.fine } else { &mut asked.case };
        let variations = case.variations(values);
        let equations = &asked.equations;
        let found = flights.of_whole(case, values, |known, flight, limited| {
            flight.measure_ground_track(limited);
            derivatives_of(equations, variations, (known, flight), limited)
        })?;
        if interrupt.is_raised() { Err(ApiError::Interrupted) } else { Ok(found.flatten()) }
    }
}

/// The derivatives of the numbers of a flight by those that vary; none where a number has none.
fn derivatives_of(
    equations: &[(usize, WantedNumber)],
    varied: Vec<Option<Varied>>,
    (known, flight): (AvailableQuantities, &Trajectory),
    interrupt: &dyn Interrupt,
) -> Result<Option<Derivatives>, SimulationError> {
    let count = varied.len();
    let mut places = Vec::new();
    let (mut variations, mut moved) = (Vec::new(), Vec::new());
    for (place, varied) in varied.into_iter().enumerate() {
        let Some(Varied { variation, known }) = varied else { continue };
        places.push(place);
        variations.push(variation);
        moved.push(known);
    }
    let known = Rc::new(AvailableWhereMoved { flight: known, moved });
    let of_goals = equations.iter().map(|(_, number)| number.outputs(flight, &known));
    let Some(outputs) = of_goals.collect::<Option<Vec<_>>>() else { return Ok(None) };
    let outputs: Vec<_> = outputs.into_iter().flatten().collect();
    let slopes = slopes_of(flight, &variations, &outputs, interrupt)?;
    let row = |of_goal: usize| {
        let mut row = vec![f64::NAN; count];
        for (place, slope) in places.iter().zip(&slopes[of_goal].slopes) {
            row[*place] = *slope;
        }
        row
    };
    let rows = |first: usize| (first..slopes.len()).step_by(2).map(row).collect();
    Ok(Some(Derivatives { shown: rows(0), searched: rows(1) }))
}

/// What a flight gives.
fn outcome(asked: &TargetRequest, flight: Flight, interrupt: &dyn Interrupt) -> Result<Outcome, ApiError> {
    let Some(flight) = flight else {
        let none = vec![None; asked.equations.len()];
        return Ok(Outcome { end: None, counts: false, searched: none.clone(), shown: none });
    };
    let (known, flown) = *flight;
    let mut outcome = Outcome {
        end: Some(flown.vehicle().termination()),
        counts: asked.counts(&flown),
        searched: Vec::with_capacity(asked.equations.len()),
        shown: Vec::with_capacity(asked.equations.len()),
    };
    for (_, number) in &asked.equations {
        let reading = number.reading(&flown, &known, interrupt)?;
        outcome.searched.push(reading.searched);
        outcome.shown.push(reading.shown);
    }
    Ok(outcome)
}
