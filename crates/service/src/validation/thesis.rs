//! The thesis: its seven cases under three sets of constants, and the initial conditions that it prints.

use std::f64::consts::TAU;

use serde_json::json;

use super::cases::{self, ThesisCase, distance, number, parsed};
use super::{Check, Expected, Group, Origin, Program, convert};
use crate::error::ApiError;

/// What the promise of the API allows, and what follows from it.
const PROMISE: &str = "Allowed: for the place of impact 1 m, the accuracy that the API promises at its default \
                       tolerance; for the time, the time to travel 1 m at the impact speed; for the deceleration, the \
                       effect of the change of density over 1 m of altitude.";

/// The flights, at the default tolerance.
pub(super) fn flights(program: Program, cases: &[ThesisCase]) -> Result<Vec<Check>, ApiError> {
    let mut checks = Vec::new();
    for case in cases {
        checks.extend(flight(program, case)?);
    }
    Ok(checks)
}

fn flight(program: Program, case: &ThesisCase) -> Result<[Check; 3], ApiError> {
    let ThesisCase { title, source, model, request, expected, .. } = case;
    let scale_height = number(request, "/atmosphere/scale_height");
    let mut request = request.clone();
    request["output"] = json!({"trajectory": false});
    let answer = program.simulate(request)?;
    let [time, speed, peak] =
        ["/final_state/time", "/final_state/speed", "/peaks/deceleration/value"].map(|at| number(expected, at));
    let origin = Origin { group: Group::Thesis, case: named(title), source: source.clone(), note: PROMISE.to_owned() };
    let off = distance(&answer["final_state"], &expected["final_state"]);
    Ok([
        origin.check(format!("place of impact, {model}"), "m", Expected::within(0.0, 1.0), off),
        origin.check(
            format!("time of impact, {model}"),
            "s",
            Expected::within(time, 1.0 / speed),
            number(&answer, "/final_state/time"),
        ),
        origin.check(
            format!("greatest deceleration, {model}"),
            "m/s²",
            Expected::within(peak, peak / scale_height),
            number(&answer, "/peaks/deceleration/value"),
        ),
    ])
}

/// The table of the thesis and the name of the case, of a title such as "Jameson 2006, Table 1: TARGET reference case 1, a fast one".
pub(super) fn named(title: &str) -> String {
    let title = title.trim_start_matches("Jameson 2006, ");
    title.split(',').next().unwrap_or(title).to_owned()
}

/// What the thesis's program made of orbital elements and of inertial vectors.
pub(super) fn conversions(cases: &[ThesisCase]) -> Vec<Check> {
    let mut checks = Vec::new();
    for ThesisCase { name, title, model, request, .. } in cases {
        let printed: Vec<_> = cases::rows(cases::CONVERSIONS).filter(|row| row[0] == name).collect();
        if printed.is_empty() || model != "earth_jameson_listing" {
            continue;
        }
        let state = json!({"planet": request["planet"], "state": request["initial_state"]});
        let answer = convert(state);
        let origin = Origin {
            group: Group::Conversions,
            case: format!("{}, initial state", named(title)),
            source: "Jameson 2006, Tables 1 and 3, the \"corresponding initial conditions\"".to_owned(),
            note: "Allowed: half a unit of the last printed digit.".to_owned(),
        };
        for row in printed {
            let [_, quantity, unit, printed, allowed] = row[..] else { continue };
            let expected = Expected::within(parsed(printed), parsed(allowed));
            let got = number(&answer["planet_relative"], &format!("/{quantity}"));
            let got = if unit == "rad" { around(got, expected.value) } else { got };
            checks.push(origin.check(
                quantity.replace("flight_path", "flight-path").replace('_', " "),
                unit,
                expected,
                got,
            ));
        }
    }
    checks
}

/// The angle, rad, with so many full turns that it comes nearest to another: the thesis prints one turn more.
fn around(angle: f64, other: f64) -> f64 {
    angle + TAU * ((other - angle) / TAU).round()
}
