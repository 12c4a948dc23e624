//! The thesis's theories beside its flights: what they neglect is known, and so is how far off they must be.

use serde_json::{Value, json};

use super::cases::{self, ThesisCase, number, parsed};
use super::{Check, Expected, Group, Origin, Program};
use crate::error::ApiError;
use crate::wire::AngleUnit;

/// Rows of a flight: with twenty times as many no deviation is another in the digits that are compared.
const ROWS: usize = 1000;

pub(super) fn checks(program: Program, cases: &[ThesisCase]) -> Result<Vec<Check>, ApiError> {
    let mut checks = Vec::new();
    for ThesisCase { name, title, model, request, .. } in cases {
        let anchors: Vec<_> = cases::rows(cases::THEORIES).filter(|row| row[0] == name).collect();
        let Some([_, solution, ..]) = anchors.first().map(|row| &row[..]) else { continue };
        if model != "earth_jameson_listing" {
            continue;
        }
        let mut request = request.clone();
        request["solution"] = json!(solution);
        request["output"] = json!({"count": ROWS});
        let answer = program.analytic(request)?;
        let origin = Origin {
            group: Group::Theories,
            case: format!("{}, {solution}", super::thesis::named(title)),
            source: "Jameson 2006, chapter V, with its misprints corrected; deviations computed independently of this \
                     program"
                .to_owned(),
            note: "The deviation results from the gravity, rotation or curvature that the theory neglects. Allowed: \
                   half a unit of the last digit given; if only a bound is given, the whole bound."
                .to_owned(),
        };
        for row in &anchors {
            let [_, _, quantity, unit, above, expected, allowed] = row[..] else { continue };
            let expected = Expected::within(parsed(expected), parsed(allowed));
            checks.push(origin.check(quantity, unit, expected, deviation(&answer, unit, parsed(above))));
        }
    }
    Ok(checks)
}

/// By how much the theory is off at most above an altitude, the speed in per cent or the angle in degrees; in metres, where it ends.
fn deviation(answer: &Value, unit: &str, above: f64) -> f64 {
    let column = |pointer: &str| {
        let column = answer.pointer(pointer).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        column.iter().map(|cell| cell.as_f64().unwrap_or(f64::NAN))
    };
    let greatest = |deviations: &mut dyn Iterator<Item = f64>| {
        let high = deviations.zip(column("/simulated/altitude")).filter(|(_, altitude)| *altitude >= above);
        // The greatest of the rows where the theory gives a number.
        high.map(|(off, _)| off.abs()).filter(|off| off.is_finite()).reduce(f64::max).unwrap_or(f64::NAN)
    };
    let speeds = column("/differences/speed").zip(column("/simulated/speed"));
    match unit {
        "%" => greatest(&mut speeds.map(|(off, speed)| 100.0 * off / speed)),
        "°" => AngleUnit::Deg.from_radians(greatest(&mut column("/differences/flight_path_angle"))),
        _ => number(answer, "/valid/to_altitude"),
    }
}
