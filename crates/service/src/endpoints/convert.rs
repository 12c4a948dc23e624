//! `POST /convert`: a state in every coordinate system.

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
use crate::wire::convert::ConvertResponse;
use crate::wire::schema::names::ConvertRequest;

/// Convert a state to all coordinate systems.
///
/// Each representation in the response is a complete `initial_state`.
#[utoipa::path(
    post,
    path = "/convert",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json`.")),
    request_body = ConvertRequest,
    responses((status = 200, description = "State in all coordinate systems.", body = ConvertResponse)),
)]
pub async fn convert(State(app): State<AppState>, parts: Parts, body: Payload) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Json])?;
    let run = move |task: &Task| answer::convert(body.json(task)?, task);
    reply(&app, "/convert", &parts, format.media_type(), run).await
}
