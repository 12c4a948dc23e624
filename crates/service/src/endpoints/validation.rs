//! `GET /validation`: the reference cases that are built into the program.

use axum::extract::State;
use axum::http::request::Parts;
use axum::response::Response;

use crate::answer::Answer;
use crate::compute::Task;
use crate::error::ApiError;
use crate::format::Format;
use crate::metrics::Work;
use crate::reply::reply;
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
    let run = |task: &Task| {
        let body = Validation::run(task)?.to_json().map_err(|_| ApiError::Internal)?;
        Ok(Answer { body, work: Work::default() })
    };
    reply(&app, "/validation", &parts, format.media_type(), run).await
}
