//! `GET /`: the page, from files in the program; nothing comes from elsewhere. Where it was not built, a short one with links.

use axum::http::{HeaderMap, HeaderName, Uri, header};
use axum::response::{IntoResponse, Response};

use crate::embedded::File;
use crate::error::ApiError;

/// The page and what it loads, as the build finds them.
static FILES: &[File] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// What a browser may do with them: load from this service, and be in no frame.
const PROTECTION: [(HeaderName, &str); 3] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; \
         font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
];

/// The page, which names what it loads: asked for each time, sent where it has changed.
///
/// # Errors
/// [`ApiError::NotFound`] where there is none.
pub async fn index(request: HeaderMap) -> Result<Response, ApiError> {
    send(FILES, "/index.html", &request, "no-cache").ok_or_else(|| not_found("/"))
}

/// What the page loads, whose names change with it.
///
/// # Errors
/// [`ApiError::NotFound`] where there is none.
pub async fn asset(uri: Uri, request: HeaderMap) -> Result<Response, ApiError> {
    let path = uri.path();
    send(FILES, path, &request, "public, max-age=31536000, immutable").ok_or_else(|| not_found(path))
}

/// A file, with what a browser may do with it; none where there is none at the path.
pub(super) fn send(files: &[File], path: &str, request: &HeaderMap, caching: &'static str) -> Option<Response> {
    let file = files.iter().find(|file| file.path == path)?;
    Some((PROTECTION, [(header::CACHE_CONTROL, caching)], file.answer(request)).into_response())
}

fn not_found(path: &str) -> ApiError {
    ApiError::NotFound(path.to_owned())
}
