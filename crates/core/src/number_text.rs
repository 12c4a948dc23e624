//! Numbers as people read them.

use std::fmt;

/// A number for people: six digits, and all of those before the point; with an exponent where it would be longer than seven digits.
///
/// # Examples
/// ```
/// use reentry::number_text::NumberText;
///
/// assert_eq!(NumberText(109_054.394).to_string(), "109054");
/// assert_eq!(NumberText(1_234_567.8).to_string(), "1234568");
/// assert_eq!(NumberText(1e12).to_string(), "1e12");
/// assert_eq!(NumberText(std::f64::consts::FRAC_PI_2).to_string(), "1.5708");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberText(pub f64);

/// Significant digits of a [`NumberText`] number.
const DIGITS: usize = 6;
/// From here on, and below the other, a number has an exponent.
const LONG: [f64; 2] = [1e7, 1e-4];

impl NumberText {
    /// The number that the text says.
    fn said(self) -> f64 {
        let is_whole = (1e6..LONG[0]).contains(&self.0.abs());
        if is_whole { self.0.round() } else { rounded(self.0, DIGITS) }
    }
}

impl fmt::Display for NumberText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&all_digits(self.said()))
    }
}

/// A number to so many significant digits, one at least.
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// Numbers for people, side by side: [`NumberText`], or with all their digits where rounding would make two of them equal that differ.
///
/// # Examples
/// ```
/// use reentry::number_text::apart;
///
/// assert_eq!(apart([90.0, 91.234_567_8]), ["90", "91.2346"]);
/// assert_eq!(apart([90.0, 90.000_000_001]), ["90", "90.000000001"]);
/// ```
pub fn apart<const N: usize>(numbers: [f64; N]) -> [String; N] {
    let hidden = |(index, number): (usize, &f64)| {
        let equal = |other: f64| same(NumberText(other).said(), NumberText(*number).said()) && !same(other, *number);
        numbers[..index].iter().any(|other| equal(*other))
    };
    let differ = numbers.iter().enumerate().any(hidden);
    numbers.map(|number| if differ { all_digits(number) } else { NumberText(number).to_string() })
}

fn same(one: f64, other: f64) -> bool {
    one.total_cmp(&other).is_eq() || one == 0.0 && other == 0.0
}

fn all_digits(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude.is_nan() {
        "not a number".to_owned()
    } else if magnitude.is_infinite() {
        "more than any number".to_owned()
    } else if magnitude != 0.0 && !(LONG[1]..LONG[0]).contains(&magnitude) {
        format!("{value:e}")
    } else {
        // Without the sign of a zero.
        (value + 0.0).to_string()
    }
}
