//! `GET /licences`: the licences of all that the program is made of.

use axum::extract::State;
use axum::http::request::Parts;
use axum::response::Response;

use crate::answer::Answer;
use crate::compute::Task;
use crate::error::ApiError;
use crate::format::Format;
use crate::licences::Licences;
use crate::metrics::Work;
use crate::reply::reply;
use crate::state::AppState;

/// Get the licences of the program and of everything in it.
///
/// The program itself, its data, what its pages load, and every library that is linked into it, each with the expression
/// of its licence and its texts. The default is a text to read.
#[utoipa::path(
    get,
    path = "/licences",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`text` (the default) or `json`; takes precedence over `Accept`.")),
    responses((status = 200, description = "All components with their licences.", content(
        (String = "text/plain"),
        (Licences = "application/json"),
    ))),
)]
pub async fn licences(State(app): State<AppState>, parts: Parts) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Text, Format::Json])?;
    let run = move |_: &Task| {
        let licences = Licences::of_program().map_err(|_| ApiError::Internal)?;
        let body = if format == Format::Json {
            licences.to_json().map_err(|_| ApiError::Internal)?
        } else {
            licences.to_text().into_bytes()
        };
        Ok(Answer { body, work: Work::default() })
    };
    reply(&app, "/licences", &parts, format.media_type(), run).await
}
