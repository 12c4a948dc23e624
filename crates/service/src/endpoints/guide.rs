//! `GET /guide/`: the guide, from files in the program; `GET /problems/{name}` and `GET /warnings/{name}`: its sections about what an
//! answer names, as HTML or JSON.

use axum::extract::{OriginalUri, Path};
use axum::http::header;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Redirect, Response};

use super::page::send;
use crate::embedded::File;
use crate::error::ApiError;
use crate::format::prefers_html;

/// The pages, and what they load, as the build writes them.
static FILES: &[File] = include!(concat!(env!("OUT_DIR"), "/guide.rs"));

/// The guide is at `/guide/`, beside which its files lie.
pub async fn redirect() -> Redirect {
    Redirect::permanent("/guide/")
}

/// The contents.
///
/// # Errors
/// [`ApiError::NotFound`] where there are none.
pub async fn contents(request: Parts) -> Result<Response, ApiError> {
    file(OriginalUri(request.uri.clone()), Path("index".to_owned()), request).await
}

/// A chapter, or a file that the chapters load.
///
/// # Errors
/// [`ApiError::NotFound`] where there is none.
pub async fn file(uri: OriginalUri, Path(name): Path<String>, request: Parts) -> Result<Response, ApiError> {
    let end = if name.contains('.') { "" } else { ".html" };
    answer(&format!("/guide/{name}{end}"), &uri, &request)
}

/// All kinds of problems.
pub async fn problems() -> Redirect {
    Redirect::permanent("/guide/problems")
}

/// All codes of warnings.
pub async fn warnings() -> Redirect {
    Redirect::permanent("/guide/warnings")
}

/// A kind of problem.
///
/// # Errors
/// [`ApiError::NotFound`] where there is none of the name.
pub async fn problem(uri: OriginalUri, Path(name): Path<String>, request: Parts) -> Result<Response, ApiError> {
    section("problems", &name, &uri, &request)
}

/// A code of warnings.
///
/// # Errors
/// [`ApiError::NotFound`] where there is none of the name.
pub async fn warning(uri: OriginalUri, Path(name): Path<String>, request: Parts) -> Result<Response, ApiError> {
    section("warnings", &name, &uri, &request)
}

/// A section that has a page of its own: HTML for browsers, which ask for it by name, else JSON.
fn section(chapter: &str, name: &str, uri: &OriginalUri, request: &Parts) -> Result<Response, ApiError> {
    let end = if prefers_html(&request.headers) { "html" } else { "json" };
    let response = answer(&format!("/{chapter}/{name}.{end}"), uri, request)?;
    Ok(([(header::VARY, "accept, accept-encoding")], response).into_response())
}

fn answer(path: &str, OriginalUri(uri): &OriginalUri, request: &Parts) -> Result<Response, ApiError> {
    send(FILES, path, &request.headers, "no-cache").ok_or_else(|| ApiError::NotFound(uri.path().to_owned()))
}
