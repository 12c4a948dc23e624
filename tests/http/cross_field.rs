//! Requests whose every field is sound by itself, but not beside the others.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::refusal::{Steady, good_answer};
use super::requests::{KINDS, capsule, conversion, flight, state, with, with_all};

/// Refuses the state in both endpoints, with the faults at pointers relative to it.
async fn refuses_state(steady: &Steady, state: &Value, expected: &[(&str, &str)]) {
    for (path, place, request) in [("/simulate", "/initial_state", capsule()), ("/convert", "/state", json!({}))] {
        let expected: Vec<_> = expected.iter().map(|(name, phrase)| (format!("{place}{name}"), *phrase)).collect();
        let expected: Vec<_> = expected.iter().map(|(pointer, phrase)| (pointer.as_str(), *phrase)).collect();
        steady.refused_at(path, &with(&request, place, state.clone()), &expected).await;
    }
}

fn orbit(semi_major_axis: f64, eccentricity: f64, true_anomaly: f64) -> Value {
    with_all(
        &state("orbital_elements"),
        [
            ("/semi_major_axis", json!(semi_major_axis)),
            ("/eccentricity", json!(eccentricity)),
            ("/true_anomaly", json!(true_anomaly)),
        ],
    )
}

#[tokio::test]
async fn the_sign_of_the_semi_major_axis_goes_with_the_eccentricity() {
    let steady = Steady::new().await;
    for (a, e, phrase) in [
        (7e6, 2.0, "must be negative for an eccentricity of 2"),
        (7e6, 1.0_f64.next_up(), "must be negative"),
        (0.0, 2.0, "must be negative"),
        (-7e6, 0.5, "must be positive for an eccentricity of 0.5"),
        (-7e6, 0.0, "must be positive"),
        (0.0, 0.5, "must be positive"),
        (7e6, 1.0, "give semi_latus_rectum instead"),
        (-7e6, 1.0, "give semi_latus_rectum instead"),
    ] {
        refuses_state(&steady, &orbit(a, e, 0.0), &[("/semi_major_axis", phrase)]).await;
    }
}

#[tokio::test]
async fn the_true_anomaly_lies_on_the_orbit() {
    let steady = Steady::new().await;
    let phrase = "1 + e cos ν must be greater than 0";
    // The asymptotes of e = 2 lie at ±2π/3 = ±2.0944.
    for anomaly in [2.0945, 3.0, -2.0945, 4.1887, -4.1887] {
        refuses_state(&steady, &orbit(-7e6, 2.0, anomaly), &[("/true_anomaly", phrase)]).await;
    }
    let mut parabola = orbit(0.0, 1.0, PI);
    parabola.as_object_mut().unwrap().remove("semi_major_axis");
    parabola["semi_latus_rectum"] = json!(7e6);
    refuses_state(&steady, &parabola, &[("/true_anomaly", phrase)]).await;
    for anomaly in [2.094, -2.094, 4.189] {
        // Out there a rotating planet would see the vehicle race around it.
        let request = json!({"planet": planet_at_rest(), "state": orbit(-7e6, 2.0, anomaly)});
        good_answer(&steady.service, "/convert", &request).await;
    }
}

#[tokio::test]
async fn both_faults_of_an_orbit_are_reported() {
    let steady = Steady::new().await;
    let expected = [("/semi_major_axis", "must be negative"), ("/true_anomaly", "1 + e cos ν must be greater than 0")];
    refuses_state(&steady, &orbit(7e6, 2.0, 3.0), &expected).await;
}

#[tokio::test]
async fn an_altitude_lies_above_the_centre() {
    let steady = Steady::new().await;
    for kind in ["planet_relative", "inertial_flight_path"] {
        for altitude in [-6_378_137.0, -7e6, -1e12] {
            let state = with_all(
                &state(kind),
                [("/altitude", json!(altitude)), ("/geocentric_latitude", json!(0)), ("/sidereal_time", json!(0))],
            );
            refuses_state(&steady, &state, &[("/altitude", "above the planet's centre")]).await;
        }
    }
}

#[tokio::test]
async fn a_position_is_not_the_centre() {
    let steady = Steady::new().await;
    for kind in ["ecef", "eci"] {
        for zero in [json!([0, 0, 0]), json!([0.0, -0.0, 0])] {
            let state = with(&state(kind), "/position", zero);
            refuses_state(&steady, &state, &[("", "the planet's centre")]).await;
        }
    }
    let below_the_equator =
        with_all(&state("geodetic"), [("/geodetic_altitude", json!(-6_378_137)), ("/geodetic_latitude", json!(0))]);
    refuses_state(&steady, &below_the_equator, &[("", "the planet's centre")]).await;
}

#[tokio::test]
async fn vectors_are_not_longer_than_the_ranges_of_radius_and_speed() {
    let steady = Steady::new().await;
    for kind in ["ecef", "eci"] {
        let far = with(&state(kind), "/position", json!([8e11, 8e11, 0]));
        let fast = with(&state(kind), "/velocity", json!([8e5, 0, 8e5]));
        refuses_state(&steady, &fast, &[("", "speed relative to the rotating planet must be at most")]).await;
        // So far out the planet-fixed velocity of an inertial state is large as well.
        if kind == "ecef" {
            refuses_state(&steady, &far, &[("", "distance from the planet's centre must be at most")]).await;
            let both = with(&far, "/velocity", json!([8e5, 0, 8e5]));
            refuses_state(&steady, &both, &[("", "distance from"), ("", "speed relative to")]).await;
        }
    }
}

#[tokio::test]
async fn the_range_of_speed_is_that_relative_to_the_planet_however_the_velocity_is_given() {
    let steady = Steady::new().await;
    // Level and due east or due west on the equator, where the planet itself moves by 7.292115e-5 * 6378137 = 465.1 m/s.
    let state = with_all(
        &state("inertial_flight_path"),
        [("/altitude", json!(0)), ("/geocentric_latitude", json!(0)), ("/inertial_flight_path_angle", json!(0))],
    );
    for (speed, heading, within) in
        [(1_000_465.0, 0.0, true), (1_000_466.0, 0.0, false), (999_534.0, PI, true), (999_535.0, PI, false)]
    {
        let state = with_all(&state, [("/inertial_speed", json!(speed)), ("/inertial_heading", json!(heading))]);
        if within {
            good_answer(&steady.service, "/convert", &json!({"state": state})).await;
        } else {
            refuses_state(&steady, &state, &[("", "speed relative to the rotating planet must be at most")]).await;
        }
    }
    // The planet-fixed velocity of something that stands still far out.
    let far = with_all(&state, [("/altitude", json!(1e11)), ("/inertial_speed", json!(0))]);
    refuses_state(&steady, &far, &[("", "speed relative to the rotating planet must be at most")]).await;
}

#[tokio::test]
async fn a_flight_starts_on_or_above_its_stop_altitude() {
    let steady = Steady::new().await;
    for stop in [120_000.01, 2e5, 1e12] {
        let request = with(&capsule(), "/stop", json!({"altitude": stop}));
        steady
            .refused_at("/simulate", &request, &[("/initial_state", "initial altitude is below the stop altitude")])
            .await;
    }
}

#[tokio::test]
async fn the_stop_altitude_lies_above_the_centre() {
    let steady = Steady::new().await;
    for stop in [-6_378_137.0, -7e6, -1e12] {
        let request = with(&capsule(), "/stop", json!({"altitude": stop}));
        steady.refused_at("/simulate", &request, &[("/stop/altitude", "the planet's centre")]).await;
    }
}

#[tokio::test]
async fn times_ascend() {
    let steady = Steady::new().await;
    for (times, at) in [
        (json!([0, 10, 20, 15, 30]), vec!["/output/times/3"]),
        (json!([0, 0]), vec!["/output/times/1"]),
        (json!([1, 2, 3, 3]), vec!["/output/times/3"]),
        (json!([3, 2, 1]), vec!["/output/times/1", "/output/times/2"]),
        (json!([1e9, 1]), vec!["/output/times/1"]),
    ] {
        let expected: Vec<_> = at.into_iter().map(|at| (at, "must be greater than the ")).collect();
        steady.refused_at("/simulate", &with(&capsule(), "/output", json!({"times": times})), &expected).await;
    }
}

fn planet_at_rest() -> Value {
    json!({"model": "custom", "gravitational_parameter": 4e14, "equatorial_radius": 6.4e6, "polar_radius": 6.4e6,
        "rotation_rate": 0})
}

#[tokio::test]
async fn an_epoch_says_nothing_about_the_angle_of_a_custom_planet() {
    let steady = Steady::new().await;
    for (path, place, request) in
        [("/simulate", "/initial_state", flight as fn(&str) -> Value), ("/convert", "/state", conversion)]
    {
        for kind in KINDS {
            for planet in [planet_at_rest(), flight("eci")["planet"].clone()] {
                let given = with(&request(kind), "/planet", planet);
                let time = format!("{place}/sidereal_time");
                let neither = super::requests::without(&given, &time);
                let by_angle = with(&neither, &format!("{place}/sidereal_angle"), 0.3);
                let undated = super::requests::without(&neither, "/epoch");
                for sound in [given, by_angle, undated] {
                    good_answer(&steady.service, path, &sound).await;
                }
                if kind == "eci" || kind == "orbital_elements" {
                    let phrase = "is required: an epoch does not define the angle of a custom planet";
                    steady.refused_at(path, &neither, &[(&time, phrase)]).await;
                } else {
                    // A planet-fixed state needs none; the frames are aligned as without an epoch.
                    good_answer(&steady.service, path, &neither).await;
                }
            }
        }
    }
}

#[tokio::test]
async fn a_planet_is_neither_a_disc_nor_a_needle() {
    let steady = Steady::new().await;
    for polar in [6.3e5, 6.5e7] {
        for (path, request) in [("/simulate", flight("ecef")), ("/convert", conversion("ecef"))] {
            let request = with(&request, "/planet/equatorial_radius", 6.4e6);
            let request = with(&request, "/planet/polar_radius", polar);
            steady.refused_at(path, &request, &[("/planet/polar_radius", "times the equatorial radius")]).await;
        }
    }
}

#[tokio::test]
async fn csv_without_a_trajectory_is_refused() {
    let steady = Steady::new().await;
    let request = with(&capsule(), "/output", json!({"trajectory": false}));
    steady.refused_at("/simulate?format=csv", &request, &[("/output/trajectory", "CSV")]).await;
}

#[tokio::test]
async fn faults_across_fields_come_in_one_answer() {
    let steady = Steady::new().await;
    let odd_planet = with(&planet_at_rest(), "/polar_radius", 6e5);
    let mut request = with_all(
        &capsule(),
        [("/planet", odd_planet), ("/stop", json!({"altitude": -7e6})), ("/epoch", json!("2026-11-22T12:00:00Z"))],
    );
    let planet = ("/planet/polar_radius", "times the equatorial radius");
    let stop = ("/stop/altitude", "the planet's centre");
    let time = ("/initial_state/sidereal_time", "is required");
    steady.refused_at("/simulate", &request, &[planet, stop]).await;

    request["initial_state"] = super::requests::without(&orbit(7e6, 2.0, 0.0), "/sidereal_time");
    let orbit = ("/initial_state/semi_major_axis", "must be negative");
    steady.refused_at("/simulate", &request, &[planet, stop, orbit, time]).await;
    request.as_object_mut().unwrap().remove("epoch");
    steady.refused_at("/simulate", &request, &[planet, stop, orbit]).await;
}

#[tokio::test]
async fn csv_without_a_trajectory_is_reported_beside_other_faults() {
    let steady = Steady::new().await;
    let request =
        with_all(&capsule(), [("/output", json!({"trajectory": false})), ("/stop", json!({"altitude": 2e5}))]);
    let expected = [("/output/trajectory", "CSV"), ("/initial_state", "initial altitude is below the stop altitude")];
    steady.refused_at("/simulate?format=csv", &request, &expected).await;
}

#[tokio::test]
async fn faults_across_fields_wait_for_a_sound_structure() {
    let steady = Steady::new().await;
    let request = with_all(&capsule(), [("/stop", json!({"altitude": 2e5})), ("/vehicle/mass", json!(-13))]);
    steady.refused_at("/simulate", &request, &[("/vehicle/mass", "got -13")]).await;
}

#[tokio::test]
async fn degrees_sent_as_radians_are_asked_about() {
    let steady = Steady::new().await;
    let mut request = capsule();
    for (name, degrees) in [("longitude", -40), ("geocentric_latitude", 10), ("flight_path_angle", -3), ("heading", 30)]
    {
        request["initial_state"][name] = json!(degrees);
    }
    let question = "for degrees, set \"angle_unit\": \"deg\"";
    let names = ["longitude", "geocentric_latitude", "flight_path_angle", "heading"];
    let pointers = names.map(|name| format!("/initial_state/{name}"));
    let expected: Vec<_> = pointers.iter().map(|pointer| (pointer.as_str(), question)).collect();
    steady.refused_at("/simulate", &request, &expected).await;
    request["angle_unit"] = json!("deg");
    good_answer(&steady.service, "/simulate", &request).await;
}
