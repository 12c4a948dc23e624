//! The elementary functions, against numbers of 192 bits.

#![allow(clippy::float_cmp, clippy::cast_precision_loss, reason = "exact values, and estimates")]

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use astro_float::{BigFloat, Consts, RoundingMode};
use reentry::elementary::{exp, ln, sin_cos};

const BITS: usize = 192;
const TO: RoundingMode = RoundingMode::ToEven;

/// A double precision number as it is: by way of a larger one, as the crate does not know subnormal ones.
fn exactly(x: f64) -> BigFloat {
    let mut exact = BigFloat::from_f64(x * 2_f64.powi(if x.abs() < 1.0 { 600 } else { -600 }), BITS);
    if let Some(exponent) = exact.exponent() {
        exact.set_exponent(exponent + if x.abs() < 1.0 { -600 } else { 600 });
    }
    exact
}

/// How far a number is from an exact one, in units of the last place that a double precision number of the exact one's size has.
fn off(number: f64, exact: &BigFloat) -> f64 {
    let difference = exactly(number).sub(exact, BITS, TO);
    let unit = exact.exponent().unwrap_or(0).max(-1021) - 53;
    let Some((words, _, _, exponent, _)) = difference.as_raw_parts() else { return f64::NAN };
    words.last().map_or(0.0, |word| *word as f64 / 2_f64.powi(64) * 2_f64.powi(exponent - unit))
}

/// The farthest that a function is off, and where.
fn farthest(places: impl Iterator<Item = f64>, mut off: impl FnMut(f64) -> f64) -> (f64, f64) {
    places
        .map(|x| (off(x), x))
        .fold((0.0, 0.0), |worst, here| if here.0 > worst.0 || here.0.is_nan() { here } else { worst })
}

/// Places at equal distances.
fn evenly(from: f64, to: f64, count: u32) -> impl Iterator<Item = f64> {
    (0..=count).map(move |index| from + (to - from) * f64::from(index) / f64::from(count))
}

/// Numbers of all sizes from 2 to the power of `from` to 2 to the power of `to`.
fn of_all_sizes(from: i32, to: i32) -> impl Iterator<Item = f64> {
    (from..to).flat_map(|power| [1.0, 1.111_111_111_111, 1.414, 1.9].map(|mantissa| mantissa * 2_f64.powi(power)))
}

/// Doubles around a number, one after another.
fn around(x: f64) -> impl Iterator<Item = f64> {
    (0..200_u64).map(move |index| f64::from_bits(x.to_bits() + index - 100))
}

#[test]
fn the_exponential_is_at_most_one_unit_off() {
    let mut consts = Consts::new().unwrap();
    let mut off = |x: f64| off(exp(x), &exactly(x).exp(BITS, TO, &mut consts));
    let small = of_all_sizes(-60, 0).flat_map(|x| [x, -x]);
    let places =
        evenly(-745.0, 709.7, 8000).chain(evenly(-2.0, 2.0, 8192)).chain(small).chain(around(0.346_573_590_279_972_64));
    let (worst, x) = farthest(places, &mut off);
    assert!(worst <= 1.0, "exp {x:e} is {worst} units off");
    assert_eq!([709.8, 1e300, -746.0, -1e300].map(exp), [f64::INFINITY, f64::INFINITY, 0.0, 0.0]);
    assert!(exp(f64::NAN).is_nan());
}

#[test]
fn the_logarithm_is_at_most_one_unit_off() {
    let mut consts = Consts::new().unwrap();
    let mut off = |x: f64| off(ln(x), &exactly(x).ln(BITS, TO, &mut consts));
    let places = of_all_sizes(-1022, 1024)
        .chain((0..52).map(|power| f64::from_bits(1 << power)))
        .chain(evenly(0.6, 1.6, 8192).filter(|x| *x != 1.0));
    let near_one = around(1.0).filter(|x| *x != 1.0).chain(around(FRAC_1_SQRT_2)).chain(around(SQRT_2));
    let (worst, x) = farthest(places.chain(near_one), &mut off);
    assert!(worst <= 1.0, "ln {x:e} is {worst} units off");
    assert!([-1.0, -f64::MIN_POSITIVE, f64::NEG_INFINITY, f64::NAN].into_iter().all(|x| ln(x).is_nan()));
}

#[test]
fn sine_and_cosine_are_at_most_one_unit_off() {
    let mut consts = Consts::new().unwrap();
    let mut worst_of = |x: f64| {
        let exact = exactly(x);
        let (sine, cosine) = sin_cos(x);
        off(sine, &exact.sin(BITS, TO, &mut consts)).max(off(cosine, &exact.cos(BITS, TO, &mut consts)))
    };
    // The doubles that come nearest to the multiples of π/2 lose the most digits.
    let multiples = (1..=1020).map(|count| f64::from(count) * std::f64::consts::FRAC_PI_2);
    let places =
        evenly(-7.0, 7.0, 8192).chain(evenly(-1600.0, 1600.0, 4001)).chain(multiples).chain(of_all_sizes(-60, 20));
    let (worst, x) = farthest(places, &mut worst_of);
    assert!(worst <= 1.0, "sine or cosine of {x:e} is {worst} units off");
    assert!([f64::INFINITY, f64::NAN].into_iter().all(|x| sin_cos(x).0.is_nan() && sin_cos(x).1.is_nan()));
}
