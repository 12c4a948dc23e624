//! Reads single values.

use reentry::scenario::Bound;
use serde_json::{Number, Value};

use crate::wire::AngleUnit;
use crate::wire::shown::quoted;

/// The index of a word among several, or what it is in its place.
pub(super) fn chosen(value: &Value, words: &[&str]) -> Result<usize, String> {
    let word = value.as_str().ok_or_else(|| kind_of(value).to_owned())?;
    words.iter().position(|known| *known == word).ok_or_else(|| quoted(word))
}

/// What is wrong with the length of a list, if it is not between the two.
pub(super) fn wrong_count(count: usize, [least, most]: [usize; 2]) -> Option<String> {
    if count < least {
        let entries = if least == 1 { "entry" } else { "entries" };
        Some(format!("must have at least {least} {entries}, got {count}"))
    } else {
        (count > most).then(|| format!("must have at most {most} entries, got {count}"))
    }
}

/// Reads text.
///
/// # Errors
/// With what is wrong.
pub fn text(value: &Value) -> Result<String, String> {
    value.as_str().map(str::to_owned).ok_or_else(|| format!("must be a string, got {}", kind_of(value)))
}

/// Reads true or false.
///
/// # Errors
/// With what is wrong.
pub fn boolean(value: &Value) -> Result<bool, String> {
    value.as_bool().ok_or_else(|| format!("must be true or false, got {}", kind_of(value)))
}

fn number(value: &Value) -> Result<f64, String> {
    value.as_f64().ok_or_else(|| format!("must be a number, got {}", kind_of(value)))
}

pub(super) fn whole(number: &Number) -> Option<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, and saturating above")]
    let from_float = |float: f64| (float.fract() == 0.0 && float >= 0.0).then_some(float as usize);
    number.as_u64().and_then(|whole| usize::try_from(whole).ok()).or_else(|| number.as_f64().and_then(from_float))
}

pub(super) fn bounded(value: &Value, bound: Bound) -> Result<f64, String> {
    let number = number(value)?;
    if bound.admits(number) { Ok(number) } else { Err(bound.refusal(number)) }
}

pub(super) fn bounded_angle(value: &Value, bound: Bound, unit: Option<AngleUnit>) -> Result<f64, String> {
    match unit {
        None => number(value),
        Some(AngleUnit::Rad) => {
            number(value)?;
            let hint = "for degrees, set \"angle_unit\": \"deg\"";
            bounded(value, bound).map_err(|detail| format!("{detail} (radians); {hint}"))
        }
        Some(AngleUnit::Deg) => {
            number(value)?;
            bounded(value, bound.scaled(1_f64.to_degrees())).map_err(|detail| format!("{detail} (degrees)"))
        }
    }
}

/// What a value is, for messages.
pub fn kind_of(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "a boolean",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "an array",
        Value::Object(_) => "an object",
    }
}
