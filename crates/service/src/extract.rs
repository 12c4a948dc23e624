//! The body of a request: declared as JSON, complete, and not too long.

use std::sync::Arc;

use axum::body::{Body, Bytes};
use axum::extract::{FromRequest, Request};
use axum::http::{HeaderMap, header};
use http_body_util::BodyExt;
use reentry::Interrupt;
use serde_json::Value;
use tokio::time::{Instant, timeout, timeout_at};

use crate::client::Client;
use crate::coding::{Coding, InflateError, inflate};
use crate::error::ApiError;
use crate::memory::{Budget, HURRY, SLOWEST};
use crate::middleware::route;
use crate::state::AppState;
use crate::wire::json;

/// A body that is declared as JSON, in the coding in which it came.
#[derive(Debug)]
pub struct Payload {
    bytes: Bytes,
    /// What these take in memory.
    held: usize,
    coding: Coding,
    limit: usize,
    /// Where the text counts that is made of another coding, and whose it is.
    budget: Arc<Budget>,
    client: Client,
}

impl Payload {
    /// The tree of its JSON.
    ///
    /// # Errors
    /// As [`Payload::text`], and when the text is not JSON.
    pub fn json(&self, interrupt: &dyn Interrupt) -> Result<Value, ApiError> {
        let text = self.text(interrupt)?;
        hold_tree(&text, interrupt)?;
        Ok(json::parse(&text)?)
    }

    /// The text.
    ///
    /// # Errors
    /// When the body is not what its coding says, or when its text is too long or has no room in memory.
    pub fn text(&self, interrupt: &dyn Interrupt) -> Result<Bytes, ApiError> {
        let Self { bytes, held, coding, limit, budget, client } = self;
        let (coding, limit) = (*coding, *limit);
        if coding == Coding::Identity {
            return Ok(bytes.clone());
        }
        let mut permit = budget.permit_beside(*client, *held);
        let text = inflate(coding, bytes, interrupt, |length| {
            if length > limit {
                Err(ApiError::PayloadTooLarge { limit })
            } else {
                permit.try_hold(length).map_err(ApiError::from)
            }
        });
        match text {
            Ok(text) => Ok(permit.keep(text)),
            Err(InflateError::Unreadable(_)) if interrupt.is_raised() => Err(ApiError::Interrupted),
            Err(InflateError::Unreadable(error)) => {
                Err(ApiError::UnreadableBody(format!("it is not {}: {error}", coding.name())))
            }
            Err(InflateError::Refused(error)) => Err(error),
        }
    }
}

/// Holds what the tree of a text takes at most, and what is made of it later, if that is much.
///
/// # Errors
/// When there is no room for it.
pub fn hold_tree(text: &[u8], interrupt: &dyn Interrupt) -> Result<(), ApiError> {
    // A list of numbers of one digit takes 35 times its length.
    let bytes = 36 * text.len();
    if bytes <= LITTLE || interrupt.may_hold(bytes) { Ok(()) } else { Err(ApiError::Interrupted) }
}

/// What is not counted while a job computes, as the first steps of a flight are not, bytes.
const LITTLE: usize = 1 << 20;

impl FromRequest<AppState> for Payload {
    type Rejection = ApiError;

    async fn from_request(request: Request, state: &AppState) -> Result<Self, ApiError> {
        read(request, state, state.config.body_limit, &state.memory.bodies).await
    }
}

/// A batch that is declared as JSON, which may be longer than a single request.
#[derive(Debug)]
pub struct BatchPayload(pub Payload);

impl FromRequest<AppState> for BatchPayload {
    type Rejection = ApiError;

    async fn from_request(request: Request, state: &AppState) -> Result<Self, ApiError> {
        read(request, state, state.config.batch_body_limit, &state.memory.batch_bodies).await.map(Self)
    }
}

async fn read(request: Request, state: &AppState, limit: usize, budget: &Arc<Budget>) -> Result<Payload, ApiError> {
    let declared = request.headers().get(header::CONTENT_TYPE);
    let media_type = declared.map_or(Ok("nothing"), |value| value.to_str()).unwrap_or("an unreadable type");
    if !is_json(media_type) {
        return Err(ApiError::UnsupportedMediaType(media_type.to_owned()));
    }
    let coding = declared_coding(request.headers())?;
    let declared = request.headers().get(header::CONTENT_LENGTH).and_then(|length| length.to_str().ok());
    let too_long = declared.and_then(|length| length.parse().ok()).is_some_and(|length: u64| length > limit as u64);
    if too_long && request.headers().contains_key(header::EXPECT) {
        // The client waits for the word to go on; any other would send all the same, and miss the answer.
        return Err(ApiError::PayloadTooLarge { limit });
    }
    let deadline = state.config.deadline;
    let route = route(&request);
    let client = Client::of(request.extensions());
    let received = collect(request.into_body(), limit, budget, client);
    let bytes = timeout(deadline, received).await;
    let (bytes, held) = bytes.map_err(|_| ApiError::BodyTimeout { seconds: deadline.as_secs_f64() })??;
    state.metrics.received(&route, bytes.len());
    Ok(Payload { bytes, held, coding, limit, budget: Arc::clone(budget), client })
}

/// The coding in which a request with these headers has its body.
fn declared_coding(headers: &HeaderMap) -> Result<Coding, ApiError> {
    let mut lines = headers.get_all(header::CONTENT_ENCODING).iter();
    let coding = lines.next().map_or(Ok(""), |line| line.to_str()).unwrap_or("an unreadable coding").trim();
    let coding = if coding.is_empty() { "identity" } else { coding };
    let known = [Coding::Identity, Coding::Gzip, Coding::Zstd];
    match known.into_iter().find(|known| known.name().eq_ignore_ascii_case(coding)) {
        Some(known) if lines.next().is_none() => Ok(known),
        Some(_) => Err(ApiError::UnsupportedCoding("several codings".to_owned())),
        None => Err(ApiError::UnsupportedCoding(coding.to_owned())),
    }
}

/// The bytes of a body, which count as held from the first on, and what they take in memory. Where bodies take much memory, one that comes slowly is not waited for.
async fn collect(
    mut body: Body,
    limit: usize,
    budget: &Arc<Budget>,
    client: Client,
) -> Result<(Bytes, usize), ApiError> {
    budget.admit(client)?;
    let mut permit = budget.permit(client);
    let mut bytes = Vec::new();
    let (mut look, mut before) = (Instant::now() + HURRY, 0);
    loop {
        let Ok(frame) = timeout_at(look, body.frame()).await else {
            if budget.is_tight() && bytes.len() - before < SLOWEST {
                return Err(ApiError::BodyTooSlow { least: SLOWEST });
            }
            (look, before) = (look + HURRY, bytes.len());
            continue;
        };
        let Some(frame) = frame else { break };
        let frame = frame.map_err(|error| ApiError::UnreadableBody(error.to_string()))?;
        let Ok(data) = frame.into_data() else { continue };
        let length = bytes.len() + data.len();
        if length > limit {
            return Err(ApiError::PayloadTooLarge { limit });
        }
        if length > bytes.capacity() {
            let capacity = (2 * bytes.capacity()).clamp(length, limit);
            permit.try_hold(capacity)?;
            bytes.reserve_exact(capacity - bytes.len());
        }
        bytes.extend_from_slice(&data);
    }
    let held = bytes.capacity();
    Ok((permit.keep(bytes), held))
}

/// `application/json` or a type built on it, with any parameters.
fn is_json(media_type: &str) -> bool {
    let essence = media_type.split(';').next().unwrap_or_default().trim().to_ascii_lowercase();
    essence == "application/json" || (essence.starts_with("application/") && essence.ends_with("+json"))
}
