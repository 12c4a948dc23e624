//! `GET /metrics`: what the service counts, for Prometheus.

use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};

use crate::error::ApiError;
use crate::metrics::MEDIA_TYPE;
use crate::state::AppState;

/// What the service counts, for Prometheus.
///
/// Requests, their duration and bytes, by route and outcome; jobs that wait and run, what they waited and took, by route; cancelled jobs;
/// integration steps and rows. Answered at another address, and not here, where the service has one for it.
#[utoipa::path(
    get,
    path = "/metrics",
    tag = "health",
    responses((status = 200, description = "The counts.", content_type = "application/openmetrics-text", body = String)),
)]
pub async fn metrics(State(app): State<AppState>) -> Result<Response, ApiError> {
    let text = app.metrics.text(app.now()).map_err(|_| ApiError::Internal)?;
    Ok(([(header::CONTENT_TYPE, MEDIA_TYPE)], text).into_response())
}
