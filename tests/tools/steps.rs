//! `cargo run --package reentry-tests --example steps`: what the steps of flights cost, and how exact they are: of the examples of
//! requests, of the thesis's cases, and of slow falls.
//!
//! A single flight may be lucky. So every one is flown at sixteen tolerances, a tenth of the default to ten times it, and the table
//! has the counts at the default, and the means over all: of the evaluations, and of the errors as multiples of the tolerance's.

#![allow(clippy::disallowed_methods, reason = "what is compared may be by the system's library")]
#![allow(clippy::unwrap_used, reason = "a tool that cannot go on has failed")]

use std::fs;
use std::sync::atomic::AtomicBool;

use reentry::integrate::Statistics;
use reentry::trajectory::Trajectory;
use reentry::{Case, Scenario, Solver, simulate};
use reentry_service::wire::json;
use reentry_service::wire::scenario::{FlightRequest, RequestedOutput};
use reentry_tests::cases::{read_json, thesis_cases};
use serde_json::{Value, json};

static NEVER: AtomicBool = AtomicBool::new(false);
const TOLERANCES: i32 = 16;
const POINTS: u32 = 200;

fn main() {
    println!(
        "| flight | right-hand sides | steps | rejected | mean right-hand sides | mean error at the end | on the way |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let only = std::env::args().nth(1);
    for (name, request) in flights() {
        if only.as_ref().is_none_or(|only| name.contains(only)) {
            row(&name, &request);
        }
    }
}

/// Prints what a flight costs.
fn row(name: &str, request: &Value) {
    let request = json::parse(request.to_string().as_bytes()).unwrap();
    let case = FlightRequest::try_from_tree(request, RequestedOutput::Answer).unwrap().scenario.case().clone();
    let Statistics { steps, rejected_steps, evaluations } = fly(&case, case.solver.relative_tolerance).statistics();
    let fine = fly(&case, 1e-13);
    let (mut cost, mut at_end, mut on_the_way) = (0.0, 0.0, 0.0);
    for index in 0..TOLERANCES {
        let tolerance = 1e-10 * 10_f64.powf(f64::from(2 * index - TOLERANCES + 1) / f64::from(TOLERANCES));
        let flown = fly(&case, tolerance);
        cost += f64::from(u32::try_from(flown.statistics().evaluations).unwrap()) / f64::from(TOLERANCES);
        let [end, way] = miss(&flown, &fine).map(|miss| (miss / tolerance).ln() / f64::from(TOLERANCES));
        at_end += end;
        on_the_way += way;
    }
    // Metres at the tolerance 1e-10.
    let [at_end, on_the_way] = [at_end, on_the_way].map(|mean| mean.exp() * 1e-10);
    println!(
        "| {name} | {evaluations} | {steps} | {rejected_steps} | {cost:.0} | {at_end:.1e} m | {on_the_way:.1e} m |"
    );
}

fn fly(case: &Case, relative_tolerance: f64) -> Trajectory {
    let solver = Solver { relative_tolerance, ..case.solver };
    simulate(&Scenario::new(Case { solver, ..case.clone() }).unwrap(), &NEVER).unwrap()
}

/// How far a flight is from another, m: at its end, the way of the delay included, and at the worst of points all along.
fn miss(flight: &Trajectory, exact: &Trajectory) -> [f64; 2] {
    let [end, exact_end] = [flight, exact].map(Trajectory::arrival);
    let delay = (end.time - exact_end.time) * exact_end.state.velocity.norm();
    let at_end = (end.state.position - exact_end.state.position).norm() + delay.abs();
    let length = end.time.min(exact_end.time);
    let times: Vec<f64> = (0..POINTS).map(|index| length * f64::from(index) / f64::from(POINTS)).collect();
    let [points, exact] = [flight, exact].map(|flight| flight.points(&times));
    let misses = points.iter().zip(&exact).map(|(point, exact)| {
        (point.flight_path.to_planet_fixed().position - exact.flight_path.to_planet_fixed().position).norm()
    });
    [at_end, misses.fold(0.0, f64::max)]
}

/// Requests with their names.
fn flights() -> Vec<(String, Value)> {
    let mut files: Vec<_> = fs::read_dir("openapi/examples").unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let examples = files.iter().map(|file| (file.file_stem().unwrap().to_string_lossy().into_owned(), read_json(file)));
    let examples = examples.filter(|(_, request)| {
        request.get("vehicle").is_some() && ["solution", "vary"].iter().all(|name| request.get(name).is_none())
    });
    let thesis = thesis_cases().into_iter().filter(|case| case.model == "earth_wgs84");
    let thesis = thesis.map(|case| (format!("{} of the thesis", case.name), case.request));
    examples
        .chain(thesis)
        .chain([
            ("the fall on Venus".into(), venus()),
            ("a parachute".into(), parachute()),
            ("a hyperbola".into(), hyperbola()),
        ])
        .collect()
}

/// A capsule that falls from orbital speed to the ground of Venus, with some lift.
fn venus() -> Value {
    json!({
        "planet": {"model": "venus"},
        "atmosphere": {"type": "standard"},
        "vehicle": {"mass": 316,
            "aerodynamics": {"type": "ballistic", "ballistic_coefficient": 188, "lift_to_drag": 0.18}},
        "initial_state": {"type": "planet_relative", "radius": 6_251_800, "longitude": 0, "geocentric_latitude": 0.2,
            "speed": 11_540, "flight_path_angle": -0.565, "heading": 0},
        "stop": {"time": 20_000},
    })
}

/// A capsule under its parachute, from 6 km in standard air.
fn parachute() -> Value {
    json!({
        "atmosphere": {"type": "us76"},
        "vehicle": {"mass": 2700, "reference_area": 1000, "aerodynamics": {"type": "constant", "drag_coefficient": 0.8}},
        "initial_state": {"type": "planet_relative", "radius": 6_384_137, "longitude": 0.3, "geocentric_latitude": 0.4,
            "speed": 40, "flight_path_angle": -1.2, "heading": 0.4},
    })
}

/// A capsule that grazes the air above circular speed, and leaves.
fn hyperbola() -> Value {
    json!({
        "vehicle": {"mass": 13_634.7, "reference_area": 8.2524, "aerodynamics": {"type": "constant", "drag_coefficient": 1.5357}},
        "initial_state": {"type": "planet_relative", "radius": 6_519_362.35, "longitude": 0, "geocentric_latitude": 0,
            "speed": 11_985.5, "flight_path_angle": 0, "heading": 0},
        "stop": {"time": 1000},
    })
}
