//! `POST /analytic`: sets a theory beside a flight.

use axum::extract::State;
use axum::http::request::Parts;
use axum::response::Response;

use crate::answer;
use crate::compute::Task;
use crate::error::ApiError;
use crate::extract::Payload;
use crate::format::Format;
use crate::reply::reply;
use crate::state::AppState;
use crate::wire::analytic::AnalyticResponse;
use crate::wire::schema::names::AnalyticRequest;

/// Compare a closed-form theory of entry with the simulated flight.
///
/// Simulates the case as `/simulate` does and predicts speed, flight-path angle and drag deceleration at its rows, in
/// time order, with the theory `solution`. The theories assume a planet that does not rotate and a bank angle of 0. A
/// value that the theory does not give is null. `text/csv` has one line per row: time, altitude, then the `simulated_`
/// and `predicted_` value of each quantity; null is an empty cell.
#[utoipa::path(
    post,
    path = "/analytic",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json` or `csv`; takes precedence over `Accept`.")),
    request_body = AnalyticRequest,
    responses(
        (status = 200, description = "Comparison of the theory with the flight.", content(
            (AnalyticResponse = "application/json"),
            (String = "text/csv"),
        )),
    ),
)]
pub async fn analytic(State(app): State<AppState>, parts: Parts, body: Payload) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &Format::OF_THEORIES)?;
    let row_limit = app.config.row_limit;
    let run = move |task: &Task| answer::analytic(body.json(task)?, format, row_limit, task);
    reply(&app, "/analytic", &parts, format.media_type(), run).await
}
