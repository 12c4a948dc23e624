//! The exponential integral Ei, scaled.

use crate::elementary::{exp, ln};

/// Euler's constant (NIST Digital Library of Mathematical Functions, 5.2.3).
const EULER: f64 = 0.577_215_664_901_532_9;

/// From here on the asymptotic expansion has all digits: its least term, that of n ≈ x, is √(2πx) e⁻ˣ = 7e-17 at x = 40.
const ASYMPTOTIC: f64 = 40.0;

/// e⁻ˣ Ei(x) for x > 0: finite where Ei itself overflows, and 1/x in the end.
///
/// ```text
/// Ei(x) = γ + ln x + Σ xⁿ/(n n!),     x < 40
/// Ei(x) ~ (eˣ/x) Σ n!/xⁿ,             x ≥ 40
/// ```
///
/// Accurate to 1e-14 of the greater of the value and e⁻ˣ: the value passes through zero at 0.3725.
///
/// # Reference
/// NIST Digital Library of Mathematical Functions, equations 6.6.1 and 6.12.2.
pub(super) fn scaled_ei(x: f64) -> f64 {
    if x < ASYMPTOTIC { exp(-x) * (EULER + ln(x) + power_series(x)) } else { asymptotic_sum(x) / x }
}

/// Σ xⁿ/(n n!), n from 1.
fn power_series(x: f64) -> f64 {
    let (mut sum, mut power, mut n) = (0.0, 1.0, 1.0);
    loop {
        power *= x / n;
        let term = power / n;
        sum += term;
        // Beyond n = 2x the terms fall by more than a half.
        if n > 2.0 * x && term <= f64::EPSILON * sum {
            return sum;
        }
        n += 1.0;
    }
}

/// Σ n!/xⁿ, n from 0, up to the term that no longer counts or no longer falls.
fn asymptotic_sum(x: f64) -> f64 {
    let (mut sum, mut term, mut n) = (1.0, 1.0, 1.0);
    while n < x && term > f64::EPSILON * sum {
        term *= n / x;
        sum += term;
        n += 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::{ASYMPTOTIC, scaled_ei};

    #[test]
    fn agrees_with_published_tables() {
        let check = |what: &str, value: f64, table: f64| {
            // A unit of the last digit printed: at x = 5 the table is half a unit off.
            assert!((value - table).abs() <= 1e-9, "{what} is {table} in the tables, not {value}");
        };
        // Abramowitz and Stegun, Handbook of Mathematical Functions, table 5.1: Ei(x).
        for (x, ei) in [(0.5, 0.454_219_905), (1.0, 1.895_117_816), (2.0, 4.954_234_356)] {
            check("Ei(x)", f64::exp(x) * scaled_ei(x), ei);
        }
        // The same, table 5.2: x e⁻ˣ Ei(x).
        for (x, ei) in [(2.0, 1.340_965_420), (3.5, 1.471_782_389), (5.0, 1.353_831_278), (10.0, 1.131_470_205)] {
            check("x e⁻ˣ Ei(x)", x * scaled_ei(x), ei);
        }
    }

    #[test]
    fn has_all_its_digits() {
        // x e⁻ˣ Ei(x), summed with 60 digits (DLMF 6.6.1); near the zero at 0.3725 the error counts against e⁻ˣ.
        for (x, value) in [
            (1e-6, -1.323_828_065_477_522e-5),
            (0.1, -0.146_838_175_654_763_03),
            (0.372_5, -7.410_735_109_464_14e-6),
            (3.0, 1.483_729_204_045_923_7),
            (20.0, 1.055_955_905_592_962_6),
            (39.0, 1.027_069_053_487_948_8),
            (41.0, 1.025_676_781_133_385_1),
            (100.0, 1.010_206_252_774_835_7),
        ] {
            let error = (x * scaled_ei(x) - value).abs();
            assert!(error <= 1e-14 * f64::max(x * f64::exp(-x), value.abs()), "x = {x}: {error:e}");
        }
    }

    #[test]
    fn both_expansions_meet() {
        let (below, above) = (scaled_ei(ASYMPTOTIC.next_down()), scaled_ei(ASYMPTOTIC));
        assert!((below / above - 1.0).abs() < 1e-14, "{below} and {above}");
    }

    #[test]
    fn goes_on_to_the_greatest_numbers() {
        assert!((1e300 * scaled_ei(1e300) - 1.0).abs() < 1e-15);
        assert!(scaled_ei(f64::MAX) > 0.0);
        // Not even the series of a tiny number takes long.
        assert!((scaled_ei(1e-300) - (1e-300_f64.ln() + super::EULER)).abs() < 1e-12);
    }
}
