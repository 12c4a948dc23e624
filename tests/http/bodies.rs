//! Bodies that leave a vehicle, and those that leave them: in every format, asked for in every way.

use reentry_service::config::Config;
use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::problems::post_json;
use super::refusal::{Steady, good_answer};
use super::requests::{with, with_all, without};
use super::simulate::{fly, names};

/// A launch of two stages: the first, with a ring around it, leaves by a named event, and the ring leaves it by one without a name.
pub(crate) fn launch() -> Value {
    let drag = |coefficient: f64| json!({"type": "constant", "drag_coefficient": coefficient});
    json!({
        "name": "launch", "angle_unit": "deg", "atmosphere": {"type": "us76"},
        "initial_state": {"type": "launch", "geodetic_latitude": -39.26, "longitude": 177.86, "azimuth": 100},
        "vehicle": {
            "reference_area": 1.13, "aerodynamics": drag(0.4),
            "parts": [
                {"name": "first", "dry_mass": 1100, "propellant": 12_000,
                    "engine": {"thrust": {"vacuum": 250_000, "sea_level": 215_000}, "specific_impulse": 300}},
                {"name": "ring", "dry_mass": 30, "reference_area": 1, "aerodynamics": drag(1.1)},
                {"name": "second", "dry_mass": 250, "propellant": 2200,
                    "engine": {"thrust": {"vacuum": 26_000}, "specific_impulse": 340}},
                {"name": "payload", "dry_mass": 150},
            ],
        },
        "control": {"steering": {"type": "vertical"}},
        "events": [
            {"name": "ignition", "when": {"quantity": "time", "rises_through": 0}, "then": {"ignite": ["first"]}},
            {"name": "tilt", "when": {"quantity": "speed", "rises_through": 60},
                "then": {"tilt": {"angle": 3}, "steer": {"type": "velocity"}}},
            {"name": "staging", "when": {"burnout": "first", "delay": 3}, "then": {"separate": [
                {"name": "first stage", "parts": ["first", "ring"], "reference_area": 3, "aerodynamics": drag(0.9), "events": [
                    {"when": {"quantity": "altitude", "falls_through": 50_000},
                        "then": {"separate": [{"name": "ring, \"loose\"", "parts": ["ring"]}]}},
                    {"name": "parachute", "when": {"quantity": "altitude", "falls_through": 4700}, "then": {"reference_area": 80}},
                ]},
            ]}},
            {"name": "second ignition", "when": {"event": "staging", "delay": 2}, "then": {"ignite": ["second"]}},
        ],
        "stop": {"time": 800},
        "output": {"interval": 20},
    })
}

const RING: &str = "ring, \"loose\"";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

async fn text(case: &Value, format: &str) -> String {
    let answer = Service::new().post(&format!("/simulate?format={format}"), case).await;
    let text = String::from_utf8(answer.body.to_vec()).unwrap();
    assert_eq!(answer.status.as_u16(), 200, "{text}");
    text
}

#[tokio::test]
async fn each_body_has_its_flight_on_the_clock_of_the_case() {
    let answer = fly(&launch()).await;
    let bodies = answer["bodies"].as_array().unwrap();
    let of = |name: &str| bodies.iter().map(|body| body[name].clone()).collect::<Vec<_>>();
    assert_eq!(of("name"), ["first stage", RING]);
    assert_eq!(of("parent"), [Value::Null, json!("first stage")]);
    assert_eq!(of("separated_by"), [json!("staging"), json!(0)]);
    assert_eq!(of("termination"), ["surface_impact", "surface_impact"]);
    for (body, event) in bodies.iter().zip([&answer["events"][3], &bodies[0]["events"][0]]) {
        let separated_at = &body["separated_at"];
        assert_eq!(&event["time"], separated_at);
        assert_eq!(&body["initial_state"]["time"], separated_at);
        // Without a push all that part have one state; the masses add up.
        for name in ["altitude", "longitude", "speed", "flight_path_angle", "downrange"] {
            check::near(name, number(&body["initial_state"][name]), number(&event["state"][name]), 1e-6);
        }
        let [before, after, own] =
            [&event["state"], &event["after"], &body["initial_state"]].map(|row| number(&row["mass"]));
        check::near("mass", before, after + own, 1e-9);
        let times = body["trajectory"]["time"].as_array().unwrap();
        let (end, between) = (&body["final_state"]["time"], &times[1..times.len() - 1]);
        assert_eq!((&times[0], &times[times.len() - 1]), (separated_at, end));
        assert!(
            between.iter().all(|time| number(time) % 20.0 == 0.0),
            "rows at multiples of the interval: {between:?}"
        );
        assert!(number(end) > number(&answer["events"][4]["time"]));
        for member in ["steps", "rejected_steps", "evaluations"] {
            assert!(body["solver"][member].is_u64(), "{member}");
        }
        assert_eq!(names(&body["initial_state"]), names(&answer["initial_state"]));
        assert_eq!(names(&body["trajectory"]), names(&answer["trajectory"]));
    }
    assert_eq!(bodies[0]["events"][1]["name"], "parachute");
    assert_eq!(bodies[0]["phases"][2]["from"], json!({"index": 1, "name": "parachute"}));
    assert_eq!((bodies[1].get("events"), bodies[1].get("phases")), (None, None));
    for member in ["formulation", "elapsed"] {
        assert_eq!(bodies[0]["solver"].get(member), None);
    }
}

#[tokio::test]
async fn where_nothing_leaves_there_are_no_bodies() {
    let case = without(&without(&launch(), "/events/2/then/separate"), "/output");
    let mut answer = fly(&with(&case, "/echo", true)).await;
    assert_eq!(answer.get("bodies"), None);
    assert_eq!(answer["case"]["output"], json!({"samples_per_step": 4}));
    assert!(text(&case, "csv").await.starts_with("time,"));
    // An event that does not happen separates nothing.
    let case = with(&launch(), "/stop/time", 100);
    answer = fly(&case).await;
    assert_eq!(answer.get("bodies"), None);
    assert!(text(&case, "csv").await.starts_with("time,"));
}

#[tokio::test]
async fn bodies_may_be_asked_for_without_rows_or_not_at_all() {
    let full = fly(&launch()).await;
    let mut ends = fly(&with(&launch(), "/output/bodies", "ends")).await;
    assert_eq!(ends["trajectory"], full["trajectory"]);
    for (without_rows, body) in
        ends["bodies"].as_array_mut().unwrap().iter_mut().zip(full["bodies"].as_array().unwrap())
    {
        assert_eq!(without_rows.get("trajectory"), None);
        without_rows["trajectory"] = body["trajectory"].clone();
        assert_eq!(without_rows, body);
    }
    let none = fly(&with(&launch(), "/output/bodies", "none")).await;
    assert_eq!(none.get("bodies"), None);
    assert_eq!(none["trajectory"], full["trajectory"]);
    let nowhere = fly(&with(&launch(), "/output", json!({"trajectory": false}))).await;
    assert_eq!((nowhere.get("trajectory"), nowhere["bodies"][0].get("trajectory")), (None, None));
    assert_eq!(nowhere["bodies"][1]["final_state"], full["bodies"][1]["final_state"]);
    // Alone it leaves the rows as they are by default.
    let echo = fly(&with_all(&launch(), [("/output", json!({"bodies": "ends"})), ("/echo", json!(true))])).await;
    assert_eq!(echo["case"]["output"], json!({"bodies": "ends", "samples_per_step": 4}));
    let echo = fly(&with(&launch(), "/echo", true)).await;
    assert_eq!(echo["case"]["output"], json!({"interval": 20, "bodies": "full"}));
}

#[tokio::test]
async fn parts_have_columns_of_their_own() {
    let answer = fly(&launch()).await;
    for place in ["initial_state", "final_state", "trajectory"] {
        assert_eq!(names(&answer[place])[names(&answer[place]).len() - 3..], ["thrust", "throttle", "pitch"]);
        assert!(names(&answer[place]).contains(&"mass"));
    }
    let columns = ["time", "mass", "propellant.first", "propellant.ring", "propellant.second", "apoapsis_altitude"];
    let answer = fly(&with(&launch(), "/output", json!({"count": 5, "columns": columns}))).await;
    assert_eq!(names(&answer["trajectory"]), columns);
    let [vehicle, stage, ring] =
        [&answer["trajectory"], &answer["bodies"][0]["trajectory"], &answer["bodies"][1]["trajectory"]];
    let first = vehicle["propellant.first"].as_array().unwrap();
    assert_eq!((&first[0], &first[2..]), (&json!(12_000.0), &[Value::Null, Value::Null, Value::Null][..]));
    assert!((1.0..12_000.0).contains(&number(&first[1])), "it burns: {first:?}");
    assert_eq!(number(&vehicle["propellant.second"][4]).to_bits(), 0.0_f64.to_bits());
    // A body has the columns of its own parts, until these leave it.
    assert_eq!(names(stage), ["time", "mass", "propellant.first", "propellant.ring", "apoapsis_altitude"]);
    assert_eq!(stage["propellant.ring"], json!([0.0, 0.0, null, null, null]));
    assert_eq!(names(ring), ["time", "mass", "propellant.ring", "apoapsis_altitude"]);
    let csv = text(&with(&launch(), "/output", json!({"count": 5, "columns": columns})), "csv").await;
    let last = csv.lines().last().unwrap().strip_prefix("\"ring, \"\"loose\"\"\",").unwrap();
    assert_eq!(last.split(',').skip(1).take(4).collect::<Vec<_>>(), ["30.0", "", "0.0", ""]);

    let steady = Steady::new().await;
    let problem =
        steady.refused(post_json("/simulate", &with(&launch(), "/output/columns", json!(["propellant.third"])))).await;
    assert_eq!(problem["errors"][0]["pointer"], "/output/columns/0");
    assert!(problem["errors"][0]["detail"].as_str().unwrap().contains("propellant.second, propellant.payload, got"));
}

#[tokio::test]
async fn csv_begins_each_row_with_the_body() {
    let answer = fly(&launch()).await;
    let csv = text(&launch(), "csv").await;
    let mut lines = csv.lines();
    let header = lines.next().unwrap();
    assert_eq!(header, format!("body,{}", names(&answer["trajectory"]).join(",")));
    let tables =
        [("", &answer), ("first stage", &answer["bodies"][0]), ("\"ring, \"\"loose\"\"\"", &answer["bodies"][1])];
    for (name, flight) in tables {
        for time in flight["trajectory"]["time"].as_array().unwrap() {
            let line = lines.next().unwrap();
            assert!(line.starts_with(&format!("{name},{time},")), "{line}");
        }
    }
    assert_eq!(lines.next(), None);
    for bodies in ["ends", "none"] {
        assert!(text(&with(&launch(), "/output/bodies", bodies), "csv").await.starts_with("time,"));
    }
    // A line stays one.
    let odd = with(&launch(), "/events/2/then/separate/0/name", "two\nlines");
    assert_eq!(text(&odd, "csv").await.lines().count(), csv.lines().count());
    assert!(text(&odd, "csv").await.contains("\ntwo\\nlines,"));
}

#[tokio::test]
async fn geojson_has_a_track_and_points_a_body() {
    let answer = fly(&launch()).await;
    for (bodies, tracks) in [("full", 3), ("ends", 1), ("none", 1)] {
        let map: Value =
            serde_json::from_str(&text(&with(&launch(), "/output/bodies", bodies), "geojson").await).unwrap();
        let properties: Vec<_> =
            map["features"].as_array().unwrap().iter().map(|feature| &feature["properties"]).collect();
        let found: Vec<_> = properties.iter().filter(|properties| properties["kind"] == "track").collect();
        assert_eq!(found.len(), tracks);
        assert_eq!((&found[0]["name"], found[0].get("body")), (&json!("launch"), None));
        for (body, track) in answer["bodies"].as_array().unwrap().iter().zip(&found[1..]) {
            assert_eq!((&track["name"], &track["body"]), (&body["name"], &body["name"]));
            let count = track["times"].to_string().matches(',').count();
            assert!(count + 1 >= body["trajectory"]["time"].as_array().unwrap().len());
        }
        for name in ["first stage", RING] {
            let ends = properties.iter().filter(|properties| properties["body"] == name && properties["kind"] == "end");
            assert_eq!(ends.count(), usize::from(bodies != "none"));
        }
    }
}

#[tokio::test]
async fn kml_has_a_folder_a_body() {
    for epoch in [None, Some("2026-11-22T12:00:00Z")] {
        let case = epoch.map_or_else(launch, |epoch| with(&launch(), "/epoch", epoch));
        let xml = text(&case, "kml").await;
        let [vehicle, stage, ring] = xml.split("<Folder>").collect::<Vec<_>>()[..] else { panic!("{xml}") };
        assert!(stage.starts_with("<name>first stage</name><description>surface impact"), "{stage}");
        assert!(ring.starts_with("<name>ring, &quot;loose&quot;</name>"), "{ring}");
        let line = if epoch.is_some() { "<gx:Track>" } else { "<LineString>" };
        assert_eq!([vehicle, stage, ring].map(|part| part.matches(line).count()), [1, 1, 1]);
        assert!(
            stage.contains("<name>parachute</name>")
                && stage.contains("<Data name=\"body\"><value>first stage</value>")
        );
        assert_eq!(xml.matches("</Folder>").count(), 2);
        let ends = text(&with(&case, "/output/bodies", "ends"), "kml").await;
        assert_eq!((ends.matches("<Folder>").count(), ends.matches(line).count()), (2, 1));
    }
}

#[tokio::test]
async fn czml_has_a_packet_a_body_while_it_flies() {
    let case = with(&launch(), "/epoch", "2026-11-22T12:00:00Z");
    let answer = fly(&case).await;
    let packets: Value = serde_json::from_str(&text(&case, "czml").await).unwrap();
    let packet = |id: &str| packets.as_array().unwrap().iter().find(|packet| packet["id"] == id).unwrap();
    let utc = |row: &Value| row["utc"].as_str().unwrap().to_owned();
    let flights = [("flight", &answer), ("body 0", &answer["bodies"][0]), ("body 1", &answer["bodies"][1])];
    for (id, flight) in flights {
        let [start, end] = ["initial_state", "final_state"].map(|row| utc(&flight[row]));
        assert_eq!(packet(id)["availability"], format!("{start}/{end}"));
        assert_eq!(packet(id)["position"]["epoch"], utc(&answer["initial_state"]));
        assert_eq!(packet(id)["position"]["cartographicDegrees"][0], flight["initial_state"]["time"]);
    }
    // Whoever flies longest sets the clock.
    let end = utc(&answer["bodies"][1]["final_state"]);
    assert!(packet("document")["clock"]["interval"].as_str().unwrap().ends_with(&end));
    assert_eq!(packet("body 0 point 0")["properties"]["body"], "first stage");
    let ids: std::collections::BTreeSet<_> =
        packets.as_array().unwrap().iter().map(|packet| packet["id"].to_string()).collect();
    assert_eq!(ids.len(), packets.as_array().unwrap().len());
}

#[tokio::test]
async fn the_limit_of_rows_is_that_of_all_bodies_together() {
    let steady = Steady::with(Config { row_limit: 30, ..Config::default() }).await;
    let with_count = |count: u64, bodies: &str| with(&launch(), "/output", json!({"count": count, "bodies": bodies}));
    for (count, bodies) in [(10, "full"), (30, "ends"), (30, "none")] {
        good_answer(&steady.service, "/simulate", &with_count(count, bodies)).await;
    }
    for (count, bodies) in [(11, "full"), (31, "ends"), (31, "none")] {
        let problem = steady.refused(post_json("/simulate", &with_count(count, bodies))).await;
        assert_eq!(problem["errors"][0]["pointer"], "/output/count");
        assert_eq!(problem["detail"], "the trajectory exceeds the limit of 30 rows");
    }
    for interval in [1e-9, 5e-324] {
        let problem =
            steady.refused(post_json("/simulate", &with(&launch(), "/output", json!({"interval": interval})))).await;
        assert_eq!(problem["type"], "/problems/row-limit");
    }
}

/// Brakes that are out above 80 m/s and in below undo themselves, as in `tests/core/model_modes.rs`.
fn with_undecided(name: &str) -> Value {
    let table = json!({"type": "alpha_mach_table", "angle_of_attack": [0, 30], "mach": [0, 1],
        "drag_coefficient": [[0.5, 0.5], [2, 2]], "lift_coefficient": [[0, 0], [0, 0]]});
    let brakes = json!({"angle_of_attack": {"type": "schedule", "against": "speed", "at": [0, 80], "value": [0, 30], "interpolation": "step"}});
    let [pointer, area] = match name {
        "first stage" => [json!("/events/2/then/separate/0"), json!(3)],
        _ => [json!("/events/2/then/separate/0/events/0/then/separate/0"), json!(0.075)],
    };
    let pointer = pointer.as_str().unwrap();
    let case = with(&launch(), &format!("{pointer}/aerodynamics"), table);
    with_all(&case, [(&format!("{pointer}/reference_area"), area), (&format!("{pointer}/control"), brakes)])
}

#[tokio::test]
async fn a_body_that_fails_is_named() {
    let steady = Steady::new().await;
    for (name, pointer) in
        [("first stage", "/events/2/then/separate/0"), (RING, "/events/2/then/separate/0/events/0/then/separate/0")]
    {
        let problem = steady.refused(post_json("/simulate", &with_undecided(name))).await;
        assert_eq!(problem["type"], "/problems/chattering-schedule", "{problem}");
        assert!(problem["detail"].as_str().unwrap().starts_with("the flight of a body cannot be completed: "));
        assert_eq!(problem["errors"][0]["pointer"], format!("{pointer}/control/angle_of_attack"));
        // Who does not fly does not fail.
        let case = with(&with_undecided(name), "/output/bodies", "none");
        good_answer(&steady.service, "/simulate", &case).await;
    }
}

#[tokio::test]
async fn bodies_have_names_of_their_own() {
    let steady = Steady::new().await;
    let nested = "/events/2/then/separate/0/events/0/then/separate/0/name";
    let problem = steady.refused(post_json("/simulate", &with(&launch(), nested, "first stage"))).await;
    assert_eq!(
        problem["errors"],
        json!([{"pointer": nested,
        "detail": "must be unique among the bodies of the case, got \"first stage\" again"}])
    );
    // That of the case is none of them.
    good_answer(&steady.service, "/simulate", &with(&launch(), nested, "launch")).await;
}

#[tokio::test]
async fn the_site_nearest_to_the_end_is_told() {
    let service = Service::new();
    let sites = service.get("/sites").await.json();
    let sites = sites["sites"].as_array().unwrap();
    let case = with(&launch(), "/output/sites", true);
    let answer = fly(&case).await;
    let turned = fly(&with(&with(&launch(), "/stop/time", 1), "/output/sites", true)).await;
    let bodies = answer["bodies"].as_array().unwrap();
    for flight in [&answer, &turned, &bodies[0], &bodies[1]] {
        let found = &flight["nearest_site"];
        let end = |name: &str| number(&flight["final_state"][name]).to_radians();
        let [longitude, latitude] = ["longitude", "geodetic_latitude"].map(end);
        // By the haversine of geodetic latitudes, which differ by a fifth of a degree from geocentric ones.
        let haversine = |site: &Value| {
            let of = |name: &str| number(&site[name]).to_radians();
            let (there, across) = (of("geodetic_latitude"), (longitude - of("longitude")) / 2.0);
            let square = ((latitude - there) / 2.0).sin().powi(2) + latitude.cos() * there.cos() * across.sin().powi(2);
            2.0 * 6_378_137.0 * square.sqrt().asin()
        };
        let nearest = sites.iter().min_by(|one, other| haversine(one).total_cmp(&haversine(other))).unwrap();
        assert_eq!(found["slug"], nearest["slug"]);
        check::relative("distance", number(&found["distance"]), haversine(nearest), 7e-3);
        let there = |name: &str| number(&nearest[name]).to_radians();
        let (other, turn) = (there("geodetic_latitude"), longitude - there("longitude"));
        let east = turn.sin() * latitude.cos();
        let north = other.cos() * latitude.sin() - other.sin() * latitude.cos() * turn.cos();
        let azimuth = east.atan2(north).to_degrees().rem_euclid(360.0);
        check::near("azimuth", number(&found["azimuth"]), azimuth, 0.4);
    }
    assert_eq!(fly(&launch()).await.get("nearest_site"), None);
    let steady = Steady::new().await;
    let mars = with_all(
        &super::requests::capsule(),
        [("/planet", json!({"model": "mars"})), ("/output", json!({"sites": true}))],
    );
    steady
        .refused_at(
            "/simulate",
            &mars,
            &[("/output/sites", "must be false or absent on a planet other than the Earth")],
        )
        .await;
}
