//! A target: numbers of a case with which a flight achieves what is wanted.

use std::time::Instant;

use reentry::Interrupt;
use reentry::solve::target::{Accuracy, Outcome, target as search_for};
use serde_json::Value;

use super::search::{Flight, Flights};
use super::{Answer, HeldMemory, Work, Written};
use crate::error::ApiError;
use crate::wire::target::{TargetRequest, TargetResponse};

/// Searches for numbers with which a flight achieves what is wanted, until `until` at the latest; `interrupt` ends it early, wherever it is.
///
/// # Errors
/// When the request is not sound, or is interrupted.
pub fn target(tree: Value, until: Option<Instant>, interrupt: &dyn Interrupt) -> Result<Answer, ApiError> {
    let mut asked = TargetRequest::try_from_tree(tree).map_err(ApiError::Invalid)?;
    let mut flights = Flights::new(interrupt, until);
    let (numbers, goals, options) = (asked.numbers(), asked.goals(), asked.options);
    let mut fly = |values: &[Vec<f64>], accuracy: Accuracy| {
        let case = if accuracy == Accuracy::Fine { &mut asked.fine } else { &mut asked.case };
        let flown = flights.fly_all(0.0, case, values, asked.extent)?;
        flown.into_iter().map(|flight| outcome(&asked, flight, interrupt)).collect()
    };
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
