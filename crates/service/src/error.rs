//! Every way in which a request fails: the one table from faults to status and problem document.

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use reentry::motion::Switch;
use reentry::simulate::SimulationError;
use serde::Serialize;
use utoipa::ToSchema;

use crate::memory::Refusal;
use crate::wire::reader::{Fault, MOST_FAULTS};
use crate::wire::shown::printable;

/// What went wrong with a request.
#[derive(Debug, thiserror::Error)]
pub enum ApiError {
    /// The body is not JSON.
    #[error("the body is not JSON: {0}")]
    NotJson(#[from] serde_json::Error),
    /// A case of a list is not JSON.
    #[error("the case is not JSON: {0} of the case")]
    CaseNotJson(serde_json::Error),
    /// The query string has something that it should not have.
    #[error("{0}")]
    BadQuery(String),
    /// The head of the request is not what HTTP has.
    #[error("{0}")]
    MalformedRequest(&'static str),
    /// The target of the request is too long.
    #[error("the path and the query are longer than a request may have them")]
    UriTooLong,
    /// The head of the request is too long.
    #[error("the head of the request is longer than 16384 bytes, or has more than 100 fields")]
    HeadTooLarge,
    /// The body ended early.
    #[error("the body could not be read: {0}")]
    UnreadableBody(String),
    /// The body did not come in time.
    #[error("the body did not come within {seconds} s")]
    BodyTimeout {
        /// The time allowed, s.
        seconds: f64,
    },
    /// The body came too slowly while there was little memory.
    #[error(
        "the body came more slowly than {least} bytes a second, which is too slow while the service has little memory left"
    )]
    BodyTooSlow {
        /// The slowest that is waited for, bytes a second.
        least: usize,
    },
    /// There is nothing at this path.
    #[error("there is nothing at {0}; see /docs")]
    NotFound(String),
    /// The path does not know the method.
    #[error("{0} does not answer to this method; see /docs")]
    MethodNotAllowed(String),
    /// None of the representations that the client accepts.
    #[error("this answer comes as {offered}, not as {asked:?}")]
    NotAcceptable {
        /// What there is.
        offered: String,
        /// What was asked for.
        asked: String,
    },
    /// The body is too long.
    #[error("the body is longer than the {limit} bytes allowed")]
    PayloadTooLarge {
        /// The limit, bytes.
        limit: usize,
    },
    /// The body is not declared as JSON.
    #[error(
        "the body must be declared as application/json, not as {0}; with curl: -H 'content-type: application/json'"
    )]
    UnsupportedMediaType(String),
    /// The body is in a coding that is not taken.
    #[error("the body must be coded by gzip or zstd, or not at all, not by {0}")]
    UnsupportedCoding(String),
    /// The request is JSON, but not a valid case.
    #[error("the request has {}", counted(.0))]
    Invalid(Vec<Fault>),
    /// More rows than allowed.
    #[error("the trajectory would have more than the {limit} rows allowed")]
    TooManyRows {
        /// The limit.
        limit: usize,
        /// The field that asks for them.
        pointer: &'static str,
    },
    /// An answer that does not fit into the memory for answers.
    #[error("the answer would take more than the {limit} bytes of memory that one may take; ask for fewer rows")]
    TooLarge {
        /// The limit, bytes.
        limit: usize,
    },
    /// More rows than there is memory for.
    #[error("the trajectory would have {rows} rows, and there is no memory for so many")]
    NoMemory {
        /// So many.
        rows: u64,
    },
    /// The flight cannot be finished.
    #[error("the flight cannot be finished: {0}")]
    Flight(#[from] SimulationError),
    /// The client has sent more requests than it may, or holds as much as it may.
    #[error("this client may send no more requests now; try again in {seconds} s")]
    TooManyRequests {
        /// Until the next is answered, s.
        seconds: u64,
    },
    /// All workers are busy and the queue is full, or the memory is.
    #[error("the service is busy; try again in a second")]
    Busy,
    /// The time allowed ran out.
    #[error("the request took longer than the {seconds} s allowed")]
    DeadlineExceeded {
        /// The time allowed, s.
        seconds: f64,
    },
    /// Nobody waits for the answer any more.
    #[error("the request was given up")]
    Interrupted,
    /// A fault of the service.
    #[error("the service failed on this request; its x-request-id finds it in the log")]
    Internal,
}

/// A problem document (RFC 9457).
#[derive(Debug, Serialize, ToSchema)]
pub struct Problem {
    /// The kind of problem: a path that stays the same.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The kind of problem, for people.
    pub title: &'static str,
    /// The HTTP status.
    pub status: u16,
    /// This problem, for people.
    pub detail: String,
    /// The fields that are at fault: the first 100. Where there are more, a last entry without a pointer says so.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schema(required = false)]
    pub errors: Vec<FieldError>,
}

impl Problem {
    /// The document as a text of one line.
    pub fn to_json(&self) -> Vec<u8> {
        serde_json::to_vec(self).unwrap_or_default()
    }
}

/// What is wrong with one field.
#[derive(Debug, Serialize, ToSchema)]
pub struct FieldError {
    /// The field, as a JSON pointer (RFC 6901).
    pub pointer: String,
    /// What is wrong, and what would be right.
    pub detail: String,
}

impl ApiError {
    /// The problem document.
    pub fn problem(&self) -> Problem {
        let (status, kind, title) = self.class();
        Problem { kind, title, status: status.as_u16(), detail: printable(&self.to_string()), errors: self.fields() }
    }

    /// The one table: status, type and title.
    fn class(&self) -> (StatusCode, &'static str, &'static str) {
        use SimulationError::{
            Chatter, Interrupted, NoDirection, NoRoom, NothingLeft, Overflow, Singularity, StepLimit, TooStiff,
        };
        use StatusCode as Status;
        match self {
            Self::NotJson(_) | Self::CaseNotJson(_) => (Status::BAD_REQUEST, "/problems/invalid-json", "Not JSON"),
            Self::BadQuery(_) => (Status::BAD_REQUEST, "/problems/invalid-query", "Invalid query string"),
            Self::MalformedRequest(_) => (Status::BAD_REQUEST, "/problems/malformed-request", "Malformed request"),
            Self::UriTooLong => (Status::URI_TOO_LONG, "/problems/uri-too-long", "Path too long"),
            Self::HeadTooLarge => {
                (Status::REQUEST_HEADER_FIELDS_TOO_LARGE, "/problems/head-too-large", "Head of the request too large")
            }
            Self::UnreadableBody(_) => (Status::BAD_REQUEST, "/problems/unreadable-body", "Unreadable body"),
            Self::BodyTimeout { .. } | Self::BodyTooSlow { .. } => {
                (Status::REQUEST_TIMEOUT, "/problems/request-timeout", "Body too slow")
            }
            Self::NotFound(_) => (Status::NOT_FOUND, "/problems/not-found", "Not found"),
            Self::MethodNotAllowed(_) => {
                (Status::METHOD_NOT_ALLOWED, "/problems/method-not-allowed", "Method not allowed")
            }
            Self::NotAcceptable { .. } => (Status::NOT_ACCEPTABLE, "/problems/not-acceptable", "Not acceptable"),
            Self::PayloadTooLarge { .. } => {
                (Status::PAYLOAD_TOO_LARGE, "/problems/payload-too-large", "Payload too large")
            }
            Self::UnsupportedMediaType(_) => {
                (Status::UNSUPPORTED_MEDIA_TYPE, "/problems/unsupported-media-type", "Unsupported media type")
            }
            Self::UnsupportedCoding(_) => {
                (Status::UNSUPPORTED_MEDIA_TYPE, "/problems/unsupported-coding", "Unsupported content coding")
            }
            Self::Invalid(_) => (Status::UNPROCESSABLE_ENTITY, "/problems/invalid-case", "Not a valid case"),
            Self::TooManyRows { .. } | Self::NoMemory { .. } => {
                (Status::UNPROCESSABLE_ENTITY, "/problems/row-limit", "Too many rows")
            }
            Self::TooLarge { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/answer-too-large", "Answer too large"),
            Self::Flight(flight) => match flight {
                StepLimit { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/step-limit", "Too many steps"),
                Singularity { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/singularity", "Singular equations"),
                TooStiff { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/step-size", "Too stiff to integrate"),
                Chatter { .. } => {
                    (Status::UNPROCESSABLE_ENTITY, "/problems/chattering-schedule", "Schedule undoes itself")
                }
                NothingLeft { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/no-mass-left", "No mass left"),
                NoDirection { .. } => {
                    (Status::UNPROCESSABLE_ENTITY, "/problems/no-direction", "Thrust without a direction")
                }
                Overflow { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/overflow", "Loads out of range"),
                NoRoom { .. } => (Status::SERVICE_UNAVAILABLE, "/problems/busy", "Busy"),
                Interrupted { .. } => (Status::GATEWAY_TIMEOUT, "/problems/deadline-exceeded", "Out of time"),
            },
            Self::TooManyRequests { .. } => {
                (Status::TOO_MANY_REQUESTS, "/problems/too-many-requests", "Too many requests")
            }
            Self::Busy => (Status::SERVICE_UNAVAILABLE, "/problems/busy", "Busy"),
            Self::DeadlineExceeded { .. } | Self::Interrupted => {
                (Status::GATEWAY_TIMEOUT, "/problems/deadline-exceeded", "Out of time")
            }
            Self::Internal => (Status::INTERNAL_SERVER_ERROR, "/problems/internal", "Internal error"),
        }
    }

    /// The fields at fault.
    fn fields(&self) -> Vec<FieldError> {
        let one = |pointer: &str, detail: String| vec![FieldError { pointer: pointer.to_owned(), detail }];
        match self {
            Self::Invalid(faults) => {
                let told = faults.iter().take(MOST_FAULTS).cloned();
                let rest = || Fault::new("", format!("there are more faults than these {MOST_FAULTS}"));
                let rest = (faults.len() > MOST_FAULTS).then(rest);
                told.chain(rest).map(|Fault { pointer, detail }| FieldError { pointer, detail }).collect()
            }
            Self::TooManyRows { limit, pointer } => one(
                pointer,
                format!("would give more than the {limit} rows allowed; ask for fewer, for example with count"),
            ),
            Self::NoMemory { rows } => one(
                "/output",
                format!("gives {rows} rows, more than there is memory for; ask for fewer, for example with count"),
            ),
            Self::Flight(SimulationError::Singularity { .. }) => {
                one("/solver/formulation", "use \"cartesian\", which has no such singularity".to_owned())
            }
            Self::Flight(SimulationError::NothingLeft { .. }) => {
                one("/events", "switch the thrust off by an event, or say how much propellant there is".to_owned())
            }
            Self::Flight(SimulationError::NoDirection { event, .. }) => one(
                &format!("/events/{event}/then/thrust/along"),
                "switch the thrust off or end the flight before the vehicle is at rest or there, for example where the speed falls through \
                 0; or give a direction that there is at rest, \"radial\" or an inertial one"
                    .to_owned(),
            ),
            Self::Flight(SimulationError::Chatter { switch, .. }) => {
                let advice =
                    "let the angle change along a line (\"interpolation\": \"linear\"), or against another quantity";
                match switch {
                    Switch::BankAngle => one("/control/bank_angle", advice.to_owned()),
                    Switch::AngleOfAttack => one("/control/angle_of_attack", advice.to_owned()),
                    _ => Vec::new(),
                }
            }
            _ => Vec::new(),
        }
    }
}

impl From<Refusal> for ApiError {
    fn from(refusal: Refusal) -> Self {
        match refusal {
            Refusal::Full => Self::Busy,
            Refusal::Share => Self::TooManyRequests { seconds: 1 },
        }
    }
}

/// How many faults there are, as far as they were counted.
fn counted(faults: &[Fault]) -> String {
    match faults.len() {
        1 => "1 fault".to_owned(),
        count if count <= MOST_FAULTS => format!("{count} faults"),
        _ => format!("more than {MOST_FAULTS} faults"),
    }
}

/// How a request ended, in a word, for those who count: kept beside the response.
#[derive(Clone, Copy, Debug)]
pub struct Outcome(pub &'static str);

impl ApiError {
    /// The last part of the problem's `type`.
    pub fn outcome(&self) -> &'static str {
        let (_, kind, _) = self.class();
        kind.rsplit('/').next().unwrap_or(kind)
    }
}

impl IntoResponse for ApiError {
    fn into_response(self) -> Response {
        let (status, ..) = self.class();
        let body = self.problem().to_json();
        let mut response = (status, [(header::CONTENT_TYPE, "application/problem+json")], body).into_response();
        response.extensions_mut().insert(Outcome(self.outcome()));
        if let Self::UnsupportedCoding(_) = self {
            response.headers_mut().insert(header::ACCEPT_ENCODING, HeaderValue::from_static("gzip, zstd"));
        }
        let retry_after = match self {
            Self::Busy => Some(1),
            Self::TooManyRequests { seconds } => Some(seconds),
            _ => None,
        };
        if let Some(seconds) = retry_after {
            response.headers_mut().insert(header::RETRY_AFTER, HeaderValue::from(seconds));
        }
        response
    }
}
