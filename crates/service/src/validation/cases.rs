//! The reference cases that are built into the program: the files of `tests/cases`, each of which names its source.

use reentry::elementary::sin_cos;
use serde_json::{Value, json};

use crate::wire::json;

/// The cases of the thesis, by its tables.
const THESIS: [&str; 7] = [
    include_str!("../../../../tests/cases/thesis/target_1.json"),
    include_str!("../../../../tests/cases/thesis/target_2.json"),
    include_str!("../../../../tests/cases/thesis/impulse.json"),
    include_str!("../../../../tests/cases/thesis/shallow_glide.json"),
    include_str!("../../../../tests/cases/thesis/steep_glide.json"),
    include_str!("../../../../tests/cases/thesis/steep_ballistic.json"),
    include_str!("../../../../tests/cases/thesis/medium_glide_supercircular.json"),
];

/// The initial conditions that the thesis prints beside those it was given.
pub const CONVERSIONS: &str = include_str!("../../../../tests/cases/thesis/conversions.csv");

/// How far the thesis's theories are from a flight.
pub const THEORIES: &str = include_str!("../../../../tests/cases/thesis/theories.csv");

/// The check cases of NASA's Engineering and Safety Center.
pub const NESC: &str = include_str!("../../../../tests/cases/nesc/cases.json");

/// What NASA's simulations make of them, by the second.
pub const NESC_HISTORIES: &str = include_str!("../../../../tests/cases/nesc/histories.csv");

/// The U.S. Standard Atmosphere, 1976, by geometric altitude.
pub const US76: &str = include_str!("../../../../tests/cases/atmosphere/us76.csv");

/// The U.S. Standard Atmosphere, 1976, by geopotential altitude.
pub const US76_GEOPOTENTIAL: &str = include_str!("../../../../tests/cases/atmosphere/us76_geopotential.csv");

/// Geodetic coordinates and planet-fixed vectors.
pub const GEODETIC: &str = include_str!("../../../../tests/cases/frames/geodetic_ecef.csv");

/// Orbital elements and inertial vectors.
pub const ELEMENTS: &str = include_str!("../../../../tests/cases/frames/classical_elements.csv");

/// The rotation from celestial frames to the planet-fixed one.
pub const EARTH_ROTATION: &str = include_str!("../../../../tests/cases/frames/earth_rotation.csv");

/// Flights that were flown.
pub const FLIGHTS: &str = include_str!("../../../../tests/cases/flights/flights.json");

/// Flights of another program at other planets.
pub const AMAT: &str = include_str!("../../../../tests/cases/bodies/amat.json");

/// Flights and corridors of that program as its author published them.
pub const AMAT_PUBLISHED: &str = include_str!("../../../../tests/cases/flights/amat.json");

/// Depths of corridors, and a load, as Chapman's theory has them.
pub const CHAPMAN: &str = include_str!("../../../../tests/cases/flights/chapman.json");

/// Launches and separations with closed forms.
pub const CLOSED_FORMS: &str = include_str!("../../../../tests/cases/ascents/closed_forms.json");

/// Stages of launchers that were flown.
pub const LAUNCHERS: &str = include_str!("../../../../tests/cases/flights/launchers.json");

/// Flights that were flown at other planets.
pub const FLIGHTS_AT_PLANETS: &str = include_str!("../../../../tests/cases/flights/planets.json");

/// A case of the thesis under one set of planet constants, with the solution of an independent program.
#[derive(Clone, Debug)]
pub struct ThesisCase {
    /// The name of its file, for example `target_2`.
    pub name: String,
    /// What it is, with the table of the thesis.
    pub title: String,
    /// Whose solution it is.
    pub source: String,
    /// `planet.model`.
    pub model: String,
    /// The request of `/simulate`, planet included, at default tolerance.
    pub request: Value,
    /// Its answer: `termination`, `initial_state`, `final_state`, `peaks`, and `samples` in between.
    pub expected: Value,
}

/// The seven cases of the thesis under three sets of constants, by its tables.
pub fn thesis_cases() -> Vec<ThesisCase> {
    THESIS.into_iter().map(tree).flat_map(|file| cases_of(&file)).collect()
}

fn cases_of(file: &Value) -> Vec<ThesisCase> {
    let sets = file["expected"].as_object().into_iter().flatten();
    sets.map(|(model, expected)| {
        let mut request = file["request"].clone();
        request["planet"] = json!({"model": model, "shape": file["shape"]});
        ThesisCase {
            name: text(&file["request"]["name"]),
            title: text(&file["title"]),
            source: text(&file["source"]),
            model: model.clone(),
            request,
            expected: expected.clone(),
        }
    })
    .collect()
}

/// The tree of a file of JSON; null where it is none, of which nothing can be expected.
pub fn tree(text: &str) -> Value {
    json::parse(text.as_bytes()).unwrap_or_default()
}

/// The rows of a table of comma-separated values: fields by the order of the header; lines that begin with # are its source.
pub fn rows(table: &str) -> impl Iterator<Item = Vec<&str>> {
    let lines = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').collect())
}

/// The number at a pointer; not a number where there is none.
pub fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN)
}

/// The number of a field of a table; not a number where it is empty or none.
pub fn parsed(field: &str) -> f64 {
    field.parse().unwrap_or(f64::NAN)
}

/// A text; empty where it is none.
pub fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// The distance, m, between the places of two states of the API in radians; not a number where a field is missing.
pub fn distance(a: &Value, b: &Value) -> f64 {
    let place = |state: &Value| {
        let field = |name: &str| state[name].as_f64().unwrap_or(f64::NAN);
        position(field("radius"), field("longitude"), field("geocentric_latitude"))
    };
    apart(place(a), place(b))
}

/// Planet-fixed, m, from the radius, m, and two angles, rad.
pub fn position(radius: f64, longitude: f64, geocentric_latitude: f64) -> [f64; 3] {
    let (sin_lon, cos_lon) = sin_cos(longitude);
    let (sin_lat, cos_lat) = sin_cos(geocentric_latitude);
    [radius * cos_lat * cos_lon, radius * cos_lat * sin_lon, radius * sin_lat]
}

/// The length of the difference of two vectors.
pub fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
