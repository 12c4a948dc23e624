//! `GET /docs`: the API to read and to try, from files in the program; nothing comes from elsewhere.

use std::sync::{Arc, LazyLock};

use axum::extract::{OriginalUri, Path};
use axum::http::header;
use axum::response::{IntoResponse, Redirect, Response};
use utoipa_swagger_ui::Config;

use crate::error::ApiError;

/// The validator of Swagger's own site is left out.
static CONFIG: LazyLock<Arc<Config<'static>>> =
    LazyLock::new(|| Arc::new(Config::from("/openapi.json").validator_url("none")));

/// The page is at `/docs/`, beside which its files lie.
pub async fn redirect() -> Redirect {
    Redirect::permanent("/docs/")
}

/// The page.
///
/// # Errors
/// [`ApiError::NotFound`] where there is none.
pub async fn page(uri: OriginalUri) -> Result<Response, ApiError> {
    file(uri, Path("index.html".to_owned())).await
}

/// A file of the page.
///
/// # Errors
/// [`ApiError::NotFound`] where there is none.
pub async fn file(OriginalUri(uri): OriginalUri, Path(name): Path<String>) -> Result<Response, ApiError> {
    match utoipa_swagger_ui::serve(&name, Arc::clone(&CONFIG)) {
        Ok(Some(file)) => Ok(([(header::CONTENT_TYPE, file.content_type)], file.bytes.into_owned()).into_response()),
        Ok(None) => Err(ApiError::NotFound(uri.path().to_owned())),
        Err(error) => {
            tracing::error!(%error, "a file of the documentation could not be made");
            Err(ApiError::Internal)
        }
    }
}
