//! Requests that were made to be expensive, by hand and by search: none gets beyond the flag, and none gets a great answer for many faults.

use std::sync::atomic::AtomicBool;

use reentry_service::answer;
use reentry_service::error::ApiError;
use reentry_service::format::Format;
use serde_json::{Value, json};

use super::requests::{capsule, with, with_all};

/// The limit of the service, bytes.
const BODY_LIMIT: usize = 1 << 20;

fn list(count: u32, entry: impl Fn(u32) -> Value) -> Value {
    (0..count).map(entry).collect()
}

fn numbers(count: u32, first: f64, step: f64) -> Value {
    list(count, |index| json!(first + step * f64::from(index)))
}

fn teeth(count: u32) -> Value {
    list(count, |index| json!(1 + index % 2))
}

/// A flight, with room for what follows.
fn plain() -> Value {
    with_all(&capsule(), [("/stop", json!({})), ("/control", json!({}))])
}

/// Thirty years in orbit at the finest tolerance, and everything that may be asked for beyond the flight.
fn endless(request: &Value) -> Value {
    let orbit = json!({"type": "planet_relative", "altitude": 1e6, "longitude": 0, "geocentric_latitude": 0.4, "speed": 7000,
        "flight_path_angle": 0, "heading": 0.5});
    with_all(
        request,
        [
            ("/initial_state", orbit),
            ("/stop/time", json!(1e9)),
            ("/solver", json!({"relative_tolerance": 1e-14})),
            ("/verify", json!(true)),
            ("/sensitivities", json!(true)),
        ],
    )
}

/// As much of every model as a request may have.
fn models() -> Vec<(&'static str, Value)> {
    let air = json!({"type": "table", "altitude": numbers(10_000, 0.0, 20.0), "density": teeth(10_000),
        "temperature": teeth(10_000), "pressure": teeth(10_000)});
    let wind =
        json!({"type": "table", "altitude": numbers(10_000, 0.0, 20.0), "east": teeth(10_000), "north": teeth(10_000)});
    let layers = list(10_000, |index| json!({"base_altitude": 20 * index, "density": 1e-9, "scale_height": 7000}));
    let by_mach = json!({"type": "mach_table", "mach": numbers(10_000, 0.0, 0.004), "lift_coefficient": teeth(10_000),
        "drag_coefficient": teeth(10_000)});
    let matrix = list(100, |_| teeth(1000));
    let by_both = json!({"type": "alpha_mach_table", "angle_of_attack": numbers(100, -0.5, 0.01),
        "mach": numbers(1000, 0.0, 0.04), "lift_coefficient": matrix, "drag_coefficient": matrix});
    let schedule = |against: &str, step: f64| json!({"type": "schedule", "against": against, "at": numbers(10_000, 0.0, step), "value": teeth(10_000)});
    vec![
        ("tables of air and wind", with_all(&plain(), [("/atmosphere", air), ("/wind", wind)])),
        ("layers", with(&plain(), "/atmosphere", json!({"type": "layered_exponential", "layers": layers}))),
        (
            "schedules, drag by Mach number",
            with_all(
                &plain(),
                [
                    ("/atmosphere", json!({"type": "us76"})),
                    ("/vehicle/aerodynamics", by_mach),
                    ("/control/bank_angle", schedule("altitude", 20.0)),
                    ("/control/angle_of_attack", schedule("time", 0.01)),
                ],
            ),
        ),
        (
            "drag by both",
            with_all(&plain(), [("/atmosphere", json!({"type": "us76"})), ("/vehicle/aerodynamics", by_both)]),
        ),
    ]
}

/// As many events and conditions as there may be.
fn events() -> Vec<(&'static str, Value)> {
    let condition =
        |index: u32, quantity: &str| json!({"quantity": quantity, "falls_through": 5000.0 - 1e-3 * f64::from(index)});
    let at_once = list(1000, |_| {
        json!({"when": {"quantity": "time", "rises_through": 0}, "then": {
            "delta_v": {"along": "normal", "value": 1e-3},
            "thrust": {"along": "radial", "value": 1e-3, "specific_impulse": 300, "propellant": 1e-3},
            "aerodynamics": {"type": "constant", "drag_coefficient": 1}}})
    });
    let in_a_row = list(1000, |index| json!({"when": condition(index, "altitude"), "then": {"mass": 700}}));
    let stops = list(1000, |index| condition(index + 1000, "speed"));
    vec![
        ("events at the start", with(&plain(), "/events", at_once)),
        ("events and stops in a row", with_all(&plain(), [("/events", in_a_row), ("/stop/when", stops)])),
    ]
}

fn fly(request: &Value, is_raised: bool) -> Result<Vec<u8>, ApiError> {
    assert!(request.to_string().len() <= BODY_LIMIT);
    answer::simulate(request.clone(), Format::Json, 100_000, &AtomicBool::new(is_raised)).map(|answer| answer.body)
}

#[test]
fn once_the_flag_is_raised_no_flight_begins() {
    for (name, request) in models().into_iter().chain(events()) {
        let problem = fly(&endless(&request), true).map_err(|error| error.problem());
        let detail = problem.expect_err(name).detail;
        assert_eq!(detail, "the flight cannot be completed: interrupted at t = 0 s", "{name}");
    }
}

/// The work of a flight is counted by its steps, of which there is a limit.
#[test]
fn a_thousand_events_at_one_instant_are_one_turn() {
    let request = with(&events()[0].1, "/output", json!({"trajectory": false}));
    let answer: Value = serde_json::from_slice(&fly(&request, false).unwrap()).unwrap();
    assert_eq!(answer["events"].as_array().map(Vec::len), Some(1000));
    assert!(answer["solver"]["steps"].as_u64().unwrap() < 400, "{}", answer["solver"]);
}

/// A step that passes many values is cut at the first of each quantity; those behind it wait for the steps that follow.
#[test]
fn of_a_thousand_conditions_in_a_row_each_is_met_at_its_value() {
    let values = [("altitude", 119e3, -100.0), ("speed", 7450.0, -20.0), ("flight_path_angle", -0.06, -1e-3)];
    let value = |index: u32| {
        let (quantity, first, step) = values[index as usize % 3];
        (quantity, first + step * f64::from(index / 3))
    };
    let event = |index: u32| {
        let (quantity, value) = value(index);
        json!({"when": {"quantity": quantity, "falls_through": value}})
    };
    let solver = json!({"relative_tolerance": 1e-3});
    let request = with_all(&plain(), [("/events", list(1000, event)), ("/solver", solver)]);
    let answer: Value = serde_json::from_slice(&fly(&request, false).unwrap()).unwrap();
    let happened = answer["events"].as_array().unwrap();
    assert!(happened.len() > 900, "only {} happened", happened.len());
    let indices = || happened.iter().map(|event| u32::try_from(event["index"].as_u64().unwrap()).unwrap());
    for of in 0..3 {
        assert!(indices().filter(|index| index % 3 == of).is_sorted(), "{} is met out of its order", value(of).0);
    }
    assert!(happened.iter().map(|event| event["time"].as_f64().unwrap()).is_sorted());
    for (index, event) in indices().zip(happened) {
        let (quantity, value) = value(index);
        let got = event["state"][quantity].as_f64().unwrap();
        assert!((got - value).abs() < 1e-9 * value.abs().max(1.0), "{quantity} is {got}, not {value}");
    }
}

#[test]
fn however_many_faults_there_are_a_hundred_are_told() {
    let members = |count: u32| (0..count).map(|index| (format!("{index:x}"), json!(0))).collect::<Value>();
    let events = list(1000, |_| json!({"a": 1, "b": 1, "c": 1, "when": {"d": 1}, "then": {"e": 1, "thrust": {}}}));
    let row = || list(1000, |_| Value::Null);
    let matrix = json!({"type": "alpha_mach_table", "angle_of_attack": numbers(100, -0.5, 0.01),
        "mach": numbers(1000, 0.0, 1.0), "lift_coefficient": list(100, |_| row()), "drag_coefficient": list(80, |_| row())});
    let descending =
        json!({"type": "table", "altitude": numbers(10_000, 1e5, -1.0), "east": teeth(10_000), "north": teeth(10_000)});
    let released = list(900, |index| json!(index.to_string()));
    let names = list(100, |_| json!({"when": {"quantity": "time", "rises_through": 1}, "then": {"release": released}}));
    for (name, request) in [
        ("fields", with(&plain(), "/control", members(90_000))),
        ("times", with(&plain(), "/output", json!({"times": list(500_000, |_| json!(0))}))),
        ("events", with(&plain(), "/events", events)),
        ("matrix", with(&plain(), "/vehicle/aerodynamics", matrix)),
        ("descending", with(&plain(), "/wind", descending)),
        ("names", with(&plain(), "/events", names)),
    ] {
        let problem = fly(&request, false).expect_err(name).problem();
        assert_eq!(problem.errors.len(), 101, "{name}");
        assert_eq!(problem.detail, "more than 100 problems in the request", "{name}");
        let last = problem.errors.last().unwrap();
        assert_eq!(
            (&*last.pointer, &*last.detail),
            ("", "more than 100 problems; the others are not listed"),
            "{name}"
        );
        assert!(problem.to_json().len() < BODY_LIMIT / 32, "{name}: {} bytes", problem.to_json().len());
    }
}

#[test]
fn what_a_fault_is_about_is_told_once() {
    // A name of many characters is that of the pointer; the fields that there are are told with the first that is none.
    let long = "x".repeat(250_000);
    let fields = [("/name", json!([&long])), (&format!("/{long}"), json!(&long)), ("/other", json!(0))];
    let errors = fly(&with_all(&plain(), fields), false).expect_err("unknown fields").problem().errors;
    let [name, first, second] = &errors[..] else { panic!("{} errors", errors.len()) };
    assert_eq!((&*name.pointer, &*name.detail), ("/name", "must be a string, got an array"));
    assert_eq!(first.pointer.len(), 250_001);
    assert!(first.detail.starts_with("is not a field here; the fields are "), "{}", first.detail);
    assert_eq!((&*second.pointer, &*second.detail), ("/other", "is not a field here"));
}

/// The answer to a batch whose cases have as many faults as a body has room for.
#[test]
fn faults_of_many_cases_are_not_much_larger_than_the_cases() {
    let members: Value = (0..1000).map(|index| (format!("{index:x}"), json!(0))).collect();
    let case = members.to_string().len();
    let problem = fly(&members, false).expect_err("unknown fields").problem().to_json().len();
    assert!(problem < 2 * case, "{problem} bytes for {case}");
}
