//! What a request leaves out and the answer says so: the unit of angles, the air, the gas of another planet, the length of a flight.

use std::path::Path;

use reentry_service::validation::{cases, flights, nesc};
use reentry_tests::cases::{read_json, thesis_cases};
use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check::{near, relative};

use super::refusal::{Steady, good_answer};
use super::requests::{capsule, conversion, flight, model, with, with_all, without};
use super::simulate::{codes, fly};

/// The text of the warning with a code, if the answer has it once.
fn detail<'a>(answer: &'a Value, code: &str) -> Option<&'a str> {
    let warnings = answer["warnings"].as_array().unwrap();
    let mut of_code = warnings.iter().filter(|warning| warning["code"] == code);
    let found = of_code.next().map(|warning| warning["detail"].as_str().unwrap());
    assert!(of_code.next().is_none(), "{answer}");
    found
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// A shallow entry whose -1.5 means degrees, and is read as radians.
fn degrees_taken_for_radians() -> Value {
    json!({
        "atmosphere": {"type": "us76"},
        "vehicle": {"mass": 1207.8, "reference_area": 2.81, "aerodynamics": {"type": "constant", "drag_coefficient": 1.6}},
        "initial_state": {"type": "planet_relative", "altitude": 99_060, "longitude": 0, "geocentric_latitude": 0, "speed": 6858,
            "flight_path_angle": -1.5, "heading": 0},
        "output": {"trajectory": false},
    })
}

#[tokio::test]
async fn angles_without_a_unit_are_a_warning() {
    const CODE: &str = "angle_unit_assumed";
    let case = degrees_taken_for_radians();
    let said = detail(&fly(&case).await, CODE).unwrap().to_owned();
    assert!(said.starts_with("Angles were read as radians") && said.contains("\"angle_unit\": \"deg\""), "{said}");
    for unit in ["rad", "deg"] {
        assert_eq!(detail(&fly(&with(&case, "/angle_unit", unit)).await, CODE), None);
    }
    let level = with(&case, "/initial_state/flight_path_angle", 0);
    assert_eq!(detail(&fly(&level).await, CODE), None);
    // Wherever the angle stands.
    let schedule = json!({"type": "schedule", "against": "time", "at": [0, 1], "value": [0, 1]});
    let turns = json!([{"when": {"quantity": "flight_path_angle", "falls_through": -0.1}}]);
    for (pointer, value) in [
        ("/control", json!({"bank_angle": 0.1})),
        ("/control", json!({"bank_angle": schedule})),
        ("/events", turns),
        ("/wind", json!({"type": "constant", "speed": 3, "from": 1})),
        ("/wind", json!({"type": "table", "altitude": [0], "speed": [3], "from": [1]})),
    ] {
        assert!(detail(&fly(&with(&level, pointer, value.clone())).await, CODE).is_some(), "{value}");
    }
    // On every other answer that has warnings.
    let service = Service::new();
    let convert = without(&conversion("geodetic"), "/angle_unit");
    assert!(detail(&good_answer(&service, "/convert", &convert).await, CODE).is_some());
    assert!(
        detail(&good_answer(&service, "/convert", &without(&conversion("ecef"), "/angle_unit")).await, CODE).is_none()
    );
    let theory = with(&without(&flight("geodetic"), "/angle_unit"), "/solution", "loh");
    assert!(detail(&good_answer(&service, "/analytic", &theory).await, CODE).is_some());
    for format in ["geojson", "kml", "czml"] {
        let map =
            service.post(&format!("/simulate?format={format}"), &with(&case, "/output", json!({"count": 3}))).await;
        assert!(String::from_utf8_lossy(&map.body).contains("Angles were read as radians"), "{format}");
    }
}

#[tokio::test]
async fn the_air_of_the_thesis_is_a_warning_where_none_is_given() {
    let answer = fly(&capsule()).await;
    let said = detail(&answer, "thesis_atmosphere").unwrap();
    assert!(
        said.contains("1.548 kg/m³") && said.contains("26 %") && said.contains("{\"type\": \"standard\"}"),
        "{said}"
    );
    // The numbers that it says.
    let at_the_ground = |answer: &Value| number(&answer["final_state"]["density"]);
    let standard = fly(&with(&capsule(), "/atmosphere", json!({"type": "us76"}))).await;
    near("the thesis's", at_the_ground(&answer), 1.548, 5e-4);
    near("26 %", at_the_ground(&answer) / at_the_ground(&standard), 1.26, 5e-3);
    assert_eq!(detail(&standard, "thesis_atmosphere"), None);
    let asked = fly(&with(&capsule(), "/atmosphere", json!({"type": "exponential"}))).await;
    assert_eq!((detail(&asked, "thesis_atmosphere"), &asked["final_state"]), (None, &answer["final_state"]));
    // Beside a theory, which needs an exponential one, the remedy is another.
    let analytic = Service::new()
        .post("/analytic", &with(&without(&flight("planet_relative"), "/atmosphere"), "/solution", "loh"))
        .await
        .json();
    let said = detail(&analytic, "thesis_atmosphere").unwrap();
    assert!(!said.contains("\"standard\"") && said.contains("surface_density"), "{said}");
}

fn custom() -> Value {
    json!({"model": "custom", "gravitational_parameter": 4.282_837e13, "equatorial_radius": 3_396_190, "polar_radius": 3_376_200,
        "rotation_rate": 7.088_218e-5})
}

#[tokio::test]
async fn the_gas_of_the_earth_on_another_planet_is_a_warning() {
    const CODE: &str = "gas_of_earth";
    let table = |of: Value| {
        let mut table = json!({"type": "table", "altitude": [0, 5e4, 1e5], "density": [0.02, 3e-4, 3e-7]});
        table.as_object_mut().unwrap().extend(of.as_object().unwrap().clone());
        table
    };
    let temperature = json!([240, 140, 120]);
    let given = json!({"type": "exponential", "surface_density": 0.02, "scale_height": 11e3});
    for (atmosphere, warned) in [
        (table(json!({"temperature": temperature})), Some("Speed of sound is that of air")),
        (table(json!({"temperature": temperature, "molar_mass": 0.044, "heat_capacity_ratio": 1.29})), None),
        (table(json!({"temperature": temperature, "speed_of_sound": [240, 190, 170]})), None),
        (table(json!({"speed_of_sound": [240, 190, 170]})), None),
        (table(json!({})), None),
        (json!({"type": "us76"}), Some("Atmosphere us76 is the Earth's")),
        (json!({"type": "layered_exponential", "preset": "earth_seven_layer"}), Some("Atmosphere earth_seven_layer")),
        (json!({"type": "exponential"}), Some("Default density and scale height are the Earth's")),
        (given.clone(), None),
        (json!({"type": "vacuum"}), None),
    ] {
        let elsewhere = fly(&with_all(&capsule(), [("/planet", custom()), ("/atmosphere", atmosphere.clone())])).await;
        let found = detail(&elsewhere, CODE);
        assert_eq!(found.is_some(), warned.is_some(), "{atmosphere}");
        assert!(found.is_none_or(|found| found.starts_with(warned.unwrap())), "{found:?}");
        let here = fly(&with(&capsule(), "/atmosphere", atmosphere)).await;
        assert_eq!(detail(&here, CODE), None);
    }
    let heated = |heating: Value| {
        let parts = [("/planet", custom()), ("/atmosphere", given.clone()), ("/heating", heating)];
        with(&with_all(&capsule(), parts), "/vehicle/nose_radius", 0.6)
    };
    let constant = json!({"type": "sutton_graves", "constant": 1.9e-4});
    for (heating, count) in [
        (json!({}), 1),
        (json!({"convective": "chapman"}), 1),
        (json!({"convective": "detra_kemp_riddell", "radiative": "tauber_sutton"}), 2),
        (json!({"convective": constant}), 0),
        (json!({"convective": constant, "radiative": "tauber_sutton"}), 1),
    ] {
        let case = heated(heating.clone());
        let warned = codes(&fly(&case).await).into_iter().filter(|code| *code == CODE).count();
        assert_eq!(warned, count, "{heating}");
        let here = fly(&without(&case, "/planet")).await;
        assert!(!codes(&here).contains(&CODE), "{heating}");
    }
    // With no atmosphere it is the thesis's, and the remedy is not us76.
    let answer = fly(&with(&capsule(), "/planet", custom())).await;
    let said = detail(&answer, "thesis_atmosphere").unwrap();
    assert!(said.ends_with("Set the \"atmosphere\" of the planet"), "{said}");
}

/// The flux is in proportion to the constant: of air, it is what the name stands for.
#[tokio::test]
async fn the_constant_of_a_gas_scales_the_heat_flux() {
    let case = with_all(&capsule(), [("/vehicle/nose_radius", json!(0.6)), ("/atmosphere", json!({"type": "us76"}))]);
    let by = |convective: Value| with(&case, "/heating", json!({"convective": convective}));
    let of = |constant: f64| by(json!({"type": "sutton_graves", "constant": constant}));
    let [air, same, double] =
        [fly(&by(json!("sutton_graves"))).await, fly(&of(1.7415e-4)).await, fly(&of(3.483e-4)).await];
    assert_eq!((&air["peaks"], &air["final_state"]), (&same["peaks"], &same["final_state"]));
    for quantity in ["convective_heat_flux", "heat_load"] {
        let [air, double] = [&air, &double].map(|answer| number(&answer["peaks"][quantity]["value"]));
        // The heat load is part of what the integrator keeps within its tolerance, which changes the steps.
        relative(quantity, double, 2.0 * air, 1e-7);
    }
}

#[tokio::test]
async fn a_speed_of_sound_has_a_mach_number_and_no_temperature() {
    let answer = fly(&model("table of sound")).await;
    let row = &answer["initial_state"];
    assert!(row.get("temperature").is_none() && row["speed_of_sound"].is_number());
    relative("Mach", number(&row["mach"]), number(&row["air_speed"]) / number(&row["speed_of_sound"]), 1e-14);
    let case = with(&model("table of sound"), "/output/columns", json!(["mach", "speed_of_sound"]));
    fly(&case).await;
    let steady = Steady::new().await;
    let case = with(&model("table of sound"), "/output/columns", json!(["mach", "temperature"]));
    steady.refused_at("/simulate", &case, &[("/output/columns/1", "temperature requires")]).await;
    let mute = without(&model("table of sound"), "/atmosphere/speed_of_sound");
    let mute = with(&mute, "/stop/when/0", json!({"quantity": "mach", "falls_through": 1}));
    steady.refused_at("/simulate", &mute, &[("/stop/when/0/quantity", "requires a Mach number")]).await;
}

#[tokio::test]
async fn a_gas_lacks_nothing_and_has_nothing_twice() {
    let steady = Steady::new().await;
    let gas = model("table of a gas");
    let without_temperature = without(&gas, "/atmosphere/temperature");
    let list = json!([240, 190, 170]);
    for (case, faults) in [
        (without(&gas, "/atmosphere/molar_mass"), vec![("/atmosphere/molar_mass", "is required")]),
        (without(&gas, "/atmosphere/heat_capacity_ratio"), vec![("/atmosphere/heat_capacity_ratio", "is required")]),
        (without_temperature, vec![("/atmosphere/temperature", "is required")]),
        (
            with(&gas, "/atmosphere/speed_of_sound", list),
            vec![
                ("/atmosphere/molar_mass", "must not be given together with speed_of_sound"),
                ("/atmosphere/heat_capacity_ratio", "must not be given together with speed_of_sound"),
            ],
        ),
        // In g/mol.
        (
            with(&gas, "/atmosphere/molar_mass", 44.01),
            vec![("/atmosphere/molar_mass", "must be between 1e-6 and 1, got 44.01")],
        ),
        (
            with(&gas, "/atmosphere/heat_capacity_ratio", json!([1.3, 1.3])),
            vec![("/atmosphere/heat_capacity_ratio", "must have as many entries as altitude, 3, got 2")],
        ),
        (
            with(&gas, "/atmosphere/heat_capacity_ratio/1", 0.7),
            vec![("/atmosphere/heat_capacity_ratio/1", "must be between 1 and 2, got 0.7")],
        ),
    ] {
        steady.refused_at("/simulate", &case, &faults).await;
    }
}

/// A wind from the west-south-west, by speed and direction, and by its components.
#[tokio::test]
async fn a_wind_from_a_direction_is_one_with_components() {
    let blown_by = |wind: Value| with(&entry(), "/wind", wind);
    let (sin, cos) = 250_f64.to_radians().sin_cos();
    for (from, components) in [
        (
            json!({"type": "constant", "speed": 40, "from": 250}),
            json!({"type": "constant", "east": -40.0 * sin, "north": -40.0 * cos}),
        ),
        // From the north, 0°, it blows to the south.
        (json!({"type": "constant", "speed": 7, "from": 0}), json!({"type": "constant", "east": 0, "north": -7})),
        // What is interpolated is the components: between a wind from the east and one from the west there is none.
        (
            json!({"type": "table", "altitude": [0, 2e4, 6e4], "speed": [30, 30, 0], "from": [90, 270, 0]}),
            json!({"type": "table", "altitude": [0, 2e4, 6e4], "east": [-30, 30, 0], "north": [0, 0, 0]}),
        ),
    ] {
        let case = with(&blown_by(from.clone()), "/echo", true);
        let [answer, expected] = [fly(&case).await, fly(&blown_by(components)).await];
        assert_eq!(answer["case"]["wind"], from, "it is echoed as it is given");
        for quantity in ["longitude", "geocentric_latitude"] {
            let [found, expected] = [&answer, &expected].map(|answer| number(&answer["final_state"][quantity]));
            // Sines of right angles are off by a rounding; 1e-9 degrees are a tenth of a millimetre.
            near(quantity, found, expected, 1e-9);
        }
    }
    let still = fly(&entry()).await;
    let blown = fly(&blown_by(json!({"type": "constant", "speed": 40, "from": 270}))).await;
    let east = |answer: &Value| number(&answer["final_state"]["longitude"]);
    assert!(east(&blown) > east(&still) + 0.01, "a west wind carries to the east");
}

/// An entry in degrees.
fn entry() -> Value {
    let parts = [("/angle_unit", json!("deg")), ("/atmosphere", json!({"type": "us76"}))];
    with(&with_all(&capsule(), parts), "/initial_state/flight_path_angle", -3)
}

#[tokio::test]
async fn a_wind_is_given_in_one_way() {
    let steady = Steady::new().await;
    for (wind, faults) in [
        (json!({"type": "constant"}), vec![("/wind/east", "is required"), ("/wind/north", "is required")]),
        (json!({"type": "constant", "speed": 3}), vec![("/wind/from", "is required")]),
        (json!({"type": "constant", "from": 1}), vec![("/wind/speed", "is required")]),
        (
            json!({"type": "constant", "east": 3, "from": 1}),
            vec![("/wind", "must have east and north, or speed and from")],
        ),
        (
            json!({"type": "constant", "speed": -1, "from": 1}),
            vec![("/wind/speed", "must be between 0 and 10000, got -1")],
        ),
        (
            json!({"type": "table", "altitude": [0, 1], "speed": [1], "from": [0, 1]}),
            vec![("/wind/speed", "must have as many entries as altitude, 2, got 1")],
        ),
    ] {
        steady.refused_at("/simulate", &with(&capsule(), "/wind", wind), &faults).await;
    }
}

/// A flight of hours says that it may be off, unless its error is asked for, or its tolerance is finer.
#[tokio::test]
async fn a_long_flight_is_a_warning_without_verification() {
    let orbit = |time: f64| {
        json!({
            "angle_unit": "rad",
            "atmosphere": {"type": "us76"},
            "vehicle": {"mass": 1000, "reference_area": 5, "aerodynamics": {"type": "constant", "drag_coefficient": 2.2}},
            "initial_state": {"type": "orbital_elements", "semi_major_axis": 6_578_137.0, "eccentricity": 0, "inclination": 0.9,
                "raan": 0, "argument_of_periapsis": 0, "true_anomaly": 0},
            "stop": {"time": time},
            "output": {"trajectory": false},
        })
    };
    let said = |answer: &Value| detail(answer, "long_flight").map(str::to_owned);
    assert_eq!(said(&fly(&orbit(7200.0)).await), None);
    let warned = said(&fly(&orbit(7201.0)).await).unwrap();
    assert_eq!(
        warned,
        "Flight lasts 2.0 hours: at a relative_tolerance of 1e-10 its end may be off by more than 1 m. \
         Set \"verify\": true to get the error"
    );
    let days = orbit(1e6);
    assert!(said(&fly(&days).await).unwrap().starts_with("Flight lasts 2.7 days: "));
    let finer = fly(&with(&days, "/solver", json!({"relative_tolerance": 1e-12}))).await;
    assert_eq!(said(&finer), None);
    let verified = fly(&with(&days, "/verify", true)).await;
    assert_eq!(said(&verified), None);
    assert!(number(&verified["verification"]["distance"]) > 1.0, "the warning was right");
}

/// us76 is a model of -5 to 1000 km.
#[tokio::test]
async fn leaving_us76_is_a_warning() {
    let high = with_all(
        &capsule(),
        [
            ("/atmosphere", json!({"type": "us76"})),
            ("/initial_state/altitude", json!(1.2e6)),
            ("/angle_unit", json!("rad")),
        ],
    );
    let answer = fly(&with(&high, "/stop", json!({"time": 10}))).await;
    assert_eq!(
        detail(&answer, "outside_model"),
        Some(
            "Atmosphere us76 ends at 1000 km: above it the density falls with the scale height at that altitude (from 0 s, at 1200 km)"
        )
    );
}

/// A map takes no notice of columns, those that the case cannot have included.
#[tokio::test]
async fn columns_do_not_matter_to_a_map() {
    let service = Service::new();
    let case = with(&capsule(), "/output", json!({"interval": 100}));
    for format in ["geojson", "kml", "czml"] {
        let path = format!("/simulate?format={format}");
        let plain = service.post(&path, &case).await;
        for columns in [json!(["time"]), json!(["mach", "altitude"])] {
            let answer = service.post(&path, &with(&case, "/output/columns", columns)).await;
            assert_eq!((answer.status.as_u16(), &answer.body), (200, &plain.body));
        }
    }
}

/// The examples of the documents and of the page: thesis, check cases, flights that were flown.
fn examples() -> Vec<(String, Value)> {
    let mut examples: Vec<(String, Value)> = Vec::new();
    for file in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../openapi/examples")).unwrap() {
        let path = file.unwrap().path();
        let mut case = read_json(&path);
        // One is of `/convert`, one of `/analytic`, and some are searches.
        if case.get("state").is_none() && case.get("vary").is_none() {
            case.as_object_mut().unwrap().shift_remove("solution");
            examples.push((path.display().to_string(), case));
        }
    }
    assert!(examples.len() >= 6, "{}", examples.len());
    examples.extend(thesis_cases().into_iter().map(|case| (case.title, case.request)));
    let checks = cases::tree(cases::NESC);
    let numbers = checks["cases"].as_object().unwrap().keys();
    examples.extend(numbers.map(|number| (number.clone(), nesc::request(number, "nasa"))));
    let file = cases::tree(cases::FLIGHTS);
    let flown = file["flights"].as_array().unwrap();
    // As on the page, with rows.
    let request = |flight: &Value| without(&flights::request(&file, flight, &json!(null)), "/output");
    examples.extend(flown.iter().map(|flight| (flight["name"].to_string(), request(flight))));
    examples
}

/// Every example, as every file that the page and the command line make of it.
#[tokio::test]
async fn every_example_downloads_in_every_format() {
    let service = Service::new();
    let examples = examples();
    assert!(examples.len() > 30, "{}", examples.len());
    for (name, case) in examples {
        let planet = case["planet"]["model"].as_str().unwrap_or("earth_wgs84");
        for format in ["json", "csv", "geojson", "kml", "czml"] {
            // Viewers have a globe of the Earth, and those of KML of two others.
            let has_globe = planet.starts_with("earth") || planet == "custom" || format == "kml" && planet == "mars";
            if ["kml", "czml"].contains(&format) && !has_globe {
                continue;
            }
            let answer = service.post(&format!("/simulate?format={format}"), &case).await;
            assert_eq!(answer.status.as_u16(), 200, "{name} as {format}: {}", String::from_utf8_lossy(&answer.body));
            assert!(answer.body.len() > 500, "{name} as {format}");
        }
    }
}

/// Digits that matter, and all of them where fewer would hide why a value is refused.
#[tokio::test]
#[expect(clippy::approx_constant, reason = "a latitude that exceeds its bound in the last digit")]
async fn faults_round_their_numbers_unless_that_hides_them() {
    let steady = Steady::new().await;
    let deg = with(&capsule(), "/angle_unit", "deg");
    let latitude = "/initial_state/geocentric_latitude";
    for (case, pointer, said) in [
        (with(&capsule(), latitude, 1.7), latitude, "must be between -1.5708 and 1.5708, got 1.7 (radians)"),
        (
            with(&capsule(), latitude, 1.570_796_326_8),
            latitude,
            "must be between -1.5707963267948966 and 1.5707963267948966, got 1.5707963268 (radians)",
        ),
        (with(&deg, latitude, 90.000_000_000_1), latitude, "must be between -90 and 90, got 90.0000000001 (degrees)"),
        (with(&deg, latitude, 91.234_567_891), latitude, "must be between -90 and 90, got 91.2346 (degrees)"),
        (with(&capsule(), "/vehicle/mass", -12.345_678_9), "/vehicle/mass", "must be greater than 0, got -12.3457"),
        (
            with(&capsule(), "/initial_state/altitude", -123.456_789),
            "/initial_state",
            "initial altitude is below the stop altitude: -123.457 m is less than 0 m",
        ),
        (
            with(&capsule(), "/output", json!({"times": [1, 1.000_000_001, 1.000_000_000_9]})),
            "/output/times/2",
            "must be greater than the previous entry, 1.000000001, got 1.0000000009",
        ),
    ] {
        steady.refused_at("/simulate", &case, &[(pointer, said)]).await;
    }
}
