//! What all searches have in common: their case, the flights that they took, and what they tell of one.

use reentry::trajectory::{Termination as CoreTermination, Trajectory};
use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;

use super::bodies::FlownBody;
use super::columns::Row;
use super::description::Object;
use super::numbers::Numbers;
use super::reader::{Fault, NumberField};
use super::scenario::SimulateRequest;
use super::trajectory::{EventReport, FlightReport, Peaks, Termination};
use super::vary::{MOST_IN_SEARCH, VariedNumber, Vary};

/// The case of a search, which asks for flights alone.
pub(super) fn without_analyses(object: &mut Object) {
    object.condition(|| {
        let never = json!({"const": false});
        json!({"if": {"type": "object"}, "then": {"properties": {"sensitivities": never, "verify": never, "dispersions": {"maxItems": 0}}}})
    });
}

/// The case of a search, with its numbers and those that vary.
pub(super) struct CaseOfSearch {
    /// As a request of `/simulate`.
    pub(super) tree: Value,
    pub(super) numbers: Numbers,
    pub(super) varied: Vec<VariedNumber>,
    /// What is wrong with the case, and with what varies.
    pub(super) faults: Vec<Fault>,
}

impl CaseOfSearch {
    /// That of a request whose field `vary` is a list; as [`CaseOfSearch::new`] has it.
    pub(super) fn of_list(
        request: &SimulateRequest,
        read: (&Value, Vec<NumberField>),
        others: &[&str],
        vary: &[Vary],
    ) -> Self {
        let vary: Vec<_> = vary.iter().enumerate().map(|(index, it)| (format!("/vary/{index}"), it)).collect();
        let mut case = Self::new(request, read, others, &vary, &[]);
        if case.varied.len() > MOST_IN_SEARCH {
            let detail = format!("must point to at most {MOST_IN_SEARCH} numbers in total, got {}", case.varied.len());
            case.faults.push(Fault::new("/vary", detail));
        }
        case
    }

    /// That of a request that was read, whose numbers are given as `fields`. `others`: its fields that are not of the case; `vary`: what varies, each
    /// with its place in the request; `pointers`: those of more numbers that the search sets.
    pub(super) fn new(
        request: &SimulateRequest,
        (whole, fields): (&Value, Vec<NumberField>),
        others: &[&str],
        vary: &[(String, &Vary)],
        pointers: &[&str],
    ) -> Self {
        let mut faults = request.analyses_faults();
        faults.extend(request.try_into_scenario().err().unwrap_or_default());
        let tree = case_alone(whole, others);
        let of_vary = vary.iter().flat_map(|(_, vary)| vary.pointers());
        let pointers: Vec<_> = of_vary.chain(pointers.iter().copied()).collect();
        let numbers = Numbers::new(tree.clone(), fields, &pointers, None, |_| None);
        let varied = Vary::resolve(vary, &numbers, request.angle_unit);
        let varied = varied.map_err(|of_vary| faults.extend(of_vary)).unwrap_or_default();
        Self { tree, numbers, varied, faults }
    }
}

/// A request without what is no part of its case.
fn case_alone(tree: &Value, others: &[&str]) -> Value {
    let mut case = tree.clone();
    if let Some(fields) = case.as_object_mut() {
        for name in others {
            fields.shift_remove(*name);
        }
    }
    case
}

/// Flights of a search.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct FlightsOfSearch {
    /// Number of flights.
    pub flights: u64,
    /// Flights that failed, by the type of the problem.
    pub failed: Vec<FailedFlights>,
    /// Computing time, s.
    pub elapsed: f64,
}

/// How flights ended, each way once, in the order in which they came.
pub(super) fn classes(ends: &[CoreTermination]) -> Vec<Termination> {
    let mut classes = Vec::new();
    for end in ends.iter().map(|end| Termination::from(*end)) {
        if !classes.contains(&end) {
            classes.push(end);
        }
    }
    classes
}

/// Flights that failed for the same reason.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct FailedFlights {
    /// Type of the problem.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Number of flights.
    pub count: u64,
}

/// End, events and peaks of a flight.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct FlightSummary {
    /// How the flight ended.
    pub termination: Termination,
    /// Index in `stop.when` of the condition that ended the flight, from 0; present if a condition ended it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub stop_condition: Option<usize>,
    /// State at the end, after the events at that instant.
    pub final_state: Row,
    /// Greatest values over the flight.
    pub peaks: Peaks,
    /// Events that happened, in order; present if the request has events.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub events: Option<Vec<EventReport>>,
}

impl FlightSummary {
    /// That of the flight of a request.
    pub fn new(request: &SimulateRequest, flight: &Trajectory) -> Self {
        let report = FlightReport::new(request, &FlownBody::vehicle(request, flight), None);
        let FlightReport { termination, condition, final_state, peaks, events, .. } = report;
        Self { termination, stop_condition: condition, final_state, peaks, events }
    }
}
