//! What heating adds to an answer: columns, peaks and warnings, from the correlation that was asked for.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::refusal::good_answer;
use super::requests::{capsule, with, with_all};
use super::simulate::{COLUMNS, codes, fly, names};

/// σ, W/(m² K⁴). CODATA 2018.
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// m.
const NOSE_RADIUS: f64 = 2.0;

const FLUXES: [&str; 4] = ["convective_heat_flux", "radiative_heat_flux", "heat_load", "wall_temperature"];

/// The capsule comes back from the Moon, with heating.
fn heated(heating: Value) -> Value {
    with_all(
        &capsule(),
        [
            ("/atmosphere", json!({"type": "us76"})),
            ("/initial_state/speed", json!(11_000)),
            ("/initial_state/flight_path_angle", json!(-0.12)),
            ("/vehicle/nose_radius", json!(NOSE_RADIUS)),
            ("/heating", heating),
        ],
    )
}

fn column(answer: &Value, name: &str) -> Vec<f64> {
    answer["trajectory"][name].as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[tokio::test]
async fn a_heated_flight_has_columns_and_peaks_of_its_own() {
    let answer = fly(&heated(json!({"radiative": "tauber_sutton"}))).await;
    for place in ["initial_state", "final_state", "trajectory"] {
        let own: Vec<_> = names(&answer[place]).into_iter().filter(|name| FLUXES.contains(name)).collect();
        assert_eq!(own, FLUXES, "{place}");
    }
    let peaks = ["convective_heat_flux", "radiative_heat_flux", "heat_flux", "heat_load", "wall_temperature"];
    assert_eq!(names(&answer["peaks"])[6..], peaks);
    for name in ["convective_heat_flux", "radiative_heat_flux", "wall_temperature"] {
        let peak = number(&answer["peaks"][name]["value"]);
        let greatest = column(&answer, name).into_iter().fold(0.0, f64::max);
        // Four rows a step come within a hundredth of a peak, and never above it.
        assert!(peak >= greatest && greatest > 0.99 * peak, "{name}: {peak} and {greatest}");
    }
    let load = column(&answer, "heat_load");
    assert_eq!(load[0].to_bits(), 0.0_f64.to_bits());
    assert!(load.windows(2).all(|pair| pair[0] <= pair[1]), "the heat load falls");
    let end = &answer["final_state"];
    assert_eq!(
        answer["peaks"]["heat_load"],
        json!({"value": end["heat_load"], "time": end["time"], "altitude": end["altitude"]})
    );
    let both = column(&answer, "convective_heat_flux").into_iter().zip(column(&answer, "radiative_heat_flux"));
    let greatest = both.map(|(convective, radiative)| convective + radiative).fold(0.0, f64::max);
    let peak = number(&answer["peaks"]["heat_flux"]["value"]);
    assert!(peak >= greatest && greatest > 0.99 * peak, "{peak} and {greatest}");
}

#[tokio::test]
async fn without_heating_there_is_no_trace_of_it() {
    let answer = fly(&with(&capsule(), "/vehicle/nose_radius", 2)).await;
    for name in FLUXES {
        assert!(answer["initial_state"].get(name).is_none() && answer["peaks"].get(name).is_none(), "{name}");
    }
    assert!(answer["peaks"].get("heat_flux").is_none());
}

/// Every row is the correlation of its own density and speed relative to the air, as the guide prints it, and its wall radiates that.
#[tokio::test]
async fn each_row_has_the_flux_of_the_correlation_that_was_asked_for() {
    type Flux = fn(f64, f64) -> f64;
    let sutton_graves: Flux = |density, speed| 1.7415e-4 * (density / NOSE_RADIUS).sqrt() * speed.powi(3);
    let detra: Flux =
        |density, speed| 1.1035e8 / NOSE_RADIUS.sqrt() * (density / 1.225).sqrt() * (speed / 7924.8).powf(3.15);
    let chapman: Flux =
        |density, speed| 1.1035e8 / NOSE_RADIUS.sqrt() * (density / 1.225).sqrt() * (speed / 7924.8).powi(3);
    // Roundings; the constant of the last two is printed to five digits.
    for (convective, formula, tolerance) in
        [("sutton_graves", sutton_graves, 1e-13), ("detra_kemp_riddell", detra, 2e-5), ("chapman", chapman, 2e-5)]
    {
        let case = with(
            &heated(json!({"convective": convective, "emissivity": 0.7})),
            "/wind",
            json!({"type": "constant", "east": 100, "north": 0}),
        );
        let answer = fly(&case).await;
        let [density, speed, flux, radiative, wall] =
            ["density", "air_speed", "convective_heat_flux", "radiative_heat_flux", "wall_temperature"]
                .map(|name| column(&answer, name));
        for row in 0..density.len() {
            check::relative(convective, flux[row], formula(density[row], speed[row]), tolerance);
            assert_eq!(radiative[row].to_bits(), 0.0_f64.to_bits(), "no radiation was asked for");
            // Roundings of two roots and a fourth power.
            check::relative("wall", 0.7 * STEFAN_BOLTZMANN * wall[row].powi(4), flux[row], 1e-13);
        }
    }
}

#[tokio::test]
async fn heating_is_echoed_with_its_defaults() {
    let answer = fly(&with(&heated(json!({})), "/echo", true)).await;
    let defaults = json!({"convective": "sutton_graves", "radiative": "none", "emissivity": 0.85});
    assert_eq!(answer["case"]["heating"], defaults);
    let named = fly(&heated(defaults)).await;
    assert_eq!(named["peaks"], answer["peaks"]);
    assert_eq!(fly(&with(&capsule(), "/echo", true)).await["case"].get("heating"), None);
}

#[tokio::test]
async fn columns_of_heating_come_as_json_as_csv_and_alone() {
    let service = Service::new();
    let all = heated(json!({"radiative": "tauber_sutton"}));
    let chosen = json!({"count": 9, "columns": ["heat_load", "time", "wall_temperature"]});
    for (output, columns) in [
        (chosen, vec!["heat_load", "time", "wall_temperature"]),
        (
            json!({"count": 9}),
            [
                &COLUMNS[..16],
                &["temperature", "pressure", "speed_of_sound", "mach"],
                &COLUMNS[16..23],
                &FLUXES,
                &COLUMNS[23..],
            ]
            .concat(),
        ),
    ] {
        let case = with(&all, "/output", output);
        let answer = good_answer(&service, "/simulate", &case).await;
        assert_eq!(names(&answer["trajectory"]), columns);
        let csv = service.post("/simulate?format=csv", &case).await;
        let csv = String::from_utf8(csv.body.to_vec()).unwrap();
        let lines: Vec<Vec<_>> = csv.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!((lines.len(), lines[0].clone()), (10, columns.clone()));
        for (row, line) in lines[1..].iter().enumerate() {
            let written: Vec<_> = columns.iter().map(|name| answer["trajectory"][*name][row].to_string()).collect();
            assert_eq!(*line, written);
        }
    }
}

#[tokio::test]
async fn a_peak_outside_the_range_of_its_correlation_is_warned_of() {
    let within = heated(json!({"convective": "sutton_graves", "radiative": "tauber_sutton"}));
    assert_eq!(codes(&fly(&with(&within, "/initial_state/speed", 12_000)).await), Vec::<&str>::new());
    let beyond = heated(json!({"convective": "detra_kemp_riddell", "radiative": "tauber_sutton"}));
    let answer = fly(&with(&beyond, "/vehicle/nose_radius", 5)).await;
    assert_eq!(codes(&answer), ["outside_range", "outside_range"]);
    let [of_radiation, of_convection] = [0, 1].map(|index| &answer["warnings"][index]);
    for (warning, peak, says) in [
        (
            of_radiation,
            "radiative_heat_flux",
            "Relation of Tauber and Sutton is made for a nose radius from 0.3 to 3 m: at its peak heat flux it is 5 m (at ",
        ),
        (
            of_convection,
            "convective_heat_flux",
            "Relation of Detra, Kemp and Riddell is made for a speed relative to the air from 0 to 8000 m/s: at its peak heat flux it is ",
        ),
    ] {
        assert!(warning["detail"].as_str().unwrap().starts_with(says), "{warning}");
        assert_eq!(warning["time"], answer["peaks"][peak]["time"]);
    }
}
