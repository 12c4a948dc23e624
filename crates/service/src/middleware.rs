//! What happens around every request: its identifier and its line in the log.

use std::time::Instant;

use axum::extract::Request;
use axum::http::{HeaderName, HeaderValue};
use axum::middleware::Next;
use axum::response::Response;
use tracing::Instrument;
use uuid::Uuid;

/// The header that names a request, in the request and in its answer.
pub const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");

const LONGEST_REQUEST_ID: usize = 128;

/// Gives every answer an `x-request-id`, and every request one line in the log.
pub async fn observe(request: Request, next: Next) -> Response {
    let id = request.headers().get(REQUEST_ID).filter(|id| is_sound(id)).cloned().unwrap_or_else(new_id);
    let line = LogLine {
        start: Instant::now(),
        span: tracing::info_span!(
            "request",
            id = id.to_str().unwrap_or_default(),
            method = %request.method(),
            path = request.uri().path(),
        ),
        status: None,
    };
    let span = line.span.clone();
    let mut line = line;
    let mut response = next.run(request).instrument(span).await;
    line.status = Some(response.status().as_u16());
    response.headers_mut().insert(REQUEST_ID, id);
    response
}

/// Up to 128 visible ASCII characters.
fn is_sound(id: &HeaderValue) -> bool {
    (1..=LONGEST_REQUEST_ID).contains(&id.len()) && id.as_bytes().iter().all(u8::is_ascii_graphic)
}

fn new_id() -> HeaderValue {
    HeaderValue::try_from(Uuid::new_v4().to_string()).unwrap_or_else(|_| HeaderValue::from_static("none"))
}

/// Written when the request is over: answered, or given up by its client.
struct LogLine {
    start: Instant,
    span: tracing::Span,
    status: Option<u16>,
}

impl Drop for LogLine {
    fn drop(&mut self) {
        let duration_ms = self.start.elapsed().as_secs_f64() * 1e3;
        let _inside = self.span.enter();
        if let Some(status) = self.status {
            tracing::info!(status, duration_ms, "answered");
        } else {
            tracing::info!(duration_ms, "client went away");
        }
    }
}
