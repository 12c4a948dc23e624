//! `GET /metrics`: what the service counts, for Prometheus.

use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};

use crate::error::ApiError;
use crate::metrics::MEDIA_TYPE;
use crate::state::AppState;

/// Get the metrics of the service for Prometheus.
///
/// Requests with their duration and bytes, by route and outcome; jobs that wait and run, with their waiting and
/// computing times, by route; cancelled jobs; integration steps and rows. If the service has a separate address for
/// metrics, this path exists only there.
#[utoipa::path(
    get,
    path = "/metrics",
    tag = "health",
    responses((status = 200, description = "Metrics.", content_type = "application/openmetrics-text", body = String)),
)]
pub async fn metrics(State(app): State<AppState>) -> Result<Response, ApiError> {
    let text = app.metrics.text(app.now()).map_err(|_| ApiError::Internal)?;
    Ok(([(header::CONTENT_TYPE, MEDIA_TYPE)], text).into_response())
}
