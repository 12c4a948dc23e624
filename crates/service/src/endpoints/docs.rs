//! `GET /docs`: the API to read and to try, from files in the program; nothing comes from elsewhere.

use std::sync::{Arc, LazyLock};

use axum::body::Bytes;
use axum::extract::{OriginalUri, Path, State};
use axum::http::header;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Redirect, Response};
use utoipa_swagger_ui::Config;

use crate::answer::Answer;
use crate::compute::Task;
use crate::embedded::media_type;
use crate::error::ApiError;
use crate::metrics::Work;
use crate::reply::reply;
use crate::state::AppState;

/// Without Swagger's bar and the validator of its own site.
static CONFIG: LazyLock<Arc<Config<'static>>> = LazyLock::new(|| {
    Arc::new(Config::from("/openapi.json").validator_url("none").use_base_layout().default_models_expand_depth(0))
});

/// The page is at `/docs/`, beside which its files lie.
pub async fn redirect() -> Redirect {
    Redirect::permanent("/docs/")
}

/// The page.
///
/// # Errors
/// [`ApiError::NotFound`] where there is none.
pub async fn page(app: State<AppState>, uri: OriginalUri, request: Parts) -> Result<Response, ApiError> {
    file(app, uri, Path("index.html".to_owned()), request).await
}

/// A file of the page, coded in the pool: the longest has more than a million bytes.
///
/// # Errors
/// [`ApiError::NotFound`] where there is none.
pub async fn file(
    State(app): State<AppState>,
    OriginalUri(uri): OriginalUri,
    Path(name): Path<String>,
    request: Parts,
) -> Result<Response, ApiError> {
    let file = match utoipa_swagger_ui::serve(&name, Arc::clone(&CONFIG)) {
        Ok(Some(file)) => file,
        Ok(None) => return Err(ApiError::NotFound(uri.path().to_owned())),
        Err(error) => {
            tracing::error!(%error, "a file of the documentation could not be made");
            return Err(ApiError::Internal);
        }
    };
    let media_type = media_type(&name);
    let job = move |_: &Task| Ok(Answer { body: file.bytes.to_vec(), work: Work::default() });
    let response = reply(&app, "/docs/{*name}", &request, media_type, job).await?;
    Ok(([(header::CONTENT_SECURITY_POLICY, POLICY), (header::CACHE_CONTROL, "no-cache")], response).into_response())
}

/// What a browser may do with the page: load from this service, with the styles that it writes into itself.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; \
                      connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The OpenAPI document, whose text is given.
///
/// # Errors
/// When the service is busy.
pub async fn document(app: &AppState, request: &Parts, text: Bytes) -> Result<Response, ApiError> {
    let job = move |_: &Task| Ok(Answer { body: text.to_vec(), work: Work::default() });
    reply(app, "/openapi.json", request, "application/json", job).await
}
