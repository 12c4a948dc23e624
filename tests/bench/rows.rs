//! `cargo bench --bench rows`: what the rows of an answer cost, in ns a value, beside the same numbers as one array.
//!
//! The machines are noisy: contenders take turns, and each figure is the median of many rounds.

#![allow(clippy::unwrap_used, reason = "a benchmark that cannot go on has failed")]

use std::sync::atomic::AtomicBool;

use reentry::simulate::Flights;
use reentry::trajectory::Sampling;
use reentry::{Scenario, simulate};
use reentry_service::wire::bodies::FlownBodies;
use reentry_service::wire::json;
use reentry_service::wire::scenario::{FlightRequest, RequestedOutput};
use reentry_service::wire::trajectory::{RequestedAnalyses, SimulateResponse};
use reentry_tests::cases::thesis_cases;
use reentry_tests::timing::{medians, timed};

const ROWS: usize = 1000;
const ROUNDS: usize = 300;

fn main() {
    println!("| flight | evaluated | as JSON | as CSV | bare numbers | evaluated, as JSON |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for name in ["target_1", "target_2", "impulse", "shallow_glide"] {
        println!("{}", line(name));
    }
}

/// What the rows of a case cost.
fn line(name: &str) -> String {
    let (scenario, response) = answered(name);
    let flight = simulate(&scenario, &AtomicBool::new(false)).unwrap();
    let csv = String::from_utf8(as_csv(&response)).unwrap();
    let cells = csv.lines().skip(1).flat_map(|line| line.split(','));
    let numbers: Vec<f64> = cells.map(|x| x.parse().unwrap()).collect();
    let columns = csv.lines().next().unwrap().split(',').count();
    assert_eq!(numbers.len(), ROWS * columns);
    let medians = medians(
        ROUNDS,
        [
            &mut timed(|| flight.points(&flight.instants(&Sampling::Count(ROWS), ROWS).unwrap())),
            &mut timed(|| serde_json::to_vec(&response).unwrap()),
            &mut timed(|| as_csv(&response)),
            &mut timed(|| serde_json::to_vec(&numbers).unwrap()),
        ],
    );
    #[expect(clippy::cast_precision_loss, reason = "some 10 000 numbers")]
    let [evaluated, json, csv, bare] = medians.map(|seconds| seconds * 1e9 / numbers.len() as f64);
    format!("| {name} | {evaluated:.1} | {json:.1} | {csv:.1} | {bare:.1} | {:.1} |", evaluated + json)
}

/// A case and its answer.
fn answered(name: &str) -> (Scenario, SimulateResponse) {
    let case = thesis_cases().into_iter().find(|case| case.name == name && case.model == "earth_wgs84").unwrap();
    let tree = json::parse(case.request.to_string().as_bytes()).unwrap();
    let job = FlightRequest::try_from_tree(tree, RequestedOutput::Answer).unwrap();
    let scenario = job.scenario.clone();
    let flights = Flights::of_vehicle(simulate(&scenario, &AtomicBool::new(false)).unwrap());
    let flight = &flights.vehicle;
    let rows = vec![Some(flight.points(&flight.instants(&Sampling::Count(ROWS), ROWS).unwrap()))];
    let flown = FlownBodies::new(&job.request, &flights);
    let response = SimulateResponse::new(&job.request, &flown, rows, RequestedAnalyses::default(), 0.0);
    (scenario, response)
}

/// The rows as CSV.
fn as_csv(response: &SimulateResponse) -> Vec<u8> {
    let mut csv = Vec::new();
    response.write_csv(&mut csv).unwrap();
    csv
}
