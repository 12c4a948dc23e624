//! `/corridor`, `/target` and `/footprint`: what they answer, and what they refuse.

use axum::http::StatusCode;
use reentry_service::config::Config;
use reentry_tests::service::Service;
use serde_json::{Value, json};

use super::refusal::{Steady, good_answer};
use super::requests::{with, with_all, without};

/// A capsule that comes back from the Moon; degrees.
fn entry() -> Value {
    json!({
        "angle_unit": "deg",
        "atmosphere": {"type": "us76"},
        "vehicle": {"mass": 5500, "reference_area": 12,
            "aerodynamics": {"type": "constant", "lift_coefficient": 0.39, "drag_coefficient": 1.3}},
        "control": {"bank_angle": 0},
        "initial_state": {"type": "planet_relative", "altitude": 122_000, "longitude": 170, "geocentric_latitude": 10,
            "speed": 10_600, "flight_path_angle": -6, "heading": 30},
        "stop": {"altitude": 0, "time": 4000, "ceiling": 130_000},
    })
}

fn corridor() -> Value {
    with_all(
        &entry(),
        [
            ("/vary", json!({"pointer": "/initial_state/flight_path_angle", "between": [-12, -3.5]})),
            (
                "/limits",
                json!([
                    {"quantity": "load_factor", "at": "peak", "at_most": 12, "with": {"/control/bank_angle": 0}},
                    {"termination": ["surface_impact"], "with": {"/control/bank_angle": 180}},
                ]),
            ),
        ],
    )
}

/// A deorbit from a low orbit: when, and how strong.
fn target() -> Value {
    json!({
        "angle_unit": "deg",
        "vehicle": {"mass": 3000, "reference_area": 4, "aerodynamics": {"type": "constant", "drag_coefficient": 1.3}},
        "atmosphere": {"type": "exponential"},
        "initial_state": {"type": "planet_relative", "altitude": 120_000, "longitude": 10, "geocentric_latitude": 20,
            "speed": 7500, "flight_path_angle": -3, "heading": 20},
        "vary": [
            {"pointer": "/initial_state/flight_path_angle", "between": [-6, -2]},
            {"pointer": "/initial_state/heading", "between": [-20, 60]},
        ],
        "achieve": [{"site": {"longitude": 22, "geodetic_latitude": 25}, "tolerance": 1}],
    })
}

fn numbers(values: &Value) -> Vec<f64> {
    values.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

#[tokio::test]
async fn a_corridor_has_bands_gaps_and_samples() {
    let service = Service::new();
    let answer = good_answer(&service, "/corridor", &corridor()).await;
    let [band] = &answer["bands"].as_array().unwrap()[..] else { panic!("{}", answer["bands"]) };
    let (from, to) = (band["from"].as_f64().unwrap(), band["to"].as_f64().unwrap());
    assert!(-12.0 < from && from < to && to < -3.5);
    assert!((band["width"].as_f64().unwrap() - (to - from)).abs() < 1e-12);
    assert_eq!((&band["from_limit"], &band["to_limit"]), (&json!(0), &json!(1)));
    let gaps = answer["gaps"].as_array().unwrap();
    assert!(gaps.len() == 2 && gaps[0]["broken"] == json!([0]) && gaps[1]["broken"] == json!([1]));
    assert_eq!(answer["nearest"], Value::Null);
    // The flights at its ends are those of /simulate.
    for (end, value) in [("from_flights", from), ("to_flights", to)] {
        for (flight, bank_angle) in band[end].as_array().unwrap().iter().zip([0, 180]) {
            let case = with_all(
                &entry(),
                [("/initial_state/flight_path_angle", json!(value)), ("/control/bank_angle", json!(bank_angle))],
            );
            let alone = good_answer(&service, "/simulate", &case).await;
            assert_eq!((&flight["final_state"], &flight["peaks"]), (&alone["final_state"], &alone["peaks"]));
        }
    }
    let load = band["from_flights"][0]["peaks"]["load_factor"]["value"].as_f64().unwrap();
    assert!((load - 12.0).abs() < 1e-5, "{load} g");
    let values = numbers(&answer["samples"]["value"]);
    let margins = &answer["samples"]["limits"][0]["margin"];
    let loads = &answer["samples"]["limits"][0]["value"];
    assert!(values.len() > 30 && values.is_sorted());
    for (margin, load) in numbers(margins).into_iter().zip(numbers(loads)) {
        assert!((margin - (12.0 - load) / 12.0).abs() < 1e-12);
    }
    assert!(answer["search"]["flights"].as_u64().unwrap() < 300, "{}", answer["search"]);
}

/// A schedule whose entries are not in order makes no case, and leaves the flights of the others theirs.
#[tokio::test]
async fn samples_that_are_no_case_leave_the_others_as_they_are() {
    let service = Service::new();
    let schedule = json!({"type": "schedule", "against": "time", "at": [0, 60, 90, 4000], "value": [0, 0, 60, 60]});
    let case = with(&entry(), "/control/bank_angle", schedule);
    let request = with_all(
        &case,
        [
            ("/vary", json!({"pointer": "/control/bank_angle/at/2", "between": [40, 120]})),
            ("/limits", json!([{"quantity": "crossrange", "at_least": 0}])),
        ],
    );
    let answer = good_answer(&service, "/corridor", &request).await;
    let values = numbers(&answer["samples"]["value"]);
    let crossranges = answer["samples"]["limits"][0]["value"].as_array().unwrap();
    let (mut unsound, mut flown) = (0, 0);
    for (value, crossrange) in values.into_iter().zip(crossranges) {
        if value <= 60.0 {
            assert_eq!(crossrange, &Value::Null, "at {value}");
            unsound += 1;
        } else {
            let alone = with_all(
                &case,
                [("/control/bank_angle/at/2", json!(value)), ("/solver", json!({"relative_tolerance": 1e-6}))],
            );
            let alone = good_answer(&service, "/simulate", &alone).await;
            // Samples about the nearest value are flown at the case's tolerance; the flight of another sample lands kilometres away.
            let off = crossrange.as_f64().unwrap() - alone["final_state"]["crossrange"].as_f64().unwrap();
            assert!(off.abs() < 1.0, "{off} m at {value}");
            flown += 1;
        }
    }
    assert!(unsound > 5 && flown > 20, "{unsound} and {flown}");
    assert_eq!(answer["search"]["failed"][0]["count"].as_u64().unwrap(), unsound, "{}", answer["search"]);
}

#[tokio::test]
async fn without_a_band_the_nearest_value_is_told() {
    let service = Service::new();
    let strict = with(&corridor(), "/limits/0/at_most", 0.2);
    let answer = good_answer(&service, "/corridor", &strict).await;
    assert_eq!(answer["bands"], json!([]));
    assert!(answer["nearest"]["margin"].as_f64().unwrap() < 0.0);
    assert!(answer["narrowest"].as_f64().unwrap() > 0.0);
}

/// The longitude and geodetic latitude of the end, the greatest load factor, and the time.
fn goals_of(flown: &Value) -> [f64; 4] {
    let [peak, last] = [&flown["peaks"]["load_factor"]["value"], &flown["final_state"]];
    [&last["longitude"], &last["geodetic_latitude"], peak, &last["time"]].map(|number| number.as_f64().unwrap())
}

/// Looks for a flight that lands at a place, and compares the derivatives of its [goals](goals_of) with central differences of flights; `steps`: by
/// which the numbers are moved.
async fn derivatives_agree_with_flights(request: &Value, place: [f64; 2], steps: [f64; 2]) {
    let service = Service::new();
    let goals = json!([
        {"quantity": "longitude", "equals": place[0], "tolerance": 1e-4},
        {"quantity": "geodetic_latitude", "equals": place[1], "tolerance": 1e-4},
        {"quantity": "load_factor", "at": "peak", "at_most": 100},
        {"quantity": "time", "at_most": 5000},
    ]);
    let answer = good_answer(&service, "/target", &with(request, "/achieve", goals)).await;
    assert_eq!(answer["outcome"], "reached", "{answer}");
    let solution = &answer["solutions"][0];
    let case = with(&solution["case"], "/solver/relative_tolerance", 1e-13);
    let flown_with = async |pointer: &str, value: f64| -> [f64; 4] {
        goals_of(&good_answer(&service, "/simulate", &with(&case, pointer, value)).await)
    };
    for (number, (value, step)) in numbers(&solution["values"]).into_iter().zip(steps).enumerate() {
        let pointer = request["vary"][number]["pointer"].as_str().unwrap();
        let above = flown_with(pointer, value + step).await;
        let below = flown_with(pointer, value - step).await;
        for goal in 0..4 {
            let difference = (above[goal] - below[goal]) / (2.0 * step);
            let derivative = solution["derivatives"][goal][number].as_f64().unwrap();
            // The differences are off by the square of the step, a ten-millionth, and by the noise of flights at 1e-13.
            let allowed = 1e-5 * difference.abs() + 1e-9 / step;
            assert!((derivative - difference).abs() < allowed, "{goal} by {pointer}: {derivative} and {difference}");
        }
    }
}

/// Those of ends and peaks, whether a goal is one value or a range that is kept.
#[tokio::test]
async fn derivatives_of_a_solution_are_those_of_flights_beside_it() {
    derivatives_agree_with_flights(&target(), [22.0, 25.0], [1e-3; 2]).await;
}

/// By numbers that are no part of the initial state.
#[tokio::test]
async fn derivatives_by_a_thrust_and_by_an_entry_of_a_schedule_are_those_of_flights_beside_them() {
    let thrust = json!({"along": "velocity", "value": -3000, "specific_impulse": 300, "propellant": 60});
    let schedule = json!({"type": "schedule", "against": "time", "at": [0, 100, 150, 5000], "value": [0, 20, 60, 60]});
    let case = with_all(
        &target(),
        [
            ("/vehicle/aerodynamics/lift_coefficient", json!(0.3)),
            ("/control", json!({"bank_angle": schedule})),
            ("/events", json!([{"when": {"quantity": "time", "rises_through": 5}, "then": {"thrust": thrust}}])),
        ],
    );
    let flown = ["/vary", "/achieve"].iter().fold(case.clone(), |case, member| without(&case, member));
    let [longitude, latitude, ..] = goals_of(&good_answer(&Service::new(), "/simulate", &flown).await);
    let vary = json!([
        {"pointer": "/events/0/then/thrust/value", "between": [-5000, -2000]},
        {"pointer": "/control/bank_angle/value/2", "between": [40, 80]},
    ]);
    derivatives_agree_with_flights(&with(&case, "/vary", vary), [longitude, latitude], [1.0, 1e-2]).await;
}

#[tokio::test]
async fn a_target_is_reached_and_its_case_can_be_sent_back() {
    let service = Service::new();
    let answer = good_answer(&service, "/target", &with(&target(), "/search", json!({"record": true}))).await;
    assert_eq!(answer["outcome"], "reached", "{answer}");
    assert_eq!(answer["nearest"], Value::Null);
    let solutions = answer["solutions"].as_array().unwrap();
    for solution in solutions {
        assert!(numbers(&solution["misses"]).iter().all(|miss| miss.abs() <= 1.0));
        let flown = good_answer(&service, "/simulate", &solution["case"]).await;
        let last = &flown["final_state"];
        // The case has its own tolerance, at which the end is within a metre: 1e-5° on the ground.
        for (column, place) in [("longitude", 22.0), ("geodetic_latitude", 25.0)] {
            assert!((last[column].as_f64().unwrap() - place).abs() < 3e-5, "{column}: {}", last[column]);
        }
        assert_eq!(solution["isolated"], true);
        assert_eq!(solution["free_direction"], Value::Null);
        // The landing moves to the north as the heading turns to it.
        assert!(solution["derivatives"][1][1].as_f64().unwrap() > 0.0);
        assert!(solution["condition"].as_f64().unwrap() > 1.0);
        let kept = numbers(&solution["values"]);
        assert_eq!(solution["case"]["initial_state"]["heading"], kept[1]);
    }
    assert!(!answer["iterations"].as_array().unwrap().is_empty());
    assert_eq!(answer["complete"], false);
    assert_eq!(answer["search"]["starts"], 97);
    // The same request gives the same answer.
    let again = good_answer(&service, "/target", &target()).await;
    assert_eq!(again["solutions"], answer["solutions"]);
}

#[tokio::test]
async fn one_number_has_all_its_solutions_and_others_are_told_why_not() {
    let service = Service::new();
    let one = with_all(
        &target(),
        [
            ("/vary", json!([{"pointer": "/initial_state/flight_path_angle", "between": [-60, -2]}])),
            ("/achieve", json!([{"quantity": "load_factor", "at": "peak", "equals": 20}])),
        ],
    );
    let answer = good_answer(&service, "/target", &one).await;
    assert_eq!((&answer["outcome"], &answer["complete"]), (&json!("reached"), &json!(true)));
    let load = answer["solutions"][0]["peaks"]["load_factor"]["value"].as_f64().unwrap();
    assert!((load - 20.0).abs() < 1e-4, "{load}");
    let beyond = with(&one, "/achieve/0/equals", 500);
    let answer = good_answer(&service, "/target", &beyond).await;
    assert_eq!(answer["outcome"], "not_reached");
    assert!(answer["reach"][0]["greatest"].as_f64().unwrap() < 500.0);
    assert!(answer["nearest"]["misses"][0].as_f64().unwrap() < 0.0);
    // A light body falls at its terminal speed, whatever its entry.
    let light =
        with_all(&one, [("/vehicle/mass", json!(30)), ("/achieve", json!([{"quantity": "speed", "equals": 300}]))]);
    let answer = good_answer(&service, "/target", &light).await;
    assert_eq!(answer["nearest"]["insensitive"], json!([0]), "{}", answer["nearest"]);
    // No flight ends so.
    let load = one["achieve"][0].clone();
    let never = with(&one, "/achieve", json!([load, {"termination": ["atmosphere_exit"]}]));
    let answer = good_answer(&service, "/target", &never).await;
    assert_eq!((&answer["nearest"], &answer["reach"]), (&Value::Null, &json!([null])));
    assert_eq!(answer["search"]["classes"], json!(["surface_impact"]));
    let few = with(&target(), "/search", json!({"flights": 30}));
    assert_eq!(good_answer(&service, "/target", &few).await["outcome"], "out_of_budget");
}

/// The thesis's program TARGET solves entry as a boundary value problem, and finds one of its two solutions: that of its table 1 is ascending.
#[tokio::test]
async fn the_boundary_values_of_target_have_an_ascending_and_a_descending_solution() {
    let example = include_str!("../../openapi/examples/boundary_values.json");
    let request: Value = serde_json::from_str(example).unwrap();
    let answer = good_answer(&Service::new(), "/target", &request).await;
    let solutions = answer["solutions"].as_array().unwrap();
    let headings: Vec<_> = solutions.iter().map(|solution| numbers(&solution["values"])[3]).collect();
    let climbs = |heading: &&f64| heading.sin() > 0.0;
    assert!(headings.iter().any(|it| climbs(&it)) && !headings.iter().all(|it| climbs(&it)), "{headings:?}");
    // Table 1: the numbers of the problem are rounded to its digits.
    let known = [-1.788_871_8, 0.590_298_1, 18_219.975, 1.150_579_3];
    let is_known =
        |solution: &Value| numbers(&solution["values"]).iter().zip(known).all(|(a, b)| (a / b - 1.0).abs() < 2e-5);
    assert!(solutions.iter().any(is_known), "{}", answer["solutions"]);
    // No entry from there arrives as fast.
    let too_fast = with(&request, "/achieve/3/equals", 12_000);
    let answer = good_answer(&Service::new(), "/target", &too_fast).await;
    assert_eq!(answer["outcome"], "not_reached");
    assert!(answer["reach"][3]["greatest"].as_f64().unwrap() < 12_000.0);
}

/// A launch whose first stage is to come down where that of another tilt does.
#[tokio::test]
async fn a_requirement_may_be_on_the_flight_of_a_body() {
    let service = Service::new();
    let launcher: Value = serde_json::from_str(include_str!("../../openapi/examples/launcher.json")).unwrap();
    let other = good_answer(&service, "/simulate", &with(&launcher, "/events/1/then/tilt/angle", 1.03)).await;
    let bodies = other["bodies"].as_array().unwrap();
    let stage = bodies.iter().find(|body| body["name"] == "first stage").unwrap();
    let range = stage["final_state"]["ground_range"].as_f64().unwrap();
    let load = stage["peaks"]["load_factor"]["value"].as_f64().unwrap();
    let ends = json!({"termination": ["surface_impact"], "body": "first stage"});
    let request = with_all(
        &launcher,
        [
            ("/vary", json!([{"pointer": "/events/1/then/tilt/angle", "between": [1, 1.036]}])),
            (
                "/achieve",
                json!([
                    {"quantity": "ground_range", "body": "first stage", "equals": range, "tolerance": 0.1},
                    {"termination": ["condition", "surface_impact"]},
                    ends,
                ]),
            ),
        ],
    );
    let answer = good_answer(&service, "/target", &request).await;
    assert_eq!(answer["outcome"], "reached", "{answer}");
    let tilt = answer["solutions"][0]["values"][0].as_f64().unwrap();
    assert!((tilt - 1.03).abs() < 1e-5, "{tilt}");
    // A limit on its loads, where the tilt at which they are just kept is known.
    let limits = json!([
        {"quantity": "load_factor", "at": "peak", "body": "first stage", "at_most": load},
        ends,
    ]);
    let vary = json!({"pointer": "/events/1/then/tilt/angle", "between": [1, 1.036]});
    let corridor = with_all(&launcher, [("/vary", vary), ("/limits", limits), ("/resolution", json!(1e-5))]);
    let answer = good_answer(&service, "/corridor", &corridor).await;
    let band = &answer["bands"][0];
    let edges = [band["from"].as_f64().unwrap(), band["to"].as_f64().unwrap()];
    assert!(edges.iter().any(|edge| (edge - 1.03).abs() < 3e-5), "{edges:?}");
    // What never leaves has no flight.
    let never = with(&request, "/events/2/when/delay", 9000);
    let answer = good_answer(&service, "/target", &never).await;
    assert_eq!((&answer["outcome"], &answer["reach"]), (&json!("not_reached"), &json!([null])));
    let faulty = with(&request, "/achieve/0/body", "booster");
    let detail = "must be the name of a body that an event of the case separates, got \"booster\"";
    Steady::new().await.refused_at("/target", &faulty, &[("/achieve/0/body", detail)]).await;
}

#[tokio::test]
async fn an_apoapsis_is_followed_through_the_parabola() {
    let service = Service::new();
    // Below, flights are captured and come down; above, they leave for good.
    let capture = with_all(
        &entry(),
        [
            ("/vary", json!([{"pointer": "/initial_state/flight_path_angle", "between": [-7, -4.5]}])),
            (
                "/achieve",
                json!([
                    {"quantity": "apoapsis_altitude", "equals": 2e7, "tolerance": 1000},
                    {"termination": ["atmosphere_exit"]},
                ]),
            ),
            ("/initial_state/speed", json!(11_500)),
        ],
    );
    let answer = good_answer(&service, "/target", &capture).await;
    assert_eq!(answer["outcome"], "reached", "{answer}");
    let miss = answer["solutions"][0]["misses"][0].as_f64().unwrap();
    assert!(miss.abs() <= 1000.0, "{miss} m");
}

#[tokio::test]
async fn coupled_numbers_and_schedules_vary() {
    let service = Service::new();
    let schedule = json!({"type": "schedule", "against": "time", "at": [0, 150], "value": [40, -40]});
    let request = with_all(
        &entry(),
        [
            ("/control/bank_angle", schedule),
            ("/initial_state/speed", json!(7600)),
            ("/initial_state/flight_path_angle", json!(-3)),
            (
                "/vary",
                json!([{"pointer": "/control/bank_angle/value/0", "between": [0, 80],
                    "also": [{"pointer": "/control/bank_angle/value/1", "factor": -1}]}]),
            ),
            ("/achieve", json!([{"quantity": "ground_range", "equals": 1_300_000}])),
        ],
    );
    let answer = good_answer(&service, "/target", &request).await;
    for solution in answer["solutions"].as_array().unwrap() {
        let value = &solution["case"]["control"]["bank_angle"]["value"];
        assert!((value[0].as_f64().unwrap() + value[1].as_f64().unwrap()).abs() < 1e-12);
    }
    assert!(answer["reach"][0]["greatest"].as_f64().unwrap() > answer["reach"][0]["least"].as_f64().unwrap());
}

/// A short entry of which the bank angle and the flight-path angle vary.
fn footprint() -> Value {
    with_all(
        &with(&entry(), "/initial_state/speed", 7500),
        [
            ("/atmosphere", json!({"type": "exponential"})),
            ("/initial_state/longitude", json!(171)),
            (
                "/vary",
                json!([
                    {"pointer": "/control/bank_angle", "between": [-80, 80]},
                    {"pointer": "/initial_state/flight_path_angle", "between": [-7, -5]},
                ]),
            ),
            ("/resolution", json!(5000)),
            // Footprints need no more, and flights are faster by it.
            ("/solver", json!({"relative_tolerance": 1e-6})),
        ],
    )
}

/// The rings of a geometry, each closed.
fn rings(geometry: &Value) -> Vec<Vec<Vec<f64>>> {
    let polygons = geometry["coordinates"].as_array().unwrap();
    let rings = polygons.iter().flat_map(|polygon| polygon.as_array().unwrap());
    rings.map(|ring| ring.as_array().unwrap().iter().map(numbers).collect()).collect()
}

#[tokio::test]
async fn a_footprint_has_a_boundary_extremes_and_points() {
    let service = Service::patient();
    let answer = good_answer(&service, "/footprint", &footprint()).await;
    assert_eq!((&answer["complete"], &answer["landed"], &answer["curve"]), (&json!(true), &json!(1.0), &Value::Null));
    assert!(answer["area"].as_f64().unwrap() > 1e9 && answer["pieces"] == 1, "{}", answer["area"]);
    let boundary = rings(&answer["boundary"]);
    assert!(answer["boundary"]["type"] == "MultiPolygon" && boundary.len() >= 2, "it crosses the antimeridian");
    for ring in boundary.iter().chain(&rings(&answer["hull"])) {
        assert!(ring.len() > 3 && ring.first() == ring.last());
        assert!(ring.iter().all(|place| place[0].abs() <= 180.0 && place[1].abs() <= 90.0));
    }
    // The extremes are flights of /simulate.
    let flown = async |values: &Value| {
        let case = with_all(
            &entry(),
            [
                ("/initial_state/speed", json!(7500)),
                ("/initial_state/longitude", json!(171)),
                ("/atmosphere", json!({"type": "exponential"})),
                ("/solver", json!({"relative_tolerance": 1e-6})),
                ("/control/bank_angle", values[0].clone()),
                ("/initial_state/flight_path_angle", values[1].clone()),
            ],
        );
        good_answer(&service, "/simulate", &case).await["final_state"].clone()
    };
    let mut crossranges = Vec::new();
    for quantity in ["downrange", "crossrange"] {
        let ends = answer["extent"][quantity].as_array().unwrap();
        let values: Vec<_> = ends.iter().map(|end| end["value"].as_f64().unwrap()).collect();
        assert!(values[0] < values[1]);
        for end in ends {
            let last = flown(&end["values"]).await;
            assert!((last[quantity].as_f64().unwrap() - end["value"].as_f64().unwrap()).abs() < 1e-6);
            assert_eq!(last["longitude"], end["site"]["longitude"]);
        }
        crossranges = values;
    }
    assert!(crossranges[0] < 0.0 && crossranges[1] > 0.0);
    let points = &answer["points"];
    let count = points["longitude"].as_array().unwrap().len();
    assert!(count > 500 && answer["search"]["flights"].as_u64().unwrap() > count as u64);
    assert_eq!(points["values"].as_array().unwrap().len(), 2);
    let last = flown(&json!([points["values"][0][7], points["values"][1][7]])).await;
    for column in ["longitude", "geodetic_latitude", "downrange", "crossrange"] {
        let difference = last[column].as_f64().unwrap() - points[column][7].as_f64().unwrap();
        assert!(difference.abs() < 1e-6, "{column}: {difference}");
    }
    assert_eq!(answer["landing"]["site"]["longitude"], points["longitude"][0]);
}

#[tokio::test]
async fn of_one_number_a_footprint_is_a_curve() {
    let service = Service::patient();
    let one = with(&footprint(), "/vary", json!([{"pointer": "/control/bank_angle", "between": [-180, 180]}]));
    let answer = good_answer(&service, "/footprint", &one).await;
    let lines = answer["curve"]["coordinates"].as_array().unwrap();
    assert!(lines.len() >= 2 && answer["curve"]["type"] == "MultiLineString", "it crosses the antimeridian");
    // The whole turn ends where it begins.
    assert!(answer["area"].as_f64().unwrap() > 1e8);
    let limits = json!([{"quantity": "load_factor", "at": "peak", "at_most": 10}]);
    let limited = good_answer(&service, "/footprint", &with(&one, "/limits", limits)).await;
    assert!(limited["within_limits"].as_f64().unwrap() < 1.0 && limited["area"] == 0.0, "{}", limited["within_limits"]);
    let kept = limited["points"]["within_limits"].as_array().unwrap();
    assert!(kept.contains(&json!(true)) && kept.contains(&json!(false)));
}

#[tokio::test]
async fn a_footprint_tells_what_does_not_land_and_what_is_coarse() {
    let service = Service::patient();
    let skips = with_all(
        &footprint(),
        [
            ("/vary/1/between", json!([-7, -0.5])),
            ("/initial_state/speed", json!(10_600)),
            ("/search", json!({"flights": 1500})),
        ],
    );
    let answer = good_answer(&service, "/footprint", &skips).await;
    let codes: Vec<_> = answer["warnings"].as_array().unwrap().iter().map(|warning| warning["code"].clone()).collect();
    assert!(codes.contains(&json!("partly_landed")) && codes.contains(&json!("coarse_boundary")), "{codes:?}");
    assert!(answer["landed"].as_f64().unwrap() < 1.0 && answer["complete"] == false);
    assert!(answer["classes"].as_array().unwrap().contains(&json!("atmosphere_exit")));
    let never = with(&footprint(), "/stop/time", 10);
    let answer = good_answer(&service, "/footprint", &never).await;
    assert_eq!((&answer["area"], &answer["landing"], &answer["landed"]), (&json!(0.0), &Value::Null, &json!(0.0)));
    assert_eq!(answer["extent"]["downrange"], json!([null, null]));
}

#[tokio::test]
async fn a_footprint_is_a_map() {
    let service = Service::patient();
    let map = service.post("/footprint?format=geojson", &footprint()).await;
    assert_eq!(map.status, StatusCode::OK);
    let map: Value = serde_json::from_slice(&map.body).unwrap();
    let features = map["features"].as_array().unwrap();
    let kinds: Vec<_> = features.iter().map(|feature| feature["properties"]["kind"].clone()).collect();
    let expected = [
        "boundary",
        "hull",
        "landing",
        "least downrange",
        "greatest downrange",
        "least crossrange",
        "greatest crossrange",
    ];
    assert_eq!(kinds, expected);
}

#[tokio::test]
async fn faults_stand_where_they_are() {
    let steady = Steady::new().await;
    let of = |request: Value, path: &'static str, pointers: &'static [&'static str]| (request, path, pointers);
    for (request, path, pointers) in [
        of(without(&corridor(), "/vary"), "/corridor", &["/vary"]),
        of(without(&corridor(), "/limits"), "/corridor", &["/limits"]),
        of(with(&corridor(), "/vary/pointer", "/vehicle/masses"), "/corridor", &["/vary/pointer"]),
        of(with(&corridor(), "/vary/pointer", "/solver/relative_tolerance"), "/corridor", &["/vary/pointer"]),
        of(with(&corridor(), "/vary/pointer", "/vary/between/0"), "/corridor", &["/vary/pointer"]),
        of(with(&corridor(), "/vary/between", json!([-100, -3])), "/corridor", &["/vary/between/0"]),
        of(with(&corridor(), "/vary/between", json!([-12, -8])), "/corridor", &["/vary/between"]),
        of(with(&corridor(), "/vary/between", json!([-3, -8])), "/corridor", &["/vary/between/1"]),
        of(
            with_all(
                &corridor(),
                [
                    ("/vary/pointer", json!("/vehicle/aerodynamics/lift_coefficient")),
                    ("/vary/between", json!([-1e308, 1.7e308])),
                ],
            ),
            "/corridor",
            &["/vary/between"],
        ),
        of(with(&corridor(), "/vary/scale", 0), "/corridor", &["/vary/scale"]),
        of(with(&corridor(), "/limits/0/equals", 3), "/corridor", &["/limits/0/equals"]),
        of(with(&corridor(), "/limits/0/at_least", 3), "/corridor", &["/limits/0"]),
        of(with(&corridor(), "/limits/0/quantity", "g"), "/corridor", &["/limits/0/quantity"]),
        of(with(&corridor(), "/limits/0/quantity", "heat_load"), "/corridor", &["/limits/0/quantity"]),
        of(with(&corridor(), "/limits/0/at", json!({"event": "x"})), "/corridor", &["/limits/0/at/event"]),
        of(with(&corridor(), "/limits/0/body", "x"), "/corridor", &["/limits/0/body"]),
        of(
            with(&corridor(), "/limits/0/with", json!({"/control/bank_angle": 400})),
            "/corridor",
            &["/limits/0/with/~1control~1bank_angle"],
        ),
        of(
            with(&corridor(), "/limits/0/with", json!({"/control/bank": 4, "/initial_state/flight_path_angle": -4})),
            "/corridor",
            &["/limits/0/with/~1control~1bank", "/limits/0/with/~1initial_state~1flight_path_angle"],
        ),
        of(with(&corridor(), "/limits/1/termination", json!(["crash"])), "/corridor", &["/limits/1/termination/0"]),
        of(with(&corridor(), "/resolution", -1), "/corridor", &["/resolution"]),
        of(with(&corridor(), "/sensitivities", true), "/corridor", &["/sensitivities"]),
        of(with(&corridor(), "/verify", true), "/corridor", &["/verify"]),
        of(with(&corridor(), "/vehicle/mass", -1), "/corridor", &["/vehicle/mass"]),
        of(with(&target(), "/vary", json!([])), "/target", &["/vary"]),
        of(with(&target(), "/vary/1/pointer", "/initial_state/flight_path_angle"), "/target", &["/vary/1/pointer"]),
        of(
            with(&target(), "/vary/0/also", json!([{"pointer": "/control/bank_angle", "factor": 1000}])),
            "/target",
            &["/vary/0/also/0/factor"],
        ),
        of(with(&target(), "/achieve", json!([{"termination": ["surface_impact"]}])), "/target", &["/achieve"]),
        of(with(&target(), "/achieve/0/site", "atlantis"), "/target", &["/achieve/0/site"]),
        of(with(&target(), "/achieve/0/tolerance", 0), "/target", &["/achieve/0/tolerance"]),
        of(with(&target(), "/search", json!({"flights": 0})), "/target", &["/search/flights"]),
        of(without(&footprint(), "/vary"), "/footprint", &["/vary"]),
        of(
            with(&footprint(), "/vary/1/pointer", "/control/bank_angle"),
            "/footprint",
            &["/vary/1/pointer", "/vary/1/between"],
        ),
        of(with(&footprint(), "/resolution", 0), "/footprint", &["/resolution"]),
        of(with(&footprint(), "/search", json!({"flights": 200_000})), "/footprint", &["/search/flights"]),
        of(
            with(&footprint(), "/limits", json!([{"quantity": "load_factor", "at": "peak", "equals": 3}])),
            "/footprint",
            &["/limits/0", "/limits/0/equals"],
        ),
        of(
            with(&footprint(), "/limits", json!([{"quantity": "g", "at_most": 3}])),
            "/footprint",
            &["/limits/0/quantity"],
        ),
    ] {
        let answer = steady.service.post(path, &request).await;
        assert_eq!(answer.status, StatusCode::UNPROCESSABLE_ENTITY, "{}", answer.json());
        let mut found = answer.pointers();
        found.dedup();
        assert_eq!(found, pointers, "{}", answer.json());
        steady.is_as_before(&answer.json()).await;
    }
}

/// A search that has no time left tells what it has found.
#[tokio::test]
async fn a_target_out_of_time_is_no_failure() {
    let deadline = std::time::Duration::from_millis(500);
    let service = Service::with(Config { deadline, ..Config::default() });
    // A thousand revolutions each.
    let slow = with_all(
        &target(),
        [
            ("/search", json!({"starts": 1000, "flights": 1_000_000})),
            ("/atmosphere", json!({"type": "vacuum"})),
            ("/initial_state/altitude", json!(400_000)),
            ("/initial_state/speed", json!(7300)),
            ("/initial_state/flight_path_angle", json!(0)),
            ("/vary/0/between", json!([-0.5, 0.5])),
            ("/stop", json!({"time": 6e6})),
        ],
    );
    let answer = service.post("/target", &slow).await;
    assert_eq!(answer.status, StatusCode::OK, "{}", answer.json());
    assert_eq!(answer.json()["nearest"], Value::Null);
    assert_eq!(answer.json()["outcome"], "out_of_budget");
}
