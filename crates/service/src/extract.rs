//! The body of a request: declared as JSON, complete, and not too long.

use axum::body::Bytes;
use axum::extract::rejection::BytesRejection;
use axum::extract::{DefaultBodyLimit, FromRequest, Request};
use axum::http::{StatusCode, header};

use crate::error::ApiError;
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

async fn read(mut request: Request, state: &AppState, limit: usize) -> Result<Bytes, ApiError> {
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
    DefaultBodyLimit::max(limit).apply(&mut request);
    let deadline = state.config.deadline;
    match tokio::time::timeout(deadline, Bytes::from_request(request, state)).await {
        Ok(Ok(body)) => Ok(body),
        Ok(Err(rejection)) => Err(unreadable(&rejection, limit)),
        Err(_) => Err(ApiError::BodyTimeout { seconds: deadline.as_secs_f64() }),
    }
}

/// `application/json` or a type built on it, with any parameters.
fn is_json(media_type: &str) -> bool {
    let essence = media_type.split(';').next().unwrap_or_default().trim().to_ascii_lowercase();
    essence == "application/json" || (essence.starts_with("application/") && essence.ends_with("+json"))
}

fn unreadable(rejection: &BytesRejection, limit: usize) -> ApiError {
    if rejection.status() == StatusCode::PAYLOAD_TOO_LARGE {
        ApiError::PayloadTooLarge { limit }
    } else {
        ApiError::UnreadableBody(rejection.body_text())
    }
}
