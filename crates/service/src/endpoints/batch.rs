//! `POST /simulate/batch`: flies many cases, and gives each answer as soon as it is there.

use std::io;
use std::sync::atomic::AtomicBool;

use axum::body::{Body, Bytes};
use axum::extract::State;
use axum::http::header;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use futures_util::{StreamExt, stream};
use tokio::time::Instant;

use crate::answer;
use crate::error::ApiError;
use crate::extract::BatchPayload;
use crate::format::Format;
use crate::state::AppState;
use crate::wire::scenario::SimulateRequest;
use crate::wire::{batch, json};

/// Flies a list of cases.
///
/// Answers with a line of JSON for each case, in order, as soon as it is there: what `/simulate` answers or, where a case fails,
/// its problem document, whose pointers begin at the case. The other cases fly all the same. Cases for which the time allowed
/// for a batch does not suffice have a problem of status 504. An answer with fewer lines than cases has broken off.
#[utoipa::path(
    post,
    path = "/simulate/batch",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`ndjson`.")),
    request_body = Vec<SimulateRequest>,
    responses(
        (status = 200, description = "A line a case: a flight or a problem document.",
            content_type = "application/x-ndjson", body = String),
    ),
)]
pub async fn simulate_batch(
    State(app): State<AppState>,
    parts: Parts,
    BatchPayload(body): BatchPayload,
) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Ndjson])?;
    let cases = app.compute.run(move |_| cases(&body)).await?;
    let row_limit = app.config.row_limit;
    let fly = |case: Bytes| {
        move |interrupt: &AtomicBool| {
            let tree = json::parse(&case).map_err(ApiError::CaseNotJson)?;
            answer::simulate(tree, Format::Json, row_limit, interrupt)
        }
    };
    let jobs: Vec<_> = cases.into_iter().map(fly).collect();
    let mut left = jobs.len() - 1;
    let time = app.config.batch_deadline;
    let start = Instant::now();
    let mut results = app.compute.run_batch(jobs, time)?;
    // The status goes before the first line: until there is one, a batch runs out of time like any other request.
    let first = results.recv().await.ok_or(ApiError::Internal)?;
    if matches!(first, Err(ApiError::DeadlineExceeded { .. })) && start.elapsed() >= time {
        return first.map(IntoResponse::into_response);
    }
    let rest = stream::poll_fn(move |context| {
        results.poll_recv(context).map(|result| match result {
            Some(result) => {
                left -= 1;
                Some(Ok(line(result)))
            }
            None => (left > 0).then(|| Err(io::Error::other("the batch ended before its last case"))),
        })
    });
    let lines = stream::once(async { Ok(line(first)) }).chain(rest);
    Ok(([(header::CONTENT_TYPE, format.media_type())], Body::from_stream(lines)).into_response())
}

/// The text of each case: a case is parsed when its turn comes, as its tree is many times as large.
fn cases(body: &Bytes) -> Result<Vec<Bytes>, ApiError> {
    let cases = batch::cases(json::elements(body)?).map_err(ApiError::Invalid)?;
    Ok(cases.into_iter().map(|case| body.slice_ref(case.get().as_bytes())).collect())
}

fn line(result: Result<Vec<u8>, ApiError>) -> Bytes {
    let mut line = result.unwrap_or_else(|error| error.problem().to_json());
    line.push(b'\n');
    line.into()
}
