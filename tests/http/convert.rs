//! `POST /convert`: every representation sent back, the ranges of the answer, and what has no orbital elements.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use axum::http::StatusCode;
use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::refusal::good_answer;
use super::requests::{KINDS, with};

/// States of every sort, with their names.
fn states() -> Vec<(&'static str, Value)> {
    let orbit = |a: f64, e: f64, i: f64, raan: f64, argument: f64, anomaly: f64| {
        json!({"type": "orbital_elements", "semi_major_axis": a, "eccentricity": e, "inclination": i, "raan": raan,
            "argument_of_periapsis": argument, "true_anomaly": anomaly, "sidereal_time": 1234.5})
    };
    let parabola = json!({"type": "orbital_elements", "semi_latus_rectum": 1.3e7, "eccentricity": 1, "inclination": 1,
        "raan": 2, "argument_of_periapsis": 3, "true_anomaly": 1.5});
    let ecef = |position: [f64; 3], velocity: [f64; 3]| json!({"type": "ecef", "position": position, "velocity": velocity, "sidereal_time": -777.25});
    let eci = |position: [f64; 3], velocity: [f64; 3]| json!({"type": "eci", "position": position, "velocity": velocity, "sidereal_time": "00:03:20.6"});
    vec![
        ("elliptic", orbit(8e6, 0.2, 1.1, 2.1, 0.3, 3.5)),
        ("nearly parabolic ellipse", orbit(6e9, 0.999, 1.1, 2.1, 0.3, 0.5)),
        ("hyperbolic", orbit(-1_840_738.0, 1.889_431, 1.178_101, 4.213_107, 2.377_746, 4.552_029)),
        ("parabolic", parabola),
        ("circular", orbit(7e6, 0.0, 1.1, 2.1, 0.0, 3.5)),
        ("circular in the equator", orbit(7e6, 0.0, 0.0, 0.0, 0.0, 3.5)),
        ("elliptic in the equator", orbit(8e6, 0.2, 0.0, 0.0, 1.0, 3.5)),
        ("retrograde in the equator", orbit(8e6, 0.2, PI, 0.0, 1.0, 3.5)),
        ("retrograde circle in the equator", orbit(7e6, 0.0, PI, 0.0, 0.0, 1.0)),
        ("polar", orbit(8e6, 0.1, FRAC_PI_2, 1.0, 1.0, 1.0)),
        ("at the periapsis", orbit(8e6, 0.1, 1.0, 1.0, 1.0, 0.0)),
        ("at the apoapsis", orbit(8e6, 0.1, 1.0, 1.0, 1.0, PI)),
        ("negative angles", orbit(8e6, 0.1, 1.0, -1.0, -2.0, -3.0)),
        ("over the north pole", ecef([0.0, 0.0, 6.5e6], [3000.0, -4000.0, 100.0])),
        ("over the south pole", ecef([0.0, 0.0, -6.5e6], [-3000.0, 10.0, 100.0])),
        ("straight down on the pole", ecef([0.0, 0.0, 6.5e6], [0.0, 0.0, -100.0])),
        ("a hair from the pole", ecef([1e-3, 1e-3, 6.5e6], [3000.0, 4000.0, 0.0])),
        ("at rest", ecef([4e6, -3e6, 4.1e6], [0.0, 0.0, 0.0])),
        ("at rest in the south-west", ecef([-4e6, -3e6, -4.1e6], [0.0, 0.0, 0.0])),
        ("on the date line", ecef([-7e6, 0.0, 1e5], [10.0, -7e3, 0.0])),
        ("below the surface", ecef([3e6, 2e6, -1e6], [10.0, 20.0, 30.0])),
        ("near the centre", ecef([1e3, 2e3, -3e3], [1e3, 20.0, 30.0])),
        ("in the plane of the equator, below the surface", ecef([2e4, 0.0, 0.0], [0.0, 100.0, 50.0])),
        ("on the axis, below the surface", ecef([0.0, 0.0, 1e4], [0.0, 5000.0, 50.0])),
        ("far away", ecef([4e11, -3e11, 1e11], [100.0, 200.0, 300.0])),
        ("straight up", ecef([7e6, 0.0, 0.0], [1000.0, 0.0, 0.0])),
        ("due west", ecef([7e6, 0.0, 0.0], [0.0, -1000.0, 0.0])),
        ("due north", ecef([0.0, 7e6, 0.0], [0.0, 0.0, 1000.0])),
        ("due south", ecef([0.0, 7e6, 0.0], [0.0, 0.0, -1000.0])),
        (
            "IMPULSE",
            eci([1_044_303.785_49, -4_866_124.541_74, 4_845_298.637_61], [-1094.1974, -4187.85837, 2588.77299]),
        ),
        (
            "a release from the hand",
            json!({"type": "geodetic", "geodetic_altitude": 2, "longitude": 3.1,
            "geodetic_latitude": -0.6, "speed": 0, "flight_path_angle": 0.3, "azimuth": 1}),
        ),
        (
            "azimuth just left of north",
            json!({"type": "geodetic", "geodetic_altitude": 2e4, "longitude": -3.1,
            "geodetic_latitude": 0.6, "speed": 900, "flight_path_angle": 0.3, "azimuth": -1e-18}),
        ),
        (
            "entry interface",
            json!({"type": "inertial_flight_path", "altitude": 121_920, "longitude": -3.0, "geocentric_latitude": -0.06,
            "inertial_speed": 11_032, "inertial_flight_path_angle": -0.1131, "inertial_azimuth": 0.876, "sidereal_time": 55}),
        ),
        (
            "inertially due west on the date line",
            json!({"type": "inertial_flight_path", "radius": 6.5e6, "longitude": -PI, "geocentric_latitude": 0.2,
            "inertial_speed": 7e3, "inertial_flight_path_angle": 0, "inertial_heading": -PI}),
        ),
        (
            "inertially straight down",
            json!({"type": "inertial_flight_path", "radius": 6.5e6, "longitude": 6.2, "geocentric_latitude": 0.2,
            "inertial_speed": 7e3, "inertial_flight_path_angle": -FRAC_PI_2, "inertial_heading": 0.3}),
        ),
        (
            "inertially still",
            json!({"type": "inertial_flight_path", "altitude": 1e6, "longitude": 1, "geocentric_latitude": 0.2,
            "inertial_speed": 0, "inertial_flight_path_angle": 0.1, "inertial_azimuth": -6.2}),
        ),
        (
            "heading past a half turn",
            json!({"type": "planet_relative", "radius": 6.5e6, "longitude": 6.2,
            "geocentric_latitude": 0.6, "speed": 900, "flight_path_angle": -1.5, "heading": 3.5}),
        ),
    ]
}

/// How far two ecef states are apart, in parts of their radius and of their speed.
///
/// A speed far below the planet's own motion at that radius is a small difference of large numbers; it counts as a hundredth of it.
fn distance(a: &Value, b: &Value) -> f64 {
    let vector = |state: &Value, name: &str| [0, 1, 2].map(|i| state[name][i].as_f64().unwrap());
    let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let apart = |name: &str| {
        let (a, b) = (vector(a, name), vector(b, name));
        norm([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
    };
    let (radius, speed) = (norm(vector(a, "position")), norm(vector(a, "velocity")));
    let rotation = 7.3e-5 * radius;
    (apart("position") / radius).max(apart("velocity") / speed.max(1e-2 * rotation))
}

#[tokio::test]
async fn every_representation_can_be_sent_back() {
    let service = Service::new();
    let mut failures = Vec::new();
    for unit in ["rad", "deg"] {
        for (name, state) in states() {
            let mut state = state;
            if unit == "deg" {
                to_degrees(&mut state);
            }
            let planets = [json!({}), json!({"model": "earth_jameson_listing", "shape": "sphere"})];
            for planet in planets {
                let request = json!({"angle_unit": unit, "planet": planet, "state": state});
                let answer = good_answer(&service, "/convert", &request).await;
                for kind in KINDS {
                    // What does not move along an ellipse or a hyperbola has no elements; it has all else.
                    if kind == "orbital_elements" && answer[kind].is_null() {
                        continue;
                    }
                    assert_eq!(answer[kind]["type"], kind);
                    let back = service.post("/convert", &with(&request, "/state", answer[kind].clone())).await;
                    if back.status != StatusCode::OK {
                        failures.push(format!("{name} as {kind} in {unit} is refused: {}", back.json()));
                        continue;
                    }
                    let back = back.json();
                    let apart = distance(&back["ecef"], &answer["ecef"]);
                    if apart > 1e-9 {
                        failures.push(format!("{name} as {kind} in {unit} comes back {apart:e} off: {}", answer[kind]));
                    }
                    assert_eq!(back["ecef"]["sidereal_time"], answer["ecef"]["sidereal_time"], "{name} {kind}");
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} of them\n{}", failures.len(), failures.join("\n"));
}

fn to_degrees(state: &mut Value) {
    for name in [
        "longitude",
        "geocentric_latitude",
        "geodetic_latitude",
        "flight_path_angle",
        "heading",
        "azimuth",
        "inertial_flight_path_angle",
        "inertial_heading",
        "inertial_azimuth",
        "inclination",
        "raan",
        "argument_of_periapsis",
        "true_anomaly",
        "mean_anomaly",
    ] {
        if let Some(angle) = state.get_mut(name) {
            *angle = json!(angle.as_f64().unwrap().to_degrees());
        }
    }
}

#[tokio::test]
async fn answered_angles_lie_in_their_ranges() {
    let service = Service::new();
    let mut outside = Vec::new();
    for (unit, turn) in [("rad", TAU), ("deg", 360.0)] {
        for (name, mut state) in states() {
            if unit == "deg" {
                to_degrees(&mut state);
            }
            let answer = good_answer(&service, "/convert", &json!({"angle_unit": unit, "state": state})).await;
            let full_turn = [
                "/orbital_elements/raan",
                "/orbital_elements/argument_of_periapsis",
                "/orbital_elements/true_anomaly",
                "/derived/mean_anomaly",
                "/geodetic/azimuth",
            ];
            let half_turns = [
                "/planet_relative/longitude",
                "/planet_relative/heading",
                "/geodetic/longitude",
                "/inertial_flight_path/longitude",
                "/inertial_flight_path/inertial_heading",
            ];
            let quarter_turns = [
                "/planet_relative/geocentric_latitude",
                "/planet_relative/flight_path_angle",
                "/geodetic/geodetic_latitude",
                "/geodetic/flight_path_angle",
                "/inertial_flight_path/geocentric_latitude",
                "/inertial_flight_path/inertial_flight_path_angle",
            ];
            let is_sound = |pointer: &str, angle: f64| {
                if full_turn.contains(&pointer) {
                    (0.0..turn).contains(&angle)
                } else if half_turns.contains(&pointer) {
                    -turn / 2.0 < angle && angle <= turn / 2.0
                } else {
                    angle.abs() <= turn / 4.0
                }
            };
            for pointer in full_turn.into_iter().chain(half_turns).chain(quarter_turns) {
                // A state without orbital elements has none of their angles.
                if let Some(angle) = answer.pointer(pointer).and_then(Value::as_f64)
                    && !is_sound(pointer, angle)
                {
                    outside.push(format!("{angle} {unit} at {pointer} of {name}"));
                }
            }
        }
    }
    assert!(outside.is_empty(), "{}", outside.join("\n"));
}

#[tokio::test]
async fn a_state_at_rest_has_angles_of_zero() {
    let service = Service::new();
    for (name, state) in states().into_iter().filter(|(name, _)| name.contains("rest") || name.contains("release")) {
        let answer = good_answer(&service, "/convert", &json!({"state": state})).await;
        for pointer in [
            "/planet_relative/speed",
            "/planet_relative/flight_path_angle",
            "/planet_relative/heading",
            "/geodetic/speed",
            "/geodetic/flight_path_angle",
            "/geodetic/azimuth",
        ] {
            assert_eq!(answer.pointer(pointer), Some(&json!(0.0)), "{name} {pointer}");
        }
    }
}

#[tokio::test]
async fn the_inertial_flight_path_is_written_by_the_inertial_velocity() {
    let service = Service::new();
    for (name, state) in states() {
        let answer = good_answer(&service, "/convert", &json!({"state": state})).await;
        let path = &answer["inertial_flight_path"];
        let names: Vec<_> = path.as_object().unwrap().keys().map(String::as_str).collect();
        let all = [
            "type",
            "radius",
            "longitude",
            "geocentric_latitude",
            "inertial_speed",
            "inertial_flight_path_angle",
            "inertial_heading",
            "sidereal_time",
        ];
        assert_eq!(names, all, "{name}");
        for shared in ["radius", "longitude", "geocentric_latitude"] {
            assert_eq!(path[shared], answer["planet_relative"][shared], "{name} {shared}");
        }
        // The same length and the same climb as the vectors, to the roundings of the turn between the frames and of a dot product.
        let vector = |name: &str| [0, 1, 2].map(|i| answer["eci"][name][i].as_f64().unwrap());
        let (position, velocity) = (vector("position"), vector("velocity"));
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let field = |name: &str| path[name].as_f64().unwrap();
        let [speed, radius] = [dot(velocity, velocity).sqrt(), dot(position, position).sqrt()];
        let tolerance = 1e-14 * (speed + 7.3e-5 * radius);
        check::near(name, field("inertial_speed"), speed, tolerance);
        let climb = field("inertial_speed") * field("inertial_flight_path_angle").sin();
        check::near(name, climb, dot(position, velocity) / radius, tolerance);
    }
}

#[tokio::test]
async fn azimuth_and_heading_of_an_inertial_flight_path_add_up_to_a_quarter_turn() {
    let service = Service::new();
    for (unit, quarter) in [("rad", FRAC_PI_2), ("deg", 90.0)] {
        for turns in [-4.0, -1.7, -1.0, -0.2, 0.0, 0.5, 1.0, 2.0, 3.3, 4.0] {
            let (azimuth, heading) = (turns * quarter, (1.0 - turns) * quarter);
            let path = |name: &str, angle: f64| {
                json!({"angle_unit": unit, "state": {"type": "inertial_flight_path", "radius": 6.5e6, "longitude": 1,
                    "geocentric_latitude": 0.5, "inertial_speed": 7e3, "inertial_flight_path_angle": -0.1, name: angle}})
            };
            let by_azimuth = good_answer(&service, "/convert", &path("inertial_azimuth", azimuth)).await;
            let heading = if heading > 4.0 * quarter { heading - 4.0 * quarter } else { heading };
            let by_heading = good_answer(&service, "/convert", &path("inertial_heading", heading)).await;
            // Some roundings of angles up to a turn.
            assert!(distance(&by_azimuth["ecef"], &by_heading["ecef"]) < 1e-14, "{turns} quarter turns in {unit}");
        }
    }
}

/// The codes of the warnings.
pub(crate) fn codes(answer: &Value) -> Vec<&str> {
    answer["warnings"].as_array().unwrap().iter().map(|warning| warning["code"].as_str().unwrap()).collect()
}

#[tokio::test]
async fn rectilinear_motion_has_no_orbital_elements() {
    let service = Service::new();
    for (position, velocity) in [
        ([7e6, 0.0, 0.0], [1000.0, 0.0, 0.0]),
        ([0.0, 0.0, 7e6], [0.0, 0.0, -1000.0]),
        ([4e6, 3e6, 1e6], [-400.0, -300.0, -100.0]),
        ([7e6, 0.0, 0.0], [0.0, 0.0, 0.0]),
    ] {
        let answer = good_answer(
            &service,
            "/convert",
            &json!({"state": {"type": "eci", "position": position, "velocity": velocity}}),
        )
        .await;
        assert_eq!(answer["orbital_elements"], json!(null));
        assert_eq!(codes(&answer), ["rectilinear_motion"]);
        for name in ["semi_latus_rectum", "periapsis_radius", "apoapsis_radius", "period"] {
            assert_eq!(answer["derived"][name], json!(null), "{name}");
        }
        assert!(answer["derived"]["specific_energy"].is_f64());
    }
}

#[tokio::test]
async fn conventional_elements_are_warned_of() {
    let service = Service::new();
    for (name, state) in states().into_iter().filter(|(_, state)| state["type"] == "orbital_elements") {
        let answer = good_answer(&service, "/convert", &json!({"state": state})).await;
        let elements = &answer["orbital_elements"];
        assert_eq!(codes(&answer).contains(&"circular_orbit"), name.contains("circ"), "{name}");
        assert_eq!(codes(&answer).contains(&"equatorial_orbit"), name.contains("equator"), "{name}");
        if name.contains("circ") {
            assert_eq!(elements["argument_of_periapsis"], json!(0.0), "{name}");
        }
        if name.contains("equator") {
            assert_eq!(elements["raan"], json!(0.0), "{name}");
        }
    }
}

#[tokio::test]
async fn an_unbound_orbit_has_neither_apoapsis_nor_period() {
    let service = Service::new();
    for (name, state) in states().into_iter().filter(|(_, state)| state["type"] == "orbital_elements") {
        let answer = good_answer(&service, "/convert", &json!({"state": state})).await;
        let (elements, derived) = (&answer["orbital_elements"], &answer["derived"]);
        let unbound = name == "hyperbolic" || name == "parabolic";
        assert_eq!(derived["apoapsis_radius"].is_null(), unbound, "{name}");
        assert_eq!(derived["period"].is_null(), unbound, "{name}");
        assert_eq!(elements.get("semi_latus_rectum").is_some(), name == "parabolic", "{name}");
        assert_eq!(elements.get("semi_major_axis").is_some(), name != "parabolic", "{name}");

        let field = |object: &Value, name: &str| object[name].as_f64().unwrap();
        let (p, e) = (field(derived, "semi_latus_rectum"), field(elements, "eccentricity"));
        check::relative(name, field(derived, "periapsis_radius"), p / (1.0 + e), 1e-12);
        if !unbound {
            let a = field(elements, "semi_major_axis");
            check::relative(name, field(derived, "apoapsis_radius"), a * (1.0 + e), 1e-9);
            check::relative(name, field(derived, "period"), TAU * (a.powi(3) / 3.986_004_418e14).sqrt(), 1e-9);
            check::relative(name, field(derived, "specific_energy"), -3.986_004_418e14 / (2.0 * a), 1e-9);
        }
    }
}
