//! `?format=oem`: the states of a flight as an Orbit Ephemeris Message (CCSDS 502.0-B-3), read by a strict reader of its own.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::bodies::launch;
use super::refusal::{Steady, good_answer};
use super::requests::{capsule, models, with, with_all, without};

const PATH: &str = "/simulate?format=oem";
const EPOCH: &str = "2026-11-22T12:00:00.25Z";

/// The keywords of a segment, in the order of table 5-3.
const METADATA: [&str; 9] = [
    "OBJECT_NAME",
    "OBJECT_ID",
    "CENTER_NAME",
    "REF_FRAME",
    "TIME_SYSTEM",
    "START_TIME",
    "STOP_TIME",
    "INTERPOLATION",
    "INTERPOLATION_DEGREE",
];

#[derive(Debug)]
struct Segment {
    comments: Vec<String>,
    values: Vec<String>,
    /// Epoch, position in m and velocity in m/s.
    states: Vec<(String, [f64; 3], [f64; 3])>,
}

impl Segment {
    fn value(&self, keyword: &str) -> &str {
        &self.values[METADATA.iter().position(|known| *known == keyword).unwrap()]
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// A number of sections 7.5.6 and 7.5.7.
fn kilo(text: &str) -> f64 {
    let mantissa = text.split('e').next().unwrap();
    let digits = mantissa.chars().filter(char::is_ascii_digit).count();
    let (whole, part) = mantissa.split_once('.').unwrap_or_else(|| panic!("{text} has no decimal point"));
    assert!(digits <= 16 && !part.is_empty() && !whole.trim_start_matches('-').is_empty(), "{text}");
    1e3 * text.parse::<f64>().unwrap()
}

/// Whether a text is a time of section 7.5.10 with six decimals.
fn is_time(text: &str) -> bool {
    let like = "0000-00-00T00:00:00.000000";
    let fits = |(byte, like): (u8, u8)| if like == b'0' { byte.is_ascii_digit() } else { byte == like };
    text.len() == like.len() && text.bytes().zip(like.bytes()).all(fits)
}

/// Reads a message by the rules of sections 5.2 and 7.
fn read(text: &str) -> Vec<Segment> {
    assert!(text.bytes().all(|byte| matches!(byte, b'\n' | b' '..=b'~')), "{text}");
    assert!(text.lines().all(|line| line.len() <= 254));
    let mut lines = text.lines().filter(|line| !line.is_empty()).peekable();
    assert_eq!(lines.next(), Some("CCSDS_OEM_VERS = 2.0"));
    while lines.next_if(|line| line.starts_with("COMMENT ")).is_some() {}
    assert!(is_time(lines.next().unwrap().strip_prefix("CREATION_DATE = ").unwrap()));
    assert_eq!(lines.next(), Some("ORIGINATOR = REENTRY"));
    let mut segments: Vec<Segment> = Vec::new();
    while let Some(line) = lines.next() {
        assert_eq!(line, "META_START");
        let mut comments = Vec::new();
        while let Some(line) = lines.next_if(|line| line.starts_with("COMMENT ")) {
            comments.push(line["COMMENT ".len()..].to_owned());
        }
        let mut values = Vec::new();
        for keyword in METADATA {
            let Some(line) = lines.next_if(|line| *line != "META_STOP") else { break };
            let (found, value) = line.split_once(" = ").unwrap();
            assert_eq!(found, keyword);
            values.push(value.to_owned());
        }
        assert_eq!(lines.next(), Some("META_STOP"));
        let mut states = Vec::new();
        while let Some(line) = lines.next_if(|line| *line != "META_START") {
            let [epoch, numbers @ ..] = &line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
            let [x, y, z, u, v, w] = numbers.iter().map(|text| kilo(text)).collect::<Vec<_>>()[..] else {
                panic!("{line}")
            };
            assert!(is_time(epoch), "{line}");
            states.push(((*epoch).to_owned(), [x, y, z], [u, v, w]));
        }
        let segment = Segment { comments, values, states };
        assert!(segment.states.windows(2).all(|pair| pair[0].0 < pair[1].0), "times do not grow");
        let ends = [segment.states.first(), segment.states.last()].map(|state| state.unwrap().0.as_str());
        assert_eq!([segment.value("START_TIME"), segment.value("STOP_TIME")], ends);
        match segment.states.len() {
            1 => assert_eq!(segment.values.len(), 7),
            _ => assert_eq!(segment.values[7..], ["HERMITE", "3"]),
        }
        if let Some(last) = segments.last() {
            assert_eq!(last.values[1..5], segment.values[1..5]);
            // Consecutive segments of an object may share an end alone (section 5.2.4.4).
            let is_same = last.value("OBJECT_NAME") == segment.value("OBJECT_NAME");
            assert!(!is_same || last.value("STOP_TIME") <= segment.value("START_TIME"));
        }
        segments.push(segment);
    }
    assert!(!segments.is_empty());
    segments
}

async fn text(case: &Value) -> String {
    let answer = Service::new().post(PATH, case).await;
    let text = String::from_utf8(answer.body.to_vec()).unwrap();
    assert_eq!(answer.status.as_u16(), 200, "{text}");
    text
}

async fn message(case: &Value) -> Vec<Segment> {
    read(&text(case).await)
}

/// All but the date on which it was made.
fn undated(text: &str) -> Vec<&str> {
    text.lines().filter(|line| !line.starts_with("CREATION_DATE")).collect()
}

fn distance(one: [f64; 3], other: [f64; 3]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// A capsule with an epoch and rows at whole milliseconds, in degrees.
fn dated() -> Value {
    let state = json!({"type": "planet_relative", "altitude": 120_000, "longitude": 170, "geocentric_latitude": 10,
        "speed": 7500, "flight_path_angle": -3, "heading": 20});
    with_all(
        &capsule(),
        [
            ("/angle_unit", json!("deg")),
            ("/initial_state", state),
            ("/epoch", json!(EPOCH)),
            ("/output", json!({"interval": 20})),
        ],
    )
}

#[tokio::test]
async fn each_body_has_its_segments() {
    let case = with(&launch(), "/epoch", json!("2026-11-22T12:00:00Z"));
    let segments = message(&case).await;
    let names: Vec<_> = segments.iter().map(|segment| segment.value("OBJECT_NAME")).collect();
    let mut bodies = names.clone();
    bodies.dedup();
    assert_eq!(bodies, ["launch", "first stage", "ring, \"loose\""]);
    let stage = &segments[names.iter().position(|name| *name == "first stage").unwrap()];
    let answer = good_answer(&Service::new(), "/simulate", &case).await;
    assert_eq!(
        stage.value("START_TIME"),
        answer["bodies"][0]["initial_state"]["utc"].as_str().unwrap().trim_end_matches('Z')
    );
    assert!(stage.comments.contains(&"end surface_impact".to_owned()), "{:?}", stage.comments);
    // Where they part, body and vehicle are at one place.
    let vehicle = segments.iter().rfind(|segment| segment.value("STOP_TIME") == stage.value("START_TIME")).unwrap();
    assert!(distance(vehicle.states.last().unwrap().1, stage.states[0].1) < 1e-3);
    for bodies in ["ends", "none"] {
        let case = with(&case, "/output", json!({"interval": 20, "bodies": bodies}));
        assert!(message(&case).await.iter().all(|segment| segment.value("OBJECT_NAME") == "launch"));
    }
}

#[tokio::test]
async fn the_states_are_those_of_the_rows_in_gcrf() {
    let service = Service::new();
    for epoch in [EPOCH, "1957-10-04T19:28:34Z", "2090-02-28T23:59:59Z"] {
        let case = with(&dated(), "/epoch", epoch);
        let rows = good_answer(&service, "/simulate", &case).await["trajectory"].clone();
        let segments = message(&case).await;
        let [segment] = &segments[..] else { panic!("{} segments", segments.len()) };
        assert_eq!(segment.values[1..5], ["UNKNOWN", "EARTH", "GCRF", "UTC"]);
        assert_eq!(segment.states.len(), rows["time"].as_array().unwrap().len());
        for (row, (utc, position, velocity)) in segment.states.iter().enumerate() {
            assert_eq!(rows["utc"][row], format!("{utc}Z"));
            let state = json!({"type": "eci", "frame": "gcrf", "position": position, "velocity": velocity});
            let request = json!({"angle_unit": "deg", "epoch": rows["utc"][row], "state": state});
            let back = good_answer(&service, "/convert", &request).await;
            // The last row alone is not at a whole microsecond: half of one is 4 mm.
            for (form, name, tolerance) in [
                ("geodetic", "geodetic_altitude", 5e-3),
                ("geodetic", "longitude", 5e-8),
                ("geodetic", "geodetic_latitude", 5e-8),
                ("planet_relative", "radius", 5e-3),
                ("planet_relative", "speed", 1e-4),
                ("planet_relative", "flight_path_angle", 1e-5),
                ("planet_relative", "heading", 1e-5),
            ] {
                check::near(name, number(&back[form][name]), number(&rows[name][row]), tolerance);
            }
        }
    }
}

/// The frame of Mars has its axes where `/convert` has those of date.
#[tokio::test]
async fn the_states_at_mars_are_in_mci() {
    let service = Service::new();
    let case = with(&with(&dated(), "/planet", json!({"model": "mars"})), "/atmosphere", json!({"type": "standard"}));
    let case = with_all(&case, [("/output", json!({"interval": 50})), ("/stop", json!({"time": 150}))]);
    let rows = good_answer(&service, "/simulate", &case).await["trajectory"].clone();
    let segments = message(&case).await;
    let [segment] = &segments[..] else { panic!("{} segments", segments.len()) };
    assert_eq!(segment.values[1..5], ["UNKNOWN", "MARS", "MCI", "UTC"]);
    assert_eq!(segment.states.len(), 4);
    for (row, (_, position, velocity)) in segment.states.iter().enumerate() {
        let mut state = json!({"type": "planet_relative"});
        for name in ["radius", "longitude", "geocentric_latitude", "speed", "flight_path_angle", "heading"] {
            state[name] = rows[name][row].clone();
        }
        let planet = json!({"model": "mars"});
        let request = json!({"angle_unit": "deg", "epoch": rows["utc"][row], "planet": planet, "state": state});
        let eci = good_answer(&service, "/convert", &request).await["eci"].clone();
        let vector = |name: &str| [0, 1, 2].map(|axis| number(&eci[name][axis]));
        let off = [distance(*position, vector("position")), distance(*velocity, vector("velocity"))];
        assert!(off[0] < 1e-3 && off[1] < 1e-6, "{off:?}");
    }
}

/// A state holds at the time that stands before it, to less than that is rounded.
#[tokio::test]
async fn a_state_is_that_of_its_date_as_it_is_written() {
    let at = async |time: f64| {
        let segments = message(&with(&dated(), "/output", json!({"times": [time]}))).await;
        let (utc, position, _) = segments[0].states[1].clone();
        (utc, position)
    };
    let [(utc, position), (same, expected)] = [at(100.0 / 3.0).await, at(33.333_333).await];
    assert_eq!((utc.as_str(), utc.as_str()), (same.as_str(), "2026-11-22T12:00:33.583333"));
    let off = distance(position, expected);
    assert!(off < 1e-4, "{off} m: a third of a microsecond is 2.5 mm");
}

/// Rows nearer to one another than dates tell are one.
#[tokio::test]
async fn dates_grow_however_close_rows_are() {
    let case = with(&dated(), "/output", json!({"times": [1e-9, 1e-7, 2e-7, 1.0, 1.000_000_1, 1.000_001]}));
    let segments = message(&case).await;
    let dates: Vec<_> = segments[0].states.iter().map(|(utc, ..)| &utc[17..]).collect();
    assert_eq!(dates[..3], ["00.250000", "01.250000", "01.250001"]);
    assert_eq!(dates.len(), 4);
}

/// A segment ends where the velocity jumps, and where a force does.
#[tokio::test]
async fn nothing_is_interpolated_across_a_jump() {
    let service = Service::new();
    let case: Value = serde_json::from_str(include_str!("../../openapi/examples/deorbit.json")).unwrap();
    let case = with(&case, "/epoch", EPOCH);
    let answer = good_answer(&service, "/simulate", &case).await;
    let segments = message(&case).await;
    let mut since: Vec<_> = answer["phases"].as_array().unwrap().iter().map(|phase| number(&phase["since"])).collect();
    // The first phase has no duration: the burn begins with the flight.
    assert_eq!((since[0], since[1]), (0.0, 0.0));
    since.remove(0);
    assert_eq!(segments.len(), since.len());
    for (pair, since) in segments.windows(2).zip(&since[1..]) {
        let [before, after] = [pair[0].states.last().unwrap(), pair[1].states.first().unwrap()];
        assert_eq!(before, after, "at {since} s");
    }
    // Every row is in a segment; of this case none is at a jump.
    let rows = answer["trajectory"]["time"].as_array().unwrap().len();
    let states: usize = segments.iter().map(|segment| segment.states.len()).sum();
    assert_eq!(states, rows + 2 * (segments.len() - 1));
    assert!(segments[1..].iter().all(|segment| segment.comments.is_empty()));

    // An impulse of 100 m/s, to the side and between two rows.
    let impulse = json!({"name": "kick", "when": {"quantity": "time", "rises_through": 50},
        "then": {"delta_v": {"along": "velocity", "value": 100}}});
    let segments = message(&with(&dated(), "/events", json!([impulse]))).await;
    let [one, other] = &segments[..] else { panic!("{} segments", segments.len()) };
    let [before, after] = [one.states.last().unwrap(), other.states.first().unwrap()];
    assert_eq!((before.0.as_str(), after.0.as_str()), ("2026-11-22T12:00:50.250000", "2026-11-22T12:00:50.250000"));
    assert!(distance(before.1, after.1) < 1e-6);
    check::near("jump", distance(before.2, after.2), 100.0, 1e-6);
    assert_eq!((one.states.len(), other.states[1].0.as_str()), (4, "2026-11-22T12:01:00.250000"));
}

#[tokio::test]
async fn what_changes_nothing_and_what_has_no_duration_makes_no_segment() {
    let nothing = json!({"name": "mark", "when": {"quantity": "time", "rises_through": 50}});
    assert_eq!(message(&with(&dated(), "/events", json!([nothing]))).await.len(), 1);
    for time in [0, 100] {
        let impulse = json!({"when": {"quantity": "time", "rises_through": time},
            "then": {"delta_v": {"along": "velocity", "value": 100}}});
        let twice = with_all(&dated(), [("/events", json!([impulse, impulse])), ("/stop", json!({"time": 100}))]);
        let segments = message(&twice).await;
        assert_eq!(segments.len(), 1, "{time}");
        let plain = message(&with(&dated(), "/stop", json!({"time": 100}))).await;
        let jump = distance(segments[0].states[0].2, plain[0].states[0].2);
        check::near("initial velocity", jump, if time == 0 { 200.0 } else { 0.0 }, 1e-6);
    }
    let on_ground = [("/initial_state/altitude", json!(0)), ("/initial_state/speed", json!(0))];
    let segments = message(&with_all(&dated(), on_ground)).await;
    assert_eq!((segments.len(), segments[0].states.len()), (1, 1));
}

#[tokio::test]
async fn the_message_says_how_it_was_flown() {
    let segments = message(&with(&capsule(), "/epoch", EPOCH)).await;
    let expected = [
        "planet earth_wgs84, atmosphere exponential, gravity inverse_square",
        "end surface_impact",
        "GCRF without polar motion, and with UT1 taken as UTC",
        "warning angle_unit_assumed",
        "warning thesis_atmosphere",
    ];
    for comment in expected {
        assert!(segments[0].comments.iter().any(|found| found == comment), "{comment}: {:?}", segments[0].comments);
    }
    for (name, expected) in [
        (json!("Capsule 1"), "Capsule 1"),
        (json!("  a\n\tb ü \u{1}META_STOP "), "a  b ? ?META_STOP"),
        (json!(" \n"), "UNKNOWN"),
        (json!("é".repeat(1000)), &"?".repeat(200)),
    ] {
        assert_eq!(message(&with(&dated(), "/name", name)).await[0].value("OBJECT_NAME"), expected);
    }
    assert_eq!(message(&dated()).await[0].value("OBJECT_NAME"), "UNKNOWN");
}

#[tokio::test]
async fn a_flight_without_a_date_or_a_frame_is_refused() {
    let steady = Steady::new().await;
    let planet = |model: &str| with(&dated(), "/planet", json!({"model": model}));
    let custom = json!({"model": "custom", "gravitational_parameter": 3.986e14, "equatorial_radius": 6.378e6,
        "polar_radius": 6.357e6, "rotation_rate": 0});
    let until =
        |epoch: &str, time: f64| with_all(&dated(), [("/epoch", json!(epoch)), ("/stop", json!({"time": time}))]);
    let of_earth = "in the years 1900 to 2100 for OEM on the Earth";
    for (case, expected) in [
        (without(&dated(), "/epoch"), vec![("/epoch", "is required for OEM, whose states have dates")]),
        (
            planet("moon"),
            vec![("/planet/model", "must be the Earth or Mars for OEM, which names no inertial frame of")],
        ),
        (
            without(&with(&dated(), "/planet", custom), "/epoch"),
            vec![("/planet/model", "no inertial frame of a custom planet"), ("/epoch", "is required")],
        ),
        (until("1899-12-31T23:59:59Z", 60.0), vec![("/epoch", of_earth)]),
        (until("2101-01-01T00:00:00Z", 60.0), vec![("/epoch", of_earth)]),
        (until("2100-12-31T23:59:30Z", 60.0), vec![("/epoch", of_earth)]),
    ] {
        steady.refused_at(PATH, &case, &expected).await;
    }
    message(&until("2100-12-31T23:58:50Z", 60.0)).await;
    let air = json!({"type": "standard"});
    let mars = |epoch| with_all(&planet("mars"), [("/atmosphere", air.clone()), ("/epoch", json!(epoch))]);
    let mars = |epoch| with(&mars(epoch), "/stop", json!({"time": 60}));
    let expected = [("/epoch", "must let the flight end before the year 10000 for OEM")];
    steady.refused_at(PATH, &mars("9999-12-31T23:59:30Z"), &expected).await;
    message(&mars("9999-12-31T23:58:50Z")).await;
}

#[tokio::test]
async fn what_has_no_place_in_a_message_is_refused() {
    let service = Service::new();
    let asks = with_all(&dated(), [("/sensitivities", json!(true)), ("/verify", json!(true))]);
    let answer = service.post(PATH, &with(&asks, "/output", json!({"trajectory": false}))).await;
    let expected = ["/sensitivities", "/verify", "/output/trajectory"].map(str::to_owned).to_vec();
    assert_eq!((answer.status.as_u16(), answer.pointers()), (422, expected));
    // An echo and columns are taken no notice of.
    let plain = text(&dated()).await;
    for (pointer, value) in [("/echo", json!(true)), ("/output/columns", json!(["mach", "time"]))] {
        assert_eq!(undated(&text(&with(&dated(), pointer, value)).await), undated(&plain));
    }
}

#[tokio::test]
async fn it_is_chosen_by_name_or_media_type() {
    let service = Service::new();
    let by_name = service.post(PATH, &dated()).await;
    assert_eq!(by_name.headers["content-type"], "text/vnd.ccsds.oem; charset=us-ascii");
    for (accept, media_type) in [
        ("text/html, text/vnd.ccsds.oem;q=0.9", "text/vnd.ccsds.oem; charset=us-ascii"),
        // Where any text will do, a table is the simpler one.
        ("text/*", "text/csv; charset=utf-8; header=present"),
    ] {
        let request = axum::http::Request::post("/simulate").header("content-type", "application/json");
        let request = request.header("accept", accept).body(dated().to_string().into()).unwrap();
        let answer = service.send(request).await;
        assert_eq!((answer.status.as_u16(), &answer.headers["content-type"]), (200, &media_type.parse().unwrap()));
    }
    for (path, body) in [("/convert", json!({})), ("/simulate/batch", json!([dated()]))] {
        let answer = service.post(&format!("{path}?format=oem"), &body).await;
        assert_eq!(answer.json()["type"], "/problems/not-acceptable", "{path}");
    }
}

#[tokio::test]
async fn every_model_gives_a_message() {
    // One has columns of its own, and one three rows alone.
    for (name, case) in models().into_iter().filter(|(name, _)| !["columns", "nearest site"].contains(name)) {
        let case = with_all(&case, [("/stop/time", json!(200)), ("/epoch", json!(EPOCH))]);
        let model = case["planet"]["model"].as_str().unwrap_or("earth_wgs84").to_owned();
        if model.starts_with("earth") || model == "mars" {
            assert!(message(&case).await.iter().any(|segment| segment.states.len() > 3), "{name}");
        }
    }
}

/// So far away that a fixed point would take more than sixteen digits.
#[tokio::test]
async fn great_distances_have_an_exponent() {
    let state = json!({"type": "ecef", "position": [9e11, 0, 0], "velocity": [-1000, 0, 0]});
    let case = with_all(
        &dated(),
        [("/initial_state", state), ("/atmosphere", json!({"type": "vacuum"})), ("/stop", json!({"time": 10}))],
    );
    let written = text(&case).await;
    assert!(written.contains("e8 "), "{written}");
    check::relative("radius", distance(read(&written)[0].states[0].1, [0.0; 3]), 9e11, 1e-15);
}
