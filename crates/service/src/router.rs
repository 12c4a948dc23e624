//! Every route.

use std::sync::LazyLock;

use axum::body::Bytes;
use axum::extract::{OriginalUri, State};
use axum::http::request::Parts;
use axum::http::{Method, header};
use axum::routing::get;
use axum::{Router, middleware};
use serde_json::Value;
use tower_http::cors::{AllowOrigin, CorsLayer};
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::config::Origins;
use crate::endpoints::{
    analytic, batch, convert, corridor, docs, footprint, guide, health, licences, metrics, page, planets, simulate,
    sites, target, validation,
};
use crate::error::ApiError;
use crate::middleware::{REQUEST_ID, check_head, limit, observe, protect};
use crate::openapi::{self, Document};
use crate::rate;
use crate::state::AppState;

/// The routes of the OpenAPI document, but for the metrics, which may have an address of their own.
fn routes() -> OpenApiRouter<AppState> {
    OpenApiRouter::with_openapi(Document::openapi())
        .routes(routes!(simulate::simulate))
        .routes(routes!(batch::simulate_batch))
        .routes(routes!(convert::convert))
        .routes(routes!(analytic::analytic))
        .routes(routes!(target::target))
        .routes(routes!(corridor::corridor))
        .routes(routes!(footprint::footprint))
        .routes(routes!(planets::planets))
        .routes(routes!(sites::sites))
        .routes(routes!(validation::validation))
        .routes(routes!(licences::licences))
        .routes(routes!(health::live))
        .routes(routes!(health::ready))
}

fn with_metrics(routes: OpenApiRouter<AppState>) -> OpenApiRouter<AppState> {
    routes.routes(routes!(metrics::metrics))
}

/// The OpenAPI document that the service gives and that is committed as `openapi/openapi.json`.
pub fn document() -> &'static Value {
    static DOCUMENT: LazyLock<Value> = LazyLock::new(|| openapi::strict(with_metrics(routes()).get_openapi()));
    &DOCUMENT
}

/// The whole service.
pub fn app(state: AppState) -> Router {
    let has_metrics = state.config.metrics_listen.is_none();
    let (api, _) = if has_metrics { with_metrics(routes()) } else { routes() }.split_for_parts();
    let text = Bytes::from(document().to_string());
    let document = async |State(app): State<AppState>, request: Parts| docs::document(&app, &request, text).await;
    let all = api
        .route("/openapi.json", get(document))
        .route("/docs", get(docs::redirect))
        .route("/docs/", get(docs::page))
        .route("/docs/{*name}", get(docs::file))
        .route("/guide", get(guide::redirect))
        .route("/guide/", get(guide::contents))
        .route("/guide/{name}", get(guide::file))
        .route("/problems", get(guide::problems))
        .route("/problems/", get(guide::problems))
        .route("/problems/{name}", get(guide::problem))
        .route("/warnings", get(guide::warnings))
        .route("/warnings/", get(guide::warnings))
        .route("/warnings/{name}", get(guide::warning))
        .route("/", get(page::index))
        .route("/assets/{name}", get(page::asset));
    surrounded(all, state)
}

/// `GET /metrics`, where it has an address of its own.
pub fn metrics_app(state: AppState) -> Router {
    let (metrics, _) = with_metrics(OpenApiRouter::default()).split_for_parts();
    surrounded(metrics, state)
}

/// Routes with what surrounds them: what answers elsewhere, the rate limit, CORS, what protects browsers, the log and the metrics.
pub fn surrounded(routes: Router<AppState>, state: AppState) -> Router {
    let origins = match &state.config.cors_origins {
        Origins::All => AllowOrigin::any(),
        Origins::These(origins) => AllowOrigin::list(origins.clone()),
    };
    let cors = CorsLayer::new()
        .allow_origin(origins)
        .allow_methods([Method::GET, Method::POST])
        .allow_headers([header::CONTENT_TYPE, header::CONTENT_ENCODING, header::ACCEPT, REQUEST_ID])
        .expose_headers([REQUEST_ID, header::RETRY_AFTER, rate::POLICY, rate::LEFT]);
    routes
        .fallback(|OriginalUri(uri): OriginalUri| async move { ApiError::NotFound(uri.path().to_owned()) })
        .method_not_allowed_fallback(|OriginalUri(uri): OriginalUri| async move {
            ApiError::MethodNotAllowed(uri.path().to_owned())
        })
        .layer(middleware::from_fn_with_state(state.clone(), limit))
        .layer(cors)
        .layer(middleware::from_fn(check_head))
        .layer(middleware::from_fn(protect))
        .layer(middleware::from_fn_with_state(state.clone(), observe))
        .with_state(state)
}
