//! `GET /health/live` and `GET /health/ready`: for those who watch the service.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use serde::Serialize;
use utoipa::ToSchema;

use crate::state::AppState;

/// Health of the service.
#[derive(Debug, Serialize, ToSchema)]
pub struct Health {
    /// `ok`, `busy` (no room for another request, or no memory for its response) or `draining` (shutting down).
    status: &'static str,
}

/// Check whether the service is running.
#[utoipa::path(
    get,
    path = "/health/live",
    tag = "health",
    responses((status = 200, description = "The service is running.", body = Health)),
)]
pub async fn live() -> Json<Health> {
    Json(Health { status: "ok" })
}

/// Check whether the service accepts new requests.
#[utoipa::path(
    get,
    path = "/health/ready",
    tag = "health",
    responses(
        (status = 200, description = "The service accepts new requests.", body = Health),
        (status = 503, description = "The service is busy or shutting down.", body = Health),
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
