//! `?format=geojson`, `kml` and `czml`: the flight on a map.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::refusal::good_answer;
use super::requests::{capsule, flight, models, with, with_all, without};

const MAPS: [(&str, &str); 3] = [
    ("geojson", "application/geo+json"),
    ("kml", "application/vnd.google-earth.kml+xml"),
    ("czml", "application/czml+json"),
];

/// The text of a map of a case that must be good.
async fn drawn(case: &Value, format: &str) -> String {
    let answer = Service::new().post(&format!("/simulate?format={format}"), case).await;
    let text = String::from_utf8(answer.body.to_vec()).unwrap();
    assert_eq!(answer.status.as_u16(), 200, "{text}");
    text
}

async fn geojson(case: &Value) -> Value {
    serde_json::from_str(&drawn(case, "geojson").await).unwrap()
}

async fn czml(case: &Value) -> Value {
    serde_json::from_str(&drawn(case, "czml").await).unwrap()
}

/// The answer in JSON, in degrees.
async fn fly(case: &Value) -> Value {
    good_answer(&Service::new(), "/simulate", case).await
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

fn positions(coordinates: &Value) -> Vec<[f64; 3]> {
    coordinates.as_array().unwrap().iter().map(|position| numbers(position).try_into().unwrap()).collect()
}

/// The texts of all elements of a name.
fn elements<'a>(xml: &'a str, name: &str) -> Vec<&'a str> {
    let (start, end) = (format!("<{name}>"), format!("</{name}>"));
    xml.split(&start).skip(1).map(|rest| rest.split(&end).next().unwrap()).collect()
}

/// The rows of an answer in JSON, with angles in degrees: longitude, latitude, altitude.
fn rows(answer: &Value) -> Vec<[f64; 3]> {
    let unit = |angle: f64| if answer["angle_unit"] == "deg" { angle } else { angle.to_degrees() };
    let column = |name| numbers(&answer["trajectory"][name]);
    let (longitudes, latitudes) = (column("longitude"), column("geodetic_latitude"));
    let places = longitudes.into_iter().zip(latitudes).zip(column("geodetic_altitude"));
    places.map(|((longitude, latitude), altitude)| [unit(longitude), unit(latitude), altitude]).collect()
}

/// A capsule that flies over the antimeridian, eastwards, in degrees.
fn across() -> Value {
    let state = json!({"type": "planet_relative", "altitude": 120_000, "longitude": 170, "geocentric_latitude": 10,
        "speed": 7500, "flight_path_angle": -3, "heading": 20});
    with_all(&capsule(), [("/angle_unit", json!("deg")), ("/initial_state", state)])
}

/// Two orbits over the poles, in degrees.
fn polar() -> Value {
    let state = json!({"type": "eci", "position": [6.8e6, 0, 0], "velocity": [0, 0, 7656]});
    let air = json!({"type": "vacuum"});
    with_all(
        &capsule(),
        [
            ("/angle_unit", json!("deg")),
            ("/initial_state", state),
            ("/atmosphere", air),
            ("/stop", json!({"time": 11000})),
        ],
    )
}

#[tokio::test]
async fn the_places_are_those_of_the_rows() {
    for case in [capsule(), flight("geodetic"), with(&flight("eci"), "/output", json!({"interval": 0.1}))] {
        let answer = fly(&case).await;
        let (rows, times) = (rows(&answer), numbers(&answer["trajectory"]["time"]));
        assert!(rows.len() > 2);

        let map = geojson(&case).await;
        let track = &map["features"][0];
        assert_eq!(track["geometry"]["type"], "LineString");
        assert_eq!(positions(&track["geometry"]["coordinates"]), rows);
        assert_eq!(track["properties"]["times"], answer["trajectory"]["time"]);
        assert_eq!(track["properties"].get("times_utc"), answer["trajectory"].get("utc"));

        let xml = drawn(&case, "kml").await;
        let (points, separator) = match case.get("epoch") {
            Some(_) => (elements(&xml, "gx:coord"), ' '),
            None => (elements(elements(&xml, "LineString")[0], "coordinates")[0].split(' ').collect(), ','),
        };
        let split = |point: &&str| point.split(separator).map(|part| part.parse().unwrap()).collect::<Vec<f64>>();
        assert_eq!(points.iter().map(split).collect::<Vec<_>>(), rows);

        let packets = czml(&case).await;
        let samples = numbers(&packets[1]["position"]["cartographicDegrees"]);
        let expected = times.into_iter().zip(rows).flat_map(|(time, [x, y, z])| [time, x, y, z]);
        assert_eq!(samples, expected.collect::<Vec<_>>());
    }
}

#[tokio::test]
async fn the_end_and_the_peaks_are_marked() {
    let case = with(&capsule(), "/atmosphere", json!({"type": "us76"}));
    let answer = fly(&case).await;
    let map = geojson(&case).await;
    let (peaks, end) = (answer["peaks"].as_object().unwrap(), &answer["final_state"]);
    let marks = &map["features"].as_array().unwrap()[1..];
    assert_eq!(marks.len(), 1 + peaks.len());
    for mark in marks {
        assert_eq!(mark["geometry"]["type"], "Point");
        let properties = &mark["properties"];
        let (name, kind, quantity) =
            (&properties["name"], &properties["kind"], properties["quantity"].as_str().unwrap());
        let place: [f64; 3] = numbers(&mark["geometry"]["coordinates"]).try_into().unwrap();
        if kind == "end" {
            assert_eq!(*name, "surface impact");
            assert_eq!((quantity, &properties["value"], &properties["unit"]), ("speed", &end["speed"], &json!("m/s")));
            assert_eq!((&properties["time"], &properties["altitude"]), (&end["time"], &end["altitude"]));
            assert_eq!([place][..], rows(&answer)[rows(&answer).len() - 1..]);
        } else {
            let peak = &peaks[quantity];
            assert_eq!((kind, name), (&json!("peak"), &json!(format!("peak {}", quantity.replace('_', " ")))));
            assert_eq!((&properties["value"], &properties["time"]), (&peak["value"], &peak["time"]));
            // The state is read off the dense output once more.
            check::near("altitude", number(&properties["altitude"]), number(&peak["altitude"]), 1e-6);
            let there = fly(&with(&case, "/output", json!({"times": [peak["time"]]}))).await;
            let expected = rows(&there)[usize::from(number(&peak["time"]) > 0.0)];
            for (found, expected) in place.into_iter().zip(expected) {
                check::near(quantity, found, expected, 1e-9);
            }
        }
    }
    let units: Vec<_> = marks.iter().map(|mark| mark["properties"]["unit"].as_str().unwrap()).collect();
    assert_eq!(units, ["m/s", "m/s²", "g", "Pa", "m", "m/s", ""]);

    let xml = drawn(&case, "kml").await;
    let packets = czml(&case).await;
    let placemarks = &elements(&xml, "Placemark")[1..];
    assert_eq!((placemarks.len(), packets.as_array().unwrap().len()), (marks.len(), 2 + marks.len()));
    for (index, mark) in marks.iter().enumerate() {
        let (place, packet) = (&mark["geometry"]["coordinates"], &packets[index + 2]);
        assert_eq!(packet["properties"], mark["properties"]);
        assert_eq!(packet["position"]["cartographicDegrees"], *place);
        let written = elements(placemarks[index], "coordinates")[0].split(',').map(|part| part.parse().unwrap());
        assert_eq!(written.collect::<Vec<f64>>(), numbers(place));
        assert!(placemarks[index].contains(&format!("<Data name=\"value\"><value>{}<", mark["properties"]["value"])));
        assert_eq!(elements(placemarks[index], "description")[0], packet["description"]);
    }
    let description = |index: usize| packets[index]["description"].as_str().unwrap();
    assert_eq!(description(4), "load factor 8.9873 g, 234.0 s after the start, at an altitude of 38465 m");
    // A Mach number has no unit.
    assert!(description(8).starts_with("mach ") && !description(8).contains(" ,"), "{}", description(8));
}

#[tokio::test]
async fn events_and_the_peaks_of_heating_are_marked() {
    let case: Value = serde_json::from_str(include_str!("../../openapi/examples/deorbit.json")).unwrap();
    let case = without(&with(&case, "/events/1/name", json!("separation_of <A> & B")), "/events/3/name");
    let answer = fly(&case).await;
    let (map, xml, packets) = (geojson(&case).await, drawn(&case, "kml").await, czml(&case).await);
    let of_kind = |kind: &str| -> Vec<(usize, &Value)> {
        let features = map["features"].as_array().unwrap().iter().enumerate();
        features.filter(|(_, feature)| feature["properties"]["kind"] == kind).collect()
    };
    let events = answer["events"].as_array().unwrap();
    let marks = of_kind("event");
    assert_eq!((events.len(), marks.len()), (6, 6));
    for (event, (index, mark)) in events.iter().zip(marks) {
        let (state, properties) = (&event["state"], &mark["properties"]);
        let name = event.get("name").cloned().unwrap_or_else(|| json!("event 3"));
        assert_eq!((&properties["name"], &properties["time"]), (&name, &event["time"]));
        assert_eq!((&properties["quantity"], &properties["value"]), (&json!("speed"), &state["speed"]));
        assert_eq!(properties["altitude"], state["altitude"]);
        let place = json!([state["longitude"], state["geodetic_latitude"], state["geodetic_altitude"]]);
        assert_eq!(mark["geometry"]["coordinates"], place);
        assert_eq!((&packets[index + 1]["name"], &packets[index + 1]["properties"]), (&name, properties));
        let name = name.as_str().unwrap().replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        assert_eq!(elements(elements(&xml, "Placemark")[index], "name"), [name]);
    }
    // All but the radiative flux, of which there is none at this speed.
    let peaks: Vec<_> = of_kind("peak").iter().map(|(_, mark)| mark["properties"]["quantity"].clone()).collect();
    let expected: Vec<_> =
        answer["peaks"].as_object().unwrap().keys().filter(|name| *name != "radiative_heat_flux").collect();
    assert_eq!(json!(peaks), json!(expected));
}

#[tokio::test]
async fn the_track_says_how_the_flight_ended_and_what_it_warns_of() {
    let table = json!({"type": "table", "altitude": [0, 1000], "east": [5, 6], "north": [0, 0]});
    let case =
        with_all(&across(), [("/wind", table), ("/stop", json!({"time": 100})), ("/name", json!("over the line"))]);
    let answer = fly(&case).await;
    assert!(!answer["warnings"].as_array().unwrap().is_empty());
    let track = geojson(&case).await["features"][0]["properties"].clone();
    for field in ["name", "termination", "models", "warnings"] {
        assert_eq!(track[field], answer[field], "{field}");
    }
    let detail = answer["warnings"][0]["detail"].as_str().unwrap();
    for format in ["kml", "czml"] {
        let text = drawn(&case, format).await;
        assert!(text.contains("time limit") && text.contains(detail), "{text}");
    }
}

/// A map has degrees, and so have the warnings on it.
#[tokio::test]
async fn warnings_are_in_degrees() {
    let (_, table) = models().into_iter().find(|(name, _)| *name == "alpha_mach_table").unwrap();
    let case = with_all(&table, [("/control/angle_of_attack", json!(1)), ("/stop/time", json!(0.5))]);
    let map = geojson(&case).await;
    let expected = "ends at an angle of attack of 28.6479°: its 28.6479° values are used above it";
    let warnings = &map["features"][0]["properties"]["warnings"];
    assert!(warnings.to_string().contains(expected), "{warnings}");
}

#[tokio::test]
async fn a_line_over_the_antimeridian_is_cut_there() {
    let westwards =
        with_all(&across(), [("/initial_state/longitude", json!(-170)), ("/initial_state/heading", json!(160))]);
    for (case, edge) in [(across(), 180.0), (westwards, -180.0)] {
        let case = with(&case, "/epoch", json!("2026-11-22T12:00:00Z"));
        let rows = rows(&fly(&case).await);
        let track = geojson(&case).await["features"][0].clone();
        assert_eq!(track["geometry"]["type"], "MultiLineString");
        let parts: Vec<_> = track["geometry"]["coordinates"].as_array().unwrap().iter().map(positions).collect();
        let [first, second] = &parts[..] else { panic!("{} parts", parts.len()) };
        let ([before @ .., leaving], [entering, after @ ..]) = (&first[..], &second[..]) else { panic!("no part") };
        // All rows are there and, between them, the edge of the map on both sides.
        assert_eq!([before, after].concat(), rows);
        assert_eq!((leaving[0], entering[0]), (edge, -edge));
        assert_eq!(leaving[1..], entering[1..]);
        // It lies on the line between its neighbours.
        let (from, to) = (before.last().unwrap(), after[0]);
        let part = (edge - from[0]) / (to[0] + 2.0 * edge - from[0]);
        assert!(0.0 < part && part < 1.0);
        check::near("latitude", leaving[1], from[1] + part * (to[1] - from[1]), 1e-12);
        check::near("altitude", leaving[2], from[2] + part * (to[2] - from[2]), 1e-8);
        // The times have the shape of the coordinates.
        for (part, coordinates) in parts.iter().enumerate() {
            let times = numbers(&track["properties"]["times"][part]);
            assert_eq!(times.len(), coordinates.len());
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
            assert_eq!(track["properties"]["times_utc"][part].as_array().unwrap().len(), times.len());
        }
    }
}

/// The antimeridian has two longitudes: a row on it belongs to the side from which the track comes, or to which it goes.
#[tokio::test]
async fn a_flight_that_touches_the_antimeridian_is_no_line_around_the_world() {
    let along = [("/initial_state/longitude", json!(180)), ("/initial_state/geocentric_latitude", json!(0))];
    let still = json!({"model": "custom", "gravitational_parameter": 3.986e14, "equatorial_radius": 6.378e6,
        "polar_radius": 6.357e6, "rotation_rate": 0});
    for (heading, parts) in [(0, 1), (180, 1), (90, 1), (-90, 1)] {
        let case = with_all(&across(), along.clone());
        let case = with_all(&case, [("/initial_state/heading", json!(heading)), ("/planet", still.clone())]);
        let geometry = geojson(&case).await["features"][0]["geometry"].clone();
        assert_eq!(geometry["type"], if parts == 1 { "LineString" } else { "MultiLineString" }, "{heading}");
        let places = positions(&geometry["coordinates"]);
        assert!(places.windows(2).all(|pair| (pair[0][0] - pair[1][0]).abs() < 5.0), "{heading}");
    }
}

/// Degrees between two places, seen from the centre.
fn apart(one: [f64; 3], other: [f64; 3]) -> f64 {
    let vector = |[longitude, latitude, _]: [f64; 3]| {
        let ((sin, cos), (up, out)) = (longitude.to_radians().sin_cos(), latitude.to_radians().sin_cos());
        [out * cos, out * sin, up]
    };
    let (one, other) = (vector(one), vector(other));
    let chord: f64 = one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum();
    (2.0 * (0.5 * chord.sqrt()).asin()).to_degrees()
}

/// How far, at most, a line on the map is from the flight, in degrees.
async fn astray(case: &Value) -> f64 {
    let flown = rows(&fly(&with(case, "/output", json!({"interval": 5}))).await);
    let geometry = geojson(case).await["features"][0]["geometry"].clone();
    let parts = match geometry["type"].as_str().unwrap() {
        "LineString" => vec![positions(&geometry["coordinates"])],
        _ => geometry["coordinates"].as_array().unwrap().iter().map(positions).collect(),
    };
    let mut worst = 0.0_f64;
    for pair in parts.iter().flat_map(|part| part.windows(2)) {
        assert!(pair.iter().flatten().all(|number| number.is_finite()));
        for part in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let drawn = [0, 1, 2].map(|i| pair[0][i] + part * (pair[1][i] - pair[0][i]));
            let nearest = flown.iter().map(|place| apart(*place, drawn)).fold(f64::INFINITY, f64::min);
            worst = worst.max(nearest);
        }
    }
    worst
}

/// Rows are some 5° apart: drawn as they are, lines past a pole would be as far off.
#[tokio::test]
async fn a_flight_over_a_pole_stays_near_its_line() {
    let still = json!({"model": "custom", "gravitational_parameter": 3.986e14, "equatorial_radius": 6.378e6,
        "polar_radius": 6.357e6, "rotation_rate": 0});
    for (what, case) in [
        ("over turning poles", polar()),
        ("over standing poles", with(&polar(), "/planet", still)),
        ("past the poles", with(&polar(), "/initial_state/velocity", json!([0, 200, 7653]))),
        (
            "from a pole",
            with_all(
                &polar(),
                [("/initial_state/position", json!([0, 0, 6.8e6])), ("/initial_state/velocity", json!([7656, 0, 0]))],
            ),
        ),
    ] {
        let worst = astray(&case).await;
        assert!(worst < 1.0, "{what}: {worst} degrees astray");
    }
}

#[tokio::test]
async fn an_epoch_dates_every_vertex() {
    let epoch = "2026-11-22T12:00:00.25Z";
    let dated = with_all(&capsule(), [("/epoch", json!(epoch)), ("/output", json!({"interval": 60}))]);
    let plain = without(&dated, "/epoch");
    let utc = fly(&dated).await["trajectory"]["utc"].clone();

    let map = geojson(&dated).await;
    assert_eq!(map["features"][0]["properties"]["times_utc"], utc);
    let marks = &map["features"].as_array().unwrap()[1..];
    assert!(marks.iter().all(|mark| mark["properties"]["utc"].is_string()));
    assert!(!geojson(&plain).await.to_string().contains("utc"));

    let xml = drawn(&dated, "kml").await;
    assert_eq!(json!(elements(&xml, "when")), utc);
    assert_eq!(elements(&xml, "gx:Track").len(), 1);
    assert_eq!(elements(&xml, "gx:coord").len(), utc.as_array().unwrap().len());
    assert!(!xml.contains("<LineString>"));
    let xml = drawn(&plain, "kml").await;
    assert!(xml.contains("<LineString>") && !xml.contains("when") && !xml.contains("gx:Track"));
    // Of the line and of every point: without it, altitudes would be ignored.
    let geometries = elements(&xml, "coordinates").len();
    assert_eq!(elements(&xml, "altitudeMode"), vec!["absolute"; geometries]);

    for (case, start) in [(&dated, "2026-11-22T12:00:00.250000Z"), (&plain, "2000-01-01T12:00:00.000000Z")] {
        let packets = czml(case).await;
        assert_eq!(packets[0]["clock"]["currentTime"], start);
        assert_eq!(packets[1]["position"]["epoch"], start);
        assert!(packets[1]["availability"].as_str().unwrap().starts_with(&format!("{start}/")));
        assert_eq!(packets[1]["availability"], packets[0]["clock"]["interval"]);
    }
    let end = czml(&dated).await[1]["availability"].as_str().unwrap().split('/').nth(1).unwrap().to_owned();
    assert_eq!(Some(&json!(end)), utc.as_array().unwrap().last());
}

#[tokio::test]
async fn a_flight_after_the_year_9999_has_no_dates() {
    let case = with_all(&capsule(), [("/epoch", json!("9999-12-31T23:59:00Z")), ("/stop", json!({"time": 60}))]);
    for (format, _) in MAPS {
        let answer = Service::new().post(&format!("/simulate?format={format}"), &case).await;
        assert_eq!((answer.status.as_u16(), answer.pointers()), (422, vec!["/epoch".to_owned()]));
        drawn(&with(&case, "/stop", json!({"time": 59})), format).await;
    }
}

#[tokio::test]
async fn any_name_is_written() {
    let name = "a <b>&\"it's\" ]]> </name> ü \u{1}\u{ffff}\n";
    let case = with(&capsule(), "/name", json!(name));
    assert_eq!(geojson(&case).await["features"][0]["properties"]["name"], name);
    let packets = czml(&case).await;
    assert_eq!((&packets[0]["name"], &packets[1]["name"]), (&json!(name), &json!(name)));
    let xml = drawn(&case, "kml").await;
    // XML has no way to write the last two but one.
    let expected = "a &lt;b&gt;&amp;&quot;it&apos;s&quot; ]]&gt; &lt;/name&gt; ü \u{fffd}\u{fffd}\n";
    assert_eq!(elements(&xml, "name")[..2], [expected; 2]);
}

#[tokio::test]
async fn a_flight_that_ends_at_its_start_is_a_point() {
    for epoch in [None, Some("2026-11-22T12:00:00Z")] {
        let mut case =
            with_all(&capsule(), [("/initial_state/altitude", json!(0)), ("/initial_state/speed", json!(0))]);
        if let Some(epoch) = epoch {
            case["epoch"] = json!(epoch);
        }
        let map = geojson(&case).await;
        assert_eq!(map["features"][0]["geometry"], json!({"type": "MultiLineString", "coordinates": []}));
        assert_eq!(map["features"][0]["properties"]["times"], json!([]));
        assert_eq!(map["features"].as_array().unwrap().len(), 7);
        assert_eq!(numbers(&czml(&case).await[1]["position"]["cartographicDegrees"]).len(), 4);
        assert_eq!(elements(&drawn(&case, "kml").await, "Placemark").len(), 7);
    }
}

#[tokio::test]
async fn every_number_of_every_model_is_finite() {
    for (name, case) in models().into_iter().filter(|(name, _)| *name != "columns") {
        let case = with(&case, "/stop/time", json!(200));
        for text in [drawn(&case, "geojson").await, drawn(&case, "czml").await] {
            assert!(!text.contains("null"), "{name}");
        }
        let xml = drawn(&case, "kml").await;
        let places = elements(&xml, "gx:coord").into_iter().chain(elements(&xml, "coordinates"));
        let numbers: Vec<f64> =
            places.flat_map(|place| place.split([' ', ','])).map(|text| text.parse().unwrap()).collect();
        assert!(numbers.len() > 20 && numbers.iter().all(|number| number.is_finite()), "{name}");
    }
}

#[tokio::test]
async fn maps_are_chosen_by_name_or_media_type() {
    let service = Service::new();
    for (format, media_type) in MAPS {
        let by_name = service.post(&format!("/simulate?format={format}"), &capsule()).await;
        assert_eq!(by_name.headers["content-type"], media_type);
        let request = axum::http::Request::post("/simulate").header("content-type", "application/json");
        let request = request.header("accept", format!("text/html, {media_type};q=0.9"));
        let by_type = service.send(request.body(capsule().to_string().into()).unwrap()).await;
        assert_eq!(
            (by_type.status.as_u16(), &by_type.headers["content-type"]),
            (200, &by_name.headers["content-type"])
        );
        assert_eq!(by_type.body, by_name.body);
        for (path, body) in [
            ("/convert", json!({})),
            ("/analytic", with(&capsule(), "/solution", json!("steep_ballistic"))),
            ("/simulate/batch", json!([capsule()])),
        ] {
            let answer = service.post(&format!("{path}?format={format}"), &body).await;
            assert_eq!(answer.json()["type"], "/problems/not-acceptable", "{path} as {format}");
        }
    }
}

#[tokio::test]
async fn what_has_no_place_on_a_map_is_refused() {
    let service = Service::new();
    let asks = with_all(&capsule(), [("/sensitivities", json!(true)), ("/verify", json!(true))]);
    let without_rows = with(&asks, "/output", json!({"trajectory": false}));
    for (format, _) in MAPS {
        let path = format!("/simulate?format={format}");
        let answer = service.post(&path, &without_rows).await;
        let expected = ["/sensitivities", "/verify", "/output/trajectory"].map(str::to_owned).to_vec();
        assert_eq!((answer.status.as_u16(), answer.pointers()), (422, expected));
        // As with CSV, there is no place for an echo either, and nothing is lost.
        assert_eq!(drawn(&with(&capsule(), "/echo", json!(true)), format).await, drawn(&capsule(), format).await);
    }
}
