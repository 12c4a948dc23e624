//! `POST /target`: finds numbers of a case with which its flight achieves goals.

use std::time::Instant;

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
use crate::wire::schema::names::TargetRequest;
use crate::wire::target::TargetResponse;

/// Find numbers of a case with which its flight achieves goals.
///
/// Varies numbers of the case within ranges until a flight achieves everything in `achieve`: a landing site, a final
/// speed, a load below a limit. All distinct solutions that were found are returned, each with the case to send to
/// `/simulate`. If the goals are out of reach, the response is 200 too: `nearest` has what comes nearest and why. The
/// same request gives the same answer, unless it ends for lack of time.
#[utoipa::path(
    post,
    path = "/target",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json`.")),
    request_body = TargetRequest,
    responses((status = 200, description = "Solutions, or what comes nearest.", body = TargetResponse)),
)]
pub async fn target(State(app): State<AppState>, parts: Parts, body: Payload) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Json])?;
    let until = Instant::now() + app.config.deadline.mul_f64(SHARE_OF_SEARCH);
    let run = move |task: &Task| answer::target(body.json(task)?, Some(until), task);
    reply(&app, "/target", &parts, format.media_type(), run).await
}

/// The part of the time of a request that a search may take: what it has found is told in the rest.
pub const SHARE_OF_SEARCH: f64 = 0.8;
