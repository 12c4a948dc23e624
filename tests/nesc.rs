//! The check cases of NASA's Engineering and Safety Center: their conditions, the histories of its simulations, and the flights
//! of the service beside them.

#![expect(clippy::unwrap_used, reason = "the files are part of the tests")]

use std::fmt::Write;
use std::path::Path;

use nalgebra::Vector3;
use serde_json::{Value, json};

use crate::cases::{read_csv, read_json};
use crate::service::Service;

/// The constants of the Earth by which a case is computed: those that NASA gives, and those that its simulations evidently have.
pub const CONSTANTS: [&str; 2] = ["nasa", "wgs_84"];

/// A foot, m: the international one.
pub const FOOT: f64 = 0.3048;

/// Where the sphere is at a whole second.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// m.
    pub geodetic_altitude: f64,
    /// Radians.
    pub longitude: f64,
    /// Radians.
    pub geodetic_latitude: f64,
    /// Planet-fixed, m; simulation 04 does not tell it.
    pub position: Option<Vector3<f64>>,
}

/// The cases, with their constants and sources.
///
/// # Panics
/// When the file is not what it should be.
pub fn cases() -> Value {
    read_json(&Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/nesc/cases.json"))
}

/// The history of a case by one of NASA's simulations.
///
/// # Panics
/// When the file has no such history.
pub fn history(case: &str, simulation: &str) -> Vec<Row> {
    let rows = read_csv("nesc/histories.csv");
    let of_case = rows.iter().filter(|row| row[0] == case && row[1] == simulation);
    let rows: Vec<_> = of_case
        .enumerate()
        .map(|(second, row)| {
            let number = |field: usize| row[field].parse::<f64>().unwrap();
            assert_eq!(row[2], second.to_string());
            Row {
                geodetic_altitude: number(3),
                longitude: number(4).to_radians(),
                geodetic_latitude: number(5).to_radians(),
                position: (!row[6].is_empty()).then(|| Vector3::new(number(6), number(7), number(8))),
            }
        })
        .collect();
    assert_eq!(rows.len(), 31, "case {case} by simulation {simulation}");
    rows
}

/// The request of a case.
pub fn request(case: &str, constants: &str) -> Value {
    let cases = cases();
    let (case, constants) = (&cases["cases"][case], &cases["constants"][constants]);
    let mut request = json!({
        "angle_unit": "deg",
        "planet": cases["planet"],
        "atmosphere": {"type": "us76"},
        "vehicle": cases["vehicle"],
        "initial_state": {"type": "geodetic", "longitude": 0, "geodetic_latitude": 0},
        "stop": {"altitude": -1000, "time": 30},
        "output": {"interval": 1},
    });
    for name in ["gravitational_parameter", "rotation_rate"] {
        request["planet"][name] = constants[name].clone();
    }
    for name in ["geodetic_altitude", "speed", "flight_path_angle", "azimuth"] {
        request["initial_state"][name] = case[name].clone();
    }
    request["vehicle"]["aerodynamics"] = json!({"type": "constant", "drag_coefficient": case["drag_coefficient"]});
    if !case["wind"].is_null() {
        request["wind"] = case["wind"].clone();
    }
    request
}

/// What the service answers to a request, by the second.
///
/// # Panics
/// When it is not a flight of thirty seconds.
pub async fn fly(request: &Value) -> Vec<Row> {
    let answer = Service::new().post("/simulate", request).await.json();
    let columns = &answer["trajectory"];
    let count = columns["time"].as_array().unwrap().len();
    assert_eq!(count, 31, "{}", columns["time"]);
    let row = |second: usize| {
        let number = |name: &str| columns[name][second].as_f64().unwrap();
        assert_eq!(number("time").to_string(), second.to_string(), "a row at each second");
        let (sin_lon, cos_lon) = number("longitude").to_radians().sin_cos();
        let (sin_lat, cos_lat) = number("geocentric_latitude").to_radians().sin_cos();
        let up = Vector3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
        Row {
            geodetic_altitude: number("geodetic_altitude"),
            longitude: number("longitude").to_radians(),
            geodetic_latitude: number("geodetic_latitude").to_radians(),
            position: Some(up * number("radius")),
        }
    };
    (0..count).map(row).collect()
}

/// How far the service is from NASA's simulations at most, over all seconds of the cases of which there are histories.
pub async fn table() -> String {
    let mut table = "| check case | altitude off by, of simulation 04 | of 05 | place off by, of 05 |\n".to_owned();
    table += "| --- | --- | --- | --- |\n";
    for (case, title) in [
        ("01", "1: dropped in air without drag"),
        ("06", "6: dropped, with drag"),
        ("09", "9: thrown upward and to the east at 431 m/s"),
    ] {
        let rows = fly(&request(case, CONSTANTS[0])).await;
        let greatest = |simulation: &str, off: fn(&Row, &Row) -> f64| {
            let history = history(case, simulation);
            rows.iter().zip(&history).map(|(row, theirs)| off(row, theirs)).fold(0.0, f64::max)
        };
        let altitude = |row: &Row, theirs: &Row| (row.geodetic_altitude - theirs.geodetic_altitude).abs();
        let place = |row: &Row, theirs: &Row| match (row.position, theirs.position) {
            (Some(row), Some(theirs)) => (row - theirs).norm(),
            _ => f64::NAN,
        };
        let [fourth, fifth] = ["04", "05"].map(|simulation| greatest(simulation, altitude) * 1e3);
        let place = greatest("05", place) * 1e3;
        let _ = writeln!(table, "| {title} | {fourth:.1} mm | {fifth:.1} mm | {place:.1} mm |");
    }
    table
}
