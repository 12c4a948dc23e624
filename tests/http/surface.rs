//! How flights of `/simulate` begin and end, their peaks and their warnings.

use std::f64::consts::FRAC_PI_2;

use reentry_tests::fuzzed::is_of_default;
use serde_json::{Value, json};

use crate::check;

use super::requests::{capsule, with, with_all};
use super::simulate::fly;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

/// The capsule at this height over the stop altitude, with a speed and a flight-path angle.
fn near_stop(height: f64, speed: f64, flight_path_angle: f64) -> Value {
    with_all(
        &capsule(),
        [
            ("/planet", json!({"shape": "sphere"})),
            ("/stop", json!({"altitude": 500, "time": 100})),
            ("/initial_state/altitude", json!(500.0 + height)),
            ("/initial_state/speed", json!(speed)),
            ("/initial_state/flight_path_angle", json!(flight_path_angle)),
        ],
    )
}

/// Within 1 mm of the stop altitude, rounding in mind.
const ON_STOP: [f64; 3] = [-0.000_99, 0.0, 0.000_99];

#[tokio::test]
async fn a_flight_that_sinks_or_rests_on_the_stop_altitude_ends_at_once() {
    for height in ON_STOP {
        for (speed, angle) in [(100.0, -0.1), (100.0, -FRAC_PI_2), (0.0, 0.0), (0.0, 0.5), (100.0, 0.0)] {
            let answer = fly(&near_stop(height, speed, angle)).await;
            let what = format!("{height} m above, {speed} m/s at {angle}");
            assert_eq!(answer["termination"], "stop_altitude", "{what}");
            assert_eq!(answer["trajectory"]["time"], json!([0.0]), "{what}");
            assert_eq!(answer["initial_state"], answer["final_state"], "{what}");
            for peak in answer["peaks"].as_object().unwrap().values() {
                assert_eq!(peak["time"], json!(0.0), "{what}");
            }
        }
    }
}

#[tokio::test]
async fn a_flight_that_rises_from_the_stop_altitude_flies() {
    for height in ON_STOP {
        for (speed, angle, tolerance) in [
            (100.0, 0.1, 1e-6),
            (100.0, FRAC_PI_2, 1e-6),
            // So slow, it rises by 5 µm only, and may end wherever counts as on the stop altitude.
            (1.0, 0.01, 1e-3),
        ] {
            let answer = fly(&near_stop(height, speed, angle)).await;
            let what = format!("{height} m above, {speed} m/s at {angle}");
            assert_eq!(answer["termination"], "stop_altitude", "{what}");
            assert!(number(&answer["final_state"]["time"]) > 0.0, "{what}");
            check::near(&what, number(&answer["final_state"]["altitude"]), 500.0, tolerance);
            let risen = number(&answer["peaks"]["altitude"]["value"]) - number(&answer["initial_state"]["altitude"]);
            assert!(risen > 4e-6, "{what}");
        }
    }
}

#[tokio::test]
async fn a_level_flight_faster_than_a_satellite_rises_from_the_stop_altitude() {
    // 9 km/s without air: the planet's surface falls away below.
    let case = with(&near_stop(0.0, 9000.0, 0.0), "/vehicle/aerodynamics/drag_coefficient", 0);
    let answer = fly(&case).await;
    assert_eq!(answer["termination"], "time_limit");
    assert!(number(&answer["final_state"]["altitude"]) > 500.0);
}

#[tokio::test]
async fn beyond_a_millimetre_above_a_flight_at_rest_falls() {
    let answer = fly(&near_stop(0.001_1, 0.0, 0.0)).await;
    assert_eq!(answer["termination"], "stop_altitude");
    // h = g t²/2 with g ≈ 9.78 m/s² at the equator's latitude of 10 degrees, centrifugal relief included.
    check::relative("fall", number(&answer["final_state"]["time"]), (2.0 * 0.001_1_f64 / 9.77).sqrt(), 0.01);
}

#[tokio::test]
async fn an_orbit_without_air_ends_with_its_time() {
    let orbit = json!({"type": "orbital_elements", "semi_major_axis": 7e6, "eccentricity": 0.01, "inclination": 1,
        "raan": 0, "argument_of_periapsis": 0, "true_anomaly": 0});
    let case = with_all(
        &capsule(),
        [("/initial_state", orbit), ("/atmosphere", json!({"type": "exponential", "surface_density": 0}))],
    );
    let answer = fly(&case).await;
    assert_eq!(answer["termination"], "time_limit");
    assert_eq!(answer["final_state"]["time"], json!(10000.0));
    for name in ["density", "dynamic_pressure", "load_factor"] {
        assert!(answer["trajectory"][name].as_array().unwrap().iter().all(|value| number(value) == 0.0), "{name}");
    }
}

#[tokio::test]
async fn a_negative_stop_altitude_is_reached() {
    for stop in [-100.0, -20_000.0] {
        let answer = fly(&with(&capsule(), "/stop", json!({"altitude": stop}))).await;
        assert_eq!(answer["termination"], "stop_altitude");
        check::near("altitude of the end", number(&answer["final_state"]["altitude"]), stop, 1e-6);
        assert!(number(&answer["final_state"]["density"]) > 1.54793);
    }
}

#[tokio::test]
async fn the_altitude_that_ends_a_flight_is_the_radial_one() {
    let answer = fly(&with(&capsule(), "/stop", json!({"altitude": 10_000}))).await;
    check::near("altitude", number(&answer["final_state"]["altitude"]), 10_000.0, 1e-6);
    let geodetic = number(&answer["final_state"]["geodetic_altitude"]);
    assert!((geodetic - 10_000.0).abs() > 1e-4, "{geodetic}");
}

#[tokio::test]
async fn a_state_at_rest_has_angles_of_zero_and_decelerates_by_minus_its_acceleration() {
    let at_rest = with_all(
        &capsule(),
        [
            ("/planet", json!({"shape": "sphere"})),
            ("/initial_state/speed", json!(0)),
            ("/initial_state/geocentric_latitude", json!(0)),
            ("/initial_state/flight_path_angle", json!(-0.5)),
            ("/initial_state/heading", json!(2)),
            ("/stop", json!({"time": 1})),
        ],
    );
    let initial = &fly(&at_rest).await["initial_state"];
    assert_eq!(initial["flight_path_angle"], json!(0.0));
    assert_eq!(initial["heading"], json!(0.0));
    assert_eq!(initial["speed"], json!(0.0));
    assert_eq!(initial["load_factor"], json!(0.0));
    // GM/r² - ω²r at 120 km over the equator, with the constants of WGS 84 (NIMA TR8350.2, tables 3.1 and 3.3).
    let radius = 6_378_137.0 + 120_000.0;
    let acceleration = 3.986_004_418e14 / (radius * radius) - 7.292_115e-5_f64.powi(2) * radius;
    check::relative("deceleration", number(&initial["deceleration"]), -acceleration, 1e-12);
}

#[tokio::test]
async fn peaks_are_at_least_every_row() {
    let lifting = with(&capsule(), "/vehicle/aerodynamics/lift_coefficient", 0.4);
    let skipping = with(&lifting, "/initial_state/speed", 9000);
    for case in [capsule(), lifting, skipping] {
        let answer = fly(&with_all(&case, [("/output", json!({"count": 20_000}))])).await;
        let (trajectory, times) = (&answer["trajectory"], answer["trajectory"]["time"].as_array().unwrap());
        for (name, peak) in answer["peaks"].as_object().unwrap() {
            let (value, time) = (number(&peak["value"]), number(&peak["time"]));
            let column = trajectory[name].as_array().unwrap();
            let greatest = column.iter().map(number).fold(f64::NEG_INFINITY, f64::max);
            // Rows are evaluated at instants of their own: the same top, but for roundings.
            assert!(value >= greatest - 1e-12 * greatest.abs(), "{name}: {value} and {greatest}");
            // Between rows the curve is nearly flat at its top.
            check::relative(name, value, greatest, 1e-4);
            let earlier = times.iter().zip(column).filter(|(at, _)| number(at) < time);
            assert!(earlier.into_iter().all(|(_, row)| number(row) <= value * (1.0 + 1e-12)), "{name}");
        }
    }
}

#[tokio::test]
async fn a_peak_that_is_reached_twice_is_the_earliest() {
    // Without air the loads are zero throughout.
    let case = with(&capsule(), "/atmosphere", json!({"type": "exponential", "surface_density": 0}));
    let answer = fly(&case).await;
    for name in ["load_factor", "dynamic_pressure"] {
        assert_eq!(answer["peaks"][name]["value"], json!(0.0));
        assert_eq!(answer["peaks"][name]["time"], json!(0.0));
        assert_eq!(answer["peaks"][name]["altitude"], answer["initial_state"]["altitude"]);
    }
}

#[tokio::test]
async fn peaks_at_the_ends_belong_to_the_flight() {
    let answer = fly(&capsule()).await;
    assert_eq!(answer["peaks"]["altitude"]["time"], json!(0.0));
    assert_eq!(answer["peaks"]["altitude"]["value"], answer["initial_state"]["altitude"]);
    // Stopped while the load still grows, the peak is the last instant.
    let answer = fly(&with(&capsule(), "/stop", json!({"altitude": 70_000}))).await;
    assert_eq!(answer["peaks"]["dynamic_pressure"]["time"], answer["final_state"]["time"]);
    assert_eq!(answer["peaks"]["dynamic_pressure"]["value"], answer["final_state"]["dynamic_pressure"]);
}

fn warnings(answer: &Value) -> Vec<Value> {
    let warnings = answer["warnings"].as_array().unwrap().iter();
    warnings.filter(|warning| !is_of_default(warning)).cloned().collect()
}

#[tokio::test]
async fn lift_that_fades_near_the_vertical_is_warned_of() {
    let lifting = with(&capsule(), "/vehicle/aerodynamics/lift_coefficient", -0.4);
    let vertical = with(&lifting, "/initial_state/flight_path_angle", -FRAC_PI_2);
    let answer = fly(&vertical).await;
    assert_eq!(warnings(&answer)[0]["code"], "lift_faded_near_vertical");
    assert_eq!(warnings(&answer)[0]["time"], json!(0.0));

    // Lift that turns it down takes the vehicle to the vertical in time.
    let steep = with(&lifting, "/initial_state/flight_path_angle", -1.4);
    let answer = fly(&steep).await;
    let [warning] = &warnings(&answer)[..] else { panic!("{:?}", warnings(&answer)) };
    assert_eq!(warning["code"], "lift_faded_near_vertical");
    let time = number(&warning["time"]);
    let row = fly(&with(&steep, "/output", json!({"times": [time]}))).await;
    let angle = number(&row["trajectory"]["flight_path_angle"][1]);
    // Lift fades within 0.001 rad of the vertical, as the warning says.
    check::near("edge of the cone", FRAC_PI_2 - angle.abs(), 1e-3, 1e-8);
}

#[tokio::test]
async fn without_lift_or_away_from_the_vertical_nothing_is_warned_of() {
    let vertical = with(&capsule(), "/initial_state/flight_path_angle", -FRAC_PI_2);
    let shallow = with_all(
        &capsule(),
        [("/vehicle/aerodynamics/lift_coefficient", json!(0.4)), ("/stop", json!({"altitude": 60_000}))],
    );
    for case in [vertical, shallow, capsule()] {
        assert_eq!(warnings(&fly(&case).await), Vec::<Value>::new());
    }
}
