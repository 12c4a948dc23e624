//! From the tree of a request to the bytes of its answer: what the endpoints and the command line have in common.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use reentry::sensitivity::sensitivities;
use reentry::simulate::{SimulationError, simulate as fly};
use reentry::trajectory::{FlightPoint, Trajectory};
use reentry::verification::verify;
use serde_json::Value;

use crate::error::ApiError;
use crate::format::Format;
use crate::wire::analytic::{AnalyticJob, AnalyticResponse};
use crate::wire::convert::ConvertResponse;
use crate::wire::scenario::{Job, Wanted};
use crate::wire::sensitivities::Sensitivities;
use crate::wire::track::Track;
use crate::wire::trajectory::{Extras, SimulateResponse};
use crate::wire::verification::Verification;

/// Flies a case; `interrupt` ends the flight early.
///
/// # Errors
/// When the case is not sound, asks for more than `row_limit` rows, or cannot be flown to its end.
pub fn simulate(tree: Value, format: Format, row_limit: usize, interrupt: &AtomicBool) -> Result<Vec<u8>, ApiError> {
    let job = Job::try_from_tree(tree, wanted(format)).map_err(ApiError::Invalid)?;
    let start = Instant::now();
    let flight = fly(&job.scenario, interrupt)?;
    let elapsed = start.elapsed().as_secs_f64();
    let points = rows(&job, &flight, row_limit)?;
    let extras = extras(&job, &flight, interrupt)?;
    let response = SimulateResponse::new(job, &flight, points, extras, elapsed);
    let track = |rows| Track::new(&response, rows, &flight).map_err(|fault| ApiError::Invalid(vec![fault]));
    Ok(match (format, &response.trajectory) {
        (Format::Csv, Some(rows)) => rows.to_csv()?,
        (Format::Geojson, Some(rows)) => track(rows)?.to_geojson()?,
        (Format::Kml, Some(rows)) => track(rows)?.to_kml()?,
        (Format::Czml, Some(rows)) => track(rows)?.to_czml()?,
        _ => serde_json::to_vec(&response)?,
    })
}

fn wanted(format: Format) -> Wanted {
    match format {
        Format::Json | Format::Ndjson => Wanted::Answer,
        Format::Csv => Wanted::Rows,
        Format::Geojson | Format::Kml | Format::Czml => Wanted::Map,
    }
}

/// What a job asks for beyond the flight.
fn extras(job: &Job, flight: &Trajectory, interrupt: &AtomicBool) -> Result<Extras, SimulationError> {
    let request = &job.request;
    let mut extras = Extras::default();
    if request.sensitivities {
        let core = sensitivities(flight, interrupt)?;
        extras.sensitivities = Some(Sensitivities::from_core(&core, request.angle_unit));
    }
    if request.verify {
        match verify(&job.scenario, flight, interrupt) {
            Ok(core) => {
                let has_thrust = request.events.iter().any(|event| event.then.thrust.is_some());
                extras.verification = Some(Verification::from_core(core, has_thrust));
            }
            Err(error @ SimulationError::Interrupted { .. }) => return Err(error),
            Err(error) => extras.unverified = Some(error),
        }
    }
    Ok(extras)
}

/// The rows for which a job asks.
fn rows(job: &Job, flight: &Trajectory, limit: usize) -> Result<Option<Vec<FlightPoint>>, ApiError> {
    let Some((sampling, pointer)) = &job.sampling else { return Ok(None) };
    let instants = flight.instants(sampling, limit).map_err(|_| ApiError::TooManyRows { limit, pointer })?;
    let points = flight.points(&instants);
    match points.iter().find(|point| !point.is_finite()) {
        Some(point) => Err(SimulationError::Overflow { time: point.time }.into()),
        None => Ok(Some(points)),
    }
}

/// Writes a state in every coordinate system.
///
/// # Errors
/// When the state is not sound.
pub fn convert(tree: Value) -> Result<Vec<u8>, ApiError> {
    Ok(serde_json::to_vec(&ConvertResponse::try_from_tree(tree).map_err(ApiError::Invalid)?)?)
}

/// Sets a theory beside a flight; `interrupt` ends the flight early.
///
/// # Errors
/// When the case is not sound, the theory does not apply, and as [`simulate`] otherwise.
pub fn analytic(tree: Value, format: Format, row_limit: usize, interrupt: &AtomicBool) -> Result<Vec<u8>, ApiError> {
    let analytic = AnalyticJob::try_from_tree(tree, wanted(format)).map_err(ApiError::Invalid)?;
    let flight = fly(&analytic.job.scenario, interrupt)?;
    let points = rows(&analytic.job, &flight, row_limit)?.unwrap_or_default();
    let extras = extras(&analytic.job, &flight, interrupt)?;
    let comparison = analytic.theory.compare(&flight, &points, interrupt)?;
    let response = AnalyticResponse::new(analytic, &flight, &points, comparison, extras);
    Ok(if format == Format::Csv { response.to_csv()? } else { serde_json::to_vec(&response)? })
}
