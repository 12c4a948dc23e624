//! What happens around every request: its identifier, its line in the log, its place in the metrics, what a client may send, and what a
//! browser may do with the answer.

use std::net::SocketAddr;
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::{Duration, Instant};

use axum::body::{Body, Bytes, HttpBody};
use axum::extract::{MatchedPath, Request, State};
use axum::http::uri::Authority;
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, Version, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use hyper::body::{Frame, SizeHint};
use tracing::Instrument;
use uuid::Uuid;

use crate::client::{Client, Peer, client};
use crate::error::{ApiError, Outcome};
use crate::state::AppState;

/// The header that names a request, in the request and in its answer.
pub const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");

const LONGEST_REQUEST_ID: usize = 128;

/// The route of a request, as the OpenAPI document has it; `other` at none.
pub fn route(request: &Request) -> String {
    request.extensions().get::<MatchedPath>().map_or(OTHER, MatchedPath::as_str).to_owned()
}

/// What is at no route.
const OTHER: &str = "other";

/// Gives every answer an `x-request-id`, and every request one line in the log and its place in the metrics.
///
/// Neither has anything of the request but its method, its path without the query, its identifier and the client's address.
pub async fn observe(State(app): State<AppState>, mut request: Request, next: Next) -> Response {
    let id = request.headers().get(REQUEST_ID).filter(|id| is_sound(id)).cloned().unwrap_or_else(new_id);
    let client = client(request.extensions(), request.headers(), &app.config);
    request.extensions_mut().insert(client);
    let span = tracing::info_span!(
        "request",
        id = id.to_str().unwrap_or_default(),
        client = client.address().map(tracing::field::display),
        method = %request.method(),
        path = request.uri().path(),
    );
    let has_no_body = request.method() == Method::HEAD;
    let route = route(&request);
    app.metrics.request_begun(&route);
    let mut line =
        Line { app, start: Instant::now(), span: span.clone(), route, answer: None, sent: 0, is_complete: false };
    let mut response = next.run(request).instrument(span).await;
    let outcome = response.extensions().get().map_or("ok", |Outcome(outcome)| outcome);
    line.answer = Some((response.status().as_u16(), outcome));
    response.headers_mut().insert(REQUEST_ID, id);
    if line.app.is_draining() {
        // The client is to send what comes next to another.
        response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    }
    line.is_complete = has_no_body || response.body().is_end_stream();
    response.map(|body| Body::new(Observed { body, rest: Bytes::new(), line }))
}

/// Up to 128 visible ASCII characters.
fn is_sound(id: &HeaderValue) -> bool {
    (1..=LONGEST_REQUEST_ID).contains(&id.len()) && id.as_bytes().iter().all(u8::is_ascii_graphic)
}

fn new_id() -> HeaderValue {
    HeaderValue::try_from(Uuid::new_v4().to_string()).unwrap_or_else(|_| HeaderValue::from_static("none"))
}

/// Written when the request is over: answered to the last byte, or given up by its client.
struct Line {
    app: AppState,
    start: Instant,
    span: tracing::Span,
    route: String,
    /// Status and outcome, once the answer begins.
    answer: Option<(u16, &'static str)>,
    /// Bytes of the answer's body.
    sent: u64,
    is_complete: bool,
}

impl Drop for Line {
    fn drop(&mut self) {
        let duration = self.start.elapsed();
        let duration_ms = duration.as_secs_f64() * 1e3;
        let outcome = match self.answer {
            Some((_, outcome)) if self.is_complete => outcome,
            _ => "abandoned",
        };
        self.app.metrics.request_over(&self.route, outcome, duration, self.sent);
        let bytes = self.sent;
        let _inside = self.span.enter();
        match self.answer {
            Some((status, _)) if self.is_complete => tracing::info!(status, duration_ms, bytes, "answered"),
            Some((status, _)) => tracing::info!(status, duration_ms, bytes, "client went away from its answer"),
            None => tracing::info!(duration_ms, "client went away"),
        }
    }
}

/// The body of an answer, until its end, in pieces: how far a client has taken it is known to a piece.
struct Observed {
    body: Body,
    /// Of a frame of the body, what has not been sent yet.
    rest: Bytes,
    line: Line,
}

/// Bytes of a piece.
const PIECE: usize = 1 << 16;

impl HttpBody for Observed {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        if self.rest.is_empty() {
            match ready!(Pin::new(&mut self.body).poll_frame(context)) {
                Some(Ok(frame)) => match frame.into_data() {
                    Ok(data) => self.rest = data,
                    Err(other) => return Poll::Ready(Some(Ok(other))),
                },
                Some(Err(error)) => return Poll::Ready(Some(Err(error))),
                None => {
                    self.line.is_complete = true;
                    return Poll::Ready(None);
                }
            }
        }
        let length = self.rest.len().min(PIECE);
        let piece = self.rest.split_to(length);
        self.line.sent += length as u64;
        self.line.is_complete |= self.is_end_stream();
        Poll::Ready(Some(Ok(Frame::data(piece))))
    }

    fn is_end_stream(&self) -> bool {
        self.rest.is_empty() && self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        let rest = self.rest.len() as u64;
        let body = self.body.size_hint();
        let mut both = SizeHint::new();
        both.set_lower(body.lower() + rest);
        if let Some(upper) = body.upper() {
            both.set_upper(upper + rest);
        }
        both
    }
}

/// Refuses requests that came over a connection without saying once to whom they go (RFC 9112, section 3.2), or in a coding of the transfer
/// that is not undone here (section 6.1).
pub async fn check_head(request: Request, next: Next) -> Response {
    let mut hosts = request.headers().get_all(header::HOST).iter();
    let mut codings = request.headers().get_all(header::TRANSFER_ENCODING).iter();
    let wrong_host = match (hosts.next(), hosts.next()) {
        (Some(_), Some(_)) => Some("the request must have exactly one Host header"),
        (Some(host), None) if !host.is_empty() && Authority::try_from(host.as_bytes()).is_err() => {
            Some("Host must be a name or an address, with an optional port")
        }
        (None, _) if request.version() > Version::HTTP_10 => Some("the request must have a Host header"),
        _ => None,
    };
    let is_chunked = codings.all(|coding| coding.as_bytes().eq_ignore_ascii_case(b"chunked"));
    let wrong_coding = (!is_chunked).then_some("Transfer-Encoding must be chunked");
    match wrong_host.or(wrong_coding) {
        Some(wrong) if request.extensions().get::<Peer>().is_some() => {
            ApiError::MalformedRequest(wrong).into_response()
        }
        _ => next.run(request).await,
    }
}

/// The answer to a head that is no request, as bytes; with its line in the log and its place in the metrics.
pub fn refuse_head(app: &AppState, peer: SocketAddr, status: StatusCode) -> Vec<u8> {
    let error = match status {
        StatusCode::URI_TOO_LONG => ApiError::UriTooLong,
        StatusCode::REQUEST_HEADER_FIELDS_TOO_LARGE => ApiError::HeadTooLarge,
        _ => ApiError::MalformedRequest("the request head is not HTTP/1.1"),
    };
    let (id, body) = (new_id(), error.problem().to_json());
    app.metrics.request_begun(OTHER);
    app.metrics.request_over(OTHER, error.outcome(), Duration::ZERO, body.len() as u64);
    let (id, client) = (id.to_str().unwrap_or_default(), peer.ip().to_canonical());
    let (status, bytes) = (status.as_u16(), body.len());
    tracing::info!(id, %client, status, bytes, "refused a malformed request head");
    let mut headers = HeaderMap::from_iter(PROTECTION);
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static("application/problem+json"));
    headers.insert(header::CONTENT_LENGTH, bytes.into());
    headers.insert(header::CONNECTION, HeaderValue::from_static("close"));
    let mut text = format!("HTTP/1.1 {status} {}\r\n{REQUEST_ID}: {id}\r\n", error.problem().title).into_bytes();
    for (name, value) in &headers {
        for part in [name.as_str().as_bytes(), b": ", value.as_bytes(), b"\r\n"] {
            text.extend_from_slice(part);
        }
    }
    text.extend_from_slice(b"\r\n");
    text.extend(body);
    text
}

/// Refuses what a client sends beyond its rate, and tells it what it has left; watching the service is free.
pub async fn limit(State(app): State<AppState>, request: Request, next: Next) -> Response {
    let Some(limit) = &app.rate_limit else { return next.run(request).await };
    if FREE.contains(&request.uri().path()) {
        return next.run(request).await;
    }
    let client = Client::of(request.extensions());
    if client.address().is_none() {
        return next.run(request).await;
    }
    let (left, mut response) = match limit.take(client) {
        Ok(left) => (left, next.run(request).await),
        Err((left, refusal)) => (left, refusal.into_response()),
    };
    limit.write_headers(left, response.headers_mut());
    response
}

/// What counts for no rate limit.
const FREE: [&str; 3] = ["/health/live", "/health/ready", "/metrics"];

/// What a browser may do with an answer that says nothing else: show it by itself, run nothing in it, and keep it nowhere.
const PROTECTION: [(HeaderName, HeaderValue); 4] = [
    (header::CONTENT_SECURITY_POLICY, HeaderValue::from_static("default-src 'none'; frame-ancestors 'none'")),
    (header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff")),
    (header::REFERRER_POLICY, HeaderValue::from_static("no-referrer")),
    (header::CACHE_CONTROL, HeaderValue::from_static("no-store")),
];

/// Gives every answer the headers that protect the browser that gets it.
pub async fn protect(request: Request, next: Next) -> Response {
    let mut response = next.run(request).await;
    let headers: &mut HeaderMap = response.headers_mut();
    for (name, value) in PROTECTION {
        headers.entry(name).or_insert(value);
    }
    response
}
