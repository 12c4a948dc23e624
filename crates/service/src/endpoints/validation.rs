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

/// Run the built-in reference cases and compare the results with expected values.
///
/// The cases run as requests to `/simulate`, `/analytic` and `/convert` do. A check of kind `reference` fails if its
/// difference exceeds the allowed one; that is a defect of the program. A check of kind `plausibility` compares with a
/// real flight, which published data do not determine fully: its difference is reported with the published uncertainty
/// and never fails.
#[utoipa::path(
    get,
    path = "/validation",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json`.")),
    responses((status = 200, description = "All checks, and whether they passed.", body = Validation)),
)]
pub async fn validation(State(app): State<AppState>, parts: Parts) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Json])?;
    let run = |task: &Task| {
        let body = Validation::run(task)?.to_json().map_err(|_| ApiError::Internal)?;
        Ok(Answer { body, work: Work::default() })
    };
    reply(&app, "/validation", &parts, format.media_type(), run).await
}
