//! A corridor: flights with many values of a number.

use reentry::Interrupt;
use reentry::solve::corridor::{Asked, Corridor, Edge, Sample, corridor as divide};
use reentry::solve::flight::SearchFlight;
use serde_json::Value;

use super::search::Flights;
use super::{Answer, HeldMemory, Work, Written};
use crate::error::ApiError;
use crate::wire::columns::AvailableQuantities;
use crate::wire::corridor::{CorridorFlight, CorridorRequest, CorridorResponse, Limit, LimitGroup};

/// Finds the values of a number with which flights keep limits; `interrupt` ends it early, wherever it is.
///
/// # Errors
/// When the request is not sound, or is interrupted.
pub fn corridor(tree: Value, interrupt: &dyn Interrupt) -> Result<Answer, ApiError> {
    let mut asked = CorridorRequest::try_from_tree(tree).map_err(ApiError::Invalid)?;
    let mut flights = Flights::new(interrupt, None);
    let (between, resolution, limits) = (asked.varied.between, asked.resolution, asked.limits);
    let groups = &mut asked.groups;
    let judge = |values: &[f64], asked: Asked| judge(groups, (values, asked), limits, &mut flights, interrupt);
    let found: Corridor = divide(between, resolution, judge)?;
    let mut flights_of = |edge: &Edge| {
        let mut flight = |group: &mut LimitGroup| {
            let limits = group.limits.iter().map(|(index, _)| *index).collect();
            let summary = flights.summary(&mut group.case, &[edge.value])?;
            Ok(summary.map(|flight| CorridorFlight { limits, flight }))
        };
        asked.groups.iter_mut().filter_map(|group| flight(group).transpose()).collect::<Result<Vec<_>, ApiError>>()
    };
    let mut ends = Vec::with_capacity(found.bands.len());
    for band in &found.bands {
        ends.push([flights_of(&band.from)?, flights_of(&band.to)?]);
    }
    let response = CorridorResponse::new(asked, found, ends, flights.so_far());
    let search = Some(if response.bands.is_empty() { "no_band" } else { "band" });
    let mut out = Written::new(HeldMemory::nothing(interrupt));
    let written = serde_json::to_writer(&mut out, &response);
    Ok(Answer { body: out.whole(written)?, work: Work { search, ..flights.work() } })
}

/// The tolerance of flights that are drawn: their numbers have five digits.
const SAMPLE_TOLERANCE: f64 = 1e-6;

/// Flies all of several values, each once for every group of limits of which one is asked for.
fn judge(
    groups: &mut [LimitGroup],
    (values, asked): (&[f64], Asked),
    limits: usize,
    flights: &mut Flights,
    interrupt: &dyn Interrupt,
) -> Result<Vec<Sample>, ApiError> {
    let unjudged = |value: &f64| Sample {
        value: *value,
        numbers: vec![None; limits],
        margins: vec![None; limits],
        ends: Vec::new(),
    };
    let mut samples: Vec<_> = values.iter().map(unjudged).collect();
    let values: Vec<_> = values.iter().map(|value| vec![*value]).collect();
    let tolerance = if asked == Asked::Roughly { SAMPLE_TOLERANCE } else { 0.0 };
    for LimitGroup { case, extent, limits } in groups {
        if !limits.iter().any(|(limit, _)| asked.has(*limit)) {
            for sample in &mut samples {
                for (limit, _) in &*limits {
                    sample.margins[*limit] = Sample::NOT_ASKED;
                }
            }
            continue;
        }
        let flown = flights.fly_all(tolerance, case, &values, *extent)?;
        for (sample, flight) in samples.iter_mut().zip(flown) {
            sample.ends.push(flight.as_ref().map(|flight| flight.1.vehicle().termination()));
            let Some(flight) = flight else { continue };
            judge_limits(sample, limits, &flight, interrupt)?;
        }
    }
    Ok(samples)
}

/// Adds what a flight says of limits.
fn judge_limits(
    sample: &mut Sample,
    limits: &[(usize, Limit)],
    (known, flown): &(AvailableQuantities, SearchFlight),
    interrupt: &dyn Interrupt,
) -> Result<(), ApiError> {
    for (index, limit) in limits {
        match limit {
            Limit::Ends(end) => {
                sample.margins[*index] = Some(if end.is_met(flown) { 1.0 } else { -1.0 });
            }
            Limit::Number(number) => {
                let reading = number.reading(flown, known, interrupt)?;
                sample.numbers[*index] = reading.shown;
                sample.margins[*index] = reading.searched.map(|value| number.searched().margin(value));
            }
        }
    }
    Ok(())
}
