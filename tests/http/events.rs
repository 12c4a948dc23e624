//! Events and conditions in the answer: what happened when, in which order, how a flight ended, and what rows show of it.

use std::f64::consts::FRAC_PI_2;

use reentry_tests::cases::read_json;
use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::refusal::good_answer;
use super::requests::{capsule, condition, event, model, with, with_all, without};
use super::simulate::{COLUMNS, codes, fly, names};

/// The capsule in standard air, with few rows.
fn entry() -> Value {
    with_all(&capsule(), [("/atmosphere", json!({"type": "us76"})), ("/output", json!({"count": 2}))])
}

/// The same with events.
fn eventful(events: &[Value]) -> Value {
    with(&entry(), "/events", json!(events))
}

/// An event that changes nothing.
fn mark(quantity: &str, way: &str, value: f64) -> Value {
    json!({"when": condition(quantity, way, value)})
}

fn mass(time: f64, mass: f64) -> Value {
    event("time", "rises_through", time, &json!({"mass": mass}))
}

fn push(along: &str, value: f64) -> Value {
    json!({"delta_v": {"along": along, "value": value}})
}

fn burn(along: &str, value: f64) -> Value {
    json!({"along": along, "value": value, "specific_impulse": 300})
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// What happened: the places in the list of the request, in order.
fn order(answer: &Value) -> Vec<u64> {
    answer["events"].as_array().unwrap().iter().map(|event| event["index"].as_u64().unwrap()).collect()
}

/// The times of what happened.
fn times(answer: &Value) -> Vec<f64> {
    answer["events"].as_array().unwrap().iter().map(|event| number(&event["time"])).collect()
}

#[tokio::test]
async fn the_answer_has_what_happened_in_order_with_the_states_before_and_after() {
    let parachute = json!({"reference_area": 200, "aerodynamics": {"type": "constant", "drag_coefficient": 0.8}});
    let answer = fly(&eventful(&[
        with(&event("mach", "falls_through", 0.9, &parachute), "/name", "parachute"),
        mark("altitude", "rises_through", 2e5),
        with(&mark("altitude", "falls_through", 1e5), "/name", "entry"),
        mass(200.0, 5000.0),
    ]))
    .await;
    assert_eq!(order(&answer), [2, 3, 0], "the second never happens");
    let happened = answer["events"].as_array().unwrap();
    assert_eq!(names(&happened[0]), ["index", "name", "time", "state", "after"]);
    assert_eq!(names(&happened[1]), ["index", "time", "state", "after"]);
    assert_eq!((&happened[0]["name"], &happened[2]["name"]), (&json!("entry"), &json!("parachute")));
    assert!(times(&answer).is_sorted());
    for event in happened {
        for state in ["state", "after"] {
            assert_eq!(names(&event[state]), names(&answer["initial_state"]));
            assert_eq!(event[state]["time"], event["time"]);
        }
    }
    assert_eq!(happened[0]["state"], happened[0]["after"], "a mark changes nothing");
    // To the resolution of a condition, a part in 10^9.
    check::relative("altitude", number(&happened[0]["state"]["altitude"]), 1e5, 1e-9);
    check::relative("Mach number", number(&happened[2]["state"]["mach"]), 0.9, 1e-9);
    assert_eq!(happened[1]["time"], json!(200.0));
    assert_eq!([&happened[1]["state"]["mass"], &happened[1]["after"]["mass"]], [&json!(5500.0), &json!(5000.0)]);
    // By the drag area: 200 · 0.8 over 12 · 1.3.
    let [before, after] = ["state", "after"].map(|state| number(&happened[2][state]["load_factor"]));
    check::relative("opening shock", after / before, 200.0 * 0.8 / (12.0 * 1.3), 1e-12);
}

#[tokio::test]
async fn where_nothing_can_happen_nothing_is_said_of_it() {
    for case in [entry(), eventful(&[])] {
        let answer = fly(&with(&case, "/echo", true)).await;
        assert_eq!((answer.get("events"), answer.get("condition")), (None, None));
        assert_eq!(answer["case"].get("events"), case.get("events"));
        assert_eq!(names(&answer["case"]["stop"]), ["altitude", "time"]);
        assert_eq!(names(&answer["initial_state"]).last(), Some(&"ground_distance"));
    }
    let answer = fly(&eventful(&[mark("speed", "rises_through", 1e5)])).await;
    assert_eq!(answer["events"], json!([]), "it can happen, and does not");
    assert_eq!(answer["initial_state"].get("mass"), None, "a mark has no mass");
}

#[tokio::test]
async fn an_impulse_changes_the_velocity_along_its_direction() {
    let pushed = |along: &'static str, value: f64| async move {
        let answer = fly(&eventful(&[event("altitude", "falls_through", 1e5, &push(along, value))])).await;
        let of = |state: &str, name: &str| number(&answer["events"][0][state][name]);
        [
            of("after", "speed") - of("state", "speed"),
            of("after", "speed") * of("after", "flight_path_angle").sin()
                - of("state", "speed") * of("state", "flight_path_angle").sin(),
            of("after", "heading") - of("state", "heading"),
        ]
    };
    // Roundings of 7.5 km/s and its angles.
    let [faster, ..] = pushed("velocity", -120.0).await;
    check::near("speed", faster, -120.0, 1e-9);
    let [_, climbs, turns] = pushed("radial", 40.0).await;
    check::near("climb", climbs, 40.0, 1e-9);
    check::near("no turn", turns, 0.0, 1e-12);
    let [_, climbs, left] = pushed("normal", 60.0).await;
    check::near("level", climbs, 0.0, 1e-9);
    assert!(left > 0.0, "towards a growing heading");
}

#[tokio::test]
async fn a_row_at_an_event_shows_what_is_after_it_and_the_first_row_what_was_given() {
    let service = Service::new();
    let case = with_all(
        &eventful(&[
            mass(0.0, 5000.0),
            mass(100.0, 4000.0),
            event("time", "rises_through", 100.0, &push("radial", 50.0)),
            mass(300.0, 3000.0),
        ]),
        [("/output", json!({"times": [100, 200]})), ("/stop", json!({"time": 300}))],
    );
    let answer = good_answer(&service, "/simulate", &case).await;
    assert_eq!(answer["trajectory"]["time"], json!([0.0, 100.0, 200.0, 300.0]));
    assert_eq!(answer["trajectory"]["mass"], json!([5500.0, 4000.0, 4000.0, 3000.0]));
    for name in names(&answer["trajectory"]) {
        let row = |index: usize| &answer["trajectory"][name][index];
        assert_eq!(row(0), &answer["events"][0]["state"][name], "{name}");
        assert_eq!(row(1), &answer["events"][2]["after"][name], "{name}");
        assert_eq!(row(3), &answer["events"][3]["after"][name], "{name}");
        assert_eq!((row(0), row(3)), (&answer["initial_state"][name], &answer["final_state"][name]), "{name}");
    }
    let csv = service.post("/simulate?format=csv", &case).await;
    let csv = String::from_utf8(csv.body.to_vec()).unwrap();
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    assert_eq!((header.len(), header.last()), (COLUMNS.len() + 5, Some(&"ground_distance")));
    for (row, line) in lines.enumerate() {
        for (name, cell) in header.iter().zip(line) {
            assert_eq!(cell, answer["trajectory"][*name][row].to_string(), "{name} of row {row}");
        }
    }
    let chosen = with(&case, "/output/columns", json!(["mass", "time"]));
    let csv = service.post("/simulate?format=csv", &chosen).await;
    let expected = "mass,time\n5500.0,0.0\n4000.0,100.0\n4000.0,200.0\n3000.0,300.0\n";
    assert_eq!(String::from_utf8(csv.body.to_vec()).unwrap(), expected);
}

#[tokio::test]
async fn a_condition_or_the_ceiling_ends_the_flight_and_the_answer_says_which() {
    let stop = |when: &[Value]| with(&entry(), "/stop", json!({"when": when}));
    let [early, late] =
        [("altitude", 6e4), ("speed", 300.0)].map(|(quantity, value)| condition(quantity, "falls_through", value));
    for (when, index, name, value) in [
        (vec![late.clone(), early.clone()], 1, "altitude", 6e4),
        (vec![condition("load_factor", "rises_through", 1e3), late.clone()], 1, "speed", 300.0),
        // Of those of one instant the first.
        (vec![late, early.clone(), early], 1, "altitude", 6e4),
    ] {
        let answer = fly(&stop(&when)).await;
        assert_eq!((&answer["termination"], &answer["condition"]), (&json!("condition"), &json!(index)));
        check::relative(name, number(&answer["final_state"][name]), value, 1e-9);
    }
    let climbs =
        with_all(&entry(), [("/initial_state/flight_path_angle", json!(0.05)), ("/stop", json!({"ceiling": 150_000}))]);
    let answer = fly(&climbs).await;
    assert_eq!((&answer["termination"], answer.get("condition")), (&json!("atmosphere_exit"), None));
    check::relative("ceiling", number(&answer["final_state"]["altitude"]), 150_000.0, 1e-9);
    // Downwards it ends nothing.
    let answer = fly(&with(&entry(), "/stop", json!({"ceiling": 1e5}))).await;
    assert_eq!((&answer["termination"], answer.get("condition")), (&json!("surface_impact"), None));
}

#[tokio::test]
async fn degrees_give_the_same_events_as_radians() {
    let angle = |quantity: f64| {
        let steep = condition("flight_path_angle", "falls_through", quantity);
        (steep.clone(), json!([{"when": steep}]))
    };
    let case = |unit: &str, of_radians: fn(f64) -> f64| {
        let ((_, events), (end, _)) = (angle(of_radians(-0.1)), angle(of_radians(-0.9)));
        let mut case =
            with_all(&entry(), [("/angle_unit", json!(unit)), ("/events", events), ("/stop", json!({"when": [end]}))]);
        for name in ["longitude", "geocentric_latitude", "flight_path_angle", "heading"] {
            let radians = number(&case["initial_state"][name]);
            case["initial_state"][name] = json!(of_radians(radians));
        }
        case
    };
    let [radians, degrees] = [fly(&case("rad", |angle| angle)).await, fly(&case("deg", f64::to_degrees)).await];
    assert_eq!([&radians["condition"], &degrees["condition"]], [&json!(0), &json!(0)]);
    for (place, value) in [("/events/0/state", -0.1), ("/events/0/after", -0.1), ("/final_state", -0.9)] {
        let [rad, deg] = [&radians, &degrees].map(|answer| answer.pointer(place).unwrap());
        check::near(place, number(&rad["flight_path_angle"]), value, 1e-9);
        check::near(place, number(&deg["flight_path_angle"]), f64::to_degrees(value), 1e-7);
        // A rounding of the angles that were sent, which the flight magnifies.
        check::near("time", number(&deg["time"]), number(&rad["time"]), 1e-8);
        check::near("longitude", number(&deg["longitude"]).to_radians(), number(&rad["longitude"]), 1e-12);
    }
}

#[tokio::test]
async fn the_echo_of_events_is_complete_and_flies_again() {
    let constant = json!({"aerodynamics": {"type": "constant", "drag_coefficient": 1}});
    let thrust = with(&burn("velocity", -100.0), "/propellant", 5);
    let events = [
        mark("time", "rises_through", 1.0),
        event("time", "rises_through", 2.0, &constant),
        event("time", "rises_through", 3.0, &json!({"thrust": thrust})),
        event("time", "rises_through", 4.0, &json!({"thrust": "off"})),
    ];
    let stop = json!({"when": [condition("altitude", "falls_through", 5e4)], "ceiling": 2e5});
    let answer = fly(&with_all(&eventful(&events), [("/stop", stop.clone()), ("/echo", json!(true))])).await;
    let filled = with_all(
        &json!(events),
        [("/0", json!({"when": events[0]["when"], "then": {}})), ("/1/then/aerodynamics/lift_coefficient", json!(0.0))],
    );
    assert_eq!(answer["case"]["events"], filled);
    assert_eq!(answer["case"]["stop"], with_all(&stop, [("/altitude", json!(0.0)), ("/time", json!(10_000.0))]));
    let again = fly(&answer["case"]).await;
    for part in ["events", "final_state", "condition", "peaks", "case"] {
        assert_eq!(again[part], answer[part], "{part}");
    }
}

#[tokio::test]
async fn events_of_one_instant_happen_in_the_order_of_the_list() {
    let parachute = json!({"reference_area": 1200});
    let answer = fly(&eventful(&[
        mark("load_factor", "rises_through", 100.0),
        mass(200.0, 4000.0),
        event("time", "rises_through", 200.0, &parachute),
        mass(200.0, 2000.0),
    ]))
    .await;
    // What the parachute makes of the load lets the first of the list happen, before the fourth, which was due as well.
    assert_eq!(order(&answer), [1, 2, 0, 3]);
    assert_eq!(times(&answer), [200.0; 4]);
    for pair in answer["events"].as_array().unwrap().windows(2) {
        assert_eq!(pair[0]["after"], pair[1]["state"], "each on what the ones before it have made");
    }
    let masses = answer["events"].as_array().unwrap().iter().map(|event| number(&event["after"]["mass"]));
    assert_eq!(masses.collect::<Vec<_>>(), [4000.0, 4000.0, 4000.0, 2000.0]);
}

#[tokio::test]
async fn what_holds_at_the_start_happens_when_it_has_been_on_the_other_side() {
    // It starts at 7.5 km/s and -0.05 rad, gains speed at first, and skips out of the air for a while.
    let skips = with_all(
        &eventful(&[
            mark("altitude", "falls_through", 2e5),
            mark("speed", "falls_through", 8000.0),
            mark("flight_path_angle", "falls_through", 0.01),
            mark("time", "rises_through", 50.0),
        ]),
        [("/vehicle/aerodynamics/lift_coefficient", json!(0.5)), ("/stop", json!({"time": 400}))],
    );
    let answer = fly(&skips).await;
    assert_eq!(order(&answer), [3, 2]);
    let back = &answer["events"][1];
    check::near("angle", number(&back["state"]["flight_path_angle"]), 0.01, 1e-9);
    let climbed = fly(&with(&skips, "/events/2/when", condition("flight_path_angle", "rises_through", 0.01))).await;
    assert!(times(&climbed)[1] < times(&answer)[1], "it was on the other side before");
}

#[tokio::test]
async fn what_begins_on_its_value_happens_at_once_if_it_moves_on() {
    let on_values = |quantity: &str, value: f64| {
        eventful(&["falls_through", "rises_through"].map(|way| mark(quantity, way, value)))
    };
    for (quantity, value, moves) in
        // Gravity gains on the drag at first, and the flight path bends less than the Earth.
        [("altitude", 120_000.0, 0), ("speed", 7500.0, 1), ("flight_path_angle", -0.05, 1)]
    {
        let answer = fly(&on_values(quantity, value)).await;
        assert_eq!((order(&answer)[0], times(&answer)[0].to_bits()), (moves, 0.0_f64.to_bits()), "{quantity}");
        assert!(times(&answer)[1..].iter().all(|time| *time > 1.0), "{quantity}: the other way comes later, if at all");
    }
    let answer = fly(&eventful(&[mark("time", "rises_through", 0.0)])).await;
    assert_eq!(times(&answer), [0.0]);
    assert_eq!(answer["events"][0]["state"], answer["initial_state"]);
}

#[tokio::test]
async fn an_event_whose_effect_undoes_its_condition_happens_once() {
    let slow = condition("speed", "falls_through", 6000.0);
    let answer = fly(&eventful(&[
        json!({"when": slow, "then": push("velocity", 200.0)}),
        mark("speed", "rises_through", 6100.0),
    ]))
    .await;
    // The push lets the second happen at the same instant; then both are over, though 6 km/s are passed once more.
    assert_eq!(order(&answer), [0, 1]);
    assert_eq!(times(&answer)[0].to_bits(), times(&answer)[1].to_bits());
    check::near("speed", number(&answer["events"][0]["after"]["speed"]), 6200.0, 1e-5);
    assert!(number(&answer["final_state"]["speed"]) < 200.0);
    // A stop on the same condition comes after what it sets off.
    let case = eventful(&[json!({"when": slow, "then": push("velocity", 200.0)})]);
    let stopped = fly(&with(&case, "/stop", json!({"when": [slow]}))).await;
    assert_eq!((&stopped["termination"], order(&stopped)), (&json!("condition"), vec![0]));
    check::near("speed", number(&stopped["final_state"]["speed"]), 6200.0, 1e-5);
}

#[tokio::test]
async fn what_happens_at_the_end_happens_and_the_stop_altitude_or_time_ends_the_flight() {
    let ground = condition("altitude", "falls_through", 1e4);
    let case = with(
        &eventful(&[json!({"when": ground, "then": {"mass": 100}})]),
        "/stop",
        json!({"altitude": 1e4, "when": [ground]}),
    );
    let answer = fly(&case).await;
    assert_eq!((&answer["termination"], answer.get("condition")), (&json!("stop_altitude"), None));
    assert_eq!((order(&answer), &answer["final_state"]["mass"]), (vec![0], &json!(100.0)));
    assert_eq!(answer["events"][0]["time"], answer["final_state"]["time"]);

    let then = condition("time", "rises_through", 60.0);
    let case = with(
        &eventful(&[json!({"when": then, "then": push("velocity", 100.0)})]),
        "/stop",
        json!({"time": 60, "when": [then]}),
    );
    let answer = fly(&case).await;
    assert_eq!((&answer["termination"], answer.get("condition")), (&json!("time_limit"), None));
    assert_eq!((order(&answer), &answer["events"][0]["after"]), (vec![0], &answer["final_state"]));
}

#[tokio::test]
async fn a_condition_that_is_met_at_the_start_ends_the_flight_with_one_row() {
    let service = Service::new();
    let later = condition("speed", "falls_through", 9000.0);
    for met in [condition("time", "rises_through", 0.0), condition("altitude", "falls_through", 120_000.0)] {
        let case =
            with_all(&entry(), [("/stop", json!({"when": [later, met]})), ("/output", json!({"samples_per_step": 4}))]);
        let answer = good_answer(&service, "/simulate", &case).await;
        assert_eq!((&answer["termination"], &answer["condition"]), (&json!("condition"), &json!(1)));
        assert_eq!(answer["trajectory"]["time"], json!([0.0]));
        assert_eq!(answer["initial_state"], answer["final_state"]);
        let csv = service.post("/simulate?format=csv", &case).await;
        assert_eq!(String::from_utf8(csv.body.to_vec()).unwrap().lines().count(), 2);
    }
    let ceiling =
        with_all(&entry(), [("/initial_state/flight_path_angle", json!(0.05)), ("/stop", json!({"ceiling": 120_000}))]);
    let answer = fly(&ceiling).await;
    assert_eq!((&answer["termination"], &answer["final_state"]["time"]), (&json!("atmosphere_exit"), &json!(0.0)));
}

#[tokio::test]
async fn thrust_burns_until_its_propellant_is_spent_and_says_so() {
    let thrust = with(&burn("velocity", -3000.0), "/propellant", 100);
    let on = event("time", "rises_through", 10.0, &json!({"thrust": thrust}));
    let answer = fly(&eventful(std::slice::from_ref(&on))).await;
    assert_eq!(codes(&answer), ["propellant_spent"]);
    // ṁ = |T|/(g₀ I_sp)
    let burnt_out = 10.0 + 100.0 * 9.806_65 * 300.0 / 3000.0;
    check::near("burnout", number(&answer["warnings"][0]["time"]), burnt_out, 1e-9);
    check::relative("mass", number(&answer["final_state"]["mass"]), 5400.0, 1e-15);
    let felt =
        number(&answer["events"][0]["after"]["load_factor"]) - number(&answer["events"][0]["state"]["load_factor"]);
    // Against the motion, as the drag is; to a rounding of 3000/(5500 g₀) = 0.0556.
    check::relative("felt on board", felt, 3000.0 / 5500.0 / 9.806_65, 1e-12);
    let off = fly(&eventful(&[on, event("time", "rises_through", 60.0, &json!({"thrust": "off"}))])).await;
    assert_eq!(codes(&off), Vec::<&str>::new());
    check::relative("mass", number(&off["final_state"]["mass"]), 5500.0 - 50.0 * 3000.0 / (9.806_65 * 300.0), 1e-15);
}

#[tokio::test]
async fn an_impulse_without_a_direction_is_warned_of_with_its_place_in_the_list() {
    let down = with(&entry(), "/initial_state/flight_path_angle", -FRAC_PI_2);
    let events =
        json!([mark("time", "rises_through", 0.0), event("time", "rises_through", 0.0, &push("normal", 10.0))]);
    let answer = fly(&with(&down, "/events", events)).await;
    assert_eq!(codes(&answer), ["no_direction"]);
    assert_eq!(answer["warnings"][0]["time"], json!(0.0));
    let detail = answer["warnings"][0]["detail"].as_str().unwrap();
    assert!(detail.starts_with("Impulse of event 1 has no effect (at 0 s)"), "{detail}");
    assert_eq!(answer["events"][1]["state"], answer["events"][1]["after"]);
}

#[tokio::test]
async fn a_thrust_without_a_direction_is_warned_of_and_one_without_mass_flow_keeps_the_mass() {
    let rest = with(&entry(), "/initial_state/speed", 0);
    let thrust = json!({"along": "velocity", "value": 3000});
    let events = json!([event("time", "rises_through", 0.0, &json!({"thrust": thrust}))]);
    let answer = fly(&with_all(&rest, [("/events", events), ("/stop", json!({"time": 20}))])).await;
    assert_eq!(codes(&answer), ["no_direction"]);
    let detail = answer["warnings"][0]["detail"].as_str().unwrap();
    assert!(detail.starts_with("Thrust of event 0 has no direction (at "), "{detail}");
    assert!(answer["final_state"].get("mass").is_none(), "nothing changes the mass");
    // From 120 km it falls in 20 s by 9.44 m/s² of gravity less 0.03 m/s² of centrifugal relief, and by 3000/5500 m/s² of thrust.
    check::relative("speed", number(&answer["final_state"]["speed"]), 20.0 * (9.41 + 3000.0 / 5500.0), 1e-3);
}

/// What is constant in inertial space has the components of inertial vectors, whatever the planet's angle is.
#[tokio::test]
async fn an_inertial_impulse_at_the_start_is_another_inertial_start() {
    for (sidereal_time, epoch) in
        [(json!(12_345.6), None), (json!("07:08:09"), None), (json!(null), Some("2026-11-26T12:00:00Z"))]
    {
        let eci = |velocity: [f64; 3]| {
            let state = json!({"type": "eci", "position": [4e6, -5e6, 1.5e6], "velocity": velocity});
            let state =
                if sidereal_time.is_null() { state } else { with(&state, "/sidereal_time", sidereal_time.clone()) };
            let request = with_all(&entry(), [("/initial_state", state), ("/stop", json!({"time": 30}))]);
            epoch.map_or(request.clone(), |epoch| with(&request, "/epoch", epoch))
        };
        // 100 m/s along (2, -1, 2)/3.
        let then = json!({"delta_v": {"along": {"frame": "inertial", "direction": [2, -1, 2]}, "value": 150}});
        let pushed =
            fly(&with(&eci([5000.0, 3000.0, 4000.0]), "/events", json!([event("time", "rises_through", 0.0, &then)])))
                .await;
        let started = fly(&eci([5100.0, 2950.0, 4100.0])).await;
        for name in ["altitude", "longitude", "geocentric_latitude", "speed", "flight_path_angle", "heading"] {
            let [pushed, started] = [&pushed, &started].map(|answer| number(&answer["final_state"][name]));
            check::relative(name, pushed, started, 1e-10);
        }
    }
}

#[tokio::test]
async fn a_parachute_fills_brakes_and_is_released() {
    let deploy = |parachute: Value| json!({"deploy": parachute});
    let drogue = json!({"name": "drogue", "drag_area": 30, "inflation_time": 2, "delay": 0.5});
    let main = json!({"name": "main", "drag_area": 900, "inflation_time": 4});
    let list = [
        event("mach", "falls_through", 0.9, &deploy(drogue)),
        event("altitude", "falls_through", 3000.0, &with(&deploy(main.clone()), "/release", json!(["drogue"]))),
        event("altitude", "falls_through", 2900.0, &json!({"release": ["drogue"]})),
    ];
    let answer = fly(&with(&eventful(&list), "/echo", true)).await;
    assert_eq!(order(&answer), [0, 1, 2]);
    assert_eq!(codes(&answer), ["not_deployed"]);
    let detail = answer["warnings"][0]["detail"].as_str().unwrap();
    assert!(detail.starts_with("Release of event 2 has no effect") && detail.contains("event 0"), "{detail}");
    assert_eq!(answer["case"]["events"][1]["then"]["deploy"], with(&main, "/delay", 0.0));
    // Under both drag areas together, 900 m² and 1.3 × 12 m².
    let sinks = f64::sqrt(2.0 * 5500.0 * 9.78 / (1.225 * (900.0 + 15.6)));
    check::relative("sinks", number(&answer["final_state"]["speed"]), sinks, 0.01);
    let at = |index: usize, side: &str| number(&answer["events"][index][side]["load_factor"]);
    check::relative("a canopy that begins to fill does not pull", at(0, "after"), at(0, "state"), 1e-12);
    assert!(at(1, "after") < 0.5 * at(1, "state"), "the drogue is gone: {}", at(1, "after"));
}

/// The angle of attack has no effect with coefficients that do not depend on it, unless an event brings such that do.
#[tokio::test]
async fn an_angle_of_attack_is_used_where_an_event_brings_coefficients_of_it() {
    let table = model("alpha_mach_table")["vehicle"]["aerodynamics"].clone();
    let pitched = with(&entry(), "/control", json!({"angle_of_attack": 0.1}));
    assert_eq!(codes(&fly(&pitched).await), ["angle_of_attack_unused"]);
    let events = json!([event("altitude", "falls_through", 5e4, &json!({"aerodynamics": table}))]);
    let answer = fly(&with(&pitched, "/events", events)).await;
    assert!(!codes(&answer).contains(&"angle_of_attack_unused"), "{}", answer["warnings"]);
}

#[tokio::test]
async fn the_example_comes_down_from_orbit_and_lands_softly() {
    let case = read_json(format!("{}/../openapi/examples/deorbit.json", env!("CARGO_MANIFEST_DIR")).as_ref());
    let answer = fly(&case).await;
    assert_eq!(answer["termination"], "surface_impact");
    assert_eq!(order(&answer), [0, 1, 2, 3, 4, 5], "everything happens, in the order of the list");
    assert_eq!(codes(&answer), ["propellant_spent"]);
    // A descent module weighs its 2700 kg under 1000 m² of parachute: √(2mg/(ρ S C_D)) = 7.4 m/s.
    let last = &answer["final_state"];
    let terminal = (2.0 * number(&last["mass"]) * 9.81 / (number(&last["density"]) * 1000.0 * 0.8)).sqrt();
    // It slows down with the air, a little behind.
    check::relative("touchdown", number(&last["speed"]), terminal, 0.01);
    assert!(number(&answer["peaks"]["load_factor"]["value"]) < 8.0, "{}", answer["peaks"]);
    let plain = without(&without(&case, "/heating"), "/events");
    assert_eq!(fly(&plain).await["termination"], "time_limit", "without the burn it stays in orbit");
}

#[tokio::test]
async fn events_and_the_end_wait_for_events_by_their_names() {
    let list = [
        json!({"when": {"event": "subsonic"}}),
        with(&mark("mach", "falls_through", 0.9), "/name", "subsonic"),
        json!({"when": {"event": "subsonic", "delay": 12.5}, "then": {"mass": 5000}}),
    ];
    let case = with(&eventful(&list), "/stop", json!({"when": [{"event": "subsonic", "delay": 20}]}));
    let answer = fly(&with(&case, "/echo", true)).await;
    assert_eq!(order(&answer), [1, 0, 2]);
    let times = times(&answer);
    check::near("with it", times[1], times[0], 0.0);
    check::near("after it", times[2], times[0] + 12.5, 1e-9);
    check::near("the end", number(&answer["final_state"]["time"]), times[0] + 20.0, 1e-9);
    assert_eq!((&answer["termination"], &answer["condition"]), (&json!("condition"), &json!(0)));
    assert_eq!(answer["case"]["events"][0]["when"], json!({"event": "subsonic", "delay": 0.0}));
}
