//! `POST /analytic`: its fields, its faults, its CSV, and that nothing a client sends breaks it.

use std::time::Duration;

use axum::http::{StatusCode, header};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};
use reentry_service::config::Config;
use reentry_tests::cases::thesis_cases;
use reentry_tests::service::{Answer, Service};
use serde_json::{Value, json};

use crate::check;

use super::fields::fields;
use super::refusal::{Steady, good_answer, problem};
use super::requests::{KINDS, capsule, flight, with, with_all, without};

const PATH: &str = "/analytic";
const SOLUTIONS: [&str; 5] = ["shallow_glide", "loh", "steep_glide", "steep_ballistic", "medium_glide"];
const QUANTITIES: [&str; 3] = ["speed", "flight_path_angle", "drag_deceleration"];

/// The case of the thesis for a solution, with few rows.
fn case(solution: &str) -> Value {
    let name = match solution {
        "loh" => "shallow_glide",
        "medium_glide" => "medium_glide_supercircular",
        other => other,
    };
    let listed = |case: &reentry_tests::cases::ThesisCase| case.name == name && case.model == "earth_jameson_listing";
    let request = thesis_cases().into_iter().find(listed).unwrap().request;
    with_all(&request, [("/solution", json!(solution)), ("/output", json!({"count": 40}))])
}

async fn compare(request: &Value) -> Value {
    good_answer(&Service::new(), PATH, request).await
}

fn names(object: &Value) -> Vec<&str> {
    object.as_object().unwrap().keys().map(String::as_str).collect()
}

fn column(value: &Value) -> Vec<Option<f64>> {
    value.as_array().unwrap().iter().map(Value::as_f64).collect()
}

#[tokio::test]
async fn the_answer_has_the_fields_of_the_contract() {
    for solution in SOLUTIONS {
        let answer = compare(&case(solution)).await;
        let all =
            ["name", "solution", "angle_unit", "version", "simulated", "predicted", "differences", "valid", "warnings"];
        assert_eq!(names(&answer), all);
        assert_eq!(answer["solution"], solution);
        for place in ["simulated", "predicted"] {
            assert_eq!(names(&answer[place]), ["time", "altitude", "speed", "flight_path_angle", "drag_deceleration"]);
        }
        assert_eq!(names(&answer["differences"]), QUANTITIES);
        assert_eq!(names(&answer["valid"]), ["from_altitude", "to_altitude", "ends_because"]);
        assert_eq!(answer["warnings"], json!([]));
        for name in ["time", "altitude"] {
            assert_eq!(answer["predicted"][name], answer["simulated"][name]);
        }
        let anonymous = compare(&without(&case(solution), "/name")).await;
        assert_eq!(names(&anonymous), all[1..]);
    }
}

#[tokio::test]
async fn the_simulated_part_is_the_flight_of_simulate() {
    for solution in SOLUTIONS {
        let request = case(solution);
        let answer = compare(&request).await;
        let flight = good_answer(&Service::new(), "/simulate", &without(&request, "/solution")).await;
        for name in ["time", "altitude", "speed", "flight_path_angle"] {
            assert_eq!(answer["simulated"][name], flight["trajectory"][name], "{name}");
        }
        // D/m = ½ρV²SC_D/m
        let vehicle = &request["vehicle"];
        let by_pressure = vehicle["reference_area"].as_f64().unwrap() / vehicle["mass"].as_f64().unwrap()
            * vehicle["aerodynamics"]["drag_coefficient"].as_f64().unwrap();
        let pressures = column(&flight["trajectory"]["dynamic_pressure"]);
        for (drag, pressure) in column(&answer["simulated"]["drag_deceleration"]).into_iter().zip(pressures) {
            check::relative("D/m", drag.unwrap(), pressure.unwrap() * by_pressure, 1e-14);
        }
    }
}

#[tokio::test]
async fn differences_are_predicted_minus_simulated_and_null_without_a_prediction() {
    for solution in SOLUTIONS {
        let answer = compare(&case(solution)).await;
        let mut counts = [0, 0];
        for name in QUANTITIES {
            let [simulated, predicted, differences] =
                ["simulated", "predicted", "differences"].map(|place| column(&answer[place][name]));
            for ((simulated, predicted), difference) in simulated.into_iter().zip(predicted).zip(differences) {
                assert_eq!(difference, predicted.map(|predicted| predicted - simulated.unwrap()), "{solution} {name}");
                counts[usize::from(predicted.is_some())] += 1;
            }
        }
        // 40 rows of three; the gliding theories but the steep one lack some.
        let all = matches!(solution, "steep_glide" | "steep_ballistic");
        assert!(counts[1] >= 12 && (counts[0] == 0) == all, "{solution} {counts:?}");
    }
}

#[tokio::test]
async fn the_end_is_located_between_the_rows_and_said_why() {
    let answer = compare(&with(&case("medium_glide"), "/output", json!({"count": 5}))).await;
    let valid = &answer["valid"];
    check::near("end", valid["to_altitude"].as_f64().unwrap(), 21_465.94, 0.01);
    assert_eq!(valid["ends_because"], "the bracket of equation 88 reaches zero");
    let altitudes = column(&answer["simulated"]["altitude"]);
    assert!(altitudes.iter().all(|altitude| (altitude.unwrap() - 21_465.94).abs() > 100.0));

    let answer = compare(&case("steep_ballistic")).await;
    assert_eq!(answer["valid"]["from_altitude"], answer["simulated"]["altitude"][0]);
    assert_eq!(answer["valid"]["to_altitude"], answer["simulated"]["altitude"][39]);
    assert_eq!(answer["valid"]["ends_because"], "the flight ends at the surface");
    let stopped = compare(&with(&case("steep_ballistic"), "/stop", json!({"time": 10}))).await;
    assert_eq!(stopped["valid"]["ends_because"], "the flight ends at the stop time");

    let no_glide = compare(&with(&case("shallow_glide"), "/vehicle/aerodynamics/lift_coefficient", 0.01)).await;
    assert_eq!(no_glide["valid"]["from_altitude"], json!(null));
    assert_eq!(no_glide["valid"]["to_altitude"], json!(null));
    assert_eq!(no_glide["valid"]["ends_because"], "|γ| of equation 78 exceeds 5°");
    assert!(column(&no_glide["predicted"]["speed"]).iter().all(Option::is_none));
}

#[tokio::test]
async fn the_readme_has_the_table_that_make_theory_prints() {
    let table = reentry_tests::theory::table().await;
    assert_eq!(table.lines().count(), 7);
    assert!(
        include_str!("../../crates/service/guide/validation.md").contains(&table),
        "the guide is out of date: run `make theory`\n{table}"
    );
}

#[tokio::test]
async fn degrees_give_the_same_comparison_as_radians() {
    for solution in SOLUTIONS {
        let radians = case(solution);
        let mut degrees = with(&radians, "/angle_unit", "deg");
        for name in ["longitude", "geocentric_latitude", "flight_path_angle", "heading"] {
            let angle = radians["initial_state"][name].as_f64().unwrap();
            degrees["initial_state"][name] = json!(angle.to_degrees());
        }
        let (radians, degrees) = (compare(&radians).await, compare(&degrees).await);
        assert_eq!(degrees["angle_unit"], "deg");
        for place in ["simulated", "predicted", "differences"] {
            for name in QUANTITIES {
                let scale = if name == "flight_path_angle" { 1_f64.to_degrees() } else { 1.0 };
                for (rad, deg) in column(&radians[place][name]).into_iter().zip(column(&degrees[place][name])) {
                    assert_eq!(rad.is_some(), deg.is_some(), "{solution} {place} {name}");
                    // Roundings of the angles that were sent grow with the flight, of speeds to 1e4 m/s and loads to 1e3 m/s².
                    check::near(name, deg.unwrap_or(0.0), rad.unwrap_or(0.0) * scale, 1e-6);
                }
            }
        }
    }
}

#[tokio::test]
async fn csv_has_a_line_a_row_and_an_empty_cell_for_no_number() {
    let service = Service::new();
    let request = case("medium_glide");
    let answer = service.post("/analytic?format=csv", &request).await;
    assert_eq!(answer.status, StatusCode::OK);
    assert!(answer.headers[header::CONTENT_TYPE].to_str().unwrap().starts_with("text/csv"));
    let text = String::from_utf8(answer.body.to_vec()).unwrap();
    let lines: Vec<_> = text.lines().map(|line| line.split(',').collect::<Vec<_>>()).collect();
    let columns = [
        "time",
        "altitude",
        "simulated_speed",
        "simulated_flight_path_angle",
        "simulated_drag_deceleration",
        "predicted_speed",
        "predicted_flight_path_angle",
        "predicted_drag_deceleration",
    ];
    assert_eq!(lines[0], columns);
    assert!(text.ends_with('\n') && lines.len() == 41);
    let json = compare(&request).await;
    let mut empty = 0;
    for (row, line) in lines[1..].iter().enumerate() {
        assert_eq!(line.len(), columns.len());
        for (name, cell) in columns.iter().zip(line) {
            let value = match name.split_once('_') {
                Some((place, name)) => &json[place][name][row],
                None => &json["simulated"][*name][row],
            };
            assert_eq!(*cell, if value.is_null() { String::new() } else { value.to_string() }, "{name} {row}");
            empty += usize::from(cell.is_empty());
        }
    }
    assert!(empty > 0 && empty % 3 == 0, "{empty}");
}

#[tokio::test]
async fn the_echo_gives_the_same_answer() {
    for solution in SOLUTIONS {
        let answer = compare(&with(&case(solution), "/echo", true)).await;
        assert_eq!(answer["case"]["solution"], solution);
        assert_eq!(answer["case"]["solver"]["formulation"], "cartesian");
        assert_eq!(compare(&answer["case"]).await, answer);
    }
    let least = with_all(
        &capsule(),
        [("/solution", json!("loh")), ("/echo", json!(true)), ("/vehicle/aerodynamics/lift_coefficient", json!(0.3))],
    );
    assert_eq!(compare(&least).await["case"]["output"], json!({"samples_per_step": 4}));
}

#[tokio::test]
async fn a_bank_angle_wind_and_the_frame_of_date_are_warned_of() {
    for kind in KINDS {
        let answer = compare(&with(&with(&flight(kind), "/solution", "shallow_glide"), "/planet", json!({}))).await;
        let warnings = answer["warnings"].as_array().unwrap();
        let codes: Vec<_> = warnings.iter().map(|warning| warning["code"].as_str().unwrap()).collect();
        let inertial = kind == "eci" || kind == "orbital_elements";
        let frame = inertial.then_some("inertial_frame_of_date");
        assert_eq!(codes, frame.into_iter().chain(["bank_angle_left_out", "wind_left_out"]).collect::<Vec<_>>());
    }
}

#[tokio::test]
async fn a_theory_that_does_not_apply_is_refused_with_every_fault() {
    let steady = Steady::new().await;
    let (lift, drag) = ("/vehicle/aerodynamics/lift_coefficient", "/vehicle/aerodynamics/drag_coefficient");
    let (angle, area, air) =
        ("/initial_state/flight_path_angle", "/vehicle/reference_area", "/atmosphere/surface_density");
    let rows = ("/output/trajectory", "the predictions are made at the rows");
    for solution in SOLUTIONS {
        let good = case(solution);
        let ballistic = solution == "steep_ballistic";
        let descends = !matches!(solution, "shallow_glide" | "loh");
        steady.refused_at(PATH, &with(&good, drag, 0), &[(drag, "must be greater than 0")]).await;
        steady.refused_at(PATH, &with(&good, area, 0), &[(area, "must be greater than 0")]).await;
        steady.refused_at(PATH, &with(&good, air, 0), &[(air, "must be greater than 0")]).await;
        let (wrong_lift, says) = if ballistic { (0.2, "must be 0") } else { (0.0, "must not be 0") };
        steady.refused_at(PATH, &with(&good, lift, wrong_lift), &[(lift, says)]).await;
        steady.refused_at(PATH, &with(&good, "/output", json!({"trajectory": false})), &[rows]).await;
        for flat in [0.0, 0.1] {
            let climbs = with(&good, angle, flat);
            if descends {
                steady.refused_at(PATH, &climbs, &[(angle, "must be less than 0")]).await;
            } else {
                compare(&climbs).await;
            }
        }
        let everything = [
            (drag, json!(0)),
            (area, json!(0)),
            (air, json!(0)),
            (lift, json!(wrong_lift)),
            (angle, json!(0.1)),
            ("/output", json!({"trajectory": false})),
        ];
        let mut expected = vec![(drag, ""), (area, ""), (air, ""), (lift, ""), rows];
        expected.extend(descends.then_some((angle, "")));
        steady.refused_at(PATH, &with_all(&good, everything), &expected).await;
        // Faults of the flight itself beside those of the theory; where there is no sound state, its angle is nobody's.
        let below = with_all(&good, [("/stop", json!({"altitude": 5e5})), (drag, json!(0))]);
        steady.refused_at(PATH, &below, &[(drag, ""), ("/initial_state", "below the stop altitude")]).await;
        let high = with(&good, "/atmosphere/scale_height", 50);
        steady.refused_at(PATH, &high, &[("/initial_state", "the air has no density")]).await;
    }
    // A state without an angle of its own is faulty as a whole; the angle is said in the request's unit.
    let up = json!({"type": "ecef", "position": [6.5e6, 0, 0], "velocity": [1000, 1000, 0]});
    let climbs = with_all(&case("steep_glide"), [("/initial_state", up), ("/angle_unit", json!("deg"))]);
    steady
        .refused_at(PATH, &climbs, &[("/initial_state", "must be less than 0: the theory is of a descent, got 4")])
        .await;
}

#[tokio::test]
async fn every_field_of_simulate_is_read_as_there() {
    let service = Service::new();
    let mut count = 0;
    for field in fields().into_iter().filter(|field| field.path == "/simulate") {
        // With a fault elsewhere, no request is sound.
        let spoilt = with(&field.request, "/vehicle/mass", -1);
        for value in field.kind.mistyped() {
            let request = with(&spoilt, &field.pointer, value);
            let there = problem(&service.post("/simulate", &request).await);
            let here = problem(&service.post(PATH, &with(&request, "/solution", "loh")).await);
            assert_eq!(here["errors"], there["errors"], "{request}");
            count += 1;
        }
    }
    assert!(count > 200, "{count}");
    let steady = Steady::new().await;
    let required = "is required";
    let all = [("/solution", required), ("/vehicle", required), ("/initial_state", required)];
    steady.refused_at(PATH, &json!({}), &all).await;
    steady.refused_at(PATH, &json!([]), &[("", "must be an object")]).await;
    steady.refused_at("/simulate", &case("loh"), &[("/solution", "is not a field here")]).await;
}

#[tokio::test]
async fn rows_over_the_limit_are_refused() {
    let steady = Steady::with(Config { row_limit: 100, ..Config::default() }).await;
    let problem = steady.refused_text(PATH, with(&case("loh"), "/output", json!({"count": 101})).to_string()).await;
    assert_eq!(problem["type"], "/problems/row-limit");
    assert_eq!(problem["errors"][0]["pointer"], "/output/count");
}

/// What is wrong with an answer, if it is neither a complete one nor a refusal.
fn unsound(answer: &Answer) -> Option<String> {
    let text = String::from_utf8_lossy(&answer.body);
    match answer.status {
        StatusCode::OK => {
            // Not a number and infinity would be written as null, which only what the theory gives may be.
            let answer = answer.json();
            let predicted = QUANTITIES.map(|name| column(&answer["predicted"][name]));
            let differences = QUANTITIES.map(|name| column(&answer["differences"][name]));
            let consistent = predicted.iter().zip(&differences).all(|(predicted, differences)| {
                predicted.iter().zip(differences).all(|(a, b)| a.is_some() == b.is_some())
            });
            let ends = [&answer["valid"]["from_altitude"], &answer["valid"]["to_altitude"]];
            let never = predicted.iter().flatten().all(Option::is_none);
            let segment = ends.iter().all(|end| end.is_null() == never);
            let complete = !answer["simulated"].to_string().contains("null") && !text.contains("NaN");
            (!(consistent && segment && complete)).then(|| text.to_string())
        }
        StatusCode::UNPROCESSABLE_ENTITY if text.contains("NaN") || text.contains("inf") => Some(text.to_string()),
        StatusCode::UNPROCESSABLE_ENTITY | StatusCode::GATEWAY_TIMEOUT => {
            problem(answer);
            None
        }
        status => Some(format!("{status}: {text}")),
    }
}

/// A number anywhere between the smallest and the greatest, at either of which half of them are not more than a few powers of ten.
fn magnitude(least: f64, greatest: f64) -> impl Strategy<Value = f64> {
    (least.log10()..greatest.log10()).prop_map(|exponent| 10_f64.powf(exponent))
}

/// Valid requests over the whole of every range that the theories use, and near what can be flown.
fn any_request() -> impl Strategy<Value = Value> {
    let body = (
        prop_oneof![magnitude(1e-3, 1e6), magnitude(1e-300, 1e300)],
        prop_oneof![magnitude(1e-3, 1e3), magnitude(1e-300, 1e300)],
        prop_oneof![-2.0..2.0, magnitude(1e-300, 1e300), Just(0.0)],
        prop_oneof![0.01..2.0, magnitude(1e-300, 1e300)],
    );
    let state = (-1e3..1e6, prop_oneof![0.0..1.5e4, 0.0..1e6], -1.571..0.3, -1.5..1.5);
    let air = (prop_oneof![Just(1.547_93), magnitude(1e-300, 1e300)], prop_oneof![Just(6935.0), magnitude(1.0, 1e12)]);
    let planet =
        (prop_oneof![Just(6_378_137.0), magnitude(1.0, 1e12)], prop_oneof![Just(3.986e14), magnitude(1e-6, 1e25)]);
    let rest = (0..SOLUTIONS.len(), any::<bool>(), -1.0..1.0);
    (body, state, air, planet, rest).prop_map(|(body, state, air, planet, (solution, spherical, bank))| {
        let solution = SOLUTIONS[solution];
        let lift = if solution == "steep_ballistic" { 0.0 } else { body.2 };
        json!({
            "solution": solution,
            "planet": {"model": "custom", "equatorial_radius": planet.0, "polar_radius": planet.0,
                "gravitational_parameter": planet.1, "rotation_rate": 0},
            "atmosphere": {"type": "exponential", "surface_density": air.0, "scale_height": air.1},
            "vehicle": {"mass": body.0, "reference_area": body.1,
                "aerodynamics": {"type": "constant", "lift_coefficient": lift, "drag_coefficient": body.3}},
            "control": {"bank_angle": bank},
            "initial_state": {"type": "planet_relative", "altitude": f64::max(state.0, 0.0), "longitude": 0,
                "geocentric_latitude": state.3, "speed": state.1,
                "flight_path_angle": f64::max(state.2, -std::f64::consts::FRAC_PI_2), "heading": 1},
            "solver": {"formulation": if spherical { "spherical" } else { "cartesian" }},
            "stop": {"time": 5000},
            "output": {"count": 20},
        })
    })
}

#[test]
fn any_valid_request_gives_numbers_or_a_refusal() {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    // Some of these flights take the greatest number of steps, of which this test need not wait for the end.
    let service = Service::with(Config { deadline: Duration::from_millis(300), ..Config::default() });
    let counts = std::cell::Cell::new((0, 0));
    let config = ProptestConfig {
        cases: 600,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    };
    let result = TestRunner::new(config).run(&any_request(), |request| {
        let answer = runtime.block_on(service.post(PATH, &request));
        let (good, all) = counts.get();
        counts.set((good + usize::from(answer.status == StatusCode::OK), all + 1));
        match unsound(&answer) {
            Some(unsound) => Err(TestCaseError::fail(format!("{unsound} for {request}"))),
            None => Ok(()),
        }
    });
    assert!(result.is_ok(), "{result:?}");
    // Neither all answers nor all refusals.
    let (good, all) = counts.get();
    assert!(good > all / 10 && good < all, "{good} of {all}");
}
