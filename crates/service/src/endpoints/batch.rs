//! `POST /simulate/batch`: flies many cases, and gives each answer as soon as it is there.

use std::io;

use axum::body::{Body, Bytes};
use axum::extract::State;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use futures_util::{Stream, stream};
use tokio::sync::mpsc;
use tokio::time::Instant;

use crate::answer::{self, Answer};
use crate::client::Client;
use crate::compute::Task;
use crate::error::ApiError;
use crate::extract::{BatchPayload, hold_tree};
use crate::format::Format;
use crate::reply::{self, Lines};
use crate::state::AppState;
use crate::wire::batch::{self, MOST_CASES};
use crate::wire::json;
use crate::wire::schema::names::SimulateRequest;

/// Simulate a list of cases.
///
/// Returns one line of JSON per case, in order, as soon as it is available: the response of `/simulate` or, if the case
/// fails, its problem document, whose pointers start at the case. The other cases still run. Cases that do not fit into
/// the time limit of a batch get a problem with status 504. A response with fewer lines than cases is incomplete.
#[utoipa::path(
    post,
    path = "/simulate/batch",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`ndjson`.")),
    request_body = Vec<SimulateRequest>,
    responses(
        (status = 200, description = "One line per case: a flight or a problem document.",
            content_type = "application/x-ndjson", body = String),
    ),
)]
pub async fn simulate_batch(
    State(app): State<AppState>,
    parts: Parts,
    BatchPayload(body): BatchPayload,
) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Ndjson])?;
    let coding = reply::coding(&parts.headers);
    let client = Client::of(&parts.extensions);
    let cases = app.compute.run(ROUTE, client, move |task| cases(&body.text(task)?)).await?;
    let fly = |case: Bytes| {
        let app = app.clone();
        move |task: &Task| fly(&app, &case, task)
    };
    let jobs: Vec<_> = cases.into_iter().map(fly).collect();
    let left = jobs.len() - 1;
    let time = app.config.batch_deadline;
    let start = Instant::now();
    let mut results = app.compute.run_batch(ROUTE, client, jobs, time)?;
    // The status goes before the first line: until there is one, a batch runs out of time like any other request.
    let first = results.recv().await.ok_or(ApiError::Internal)?;
    if matches!(first, Err(ApiError::DeadlineExceeded { .. })) && start.elapsed() >= time {
        return first.map(IntoResponse::into_response);
    }
    let lines = Lines::new(coding)?;
    let batch = Batch { app, client, results, first: Some(first), left };
    Ok(reply::response(format.media_type(), coding, Body::from_stream(batch.coded(lines))))
}

const ROUTE: &str = "/simulate/batch";

fn fly(app: &AppState, case: &[u8], task: &Task) -> Result<Bytes, ApiError> {
    hold_tree(case, task)?;
    let tree = json::parse(case).map_err(ApiError::CaseNotJson)?;
    let Answer { body, work } = answer::simulate(tree, Format::Json, app.config.row_limit, task)?;
    app.metrics.flown(ROUTE, work);
    Ok(task.keep(with_line_end(body)))
}

fn with_line_end(mut line: Vec<u8>) -> Vec<u8> {
    line.push(b'\n');
    line
}

/// A batch whose answer is being sent.
struct Batch {
    app: AppState,
    client: Client,
    results: mpsc::Receiver<Result<Bytes, ApiError>>,
    /// The first result, until it has been taken.
    first: Option<Result<Bytes, ApiError>>,
    /// Cases after that.
    left: usize,
}

impl Batch {
    /// The line of the next case; none after the last.
    async fn next(&mut self) -> io::Result<Option<Bytes>> {
        let result = match self.first.take() {
            Some(first) => first,
            None if self.left == 0 => return Ok(None),
            None => {
                self.left -= 1;
                let ended = || io::Error::other("the batch ended before its last case");
                self.results.recv().await.ok_or_else(ended)?
            }
        };
        self.app.metrics.case_over(result.as_ref().map_or_else(ApiError::outcome, |_| "ok"));
        Ok(Some(result.unwrap_or_else(|error| with_line_end(error.problem().to_json()).into())))
    }

    /// The lines, coded.
    fn coded(self, lines: Lines) -> impl Stream<Item = io::Result<Bytes>> {
        stream::try_unfold(Some((self, lines)), async |state| {
            let Some((mut batch, lines)) = state else { return Ok(None) };
            match batch.next().await? {
                Some(line) => {
                    let (lines, line) =
                        lines.next(&batch.app, ROUTE, batch.client, line).await.map_err(io::Error::other)?;
                    Ok(Some((line, Some((batch, lines)))))
                }
                None => Ok(Some((lines.end().map_err(io::Error::other)?, None))),
            }
        })
    }
}

/// The text of each case: a case is parsed when its turn comes, as its tree is many times as large.
fn cases(body: &Bytes) -> Result<Vec<Bytes>, ApiError> {
    // Before there is memory for each.
    let count = json::count(body);
    if count > MOST_CASES {
        return Err(ApiError::Invalid(vec![batch::too_many(count)]));
    }
    let cases = batch::cases(json::elements(body)?).map_err(ApiError::Invalid)?;
    Ok(cases.into_iter().map(|case| body.slice_ref(case.get().as_bytes())).collect())
}
