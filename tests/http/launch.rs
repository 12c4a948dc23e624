//! Launches, parts, steering and separations: what is refused, each at its own field, and that what is echoed flies again.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use super::refusal::{Steady, good_answer, problem};
use super::requests::{capsule, condition, conversion, with, with_all, without};
use super::simulate::{codes, fly};

/// Two stages with boosters and a fairing that fly for three minutes.
fn launcher() -> Value {
    let constant = |drag: f64| json!({"type": "constant", "drag_coefficient": drag});
    json!({
        "angle_unit": "deg",
        "planet": {"model": "earth_wgs84", "gravity": {"type": "zonal", "degree": 2}},
        "atmosphere": {"type": "us76"},
        "initial_state": {"type": "launch", "site": "mahia", "azimuth": 100},
        "vehicle": {
            "reference_area": 1.13,
            "aerodynamics": {"type": "mach_table", "mach": [0, 1, 5], "drag_coefficient": [0.3, 0.5, 0.3], "lift_coefficient": [0, 0, 0]},
            "parts": [
                {"name": "first", "dry_mass": 1100, "propellant": 12000, "reference_area": 3, "aerodynamics": constant(0.9),
                 "engine": {"thrust": {"vacuum": 250_000, "sea_level": 215_000}, "specific_impulse": 300}},
                {"name": "booster", "count": 2, "dry_mass": 90, "propellant": 700, "reference_area": 0.3, "aerodynamics": constant(0.9),
                 "engine": {"thrust": {"type": "table", "time": [0, 0.5, 20, 22], "vacuum": [0, 60_000, 75_000, 0]},
                    "specific_impulse": 270, "exit_area": 0.08}},
                {"name": "second", "dry_mass": 250, "propellant": 2200, "engine": {"thrust": {"vacuum": 26_000}, "specific_impulse": 340}},
                {"name": "fairing", "dry_mass": 50, "reference_area": 2.2, "aerodynamics": constant(1.2)},
                {"name": "payload", "dry_mass": 150},
            ],
        },
        "control": {"steering": {"type": "vertical"}},
        "events": [
            {"name": "ignition", "when": condition("time", "rises_through", 0.0), "then": {"ignite": ["first", "booster"]}},
            {"name": "tilt", "when": condition("speed", "rises_through", 60.0), "then": {"tilt": {"angle": 3}, "steer": {"type": "velocity"}}},
            {"name": "booster drop", "when": {"burnout": "booster", "delay": 1},
             "then": {"separate": [{"name": "boosters", "parts": ["booster"], "push": {"along": "radial", "value": -1.5}}]}},
            {"name": "staging", "when": {"burnout": "first", "delay": 3}, "then": {"separate": [{"name": "first stage", "parts": ["first"],
                "events": [{"name": "parachute", "when": condition("altitude", "falls_through", 4700.0), "then": {"reference_area": 80}}]}]}},
            {"name": "second ignition", "when": {"event": "staging", "delay": 2},
             "then": {"ignite": ["second"], "load_limit": 0.95, "throttle": {"second": 0.9}, "steer": {"type": "program", "frame": "launch",
                "pitch": {"type": "schedule", "against": {"since": "second ignition"}, "at": [0, 300], "value": [25, -12]}}}},
            {"name": "fairing", "when": condition("altitude", "rises_through", 110_000.0),
             "then": {"separate": [{"name": "fairing", "parts": ["fairing"], "push": {"along": "normal", "value": 3}}]}},
        ],
        "stop": {"time": 200},
        "output": {"trajectory": false},
    })
}

/// The launcher with one change.
fn but(pointer: &str, value: Value) -> Value {
    with(&launcher(), pointer, value)
}

/// The first stage as it leaves, in the launcher.
const FIRST_STAGE: &str = "/events/3/then/separate/0";

#[tokio::test]
async fn names_are_those_of_parts_all_at_once() {
    let steady = Steady::new().await;
    let engines = "must be the name of a part with an engine (\"first\", \"booster\", \"second\"), got ";
    let parts = "must be the name of a part (\"first\", \"booster\", \"second\", \"fairing\", \"payload\"), got ";
    let request = with_all(
        &launcher(),
        [
            (
                "/events/0/then",
                json!({"ignite": ["frist", "first", "fairing"], "shut_down": ["x"], "throttle": {"a/b~": 0.5}}),
            ),
            ("/events/2/when/burnout", json!("payload")),
            ("/events/2/then/separate/0/parts", json!(["boosters"])),
            ("/events/3/then/separate/0/events/0/then", json!({"ignite": ["second"], "reference_area": 8})),
            ("/events/3/then/separate/0/stop", json!({"when": [{"burnout": "booster"}]})),
            ("/stop/when", json!([{"burnout": "third"}])),
        ],
    );
    let of_body = "must be the name of a part with an engine (\"first\"), got ";
    let texts = [
        (engines, "frist"),
        (engines, "fairing"),
        (engines, "x"),
        (engines, "a/b~"),
        (engines, "payload"),
        (parts, "boosters"),
        (of_body, "second"),
        (of_body, "booster"),
        (engines, "third"),
    ];
    let texts = texts.map(|(text, got)| format!("{text}{got:?}"));
    let pointers = [
        "/events/0/then/ignite/0",
        "/events/0/then/ignite/2",
        "/events/0/then/shut_down/0",
        "/events/0/then/throttle/a~1b~0",
        "/events/2/when/burnout",
        "/events/2/then/separate/0/parts/0",
        "/events/3/then/separate/0/events/0/then/ignite/0",
        "/events/3/then/separate/0/stop/when/0/burnout",
        "/stop/when/0/burnout",
    ];
    let expected: Vec<_> = pointers.into_iter().zip(texts.iter().map(String::as_str)).collect();
    steady.refused_at("/simulate", &request, &expected).await;
    // What such a body weighs is not asked.
    let ballistic = json!({"type": "ballistic", "ballistic_coefficient": 100});
    let unknown = json!([{"name": "b", "parts": ["x"], "aerodynamics": ballistic}]);
    let request = but("/events/2/then/separate", unknown);
    steady.refused_at("/simulate", &request, &[("/events/2/then/separate/0/parts/0", parts)]).await;
    // Many names are not told one by one.
    let many: Vec<_> = (0..30).map(|index| json!({"name": format!("part {index}"), "dry_mass": 1})).collect();
    let request = with_all(
        &launcher(),
        [
            ("/vehicle/parts", json!(many)),
            (
                "/events",
                json!([{"when": condition("time", "rises_through", 1.0), "then": {"separate": [
                {"name": "a", "parts": ["part"], "reference_area": 1, "aerodynamics": {"type": "constant", "drag_coefficient": 1}}]}}]),
            ),
        ],
    );
    let expected = [("/events/0/then/separate/0/parts/0", "\"part 9\" and 20 more), got \"part\"")];
    steady.refused_at("/simulate", &request, &expected).await;
}

#[tokio::test]
async fn a_part_leaves_once_and_one_remains() {
    let steady = Steady::new().await;
    let constant = json!({"type": "constant", "drag_coefficient": 1});
    let together =
        |parts: Value| json!([{"name": "all", "parts": parts, "reference_area": 1, "aerodynamics": constant}]);
    for (parts, pointer, phrase) in [
        (json!(["fairing", "first"]), "/parts/1", "must be a part that is separated once: event 3 separates it"),
        (json!(["fairing", "fairing"]), "/parts/1", "must be a part that is separated once: event 5 separates it"),
        (json!(["fairing", "payload", "second"]), "/parts", "must leave a part to the vehicle"),
        (json!([]), "/parts", "must have at least one name, got none"),
    ] {
        let request = but("/events/5/then/separate", together(parts));
        steady.refused_at("/simulate", &request, &[(&format!("/events/5/then/separate/0{pointer}"), phrase)]).await;
    }
    let parts = but("/vehicle/parts/1/name", json!("first"));
    let phrase = "must be the name of a part with an engine (\"first\", \"second\"), got \"booster\"";
    let expected = [
        ("/vehicle/parts/1/name", "must be unique, got \"first\" again"),
        ("/events/0/then/ignite/1", phrase),
        ("/events/2/when/burnout", phrase),
        ("/events/2/then/separate/0/parts/0", "must be the name of a part"),
    ];
    steady.refused_at("/simulate", &parts, &expected).await;
}

#[tokio::test]
async fn an_engine_is_lit_once_unless_it_is_shut_down() {
    let steady = Steady::new().await;
    let again = but("/events/4/then/ignite", json!(["first", "second"]));
    let phrase = "must be a part that is not lit: event 0 lights it, and no event shuts it down";
    steady.refused_at("/simulate", &again, &[("/events/4/then/ignite/0", phrase)]).await;
    let at_once = but("/events/0/then/ignite", json!(["first", "booster", "first"]));
    steady.refused_at("/simulate", &at_once, &[("/events/0/then/ignite/2", phrase)]).await;
    let mut relit =
        with_all(&launcher(), [("/stop/time", json!(20)), ("/events/4/when", json!({"event": "off", "delay": 2}))]);
    relit["events"][4]["then"] = json!({"ignite": ["first"]});
    let off = json!({"name": "off", "when": condition("time", "rises_through", 5.0), "then": {"shut_down": ["first"]}});
    relit["events"].as_array_mut().unwrap().push(off);
    let answer = good_answer(&steady.service, "/simulate", &relit).await;
    assert_eq!(codes(&answer), Vec::<&str>::new());
    // One that has left, and one that burns already, is not lit: a warning.
    relit["events"][6]["when"] = condition("time", "rises_through", 15.0);
    relit["events"][4]["when"] = condition("time", "rises_through", 10.0);
    let answer = good_answer(&steady.service, "/simulate", &relit).await;
    assert_eq!(codes(&answer), ["not_lit"]);
}

#[tokio::test]
#[expect(clippy::too_many_lines, reason = "a list")]
async fn parts_have_masses_and_engines_that_fit() {
    let steady = Steady::new().await;
    let part = |index: usize, field: &str| format!("/vehicle/parts/{index}/{field}");
    for (pointer, value, fault, phrase) in [
        (part(4, "dry_mass"), json!(0), part(4, "dry_mass"), "must be greater than 0: the part has no propellant"),
        (part(4, "propellant"), json!(5), part(4, "propellant"), "must be 0: the part has no engine to burn it"),
        (
            part(0, "engine/thrust/sea_level"),
            json!(250_001),
            part(0, "engine/thrust/sea_level"),
            "must be at most the thrust in vacuum, 250000 N, got 250001",
        ),
        (
            part(0, "engine/exit_area"),
            json!(0.3),
            part(0, "engine/exit_area"),
            "must not be given together with thrust/sea_level, which defines it",
        ),
        (
            part(0, "engine/thrust/vacuum"),
            json!([2, 1]),
            part(0, "engine/thrust/vacuum"),
            "must be a number without \"type\": \"table\", got an array",
        ),
        (
            part(0, "engine/thrust/time"),
            json!([0, 1]),
            part(0, "engine/thrust/time"),
            "must be omitted without \"type\": \"table\"",
        ),
        (part(0, "engine/thrust/type"), json!("constant"), part(0, "engine/thrust/type"), "must be one of table"),
        (
            part(1, "engine/thrust/time"),
            json!([0.1, 0.5, 20, 22]),
            part(1, "engine/thrust/time/0"),
            "must be 0, the ignition, got 0.1",
        ),
        (
            part(1, "engine/thrust/time"),
            json!([0, 5, 5, 22]),
            part(1, "engine/thrust/time/2"),
            "must be greater than the",
        ),
        (
            part(1, "engine/thrust/time"),
            json!([0, 5, 22]),
            part(1, "engine/thrust/vacuum"),
            "must have as many entries as time, 3, got 4",
        ),
        (part(1, "engine/thrust/time"), json!([0]), part(1, "engine/thrust/time"), "must have "),
        (
            part(1, "engine/thrust/vacuum"),
            json!(75_000),
            part(1, "engine/thrust/vacuum"),
            "must be an array of numbers for a table, got a number",
        ),
        (
            part(1, "engine/thrust/sea_level"),
            json!(1),
            part(1, "engine/thrust/sea_level"),
            "must be omitted for a table; give exit_area",
        ),
        (
            part(1, "reference_area"),
            json!(1e308),
            part(1, "reference_area"),
            "is too large: times count, it exceeds the greatest number",
        ),
        (
            part(1, "dry_mass"),
            json!(1e308),
            "/vehicle/parts".to_owned(),
            "must have a total mass that is a finite number",
        ),
        (
            "/vehicle/mass".to_owned(),
            json!(5),
            "/vehicle".to_owned(),
            "must have exactly one of mass, parts, got mass and parts",
        ),
    ] {
        let also_type = pointer.ends_with("thrust/type");
        let request = but(&pointer, value.clone());
        let mut expected = vec![(fault.as_str(), phrase)];
        let [vacuum, sea_level, time] =
            ["vacuum", "sea_level", "time"].map(|field| part(0, &format!("engine/thrust/{field}")));
        if also_type {
            // It is taken for a table, since it has a type.
            expected.extend([
                (vacuum.as_str(), "for a table"),
                (&sea_level, "for a table"),
                (&time, "is required for a table"),
            ]);
        }
        steady.refused_at("/simulate", &request, &expected).await;
    }
    let without_parts = without(&without(&launcher(), "/vehicle/parts"), "/events");
    let neither = ("/vehicle", "must have exactly one of mass, parts, got none of them");
    steady.refused_at("/simulate", &without_parts, &[neither]).await;
    let none = but("/vehicle/parts", json!([]));
    steady.refused_at("/simulate", &none, &[("/vehicle/parts", "must have at least 1 entr")]).await;
    let time = without(&launcher(), "/vehicle/parts/1/engine/thrust/time");
    steady.refused_at("/simulate", &time, &[("/vehicle/parts/1/engine/thrust/time", "is required for a table")]).await;
}

#[tokio::test]
async fn an_exit_area_needs_a_pressure() {
    let steady = Steady::new().await;
    let constant = json!({"type": "constant", "drag_coefficient": 0.4});
    let request =
        with_all(&launcher(), [("/atmosphere", json!({"type": "exponential"})), ("/vehicle/aerodynamics", constant)]);
    let phrase = "requires the pressure of the air: the atmosphere must be standard, us76 or nrlmsise00, or a table with pressure";
    let expected =
        [("/vehicle/parts/0/engine/thrust/sea_level", phrase), ("/vehicle/parts/1/engine/exit_area", phrase)];
    steady.refused_at("/simulate", &request, &expected).await;
    let request =
        without(&with(&request, "/vehicle/parts/1/engine/exit_area", 0), "/vehicle/parts/0/engine/thrust/sea_level");
    good_answer(&steady.service, "/simulate", &request).await;
}

#[tokio::test]
async fn what_acts_on_parts_needs_parts() {
    let steady = Steady::new().await;
    let then = json!({"load_limit": 3, "steer": {"type": "velocity"}, "ignite": ["a"], "shut_down": ["b"], "throttle": {"c": 1}, "tilt": {"angle": 0}});
    let request = with_all(
        &capsule(),
        [
            ("/control", json!({"steering": {"type": "velocity"}})),
            ("/events", json!([{"when": condition("time", "rises_through", 1.0), "then": then}])),
        ],
    );
    let none = "must be the name of a part with an engine (there is none), got ";
    let expected = [
        ("/control/steering", "requires vehicle.parts"),
        ("/events/0/then/load_limit", "requires vehicle.parts"),
        ("/events/0/then/steer", "requires vehicle.parts"),
        ("/events/0/then/ignite/0", none),
        ("/events/0/then/shut_down/0", none),
        ("/events/0/then/throttle/c", none),
    ];
    steady.refused_at("/simulate", &request, &expected).await;
    // The parts define what these would.
    let thrust = json!({"along": "velocity", "value": 10});
    let request = but("/events/1/then", json!({"mass": 5, "thrust": thrust}));
    let phrase = "must be omitted: the parts of the vehicle define its mass and its engines";
    let own = [("/events/1/then/mass", phrase), ("/events/1/then/thrust", phrase)];
    steady.refused_at("/simulate", &request, &own).await;
    let spherical = but("/solver", json!({"formulation": "spherical"}));
    let expected = [("/solver/formulation", "must be cartesian for a vehicle with parts")];
    steady.refused_at("/simulate", &spherical, &expected).await;
}

#[tokio::test]
async fn angles_of_a_steering_are_those_of_its_frame() {
    let steady = Steady::new().await;
    let steering = |fields: Value| but("/control", json!({"steering": fields}));
    let at = |name: &str| format!("/control/steering{name}");
    for (fields, faults) in [
        (
            json!({"type": "program", "frame": "launch", "pitch": 1, "azimuth": 2}),
            vec![("/azimuth", "is not a field here; the fields are type, frame, pitch, yaw")],
        ),
        (json!({"type": "program", "frame": "launch"}), vec![("/pitch", "is required")]),
        (
            json!({"type": "program", "frame": "local", "pitch": 1, "yaw": 1}),
            vec![("/azimuth", "is required"), ("/yaw", "is not a field here")],
        ),
        (
            json!({"type": "program", "frame": "inertial", "pitch": 1, "declination": 500}),
            vec![
                ("/right_ascension", "is required"),
                ("/pitch", "is not a field here"),
                ("/declination", "must be between -360 and 360"),
            ],
        ),
        (
            json!({"type": "program", "pitch": 1}),
            vec![("/frame", "is required; it must be one of launch, local, inertial")],
        ),
        (
            json!({"type": "programme", "pitch": 1}),
            vec![("/type", "must be one of vertical, velocity, program, linear_tangent")],
        ),
        (
            json!({"type": "linear_tangent", "a": "1"}),
            vec![("/a", "must be a number, got a string"), ("/b", "is required")],
        ),
        (json!({"type": "vertical", "pitch": 3}), vec![("/pitch", "is not a field here; the fields are type")]),
    ] {
        let faults: Vec<_> = faults.into_iter().map(|(name, phrase)| (at(name), phrase)).collect();
        let faults: Vec<_> = faults.iter().map(|(pointer, phrase)| (pointer.as_str(), *phrase)).collect();
        steady.refused_at("/simulate", &steering(fields), &faults).await;
    }
    for (kind, angle) in [("velocity", 3), ("vertical", 0)] {
        let control = json!({"steering": {"type": kind}, "angle_of_attack": angle});
        good_answer(&steady.service, "/simulate", &but("/control", control)).await;
    }
    for given in [json!({"type": "vertical"}), json!({"type": "program", "frame": "launch", "pitch": 80})] {
        let control = json!({"steering": given, "angle_of_attack": {"type": "schedule", "against": "time", "at": [0], "value": [0]}});
        let phrase = "must be omitted: the steering defines the angle of attack; only \"velocity\" takes it";
        steady.refused_at("/simulate", &but("/control", control), &[("/control/angle_of_attack", phrase)]).await;
    }
    // Schedules by what the case does not have.
    let schedule = |against: Value| json!({"type": "schedule", "against": against, "at": [0, 1], "value": [80, 70]});
    let since = |name: &str| schedule(json!({"since": name}));
    let programs = with_all(
        &launcher(),
        [
            ("/control/steering", json!({"type": "program", "frame": "local", "pitch": 80, "azimuth": since("main")})),
            (
                "/events/4/then/steer",
                json!({"type": "program", "frame": "inertial", "right_ascension": since("mane"), "declination": 1}),
            ),
        ],
    );
    let unknown = "must be the name of an event of the case, got ";
    let expected = [
        ("/control/steering/azimuth/against/since", unknown),
        ("/events/4/then/steer/right_ascension/against/since", unknown),
    ];
    steady.refused_at("/simulate", &programs, &expected).await;
    let by_mach = with_all(
        &programs,
        [
            ("/control/steering/azimuth", schedule(json!("mach"))),
            ("/events/4/then/steer/right_ascension", schedule(json!("mach"))),
            (
                "/atmosphere",
                json!({"type": "table", "altitude": [0, 1e5], "density": [1, 1e-6], "pressure": [1e5, 0.1]}),
            ),
        ],
    );
    let phrase = "requires a Mach number";
    let expected = [
        ("/vehicle/aerodynamics/type", phrase),
        ("/control/steering/azimuth/against", phrase),
        ("/events/4/then/steer/right_ascension/against", phrase),
    ];
    steady.refused_at("/simulate", &by_mach, &expected).await;
}

#[tokio::test]
async fn a_launch_is_from_a_site_or_from_a_place() {
    let steady = Steady::new().await;
    let launch = |fields: Value| but("/initial_state", with(&fields, "/type", "launch"));
    let at = |name: &str| format!("/initial_state{name}");
    let both = "must have exactly one of site, geodetic_latitude, got site and geodetic_latitude";
    for (fields, name, phrase) in [
        (json!({}), "", "must have exactly one of site, geodetic_latitude, got none of them"),
        (json!({"longitude": 3}), "", "must have exactly one of site, geodetic_latitude, got none of them"),
        (json!({"site": "mahia", "geodetic_latitude": 3, "longitude": 3}), "", both),
        (json!({"site": "mahia", "longitude": 3}), "/longitude", "is not a field here; the fields are "),
        (json!({"site": "mahia", "speed": 3}), "/speed", "is not a field here"),
        (json!({"geodetic_latitude": 3}), "/longitude", "is required"),
        (json!({"geodetic_latitude": 93, "longitude": 0}), "/geodetic_latitude", "must be between -90 and 90"),
        (
            json!({"site": "mahia_2"}),
            "/site",
            "must be the slug of a site of GET /sites, such as \"mahia\", got \"mahia_2\"",
        ),
        (json!({"site": "Mahia"}), "/site", "such as \"mahia\", got \"Mahia\""),
        (json!({"site": "nowhere"}), "/site", "must be the slug of a site of GET /sites, got \"nowhere\""),
        (json!({"site": 3}), "/site", "must be a string, got a number"),
        (json!({"site": "mahia", "hold_down": 1}), "/hold_down", "must be true or false"),
        (json!({"site": "mahia", "azimuth": 361}), "/azimuth", "must be between -360 and 360"),
        (
            json!({"geodetic_latitude": 3, "longitude": 3, "geodetic_altitude": -10}),
            "",
            "initial altitude is below the stop altitude",
        ),
        (
            json!({"geodetic_latitude": 3, "longitude": 3, "geodetic_altitude": -7e6}),
            "/geodetic_altitude",
            "above the planet's centre",
        ),
    ] {
        steady.refused_at("/simulate", &launch(fields), &[(&at(name), phrase)]).await;
    }
    let convert = with(&conversion("ecef"), "/state", json!({"type": "launch", "site": "mahia"}));
    let kinds =
        "must be one of planet_relative, geodetic, ecef, eci, orbital_elements, inertial_flight_path, got \"launch\"";
    steady.refused_at("/convert", &convert, &[("/state/type", kinds)]).await;
}

#[tokio::test]
async fn the_event_of_a_launch_is_no_other() {
    let steady = Steady::new().await;
    let named = but("/events/1/name", json!("liftoff"));
    let phrase = "must not be \"liftoff\", which is the event of the launch";
    steady.refused_at("/simulate", &named, &[("/events/1/name", phrase)]).await;
    // Others may wait for it, and without a hold-down the name is free.
    let waits = but("/events/1/when", json!({"event": "liftoff", "delay": 5}));
    let answer = good_answer(&steady.service, "/simulate", &waits).await;
    let [lift_off, tilt] = ["liftoff", "tilt"].map(|name| {
        let events = answer["events"].as_array().unwrap();
        events.iter().find(|event| event["name"] == name).unwrap()["time"].as_f64().unwrap()
    });
    assert!((tilt - lift_off - 5.0).abs() < 1e-9, "{lift_off} {tilt}");
    good_answer(&steady.service, "/simulate", &with(&named, "/initial_state/hold_down", false)).await;
    let twice = but("/events/1/name", json!("staging"));
    let phrase = "must be the name of exactly one event, got \"staging\", the name of 2 events";
    steady.refused_at("/simulate", &twice, &[("/events/4/when/event", phrase)]).await;
    let circle = but("/events/3/when", json!({"event": "second ignition"}));
    let phrase = "must not be an event that waits for itself";
    steady
        .refused_at("/simulate", &circle, &[("/events/3/when/event", phrase), ("/events/4/when/event", phrase)])
        .await;
    for (given, got) in [
        (json!({"burnout": "first", "event": "staging"}), "got event and burnout"),
        (json!({"burnout": "first", "quantity": "time", "rises_through": 1}), "got quantity and burnout"),
        (json!({"delay": 3}), "got none of them"),
    ] {
        let phrase = format!("must have exactly one of quantity, event, burnout, {got}");
        steady.refused_at("/simulate", &but("/events/3/when", given), &[("/events/3/when", &phrase)]).await;
    }
    let falls = but("/events/3/when", json!({"burnout": "first", "falls_through": 3}));
    steady
        .refused_at("/simulate", &falls, &[("/events/3/when/falls_through", "is not a field here; the fields are ")])
        .await;
}

/// A body with one part, that may stand in any of the launcher's events.
fn payload() -> Value {
    json!({"name": "payload", "parts": ["payload"], "reference_area": 1, "aerodynamics": {"type": "constant", "drag_coefficient": 1}})
}

#[tokio::test]
async fn there_are_64_bodies_at_most() {
    let steady = Steady::new().await;
    let many = |count: usize| but("/events/5/then/separate", json!(vec![payload(); count]));
    let entries = ("/events/5/then/separate", "must have at most 64 entries, got 65");
    steady.refused_at("/simulate", &many(65), &[entries]).await;
    let phrase = "must separate at most 64 bodies in all, with those that separate from bodies, got 65";
    steady.refused_at("/simulate", &many(63), &[("/events/5/then/separate", phrase)]).await;
    // Those that bodies separate count.
    let inner = json!({"when": condition("time", "rises_through", 1e5), "then": {"separate": vec![payload(); 62]}});
    let request = but(&format!("{FIRST_STAGE}/events"), json!([inner]));
    steady.refused_at("/simulate", &request, &[("/events/5/then/separate", phrase)]).await;
    // As many as fit in a request cost no more to refuse: none of them is looked at.
    let event = json!({"when": condition("time", "rises_through", 1.0), "then": {"separate": vec![payload(); 64]}});
    let request = but("/events", json!(vec![event; 100]));
    let phrase = "must separate at most 64 bodies in all, with those that separate from bodies, got 6400";
    steady.refused_at("/simulate", &request, &[("/events/99/then/separate", phrase)]).await;
    let parts: Vec<_> = (0..65).map(|index| json!({"name": index.to_string(), "dry_mass": 1})).collect();
    let body = |index: i32| {
        with_all(&payload(), [("/name", json!(index.to_string())), ("/parts", json!([index.to_string()]))])
    };
    let bodies: Vec<_> = (0..64).map(body).collect();
    let events = json!([{"when": condition("time", "rises_through", 1.0), "then": {"separate": bodies}}]);
    good_answer(
        &steady.service,
        "/simulate",
        &with_all(&launcher(), [("/vehicle/parts", json!(parts)), ("/events", events)]),
    )
    .await;
}

#[tokio::test]
async fn a_body_needs_aerodynamics_and_an_area() {
    let steady = Steady::new().await;
    let at = |field: &str| format!("{FIRST_STAGE}/{field}");
    let [area, aerodynamics] = ["reference_area", "aerodynamics"].map(at);
    let of_part = without(&launcher(), "/vehicle/parts/0/reference_area");
    steady.refused_at("/simulate", &of_part, &[(&area, "is required: part \"first\" has none")]).await;
    let neither = without(&of_part, "/vehicle/parts/0/aerodynamics");
    let phrase = "is required: part \"first\" has none";
    steady.refused_at("/simulate", &neither, &[(&area, phrase), (&aerodynamics, phrase)]).await;
    let two = but(&at("parts"), json!(["first", "fairing"]));
    let two = with(&two, "/events/5/then", json!({}));
    let phrase = "is required for a body of several parts";
    steady.refused_at("/simulate", &two, &[(&area, phrase), (&aerodynamics, phrase)]).await;
    // A ballistic coefficient refers to no area.
    let ballistic = json!({"type": "ballistic", "ballistic_coefficient": 300});
    let given = with(&neither, &aerodynamics, ballistic.clone());
    let opens = "/events/3/then/separate/0/events/0/then/reference_area";
    steady.refused_at("/simulate", &given, &[(opens, "must be omitted: the vehicle is ballistic")]).await;
    good_answer(&steady.service, "/simulate", &with(&given, &at("events"), json!([]))).await;
    let area_too = with_all(&given, [(area.as_str(), json!(3)), (&at("events"), json!([]))]);
    steady.refused_at("/simulate", &area_too, &[(&area, "is not a field here")]).await;
}

#[tokio::test]
async fn faults_within_bodies_have_the_pointers_of_their_fields() {
    let steady = Steady::new().await;
    let at = |field: &str| format!("{FIRST_STAGE}{field}");
    let inner = json!({"when": {"event": "gone"}, "then": {"separate": [with(&payload(), "/stop", json!({"when": [{"burnout": "first"}]}))]}});
    let request = with_all(
        &launcher(),
        [
            (
                &*at("/events"),
                json!([inner, {"when": condition("heat_flux", "rises_through", 1.0), "then": {"mass": 3, "release": ["drogue"]}}]),
            ),
            (
                &at("/control"),
                json!({"steering": {"type": "vertical"}, "angle_of_attack": 3,
                "bank_angle": {"type": "schedule", "against": {"since": "staging"}, "at": [0], "value": [1]}}),
            ),
            (&at("/stop"), json!({"ceiling": -5, "when": [{"event": "staging"}]})),
        ],
    );
    let unknown = "must be the name of an event of the case, got ";
    let expected = [
        ("/events/0/when/event", unknown),
        ("/events/0/then/separate/0/parts/0", "must be the name of a part (\"first\"), got \"payload\""),
        (
            "/events/0/then/separate/0/stop/when/0/burnout",
            "must be the name of a part with an engine (there is none), got \"first\"",
        ),
        ("/events/1/when/quantity", "requires heating"),
        ("/events/1/then/mass", "must be omitted"),
        ("/events/1/then/release/0", "must be the name of a parachute that an event deploys"),
        ("/control/angle_of_attack", "must be omitted: the steering defines the angle of attack"),
        ("/control/bank_angle/against/since", unknown),
        ("/stop/ceiling", "must be greater than the stop altitude, 0 m, got -5"),
        ("/stop/when/0/event", unknown),
    ];
    let expected = expected.map(|(pointer, phrase)| (at(pointer), phrase));
    let expected: Vec<_> = expected.iter().map(|(pointer, phrase)| (pointer.as_str(), *phrase)).collect();
    steady.refused_at("/simulate", &request, &expected).await;
    let structure = with_all(
        &launcher(),
        [
            (&*at("/events/0/then"), json!({"reference_area": -1, "tilt": {}})),
            (&at("/push"), json!({"along": "up", "value": 1e7})),
            (&at("/stop"), json!({"time": 0})),
            (&at("/parts"), json!([1])),
            (&at("/color"), json!("red")),
        ],
    );
    let expected = [
        ("/events/0/then/reference_area", "must be at least 0, got -1"),
        ("/events/0/then/tilt/angle", "is required"),
        ("/push/along", "must be one of velocity, radial, normal, horizontal"),
        ("/push/value", "must be between -1000000 and 1000000"),
        ("/stop/time", "must be greater than 0"),
        ("/parts/0", "must be a string, got a number"),
        (
            "/color",
            "is not a field here; the fields are name, parts, push, reference_area, aerodynamics, events, control, stop",
        ),
    ];
    let expected = expected.map(|(pointer, phrase)| (at(pointer), phrase));
    let expected: Vec<_> = expected.iter().map(|(pointer, phrase)| (pointer.as_str(), *phrase)).collect();
    steady.refused_at("/simulate", &structure, &expected).await;
}

#[tokio::test]
async fn a_mach_number_that_a_body_lacks_is_told_where_it_is_needed() {
    let steady = Steady::new().await;
    let table = launcher()["vehicle"]["aerodynamics"].clone();
    let constant = json!({"type": "constant", "drag_coefficient": 0.4});
    let air = json!({"type": "table", "altitude": [0, 1e5], "density": [1, 1e-6], "pressure": [1e5, 0.1]});
    let base = with_all(&launcher(), [("/vehicle/aerodynamics", constant), ("/atmosphere", air)]);
    good_answer(&steady.service, "/simulate", &base).await;
    let phrase = "requires a Mach number";
    let of_part = with(&base, "/vehicle/parts/0/aerodynamics", table.clone());
    steady.refused_at("/simulate", &of_part, &[("/vehicle/parts/0/aerodynamics/type", phrase)]).await;
    let own = with(&of_part, &format!("{FIRST_STAGE}/aerodynamics"), table);
    steady.refused_at("/simulate", &own, &[("/events/3/then/separate/0/aerodynamics/type", phrase)]).await;
    let schedule = json!({"type": "schedule", "against": "mach", "at": [0], "value": [1]});
    let steered = json!({"bank_angle": schedule, "steering": {"type": "program", "frame": "local", "pitch": 3, "azimuth": schedule}});
    let controlled = with(&base, &format!("{FIRST_STAGE}/control"), steered);
    let expected = [
        ("/events/3/then/separate/0/control/bank_angle/against", phrase),
        ("/events/3/then/separate/0/control/steering/azimuth/against", phrase),
    ];
    steady.refused_at("/simulate", &controlled, &expected).await;
}

#[tokio::test]
async fn an_inertial_direction_needs_the_angle_of_the_planet_wherever_it_stands() {
    let steady = Steady::new().await;
    let planet = json!({"model": "custom", "gravitational_parameter": 3.986e14, "equatorial_radius": 6_378_137, "polar_radius": 6_356_752,
        "rotation_rate": 7.29e-5});
    let launch = json!({"type": "launch", "geodetic_latitude": -39, "longitude": 178, "azimuth": 100});
    let base = with_all(
        &launcher(),
        [
            ("/planet", planet),
            ("/initial_state", launch),
            ("/epoch", json!("2026-01-01T00:00:00Z")),
            ("/stop/time", json!(1)),
        ],
    );
    good_answer(&steady.service, "/simulate", &base).await;
    let push = json!({"along": {"frame": "inertial", "direction": [1, 0, 0]}, "value": 3});
    let steering = json!({"type": "program", "frame": "inertial", "right_ascension": 1, "declination": 2});
    for (pointer, value) in [
        ("/control/steering", steering.clone()),
        ("/events/4/then/steer", steering.clone()),
        ("/events/3/then/separate/0/push", push.clone()),
        ("/events/3/then/separate/0/control", json!({"steering": steering})),
        ("/events/3/then/separate/0/events/0/then", json!({"delta_v": push})),
    ] {
        let request = with(&base, pointer, value);
        let expected = [("/initial_state/sidereal_time", "is required for an inertial direction")];
        steady.refused_at("/simulate", &request, &expected).await;
        good_answer(&steady.service, "/simulate", &with(&request, "/initial_state/sidereal_angle", 30)).await;
    }
}

#[tokio::test]
async fn bodies_within_bodies_end_where_json_does() {
    let steady = Steady::new().await;
    let nested = |depth: usize| {
        let mut events = json!([]);
        for index in (0..depth).rev() {
            let parts: Vec<_> = (index..depth).map(|index| index.to_string()).collect();
            let body = with_all(
                &payload(),
                [("/name", json!(index.to_string())), ("/parts", json!(parts)), ("/events", events)],
            );
            let time = condition("time", "rises_through", 1.0 + f64::from(u16::try_from(index).unwrap()));
            events = json!([{"when": time, "then": {"separate": [body]}}]);
        }
        let parts: Vec<_> = (0..=depth).map(|index| json!({"name": index.to_string(), "dry_mass": 1})).collect();
        with_all(&launcher(), [("/vehicle/parts", json!(parts)), ("/events", events)])
    };
    // An event, its effect, a list and a body: five levels of JSON each, of which there may be 128.
    for depth in [2, 10, 20] {
        let request = nested(depth);
        let answer = good_answer(&steady.service, "/simulate", &request).await;
        assert_eq!(answer["events"].as_array().unwrap().len(), 1, "{depth}");
        // The innermost body takes the only part that its parent has.
        let deepest = format!("{}/events", "/events/0/then/separate/0".repeat(depth));
        let inner = json!([{"when": {"event": "x"}, "then": {"mass": 1}}]);
        let expected = [
            (format!("{deepest}/0/when/event"), "must be the name of an event"),
            (format!("{deepest}/0/then/mass"), "must be omitted"),
        ];
        let expected: Vec<_> = expected.iter().map(|(pointer, phrase)| (pointer.as_str(), *phrase)).collect();
        steady.refused_at("/simulate", &with(&request, &deepest, inner), &expected).await;
    }
    let deep = problem(&steady.service.post("/simulate", &nested(40)).await);
    assert_eq!(deep["type"], "/problems/invalid-json");
}

#[tokio::test]
async fn a_launch_echoed_flies_the_same() {
    let service = Service::new();
    let place = json!({"type": "launch", "geodetic_latitude": -39.26, "longitude": 177.86});
    let free = with_all(&place, [("/geodetic_altitude", json!(30)), ("/hold_down", json!(false))]);
    for state in [launcher()["initial_state"].clone(), place, free] {
        let request = with_all(&launcher(), [("/echo", json!(true)), ("/initial_state", state)]);
        let first = good_answer(&service, "/simulate", &request).await;
        let case = &first["case"];
        let has = |pointer: &str, value: Value| assert_eq!(case.pointer(pointer), Some(&value), "{pointer}");
        has("/vehicle/parts/0/count", json!(1));
        has("/vehicle/parts/3/propellant", json!(0.0));
        has("/events/3/then/separate/0/control", json!({"bank_angle": 0.0, "angle_of_attack": 0.0}));
        has("/events/3/then/separate/0/stop", json!({}));
        has("/events/4/then/steer/yaw", json!(0.0));
        has("/control", json!({"steering": {"type": "vertical"}, "bank_angle": 0.0, "angle_of_attack": 0.0}));
        assert!(case["initial_state"]["hold_down"].is_boolean() && case["initial_state"]["azimuth"].is_number());
        assert_eq!(case["events"].as_array().unwrap().len(), 6, "the event of the launch is none of the request's");
        let mut again = good_answer(&service, "/simulate", case).await;
        again["solver"]["elapsed"] = first["solver"]["elapsed"].clone();
        let timeless = |mut answer: Value| {
            for body in answer["bodies"].as_array_mut().into_iter().flatten() {
                body["solver"]["elapsed"] = json!(0);
            }
            answer
        };
        assert_eq!(timeless(again), timeless(first.clone()));
    }
}

/// Pointers to numbers of a launch, with steps for differences in their own units.
const NUMBERS: [(&str, f64); 17] = [
    ("/initial_state/azimuth", 1e-3),
    ("/initial_state/geodetic_latitude", 1e-4),
    ("/vehicle/parts/0/dry_mass", 0.1),
    ("/vehicle/parts/0/propellant", 0.1),
    ("/vehicle/parts/0/engine/thrust/vacuum", 10.0),
    ("/vehicle/parts/0/engine/thrust/sea_level", 10.0),
    ("/vehicle/parts/0/engine/specific_impulse", 1e-3),
    ("/vehicle/parts/1/engine/thrust/vacuum/2", 1.0),
    ("/vehicle/parts/1/engine/thrust/time/2", 1e-3),
    ("/vehicle/parts/1/engine/exit_area", 1e-5),
    ("/vehicle/parts/4/dry_mass", 0.01),
    ("/events/1/then/tilt/angle", 1e-4),
    ("/events/1/when/rises_through", 1e-3),
    ("/events/3/when/delay", 1e-3),
    ("/events/4/then/throttle/second", 1e-5),
    ("/events/4/then/load_limit", 1e-5),
    ("/events/4/then/steer/pitch/value/1", 1e-3),
];

#[tokio::test]
async fn numbers_of_a_launch_have_derivatives() {
    let place = json!({"type": "launch", "geodetic_latitude": -39.26, "longitude": 177.86, "azimuth": 100});
    let case = with_all(&launcher(), [("/initial_state", place), ("/solver", json!({"relative_tolerance": 1e-12}))]);
    let of = json!([{"quantity": "speed"}, {"quantity": "longitude"}, {"quantity": "altitude"}, {"quantity": "mass"}]);
    let scales = [1e3, 10.0, 1e5, 1e3];
    let pointers: Vec<_> = NUMBERS.iter().map(|(pointer, _)| *pointer).collect();
    let asked = |case: &Value, to: Value| with(case, "/sensitivities", json!({"of": of, "to": to}));
    let answer = fly(&asked(&case, json!(pointers))).await;
    let filled = fly(&with(&case, "/echo", true)).await["case"].clone();
    for (column, (pointer, step)) in NUMBERS.into_iter().enumerate() {
        let number = filled.pointer(pointer).and_then(Value::as_f64).unwrap();
        let told = &answer["sensitivities"]["to"][column];
        assert_eq!((told["pointer"].as_str(), told["value"].as_f64()), (Some(pointer), Some(number)));
        let mut values = Vec::new();
        for moved in [number + step, number - step] {
            values.push(fly(&asked(&with(&filled, pointer, moved), json!([]))).await["sensitivities"]["of"].clone());
        }
        for (row, scale) in scales.into_iter().enumerate() {
            let slope = answer["sensitivities"]["matrix"][row][column].as_f64();
            let slope = slope.unwrap_or_else(|| panic!("no slope of {} by {pointer}", of[row]));
            let [above, below] = [0, 1].map(|side: usize| values[side][row]["value"].as_f64().unwrap());
            let difference = (above - below) / (2.0 * step);
            // The differences bend, and flights at 1e-12 are noisy.
            let allowed = 2e-3 * difference.abs() + 1e-8 * scale / step;
            assert!(
                (slope - difference).abs() <= allowed,
                "{} by {pointer}: {slope}, by differences {difference}",
                of[row]
            );
        }
    }
}

#[tokio::test]
async fn numbers_of_a_launch_that_are_not_there_are_named() {
    let steady = Steady::new().await;
    let to = json!(["/events/4/then/throttle/third", "/vehicle/mass", "/initial_state/site", "/vehicle/parts/0/count"]);
    let request = but("/sensitivities", json!({"of": [{"quantity": "speed"}], "to": to}));
    let phrase = "must ";
    let expected = [0, 1, 2, 3].map(|index| format!("/sensitivities/to/{index}"));
    let expected: Vec<_> = expected.iter().map(|pointer| (pointer.as_str(), phrase)).collect();
    steady.refused_at("/simulate", &request, &expected).await;
}

#[tokio::test]
async fn a_launch_that_never_lifts_off_is_no_error() {
    let answer = fly(&with_all(&launcher(), [("/events/0/then", json!({})), ("/stop/time", json!(10))])).await;
    assert_eq!(codes(&answer), ["never_lifted"]);
    assert_eq!(answer["termination"], "time_limit");
    let [start, end] = ["initial_state", "final_state"].map(|name| answer[name]["geodetic_altitude"].as_f64().unwrap());
    assert!((end - start).abs() < 1e-6, "{start} {end}");
}

/// What a load limit leaves to each of several engines is not known where one has a table.
#[tokio::test]
async fn unknown_shares_are_a_problem_of_their_own() {
    let service = Service::new();
    let limited = but("/events/0/then", json!({"ignite": ["first", "booster"], "load_limit": 2}));
    let answer = service.post("/simulate", &limited).await;
    assert_eq!(problem(&answer)["type"], "/problems/unknown-shares");
}
