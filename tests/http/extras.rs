//! `"sensitivities": true` and `"verify": true`.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::requests::{flight, with, with_all};
use super::simulate::fly;

const INPUTS: [&str; 13] = [
    "mass",
    "reference_area",
    "lift_coefficient",
    "drag_coefficient",
    "bank_angle",
    "surface_density",
    "density_factor",
    "radius",
    "longitude",
    "geocentric_latitude",
    "speed",
    "flight_path_angle",
    "heading",
];
const OUTPUTS: [&str; 5] = ["time", "longitude", "geocentric_latitude", "speed", "flight_path_angle"];
/// Those in the request's unit of angles.
const ANGLES: [&str; 6] =
    ["bank_angle", "longitude", "geocentric_latitude", "flight_path_angle", "heading", "geodetic_latitude"];

/// TARGET case 2, without rows.
fn target_2() -> Value {
    let case: Value = serde_json::from_str(include_str!("../../openapi/examples/target_2.json")).unwrap();
    with(&case, "/output", json!({"trajectory": false}))
}

fn keys(object: &Value) -> Vec<&str> {
    object.as_object().unwrap().keys().map(String::as_str).collect()
}

#[tokio::test]
async fn both_are_there_only_where_they_are_asked_for() {
    let plain = fly(&target_2()).await;
    assert!(plain.get("sensitivities").is_none() && plain.get("verification").is_none());
    let asked = fly(&with_all(&target_2(), [("/sensitivities", json!(true)), ("/verify", json!(true))])).await;
    assert_eq!(keys(&asked["sensitivities"]), OUTPUTS);
    for output in OUTPUTS {
        assert_eq!(keys(&asked["sensitivities"][output]), INPUTS);
    }
    let fields = ["relative_tolerance", "time_difference", "distance", "energy_drift", "drag_work"];
    assert_eq!(keys(&asked["verification"]), fields);
    // The flight itself is the same.
    assert_eq!(asked["final_state"], plain["final_state"]);
}

#[tokio::test]
async fn sensitivities_are_the_differences_of_answers() {
    let case = with(&target_2(), "/solver", json!({"relative_tolerance": 1e-13}));
    let slopes = fly(&with(&case, "/sensitivities", json!(true))).await["sensitivities"].clone();
    for (path, input, step) in [
        ("vehicle/mass", "mass", 1e-2),
        ("vehicle/aerodynamics/drag_coefficient", "drag_coefficient", 1e-6),
        ("control/bank_angle", "bank_angle", 1e-5),
        ("atmosphere/surface_density", "surface_density", 1e-5),
        ("initial_state/speed", "speed", 0.1),
        ("initial_state/heading", "heading", 1e-6),
    ] {
        let nominal = case.pointer(&format!("/{path}")).and_then(Value::as_f64).unwrap();
        let above = fly(&with(&case, &format!("/{path}"), json!(nominal + step))).await["final_state"].clone();
        let below = fly(&with(&case, &format!("/{path}"), json!(nominal - step))).await["final_state"].clone();
        for output in OUTPUTS {
            let change = above[output].as_f64().unwrap() - below[output].as_f64().unwrap();
            let slope = slopes[output][input].as_f64().unwrap();
            // Second order, and the rounding of an arrival: 1e-8 s or m/s, and as much less for angles as they are smaller.
            let rounding = if ANGLES.contains(&output) { 1e-13 } else { 1e-8 } / step;
            check::near(&format!("{output} by {input}"), slope, change / (2.0 * step), 1e-4 * slope.abs() + rounding);
        }
    }
}

#[tokio::test]
async fn sensitivities_are_in_the_unit_of_the_request() {
    let radians = with(&target_2(), "/sensitivities", json!(true));
    let mut degrees = with(&radians, "/angle_unit", json!("deg"));
    for path in [
        "/control/bank_angle",
        "/initial_state/longitude",
        "/initial_state/geocentric_latitude",
        "/initial_state/flight_path_angle",
        "/initial_state/heading",
    ] {
        let angle = degrees.pointer_mut(path).unwrap();
        *angle = json!(angle.as_f64().unwrap().to_degrees());
    }
    let [radians, degrees] = [fly(&radians).await, fly(&degrees).await].map(|answer| answer["sensitivities"].clone());
    for output in OUTPUTS {
        for input in INPUTS {
            let unit = |name| if ANGLES.contains(&name) { 1_f64.to_degrees() } else { 1.0 };
            let expected = radians[output][input].as_f64().unwrap() * unit(output) / unit(input);
            // The angles differ by a rounding, which the flight magnifies.
            let tolerance = 1e-9 * expected.abs() + 1e-9;
            check::near(&format!("{output} by {input}"), degrees[output][input].as_f64().unwrap(), expected, tolerance);
        }
    }
}

/// At rest, an angle has no slope: null, and no infinity.
#[tokio::test]
async fn what_has_no_derivative_is_null() {
    let mut stone = flight("planet_relative");
    stone["initial_state"] = json!({"type": "planet_relative", "altitude": 1000, "longitude": 0.3, "geocentric_latitude": 0.2,
        "speed": 0, "flight_path_angle": 0, "heading": 0});
    stone["planet"] = json!({"model": "custom", "gravitational_parameter": 4e14, "equatorial_radius": 6.4e6,
        "polar_radius": 6.4e6, "rotation_rate": 0});
    stone["vehicle"]["aerodynamics"] = json!({"type": "constant", "drag_coefficient": 1});
    stone["stop"] = json!({"altitude": 0});
    stone["sensitivities"] = json!(true);
    stone["verify"] = json!(true);
    for field in ["epoch", "wind"] {
        stone.as_object_mut().unwrap().remove(field);
    }
    let answer = fly(&stone).await;
    let slopes = &answer["sensitivities"];
    // Straight down, the flight-path angle stands at its least: no slope on either side.
    assert_eq!(slopes["flight_path_angle"]["speed"], json!(null));
    // dt/dr from rest: higher by a metre, later by one over the final speed and more.
    assert!(slopes["time"]["radius"].as_f64().unwrap() > 0.0);
}

#[tokio::test]
async fn the_verification_is_that_of_the_two_flights() {
    let solver = |tolerance: f64| with(&target_2(), "/solver", json!({"relative_tolerance": tolerance}));
    let (coarse, fine) = (fly(&with(&solver(1e-6), "/verify", json!(true))).await, fly(&solver(1e-8)).await);
    let verification = &coarse["verification"];
    let number = |value: &Value| value.as_f64().unwrap();
    check::relative("tolerance", number(&verification["relative_tolerance"]), 1e-8, 1e-12);
    let late = number(&coarse["final_state"]["time"]) - number(&fine["final_state"]["time"]);
    check::near("time", number(&verification["time_difference"]), late, 1e-12);
    let distance = reentry_tests::cases::distance(&coarse["final_state"], &fine["final_state"]);
    // Both through latitudes and longitudes and back.
    check::near("distance", number(&verification["distance"]), distance, 1e-8);
}

/// CSV is rows and nothing else: an option that it cannot answer is refused, never ignored.
#[tokio::test]
async fn csv_has_no_place_for_them() {
    let service = Service::new();
    let mut case = with(&target_2(), "/output", json!({"count": 2}));
    case["sensitivities"] = json!(true);
    case["verify"] = json!(true);
    let answer = service.post("/simulate?format=csv", &case).await;
    assert_eq!((answer.status.as_u16(), answer.pointers()), (422, vec!["/sensitivities".into(), "/verify".into()]));
    case["solution"] = json!("loh");
    let answer = service.post("/analytic?format=csv", &case).await;
    assert_eq!((answer.status.as_u16(), answer.pointers()), (422, vec!["/sensitivities".into(), "/verify".into()]));
    let answer = service.post("/analytic", &case).await;
    assert_eq!(answer.status.as_u16(), 200);
    assert!(answer.json()["sensitivities"].is_object() && answer.json()["verification"].is_object());
}
