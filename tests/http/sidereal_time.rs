//! Sidereal time and epochs, which stand in every state and in both requests.

use axum::http::StatusCode;
use reentry_tests::service::Service;
use serde_json::json;

use crate::check;

use super::convert::codes;
use super::refusal::{Steady, good_answer, problem};
use super::requests::{KINDS, conversion, flight, with, without};

#[tokio::test]
async fn sidereal_time_is_seconds_or_a_clock() {
    let service = Service::new();
    for (given, seconds) in [
        (json!(200.6), 200.6),
        (json!("00:03:20.6"), 200.6),
        (json!("00:00:00"), 0.0),
        (json!("23:59:59.999"), 86_399.999),
        (json!("100:00:01"), 360_001.0),
        (json!(-1e5), -1e5),
        (json!(1e9), 1e9),
        (json!(0), 0.0),
    ] {
        let request = with(&conversion("eci"), "/state/sidereal_time", given.clone());
        let answer = good_answer(&service, "/convert", &request).await;
        for kind in KINDS {
            assert_eq!(answer[kind]["sidereal_time"], json!(seconds), "{given} in {kind}");
        }
    }
    let clocks = [
        "",
        "00:03",
        "0:03:20",
        "00:60:00",
        "00:00:60",
        "-00:03:20",
        "00:03:20,6",
        "00:03:20.",
        "00:3:20",
        "00:03:20.6s",
        " 00:03:20",
        "1e2:00:00",
        "00:03:-1",
        "noon",
        "٠٠:٠٣:٢٠",
    ];
    let steady = Steady::new().await;
    for clock in clocks {
        let request = with(&conversion("ecef"), "/state/sidereal_time", clock);
        steady.refused_at("/convert", &request, &[("/state/sidereal_time", "\"HH:MM:SS.s\"")]).await;
    }
}

/// The sidereal time that follows from an epoch, turned to an angle in degrees in [0, 360).
async fn angle_at(service: &Service, epoch: &str) -> f64 {
    let request = without(&conversion("ecef"), "/state/sidereal_time");
    let request = with(&with(&request, "/planet", json!({})), "/epoch", epoch);
    let answer = good_answer(service, "/convert", &request).await;
    (answer["eci"]["sidereal_time"].as_f64().unwrap() * 7.292_115e-5).to_degrees().rem_euclid(360.0)
}

#[tokio::test]
async fn an_epoch_gives_the_earth_rotation_angle() {
    let service = Service::new();
    let day = 360.0 * 0.002_737_811_911_354_48_f64;
    let noon_2000: f64 = 280.460_618_375_04;
    for (epoch, expected) in [
        ("2000-01-01T12:00:00Z", noon_2000),
        ("2000-01-01T12:00:00.000Z", noon_2000),
        ("2000-01-01T13:00:00+01:00", noon_2000),
        ("2000-01-01T06:30:00-05:30", noon_2000),
        ("2000-01-02T12:00:00Z", noon_2000 + day),
        ("1999-12-31T12:00:00Z", noon_2000 - day),
        // 9822 days later; half a day later the angle is half a turn further, and half a day's excess.
        ("2026-11-22T12:00:00Z", noon_2000 + 9822.0 * day),
        ("2026-11-23T00:00:00Z", noon_2000 + 9822.5 * day + 180.0),
        ("2024-02-29T12:00:00Z", noon_2000 + 8825.0 * day),
    ] {
        let angle = angle_at(&service, epoch).await;
        check::angle(epoch, angle.to_radians(), expected.to_radians(), 1e-9);
    }
}

#[tokio::test]
async fn a_leap_second_is_a_time() {
    let angle = angle_at(&Service::new(), "2016-12-31T23:59:60Z").await;
    let next = angle_at(&Service::new(), "2017-01-01T00:00:00Z").await;
    // The Earth turns by 15 arc seconds in a second: the leap second lies within two seconds of midnight.
    check::angle("leap second", angle.to_radians(), next.to_radians(), 2.0 * 7.3e-5);
}

#[tokio::test]
async fn a_sidereal_time_wins_over_an_epoch() {
    let answer = good_answer(&Service::new(), "/convert", &conversion("ecef")).await;
    assert_eq!(answer["ecef"]["sidereal_time"], json!(100.0));
}

#[tokio::test]
async fn what_is_no_instant_is_refused_as_an_epoch() {
    let service = Service::new();
    let mut accepted = Vec::new();
    for epoch in [
        "",
        "yesterday",
        "2026-01-01",
        "2026-01-01T00:00:00",
        "2026-13-01T00:00:00Z",
        "2026-00-01T00:00:00Z",
        "2026-02-30T00:00:00Z",
        "2025-02-29T00:00:00Z",
        "2026-01-00T00:00:00Z",
        "2026-01-32T00:00:00Z",
        "2026-04-31T00:00:00Z",
        "2026-01-01T25:00:00Z",
        "2026-01-01T24:00:00Z",
        "2026-01-01T00:60:00Z",
        "2026-01-01T00:00:61Z",
        "2026-01-01T00:00:60Z",
        "2026-01-01T00:00:00+24:00",
        "2026-01-01T00:00:00+01:60",
        "2026-01-01T00:00:00 UTC",
        "2026-01-01T00:00:00TAI",
        "2026-01-01T00:00:00.Z",
        "2026-01-01T00:00:00+0100",
        "26-01-01T00:00:00Z",
        "+2026-01-01T00:00:00Z",
        "JD 2451545.0",
        "2026-W01-1T00:00:00Z",
        "2026-01-01T00:00Z",
    ] {
        for (path, request) in [("/convert", conversion("eci")), ("/simulate", flight("orbital_elements"))] {
            let answer = service.post(path, &with(&request, "/epoch", epoch)).await;
            if answer.status == StatusCode::OK {
                accepted.push(format!("{path} {epoch:?}"));
            } else {
                let refusal = problem(&answer);
                assert_eq!(answer.pointers(), ["/epoch"], "{refusal}");
                let detail = refusal["errors"][0]["detail"].as_str().unwrap();
                assert!(detail.starts_with("must be an RFC 3339 time"), "{detail}");
            }
        }
    }
    assert!(accepted.is_empty(), "accepted: {}", accepted.join(", "));
}

#[tokio::test]
async fn an_inertial_state_with_an_epoch_warns_of_the_frame() {
    let service = Service::new();
    for kind in KINDS {
        let on_earth = with(&conversion(kind), "/planet", json!({}));
        let answer = good_answer(&service, "/convert", &on_earth).await;
        let inertial = kind == "eci" || kind == "orbital_elements";
        assert_eq!(codes(&answer).contains(&"inertial_frame_of_date"), inertial, "{kind}");
        // Without a date there is none of date, and another planet has no J2000.
        for other in [without(&on_earth, "/epoch"), conversion(kind)] {
            let answer = good_answer(&service, "/convert", &other).await;
            assert!(!codes(&answer).contains(&"inertial_frame_of_date"), "{kind}");
        }
    }
}
