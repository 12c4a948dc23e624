//! `POST /simulate`: defaults, the echo, units of angles, and the digits of numbers.

use axum::http::StatusCode;
use reentry::Case;
use reentry_service::wire::scenario::{FlightRequest, RequestedOutput};
use reentry_tests::fuzzed::{is_of_default, without_warnings_of_defaults};
use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::refusal::good_answer;
use super::requests::{KINDS, capsule, flight, models, with, with_all, without};

/// The quantities of a row of every case, in the order of the contract.
pub(crate) const COLUMNS: [&str; 25] = [
    "time",
    "altitude",
    "radius",
    "longitude",
    "geocentric_latitude",
    "geodetic_latitude",
    "geodetic_altitude",
    "speed",
    "flight_path_angle",
    "heading",
    "density",
    "dynamic_pressure",
    "deceleration",
    "load_factor",
    "azimuth",
    "air_speed",
    "bank_angle",
    "angle_of_attack",
    "downrange",
    "crossrange",
    "inertial_speed",
    "inertial_flight_path_angle",
    "specific_energy",
    "ground_range",
    "ground_distance",
];

/// Those that are in the request's unit of angles.
const ANGLES: [&str; 9] = [
    "longitude",
    "geocentric_latitude",
    "geodetic_latitude",
    "flight_path_angle",
    "heading",
    "azimuth",
    "bank_angle",
    "angle_of_attack",
    "inertial_flight_path_angle",
];

/// Flies a case that must be good.
pub(crate) async fn fly(case: &Value) -> Value {
    good_answer(&Service::new(), "/simulate", case).await
}

/// The names of an object's fields, in order.
pub(crate) fn names(object: &Value) -> Vec<&str> {
    object.as_object().unwrap().keys().map(String::as_str).collect()
}

/// The codes of an answer's warnings, in order, but for those of what the least of requests leaves out.
pub(crate) fn codes(answer: &Value) -> Vec<&str> {
    let warnings = answer["warnings"].as_array().unwrap().iter().filter(|warning| !is_of_default(warning));
    warnings.map(|warning| warning["code"].as_str().unwrap()).collect()
}

/// An answer but for the one thing that differs from run to run, and for warnings of what its request leaves out.
fn reproducible(answer: Value) -> Value {
    let mut answer = without_warnings_of_defaults(answer);
    answer["solver"]["elapsed"] = json!(null);
    answer
}

#[tokio::test]
async fn the_answer_has_the_fields_of_the_contract_in_order() {
    let answer = fly(&capsule()).await;
    let all = [
        "angle_unit",
        "version",
        "models",
        "termination",
        "initial_state",
        "final_state",
        "peaks",
        "trajectory",
        "solver",
        "warnings",
    ];
    assert_eq!(names(&answer), all);
    for place in ["initial_state", "final_state", "trajectory"] {
        assert_eq!(names(&answer[place]), COLUMNS, "{place}");
    }
    assert_eq!(names(&answer["models"]), ["planet", "shape", "atmosphere", "gravity", "aerodynamics", "wind"]);
    assert_eq!(names(&answer["peaks"]), ["deceleration", "load_factor", "dynamic_pressure", "altitude", "speed"]);
    for peak in answer["peaks"].as_object().unwrap().values() {
        assert_eq!(names(peak), ["value", "time", "altitude"]);
    }
    for name in ["formulation", "steps", "rejected_steps", "evaluations", "elapsed"] {
        assert!(names(&answer["solver"]).contains(&name), "{name}");
    }
    assert_eq!(answer["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(fly(&with(&capsule(), "/name", "Gemini")).await["name"], "Gemini");
}

#[tokio::test]
async fn defaults_are_those_of_the_contract() {
    let defaults = json!({
        "angle_unit": "rad",
        "echo": true,
        "sensitivities": false,
        "verify": false,
        "planet": {"model": "earth_wgs84", "shape": "ellipsoid", "gravity": {"type": "inverse_square"}},
        "atmosphere": {"type": "exponential", "surface_density": 1.54793, "scale_height": 6935.0},
        "density_factor": 1.0,
        "control": {"bank_angle": 0.0, "angle_of_attack": 0.0},
        "stop": {"altitude": 0.0, "time": 10000.0},
        "output": {"samples_per_step": 4},
    });
    let mut expected = with_all(
        &capsule(),
        [("/vehicle/aerodynamics/lift_coefficient", json!(0.0)), ("/initial_state/sidereal_time", json!(0))],
    );
    for (name, value) in defaults.as_object().unwrap() {
        expected[name] = value.clone();
    }
    let answer = fly(&with(&capsule(), "/echo", true)).await;
    let mut case = answer["case"].clone();
    let solver = case.as_object_mut().unwrap().remove("solver").unwrap();
    assert_eq!(case, expected);
    assert_eq!(solver["formulation"], "cartesian");
    // How small the tolerance is, the service decides; the answer says it.
    assert!(solver["relative_tolerance"].as_f64().unwrap() <= 1e-8, "{solver}");
    assert_eq!(solver["relative_tolerance"], answer["solver"]["relative_tolerance"]);
    let models = json!({"planet": "earth_wgs84", "shape": "ellipsoid", "atmosphere": "exponential",
        "gravity": "inverse_square", "aerodynamics": "constant", "wind": "still"});
    assert_eq!(answer["models"], models);
}

#[test]
fn the_core_has_the_defaults_of_the_contract() {
    let request = json!({
        "vehicle": {"mass": 700, "reference_area": 0.2, "aerodynamics": {"type": "constant", "drag_coefficient": 0.2}},
        "initial_state": {"type": "planet_relative", "altitude": 1e5, "longitude": 1, "geocentric_latitude": 0.5, "speed": 3000,
            "flight_path_angle": -0.5, "heading": 1},
    });
    let job = FlightRequest::try_from_tree(request, RequestedOutput::Answer).unwrap();
    let case = job.scenario.case();
    assert_eq!(*case, Case::new(case.vehicle.clone(), case.initial_state));
}

#[tokio::test]
async fn a_bare_atmosphere_and_empty_parts_have_the_defaults_as_well() {
    let empty = with_all(
        &capsule(),
        [
            ("/planet", json!({})),
            ("/atmosphere", json!({"type": "exponential"})),
            ("/control", json!({})),
            ("/stop", json!({})),
            ("/solver", json!({})),
        ],
    );
    assert_eq!(reproducible(fly(&empty).await), reproducible(fly(&capsule()).await));
}

#[tokio::test]
async fn the_echo_flown_again_gives_the_same_answer() {
    let service = Service::new();
    let mut cases: Vec<_> = KINDS.iter().map(|kind| flight(kind)).collect();
    let on_earth = cases.iter().map(|case| with(case, "/planet", json!({})));
    cases.extend(on_earth.map(|case| without(&case, "/initial_state/sidereal_time")).collect::<Vec<_>>());
    for text in ["deorbit", "lifting_capsule", "sample_return", "mars", "titan", "target_1", "target_2", "impulse"] {
        let file = format!("{}/../openapi/examples/{text}.json", env!("CARGO_MANIFEST_DIR"));
        cases.push(reentry_tests::cases::read_json(file.as_ref()));
    }
    cases.push(capsule());
    cases.extend(models().into_iter().map(|(_, case)| case));
    cases.push(with(&capsule(), "/angle_unit", "deg"));
    for case in cases {
        let answer = good_answer(&service, "/simulate", &with(&case, "/echo", true)).await;
        let again = good_answer(&service, "/simulate", &answer["case"]).await;
        assert_eq!(reproducible(again), reproducible(answer), "{case}");
    }
}

/// What `cargo run --package reentry-tests --example steps` has for these, and a little more.
#[tokio::test]
async fn the_examples_take_few_evaluations() {
    for (name, evaluations, rejected) in [
        ("deorbit", 1800, 14),
        ("lifting_capsule", 2400, 36),
        ("sample_return", 1850, 14),
        ("mars", 850, 12),
        ("titan", 700, 13),
    ] {
        let file = format!("{}/../openapi/examples/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let solver = fly(&reentry_tests::cases::read_json(file.as_ref())).await["solver"].clone();
        assert!(solver["evaluations"].as_u64().unwrap() <= evaluations, "{name}: {solver}");
        assert!(solver["rejected_steps"].as_u64().unwrap() <= rejected, "{name}: {solver}");
    }
}

#[tokio::test]
async fn numbers_are_echoed_as_sent() {
    let body = with_all(&capsule(), [("/echo", json!(true)), ("/vehicle/mass", json!("MASS"))]).to_string();
    let service = Service::new();
    for (sent, echoed) in [
        ("13", "13"),
        ("13.5", "13.5"),
        ("5500.123456789012", "5500.123456789012"),
        ("0.1", "0.1"),
        ("2251799813685249.5", "2251799813685249.5"),
        ("9007199254740993", "9007199254740993"),
    ] {
        let answer = service.post_text("/simulate", body.replace("\"MASS\"", sent)).await;
        let text = String::from_utf8(answer.body.to_vec()).unwrap();
        assert_eq!(answer.status, StatusCode::OK, "{text}");
        assert!(text.contains(&format!("\"mass\":{echoed},")), "{sent}: {text}");
    }
}

/// Every number of a JSON text, as it is written.
fn written_numbers(text: &str) -> Vec<String> {
    let mut outside_strings = String::new();
    let mut quoted = false;
    for character in text.chars() {
        quoted ^= character == '"';
        outside_strings.push(if quoted { ' ' } else { character });
    }
    let number = |part: &&str| part.starts_with(|first: char| first == '-' || first.is_ascii_digit());
    let parts = outside_strings.split(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c)));
    parts.filter(number).map(str::to_owned).collect()
}

#[tokio::test]
async fn numbers_read_back_to_the_same_f64() {
    let answer = Service::new().post("/simulate", &with(&capsule(), "/output", json!({"count": 500}))).await;
    let text = String::from_utf8(answer.body.to_vec()).unwrap();
    let numbers = written_numbers(&text);
    assert!(numbers.len() > 14 * 500);
    for number in numbers {
        // The shortest digits that read back to a number are those of Rust, which are exact.
        let value: f64 = number.parse().unwrap();
        let digits = |text: &str| {
            let mantissa = text.split(['e', 'E']).next().unwrap();
            let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
            digits.trim_start_matches('0').trim_end_matches('0').len()
        };
        assert!(digits(&number) <= digits(&format!("{value:e}")), "{number}");
        assert_eq!(serde_json::from_str::<f64>(&number).unwrap().to_bits(), value.to_bits(), "{number}");
    }
}

#[tokio::test]
async fn degrees_give_the_same_flight_as_radians() {
    let radians = flight("planet_relative");
    let mut degrees = with_all(&radians, [("/angle_unit", json!("deg"))]);
    for pointer in [
        "/control/bank_angle",
        "/initial_state/longitude",
        "/initial_state/geocentric_latitude",
        "/initial_state/flight_path_angle",
        "/initial_state/heading",
    ] {
        let angle = radians.pointer(pointer).unwrap().as_f64().unwrap();
        degrees = with(&degrees, pointer, angle.to_degrees());
    }
    let (in_radians, in_degrees) = (fly(&radians).await, fly(&degrees).await);
    assert_eq!(in_degrees["angle_unit"], "deg");
    for name in COLUMNS {
        for place in ["initial_state", "final_state"] {
            let [rad, deg] = [&in_radians, &in_degrees].map(|answer| &answer[place][name]);
            let (Some(rad), Some(deg)) = (rad.as_f64(), deg.as_f64()) else {
                assert!(rad.is_null() && deg.is_null(), "{name} of {place}");
                continue;
            };
            let what = format!("{name} of {place}");
            // A rounding of the angles that were sent moves the flight by parts of 1e-16.
            match name {
                _ if ANGLES.contains(&name) => check::angle(&what, deg.to_radians(), rad, 1e-13),
                "altitude" | "geodetic_altitude" | "downrange" | "crossrange" | "ground_range" | "ground_distance" => {
                    check::near(&what, deg, rad, 1e-6);
                }
                "time" => check::near(&what, deg, rad, 1e-12),
                _ => check::relative(&what, deg, rad, 1e-10),
            }
        }
        let (rad, deg) = (&in_radians["trajectory"][name], &in_degrees["trajectory"][name]);
        assert_eq!(rad.as_array().unwrap().len(), deg.as_array().unwrap().len());
    }
    let csv = Service::new().post("/simulate?format=csv", &degrees).await;
    let text = String::from_utf8(csv.body.to_vec()).unwrap();
    let longitude = text.lines().nth(1).unwrap().split(',').nth(3).unwrap();
    assert_eq!(longitude, in_degrees["trajectory"]["longitude"][0].to_string());
}

#[tokio::test]
async fn longitudes_and_headings_are_answered_in_half_turns() {
    let pi = std::f64::consts::PI;
    let mut case = with(&capsule(), "/stop", json!({"time": 1}));
    for (longitude, heading) in [(pi, pi), (-pi, -pi), (6.2, 6.2), (-6.2, -6.2), (3.2, -3.2), (2.0 * pi, -2.0 * pi)] {
        case["initial_state"]["longitude"] = json!(longitude);
        case["initial_state"]["heading"] = json!(heading);
        let answer = fly(&case).await;
        for (name, sent) in [("longitude", longitude), ("heading", heading)] {
            let columns = answer["trajectory"][name].as_array().unwrap();
            for value in columns.iter().map(|value| value.as_f64().unwrap()) {
                assert!(-pi < value && value <= pi, "{name} {value}");
            }
            check::angle(name, answer["initial_state"][name].as_f64().unwrap(), sent, 1e-14);
        }
    }
}

#[tokio::test]
async fn an_epoch_and_an_inertial_state_warn_of_the_frame() {
    let service = Service::new();
    for kind in KINDS {
        for (epoch, given) in [(json!("2026-11-22T12:00:00Z"), true), (json!(null), false)] {
            let mut case = with(&without(&flight(kind), "/epoch"), "/planet", json!({}));
            if given {
                case["epoch"] = epoch;
            }
            let answer = good_answer(&service, "/simulate", &case).await;
            let inertial = kind == "eci" || kind == "orbital_elements";
            let warnings = answer["warnings"].as_array().unwrap();
            let warns = warnings.iter().any(|warning| warning["code"] == "inertial_frame_of_date");
            assert_eq!(warns, given && inertial, "{kind}");
            if warns {
                assert_eq!(names(&warnings[0]), ["code", "detail"]);
                let detail = warnings[0]["detail"].as_str().unwrap();
                assert!(detail.starts_with("Inertial frame is date: the Earth's equator of date"), "{detail}");
                assert!(detail.contains("to teme for vectors of SGP4 or gcrf for J2000"), "{detail}");
            }
        }
    }
}
