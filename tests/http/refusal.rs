//! What every refusal looks like, and that the service is afterwards as good as before.

use std::collections::BTreeSet;

use axum::body::Body;
use axum::http::{Method, Request, StatusCode, header};
use reentry_service::config::Config;
use reentry_tests::service::{Answer, Service};
use serde_json::{Value, json};

use super::requests::{conversion, flight};

/// The whole list of problems: type, title, status.
const PROBLEMS: [(&str, &str, u16); 28] = [
    ("/problems/invalid-json", "Not JSON", 400),
    ("/problems/invalid-query", "Invalid query string", 400),
    ("/problems/unreadable-body", "Unreadable body", 400),
    ("/problems/malformed-request", "Malformed request", 400),
    ("/problems/not-found", "Not found", 404),
    ("/problems/method-not-allowed", "Method not allowed", 405),
    ("/problems/not-acceptable", "Not acceptable", 406),
    ("/problems/request-timeout", "Body too slow", 408),
    ("/problems/payload-too-large", "Payload too large", 413),
    ("/problems/uri-too-long", "Path too long", 414),
    ("/problems/unsupported-media-type", "Unsupported media type", 415),
    ("/problems/unsupported-coding", "Unsupported content coding", 415),
    ("/problems/invalid-case", "Case not valid", 422),
    ("/problems/row-limit", "Too many rows", 422),
    ("/problems/answer-too-large", "Answer too large", 422),
    ("/problems/step-limit", "Too many steps", 422),
    ("/problems/singularity", "Singular equations", 422),
    ("/problems/step-size", "Too stiff to integrate", 422),
    ("/problems/chattering-schedule", "Chattering schedule", 422),
    ("/problems/no-direction", "Thrust without direction", 422),
    ("/problems/no-mass-left", "No mass left", 422),
    ("/problems/unknown-shares", "Unknown shares of propellant", 422),
    ("/problems/overflow", "Loads out of range", 422),
    ("/problems/too-many-requests", "Too many requests", 429),
    ("/problems/head-too-large", "Request head too large", 431),
    ("/problems/internal", "Internal error", 500),
    ("/problems/busy", "Busy", 503),
    ("/problems/deadline-exceeded", "Time limit exceeded", 504),
];

/// Those that the program may give: its table is a `match`, of which only the source has the whole.
#[test]
fn every_problem_of_the_program_is_listed() {
    let source = include_str!("../../crates/service/src/error.rs");
    let of_program: BTreeSet<_> = source.split('"').filter(|text| text.starts_with("/problems/")).collect();
    assert_eq!(of_program, PROBLEMS.iter().map(|(kind, ..)| *kind).collect());
}

/// A service that must answer good requests after every bad one as if nothing had happened.
pub(crate) struct Steady {
    pub(crate) service: Service,
    before: [Value; 2],
}

impl Steady {
    /// With the default settings.
    pub(crate) async fn new() -> Self {
        Self::with(Config::default()).await
    }

    /// With other settings.
    pub(crate) async fn with(config: Config) -> Self {
        let service = Service::with(config);
        let before = good_answers(&service).await;
        Self { service, before }
    }

    /// Sends a request that must be refused, and gives the problem document.
    pub(crate) async fn refused(&self, request: Request<Body>) -> Value {
        let problem = problem(&self.service.send(request).await);
        self.is_as_before(&problem).await;
        problem
    }

    /// Fails unless good requests have the same answers as before what was refused.
    pub(crate) async fn is_as_before(&self, problem: &Value) {
        assert_eq!(good_answers(&self.service).await, self.before, "good requests after {problem}");
    }

    /// Posts a text that must be refused.
    pub(crate) async fn refused_text(&self, path: &str, body: impl Into<Body>) -> Value {
        self.refused(post(path, body)).await
    }

    /// Posts a case that must be refused for faults at exactly these pointers, in any order; each detail has the phrase beside it.
    pub(crate) async fn refused_at(&self, path: &str, body: &Value, expected: &[(&str, &str)]) {
        let problem = self.faults_at(path, body, expected).await;
        self.is_as_before(&problem).await;
    }

    /// The same without a look at good requests afterwards.
    pub(crate) async fn faults_at(&self, path: &str, body: &Value, expected: &[(&str, &str)]) -> Value {
        let problem = problem(&self.service.send(post(path, body.to_string())).await);
        assert_eq!(problem["type"], "/problems/invalid-case", "{problem} for {body}");
        let errors = problem["errors"].as_array().unwrap();
        let mut pointers: Vec<_> = errors.iter().map(|error| error["pointer"].as_str().unwrap()).collect();
        let mut wanted: Vec<_> = expected.iter().map(|(pointer, _)| *pointer).collect();
        pointers.sort_unstable();
        wanted.sort_unstable();
        assert_eq!(pointers, wanted, "{problem} for {body}");
        for (pointer, phrase) in expected {
            let says =
                |error: &&Value| error["pointer"] == *pointer && error["detail"].as_str().unwrap().contains(phrase);
            assert!(errors.iter().any(|error| says(&error)), "no {phrase:?} at {pointer} in {problem} for {body}");
        }
        problem
    }
}

/// A request with a body of JSON.
fn post(path: &str, body: impl Into<Body>) -> Request<Body> {
    let request = Request::builder().method(Method::POST).uri(path);
    request.header(header::CONTENT_TYPE, "application/json").body(body.into()).unwrap()
}

/// The problem document of an answer, which must be one.
pub(crate) fn problem(answer: &Answer) -> Value {
    let text = String::from_utf8_lossy(&answer.body);
    assert_eq!(answer.headers[header::CONTENT_TYPE], "application/problem+json", "{} {text}", answer.status);
    assert!(answer.headers.contains_key("x-request-id"), "{text}");
    let problem = answer.json();
    let of_kind = PROBLEMS.iter().find(|(kind, ..)| problem["type"] == *kind);
    let (_, title, status) = of_kind.unwrap_or_else(|| panic!("an unlisted problem: {text}"));
    assert_eq!(problem["title"], *title, "{text}");
    assert_eq!(problem["status"], *status, "{text}");
    assert_eq!(answer.status, StatusCode::from_u16(*status).unwrap(), "{text}");
    assert_eq!(answer.headers.contains_key(header::RETRY_AFTER), [429, 503].contains(status), "{text}");

    let mut names: Vec<_> = problem.as_object().unwrap().keys().map(String::as_str).collect();
    if names.last() == Some(&"errors") {
        names.pop();
    }
    assert_eq!(names, ["type", "title", "status", "detail"]);
    is_for_people(&problem["detail"]);
    let errors = problem["errors"].as_array().cloned().unwrap_or_default();
    for error in &errors {
        assert_eq!(error.as_object().unwrap().len(), 2, "{text}");
        let pointer = error["pointer"].as_str().unwrap();
        assert!(pointer.is_empty() || pointer.starts_with('/'), "{text}");
        is_for_people(&error["detail"]);
    }
    if problem["type"] == "/problems/invalid-case" {
        assert!(!errors.is_empty(), "{text}");
    }
    problem
}

/// A detail is a line of text without the marks of a program's insides.
fn is_for_people(detail: &Value) {
    let detail = detail.as_str().unwrap();
    assert!(!detail.is_empty());
    for mark in ["NaN", "inf,", "Some(", "None", "Err(", "\n", "  "] {
        assert!(!detail.contains(mark), "{mark:?} in {detail:?}");
    }
}

async fn good_answers(service: &Service) -> [Value; 2] {
    let mut flight = good_answer(service, "/simulate", &flight("planet_relative")).await;
    flight["solver"]["elapsed"] = json!(null);
    [flight, good_answer(service, "/convert", &conversion("orbital_elements")).await]
}

/// The answer to a request that must be good.
pub(crate) async fn good_answer(service: &Service, path: &str, body: &Value) -> Value {
    let answer = service.post(path, body).await;
    let text = String::from_utf8_lossy(&answer.body);
    assert_eq!(answer.status, StatusCode::OK, "{text} for {body}");
    assert_eq!(answer.headers[header::CONTENT_TYPE], "application/json");
    answer.json()
}
