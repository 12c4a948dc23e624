//! `POST /corridor`: finds the values of a number with which flights keep limits.

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
use crate::wire::corridor::CorridorResponse;
use crate::wire::schema::names::CorridorRequest;

/// Find the entry corridor of a case.
///
/// Varies one number of the case within a range and returns the bands of values with which flights keep all limits: an
/// entry corridor between overshoot and undershoot, for example. Each limit may be flown `with` other numbers, as the
/// steep end of a corridor is flown with the lift up and its shallow end with the lift down. The ends of the bands are
/// located to `resolution`; several bands are possible.
#[utoipa::path(
    post,
    path = "/corridor",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json`.")),
    request_body = CorridorRequest,
    responses((status = 200, description = "Bands, gaps and samples.", body = CorridorResponse)),
)]
pub async fn corridor(State(app): State<AppState>, parts: Parts, body: Payload) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Json])?;
    let run = move |task: &Task| answer::corridor(body.json(task)?, task);
    reply(&app, "/corridor", &parts, format.media_type(), run).await
}
