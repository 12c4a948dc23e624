//! The body of a request: declared as JSON, complete, and not too long.

use axum::body::{Body, Bytes};
use axum::extract::{FromRequest, Request};
use axum::http::header;
use http_body_util::BodyExt;

use crate::error::ApiError;
use crate::middleware::route;
use crate::state::AppState;

/// The bytes of a body that is declared as JSON.
#[derive(Debug)]
pub struct Payload(pub Bytes);

impl FromRequest<AppState> for Payload {
    type Rejection = ApiError;

    async fn from_request(request: Request, state: &AppState) -> Result<Self, ApiError> {
        read(request, state, state.config.body_limit).await.map(Self)
    }
}

/// The bytes of a batch that is declared as JSON, which may be longer than a single request.
#[derive(Debug)]
pub struct BatchPayload(pub Bytes);

impl FromRequest<AppState> for BatchPayload {
    type Rejection = ApiError;

    async fn from_request(request: Request, state: &AppState) -> Result<Self, ApiError> {
        read(request, state, state.config.batch_body_limit).await.map(Self)
    }
}

async fn read(request: Request, state: &AppState, limit: usize) -> Result<Bytes, ApiError> {
    let declared = request.headers().get(header::CONTENT_TYPE);
    let media_type = declared.map_or(Ok("nothing"), |value| value.to_str()).unwrap_or("an unreadable type");
    if !is_json(media_type) {
        return Err(ApiError::UnsupportedMediaType(media_type.to_owned()));
    }
    let declared = request.headers().get(header::CONTENT_LENGTH).and_then(|length| length.to_str().ok());
    let too_long = declared.and_then(|length| length.parse().ok()).is_some_and(|length: u64| length > limit as u64);
    if too_long && request.headers().contains_key(header::EXPECT) {
        // The client waits for the word to go on; any other would send all the same, and miss the answer.
        return Err(ApiError::PayloadTooLarge { limit });
    }
    let deadline = state.config.deadline;
    let route = route(&request);
    let received = collect(request.into_body(), state, limit);
    let body = tokio::time::timeout(deadline, received).await;
    let body = body.map_err(|_| ApiError::BodyTimeout { seconds: deadline.as_secs_f64() })??;
    state.metrics.received(&route, body.len());
    Ok(body)
}

/// The bytes of a body, which count as held from the first on.
async fn collect(mut body: Body, state: &AppState, limit: usize) -> Result<Bytes, ApiError> {
    let mut share = state.memory.share();
    let mut bytes = Vec::new();
    while let Some(frame) = body.frame().await {
        let frame = frame.map_err(|error| ApiError::UnreadableBody(error.to_string()))?;
        let Ok(data) = frame.into_data() else { continue };
        if bytes.len() + data.len() > limit {
            return Err(ApiError::PayloadTooLarge { limit });
        }
        if state.memory.is_full() {
            return Err(ApiError::Busy);
        }
        share.grow(data.len());
        bytes.extend_from_slice(&data);
    }
    Ok(share.keep(bytes))
}

/// `application/json` or a type built on it, with any parameters.
fn is_json(media_type: &str) -> bool {
    let essence = media_type.split(';').next().unwrap_or_default().trim().to_ascii_lowercase();
    essence == "application/json" || (essence.starts_with("application/") && essence.ends_with("+json"))
}
