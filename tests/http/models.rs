//! The models of `/simulate`: gravity, air, wind, aerodynamics and control; what they add to the answer, and their faults.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use super::refusal::{Steady, good_answer};
use super::requests::{capsule, flight, model, with, with_all, without};
use super::simulate::{COLUMNS, codes, fly, names};

#[tokio::test]
async fn the_answer_says_which_models_flew() {
    for (name, part, kind) in [
        ("us76", "atmosphere", "us76"),
        ("vacuum", "atmosphere", "vacuum"),
        ("layers", "atmosphere", "layered_exponential"),
        ("preset", "atmosphere", "layered_exponential"),
        ("table of air", "atmosphere", "table"),
        ("us76", "wind", "constant"),
        ("table of wind", "wind", "table"),
        ("zonal", "gravity", "zonal"),
        ("us76", "aerodynamics", "constant"),
        ("ballistic", "aerodynamics", "ballistic"),
        ("mach_table", "aerodynamics", "mach_table"),
        ("alpha_mach_table", "aerodynamics", "alpha_mach_table"),
    ] {
        let answer = fly(&model(name)).await;
        assert_eq!(answer["models"][part], kind, "{name}");
    }
}

#[tokio::test]
async fn the_echo_has_the_defaults_of_every_model() {
    for (pointer, sent, echoed) in [
        (
            "/planet",
            json!({"gravity": {"type": "zonal"}}),
            json!({"gravity": {"type": "zonal", "degree": 2,
            "j2": 1.082_629_821_3e-3}, "model": "earth_wgs84", "shape": "ellipsoid"}),
        ),
        (
            "/planet",
            json!({"gravity": {"type": "zonal", "degree": 4, "j3": 0}}),
            json!({"gravity": {"type": "zonal", "degree": 4, "j2": 1.082_629_821_3e-3, "j3": 0,
                "j4": -1.619_621_591_4e-6}, "model": "earth_wgs84", "shape": "ellipsoid"}),
        ),
        ("/atmosphere", json!({"type": "us76"}), json!({"type": "us76"})),
        (
            "/control",
            json!({"bank_angle": {"type": "schedule", "against": "time", "at": [0], "value": [1]}}),
            json!({"bank_angle": {"type": "schedule", "against": "time", "at": [0], "value": [1],
                "interpolation": "linear"}, "angle_of_attack": 0.0}),
        ),
        (
            "/vehicle",
            json!({"mass": 10, "aerodynamics": {"type": "ballistic", "ballistic_coefficient": 100}}),
            json!({"mass": 10, "aerodynamics": {"type": "ballistic", "ballistic_coefficient": 100,
                "lift_to_drag": 0.0}}),
        ),
        ("/output", json!({"columns": ["time"]}), json!({"columns": ["time"], "samples_per_step": 4})),
    ] {
        let case = with_all(&capsule(), [(pointer, sent), ("/echo", json!(true))]);
        let answer = fly(&case).await;
        assert_eq!(answer["case"].pointer(pointer), Some(&echoed), "{case}");
        assert_eq!(answer["case"].get("wind"), None);
    }
}

#[tokio::test]
async fn columns_are_there_where_the_models_make_them_possible() {
    let with_air = ["temperature", "pressure", "speed_of_sound", "mach"];
    for (case, conditional) in [
        (capsule(), vec![]),
        (with(&capsule(), "/epoch", json!("2026-11-22T12:00:00Z")), vec!["utc"]),
        (with(&capsule(), "/atmosphere", json!({"type": "us76"})), with_air.to_vec()),
        (with(&capsule(), "/atmosphere", json!({"type": "vacuum"})), vec![]),
        (without(&model("table of air"), "/atmosphere/temperature"), vec!["pressure", "utc"]),
        (without(&model("table of air"), "/atmosphere/pressure"), vec!["temperature", "speed_of_sound", "mach", "utc"]),
    ] {
        let answer = fly(&case).await;
        for place in ["initial_state", "final_state", "trajectory"] {
            let found: Vec<_> = names(&answer[place]).into_iter().filter(|name| !COLUMNS.contains(name)).collect();
            assert_eq!(found, conditional, "{place} of {case}");
        }
        assert_eq!(answer["peaks"].get("mach").is_some(), conditional.contains(&"mach"), "{case}");
    }
    let all = fly(&model("us76")).await;
    let last = names(&all["trajectory"]);
    assert_eq!((last.len(), last.last()), (30, Some(&"ground_distance")));
    assert_eq!(last[14..20], ["azimuth", "air_speed", "temperature", "pressure", "speed_of_sound", "mach"]);
}

#[tokio::test]
async fn the_azimuth_of_what_stands_still_or_flies_vertically_is_0() {
    for (speed, angle) in [(0, 0), (0, -45), (100, 90), (100, -90)] {
        let case = with_all(
            &capsule(),
            [
                ("/angle_unit", json!("deg")),
                ("/initial_state/speed", json!(speed)),
                ("/initial_state/flight_path_angle", json!(angle)),
                ("/initial_state/heading", json!(30)),
            ],
        );
        assert_eq!(fly(&case).await["initial_state"]["azimuth"], json!(0.0), "{speed} m/s at {angle}°");
    }
}

#[tokio::test]
async fn the_azimuth_is_the_compass_direction_of_the_heading() {
    for (heading, azimuth) in [(0, 90), (90, 0), (180, 270), (-180, 270), (-90, 180), (45, 45), (91, 359), (-1, 91)] {
        let case = with_all(
            &capsule(),
            [
                ("/angle_unit", json!("deg")),
                ("/initial_state/flight_path_angle", json!(-3)),
                ("/initial_state/heading", json!(heading)),
            ],
        );
        let found = fly(&case).await["initial_state"]["azimuth"].as_f64().unwrap();
        assert!((0.0..360.0).contains(&found), "{heading}: {found}");
        let apart = (found - f64::from(azimuth)).rem_euclid(360.0);
        assert!(apart.min(360.0 - apart) < 1e-9, "{heading}: {found}");
    }
}

#[tokio::test]
async fn utc_follows_the_epoch() {
    let output = json!({"times": [0.25, 30]});
    let case = with_all(&capsule(), [("/epoch", json!("2026-11-22T13:59:45.5+01:00")), ("/output", output)]);
    let answer = fly(&case).await;
    let utc = answer["trajectory"]["utc"].as_array().unwrap();
    assert_eq!(utc[..3], ["2026-11-22T12:59:45.500000Z", "2026-11-22T12:59:45.750000Z", "2026-11-22T13:00:15.500000Z"]);
    assert_eq!(answer["initial_state"]["utc"], utc[0]);
    // RFC 3339 ends with the year 9999.
    let late = with(&case, "/epoch", json!("9999-12-31T23:59:59Z"));
    let answer = fly(&late).await;
    let utc = answer["trajectory"]["utc"].as_array().unwrap();
    assert_eq!(utc[..3], [json!("9999-12-31T23:59:59.000000Z"), json!("9999-12-31T23:59:59.250000Z"), json!(null)]);
    for leap in ["2016-12-31T23:59:60Z", "2016-12-31T23:59:59.5Z", "1972-06-30T23:59:60Z", "0000-01-01T00:00:00Z"] {
        fly(&with(&case, "/epoch", leap)).await;
    }
}

#[tokio::test]
async fn chosen_columns_come_alone_and_in_their_order() {
    let service = Service::new();
    let columns = json!(["speed", "utc", "time", "crossrange"]);
    let way = json!({"times": [1, 2], "columns": columns});
    let case = with_all(&capsule(), [("/epoch", json!("2026-11-22T12:00:00Z")), ("/output", way)]);
    let mut answer = good_answer(&service, "/simulate", &case).await;
    let mut full = good_answer(&service, "/simulate", &without(&case, "/output/columns")).await;
    assert_eq!(names(&answer["trajectory"]), ["speed", "utc", "time", "crossrange"]);
    for name in names(&answer["trajectory"]) {
        assert_eq!(answer["trajectory"][name], full["trajectory"][name], "{name}");
    }
    // All else is as without.
    for answer in [&mut answer, &mut full] {
        answer["solver"]["elapsed"] = json!(0);
        answer["trajectory"] = json!(null);
    }
    assert_eq!(answer, full);

    let csv = service.post("/simulate?format=csv", &case).await;
    let csv = String::from_utf8(csv.body.to_vec()).unwrap();
    let lines: Vec<_> = csv.lines().collect();
    assert_eq!(lines[0], "speed,utc,time,crossrange");
    assert!(lines[1].starts_with("7500.0") && lines[1].contains(",2026-11-22T12:00:00.000000Z,0.0,"), "{}", lines[1]);

    let batch = service.post("/simulate/batch", &json!([case])).await;
    let line: Value = serde_json::from_slice(&batch.body).unwrap();
    assert_eq!(names(&line["trajectory"]), ["speed", "utc", "time", "crossrange"]);
}

#[tokio::test]
async fn columns_without_a_way_have_four_rows_a_step() {
    let answer = fly(&with(&capsule(), "/output", json!({"columns": ["time"]}))).await;
    assert_eq!(answer["trajectory"]["time"], fly(&capsule()).await["trajectory"]["time"]);
}

/// From a vertical start there is no direction in which to count.
#[tokio::test]
async fn what_is_no_number_is_null_and_an_empty_cell() {
    let down = with_all(
        &capsule(),
        [
            ("/initial_state/flight_path_angle", json!(-std::f64::consts::FRAC_PI_2)),
            ("/output", json!({"count": 2, "columns": ["downrange", "time", "crossrange"]})),
        ],
    );
    let service = Service::new();
    let answer = good_answer(&service, "/simulate", &down).await;
    for name in ["downrange", "crossrange"] {
        assert_eq!(answer["trajectory"][name], json!([null, null]));
        assert_eq!(answer["final_state"][name], json!(null));
    }
    let csv = service.post("/simulate?format=csv", &down).await;
    let csv = String::from_utf8(csv.body.to_vec()).unwrap();
    assert_eq!(csv.lines().nth(1), Some(",0.0,"));
}

#[tokio::test]
async fn faults_of_columns_are_named() {
    let steady = Steady::new().await;
    let known = COLUMNS[..14].join(", ");
    for (output, pointer, phrase) in [
        (json!({"columns": ["time", "hight"]}), "/output/columns/1", known.as_str()),
        (
            json!({"columns": ["time", "hight"]}),
            "/output/columns/1",
            "periapsis_altitude, thrust, throttle, pitch, energy, got \"hight\"",
        ),
        (json!({"columns": ["time", 3]}), "/output/columns/1", "got a number"),
        (json!({"columns": ["time", "speed", "time"]}), "/output/columns/2", "time is given twice"),
        (json!({"columns": []}), "/output/columns", "must have at least 1 entry, got 0"),
        (json!({"columns": "time"}), "/output/columns", "must be an array of names, got a string"),
        (
            json!({"columns": ["time"], "trajectory": false}),
            "/output/columns",
            "must not be given together with \"trajectory\": false",
        ),
        (json!({"columns": ["time"], "count": 2, "interval": 1}), "/output", "must have exactly one of"),
        (
            json!({"columns": ["time", "thrust"]}),
            "/output/columns/1",
            "thrust requires an event that switches a thrust on",
        ),
        (json!({"columns": ["mach"]}), "/output/columns/0", "mach requires an atmosphere with a speed of sound"),
        (json!({"columns": ["time", "pressure"]}), "/output/columns/1", "an atmosphere with a pressure"),
        (json!({"columns": ["time", "utc"]}), "/output/columns/1", "utc requires an epoch"),
    ] {
        steady.refused_at("/simulate", &with(&capsule(), "/output", output), &[(pointer, phrase)]).await;
    }
    let several = with(&capsule(), "/output", json!({"columns": ["utc", "time", "temperature", "speed_of_sound"]}));
    let expected = [("/output/columns/0", "epoch"), ("/output/columns/2", "us76"), ("/output/columns/3", "us76")];
    steady.refused_at("/simulate", &several, &expected).await;
    let analytic = with_all(&capsule(), [("/solution", json!("loh")), ("/output", json!({"columns": ["time"]}))]);
    let expected = [
        ("/output/columns", "the columns of this response are fixed"),
        ("/vehicle/aerodynamics/lift_coefficient", "the theory requires lift"),
    ];
    steady.refused_at("/analytic", &analytic, &expected).await;
}

#[tokio::test]
async fn zonal_coefficients_go_with_the_degree() {
    let steady = Steady::new().await;
    for (gravity, expected) in [
        (json!({"type": "zonal", "j3": 0}), vec![("/planet/gravity/j3", "is not a field here")]),
        (json!({"type": "zonal", "degree": 3, "j4": 0}), vec![("/planet/gravity/j4", "is not a field here")]),
        (json!({"type": "zonal", "degree": 5}), vec![("/planet/gravity/degree", "between 2 and 4, got 5")]),
        (
            json!({"type": "zonal", "degree": 1, "j4": 1}),
            vec![
                ("/planet/gravity/degree", "between 2 and 4, got 1"),
                ("/planet/gravity/j4", "must be between -0.1 and 0.1, got 1"),
            ],
        ),
        (json!({"type": "inverse_square", "j2": 0}), vec![("/planet/gravity/j2", "is not a field here")]),
        (json!({"type": "point"}), vec![("/planet/gravity/type", "must be one of inverse_square, zonal")]),
        (json!(9.81), vec![("/planet/gravity", "must be an object, got a number")]),
    ] {
        for (path, request) in
            [("/simulate", capsule()), ("/convert", json!({"state": super::requests::state("ecef")}))]
        {
            let request = with(&request, "/planet", json!({"gravity": gravity}));
            steady.refused_at(path, &request, &expected).await;
        }
    }
    let custom = with(&flight("ecef"), "/planet/gravity", json!({"type": "zonal", "degree": 4, "j3": 0}));
    let required = "is required";
    let expected = [("/planet/gravity/j2", required), ("/planet/gravity/j4", required)];
    steady.refused_at("/simulate", &custom, &expected).await;
}

#[tokio::test]
async fn faults_of_tables_stand_at_their_numbers() {
    let steady = Steady::new().await;
    let air = model("table of air");
    let aerodynamics = model("alpha_mach_table");
    for (request, changes) in [
        (&air, vec![("/atmosphere/altitude", json!([0, 5e4, 5e4]), "/atmosphere/altitude/2", "must be greater than")]),
        (
            &air,
            vec![(
                "/atmosphere/density",
                json!([1, 2]),
                "/atmosphere/density",
                "as many entries as altitude, 3, got 2",
            )],
        ),
        (
            &air,
            vec![
                ("/atmosphere/density", json!([1, 0, 1]), "/atmosphere/density/1", "must be greater than 0, got 0"),
                ("/atmosphere/temperature", json!([1, "2", 3]), "/atmosphere/temperature/1", "must be a number"),
                ("/atmosphere/pressure", json!([1]), "/atmosphere/pressure", "must have at least 2 entries, got 1"),
            ],
        ),
        (
            &aerodynamics,
            vec![
                (
                    "/vehicle/aerodynamics/angle_of_attack",
                    json!([0, 0, 0.1]),
                    "/vehicle/aerodynamics/angle_of_attack/1",
                    "must be greater than the previous entry, 0",
                ),
                (
                    "/vehicle/aerodynamics/lift_coefficient",
                    json!([[1, 2, 3], [4, 5], [7, 8, 9]]),
                    "/vehicle/aerodynamics/lift_coefficient/1",
                    "must have as many numbers as mach, 3, got 2",
                ),
                (
                    "/vehicle/aerodynamics/drag_coefficient",
                    json!([[1, 2, 3], [4, 5, -6], [7, 8, 9]]),
                    "/vehicle/aerodynamics/drag_coefficient/1/2",
                    "must be at least 0, got -6",
                ),
            ],
        ),
        (
            &aerodynamics,
            vec![
                (
                    "/vehicle/aerodynamics/lift_coefficient",
                    json!([[1, 2, 3]]),
                    "/vehicle/aerodynamics/lift_coefficient",
                    "must have as many entries as angle_of_attack, 2, got 1",
                ),
                (
                    "/vehicle/aerodynamics/drag_coefficient",
                    json!([[1, 2, 3], 4]),
                    "/vehicle/aerodynamics/drag_coefficient/1",
                    "must be an array of numbers, got a number",
                ),
            ],
        ),
        (
            &model("layers"),
            vec![(
                "/atmosphere/layers",
                json!([{"base_altitude": 1e4, "density": 1, "scale_height": 7e3},
                {"base_altitude": 0, "density": 1, "scale_height": 7e3}]),
                "/atmosphere/layers/1/base_altitude",
                "must be greater than the previous entry, 10000, got 0",
            )],
        ),
        (
            &model("table of wind"),
            vec![("/wind/east", json!([1, 2e4]), "/wind/east/1", "must be between -10000 and 10000")],
        ),
    ] {
        let spoilt = changes.iter().fold(request.clone(), |request, (at, value, ..)| with(&request, at, value.clone()));
        let expected: Vec<_> = changes.iter().map(|(_, _, pointer, phrase)| (*pointer, *phrase)).collect();
        steady.refused_at("/simulate", &spoilt, &expected).await;
    }
    let both = with(&model("layers"), "/atmosphere/preset", json!("earth_seven_layer"));
    steady.refused_at("/simulate", &both, &[("/atmosphere", "exactly one of layers, preset")]).await;
}

#[tokio::test]
async fn tables_are_not_longer_than_allowed() {
    let steady = Steady::new().await;
    let ascending = |count: u32| (0..count).map(f64::from).collect::<Vec<_>>();
    let long = with_all(
        &model("table of wind"),
        [
            ("/wind/altitude", json!(ascending(10_001))),
            ("/wind/east", json!(vec![0; 10_001])),
            ("/wind/north", json!(vec![0; 10_000])),
        ],
    );
    let expected = [
        ("/wind/altitude", "must have at most 10000 entries, got 10001"),
        ("/wind/east", "must have at most 10000 entries"),
    ];
    steady.refused_at("/simulate", &long, &expected).await;
    let wide = json!({"type": "alpha_mach_table", "angle_of_attack": (0..101).map(|row| f64::from(row) / 100.0)
        .collect::<Vec<_>>(), "mach": ascending(1001), "lift_coefficient": vec![vec![0; 2]; 101],
        "drag_coefficient": [vec![1; 1001]]});
    let expected = [
        ("/vehicle/aerodynamics/angle_of_attack", "must have at most 100 entries, got 101"),
        ("/vehicle/aerodynamics/mach", "must have at most 1000 entries, got 1001"),
        ("/vehicle/aerodynamics/lift_coefficient", "must have at most 100 entries, got 101"),
        ("/vehicle/aerodynamics/drag_coefficient/0", "must have at most 1000 entries, got 1001"),
    ];
    steady.refused_at("/simulate", &with(&model("alpha_mach_table"), "/vehicle/aerodynamics", wide), &expected).await;
    let largest = json!({"type": "alpha_mach_table", "angle_of_attack": (0..100).map(|row| f64::from(row) / 100.0)
        .collect::<Vec<_>>(), "mach": ascending(1000), "lift_coefficient": vec![vec![0; 1000]; 100],
        "drag_coefficient": vec![vec![1; 1000]; 100]});
    good_answer(&steady.service, "/simulate", &with(&model("alpha_mach_table"), "/vehicle/aerodynamics", largest))
        .await;
}

#[tokio::test]
async fn a_ballistic_vehicle_has_no_area() {
    let steady = Steady::new().await;
    let ballistic = model("ballistic");
    let request = with(&ballistic, "/vehicle/reference_area", json!(0.2));
    steady.refused_at("/simulate", &request, &[("/vehicle/reference_area", "is not a field here")]).await;
    let request = with(&ballistic, "/vehicle/aerodynamics/drag_coefficient", json!(1));
    let expected = [("/vehicle/aerodynamics/drag_coefficient", "is not a field here")];
    steady.refused_at("/simulate", &request, &expected).await;
    let request = with(&ballistic, "/vehicle/aerodynamics/type", json!("constant"));
    let expected = [
        ("/vehicle/reference_area", "is required"),
        ("/vehicle/aerodynamics/drag_coefficient", "is required"),
        ("/vehicle/aerodynamics/ballistic_coefficient", "is not a field here"),
        ("/vehicle/aerodynamics/lift_to_drag", "is not a field here"),
    ];
    steady.refused_at("/simulate", &request, &expected).await;
}

#[tokio::test]
async fn faults_of_schedules_are_named() {
    let steady = Steady::new().await;
    let along = |against: Value, at: Value, value: Value| json!({"type": "schedule", "against": against, "at": at, "value": value});
    let schedule = |against: &str, at: Value, value: Value| along(json!(against), at, value);
    for (command, expected) in [
        (
            along(json!({"since": 3}), json!([1, 2]), json!([0, 0])),
            vec![("/against/since", "must be a string, got a number")],
        ),
        (along(json!({}), json!([0]), json!([0])), vec![("/against/since", "is required")]),
        (
            along(json!({"since": "main", "event": "main"}), json!([0]), json!([0])),
            vec![("/against/event", "is not a field here")],
        ),
        (along(json!({"since": "main"}), json!([-1]), json!([0])), vec![("/at/0", "must be at least 0, got -1")]),
        (
            along(json!({"since": "main"}), json!([0]), json!([0])),
            vec![("/against/since", "must be the name of an event of the case, got \"main\"")],
        ),
        (
            schedule("energy", json!([-1e7, -2e7]), json!([0, 0])),
            vec![("/at/1", "must be greater than the previous entry, -1e7")],
        ),
        (json!("flat"), vec![("", "must be a number or an object with a schedule, got a string")]),
        (json!([0]), vec![("", "must be a number or an object with a schedule, got an array")]),
        (json!({"at": [0], "value": [0]}), vec![("/type", "is required; it must be one of schedule")]),
        (schedule("time", json!([0, -1]), json!([0, 0])), vec![("/at/1", "must be at least 0, got -1")]),
        (schedule("time", json!([1, 1]), json!([0, 0])), vec![("/at/1", "must be greater than the previous entry, 1")]),
        (schedule("altitude", json!([-10]), json!([9])), vec![("/value/0", "for degrees, set")]),
        (
            schedule("altitude", json!([2e12]), json!([0, 1])),
            vec![("/at/0", "must be between -1e12 and 1e12"), ("/value", "must have as many entries as at, 1, got 2")],
        ),
        (
            schedule("height", json!([]), json!([])),
            vec![
                ("/against", "must be one of time, altitude, speed, mach, energy, got \"height\""),
                ("/at", "must have at least 1 entry, got 0"),
                ("/value", "must have at least 1 entry, got 0"),
            ],
        ),
    ] {
        for name in ["bank_angle", "angle_of_attack"] {
            let at = format!("/control/{name}");
            let request = with(&with(&capsule(), "/control", json!({})), &at, command.clone());
            let expected: Vec<_> = expected.iter().map(|(place, phrase)| (format!("{at}{place}"), *phrase)).collect();
            let expected: Vec<_> = expected.iter().map(|(pointer, phrase)| (pointer.as_str(), *phrase)).collect();
            steady.refused_at("/simulate", &request, &expected).await;
        }
    }
    let degrees = with_all(
        &capsule(),
        [
            ("/angle_unit", json!("deg")),
            ("/initial_state/flight_path_angle", json!(-3)),
            ("/control", json!({"bank_angle": schedule("time", json!([0, 1]), json!([360, 361]))})),
        ],
    );
    steady.refused_at("/simulate", &degrees, &[("/control/bank_angle/value/1", "(degrees)")]).await;
}

#[tokio::test]
async fn what_needs_a_mach_number_needs_a_temperature() {
    let steady = Steady::new().await;
    let phrase = "requires a Mach number";
    let by_mach = json!({"type": "schedule", "against": "mach", "at": [1], "value": [0]});
    let control = json!({"bank_angle": by_mach, "angle_of_attack": by_mach});
    for atmosphere in [
        json!({"type": "exponential"}),
        json!({"type": "vacuum"}),
        json!({"type": "layered_exponential", "preset": "earth_seven_layer"}),
        json!({"type": "table", "altitude": [0, 1e5], "density": [1, 1e-6]}),
    ] {
        for table in ["mach_table", "alpha_mach_table"] {
            let request = with_all(&model(table), [("/atmosphere", atmosphere.clone()), ("/control", control.clone())]);
            let expected = [
                ("/vehicle/aerodynamics/type", phrase),
                ("/control/bank_angle/against", phrase),
                ("/control/angle_of_attack/against", phrase),
            ];
            steady.refused_at("/simulate", &request, &expected).await;
        }
    }
}

#[tokio::test]
async fn faults_of_all_models_come_in_one_answer() {
    let steady = Steady::new().await;
    let request = json!({
        "planet": {"gravity": {"type": "zonal", "degree": "two"}},
        "atmosphere": {"type": "table", "altitude": [0], "density": [1, -2]},
        "density_factor": -1,
        "wind": {"type": "constant", "east": 1e5},
        "vehicle": {"mass": 1, "reference_area": 2, "aerodynamics": {"type": "ballistic", "lift_to_drag": "1"}},
        "control": {"bank_angle": {"type": "schedule", "against": "mach", "at": [1, 0], "value": [7, 0]},
            "angle_of_attack": null},
        "initial_state": super::requests::state("geodetic"),
        "output": {"columns": ["time", "time", "tim"]},
    });
    let expected = [
        ("/planet/gravity/degree", "must be a whole number, got a string"),
        ("/atmosphere/altitude", "must have at least 2 entries, got 1"),
        ("/atmosphere/density/1", "must be greater than 0, got -2"),
        ("/density_factor", "must be at least 0, got -1"),
        ("/wind/east", "must be between -10000 and 10000, got 100000"),
        ("/wind/north", "is required"),
        ("/vehicle/reference_area", "is not a field here"),
        ("/vehicle/aerodynamics/ballistic_coefficient", "is required"),
        ("/vehicle/aerodynamics/lift_to_drag", "must be a number, got a string"),
        ("/control/bank_angle/at/1", "must be greater than the previous entry, 1, got 0"),
        ("/control/bank_angle/value/0", "for degrees, set"),
        ("/control/angle_of_attack", "must be a number or an object with a schedule, got null"),
        ("/output/columns/2", "got \"tim\""),
    ];
    steady.refused_at("/simulate", &request, &expected).await;
}

#[tokio::test]
async fn an_angle_of_attack_that_changes_nothing_is_warned_of() {
    let code = "angle_of_attack_unused";
    let schedule = json!({"type": "schedule", "against": "time", "at": [0], "value": [0]});
    for (name, command, warns) in [
        ("us76", json!(0), false),
        ("us76", json!(0.1), true),
        ("us76", schedule.clone(), true),
        ("mach_table", json!(0.1), true),
        ("ballistic", json!(0.1), true),
        ("alpha_mach_table", json!(0.1), false),
        ("alpha_mach_table", schedule, false),
    ] {
        let answer = fly(&with(&model(name), "/control/angle_of_attack", command)).await;
        assert_eq!(codes(&answer).contains(&code), warns, "{name}");
    }
}

#[tokio::test]
async fn a_theory_wants_one_scale_height_and_constant_coefficients() {
    let steady = Steady::new().await;
    let theory = |name: &str| with(&model(name), "/solution", json!("loh"));
    let atmosphere = ("/atmosphere/type", "must be exponential");
    for name in ["us76", "vacuum", "layers", "table of air"] {
        steady.refused_at("/analytic", &theory(name), &[atmosphere]).await;
    }
    let aerodynamics = ("/vehicle/aerodynamics/type", "must be constant or ballistic");
    for name in ["mach_table", "alpha_mach_table"] {
        steady.refused_at("/analytic", &theory(name), &[atmosphere, aerodynamics]).await;
    }
    let thin = with_all(
        &with(&flight("geodetic"), "/solution", json!("loh")),
        [("/density_factor", json!(0)), ("/atmosphere/surface_density", json!(0))],
    );
    let phrase = "the theory requires air";
    let expected = [("/density_factor", phrase), ("/atmosphere/surface_density", phrase)];
    steady.refused_at("/analytic", &thin, &expected).await;

    let ballistic = with(
        &theory("ballistic"),
        "/atmosphere",
        json!({"type": "exponential", "surface_density": 1.2, "scale_height": 7000}),
    );
    let no_lift = with(&ballistic, "/vehicle/aerodynamics/lift_to_drag", json!(0));
    let expected = [("/vehicle/aerodynamics/lift_to_drag", "the theory requires lift")];
    steady.refused_at("/analytic", &no_lift, &expected).await;
    let steep = with(&ballistic, "/solution", json!("steep_ballistic"));
    let expected = [("/vehicle/aerodynamics/lift_to_drag", "the ballistic theory assumes no lift, got 0.3")];
    steady.refused_at("/analytic", &steep, &expected).await;
    let answer = good_answer(&steady.service, "/analytic", &ballistic).await;
    assert_eq!(codes(&answer), ["bank_angle_left_out", "wind_left_out"]);
    let calm =
        with_all(&ballistic, [("/wind/east", json!(0)), ("/wind/north", json!(0)), ("/control/bank_angle", json!(0))]);
    assert_eq!(codes(&good_answer(&steady.service, "/analytic", &calm).await), Vec::<&str>::new());
}
