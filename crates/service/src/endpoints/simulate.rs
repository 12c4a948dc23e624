//! `POST /simulate`: flies a case.

use std::sync::atomic::AtomicBool;

use axum::extract::State;
use axum::http::header;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};

use crate::answer;
use crate::error::ApiError;
use crate::extract::Payload;
use crate::format::Format;
use crate::state::AppState;
use crate::wire::json;
use crate::wire::scenario::SimulateRequest;
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
    let row_limit = app.config.row_limit;
    let run = move |interrupt: &AtomicBool| answer::simulate(json::parse(&body)?, format, row_limit, interrupt);
    let body = app.compute.run(run).await?;
    Ok(([(header::CONTENT_TYPE, format.media_type())], body).into_response())
}
