//! Launches beside closed forms, entries as another program flies them, in the same air and as its author published them, and flights that were
//! flown, beside what was published of them: not all is known that those depend on, and nothing is tuned.

use serde_json::{Map, Value, json};

use super::cases::{self, number, text, tree};
use super::{Check, Expected, Group, Origin, Program};
use crate::error::ApiError;

pub(super) fn checks(program: Program) -> Result<Vec<Check>, ApiError> {
    let closed_forms = of_file(program, Group::Ascents, &tree(cases::CLOSED_FORMS))?;
    let of_another_program = of_file(program, Group::Bodies, &tree(cases::AMAT))?;
    let published = of_file(program, Group::Bodies, &tree(cases::AMAT_PUBLISHED))?;
    let on_earth = of_file(program, Group::Flights, &tree(cases::FLIGHTS))?;
    let elsewhere = of_file(program, Group::Flights, &tree(cases::FLIGHTS_AT_PLANETS))?;
    let launchers = of_file(program, Group::Flights, &tree(cases::LAUNCHERS))?;
    Ok([closed_forms, of_another_program, published, on_earth, elsewhere, launchers].concat())
}

pub(super) fn of_file(program: Program, group: Group, file: &Value) -> Result<Vec<Check>, ApiError> {
    let mut checks = Vec::new();
    for flight in elements(&file["flights"]) {
        let [case, source, note] = ["name", "source", "note"].map(|name| text(&flight[name]));
        let origin = Origin { group, case, source, note };
        let mut flown: Option<(&Value, Value)> = None;
        for published in elements(&flight["published"]) {
            let when = &published["when"];
            // What is published of the same flight is looked up in one answer.
            let answer = match flown.take().filter(|(known, _)| *known == when) {
                Some((_, answer)) => answer,
                None => program.simulate(request(file, flight, when))?,
            };
            let got = number(&answer, published["at"].as_str().unwrap_or_default());
            flown = Some((when, answer));
            let [quantity, unit] = ["quantity", "unit"].map(|name| text(&published[name]));
            let value = number(published, "/value");
            checks.push(if let Some(allowed) = published["allowed"].as_f64() {
                origin.check(quantity, &unit, Expected::within(value, allowed).rounding(0.1 * allowed), got)
            } else {
                let allowed = published["uncertainty"].as_f64();
                origin.beside(quantity, &unit, Expected { value, allowed, rounding: 0.0 }, got)
            });
        }
    }
    Ok(checks)
}

pub(super) fn elements(list: &Value) -> &[Value] {
    list.as_array().map_or(&[], Vec::as_slice)
}

/// The request of a flight: what all have, what the flight has that it is like, and what it has itself. It ends where a condition is met,
/// unless that is null.
pub fn request(file: &Value, flight: &Value, when: &Value) -> Value {
    let like = elements(&file["flights"]).iter().find(|other| other["name"] == flight["like"]);
    let mut request = file["defaults"].clone();
    for part in like.into_iter().chain([flight]) {
        merge(&mut request, &part["request"]);
    }
    if !when.is_null() {
        request["stop"]["when"] = json!([when]);
    }
    request
}

/// A merge patch (RFC 7396): null takes a field away.
pub(super) fn merge(target: &mut Value, patch: &Value) {
    let Value::Object(patch) = patch else {
        *target = patch.clone();
        return;
    };
    if !target.is_object() {
        *target = Value::Object(Map::new());
    }
    for (name, value) in patch {
        if value.is_null() {
            target.as_object_mut().map(|target| target.remove(name));
        } else {
            merge(&mut target[name], value);
        }
    }
}
