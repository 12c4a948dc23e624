//! From a job to its response: run in the pool, counted, coded, and held until it is sent.

use std::sync::atomic::AtomicBool;

use axum::body::{Body, Bytes};
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use reentry::Interrupt;

use crate::answer::Answer;
use crate::client::Client;
use crate::coding::{Coding, Encoder};
use crate::compute::Task;
use crate::error::ApiError;
use crate::state::AppState;

/// The codings that are made while a client waits, the fastest first.
const CODINGS: [Coding; 3] = [Coding::Zstd, Coding::Gzip, Coding::Identity];

/// The coding of an answer to a request with these headers, where it is long enough.
pub fn coding(request: &HeaderMap) -> Coding {
    Coding::negotiate(request, &CODINGS)
}

/// Runs the job of a route and answers with what it gives, in the coding that the client likes best.
///
/// # Errors
/// Those of the job and of [`Compute::run`](crate::compute::Compute::run).
pub async fn reply<F>(
    app: &AppState,
    route: &'static str,
    request: &Parts,
    media_type: &'static str,
    mut job: F,
) -> Result<Response, ApiError>
where
    F: FnMut(&Task) -> Result<Answer, ApiError> + Send + 'static,
{
    let coding = coding(&request.headers);
    let state = app.clone();
    let run = move |task: &Task| {
        let Answer { body, work } = job(task)?;
        state.metrics.flown(route, work);
        let coding = if body.len() as u64 >= state.config.compress_above { coding } else { Coding::Identity };
        Ok((coding, task.keep(coded(body, coding, task)?)))
    };
    let (coding, body) = app.compute.run(route, Client::of(&request.extensions), run).await?;
    Ok(response(media_type, coding, body))
}

/// A response of a body in a coding.
pub fn response(media_type: &'static str, coding: Coding, body: impl Into<Body>) -> Response {
    let headers = [(header::CONTENT_TYPE, media_type), (header::VARY, "accept-encoding")];
    match coding {
        Coding::Identity => (headers, body.into()).into_response(),
        coding => (headers, [(header::CONTENT_ENCODING, coding.name())], body.into()).into_response(),
    }
}

fn coded(body: Vec<u8>, coding: Coding, interrupt: &dyn Interrupt) -> Result<Vec<u8>, ApiError> {
    if coding == Coding::Identity {
        return Ok(body);
    }
    // Only the flag ends it early.
    let mut encoder = Encoder::new(coding).map_err(|_| ApiError::Internal)?;
    encoder.write(&body, interrupt).map_err(|_| ApiError::Interrupted)?;
    encoder.finish().map_err(|_| ApiError::Internal)
}

/// Lines that are coded as one text, each readable as soon as it is there.
#[derive(Debug)]
pub struct Lines {
    encoder: Encoder,
}

/// The longest line that is coded by the thread that talks to the client, bytes: less than a millisecond.
const SHORT: usize = 1 << 16;

impl Lines {
    /// No line yet.
    ///
    /// # Errors
    /// When there is no memory for it.
    pub fn new(coding: Coding) -> Result<Self, ApiError> {
        Encoder::new(coding).map(|encoder| Self { encoder }).map_err(|_| ApiError::Internal)
    }

    /// The next line, coded; a long one by a worker.
    ///
    /// # Errors
    /// As [`Compute::share`](crate::compute::Compute::share).
    pub async fn next(
        self,
        app: &AppState,
        route: &'static str,
        client: Client,
        line: Bytes,
    ) -> Result<(Self, Bytes), ApiError> {
        if matches!(self.encoder, Encoder::Identity(_)) {
            return Ok((self, line));
        }
        if line.len() <= SHORT {
            let (lines, coded) = self.write(&line, &AtomicBool::new(false))?;
            return Ok((lines, app.memory.answers.permit(client).keep(coded)));
        }
        // Once: it asks for no memory, hence it is not begun anew.
        let mut lines = Some(self);
        let code = move |task: &Task| {
            let (lines, coded) = lines.take().ok_or(ApiError::Internal)?.write(&line, task)?;
            Ok((lines, task.keep(coded)))
        };
        app.compute.share(route, client, code, app.config.deadline).await
    }

    fn write(mut self, line: &[u8], interrupt: &dyn Interrupt) -> Result<(Self, Vec<u8>), ApiError> {
        self.encoder.write(line, interrupt).map_err(|_| ApiError::Interrupted)?;
        let coded = self.encoder.take().map_err(|_| ApiError::Internal)?;
        Ok((self, coded))
    }

    /// What follows the last line.
    ///
    /// # Errors
    /// Never: memory can always be written.
    pub fn end(self) -> Result<Bytes, ApiError> {
        self.encoder.finish().map(Bytes::from).map_err(|_| ApiError::Internal)
    }
}
