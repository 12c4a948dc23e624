//! `GET /validation`: the reference cases that are built into the program.

use axum::extract::State;
use axum::http::header;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};

use crate::error::ApiError;
use crate::format::Format;
use crate::state::AppState;
use crate::validation::Validation;

/// Flies every reference case, and answers what is expected and what comes out.
///
/// The cases are built into the program and go the way of `/simulate`, `/analytic` and `/convert`. A check of the kind `reference` that
/// differs by more than is allowed is a fault of the program; a `plausibility`, an entry that was flown, depends on more than was
/// published of it, and its difference is told beside the published uncertainty.
#[utoipa::path(
    get,
    path = "/validation",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json`.")),
    responses((status = 200, description = "Every check; whether all passed.", body = Validation)),
)]
pub async fn validation(State(app): State<AppState>, parts: Parts) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Json])?;
    let body = app.compute.run(|interrupt| Validation::run(interrupt)?.to_json()).await?;
    Ok(([(header::CONTENT_TYPE, format.media_type())], body).into_response())
}
