//! `GET /health/live` and `GET /health/ready`: for those who watch the service.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use serde::Serialize;
use utoipa::ToSchema;

use crate::state::AppState;

/// How the service is.
#[derive(Debug, Serialize, ToSchema)]
pub struct Health {
    /// `ok`, `busy` (no place for another job, or no memory for its answer) or `draining` (going down).
    status: &'static str,
}

/// Whether the service runs.
#[utoipa::path(
    get,
    path = "/health/live",
    tag = "health",
    responses((status = 200, description = "It runs.", body = Health)),
)]
pub async fn live() -> Json<Health> {
    Json(Health { status: "ok" })
}

/// Whether the service takes new work.
#[utoipa::path(
    get,
    path = "/health/ready",
    tag = "health",
    responses(
        (status = 200, description = "It takes new work.", body = Health),
        (status = 503, description = "It is busy or going down.", body = Health),
    ),
)]
pub async fn ready(State(app): State<AppState>) -> (StatusCode, Json<Health>) {
    let (code, status) = if app.is_draining() {
        (StatusCode::SERVICE_UNAVAILABLE, "draining")
    } else if app.compute.has_room() {
        (StatusCode::OK, "ok")
    } else {
        (StatusCode::SERVICE_UNAVAILABLE, "busy")
    };
    (code, Json(Health { status }))
}
