//! Numbers for people: as many digits as tell something, and no rounding, which is another on every machine.

use reentry::elementary::{log10, pow};

/// Where there is no number.
pub(super) const NONE: &str = "-";

/// A number down to the digit of a step: 32.268 s for 32.26842 and 0.002.
pub(super) fn down_to(value: f64, step: f64, unit: &str) -> String {
    if value == 0.0 || step == 0.0 {
        return exact(value, unit);
    }
    let [magnitude, last] = [value.abs(), step].map(power);
    let text = if (-4..8).contains(&magnitude) {
        format!("{value:.*}", usize::try_from(-last).unwrap_or(0))
    } else {
        format!("{value:.*e}", usize::try_from(magnitude - last).unwrap_or(0))
    };
    with_unit(&text, unit)
}

/// A number with its own digits.
pub(super) fn exact(value: f64, unit: &str) -> String {
    with_unit(&value.to_string(), unit)
}

/// A number that is told with its own digits, and no more of them than this.
pub(super) fn short(value: f64, digits: usize, unit: &str) -> String {
    let (scale, unit) = prefixed(value, unit);
    // Rounded once, as a text, which is read back to the shortest number of so many digits.
    let rounded: f64 = format!("{:.*e}", digits - 1, value / scale).parse().unwrap_or(value);
    let exponent = power(rounded.abs());
    with_unit(
        &if rounded == 0.0 || (-4..8).contains(&exponent) { rounded.to_string() } else { format!("{rounded:e}") },
        &unit,
    )
}

/// A difference with two digits, or as less than a power of ten where it is no more than rounding.
pub(super) fn difference(value: Option<f64>, rounding: f64, unit: &str) -> String {
    let least = if rounding > 0.0 { pow(10.0, log10(rounding).ceil()) } else { 0.0 };
    match value {
        None => NONE.to_owned(),
        Some(value) if value.abs() < least => format!("< {}", short(least, 1, unit)),
        Some(value) => short(value, 2, unit),
    }
}

/// The exponent of the first digit; some small one of zero, and 0 of what is no number.
#[expect(clippy::cast_possible_truncation, reason = "exponents of numbers are small")]
fn power(value: f64) -> i32 {
    log10(value).floor().clamp(-400.0, 400.0) as i32
}

/// The prefix of the unit with which a number has few digits, and by how much it scales it.
fn prefixed(value: f64, unit: &str) -> (f64, String) {
    // From how much on, less a rounding.
    let scales = [(1e3, 1e3, "k"), (0.099, 1.0, ""), (0.99e-4, 1e-3, "m"), (0.99e-7, 1e-6, "µ"), (0.0, 1e-9, "n")];
    let suited =
        scales.into_iter().find(|(from, ..)| value.abs() >= *from && value != 0.0 && matches!(unit, "m" | "s"));
    suited.map_or((1.0, unit.to_owned()), |(_, scale, prefix)| (scale, format!("{prefix}{unit}")))
}

fn with_unit(number: &str, unit: &str) -> String {
    match unit {
        "" => number.to_owned(),
        "°" => format!("{number}°"),
        _ => format!("{number} {unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_are_compared() {
        for (value, step, unit, text) in [
            (32.268_419, 0.002, "s", "32.268 s"),
            (6_774_382.4, 50.0, "m", "6774382 m"),
            (-1.221_73, 5e-5, "rad", "-1.22173 rad"),
            (0.062_135_6, 1e-5, "°", "0.06214°"),
            (7.823_16e-15, 9.69e-19, "kg/m³", "7.8232e-15 kg/m³"),
            (0.0, 1.0, "", "0"),
            (32.5, 0.0, "g", "32.5 g"),
            (f64::NAN, 1.0, "g", "NaN g"),
            (f64::INFINITY, 1.0, "g", "inf g"),
        ] {
            assert_eq!(down_to(value, step, unit), text);
        }
    }

    #[test]
    fn differences_have_two_digits_and_the_unit_that_suits_them() {
        for (value, unit, text) in [
            (0.000_247_2, "m", "0.25 mm"),
            (-0.43e-3, "m", "-0.43 mm"),
            (63.456e-3, "m", "63 mm"),
            (0.1, "m", "0.1 m"),
            (1676.2, "m", "1.7 km"),
            (-1.2e-8, "s", "-12 ns"),
            (-0.453, "g", "-0.45 g"),
            (-8.42e-19, "kg/m³", "-8.4e-19 kg/m³"),
            (5.64e-6, "°", "5.6e-6°"),
            (9.96, "K", "10 K"),
            (0.0, "m", "0 m"),
        ] {
            assert_eq!(difference(Some(value), 0.0, unit), text);
        }
        assert_eq!(difference(None, 1e-6, "m"), "-");
    }

    #[test]
    fn roundings_are_told_as_less_than_a_power_of_ten() {
        for (value, rounding, unit, text) in [
            (3.55e-9, 1e-4, "m", "< 0.1 mm"),
            (-1.02e-8, 5e-8, "s", "< 0.1 µs"),
            (0.0, 1e-13, "", "< 1e-13"),
            (-2e-16, 1e-13, "", "< 1e-13"),
            (1.1e-4, 1e-4, "m", "0.11 mm"),
        ] {
            assert_eq!(difference(Some(value), rounding, unit), text);
        }
    }
}
