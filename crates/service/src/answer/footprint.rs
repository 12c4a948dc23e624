//! A footprint: where flights with many values of some numbers land.

use std::time::Instant;

use reentry::Interrupt;
use reentry::sensitivity::Moment;
use reentry::solve::flight::Extent;
use reentry::solve::footprint::{Outcome, SurveyFlight, footprint as survey};
use serde_json::Value;

use super::search::{Flight, Flights};
use super::{Answer, HeldMemory, NUMBER, Work, Written};
use crate::error::ApiError;
use crate::format::Format;
use crate::wire::footprint::{FootprintRequest, FootprintResponse};

/// What a flight takes in memory, bytes, with its place in triangles and polygons, and in the answer.
const FLIGHT: usize = 512 + size_of::<SurveyFlight>() + 6 * NUMBER;

/// Surveys where flights land, until `until` at the latest; `interrupt` ends it early, wherever it is.
///
/// # Errors
/// When the request is not sound, or is interrupted.
pub fn footprint(
    tree: Value,
    format: Format,
    until: Option<Instant>,
    interrupt: &dyn Interrupt,
) -> Result<Answer, ApiError> {
    let mut asked = FootprintRequest::try_from_tree(tree).map_err(ApiError::Invalid)?;
    let mut held = HeldMemory::nothing(interrupt);
    held.reserve(FLIGHT * asked.options.flights)?;
    let mut flights = Flights::new(interrupt, until);
    let (numbers, options, shape) = (asked.numbers(), asked.options, asked.request.planet.core.shape);
    let near = downrange(&mut asked, &mut flights, interrupt)?;
    let mut fly = |values: &[Vec<f64>]| {
        let flown = flights.fly_all(0.0, &mut asked.case, values, asked.extent)?;
        let outcome = |flight: Flight| match flight {
            Some(flight) => asked.outcome(&flight.1, &flight.0, near, interrupt),
            None => Ok(Outcome { end: None, landing: None, margin: f64::NEG_INFINITY }),
        };
        Ok::<_, ApiError>(flown.into_iter().map(outcome).collect::<Result<_, _>>()?)
    };
    let found = survey(&numbers, &shape, options, &mut fly)?;
    let response = FootprintResponse::new(asked, &found, flights.so_far());
    let search = Some(if response.complete { "complete" } else { "coarse" });
    let mut out = Written::new(held);
    let written = match format {
        Format::Geojson => response.write_geojson(&mut out),
        _ => serde_json::to_writer(&mut out, &response),
    };
    Ok(Answer { body: out.whole(written)?, work: Work { search, ..flights.work() } })
}

/// The downrange of the case's own landing, m, with all its turns about the planet; 0 where it has none.
fn downrange(asked: &mut FootprintRequest, flights: &mut Flights, interrupt: &dyn Interrupt) -> Result<f64, ApiError> {
    let own: Vec<_> = asked.case.varied().iter().map(|number| number.start).collect();
    let flown = flights.fly_all(0.0, &mut asked.case, &[own], Extent::Whole)?.pop();
    let Some(flown) = flown.flatten() else { return Ok(0.0) };
    let end = flown.1.vehicle().point(Moment::End, &|_| None, interrupt)?;
    Ok(end.and_then(|point| point.downrange).unwrap_or_default())
}
