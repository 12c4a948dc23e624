//! Requests that are JSON, but not of the right structure: every field missing, mistyped and misspelt.

use serde_json::{Value, json};

use super::fields::{Kind, Need, fields};
use super::refusal::Steady;
use super::requests::{ALTERNATIVES, KINDS, capsule, conversion, flight, state, with, with_all, without};

#[tokio::test]
async fn every_missing_field_is_named() {
    let steady = Steady::new().await;
    let fields: Vec<_> = fields().into_iter().filter(|field| field.need == Need::Required).collect();
    assert!(fields.len() > 100, "{} fields", fields.len());
    for field in fields {
        let request = without(&field.request, &field.pointer);
        steady.refused_at(field.path, &request, &[(&field.pointer, "is required")]).await;
    }
}

#[tokio::test]
async fn every_optional_field_may_be_left_out() {
    let steady = Steady::new().await;
    for field in fields().iter().filter(|field| field.need == Need::Optional) {
        let request = without(&field.request, &field.pointer);
        super::refusal::good_answer(&steady.service, field.path, &request).await;
    }
}

#[tokio::test]
async fn every_mistyped_field_is_named_with_what_was_expected_and_what_was_got() {
    let steady = Steady::new().await;
    for field in fields() {
        let mut last = Value::Null;
        for value in field.kind.mistyped() {
            let request = with(&field.request, &field.pointer, value.clone());
            let got = match &value {
                Value::Null => "got null",
                _ => "got ",
            };
            let expected = match field.kind {
                Kind::Number(_) | Kind::NumberOrNull(_) | Kind::Angle(_) | Kind::Command(_) => "must be a number",
                Kind::NumberOrNumbers(_) => "must be a number or an array of numbers",
                Kind::Thrust => "must be \"off\" or an object",
                Kind::Whole => "must be a whole number",
                Kind::Name | Kind::NameOrObject => "must be one of ",
                Kind::Text => "must be a string",
                Kind::Boolean => "must be true or false",
                Kind::BooleanOrObject => "must be true, false or an object with outputs and numbers",
                Kind::False => "must be false",
                Kind::Object => "must be an object",
                Kind::TextOrObject => "must be ",
                Kind::Vector | Kind::Numbers => "must be an array of numbers",
                Kind::Matrix => "must be an array of arrays of numbers",
                Kind::Names => "must be an array of names",
                Kind::Texts => "must be an array of strings",
                Kind::TextOrTexts => "must be a string or an array of strings",
                Kind::Objects => "must be an array of objects",
                Kind::Instant => "must be an RFC 3339 time",
                Kind::SiderealTime => "must be a number of seconds or \"HH:MM:SS.s\"",
            };
            let problem = steady.faults_at(field.path, &request, &[(field.pointer.as_str(), expected)]).await;
            assert!(problem["errors"][0]["detail"].as_str().unwrap().contains(got), "no {got:?} in {problem}");
            last = problem;
        }
        steady.is_as_before(&last).await;
    }
}

#[tokio::test]
async fn every_misspelt_field_is_named() {
    let steady = Steady::new().await;
    for field in fields() {
        let misspelt = format!("{}_", field.pointer);
        let value = field.request.pointer(&field.pointer).unwrap().clone();
        let request = with(&field.request, &misspelt, value);
        steady.refused_at(field.path, &request, &[(&misspelt, "is not a field here")]).await;
    }
}

#[tokio::test]
async fn an_unknown_field_is_told_the_known_ones_once_each() {
    let steady = Steady::new().await;
    for field in fields() {
        let (parent, _) = field.pointer.rsplit_once('/').unwrap();
        let request = with(&field.request, &format!("{parent}/mas"), 13);
        let problem = steady.refused_text(field.path, request.to_string()).await;
        let detail = problem["errors"][0]["detail"].as_str().unwrap();
        let known = detail.strip_prefix("is not a field here; the fields are ").unwrap();
        let mut known: Vec<_> = known.split(", ").collect();
        let count = known.len();
        known.sort_unstable();
        known.dedup();
        assert_eq!(known.len(), count, "{problem}");
    }
}

#[tokio::test]
async fn pointers_escape_the_names_of_unknown_fields() {
    let steady = Steady::new().await;
    for (name, escaped) in [("a/b", "a~1b"), ("a~b", "a~0b"), ("~1", "~01"), ("", ""), (" ", " "), ("µ\"\\", "µ\"\\")]
    {
        let mut request = capsule();
        request["vehicle"][name] = json!(1);
        steady.refused_at("/simulate", &request, &[(&format!("/vehicle/{escaped}"), "is not a field here")]).await;
    }
}

#[tokio::test]
async fn a_request_that_is_no_object_is_refused_at_the_root() {
    let steady = Steady::new().await;
    for request in [json!(null), json!(13), json!("case"), json!([]), json!([capsule()]), json!(true)] {
        for path in ["/simulate", "/convert"] {
            steady.refused_at(path, &request, &[("", "must be an object, got ")]).await;
        }
    }
}

#[tokio::test]
async fn an_empty_request_lacks_only_what_is_required() {
    let steady = Steady::new().await;
    let required = "is required";
    steady.refused_at("/simulate", &json!({}), &[("/vehicle", required), ("/initial_state", required)]).await;
    steady.refused_at("/convert", &json!({}), &[("/state", required)]).await;
}

/// Names of kinds that are nearly right, or belong elsewhere.
const WRONG_NAMES: [&str; 7] = ["", "ECI", "eci ", "constant_", "orbital-elements", "Exponential", "earth"];

#[tokio::test]
async fn an_unknown_name_is_refused_where_it_stands_and_told_the_known_ones() {
    let steady = Steady::new().await;
    let named = fields().into_iter().filter(|field| matches!(field.kind, Kind::Name | Kind::NameOrObject));
    let named: Vec<_> = named.collect();
    for field in &named {
        for name in WRONG_NAMES {
            let request = with(&field.request, &field.pointer, name);
            let phrase = match field.pointer.as_str() {
                "/angle_unit" => "must be one of rad, deg, got ",
                "/planet/model" => {
                    "must be one of earth_wgs84, earth_jameson_listing, earth_jameson_text, jupiter, mars, moon, neptune, saturn, titan, uranus, venus, custom, got "
                }
                "/solution" => "must be one of shallow_glide, loh, steep_glide, steep_ballistic, medium_glide, got ",
                "/planet/shape" => "must be one of sphere, ellipsoid, got ",
                "/planet/gravity/type" => "must be one of inverse_square, zonal, got ",
                "/atmosphere/type" => {
                    "must be one of standard, exponential, us76, nrlmsise00, layered_exponential, table, vacuum, got "
                }
                "/atmosphere/preset" => "must be one of earth_seven_layer, got ",
                "/wind/type" => "must be one of constant, table, got ",
                "/vehicle/aerodynamics/type"
                | "/events/0/then/aerodynamics/type"
                | "/vehicle/parts/1/aerodynamics/type" => {
                    "must be one of constant, ballistic, mach_table, alpha_mach_table, got "
                }
                "/heating/convective" => "must be one of sutton_graves, detra_kemp_riddell, chapman, got ",
                "/heating/convective/type" => "must be one of sutton_graves, got ",
                "/heating/radiative" => "must be one of none, tauber_sutton, craig_lyne, got ",
                "/sensitivities/of/0/quantity"
                | "/limits/0/quantity"
                | "/limits/1/quantity"
                | "/achieve/0/quantity"
                | "/achieve/1/quantity" => "must be one of time, altitude, radius, longitude, ",
                "/sensitivities/of/0/at" | "/limits/0/at" | "/limits/1/at" | "/achieve/0/at" | "/achieve/1/at" => {
                    "must be one of end, start, peak, lowest, got "
                }
                "/sensitivities/of/0/at/side" | "/limits/1/at/side" | "/achieve/1/at/side" => {
                    "must be one of before, after, got "
                }
                "/dispersions/0/offset/type" => "must be one of normal, multivariate_normal, got ",
                "/events/0/when/quantity"
                | "/stop/when/0/quantity"
                | "/events/1/then/separate/0/stop/when/0/quantity" => {
                    "must be one of time, altitude, speed, mach, dynamic_pressure, load_factor, flight_path_angle, mass, "
                }
                "/events/0/then/delta_v/along"
                | "/events/0/then/thrust/along"
                | "/events/1/then/separate/0/push/along" => "must be one of velocity, radial, normal, horizontal, got ",
                "/events/0/then/delta_v/along/frame" | "/events/0/then/thrust/along/frame" => {
                    "must be one of inertial, got "
                }
                "/control/bank_angle/type" => "must be one of schedule, got ",
                "/control/bank_angle/against" => "must be one of time, altitude, speed, mach, energy, got ",
                "/control/bank_angle/interpolation" => "must be one of linear, step, got ",
                "/vehicle/parts/1/engine/thrust/type" => "must be one of table, got ",
                "/control/steering/type" | "/events/1/then/steer/type" => {
                    "must be one of vertical, velocity, program, linear_tangent, got "
                }
                "/control/steering/frame" => "must be one of launch, local, inertial, got ",
                "/initial_state/type" => {
                    "must be one of planet_relative, geodetic, ecef, eci, orbital_elements, inertial_flight_path, launch, got "
                }
                "/output/bodies" => "must be one of full, ends, none, got ",
                "/solver/formulation" => "must be one of cartesian, spherical, got ",
                "/state/frame" | "/initial_state/frame" => "must be one of date, teme, gcrf, got ",
                _ => {
                    "must be one of planet_relative, geodetic, ecef, eci, orbital_elements, inertial_flight_path, got "
                }
            };
            steady.refused_at(field.path, &request, &[(&field.pointer, phrase)]).await;
        }
    }
}

#[tokio::test]
async fn of_alternatives_exactly_one_is_given() {
    let steady = Steady::new().await;
    for (path, request, at) in
        [("/simulate", flight as fn(&str) -> Value, "/initial_state"), ("/convert", conversion, "/state")]
    {
        for (kind, given, other, value) in ALTERNATIVES {
            let none = without(&request(kind), &format!("{at}/{given}"));
            steady.refused_at(path, &none, &[(at, "must have exactly one of ")]).await;
            let both = with(&request(kind), &format!("{at}/{other}"), value);
            steady.refused_at(path, &both, &[(at, "must have exactly one of ")]).await;
        }
        let bare = without(&request("inertial_flight_path"), &format!("{at}/altitude"));
        let bare = without(&bare, &format!("{at}/inertial_heading"));
        let [place, direction] = ["of radius, altitude, got none", "of inertial_heading, inertial_azimuth, got none"];
        steady.refused_at(path, &bare, &[(at, place), (at, direction)]).await;
    }
}

#[tokio::test]
async fn of_the_ways_of_output_exactly_one_is_given() {
    let steady = Steady::new().await;
    let ways = [
        ("samples_per_step", json!(2)),
        ("interval", json!(1)),
        ("count", json!(2)),
        ("times", json!([1])),
        ("trajectory", json!(false)),
    ];
    let phrase = "must have exactly one of samples_per_step, interval, count, times, trajectory, got ";
    let none = with(&capsule(), "/output", json!({}));
    steady.refused_at("/simulate", &none, &[("/output", phrase)]).await;
    for (i, (first, one)) in ways.iter().enumerate() {
        for (second, other) in &ways[i + 1..] {
            let both = with(&capsule(), "/output", json!({*first: one, *second: other}));
            steady.refused_at("/simulate", &both, &[("/output", phrase)]).await;
        }
    }
    let all: Value = ways.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    steady.refused_at("/simulate", &with(&capsule(), "/output", all), &[("/output", phrase)]).await;
}

#[tokio::test]
async fn vectors_have_three_numbers() {
    let steady = Steady::new().await;
    for (path, request, at) in
        [("/simulate", flight as fn(&str) -> Value, "/initial_state"), ("/convert", conversion, "/state")]
    {
        for kind in ["ecef", "eci"] {
            for name in ["position", "velocity"] {
                let at = format!("{at}/{name}");
                for wrong in [json!([]), json!([7e3, 0]), json!([7e3, 0, 0, 0])] {
                    let request = with(&request(kind), &at, wrong);
                    steady.refused_at(path, &request, &[(&at, "must have 3 numbers, got ")]).await;
                }
                for element in [json!("7e6"), json!(null), json!([7e6]), json!({}), json!(true)] {
                    let at = format!("{at}/1");
                    let request = with(&request(kind), &at, element);
                    steady.refused_at(path, &request, &[(&at, "must be a number, got ")]).await;
                }
                let request = with(&request(kind), &at, json!([null, 1, "z"]));
                let expected = [(&*format!("{at}/0"), "got null"), (&*format!("{at}/2"), "got a string")];
                steady.refused_at(path, &request, &expected).await;
            }
        }
    }
}

#[tokio::test]
async fn whole_numbers_have_no_fraction_and_a_least_value() {
    let steady = Steady::new().await;
    for (name, least) in [("samples_per_step", 1), ("count", 2)] {
        let at = format!("/output/{name}");
        for wrong in [json!(least - 1), json!(-1), json!(2.5), json!(-1e300), json!(1e-300)] {
            let request = with_all(&capsule(), [("/output", json!({})), (&at, wrong)]);
            steady.refused_at("/simulate", &request, &[(&at, "must be a whole number of at least")]).await;
        }
        // JSON knows one kind of number: 3.0 is as whole as 3.
        let request = with_all(&capsule(), [("/output", json!({})), (&at, json!(3.0))]);
        super::refusal::good_answer(&steady.service, "/simulate", &request).await;
    }
}

#[tokio::test]
async fn all_faults_of_structure_and_of_bounds_come_in_one_answer() {
    let steady = Steady::new().await;
    let request = json!({
        "nmae": "misspelt",
        "angle_unit": "rad",
        "planet": {"model": "custom", "shape": "cube", "gravitational_parameter": 0, "equatorial_radius": 6.4e6,
            "polar_radius": "6.3e6"},
        "atmosphere": {"type": "exponential", "scale_height": -7000, "density": 1},
        "vehicle": {"mass": -13, "reference_area": null, "aerodynamics": {"type": "constant", "drag": 1}},
        "control": {"bank_angle": 45},
        "initial_state": {"type": "planet_relative", "longitude": 280, "geocentric_latitude": 2, "speed": -1,
            "flight_path_angle": "-0.1", "sidereal_time": "noon"},
        "stop": {"time": 0},
        "output": {"times": [-1, 2, "3"], "count": 1},
        "solver": {"formulation": "polar", "relative_tolerance": 1},
    });
    let expected = [
        ("/nmae", "is not a field here"),
        ("/planet/shape", "must be one of sphere, ellipsoid, got \"cube\""),
        ("/planet/gravitational_parameter", "must be between 1e-6 and 1e25, got 0"),
        ("/planet/polar_radius", "must be a number, got a string"),
        ("/planet/rotation_rate", "is required"),
        ("/atmosphere/scale_height", "must be greater than 0, got -7000"),
        ("/atmosphere/density", "is not a field here"),
        ("/vehicle/mass", "must be greater than 0, got -13"),
        ("/vehicle/reference_area", "must be a number, got null"),
        ("/vehicle/aerodynamics/drag_coefficient", "is required"),
        ("/vehicle/aerodynamics/drag", "is not a field here"),
        ("/control/bank_angle", "for degrees, set"),
        ("/initial_state", "must have exactly one of radius, altitude, got none"),
        ("/initial_state/longitude", "for degrees, set"),
        ("/initial_state/geocentric_latitude", "for degrees, set"),
        ("/initial_state/speed", "must be between 0 and 1000000, got -1"),
        ("/initial_state/flight_path_angle", "must be a number, got a string"),
        ("/initial_state", "must have exactly one of heading, azimuth, got none of them"),
        ("/initial_state/sidereal_time", "\"noon\""),
        ("/stop/time", "must be greater than 0"),
        ("/output", "must have exactly one of"),
        ("/output/times/0", "must be at least 0, got -1"),
        ("/output/times/2", "must be a number, got a string"),
        ("/output/count", "must be a whole number of at least 2, got 1"),
        ("/solver/formulation", "must be one of cartesian, spherical, got \"polar\""),
        ("/solver/relative_tolerance", "must be between"),
    ];
    steady.refused_at("/simulate", &request, &expected).await;
}

#[tokio::test]
async fn the_fields_of_one_kind_are_unknown_to_another() {
    let steady = Steady::new().await;
    for kind in KINDS {
        for other in KINDS.into_iter().filter(|other| *other != kind) {
            let mut request = conversion(kind);
            let own: Vec<_> = state(kind).as_object().unwrap().keys().cloned().collect();
            let foreign = state(other);
            let foreign: Vec<_> = foreign.as_object().unwrap().iter().filter(|(name, _)| !own.contains(name)).collect();
            let Some((name, value)) = foreign.first() else {
                assert_eq!((kind.min(other), kind.max(other)), ("ecef", "eci"), "they alone have the same fields");
                continue;
            };
            request["state"][*name] = (*value).clone();
            let at = format!("/state/{name}");
            steady.refused_at("/convert", &request, &[(&at, "is not a field here")]).await;
        }
    }
}

#[tokio::test]
async fn a_named_planet_takes_no_numbers_of_its_own() {
    let steady = Steady::new().await;
    for model in ["earth_wgs84", "earth_jameson_listing", "earth_jameson_text"] {
        let planet = json!({"model": model, "rotation_rate": 0, "polar_radius": 6.3e6});
        let request = with(&capsule(), "/planet", planet);
        let phrase = "is not a field here";
        let expected = [("/planet/rotation_rate", phrase), ("/planet/polar_radius", phrase)];
        steady.refused_at("/simulate", &request, &expected).await;
    }
}
