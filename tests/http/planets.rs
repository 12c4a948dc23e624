//! The bodies beside the Earth: what a case may ask of them, what each lacks, and that they are what `GET /planets` says.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::convert::codes;
use super::refusal::{Steady, good_answer};
use super::requests::{capsule, with, with_all, without};
use super::simulate::fly;

const BODIES: [&str; 8] = ["jupiter", "mars", "moon", "neptune", "saturn", "titan", "uranus", "venus"];

/// What the service says of its planets, by their names.
async fn planets(service: &Service) -> Vec<(String, Value)> {
    let answer = service.get("/planets").await;
    assert_eq!(answer.status.as_u16(), 200);
    let list = answer.json()["planets"].as_array().unwrap().clone();
    list.into_iter().map(|planet| (planet["name"].as_str().unwrap().to_owned(), planet)).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// An entry at a body, in degrees, with all that depends on it; slow, and low enough to meet the air of each.
fn entry(body: &str) -> Value {
    let (altitude, speed) = match body {
        "jupiter" | "saturn" => (450e3, 30e3),
        "uranus" | "neptune" => (600e3, 23e3),
        "titan" => (900e3, 6000.0),
        "moon" => (100e3, 2200.0),
        "venus" => (180e3, 10_500.0),
        _ => (120e3, 6500.0),
    };
    // Of Titan's high air a shallow entry would skip.
    let flight_path_angle = if body == "titan" { -45 } else { -15 };
    let state = json!({"type": "planet_relative", "altitude": altitude, "longitude": 20, "geocentric_latitude": 35,
        "speed": speed, "flight_path_angle": flight_path_angle, "heading": 40});
    let parts = [
        ("/angle_unit", json!("deg")),
        ("/planet", json!({"model": body, "gravity": {"type": "zonal", "degree": 4}})),
        ("/vehicle/nose_radius", json!(0.6)),
        ("/initial_state", state),
        ("/stop", json!({"altitude": 0, "time": 600})),
        ("/output", json!({"count": 12})),
    ];
    with_all(&capsule(), parts)
}

#[tokio::test]
async fn every_planet_that_a_case_may_name_is_listed_but_custom() {
    let service = Service::new();
    let document = reentry_service::document();
    let words = document["components"]["schemas"]["PlanetModel"]["enum"].as_array().unwrap().clone();
    let listed = planets(&service).await;
    let names: Vec<_> = listed.iter().map(|(name, _)| json!(name)).collect();
    assert_eq!([names, vec![json!("custom")]].concat(), words);
    for (name, planet) in &listed {
        for (number_of, unit) in [
            ("gravitational_parameter", "m³/s²"),
            ("equatorial_radius", "m"),
            ("polar_radius", "m"),
            ("rotation_rate", "rad/s"),
            ("prime_meridian", "°"),
            ("sutton_graves_constant", "√kg/m"),
        ] {
            let Some(given) = planet.get(number_of) else {
                let absent = match number_of {
                    // The Earth's angle is no line in time.
                    "prime_meridian" => name.starts_with("earth"),
                    "sutton_graves_constant" => ["moon", "neptune", "uranus"].contains(&name.as_str()),
                    _ => false,
                };
                assert!(absent, "{name} has no {number_of}");
                continue;
            };
            assert!(number(&given["value"]).is_finite() && given["unit"] == unit, "{name}: {given}");
            assert!(given["source"].as_str().unwrap().len() > 10, "{name}: {given}");
        }
        for part in ["zonal", "atmosphere", "radiation"] {
            let source = planet.get(part).map(|part| part["source"].as_str().unwrap_or_default().len());
            assert!(source.is_none_or(|length| length > 10), "{name}: {part}");
        }
        assert_eq!(planet.get("atmosphere").is_none(), name == "moon");
        assert!(["j2", "j3", "j4"].iter().all(|name| planet["zonal"][name].is_number()), "{name}");
        assert!(planet["description"].as_str().unwrap().len() > 10 && planet["title"].is_string());
    }
    // Those of a file are passed on whole: none of its fields is dropped.
    for (name, planet) in listed.iter().filter(|(name, _)| !name.starts_with("earth")) {
        let body = reentry::body::BODIES.iter().find(|body| body.name == name).unwrap();
        let file: Value = serde_json::from_str(body.source).unwrap();
        assert_eq!(*planet, file, "{name}");
    }
}

/// All that a case may say of a named planet, said of a custom one with the numbers of the list.
fn as_custom(case: &Value, planet: &Value) -> Value {
    let value = |name: &str| planet[name]["value"].clone();
    let mut gravity = json!({"type": "zonal", "degree": 4});
    for name in ["j2", "j3", "j4"] {
        gravity[name] = planet["zonal"][name].clone();
    }
    let custom = json!({"model": "custom", "gravitational_parameter": value("gravitational_parameter"),
        "equatorial_radius": value("equatorial_radius"), "polar_radius": value("polar_radius"),
        "rotation_rate": value("rotation_rate"), "gravity": gravity});
    let mut atmosphere = json!({"type": "vacuum"});
    if let Some(air) = planet.get("atmosphere") {
        atmosphere = json!({"type": "table"});
        for name in ["altitude", "density", "temperature", "pressure", "molar_mass", "heat_capacity_ratio"] {
            atmosphere[name] = air[name].clone();
        }
    }
    let mut case = with_all(case, [("/planet", custom), ("/atmosphere", atmosphere)]);
    if planet.get("sutton_graves_constant").is_some() {
        let constant = json!({"type": "sutton_graves", "constant": value("sutton_graves_constant")});
        case = with(&case, "/heating", json!({"convective": constant}));
    }
    case
}

#[tokio::test]
async fn a_named_body_flies_as_a_custom_planet_with_its_listed_numbers() {
    let service = Service::new();
    for (name, planet) in planets(&service).await.into_iter().filter(|(name, _)| BODIES.contains(&name.as_str())) {
        let mut case = entry(&name);
        let is_heated = planet.get("sutton_graves_constant").is_some();
        if is_heated {
            case = with(&case, "/heating", json!({}));
        }
        let [named, custom] = [good_answer(&service, "/simulate", &case).await, fly(&as_custom(&case, &planet)).await];
        for part in ["termination", "initial_state", "final_state", "peaks", "trajectory"] {
            assert_eq!(named[part], custom[part], "{name}: {part}");
        }
        assert_eq!((&named["models"]["planet"], &named["models"]["atmosphere"]), (&json!(name), &json!("standard")));
        assert!(number(&named["final_state"]["time"]) > 30.0, "{name}: no flight");
        if name != "moon" {
            assert!(number(&named["peaks"]["load_factor"]["value"]) > 1.0, "{name}: no air");
            assert!(named["peaks"]["mach"].is_object(), "{name}");
        }
        assert_eq!(named["peaks"].get("heat_load").is_some(), is_heated, "{name}");
        if is_heated {
            assert!(number(&named["peaks"]["heat_load"]["value"]) > 1e5, "{name}: no heat");
        }
    }
}

#[tokio::test]
async fn the_echo_of_a_body_flies_to_the_same_digits() {
    let service = Service::new();
    for (name, planet) in planets(&service).await.into_iter().filter(|(name, _)| BODIES.contains(&name.as_str())) {
        for gravity in
            [json!({"type": "zonal", "degree": 4}), json!({"type": "zonal"}), json!({"type": "inverse_square"})]
        {
            let case = with_all(&entry(&name), [("/planet/gravity", gravity.clone()), ("/echo", json!(true))]);
            let answer = good_answer(&service, "/simulate", &case).await;
            let echo = &answer["case"];
            assert_eq!(echo["atmosphere"], json!({"type": "standard"}), "{name}");
            assert_eq!(echo["planet"]["model"], json!(name));
            let degree = if gravity["type"] == "zonal" { gravity["degree"].as_u64().unwrap_or(2) } else { 0 };
            for (order, coefficient) in [(2, "j2"), (3, "j3"), (4, "j4")] {
                let expected = (order <= degree).then(|| &planet["zonal"][coefficient]);
                assert_eq!(echo["planet"]["gravity"].get(coefficient), expected, "{name}: {coefficient} of {gravity}");
            }
            let again = good_answer(&service, "/simulate", echo).await;
            for part in ["final_state", "peaks", "trajectory", "models", "case"] {
                assert_eq!(again[part], answer[part], "{name}: {part}");
            }
        }
    }
}

/// What a body lacks is refused where it stands, with what to do.
#[tokio::test]
async fn what_a_body_lacks_is_refused() {
    let steady = Steady::new().await;
    let heated = |body: &str, heating: Value| with(&entry(body), "/heating", heating);
    for (case, pointer, phrase) in [
        (heated("moon", json!({})), "/heating/convective", "no constant is known for Moon; give"),
        (heated("neptune", json!({})), "/heating/convective", "no constant is known for Neptune; give"),
        (heated("mars", json!({"convective": "chapman"})), "/heating/convective", "for the Earth's air, on Mars; give"),
        (heated("venus", json!({"convective": "detra_kemp_riddell"})), "/heating/convective", "on Venus; give"),
        (heated("mars", json!({"radiative": "craig_lyne"})), "/heating/radiative", "on Mars: use \"tauber_sutton\" or"),
        (
            heated("venus", json!({"radiative": "tauber_sutton"})),
            "/heating/radiative",
            "on Venus: use \"craig_lyne\" or",
        ),
        (
            heated("titan", json!({"radiative": "tauber_sutton"})),
            "/heating/radiative",
            "no correlation of the radiative",
        ),
        (heated("jupiter", json!({"radiative": "craig_lyne"})), "/heating/radiative", "on Jupiter: no correlation"),
    ] {
        steady.refused_at("/simulate", &case, &[(pointer, phrase)]).await;
    }
    // On the Earth too a correlation of another gas is none.
    let on_earth =
        with_all(&capsule(), [("/vehicle/nose_radius", json!(1)), ("/heating", json!({"radiative": "craig_lyne"}))]);
    let refused = ("/heating/radiative", "on the Earth: use \"tauber_sutton\" or \"none\"");
    steady.refused_at("/simulate", &on_earth, &[refused]).await;
    let custom = json!({"model": "custom", "gravitational_parameter": 4.28e13, "equatorial_radius": 3.4e6,
        "polar_radius": 3.4e6, "rotation_rate": 7e-5});
    let of_custom = with_all(&capsule(), [("/planet", custom), ("/atmosphere", json!({"type": "standard"}))]);
    let refused = ("/atmosphere/type", "must not be standard: a custom planet has no standard atmosphere");
    steady.refused_at("/simulate", &of_custom, &[refused]).await;
    for frame in ["gcrf", "teme"] {
        let state = json!({"type": "eci", "frame": frame, "position": [3.5e6, 0, 0], "velocity": [0, 5e3, 0]});
        let case =
            with_all(&entry("mars"), [("/initial_state", state.clone()), ("/epoch", json!("2021-02-18T20:44:00Z"))]);
        let refused = ("/initial_state/frame", "is a frame of the Earth and is not available on Mars");
        steady.refused_at("/simulate", &case, &[refused]).await;
        let conversion = json!({"planet": {"model": "venus"}, "epoch": "2021-02-18T20:44:00Z",
            "state": with(&state, "/position", json!([6.5e6, 0, 0]))});
        let refused = ("/state/frame", "is not available on Venus");
        steady.refused_at("/convert", &conversion, &[refused]).await;
    }
}

#[tokio::test]
async fn all_that_a_body_lacks_is_refused_at_once() {
    let steady = Steady::new().await;
    let lacks = [
        ("/planet/rotation_rate", "is not a field here"),
        ("/heating/convective", "for the Earth's air, on Moon"),
        ("/heating/radiative", "on Moon: no correlation"),
        ("/heating/emissivity", "at most 1"),
        ("/vehicle/mass", "greater than 0"),
    ];
    let heating = json!({"convective": "chapman", "radiative": "tauber_sutton", "emissivity": 2});
    let changes = [("/planet/rotation_rate", json!(1e-6)), ("/heating", heating), ("/vehicle/mass", json!(-1))];
    steady.refused_at("/simulate", &with_all(&entry("moon"), changes), &lacks).await;
    // A word that is none does not hide what the other lacks.
    let heating = json!({"convective": "fay_riddell", "radiative": "craig_lyne"});
    let expected =
        [("/heating/convective", "must be one of"), ("/heating/radiative", "on Mars: use \"tauber_sutton\"")];
    steady.refused_at("/simulate", &with(&entry("mars"), "/heating", heating), &expected).await;
}

/// The instant of an inertial state at a body, by /convert of a place that turns with it.
async fn turned(service: &Service, body: &str, epoch: &str) -> Value {
    let state = json!({"type": "ecef", "position": [3e7, 4e7, 5e7], "velocity": [100, -200, 300]});
    let request = json!({"angle_unit": "deg", "planet": {"model": body}, "epoch": epoch, "state": state});
    good_answer(service, "/convert", &request).await
}

/// W at the landing of Curiosity by the report of the IAU of 2000, and days of terrestrial time by hand: 4601 days from 2000 January 1 to 2012
/// August 6; TAI is 35 s ahead of UTC since that July.
#[tokio::test]
async fn an_epoch_gives_the_meridian_of_a_body() {
    let service = Service::new();
    let days = 4600.5 + (5.0 * 3600.0 + 10.0 * 60.0 + 45.0 + 35.0 + 32.184) / 86_400.0;
    let answer = turned(&service, "mars", "2012-08-06T05:10:45Z").await;
    let angle = number(&answer["eci"]["sidereal_time"]) * 350.891_982_26 / 86_400.0;
    let expected: f64 = 176.630 + 350.891_982_26 * days;
    check::angle("Mars", angle.to_radians(), expected.to_radians(), 3e-3_f64.to_radians());
    // Jupiter turns by 0.01° a second, Saturn, Uranus and Neptune by less: so a second more or less would be seen.
    for (body, at_epoch, by_day) in [
        ("jupiter", 284.95, 870.536),
        ("saturn", 38.90, 810.793_902_4),
        ("uranus", 203.81, -501.160_092_8),
        ("venus", 160.20, -1.481_368_8),
        ("titan", 186.5855, 22.576_976_8),
    ] {
        let answer = turned(&service, body, "2012-08-06T05:10:45Z").await;
        let angle = number(&answer["eci"]["sidereal_time"]) * by_day / 86_400.0;
        check::angle(body, angle.to_radians(), (at_epoch + by_day * days).to_radians(), 1e-7);
    }
}

/// A second lies before a leap second, one in it, and one behind; before 1972 UTC is 10 s behind TAI.
#[tokio::test]
async fn leap_seconds_count_in_the_rotation_of_a_body() {
    let service = Service::new();
    let mut at = Vec::new();
    for epoch in ["2016-12-31T23:59:59Z", "2016-12-31T23:59:60Z", "2017-01-01T00:00:00Z"] {
        at.push(number(&turned(&service, "jupiter", epoch).await["eci"]["sidereal_time"]));
    }
    for pair in at.windows(2) {
        check::near("a second", pair[1] - pair[0], 1.0, 1e-6);
    }
    // 28 years are 10227 days, and 27 leap seconds lie within them, of which five fall into 1999 to 2017.
    let [earlier, later] = [
        turned(&service, "jupiter", "1999-01-01T00:00:00Z").await,
        turned(&service, "jupiter", "2017-01-01T00:00:00Z").await,
    ];
    let day = 360.0 / 870.536 * 86_400.0;
    let turned = number(&later["eci"]["sidereal_time"]) - number(&earlier["eci"]["sidereal_time"]);
    let seconds = 6575.0 * 86_400.0 + 5.0;
    let error = (turned - seconds).rem_euclid(day);
    check::near("18 years", error.min(day - error), 0.0, 1e-3);
}

/// Of a body that turns westward the angle falls: the sidereal time is the time in which it comes from 0 to what it is, and leads back.
#[tokio::test]
async fn the_sidereal_time_of_a_body_is_that_of_its_turn() {
    let service = Service::new();
    let listed = planets(&service).await;
    for body in BODIES {
        for epoch in ["1990-03-01T00:00:00Z", "2026-11-22T12:00:00Z", "2051-07-07T07:07:07Z"] {
            let answer = turned(&service, body, epoch).await;
            let time = number(&answer["eci"]["sidereal_time"]);
            let rate = listed
                .iter()
                .find(|(name, _)| name == body)
                .map(|(_, planet)| number(&planet["rotation_rate"]["value"]));
            let period = std::f64::consts::TAU / rate.unwrap().abs();
            assert!((0.0..=period).contains(&time), "{body}: {time} of {period}");
            // Without the epoch, the state with this time is the same place.
            for kind in ["eci", "orbital_elements", "inertial_flight_path"] {
                let mut state = answer[kind].clone();
                state["type"] = json!(kind);
                let request = json!({"angle_unit": "deg", "planet": {"model": body}, "state": state});
                let again = service.post("/convert", &request).await;
                if again.status.as_u16() != 200 {
                    assert!(kind != "eci", "{}", String::from_utf8_lossy(&again.body));
                    continue;
                }
                let again = again.json();
                for part in ["position", "velocity"] {
                    for axis in 0..3 {
                        let [expected, found] = [&answer, &again].map(|answer| number(&answer["ecef"][part][axis]));
                        check::near(&format!("{body} {kind} {part}"), found, expected, 1e-8 * 7e7);
                    }
                }
            }
        }
    }
}

#[tokio::test]
async fn an_inertial_state_at_a_body_warns_of_its_frame() {
    let service = Service::new();
    for (body, title) in [("mars", "Mars"), ("venus", "Venus"), ("moon", "Moon")] {
        let request = json!({"angle_unit": "deg", "planet": {"model": body}, "epoch": "2026-11-22T12:00:00Z",
            "state": {"type": "eci", "position": [7e6, 0, 1e6], "velocity": [0, 5e3, 0]}});
        let answer = good_answer(&service, "/convert", &request).await;
        let warnings = answer["warnings"].as_array().unwrap();
        let [warning] = &warnings[..] else { panic!("{answer}") };
        assert_eq!(warning["code"], "inertial_frame_of_date");
        assert!(
            warning["detail"].as_str().unwrap().contains(&format!("the equator of {title}, with the x axis")),
            "{warning}"
        );
        let turned = good_answer(&service, "/convert", &with(&request, "/state/sidereal_angle", 0.1)).await;
        let detail = turned["warnings"][0]["detail"].as_str().unwrap();
        assert!(detail.contains("turned by the sidereal time or angle of the state"), "{turned}");
        for without_it in [
            without(&request, "/epoch"),
            with(&request, "/state", json!({"type": "ecef", "position": [7e6, 0, 1e6], "velocity": [0, 5e3, 0]})),
        ] {
            assert_eq!(
                codes(&good_answer(&service, "/convert", &without_it).await),
                Vec::<&str>::new(),
                "{without_it}"
            );
        }
    }
}

#[tokio::test]
async fn the_air_of_a_body_has_the_warnings_that_belong_to_it() {
    for body in BODIES {
        let expected: &[&str] = if body == "saturn" { &["atmosphere_of_low_confidence"] } else { &[] };
        assert_eq!(codes(&fly(&entry(body)).await), expected, "{body}");
        let standard = with(&entry(body), "/atmosphere", json!({"type": "standard"}));
        assert_eq!(codes(&fly(&standard).await), expected, "{body}");
        let vacuum = with(&entry(body), "/atmosphere", json!({"type": "vacuum"}));
        assert_eq!(codes(&fly(&vacuum).await), Vec::<&str>::new(), "{body}");
        let of_earth = with(&entry(body), "/atmosphere", json!({"type": "exponential"}));
        assert_eq!(codes(&fly(&of_earth).await), ["gas_of_earth"], "{body}");
    }
    // On the Earth the standard is us76, with whose digits it flies.
    let on_earth = |kind: &str| with(&capsule(), "/atmosphere", json!({"type": kind}));
    let [standard, us76] = [fly(&on_earth("standard")).await, fly(&on_earth("us76")).await];
    for part in ["final_state", "peaks", "trajectory", "warnings"] {
        assert_eq!(standard[part], us76[part], "{part}");
    }
}

/// The correlation of the radiation in its own gas, by the row: 2.35e8 r^0.526 ρ^1.19 f(V) at Mars and C V^n ρ^1.2 r^0.49 at Venus.
#[tokio::test]
async fn rows_have_the_radiation_of_the_body() {
    let radiation = |body: &str| {
        with(
            &entry(body),
            "/heating",
            json!({"radiative": if body == "mars" { "tauber_sutton" } else { "craig_lyne" }}),
        )
    };
    let mars =
        fly(&with_all(&radiation("mars"), [("/initial_state/speed", json!(8900)), ("/output", json!({"count": 400}))]))
            .await;
    let column = |answer: &Value, name: &str| -> Vec<f64> {
        answer["trajectory"][name].as_array().unwrap().iter().map(number).collect()
    };
    let mut seen = 0;
    let [density, speed, flux] = ["density", "air_speed", "radiative_heat_flux"].map(|name| column(&mars, name));
    for row in 0..density.len() {
        let f = flux[row] / (2.35e8 * 0.6_f64.powf(0.526) * density[row].powf(1.19));
        // Between the entries at 7, 8 and 8.8 km/s, by the neighbours of the table.
        for ([low, high], [below, above]) in
            [([7000.0, 7200.0], [8.1, 10.2]), ([8000.0, 8200.0], [19.2, 21.4]), ([8600.0, 8800.0], [26.0, 28.9])]
        {
            if (low..high).contains(&speed[row]) {
                let expected = below + (above - below) * (speed[row] - low) / (high - low);
                check::relative("f", f, expected, 1e-10);
                seen += 1;
            }
        }
        assert!(speed[row] >= 6000.0 || flux[row].to_bits() == 0);
    }
    assert!(seen > 10, "{seen}");
    let venus = fly(&with(&radiation("venus"), "/output", json!({"count": 400}))).await;
    let [density, speed, flux] = ["density", "air_speed", "radiative_heat_flux"].map(|name| column(&venus, name));
    for row in 0..density.len() {
        let (constant, exponent) = match speed[row] {
            slow if slow < 8000.0 => (3.33e-34, 10.0),
            medium if medium < 10_000.0 => (1.22e-16, 5.5),
            _ => (3.07e-48, 13.4),
        };
        // W/cm².
        let expected = 1e4 * constant * speed[row].powf(exponent) * density[row].powf(1.2) * 0.6_f64.powf(0.49);
        check::relative("Venus", flux[row], expected, 1e-10);
    }
}

#[tokio::test]
async fn maps_are_of_globes_that_viewers_have() {
    let service = Service::new();
    let steady = Steady::new().await;
    for body in BODIES {
        let case = entry(body);
        let geojson = service.post("/simulate?format=geojson", &case).await;
        assert_eq!(geojson.status.as_u16(), 200, "{body}");
        assert!(String::from_utf8_lossy(&geojson.body).contains(&format!("\"planet\":\"{body}\"")), "{body}");
        let kml = service.post("/simulate?format=kml", &case).await;
        if ["mars", "moon"].contains(&body) {
            let text = String::from_utf8_lossy(&kml.body).into_owned();
            let root = text.split("<kml").nth(1).unwrap().split('>').next().unwrap();
            assert!(root.contains(&format!("hint=\"target={body}\"")), "{root}");
        } else {
            steady
                .refused_at(
                    "/simulate?format=kml",
                    &case,
                    &[("/planet/model", "must be the Earth, mars or moon for KML")],
                )
                .await;
        }
        steady.refused_at("/simulate?format=czml", &case, &[("/planet/model", "must be the Earth for CZML")]).await;
    }
    let earth = service.post("/simulate?format=kml", &capsule()).await;
    assert!(!String::from_utf8_lossy(&earth.body).contains("hint="));
}
