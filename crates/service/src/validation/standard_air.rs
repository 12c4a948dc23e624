//! The air of `us76` at the points that the U.S. Standard Atmosphere, 1976, prints.

use reentry::elementary::pow;
use serde_json::json;

use super::cases::{self, number, parsed};
use super::{Check, Expected, Group, Origin, Program, nearest};
use crate::error::ApiError;

/// r₀, m, of the standard, by which its geopotential altitudes are geometric ones.
const RADIUS: f64 = 6_356_766.0;
/// R*, J/(kmol K), of the standard.
const GAS_CONSTANT: f64 = 8314.32;

/// What is printed in the columns of the tables, with its unit, the units of the last digit by which a printed number may be off,
/// and the share of it by which it may be off above 86 km.
const COLUMNS: [(&str, &str, f64, f64); 5] = [
    ("temperature", "K", 0.5, 0.0),
    ("pressure", "Pa", 1.0, 6e-5),
    ("density", "kg/m³", 0.5, 6e-5),
    ("speed of sound", "m/s", 0.5, 0.0),
    ("molecular weight", "kg/kmol", 0.5, 6e-5),
];

/// Of each printed quantity the point that comes nearest to its limit.
pub(super) fn checks(program: Program) -> Result<Vec<Check>, ApiError> {
    let geometric = |height: f64| RADIUS * height / (RADIUS - height);
    let mut checks = table(program, "us76 by geometric altitude", cases::US76, |kilometres| 1000.0 * kilometres)?;
    checks.extend(table(program, "us76 by geopotential altitude", cases::US76_GEOPOTENTIAL, geometric)?);
    Ok(checks)
}

fn table(program: Program, case: &str, table: &str, altitude: impl Fn(f64) -> f64) -> Result<Vec<Check>, ApiError> {
    let origin = Origin {
        group: Group::StandardAir,
        case: case.to_owned(),
        source: "U.S. Standard Atmosphere, 1976, NOAA-S/T 76-1562, Tables I to III, from secondary copies".to_owned(),
        note: "The printed point nearest to its limit. Allowed: half a unit of the last printed digit; for pressures, \
               which the report truncates, one unit; above 86 km, in addition 6e-5 of the value, the difference \
               between the report's sums and its integrals."
            .to_owned(),
    };
    let mut points: [Vec<Check>; COLUMNS.len()] = Default::default();
    for row in cases::rows(table) {
        let altitude = altitude(parsed(row[0]));
        let air = air(program, altitude)?;
        for (column, (printed, got)) in
            row[1..].iter().zip(air).enumerate().filter(|(_, (printed, _))| !printed.is_empty())
        {
            let (quantity, unit, last, share) = COLUMNS[column];
            let share = if altitude > 86e3 { share } else { 0.0 };
            let expected = Expected::within(parsed(printed), last * last_digit(printed) + share * parsed(printed));
            points[column].push(origin.check(format!("{quantity} at {:.1} km", altitude / 1e3), unit, expected, got));
        }
    }
    let of_all = |points: Vec<Check>| {
        let count = points.len();
        let nearest = nearest(points)?;
        Some(Check { quantity: format!("{}, of {count} points", nearest.quantity), ..nearest })
    };
    Ok(points.into_iter().filter_map(of_all).collect())
}

/// The columns of the table at an altitude, m: what a flight that starts there at rest answers of its air.
fn air(program: Program, altitude: f64) -> Result<[f64; COLUMNS.len()], ApiError> {
    let answer = program.simulate(json!({
        "planet": {"shape": "sphere"},
        "atmosphere": {"type": "us76"},
        "vehicle": {"mass": 1, "reference_area": 1, "aerodynamics": {"type": "constant", "drag_coefficient": 0}},
        "initial_state": {"type": "planet_relative", "altitude": altitude, "longitude": 0, "geocentric_latitude": 0, "speed": 0,
            "flight_path_angle": 0, "heading": 0},
        "stop": {"altitude": -1000, "time": 1e-3},
        "output": {"trajectory": false},
    }))?;
    let [temperature, pressure, density, speed_of_sound] = ["temperature", "pressure", "density", "speed_of_sound"]
        .map(|name| number(&answer["initial_state"], &format!("/{name}")));
    Ok([temperature, pressure, density, speed_of_sound, density / pressure * GAS_CONSTANT * temperature])
}

/// One unit of the last digit of a printed number.
fn last_digit(printed: &str) -> f64 {
    let (mantissa, exponent) = printed.split_once('e').unwrap_or((printed, "0"));
    let decimals = mantissa.split_once('.').map_or("", |(_, decimals)| decimals).chars().map(|_| 0.1).product::<f64>();
    decimals * pow(10.0, parsed(exponent))
}
