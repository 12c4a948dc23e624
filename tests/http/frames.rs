//! The inertial frames of the Earth, the angle to them, and what stands in place of other fields of a state.

use std::f64::consts::{FRAC_PI_2, PI};

use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::convert::codes;
use super::refusal::{Steady, good_answer};
use super::requests::{KINDS, capsule, conversion, flight, state, with, with_all, without};

fn vector(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|i| value[i].as_f64().unwrap())
}

fn apart(a: &Value, b: &Value) -> f64 {
    vector(a).iter().zip(vector(b)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// A conversion on the Earth at an epoch, of a state without a sidereal time.
fn dated(kind: &str, frame: &str) -> Value {
    let request = without(&with(&conversion(kind), "/planet", json!({})), "/state/sidereal_time");
    with(&request, "/state/frame", frame)
}

/// At rest in TEME over the Arctic, as asked of `SatelliteToolbox` (Julia), whose answer this is.
#[tokio::test]
async fn vectors_of_sgp4_are_where_another_tool_has_them() {
    let request = json!({
        "epoch": "2024-09-07T12:00:00Z",
        "state": {"type": "eci", "frame": "teme", "position": [444_370, -1_395_020, 6_725_180], "velocity": [0, 0, 0]},
    });
    let answer = good_answer(&Service::new(), "/convert", &request).await;
    // The tool took polar motion and UT1-UTC of the day, which are neglected here: 17 m along x, y and z as a polar motion of 0.3" and a
    // turn of the Earth by 0.05 s make them. In the frame of date the place is 8 km off.
    let off = apart(&answer["ecef"]["position"], &json!([-745_520, 1_260_039, 6_725_183]));
    assert!(off < 20.0, "{off} m: {}", answer["ecef"]);
    assert!(apart(&answer["ecef"]["velocity"], &json!([91.88, 54.36, 0])) < 0.01, "{}", answer["ecef"]);
    // In the frame of date, as the API takes it by default, they lie 0.33 degrees further east: the right ascension of its origin.
    let of_date = good_answer(&Service::new(), "/convert", &with(&request, "/state/frame", "date")).await;
    let off = apart(&of_date["ecef"]["position"], &answer["ecef"]["position"]);
    check::relative("frame of date", off, 1_464_086.0 * 0.316_f64.to_radians(), 0.01);
}

#[tokio::test]
async fn a_conversion_answers_in_the_frame_that_it_got() {
    let service = Service::new();
    for kind in ["eci", "orbital_elements"] {
        for frame in ["date", "teme", "gcrf"] {
            let request = dated(kind, frame);
            let answer = good_answer(&service, "/convert", &request).await;
            for inertial in ["eci", "orbital_elements"] {
                assert_eq!(answer[inertial]["frame"], frame, "{kind}");
                assert_eq!(answer[inertial].get("sidereal_time").is_some(), frame == "date", "{kind} in {frame}");
                let back = good_answer(&service, "/convert", &with(&request, "/state", answer[inertial].clone())).await;
                let off = apart(&back["ecef"]["position"], &answer["ecef"]["position"]);
                assert!(off < 1e-6, "{inertial} in {frame}: {off} m");
            }
            // What was sent comes back, and planet-fixed states have the sidereal time of the date.
            if kind == "eci" {
                assert!(apart(&answer["eci"]["position"], &request["state"]["position"]) < 1e-6, "{frame}");
                assert!(apart(&answer["eci"]["velocity"], &request["state"]["velocity"]) < 1e-9, "{frame}");
            }
            let of_date = good_answer(&service, "/convert", &dated("eci", "date")).await;
            assert_eq!(answer["ecef"]["sidereal_time"], of_date["ecef"]["sidereal_time"]);
            let code = if frame == "date" { "inertial_frame_of_date" } else { "earth_orientation_neglected" };
            assert!(codes(&answer).contains(&code), "{kind} in {frame}: {}", answer["warnings"]);
        }
    }
}

/// The pole of the Earth of 2026 lies 0.148 degrees from that of J2000, and its origin 0.34 degrees from the mean equinox.
#[tokio::test]
async fn the_frames_lie_beside_each_other_as_precession_has_moved_them() {
    let service = Service::new();
    let mut places = Vec::new();
    for frame in ["date", "teme", "gcrf"] {
        let request = with(&dated("eci", frame), "/state/position", json!([6_378_137, 0, 0]));
        let answer = good_answer(&service, "/convert", &request).await;
        places.push(answer["ecef"]["position"].clone());
    }
    // 26.9 years of 46.12" in right ascension, and of 20.04" towards the pole (IAU 2006), to the nutation of some 15".
    let nutation = 15.0 / 3600.0;
    let degrees = |metres: f64| (metres / 6_378_137.0).to_degrees();
    check::near("origin", degrees(apart(&places[0], &places[1])), 26.9 * 46.12 / 3600.0, nutation);
    check::near("pole", degrees(apart(&places[0], &places[2])), 26.9 * 20.04 / 3600.0, nutation);
}

#[tokio::test]
async fn a_flight_starts_where_the_conversion_has_it() {
    let service = Service::new();
    for kind in ["eci", "orbital_elements"] {
        for frame in ["teme", "gcrf"] {
            let conversion = dated(kind, frame);
            let answer = good_answer(&service, "/convert", &conversion).await;
            let case =
                with_all(&flight(kind), [("/planet", json!({})), ("/initial_state", conversion["state"].clone())]);
            let case = with(&case, "/echo", true);
            let flown = good_answer(&service, "/simulate", &case).await;
            for name in ["longitude", "geocentric_latitude", "speed", "flight_path_angle", "heading"] {
                assert_eq!(flown["initial_state"][name], answer["planet_relative"][name], "{kind} in {frame}: {name}");
            }
            assert!(codes(&flown).contains(&"earth_orientation_neglected"), "{}", flown["warnings"]);
            let again = good_answer(&service, "/simulate", &flown["case"]).await;
            assert_eq!(again["final_state"], flown["final_state"]);
        }
    }
}

#[tokio::test]
async fn the_frames_of_the_earth_need_a_date_on_the_earth() {
    let steady = Steady::new().await;
    for kind in ["eci", "orbital_elements"] {
        for frame in ["teme", "gcrf"] {
            let good = dated(kind, frame);
            let at = "/state/frame";
            let case = |conversion: &Value| {
                let case = with_all(&capsule(), [("/initial_state", conversion["state"].clone())]);
                ["epoch", "planet"].iter().fold(case, |case, name| match conversion.get(name) {
                    Some(value) => with(&case, &format!("/{name}"), value.clone()),
                    None => case,
                })
            };
            let mut bad = vec![
                (without(&good, "/epoch"), at, "requires an epoch"),
                (with(&good, "/planet", conversion("eci")["planet"].clone()), at, "is a frame of the Earth"),
            ];
            for epoch in ["1899-12-31T23:59:59Z", "1900-01-01T00:59:59+01:00", "2101-01-01T00:00:00Z"] {
                bad.push((with(&good, "/epoch", epoch), at, "requires an epoch from 1900 to 2100, got the year "));
            }
            for (name, value) in [("sidereal_time", json!(0)), ("sidereal_angle", json!(0))] {
                let request = with(&good, &format!("/state/{name}"), value);
                bad.push((
                    request,
                    if name == "sidereal_time" { "/state/sidereal_time" } else { "/state/sidereal_angle" },
                    "must be omitted",
                ));
            }
            for (request, pointer, phrase) in bad {
                steady.refused_at("/convert", &request, &[(pointer, phrase)]).await;
                let pointer = pointer.replace("/state", "/initial_state");
                steady.refused_at("/simulate", &case(&request), &[(&pointer, phrase)]).await;
            }
            for epoch in ["1900-01-01T00:00:00Z", "2100-12-31T23:59:59Z", "2101-01-01T00:59:59+01:00"] {
                good_answer(&steady.service, "/convert", &with(&good, "/epoch", epoch)).await;
            }
        }
    }
    // Planet-fixed states have no inertial frame.
    for kind in KINDS.into_iter().filter(|kind| !["eci", "orbital_elements"].contains(kind)) {
        steady.refused_at("/convert", &dated(kind, "teme"), &[("/state/frame", "is not a field here")]).await;
    }
}

#[tokio::test]
async fn a_sidereal_angle_is_the_time_by_the_rate_of_rotation() {
    let service = Service::new();
    for kind in KINDS {
        for (unit, scale) in [("rad", 1.0), ("deg", 180.0 / PI)] {
            let base = without(&with(&json!({"planet": {}}), "/state", state(kind)), "/state/sidereal_time");
            let base = with(&base, "/angle_unit", "rad");
            let by_time = good_answer(&service, "/convert", &with(&base, "/state/sidereal_time", 10_000)).await;
            // The same state with its angles in this unit, by way of its vectors where it has angles.
            let vectors = if kind == "eci" { "eci" } else { "ecef" };
            let mut given = by_time[vectors].clone();
            given.as_object_mut().unwrap().remove("sidereal_time");
            given["sidereal_angle"] = json!(10_000.0 * 7.292_115e-5 * scale);
            let request = json!({"angle_unit": unit, "planet": {}, "state": given});
            let by_angle = good_answer(&service, "/convert", &request).await;
            for inertial in ["position", "velocity"] {
                let off = apart(&by_angle["eci"][inertial], &by_time["eci"][inertial]);
                assert!(off < 1e-8, "{kind} in {unit}: {inertial} {off}");
            }
            // The answers give what was given.
            for answered in KINDS {
                assert_eq!(by_angle[answered]["sidereal_angle"], given["sidereal_angle"], "{answered}");
                assert_eq!(by_angle[answered].get("sidereal_time"), None, "{answered}");
                let back =
                    good_answer(&service, "/convert", &with(&request, "/state", by_angle[answered].clone())).await;
                let off = apart(&back["eci"]["position"], &by_angle["eci"]["position"]);
                assert!(off < 1e-4, "{kind} as {answered}: {off}");
            }
        }
    }
    // It turns what does not rotate, too.
    let still = json!({"model": "custom", "gravitational_parameter": 4e14, "equatorial_radius": 6.4e6, "polar_radius": 6.4e6,
        "rotation_rate": 0});
    let request = json!({"planet": still, "state": {"type": "eci", "position": [7e6, 0, 0], "velocity": [0, 7e3, 0],
        "sidereal_angle": FRAC_PI_2}});
    let answer = good_answer(&service, "/convert", &request).await;
    assert!(apart(&answer["ecef"]["position"], &json!([0, -7e6, 0])) < 1e-8, "{}", answer["ecef"]);
}

#[tokio::test]
async fn time_and_angle_are_not_both_given() {
    let steady = Steady::new().await;
    for kind in KINDS {
        for (path, at, request) in [
            ("/convert", "/state", conversion(kind)),
            ("/simulate", "/initial_state", flight(kind)),
            ("/analytic", "/initial_state", with(&flight(kind), "/solution", "loh")),
        ] {
            let both = with(&request, &format!("{at}/sidereal_angle"), 0);
            steady.refused_at(path, &both, &[(at, "must have at most one of sidereal_time, sidereal_angle")]).await;
        }
    }
}

#[tokio::test]
async fn sidereal_times_of_more_than_thirty_years_are_refused() {
    let steady = Steady::new().await;
    let at = |value: Value| with(&conversion("eci"), "/state/sidereal_time", value);
    for value in [json!(1e9), json!(-1e9), json!("277777:46:40"), json!("00:00:00.000000000000000000000000001")] {
        good_answer(&steady.service, "/convert", &at(value)).await;
    }
    let long = format!("{}:00:00", "9".repeat(400));
    for value in [json!(1e9_f64.next_up()), json!(-1.1e9), json!(1e300), json!("277777:46:40.1"), json!(long)] {
        steady.refused_at("/convert", &at(value), &[("/state/sidereal_time", "must be ")]).await;
    }
}

#[tokio::test]
async fn a_mean_anomaly_stands_in_place_of_the_true_one() {
    let service = Service::new();
    for (unit, turn) in [("rad", 2.0 * PI), ("deg", 360.0)] {
        for eccentricity in [0.0, 0.01, 0.5, 0.9, 0.999] {
            for part in [-0.9, -0.3, 0.0, 0.001, 0.25, 0.5, 0.75, 0.999] {
                let orbit = json!({"type": "orbital_elements", "semi_latus_rectum": 8e6, "eccentricity": eccentricity,
                    "inclination": 0.5, "raan": 1, "argument_of_periapsis": 2, "mean_anomaly": part * turn});
                let request = json!({"angle_unit": unit, "state": orbit});
                let answer = good_answer(&service, "/convert", &request).await;
                let mean = answer["derived"]["mean_anomaly"].as_f64().unwrap() / turn;
                // A circle has no periapsis, and one that is nearly a parabola loses digits of the state.
                if eccentricity > 0.0 {
                    check::angle("mean anomaly", mean * 2.0 * PI, part * 2.0 * PI, 1e-9);
                }
                assert!(answer["orbital_elements"]["true_anomaly"].is_f64());
                assert_eq!(answer["orbital_elements"].get("mean_anomaly"), None);
            }
        }
    }
    // A quarter of the period after the periapsis.
    let orbit = |name: &str, anomaly: f64| {
        json!({"planet": {"shape": "sphere"}, "state": {"type": "orbital_elements", "semi_major_axis": 1.2e7,
        "eccentricity": 0.3, "inclination": 0.5, "raan": 1, "argument_of_periapsis": 2, (name): anomaly}})
    };
    let quarter = good_answer(&service, "/convert", &orbit("mean_anomaly", FRAC_PI_2)).await;
    let period = quarter["derived"]["period"].as_f64().unwrap();
    let mut case = with_all(
        &capsule(),
        [
            ("/initial_state", orbit("true_anomaly", 0.0)["state"].clone()),
            ("/planet", json!({"shape": "sphere"})),
            ("/atmosphere", json!({"type": "vacuum"})),
            ("/stop", json!({"time": period / 4.0})),
        ],
    );
    case["solver"] = json!({"relative_tolerance": 1e-12});
    let flown = good_answer(&service, "/simulate", &case).await;
    let radius = flown["final_state"]["radius"].as_f64().unwrap();
    // A tolerance of 1e-12 of the radius in each of some hundred steps.
    check::near("radius", radius, quarter["planet_relative"]["radius"].as_f64().unwrap(), 1e-3);
}

#[tokio::test]
async fn an_unbound_orbit_has_no_mean_anomaly() {
    let steady = Steady::new().await;
    for eccentricity in [1.0, 1.5] {
        let orbit = json!({"type": "orbital_elements", "semi_latus_rectum": 1.3e7, "eccentricity": eccentricity,
            "inclination": 1, "raan": 2, "argument_of_periapsis": 3, "true_anomaly": 0.5});
        let request = json!({"state": orbit});
        let answer = good_answer(&steady.service, "/convert", &request).await;
        assert_eq!(answer["derived"]["mean_anomaly"], json!(null));
        let by_mean = with(&without(&request, "/state/true_anomaly"), "/state/mean_anomaly", 0.5);
        let phrase = format!("requires an eccentricity below 1, got {eccentricity}");
        steady.refused_at("/convert", &by_mean, &[("/state/mean_anomaly", &phrase)]).await;
    }
}

#[tokio::test]
async fn azimuth_and_heading_add_up_to_a_quarter_turn() {
    let service = Service::new();
    for (unit, quarter) in [("rad", FRAC_PI_2), ("deg", 90.0)] {
        for turns in [-3.0, -1.7, -1.0, -0.2, 0.0, 0.5, 1.0, 2.0, 3.3, 4.0] {
            let path = |name: &str, angle: f64| {
                json!({"angle_unit": unit, "state": {"type": "planet_relative", "radius": 6.5e6, "longitude": 1,
                    "geocentric_latitude": 0.5, "speed": 7e3, "flight_path_angle": -0.1, (name): angle}})
            };
            let by_azimuth = good_answer(&service, "/convert", &path("azimuth", turns * quarter)).await;
            let by_heading = good_answer(&service, "/convert", &path("heading", (1.0 - turns) * quarter)).await;
            // Some roundings of angles up to a turn.
            let off = apart(&by_azimuth["ecef"]["velocity"], &by_heading["ecef"]["velocity"]);
            assert!(off < 7e3 * 1e-14, "{turns} quarter turns in {unit}: {off}");
        }
    }
    // Clockwise from north: east is a quarter turn, as in the geodetic state of the answer on a sphere.
    let east = json!({"planet": {"shape": "sphere"}, "angle_unit": "deg", "state": {"type": "planet_relative", "altitude": 1e5, "longitude": 0,
        "geocentric_latitude": 0, "speed": 7e3, "flight_path_angle": 0, "azimuth": 30}});
    let answer = good_answer(&service, "/convert", &east).await;
    check::near("azimuth", answer["geodetic"]["azimuth"].as_f64().unwrap(), 30.0, 1e-12);
}
