//! `GET /`: a short page with links.

use axum::response::Html;

/// A short page with links.
pub async fn home() -> Html<&'static str> {
    Html(include_str!("home.html"))
}
