//! The check cases of NASA's Engineering and Safety Center, as the program has them, with vectors to reckon with.

use nalgebra::Vector3;
pub use reentry_service::validation::nesc::{CONSTANTS, request};
use reentry_service::validation::nesc::{Second, seconds};
use reentry_service::validation::{
    cases::{NESC, tree},
    nesc,
};
use serde_json::Value;

use crate::service::Service;

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

impl From<Second> for Row {
    fn from(Second { geodetic_altitude, longitude, geodetic_latitude, position }: Second) -> Self {
        Self {
            geodetic_altitude,
            longitude: longitude.to_radians(),
            geodetic_latitude: geodetic_latitude.to_radians(),
            position: position[0].is_finite().then(|| position.into()),
        }
    }
}

/// The cases, with their constants and sources.
pub fn cases() -> Value {
    tree(NESC)
}

/// The history of a case by one of NASA's simulations.
///
/// # Panics
/// When the file has no such history.
pub fn history(case: &str, simulation: &str) -> Vec<Row> {
    thirty(nesc::history(case, simulation))
}

/// What the service answers to a request, by the second.
///
/// # Panics
/// When it is not a flight of thirty seconds.
pub async fn fly(request: &Value) -> Vec<Row> {
    let answer = Service::new().post("/simulate", request).await.json();
    for (second, time) in answer["trajectory"]["time"].as_array().into_iter().flatten().enumerate() {
        assert_eq!(time.to_string(), format!("{second}.0"), "a row at each second");
    }
    thirty(seconds(&answer))
}

fn thirty(seconds: Vec<Second>) -> Vec<Row> {
    assert_eq!(seconds.len(), 31, "thirty seconds and the start");
    seconds.into_iter().map(Row::from).collect()
}
