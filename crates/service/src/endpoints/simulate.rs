//! `POST /simulate`: flies a case.

use std::time::Instant;

use axum::extract::State;
use axum::http::header;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use reentry::simulate::SimulationError;

use crate::error::ApiError;
use crate::extract::Payload;
use crate::format::Format;
use crate::state::AppState;
use crate::wire::json;
use crate::wire::scenario::{Job, SimulateRequest, Wanted};
use crate::wire::trajectory::SimulateResponse;

/// Flies a case.
///
/// Integrates the motion of a point mass from its initial state until it crosses the stop altitude downwards or the stop time
/// is reached, and answers with the initial and final state, the peaks and the trajectory.
/// `text/csv` has the trajectory alone: a header of the names, and a line an instant.
#[utoipa::path(
    post,
    path = "/simulate",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json` or `csv`; wins over `Accept`.")),
    request_body = SimulateRequest,
    responses(
        (status = 200, description = "The flight.", content(
            (SimulateResponse = "application/json"),
            (String = "text/csv"),
        )),
    ),
)]
pub async fn simulate(State(app): State<AppState>, parts: Parts, Payload(body): Payload) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Json, Format::Csv])?;
    let wanted = if format == Format::Csv { Wanted::Rows } else { Wanted::Answer };
    let row_limit = app.config.row_limit;
    let body = app
        .compute
        .run(move |interrupt| {
            let job = Job::try_from_tree(json::parse(&body)?, wanted).map_err(ApiError::Invalid)?;
            let start = Instant::now();
            let flight = reentry::simulate::simulate(&job.scenario, interrupt)?;
            let elapsed = start.elapsed().as_secs_f64();
            let points = match &job.sampling {
                Some((sampling, pointer)) => {
                    let too_many = |_| ApiError::TooManyRows { limit: row_limit, pointer };
                    let instants = flight.instants(sampling, row_limit).map_err(too_many)?;
                    let points = flight.points(&instants);
                    if let Some(point) = points.iter().find(|point| !point.is_finite()) {
                        return Err(SimulationError::Overflow { time: point.time }.into());
                    }
                    Some(points)
                }
                None => None,
            };
            let response = SimulateResponse::new(job, &flight, points, elapsed);
            Ok(match (format, &response.trajectory) {
                (Format::Csv, Some(trajectory)) => trajectory.to_csv()?,
                _ => serde_json::to_vec(&response)?,
            })
        })
        .await?;
    Ok(([(header::CONTENT_TYPE, format.media_type())], body).into_response())
}
