//! What is refused of events, of conditions and of heating, each at its own field.

use std::f64::consts::FRAC_PI_2;

use serde_json::{Value, json};

use super::refusal::{Steady, good_answer};
use super::requests::{capsule, condition, event, flight, model, named, waiting, with, with_all, without};

/// The capsule with events.
fn eventful(events: &[Value]) -> Value {
    with(&capsule(), "/events", json!(events))
}

/// An event at a second of flight.
fn then(effect: &Value) -> Value {
    event("time", "rises_through", 1.0, effect)
}

fn constant() -> Value {
    json!({"type": "constant", "drag_coefficient": 0.8})
}

fn ballistic() -> Value {
    json!({"type": "ballistic", "ballistic_coefficient": 100})
}

/// The capsule by its ballistic coefficient, without an area.
fn ballistic_capsule() -> Value {
    with(&capsule(), "/vehicle", json!({"mass": 5500, "aerodynamics": ballistic()}))
}

#[tokio::test]
async fn a_condition_passes_its_value_one_way() {
    let steady = Steady::new().await;
    for (given, got) in [
        (json!({"falls_through": 1, "rises_through": 1}), "got falls_through and rises_through"),
        (json!({}), "got none of them"),
    ] {
        for quantity in ["altitude", "flight_path_angle", "time"] {
            let condition = with(&given, "/quantity", quantity);
            let request = with_all(
                &capsule(),
                [("/events", json!([{"when": condition}])), ("/stop", json!({"when": [condition]}))],
            );
            let phrase = format!("must have exactly one of falls_through, rises_through, {got}");
            let expected = [("/events/0/when", phrase.as_str()), ("/stop/when/0", phrase.as_str())];
            steady.refused_at("/simulate", &request, &expected).await;
        }
    }
}

#[tokio::test]
async fn time_never_falls() {
    let steady = Steady::new().await;
    let falls = condition("time", "falls_through", 1.0);
    let request = with_all(
        &capsule(),
        [("/events", json!([then(&json!({})), {"when": falls}])), ("/stop", json!({"when": [falls]}))],
    );
    let phrase = "must not be given for time, which never falls; use rises_through";
    let expected = [("/events/1/when/falls_through", phrase), ("/stop/when/0/falls_through", phrase)];
    steady.refused_at("/simulate", &request, &expected).await;
}

#[tokio::test]
async fn conditions_and_coefficients_by_mach_number_need_a_temperature() {
    let steady = Steady::new().await;
    let mach = condition("mach", "falls_through", 0.9);
    let speed = condition("speed", "falls_through", 300.0);
    for table in ["mach_table", "alpha_mach_table"] {
        let aerodynamics = model(table)["vehicle"]["aerodynamics"].clone();
        for atmosphere in [json!({"type": "exponential"}), json!({"type": "vacuum"})] {
            let request = with_all(
                &capsule(),
                [
                    ("/atmosphere", atmosphere),
                    ("/events", json!([{"when": mach}, {"when": speed, "then": {"aerodynamics": aerodynamics}}])),
                    ("/stop", json!({"when": [speed, mach]})),
                ],
            );
            let phrase = "requires a Mach number: the atmosphere must be standard, us76 or nrlmsise00, or a table with temperature or speed_of_sound";
            let pointers = ["/events/0/when/quantity", "/events/1/then/aerodynamics/type", "/stop/when/1/quantity"];
            steady.refused_at("/simulate", &request, &pointers.map(|pointer| (pointer, phrase))).await;
            good_answer(&steady.service, "/simulate", &with(&request, "/atmosphere", json!({"type": "us76"}))).await;
        }
    }
}

#[tokio::test]
async fn the_ceiling_lies_above_the_stop_altitude() {
    let steady = Steady::new().await;
    for (altitude, ceiling) in [(0.0, 0.0), (0.0, -5.0), (5000.0, 5000.0), (5000.0, 4999.0), (-10.0, -1e12)] {
        let stop = json!({"altitude": altitude, "ceiling": ceiling});
        let phrase = format!("must be greater than the stop altitude, {altitude} m, got ");
        steady.refused_at("/simulate", &with(&capsule(), "/stop", stop), &[("/stop/ceiling", &phrase)]).await;
        let stop = json!({"altitude": altitude, "ceiling": f64::next_up(altitude)});
        good_answer(&steady.service, "/simulate", &with(&capsule(), "/stop", stop)).await;
    }
}

#[tokio::test]
async fn heating_wants_a_nose_and_an_emissivity_within_1() {
    let steady = Steady::new().await;
    let request = with(&capsule(), "/heating", json!({}));
    let expected =
        [("/vehicle/nose_radius", "is required for heating: the heat flux at the stagnation point depends on it")];
    steady.refused_at("/simulate", &request, &expected).await;
    // A nose without heating is a part of the vehicle like others.
    good_answer(&steady.service, "/simulate", &with(&capsule(), "/vehicle/nose_radius", 2)).await;
    for emissivity in [0.0, 1.1, 1_f64.next_up(), -0.5] {
        let request = with(&model("heating"), "/heating/emissivity", emissivity);
        let expected = [("/heating/emissivity", "must be greater than 0 and at most 1, got ")];
        steady.refused_at("/simulate", &request, &expected).await;
    }
}

#[tokio::test]
async fn coefficients_of_an_area_need_one_and_others_take_none() {
    let steady = Steady::new().await;
    let at = "/events/0/then/reference_area";
    // Beside ballistic aerodynamics there is no such field, whatever the vehicle is.
    for vehicle in [capsule(), ballistic_capsule()] {
        let request =
            with(&vehicle, "/events", json!([then(&json!({"reference_area": 5, "aerodynamics": ballistic()}))]));
        let expected =
            [(at, "is not a field here; the fields are mass, aerodynamics, delta_v, thrust, deploy, release")];
        steady.refused_at("/simulate", &request, &expected).await;
    }
    for name in ["mach_table", "alpha_mach_table"] {
        let table = model(name);
        let effect = json!({"aerodynamics": table["vehicle"]["aerodynamics"]});
        let request = with_all(
            &ballistic_capsule(),
            [("/atmosphere", json!({"type": "us76"})), ("/events", json!([then(&effect)]))],
        );
        steady
            .refused_at(
                "/simulate",
                &request,
                &[(
                    at,
                    "is required: the vehicle is ballistic and has no reference \
                                                         area",
                )],
            )
            .await;
    }
    // Which event comes first, nobody knows before the flight: each brings its own area.
    let request = with(
        &ballistic_capsule(),
        "/events",
        json!([
            then(&json!({"aerodynamics": constant()})),
            then(&json!({"reference_area": 5, "aerodynamics": constant()})),
            then(&json!({"aerodynamics": constant()})),
            then(&json!({"aerodynamics": ballistic()})),
            then(&json!({"mass": 5000})),
        ]),
    );
    let phrase = "is required: the vehicle is ballistic and has no reference area for these coefficients";
    steady.refused_at("/simulate", &request, &[(at, phrase), ("/events/2/then/reference_area", phrase)]).await;
    // An area to which no coefficient ever refers would change nothing.
    let grows = then(&json!({"reference_area": 5}));
    let request = with(&ballistic_capsule(), "/events", json!([grows, then(&json!({"aerodynamics": ballistic()}))]));
    let expected = [(
        at,
        "must be omitted: the vehicle is ballistic, and no event gives it coefficients that refer to \
                          an area",
    )];
    steady.refused_at("/simulate", &request, &expected).await;
    let opens = then(&json!({"reference_area": 2, "aerodynamics": constant()}));
    let request = with(&ballistic_capsule(), "/events", json!([opens, grows]));
    good_answer(&steady.service, "/simulate", &request).await;
    good_answer(&steady.service, "/simulate", &eventful(&[grows, then(&json!({"aerodynamics": constant()}))])).await;
}

#[tokio::test]
async fn thresholds_of_the_flight_path_angle_are_in_the_unit_of_the_request() {
    let steady = Steady::new().await;
    let in_degrees =
        with_all(&capsule(), [("/angle_unit", json!("deg")), ("/initial_state/flight_path_angle", json!(-3))]);
    for way in ["falls_through", "rises_through"] {
        let request = |capsule: &Value, angle: f64| {
            let condition = condition("flight_path_angle", way, angle);
            with_all(capsule, [("/events", json!([{"when": condition}])), ("/stop", json!({"when": [condition]}))])
        };
        let pointers = [format!("/events/0/when/{way}"), format!("/stop/when/0/{way}")];
        let expected = |phrase| pointers.each_ref().map(|pointer| (pointer.as_str(), phrase));
        let phrase = "got -3 (radians); for degrees, set \"angle_unit\": \"deg\"";
        steady.refused_at("/simulate", &request(&capsule(), -3.0), &expected(phrase)).await;
        let phrase = "must be between -90 and 90, got -91 (degrees)";
        steady.refused_at("/simulate", &request(&in_degrees, -91.0), &expected(phrase)).await;
        for limit in [-1.0, 1.0] {
            good_answer(&steady.service, "/simulate", &request(&capsule(), limit * FRAC_PI_2)).await;
            good_answer(&steady.service, "/simulate", &request(&in_degrees, limit * 90.0)).await;
        }
    }
}

#[tokio::test]
async fn thrust_is_off_or_an_object() {
    let steady = Steady::new().await;
    for (thrust, got) in [
        (json!("on"), "\"on\""),
        (json!("Off"), "\"Off\""),
        (json!(""), "\"\""),
        (json!(null), "null"),
        (json!(0), "a number"),
        (json!(false), "a boolean"),
        (json!([]), "an array"),
    ] {
        let phrase = format!("must be \"off\" or an object, got {got}");
        let request = eventful(&[then(&json!({"thrust": thrust}))]);
        steady.refused_at("/simulate", &request, &[("/events/0/then/thrust", &phrase)]).await;
    }
    let expected = [
        ("/events/0/then/thrust/along", "is required; it must be one of velocity, radial, normal, horizontal"),
        ("/events/0/then/thrust/value", "is required"),
    ];
    steady.refused_at("/simulate", &eventful(&[then(&json!({"thrust": {}}))]), &expected).await;
}

#[tokio::test]
async fn faults_of_directions_and_of_propellant_name_their_place() {
    let steady = Steady::new().await;
    let along = |direction: Value| json!({"frame": "inertial", "direction": direction});
    let thrust = |along: Value| json!({"thrust": {"along": along, "value": 10}});
    let push = |along: Value| json!({"delta_v": {"along": along, "value": 10}});
    for (place, effect) in [("thrust", &thrust as &dyn Fn(Value) -> Value), ("delta_v", &push)] {
        let at = |name: &str| format!("/events/0/then/{place}/along{name}");
        for (given, name, phrase) in [
            (along(json!([0, 0, 0])), "/direction", "must not be [0, 0, 0], which has no direction"),
            (along(json!([0, -0.0, 0])), "/direction", "must not be [0, 0, 0]"),
            (along(json!([1, 0])), "/direction", "must have 3 numbers, got 2"),
            (along(json!([1, 0, "z"])), "/direction/2", "must be a number, got a string"),
            (json!({"frame": "gcrf", "direction": [1, 0, 0]}), "/frame", "must be one of inertial, got \"gcrf\""),
            (json!({"direction": [1, 0, 0]}), "/frame", "is required; it must be one of inertial"),
            (json!({"frame": "inertial"}), "/direction", "is required"),
            (json!("inertial"), "", "must be one of velocity, radial, normal, horizontal, got \"inertial\""),
        ] {
            let request = eventful(&[then(&effect(given))]);
            steady.refused_at("/simulate", &request, &[(&at(name), phrase)]).await;
        }
        for direction in [[5e-324, 0.0, 0.0], [f64::MAX, f64::MIN, f64::MAX]] {
            let request = eventful(&[then(&effect(along(json!(direction))))]);
            good_answer(&steady.service, "/simulate", &request).await;
        }
    }
    let unburnt = json!({"thrust": {"along": "radial", "value": 10, "propellant": 1}});
    let expected = [(
        "/events/0/then/thrust/propellant",
        "must be omitted: without specific_impulse the thrust consumes no \
                                               propellant",
    )];
    steady.refused_at("/simulate", &eventful(&[then(&unburnt)]), &expected).await;
}

#[tokio::test]
async fn a_parachute_has_a_name_of_its_own_and_is_released_by_it() {
    let steady = Steady::new().await;
    let deploys = |name: &str| json!({"deploy": {"name": name, "drag_area": 10, "inflation_time": 1}});
    let request = eventful(&[
        then(&deploys("drogue")),
        then(&deploys("main")),
        then(&with(&deploys("drogue"), "/release", json!(["main", "mane", ""]))),
        then(&with(&deploys("main"), "/release", json!(["drogue"]))),
    ]);
    let unknown = "must be the name of a parachute that an event deploys, got ";
    let expected = [
        ("/events/2/then/deploy/name", "must be unique: event 0 deploys a parachute of this name"),
        ("/events/3/then/deploy/name", "must be unique: event 1 deploys a parachute of this name"),
        ("/events/2/then/release/1", &format!("{unknown}\"mane\"")),
        ("/events/2/then/release/2", &format!("{unknown}\"\"")),
    ];
    steady.refused_at("/simulate", &request, &expected).await;
    let request = eventful(&[then(&json!({"release": "main"})), then(&json!({"release": [1, "a"]}))]);
    let expected = [
        ("/events/0/then/release", "must be an array of strings, got a string"),
        ("/events/1/then/release/0", "must be a string, got a number"),
    ];
    steady.refused_at("/simulate", &request, &expected).await;
}

#[tokio::test]
async fn a_case_has_up_to_a_thousand_events_and_conditions() {
    let steady = Steady::new().await;
    let many = |count: usize| {
        let condition = condition("speed", "rises_through", 1e5);
        let stop = json!({"time": 1, "when": vec![condition.clone(); count]});
        with_all(&capsule(), [("/events", json!(vec![json!({"when": condition}); count])), ("/stop", stop)])
    };
    let phrase = "must have at most 1000 entries, got 1001";
    steady.refused_at("/simulate", &many(1001), &[("/events", phrase), ("/stop/when", phrase)]).await;
    good_answer(&steady.service, "/simulate", &many(1000)).await;
}

#[tokio::test]
async fn all_faults_of_events_and_heating_come_in_one_answer() {
    let steady = Steady::new().await;
    let request = with_all(
        &capsule(),
        [
            ("/vehicle/nose_radius", json!(0)),
            ("/heating", json!({"convective": "fay_riddell", "radiative": null, "emissivity": 2, "wall": "cold"})),
            (
                "/events",
                json!([
                    {"name": 1, "when": {"quantity": "size", "rises_through": 1}, "then": {"mass": 0, "reference_area": -1}},
                    {"when": {"quantity": "mach", "rises_through": -1}, "then": {"delta_v": {"along": "up", "value": 1e7}}},
                    {"then": {"thrust": {"along": "velocity", "value": "full", "specific_impulse": 0, "propellant": 0}}},
                    {"when": {"quantity": "time", "falls_through": 1e10}, "then": {"aerodynamics": {"type": "brick"}}},
                    "parachute",
                ]),
            ),
            ("/stop", json!({"ceiling": 1e13, "when": [{"rises_through": 1}, {"quantity": "altitude"}]})),
        ],
    );
    let expected = [
        ("/vehicle/nose_radius", "must be greater than 0, got 0"),
        ("/heating/convective", "got \"fay_riddell\""),
        ("/heating/radiative", "must be one of none, tauber_sutton, craig_lyne, got null"),
        ("/heating/emissivity", "must be greater than 0 and at most 1, got 2"),
        ("/heating/wall", "is not a field here; the fields are convective, radiative, emissivity"),
        ("/events/0/name", "must be a string, got a number"),
        ("/events/0/when/quantity", "must be one of time, altitude"),
        ("/events/0/then/mass", "must be greater than 0, got 0"),
        ("/events/0/then/reference_area", "must be at least 0, got -1"),
        ("/events/1/when/rises_through", "must be at least 0, got -1"),
        ("/events/1/then/delta_v/along", "must be one of velocity, radial, normal, horizontal, got \"up\""),
        ("/events/1/then/delta_v/value", "must be between -1000000 and 1000000"),
        ("/events/2/when", "is required"),
        ("/events/2/then/thrust/value", "must be a number, got a string"),
        ("/events/2/then/thrust/specific_impulse", "must be between 0.001 and 1e9, got 0"),
        ("/events/2/then/thrust/propellant", "must be greater than 0, got 0"),
        ("/events/3/when/falls_through", "must be between 0 and 1e9, got "),
        ("/events/3/then/aerodynamics/type", "got \"brick\""),
        ("/events/4", "must be an object, got a string"),
        ("/stop/ceiling", "must be between -1e12 and 1e12, got "),
        ("/stop/when/0", "must have exactly one of quantity, event, burnout, got none of them"),
        ("/stop/when/1", "must have exactly one of falls_through, rises_through, got none of them"),
    ];
    steady.refused_at("/simulate", &request, &expected).await;
}

#[tokio::test]
async fn faults_across_events_heating_and_columns_come_in_one_answer() {
    let steady = Steady::new().await;
    let request = with_all(
        &ballistic_capsule(),
        [
            ("/heating", json!({})),
            (
                "/events",
                json!([
                    {"when": {"quantity": "time", "falls_through": 1}, "then": {"aerodynamics": constant()}},
                    {"when": {"quantity": "mach", "falls_through": 1}},
                ]),
            ),
            ("/stop", json!({"ceiling": -1})),
            ("/output", json!({"columns": ["time", "mass"]})),
        ],
    );
    let expected = [
        ("/vehicle/nose_radius", "is required"),
        ("/events/0/when/falls_through", "never falls"),
        ("/events/0/then/reference_area", "is required"),
        ("/events/1/when/quantity", "requires a Mach number"),
        ("/stop/ceiling", "must be greater than the stop altitude"),
        ("/output/columns/1", "mass requires an event that changes it"),
    ];
    steady.refused_at("/simulate", &request, &expected).await;
}

#[tokio::test]
async fn columns_of_heating_and_mass_are_there_where_the_case_has_them() {
    let steady = Steady::new().await;
    let columns = ["convective_heat_flux", "radiative_heat_flux", "heat_load", "wall_temperature", "mass"];
    let request = with(&capsule(), "/output", json!({"columns": columns}));
    let details = [
        "requires heating",
        "requires heating",
        "requires heating",
        "requires heating",
        "requires an event that changes it",
    ];
    let expected = columns.iter().zip(details).enumerate();
    let expected: Vec<_> = expected
        .map(|(index, (name, needs))| (format!("/output/columns/{index}"), format!("{name} {needs}")))
        .collect();
    let expected: Vec<_> = expected.iter().map(|(pointer, phrase)| (pointer.as_str(), phrase.as_str())).collect();
    steady.refused_at("/simulate", &request, &expected).await;
    // An event that leaves the mass alone is none that changes it.
    let area = with(&request, "/events", json!([then(&json!({"reference_area": 5}))]));
    steady.refused_at("/simulate", &area, &expected).await;
}

#[tokio::test]
async fn a_theory_knows_neither_events_nor_heating() {
    let steady = Steady::new().await;
    let theory = with(&flight("geodetic"), "/solution", "loh");
    let heating = ("/heating", "must not be given: the theories do not include heating");
    let events = ("/events", "must be omitted: the theory assumes one vehicle without thrust");
    let mark = json!([then(&json!({}))]);
    steady.refused_at("/analytic", &with(&theory, "/heating", json!({})), &[heating]).await;
    steady.refused_at("/analytic", &with(&theory, "/events", mark.clone()), &[events]).await;
    // Beside faults of the flight itself and of the theory, too.
    let request = with_all(
        &without(&theory, "/vehicle/nose_radius"),
        [
            ("/heating", json!({})),
            ("/events", mark),
            ("/stop", json!({"ceiling": -1})),
            ("/vehicle/aerodynamics/lift_coefficient", json!(0)),
        ],
    );
    let expected = [
        heating,
        events,
        ("/vehicle/nose_radius", "is required"),
        ("/stop/ceiling", "must be greater than the stop altitude"),
        ("/vehicle/aerodynamics/lift_coefficient", "the theory requires lift"),
    ];
    steady.refused_at("/analytic", &request, &expected).await;
    // That a flight ends earlier is no matter to a theory.
    let stop = json!({"ceiling": 1e6, "when": [condition("time", "rises_through", 0.5)]});
    let answer = good_answer(&steady.service, "/analytic", &with(&theory, "/stop", stop)).await;
    assert_eq!(answer["valid"]["ends_because"], "the flight ends by a condition");
    let climbs =
        with_all(&theory, [("/initial_state/flight_path_angle", json!(0.1)), ("/stop", json!({"ceiling": 90_100}))]);
    let answer = good_answer(&steady.service, "/analytic", &climbs).await;
    assert_eq!(answer["valid"]["ends_because"], "the flight ends at the ceiling");
}

#[tokio::test]
async fn what_waits_for_an_event_waits_for_one_that_may_happen() {
    let steady = Steady::new().await;
    let refused = async |events: Value, expected: &[(&str, &str)]| {
        steady.refused_at("/simulate", &with(&capsule(), "/events", events), expected).await;
    };
    let unknown = "must be the name of an event of the case, got \"main\"";
    refused(json!([named("drogue"), waiting("main", 1.0)]), &[("/events/1/when/event", unknown)]).await;
    let several = "must be the name of exactly one event, got \"drogue\", the name of 2 events";
    refused(json!([named("drogue"), named("drogue"), waiting("drogue", 1.0)]), &[("/events/2/when/event", several)])
        .await;
    let circle = "must not be an event that waits";
    let [mut first, mut second] = [waiting("second", 1.0), waiting("first", 1.0)];
    (first["name"], second["name"]) = (json!("first"), json!("second"));
    refused(json!([first, second]), &[("/events/0/when/event", circle), ("/events/1/when/event", circle)]).await;
    let both = json!({"quantity": "time", "rises_through": 1, "event": "drogue"});
    refused(
        json!([named("drogue"), {"when": both}]),
        &[("/events/1/when", "must have exactly one of quantity, event, burnout, got quantity and event")],
    )
    .await;
    let stop = with_all(&capsule(), [("/stop", json!({"when": [{"event": "main"}]}))]);
    steady.refused_at("/simulate", &stop, &[("/stop/when/0/event", unknown)]).await;
    let since = |name: &str| json!({"type": "schedule", "against": {"since": name}, "at": [0, 10], "value": [0, 1]});
    let all = with_all(
        &stop,
        [
            ("/events", json!([named("drogue"), named("drogue")])),
            ("/control", json!({"bank_angle": since("main"), "angle_of_attack": since("drogue")})),
        ],
    );
    let expected = [
        ("/stop/when/0/event", unknown),
        ("/control/bank_angle/against/since", unknown),
        ("/control/angle_of_attack/against/since", several),
    ];
    steady.refused_at("/simulate", &all, &expected).await;
}

#[tokio::test]
async fn conditions_need_what_their_quantities_do() {
    let steady = Steady::new().await;
    for quantity in ["heat_flux", "heat_load", "wall_temperature"] {
        let request = with(&capsule(), "/events", json!([{"when": condition(quantity, "rises_through", 1.0)}]));
        steady.refused_at("/simulate", &request, &[("/events/0/when/quantity", "requires heating")]).await;
    }
    let rest = with(&capsule(), "/initial_state/speed", 0);
    let request = with(&rest, "/stop", json!({"when": [condition("downrange", "rises_through", 1.0)]}));
    steady.refused_at("/simulate", &request, &[("/stop/when/0/quantity", "requires an initial heading")]).await;
}
