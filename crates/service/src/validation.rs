//! The reference cases, built into the program and flown as its users fly theirs: what is expected, and what comes out.

pub mod cases;
pub mod flights;
pub mod nesc;

mod corridors;
mod frames;
mod number;
mod report;
mod standard_air;
mod theories;
mod thesis;

use std::borrow::Borrow;
use std::sync::atomic::AtomicBool;

use reentry::Interrupt;
use reentry::simulate::{BodyError, SimulationError};
use serde::Serialize;
use serde_json::Value;
use utoipa::ToSchema;

use crate::answer::{self, Answer};
use crate::error::ApiError;
use crate::format::Format;
use crate::wire::json;

/// Results of the built-in reference cases.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Validation {
    /// Version of the service.
    pub version: &'static str,
    /// Whether every check of kind `reference` passed.
    pub passed: bool,
    /// Checks, ordered by group and case.
    pub checks: Vec<Check>,
}

/// Comparison of one computed number with its reference value.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Check {
    /// Group of cases.
    pub group: Group,
    /// Name of the case in its source.
    pub case: String,
    /// Compared quantity.
    pub quantity: String,
    /// Unit of the four numbers; empty for dimensionless numbers.
    pub unit: String,
    /// Reference value; 0 if the compared number is a distance from the reference.
    pub expected: f64,
    /// Computed value; null if the program gives none.
    #[schema(required = true)]
    pub got: Option<f64>,
    /// Computed minus reference value; null if there is no computed value.
    #[schema(required = true)]
    pub difference: Option<f64>,
    /// Allowed magnitude of the difference or, for a plausibility, the published uncertainty; null if none is
    /// published.
    #[schema(required = true)]
    pub allowed: Option<f64>,
    /// Kind of check.
    pub kind: Kind,
    /// Whether the difference is within `allowed`; null for a plausibility.
    #[schema(required = true)]
    pub passed: Option<bool>,
    /// Source of the reference value.
    pub source: String,
    /// Reason for the allowed difference, and assumptions made.
    pub note: String,
    /// Differences below are roundings, which differ from machine to machine and are not told in a text.
    #[serde(skip)]
    rounding: f64,
}

/// Group of cases. `thesis`: the seven cases of the thesis. `conversions`: the initial conditions that the thesis
/// prints. `theories`: the closed-form theories of the thesis compared with flights. `check_cases`: NASA's check cases.
/// `standard_air`: the U.S. Standard Atmosphere, 1976. `frames`: coordinates and orbital elements. `bodies`: entries at
/// planets, compared with another program. `flights`: real entries. `corridors`: entry corridors, compared with another
/// program and with an approximate theory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// The thesis's seven cases.
    Thesis,
    /// The initial conditions that the thesis prints.
    Conversions,
    /// The thesis's closed forms beside the flight.
    Theories,
    /// NASA's check cases.
    CheckCases,
    /// The U.S. Standard Atmosphere, 1976.
    StandardAir,
    /// Coordinates and orbital elements.
    Frames,
    /// Launches and separations, as closed forms have them.
    Ascents,
    /// Entries at planets, as another program flies them.
    Bodies,
    /// Flights that were flown.
    Flights,
    /// Entry corridors, as another program and an approximate theory have them.
    Corridors,
}

/// Kind of check. `reference`: all inputs are known; a difference greater than allowed is a failure. `plausibility`:
/// some inputs are assumed or were not measured, or the reference is approximate; the difference is reported and never a
/// failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// All is known that the result depends on: a difference greater than allowed is a fault.
    Reference,
    /// Something had to be assumed, was not measured, or is approximate: the difference is told, and never a fault.
    Plausibility,
}

impl Validation {
    /// Flies every case; `interrupt` ends that early.
    ///
    /// # Errors
    /// When interrupted.
    pub fn run(interrupt: &dyn Interrupt) -> Result<Self, ApiError> {
        let program = Program { interrupt };
        let cases = cases::thesis_cases();
        let groups = [
            thesis::flights(program, &cases)?,
            thesis::conversions(&cases),
            theories::checks(program, &cases)?,
            nesc::checks(program)?,
            standard_air::checks(program)?,
            frames::checks(),
            flights::checks(program)?,
            corridors::checks(program)?,
        ];
        Ok(Self::of(groups.concat()))
    }

    fn of(checks: Vec<Check>) -> Self {
        let passed = !checks.iter().any(Check::is_miss);
        Self { version: env!("CARGO_PKG_VERSION"), passed, checks }
    }

    /// As JSON, on one line.
    ///
    /// # Errors
    /// Never: all of it is text and numbers.
    pub fn to_json(&self) -> Result<Vec<u8>, serde_json::Error> {
        serde_json::to_vec(self)
    }

    /// The checks that did not pass.
    pub fn misses(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(|check| check.is_miss())
    }
}

impl Check {
    /// Whether it counts, and did not pass.
    pub fn is_miss(&self) -> bool {
        self.passed == Some(false)
    }

    /// The difference in parts of what is allowed; 0 where it is no more than rounding, and beyond all limits where there is none.
    fn share(&self) -> f64 {
        match (self.difference.map(f64::abs), self.allowed) {
            (Some(difference), _) if difference <= self.rounding => 0.0,
            (Some(difference), Some(allowed)) => difference / allowed,
            _ => f64::INFINITY,
        }
    }
}

/// A number that is known from elsewhere.
#[derive(Clone, Copy, Debug)]
struct Expected {
    value: f64,
    allowed: Option<f64>,
    rounding: f64,
}

impl Expected {
    /// A number that may be missed by so much.
    fn within(value: f64, allowed: f64) -> Self {
        Self { value, allowed: Some(allowed), rounding: 1e-4 * allowed }
    }

    /// The same, of which differences below this are roundings.
    fn rounding(self, rounding: f64) -> Self {
        Self { rounding, ..self }
    }
}

/// Where expectations come from.
#[derive(Clone, Debug)]
struct Origin {
    group: Group,
    case: String,
    source: String,
    note: String,
}

impl Origin {
    /// Compares what is expected with what the program got.
    fn check(&self, quantity: impl Into<String>, unit: &str, expected: Expected, got: f64) -> Check {
        let check = self.beside(quantity, unit, expected, got);
        // A number that is none is within nothing.
        let passed = check.difference.zip(check.allowed).is_some_and(|(off, allowed)| off.abs() <= allowed);
        Check { kind: Kind::Reference, passed: Some(passed), ..check }
    }

    /// Sets what is published beside what the program got.
    fn beside(&self, quantity: impl Into<String>, unit: &str, expected: Expected, got: f64) -> Check {
        let finite = |number: f64| number.is_finite().then_some(number);
        let Self { group, case, source, note } = self.clone();
        Check {
            group,
            case,
            quantity: quantity.into(),
            unit: unit.to_owned(),
            expected: expected.value,
            got: finite(got),
            difference: finite(got - expected.value),
            allowed: expected.allowed,
            kind: Kind::Plausibility,
            passed: None,
            source,
            note,
            rounding: expected.rounding,
        }
    }
}

/// The check that comes nearest to its limit, or is beyond it furthest; the first of equals.
fn nearest<C: Borrow<Check>>(checks: impl IntoIterator<Item = C>) -> Option<C> {
    let share = |check: &C| check.borrow().share();
    checks.into_iter().reduce(|nearest, check| if share(&check) > share(&nearest) { check } else { nearest })
}

/// The program as its users see it: a request in JSON goes in, its answer in JSON comes out.
#[derive(Clone, Copy, Debug)]
struct Program<'a> {
    interrupt: &'a dyn Interrupt,
}

impl Program<'_> {
    /// Rows that a flight may have.
    const ROW_LIMIT: usize = 100_000;

    fn simulate(self, request: Value) -> Result<Value, ApiError> {
        answered(answer::simulate(request, Format::Json, Self::ROW_LIMIT, self.interrupt))
    }

    fn corridor(self, request: Value) -> Result<Value, ApiError> {
        answered(answer::corridor(request, self.interrupt))
    }

    fn analytic(self, request: Value) -> Result<Value, ApiError> {
        answered(answer::analytic(request, Format::Json, Self::ROW_LIMIT, self.interrupt))
    }
}

/// The answer to a state, in every coordinate system; null where there is none.
fn convert(request: Value) -> Value {
    answered(answer::convert(request, &AtomicBool::new(false))).unwrap_or_default()
}

/// The tree of an answer; null where there is none, in which no check finds what it expects.
fn answered(result: Result<Answer, ApiError>) -> Result<Value, ApiError> {
    match result {
        Err(
            error @ (ApiError::Interrupted
            | ApiError::Flight(BodyError { error: SimulationError::Interrupted { .. }, .. })),
        ) => Err(error),
        result => Ok(result.ok().and_then(|answer| json::parse(&answer.body).ok()).unwrap_or_default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn origin() -> Origin {
        Origin {
            group: Group::Frames,
            case: "a case".to_owned(),
            source: "a book".to_owned(),
            note: "to the digit".to_owned(),
        }
    }

    fn check(expected: f64, allowed: f64, got: f64) -> Check {
        origin().check("a length", "m", Expected::within(expected, allowed), got)
    }

    #[test]
    fn what_differs_by_no_more_than_is_allowed_passes() {
        for (got, passes) in
            [(10.0, true), (10.5, true), (9.5, true), (10.500_001, false), (9.499_999, false), (-10.0, false)]
        {
            let check = check(10.0, 0.5, got);
            assert_eq!((check.passed, check.difference), (Some(passes), Some(got - 10.0)), "{got}");
            assert_eq!(Validation::of(vec![check]).passed, passes);
        }
    }

    #[test]
    fn what_is_no_number_passes_nowhere() {
        let [none, infinite] = [f64::NAN, f64::INFINITY];
        for (expected, allowed, got) in [
            (1.0, 1.0, none),
            (1.0, 1.0, infinite),
            (none, 1.0, 1.0),
            (1.0, none, 1.0),
            (infinite, 1.0, infinite),
            (1.0, none, none),
        ] {
            assert!(check(expected, allowed, got).is_miss(), "{expected}, {allowed}, {got}");
        }
        assert_eq!(check(1.0, 1.0, none).got, None);
    }

    #[test]
    fn one_miss_is_a_miss_of_all_and_is_told() {
        let validation =
            Validation::of(vec![check(10.0, 0.5, 10.0), check(10.0, 0.5, 12.0), check(10.0, 0.5, f64::NAN)]);
        assert!(!validation.passed);
        let told: Vec<_> = validation.misses().map(Check::told).collect();
        let [far, none] = ["got 12.0 m, difference 2 m", "got -, difference -"];
        assert_eq!(told, [far, none].map(|got| format!("a case, a length: expected 10.0 m, {got}, allowed 0.5 m")));
        let text = validation.to_text();
        assert_eq!(text.matches("FAILED").count(), 2, "{text}");
        assert!(text.ends_with(
            "3 checks against references: 2 failed. 0 comparisons with real flights and approximations, for information only.\n"
        ));
        // The line of the case is of the one that is furthest from what is expected.
        assert!(validation.to_markdown().contains("| a case | 3 | a length | 10.0 m | - | - | 0.5 m | 1 |"));
    }

    #[test]
    fn a_plausibility_does_not_count() {
        let far = origin().beside("a length", "m", Expected::within(10.0, 0.5), 20.0);
        assert_eq!((far.difference, far.passed), (Some(10.0), None));
        assert!(Validation::of(vec![far]).passed);
    }

    #[test]
    fn a_case_that_is_not_answered_misses_and_one_that_is_interrupted_ends_all() {
        let program = |interrupt| Program { interrupt };
        let [goes_on, raised] = [AtomicBool::new(false), AtomicBool::new(true)];
        assert_eq!(program(&goes_on).simulate(Value::Null).unwrap(), Value::Null);
        assert!(nesc::checks(program(&raised)).is_err());
    }
}
