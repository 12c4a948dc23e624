//! The service, called as a function: the whole router, no socket.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, Bytes};
use axum::http::{HeaderMap, Method, Request, StatusCode, header};
use http_body_util::BodyExt;
use reentry_service::compute::Compute;
use reentry_service::config::Config;
use reentry_service::state::AppState;
use reentry_service::telemetry::LostLines;
use serde_json::Value;
use tower::ServiceExt;

/// A running service.
#[derive(Clone, Debug)]
pub struct Service {
    router: Router,
}

/// What it answered.
#[derive(Debug)]
pub struct Answer {
    /// The status.
    pub status: StatusCode,
    /// The headers.
    pub headers: HeaderMap,
    /// The body.
    pub body: Bytes,
}

impl Service {
    /// A service with the settings of `reentry serve`.
    pub fn new() -> Self {
        Self::with(Config::default())
    }

    /// The same with a minute for a request, for tests of what takes a while on a busy machine and not of how long it takes.
    pub fn patient() -> Self {
        Self::with(Config { deadline: Duration::from_mins(1), ..Config::default() })
    }

    /// A service with other settings.
    ///
    /// # Panics
    /// When the system gives no thread.
    #[expect(clippy::expect_used, reason = "a test that has no threads cannot go on")]
    pub fn with(config: Config) -> Self {
        Self {
            router: reentry_service::app(AppState::new(config, LostLines::default()).expect("threads for the workers")),
        }
    }

    /// Sends any request.
    ///
    /// # Panics
    /// When the body of the answer cannot be read.
    #[expect(clippy::expect_used, reason = "the service answers from memory")]
    pub async fn send(&self, request: Request<Body>) -> Answer {
        let Ok(response) = self.router.clone().oneshot(request).await;
        let (parts, body) = response.into_parts();
        let body = body.collect().await.expect("a body from memory").to_bytes();
        Answer { status: parts.status, headers: parts.headers, body }
    }

    /// Sends a JSON body of any text.
    ///
    /// # Panics
    /// When the path is no URI.
    #[expect(clippy::expect_used, reason = "the paths are literals")]
    pub async fn post_text(&self, path: &str, body: impl Into<Body>) -> Answer {
        let request = Request::builder().method(Method::POST).uri(path);
        let request = request.header(header::CONTENT_TYPE, "application/json");
        self.send(request.body(body.into()).expect("a request")).await
    }

    /// Sends a JSON value.
    pub async fn post(&self, path: &str, body: &Value) -> Answer {
        self.post_text(path, body.to_string()).await
    }

    /// Gets a path.
    ///
    /// # Panics
    /// When the path is no URI.
    #[expect(clippy::expect_used, reason = "the paths are literals")]
    pub async fn get(&self, path: &str) -> Answer {
        self.send(Request::builder().uri(path).body(Body::empty()).expect("a request")).await
    }
}

/// A pool of workers by itself.
///
/// # Panics
/// When the system gives no thread.
#[expect(clippy::expect_used, reason = "a test that has no threads cannot go on")]
pub fn pool(config: Config) -> Arc<Compute> {
    AppState::new(config, LostLines::default()).expect("threads for the workers").compute
}

impl Default for Service {
    fn default() -> Self {
        Self::new()
    }
}

impl Answer {
    /// The body as JSON.
    ///
    /// # Panics
    /// When it is not.
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body)
            .unwrap_or_else(|error| panic!("{} is not JSON: {error}", String::from_utf8_lossy(&self.body)))
    }

    /// The pointers of a problem document, in order.
    pub fn pointers(&self) -> Vec<String> {
        let problem = self.json();
        let errors = problem["errors"].as_array().cloned().unwrap_or_default();
        errors.iter().filter_map(|error| error["pointer"].as_str().map(str::to_owned)).collect()
    }
}
