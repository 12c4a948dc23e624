//! The reference cases that are built into the program: `reentry validate`, `GET /validation`, and the guide.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use axum::http::StatusCode;
use reentry_service::validation::{Check, Group, Validation};
use reentry_tests::cases::read_json;
use reentry_tests::service::Service;

fn validation() -> Validation {
    Validation::run(&AtomicBool::new(false)).unwrap()
}

#[test]
fn every_reference_case_comes_out_as_expected() {
    let validation = validation();
    let misses: Vec<_> = validation.misses().map(Check::told).collect();
    assert!(validation.passed && misses.is_empty(), "{}", misses.join("\n"));
}

/// A file that is not read would be a check less, and nothing more.
#[test]
fn no_check_is_left_out() {
    let validation = validation();
    for (group, count) in [
        // Seven cases, three sets of constants, three numbers.
        (Group::Thesis, 63),
        (Group::Conversions, 12),
        (Group::Theories, 7),
        // Three simulations of three cases, of which one does not tell the place; and a tenth case.
        (Group::CheckCases, 3 * 5 + 2),
        (Group::StandardAir, 8),
        (Group::Frames, 11),
        // Eight cases of one to five numbers.
        (Group::Ascents, 3 + 1 + 3 + 3 + 2 + 1 + 2 + 5),
        // In the same air: seven planets, three numbers each; five convective heat fluxes and a radiative one.
        // As published: five entries at Venus and four at Titan of three numbers, one of them of two; passes at Uranus,
        // Mars and the Earth, four of two numbers each and five of one.
        (Group::Bodies, 7 * 3 + 5 + 1 + 5 * 3 - 1 + 4 * 3 + 4 * 2 + 4 * 2 + 5),
        // Nine at the Earth, 21 at other planets, and stages of launchers: three of four numbers and one of two.
        (Group::Flights, 9 + 21 + 3 * 4 + 2),
        // Nineteen corridors with two limits each, three depths and a load.
        (Group::Corridors, 19 * 2 + 3 + 1),
    ] {
        let found = validation.checks.iter().filter(|check| check.group == group);
        assert_eq!(found.count(), count, "{group:?}");
    }
    assert!(validation.checks.iter().all(|check| check.got.is_some() && !check.source.is_empty()));
    let is_theory = |check: &Check| check.group == Group::Corridors && check.case.starts_with("Chapman");
    let judged = |check: &Check| check.passed.is_some() != (check.group == Group::Flights || is_theory(check));
    assert!(
        validation.checks.iter().all(judged),
        "flights that were flown and a theory are no references, all else is"
    );
}

/// As another search had found them, to the digits given.
#[test]
fn the_limits_of_corridors_are_where_another_search_finds_them() {
    let file = read_json(&Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/flights/amat.json"));
    let corridors = file["corridors"].as_array().unwrap();
    let ends = corridors.iter().flat_map(|corridor| corridor["ends"].as_array().unwrap());
    let expected: Vec<_> = ends.map(|end| end["here"]["flight_path_angle"].as_f64().unwrap()).collect();
    let validation = validation();
    let of_amat = |check: &&Check| check.group == Group::Corridors && check.passed.is_some();
    let got: Vec<_> = validation.checks.iter().filter(of_amat).map(|check| check.got.unwrap()).collect();
    assert_eq!(got.len(), expected.len());
    for (got, expected) in got.into_iter().zip(expected) {
        assert!((got - expected).abs() < 6e-5, "{got} and {expected}");
    }
}

#[test]
fn every_file_of_cases_is_built_in() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let built_in = fs::read_to_string(root.join("../crates/service/src/validation/cases.rs")).unwrap();
    let mut open = vec![root.join("cases")];
    let mut count = 0;
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(fs::read_dir(&path).unwrap().flatten().map(|entry| entry.path()));
        } else {
            let name = path.strip_prefix(root).unwrap().display().to_string();
            assert!(built_in.contains(&format!("/tests/{name}\")")), "{name} is not in the program");
            count += 1;
        }
    }
    assert!(count > 15, "only {count} files");
}

#[tokio::test]
async fn the_service_answers_with_the_validation() {
    let service = Service::patient();
    let answer = service.get("/validation").await;
    assert_eq!(
        (answer.status, &answer.headers["content-type"]),
        (StatusCode::OK, &"application/json".parse().unwrap())
    );
    assert_eq!(answer.body, validation().to_json().unwrap());
    assert_eq!(service.get("/validation?format=json").await.body, answer.body);
    assert_eq!(service.get("/validation?format=csv").await.status, StatusCode::NOT_ACCEPTABLE);
    assert_eq!(service.get("/validation?case=1").await.status, StatusCode::BAD_REQUEST);
    assert_eq!(service.post_text("/validation", "{}").await.status, StatusCode::METHOD_NOT_ALLOWED);
}

#[test]
fn a_validation_for_which_nobody_waits_ends() {
    assert!(Validation::run(&AtomicBool::new(true)).is_err());
}

#[test]
fn the_guide_has_the_validation() {
    let markdown = validation().to_markdown();
    assert!(
        include_str!("../../crates/service/guide/validation.md").contains(&markdown),
        "out of date: run `make validation`\n{markdown}"
    );
}

#[test]
fn the_text_has_every_check_and_every_source() {
    let validation = validation();
    let text = validation.to_text();
    for check in &validation.checks {
        let line = text.lines().find(|line| line.contains(&check.case) && line.contains(&check.quantity));
        assert!(line.is_some_and(|line| !line.contains("FAILED")), "{}", check.told());
        assert!(text.contains(&check.source) && text.contains(&check.note), "{}", check.told());
    }
    assert!(text.ends_with(
        "250 checks against references: all passed. 48 comparisons with real flights and approximations, for information only.\n"
    ));
}
