//! Every number at the ends of its range, just outside them, and as large as numbers get.

use std::time::Duration;

use axum::http::StatusCode;
use reentry_service::config::Config;
use reentry_tests::service::{Answer, Service};
use serde_json::{Value, json};

use super::fields::{Field, Kind, Range, fields};
use super::refusal::{Steady, problem};
use super::requests::{capsule, conversion, flight, state, with, with_all};

/// The numbers with their ranges, angles once in each unit.
fn numbers() -> Vec<(Field, Range)> {
    let mut numbers = Vec::new();
    for mut field in fields() {
        match field.kind {
            Kind::Number(range) | Kind::NumberOrNull(range) | Kind::NumberOrNumbers(range) => {
                numbers.push((field, range));
            }
            Kind::Angle(range) | Kind::Command(range) => {
                field.request = with(&field.request, "/angle_unit", "deg");
                numbers.push((field, range.in_degrees()));
            }
            _ => {}
        }
    }
    let radians = |field: Field| match field.kind {
        Kind::Angle(range) | Kind::Command(range) => Some((field, range)),
        _ => None,
    };
    numbers.extend(fields().into_iter().filter_map(radians));
    numbers
}

/// Whether a field may hold a number.
fn is_number(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Number(_)
            | Kind::NumberOrNull(_)
            | Kind::NumberOrNumbers(_)
            | Kind::Angle(_)
            | Kind::Command(_)
            | Kind::SiderealTime
            | Kind::Whole
    )
}

#[tokio::test]
async fn a_value_just_outside_its_range_is_refused() {
    let steady = Steady::new().await;
    let mut count = 0;
    for (field, range) in numbers() {
        for value in range.beyond() {
            let request = with(&field.request, &field.pointer, value);
            let radians =
                matches!(field.kind, Kind::Angle(_) | Kind::Command(_)) && field.request["angle_unit"] == "rad";
            let phrase = if radians { "for degrees, set" } else { "must be " };
            steady.refused_at(field.path, &request, &[(&field.pointer, phrase)]).await;
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

/// Whether the answer says that the field is out of its own range, whatever its neighbours.
fn out_of_range(answer: &Answer, pointer: &str) -> bool {
    let out_of_range = |error: &Value| {
        let detail = error["detail"].as_str().unwrap();
        // Where the centre lies, the planet says, and above what a ceiling lies, the stop altitude.
        let by_neighbours = ["the planet's centre", "the stop altitude"].iter().any(|whose| detail.contains(whose));
        error["pointer"] == pointer && detail.starts_with("must be ") && !by_neighbours
    };
    answer.status != StatusCode::OK && answer.json()["errors"].as_array().into_iter().flatten().any(out_of_range)
}

/// What is wrong with an answer, if it is neither a complete one nor a refusal.
fn unsound(answer: &Answer) -> Option<String> {
    let text = String::from_utf8_lossy(&answer.body);
    match answer.status {
        StatusCode::OK => {
            // Not a number and infinity are written as null, which only these may be; without elements all of them are.
            let mut answer = answer.json();
            let bound = ["/derived/apoapsis_radius", "/derived/period", "/derived/mean_anomaly"];
            let elements = ["/orbital_elements", "/derived/semi_latus_rectum", "/derived/periapsis_radius"];
            let has_elements = !answer["orbital_elements"].is_null();
            for pointer in bound.into_iter().chain(elements.into_iter().filter(|_| !has_elements)) {
                if let Some(value) = answer.pointer_mut(pointer) {
                    *value = json!(0);
                }
            }
            // From a vertical start there is no way to count along.
            for place in ["/initial_state", "/final_state", "/trajectory"] {
                for name in ["downrange", "crossrange"] {
                    if let Some(value) = answer.pointer_mut(&format!("{place}/{name}")) {
                        *value = json!(0);
                    }
                }
            }
            // A derivative and a share may be none.
            for place in ["/sensitivities", "/covariance"] {
                if let Some(value) = answer.pointer_mut(place) {
                    *value = json!(0);
                }
            }
            // What a search does not come to, of requirements and of flights.
            for place in ["/solutions", "/nearest", "/reach", "/bands", "/samples"] {
                if let Some(value) = answer.pointer_mut(place) {
                    *value = json!(0);
                }
            }
            // What a footprint has none of; what it has is finite.
            let extremes = ["crossrange/0", "crossrange/1", "downrange/0", "downrange/1"];
            let of_footprints = extremes.map(|end| format!("/extent/{end}"));
            let of_footprints = of_footprints.into_iter().chain(["/curve", "/landing", "/error"].map(str::to_owned));
            for place in of_footprints {
                if let Some(value) = answer.pointer_mut(&place).filter(|value| value.is_null()) {
                    *value = json!(0);
                }
            }
            // What leaves the vehicle leaves no other body.
            if let Some(bodies) = answer.pointer_mut("/bodies").and_then(Value::as_array_mut) {
                for body in bodies {
                    body["parent"] = json!(0);
                    // Its first phase begins with it.
                    if let Some(from) = body.pointer_mut("/phases/0/from") {
                        *from = json!(0);
                    }
                }
            }
            // The first phase begins with the flight, and not with an event.
            if let Some(value) = answer.pointer_mut("/phases/0/from") {
                *value = json!(0);
            }
            answer.to_string().contains("null").then(|| text.to_string())
        }
        // A field is called inflation_time.
        StatusCode::UNPROCESSABLE_ENTITY if text.contains("NaN") || text.replace("inflation", "").contains("inf") => {
            Some(text.to_string())
        }
        StatusCode::UNPROCESSABLE_ENTITY | StatusCode::GATEWAY_TIMEOUT => {
            problem(answer);
            None
        }
        status => Some(format!("{status}: {text}")),
    }
}

/// Fails if there are any, with a line for each.
fn none_of(failures: &[String]) {
    let lines: Vec<_> = failures.iter().map(|failure| failure.chars().take(900).collect::<String>()).collect();
    assert!(failures.is_empty(), "{} unsound answers:\n{}", failures.len(), lines.join("\n"));
}

#[tokio::test]
async fn the_limits_of_a_range_belong_to_it() {
    let service = Service::new();
    let mut failures = Vec::new();
    for (field, range) in numbers() {
        for value in range.ends() {
            // The sign of the semi-major axis goes with the eccentricity: a matter of both fields.
            if !(field.pointer.ends_with("/semi_major_axis") && value < 0.0) {
                let mut request = with(&field.request, &field.pointer, value);
                if field.pointer == "/planet/polar_radius" {
                    // A planet must not be too flat for the other radius either.
                    request = with(&request, "/planet/equatorial_radius", value);
                }
                let answer = service.post(field.path, &request).await;
                let what = format!("{} {} {value:e}", field.path, field.pointer);
                failures.extend(unsound(&answer).map(|answer| format!("{what}: {answer}")));
                assert!(!out_of_range(&answer, &field.pointer), "{what}: {}", answer.json());
            }
        }
    }
    none_of(&failures);
}

#[tokio::test]
async fn huge_and_tiny_numbers_give_an_answer_or_a_refusal() {
    // Some of these flights take the greatest number of steps, of which this test need not wait for the end.
    let service = Service::with(Config { deadline: Duration::from_millis(500), ..Config::default() });
    let mut values = vec![0.0, 5e-324, 1e-300, 1e-200, 1e-100, 1e-30, 1e30, 1e100, 1e155, 1e200, 1e300, f64::MAX];
    values.extend(values.clone().into_iter().map(|value| -value));
    let mut failures = Vec::new();
    for field in fields() {
        if is_number(field.kind) {
            for value in &values {
                let answer = service.post(field.path, &with(&field.request, &field.pointer, *value)).await;
                let what = format!("{} {} {value:e}", field.path, field.pointer);
                failures.extend(unsound(&answer).map(|answer| format!("{what}: {answer}")));
            }
        }
    }
    none_of(&failures);
}

#[tokio::test]
async fn vectors_of_any_size_give_an_answer_or_a_refusal() {
    let service = Service::with(Config { deadline: Duration::from_millis(500), ..Config::default() });
    let sizes = [0.0, 5e-324, 1e-200, 1e-9, 1.0, 1e6, 1e12, 1e155, f64::MAX];
    let mut failures = Vec::new();
    for kind in ["ecef", "eci"] {
        for position in sizes {
            for velocity in sizes {
                let mut state = state(kind);
                state["position"] = json!([position, -position, position / 2.0]);
                state["velocity"] = json!([velocity, velocity, -velocity]);
                let flown =
                    with_all(&flight(kind), [("/initial_state", state.clone()), ("/stop/altitude", json!(-6.3e6))]);
                for (path, request) in [("/convert", with(&conversion(kind), "/state", state)), ("/simulate", flown)] {
                    let answer = service.post(path, &request).await;
                    let what = format!("{path} {kind} {position:e} m, {velocity:e} m/s");
                    failures.extend(unsound(&answer).map(|answer| format!("{what}: {answer}")));
                }
            }
        }
    }
    none_of(&failures);
}

#[tokio::test]
async fn numbers_that_no_f64_holds_are_not_json() {
    let steady = Steady::new().await;
    let digits = "9".repeat(400);
    for field in fields() {
        if is_number(field.kind) {
            let text = with(&field.request, &field.pointer, "HERE").to_string();
            for number in ["1e999", "-1e999", &digits] {
                let problem = steady.refused_text(field.path, text.replace("\"HERE\"", number)).await;
                assert_eq!(problem["type"], "/problems/invalid-json");
                let detail = problem["detail"].as_str().unwrap();
                assert!(detail.contains("number out of range at line 1 column "), "{detail}");
            }
        }
    }
}

#[tokio::test]
async fn words_for_what_is_not_finite_are_not_json() {
    let steady = Steady::new().await;
    let text = with(&capsule(), "/vehicle/mass", "HERE").to_string();
    for word in ["NaN", "Infinity", "-Infinity", "nan", "inf", "1e", "0x10", "+1", ".5", "1.", "01", "1_000"] {
        let problem = steady.refused_text("/simulate", text.replace("\"HERE\"", word)).await;
        assert_eq!(problem["type"], "/problems/invalid-json", "{word}");
    }
}

#[tokio::test]
async fn elements_of_times_are_not_negative() {
    let steady = Steady::new().await;
    let request = with(&capsule(), "/output", json!({"times": [-5e-324, 1, 2]}));
    steady.refused_at("/simulate", &request, &[("/output/times/0", "must be at least 0, got -5e-324")]).await;
}

#[tokio::test]
async fn components_of_vectors_lie_within_their_bounds() {
    let steady = Steady::new().await;
    let fast = with(&conversion("ecef"), "/state/velocity/1", 1e6_f64.next_up());
    steady.refused_at("/convert", &fast, &[("/state/velocity/1", "must be between -1000000 and 1000000")]).await;
    for kind in ["ecef", "eci"] {
        for (index, value) in [(0, 1e12_f64.next_up()), (1, -1e300), (2, (-1e12_f64).next_down())] {
            let at = format!("/state/position/{index}");
            let request = with(&conversion(kind), &at, value);
            steady.refused_at("/convert", &request, &[(&at, "must be between -1e12 and 1e12")]).await;
        }
    }
}
