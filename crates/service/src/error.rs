//! Every way in which a request fails: the one table from faults to status and problem document.

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use reentry::motion::Switch;
use reentry::simulate::{BodyError, SimulationError};
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
    #[error("the path and query string are too long")]
    UriTooLong,
    /// The head of the request is too long.
    #[error("the request head exceeds 16384 bytes or 100 header fields")]
    HeadTooLarge,
    /// The body ended early.
    #[error("the body could not be read: {0}")]
    UnreadableBody(String),
    /// The body did not come in time.
    #[error("the body did not arrive within {seconds} s")]
    BodyTimeout {
        /// The time allowed, s.
        seconds: f64,
    },
    /// The body came too slowly while there was little memory.
    #[error("the body arrived at less than {least} bytes per second, the minimum while the service is low on memory")]
    BodyTooSlow {
        /// The slowest that is waited for, bytes a second.
        least: usize,
    },
    /// There is nothing at this path.
    #[error("no resource at {0}; see /docs/ and /guide/")]
    NotFound(String),
    /// The path does not know the method.
    #[error("{0} does not support this method; see /docs")]
    MethodNotAllowed(String),
    /// None of the representations that the client accepts.
    #[error("the response is available as {offered}, not as {asked:?}")]
    NotAcceptable {
        /// What there is.
        offered: String,
        /// What was asked for.
        asked: String,
    },
    /// The body is too long.
    #[error("the body exceeds the limit of {limit} bytes")]
    PayloadTooLarge {
        /// The limit, bytes.
        limit: usize,
    },
    /// The body is not declared as JSON.
    #[error("content-type must be application/json, got {0}; with curl: -H 'content-type: application/json'")]
    UnsupportedMediaType(String),
    /// The body is in a coding that is not taken.
    #[error("content-encoding must be gzip, zstd or absent, got {0}")]
    UnsupportedCoding(String),
    /// The request is JSON, but not a valid case.
    #[error("{} in the request", counted(.0))]
    Invalid(Vec<Fault>),
    /// More rows than allowed.
    #[error("the trajectory exceeds the limit of {limit} rows")]
    TooManyRows {
        /// The limit.
        limit: usize,
        /// The field that asks for them.
        pointer: &'static str,
    },
    /// An answer that does not fit into the memory for answers.
    #[error("the response exceeds the limit of {limit} bytes of memory; request fewer rows")]
    TooLarge {
        /// The limit, bytes.
        limit: usize,
    },
    /// More rows than there is memory for.
    #[error("the trajectory has {rows} rows, too many for the available memory")]
    NoMemory {
        /// So many.
        rows: u64,
    },
    /// The flight cannot be finished.
    #[error("the flight {}cannot be completed: {}", if .0.body.is_empty() { "" } else { "of a body " }, .0.error)]
    Flight(#[from] BodyError),
    /// The client has sent more requests than it may, or holds as much as it may.
    #[error("this client has reached its request limit; try again in {seconds} s")]
    TooManyRequests {
        /// Until the next is answered, s.
        seconds: u64,
    },
    /// All workers are busy and the queue is full, or the memory is.
    #[error("the service is busy; try again in 1 s")]
    Busy,
    /// The time allowed ran out.
    #[error("the request exceeded the time limit of {seconds} s")]
    DeadlineExceeded {
        /// The time allowed, s.
        seconds: f64,
    },
    /// Nobody waits for the answer any more.
    #[error("the request was cancelled")]
    Interrupted,
    /// A fault of the service.
    #[error("the service failed on this request; find its x-request-id in the log")]
    Internal,
}

/// Problem document (RFC 9457).
#[derive(Debug, Serialize, ToSchema)]
pub struct Problem {
    /// Type of the problem: a stable path.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Type of the problem, for people.
    pub title: &'static str,
    /// HTTP status code.
    pub status: u16,
    /// Explanation of this problem, for people.
    pub detail: String,
    /// Fields with problems, at most 100. If there are more, a last entry without a pointer says so.
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

/// Problem with one field.
#[derive(Debug, Serialize, ToSchema)]
pub struct FieldError {
    /// JSON pointer of the field (RFC 6901).
    pub pointer: String,
    /// Explanation of the problem, with the valid values.
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
            UnknownShares,
        };
        use StatusCode as Status;
        match self {
            Self::NotJson(_) | Self::CaseNotJson(_) => (Status::BAD_REQUEST, "/problems/invalid-json", "Not JSON"),
            Self::BadQuery(_) => (Status::BAD_REQUEST, "/problems/invalid-query", "Invalid query string"),
            Self::MalformedRequest(_) => (Status::BAD_REQUEST, "/problems/malformed-request", "Malformed request"),
            Self::UriTooLong => (Status::URI_TOO_LONG, "/problems/uri-too-long", "Path too long"),
            Self::HeadTooLarge => {
                (Status::REQUEST_HEADER_FIELDS_TOO_LARGE, "/problems/head-too-large", "Request head too large")
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
            Self::Invalid(_) => (Status::UNPROCESSABLE_ENTITY, "/problems/invalid-case", "Case not valid"),
            Self::TooManyRows { .. } | Self::NoMemory { .. } => {
                (Status::UNPROCESSABLE_ENTITY, "/problems/row-limit", "Too many rows")
            }
            Self::TooLarge { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/answer-too-large", "Answer too large"),
            Self::Flight(BodyError { error, .. }) => match error {
                StepLimit { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/step-limit", "Too many steps"),
                Singularity { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/singularity", "Singular equations"),
                TooStiff { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/step-size", "Too stiff to integrate"),
                Chatter { .. } => {
                    (Status::UNPROCESSABLE_ENTITY, "/problems/chattering-schedule", "Chattering schedule")
                }
                NothingLeft { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/no-mass-left", "No mass left"),
                NoDirection { .. } => {
                    (Status::UNPROCESSABLE_ENTITY, "/problems/no-direction", "Thrust without direction")
                }
                UnknownShares { .. } => {
                    (Status::UNPROCESSABLE_ENTITY, "/problems/unknown-shares", "Unknown shares of propellant")
                }
                Overflow { .. } => (Status::UNPROCESSABLE_ENTITY, "/problems/overflow", "Loads out of range"),
                NoRoom { .. } => (Status::SERVICE_UNAVAILABLE, "/problems/busy", "Busy"),
                Interrupted { .. } => (Status::GATEWAY_TIMEOUT, "/problems/deadline-exceeded", "Time limit exceeded"),
            },
            Self::TooManyRequests { .. } => {
                (Status::TOO_MANY_REQUESTS, "/problems/too-many-requests", "Too many requests")
            }
            Self::Busy => (Status::SERVICE_UNAVAILABLE, "/problems/busy", "Busy"),
            Self::DeadlineExceeded { .. } | Self::Interrupted => {
                (Status::GATEWAY_TIMEOUT, "/problems/deadline-exceeded", "Time limit exceeded")
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
                let rest = || Fault::new("", format!("more than {MOST_FAULTS} problems; the others are not listed"));
                let rest = (faults.len() > MOST_FAULTS).then(rest);
                told.chain(rest).map(|Fault { pointer, detail }| FieldError { pointer, detail }).collect()
            }
            Self::TooManyRows { limit, pointer } => {
                one(pointer, format!("gives more than {limit} rows; request fewer, for example with count"))
            }
            Self::NoMemory { rows } => one(
                "/output",
                format!("gives {rows} rows, too many for the available memory; request fewer, for example with count"),
            ),
            Self::Flight(error) => fields_of_flight(error),
            _ => Vec::new(),
        }
    }
}

impl From<SimulationError> for ApiError {
    fn from(error: SimulationError) -> Self {
        Self::Flight(error.into())
    }
}

/// The field at fault where a flight cannot be finished: of a body that of its separation, or one below it.
fn fields_of_flight(BodyError { body, error }: &BodyError) -> Vec<FieldError> {
    let separation = body.iter().map(|(event, separation)| format!("/events/{event}/then/separate/{separation}"));
    let separation = separation.collect::<Vec<_>>().concat();
    let (pointer, advice) = match error {
        SimulationError::Singularity { .. } => {
            ("/solver/formulation".to_owned(), "use \"cartesian\", which has no such singularity")
        }
        SimulationError::NothingLeft { .. } => {
            (format!("{separation}/events"), "switch the thrust off with an event, or set its propellant")
        }
        SimulationError::NoDirection { event, .. } => (
            format!("{separation}/events/{event}/then/thrust/along"),
            "switch the thrust off or end the flight when the vehicle comes to rest or before, for example where the \
             speed falls through 0; or use a direction that is defined at rest, \"radial\" or an inertial one",
        ),
        SimulationError::Chatter { switch: switch @ (Switch::BankAngle | Switch::AngleOfAttack), .. } => {
            let command = if *switch == Switch::BankAngle { "bank_angle" } else { "angle_of_attack" };
            let advice = "use \"interpolation\": \"linear\", or another quantity in \"against\"";
            (format!("{separation}/control/{command}"), advice)
        }
        _ if body.is_empty() => return Vec::new(),
        error => return vec![FieldError { pointer: separation, detail: error.to_string() }],
    };
    vec![FieldError { pointer, detail: advice.to_owned() }]
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
        1 => "1 problem".to_owned(),
        count if count <= MOST_FAULTS => format!("{count} problems"),
        _ => format!("more than {MOST_FAULTS} problems"),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_that_fails_is_told_by_its_separation() {
        let at = |body: &[(usize, usize)], error| ApiError::Flight(BodyError { body: body.to_vec(), error }).problem();
        let limit = SimulationError::StepLimit { time: 1.0, limit: 10 };
        assert!(at(&[], limit).errors.is_empty());
        let problem = at(&[(3, 0), (1, 2)], limit);
        assert_eq!(problem.errors[0].pointer, "/events/3/then/separate/0/events/1/then/separate/2");
        assert_eq!(problem.errors[0].detail, limit.to_string());
        assert_eq!(problem.detail, format!("the flight of a body cannot be completed: {limit}"));
        let rest = SimulationError::NoDirection { event: 4, time: 1.0, altitude: 0.0 };
        assert_eq!(at(&[(3, 0)], rest).errors[0].pointer, "/events/3/then/separate/0/events/4/then/thrust/along");
        let pole = SimulationError::Singularity { time: 1.0, at: reentry::motion::Singularity::Pole };
        assert_eq!(at(&[(3, 0)], pole).errors[0].pointer, "/solver/formulation");
    }
}
