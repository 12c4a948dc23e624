//! Every route.

use axum::extract::OriginalUri;
use axum::http::{Method, header};
use axum::routing::get;
use axum::{Json, Router, middleware};
use serde_json::Value;
use tower_http::CompressionLevel;
use tower_http::compression::CompressionLayer;
use tower_http::compression::predicate::SizeAbove;
use tower_http::cors::{Any, CorsLayer};
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::endpoints::{analytic, batch, convert, docs, health, page, simulate, validation};
use crate::error::ApiError;
use crate::middleware::{REQUEST_ID, observe};
use crate::openapi::{self, Document};
use crate::state::AppState;

/// The routes of the OpenAPI document.
fn routes() -> OpenApiRouter<AppState> {
    OpenApiRouter::with_openapi(Document::openapi())
        .routes(routes!(simulate::simulate))
        .routes(routes!(batch::simulate_batch))
        .routes(routes!(convert::convert))
        .routes(routes!(analytic::analytic))
        .routes(routes!(validation::validation))
        .routes(routes!(health::live))
        .routes(routes!(health::ready))
}

/// The OpenAPI document that the service gives and that is committed as `openapi/openapi.json`.
pub fn document() -> Value {
    openapi::strict(routes().get_openapi())
}

/// The whole service.
pub fn app(state: AppState) -> Router {
    let (api, _) = routes().split_for_parts();
    let document = document();
    let api = api
        .route("/openapi.json", get(move || std::future::ready(Json(document.clone()))))
        .route("/docs", get(docs::redirect))
        .route("/docs/", get(docs::page))
        .route("/docs/{*name}", get(docs::file));
    // The page is compressed already.
    let all = compressed(api, &state)
        .route("/", get(page::index))
        .route("/assets/{name}", get(page::asset))
        .fallback(|OriginalUri(uri): OriginalUri| async move { ApiError::NotFound(uri.path().to_owned()) })
        .method_not_allowed_fallback(|OriginalUri(uri): OriginalUri| async move {
            ApiError::MethodNotAllowed(uri.path().to_owned())
        });
    surrounded(all, state)
}

/// Routes with what surrounds those of the API: compression, CORS, the log.
pub fn layered(routes: Router<AppState>, state: AppState) -> Router {
    surrounded(compressed(routes, &state), state)
}

/// Routes whose answers are compressed.
fn compressed(routes: Router<AppState>, state: &AppState) -> Router<AppState> {
    routes.layer(
        CompressionLayer::new()
            .quality(CompressionLevel::Fastest)
            .compress_when(SizeAbove::new(state.config.compress_above)),
    )
}

/// Routes with CORS and the log.
fn surrounded(routes: Router<AppState>, state: AppState) -> Router {
    let cors = CorsLayer::new()
        .allow_origin(Any)
        .allow_methods([Method::GET, Method::POST])
        .allow_headers([header::CONTENT_TYPE, header::ACCEPT, REQUEST_ID])
        .expose_headers([REQUEST_ID, header::RETRY_AFTER]);
    routes.layer(cors).layer(middleware::from_fn(observe)).with_state(state)
}
