//! How the Earth is turned in space: the rotations from celestial frames to the planet-fixed one.
//!
//! All take days (of 86 400 s) of UT1 after 2000 January 1, 12 h. Polar motion is neglected, which is less than 0.6", 18 m at the
//! surface. Precession and nutation go by the same days: they differ from TT by a minute or two, in which they move by less than 2e-4".

use std::f64::consts::{PI, TAU};

use super::{Rotation, about_pole, rotation_about, wrap_to_turn};
use crate::elementary::{asin, atan2, hypot, sin_cos};

/// The years for which [`gcrf_to_planet_fixed`] and [`teme_to_planet_fixed`] are tested.
pub const TESTED_YEARS: std::ops::RangeInclusive<i64> = 1900..=2100;

/// One arc second, rad.
const ARCSECOND: f64 = PI / 648_000.0;
/// Days in a Julian century.
const CENTURY: f64 = 36_525.0;

/// The angle by which the Earth is turned against the celestial intermediate origin of date, in [0, 2π).
///
/// ```text
/// ERA = 2π (0.7790572732640 + 1.00273781191135448 D)
/// ```
///
/// # Reference
/// IERS Conventions (2010), equation 5.15.
pub fn earth_rotation_angle(days: f64) -> f64 {
    // The whole turns of D fall out first, so that the digits of its fraction remain.
    let turns = days.fract() + 0.779_057_273_264_0 + 0.002_737_811_911_354_48 * days;
    wrap_to_turn(TAU * turns.fract())
}

/// Greenwich mean sidereal time of 1982: the angle by which the Earth is turned against the mean equinox of date, in [0, 2π).
///
/// ```text
/// GMST = 67310.54841 s + (876600 h + 8640184.812866 s) T + 0.093104 s T² - 6.2e-6 s T³
/// ```
///
/// with T in centuries of UT1.
///
/// # Reference
/// S. Aoki et al., The new definition of Universal Time, Astronomy and Astrophysics 105 (1982), 359.
pub fn greenwich_mean_sidereal_time(days: f64) -> f64 {
    let t = days / CENTURY;
    // 876600 h a century is a turn a day, of which whole ones fall out.
    let turns = days.fract() + (67_310.548_41 + (8_640_184.812_866 + (0.093_104 - 6.2e-6 * t) * t) * t) / 86_400.0;
    wrap_to_turn(TAU * turns.fract())
}

/// The rotation that takes components in the frame of SGP4 (true equator, mean equinox) to planet-fixed ones.
///
/// ```text
/// r = R₃(GMST) r_TEME
/// ```
///
/// # Reference
/// D. A. Vallado et al., Revisiting Spacetrack Report #3, AIAA 2006-6753, appendix C.
pub fn teme_to_planet_fixed(days: f64) -> Rotation {
    about_pole(greenwich_mean_sidereal_time(days))
}

/// The rotation that takes components in the geocentric celestial reference frame to planet-fixed ones, to 0.05" (1.5 m at the
/// surface) in the [years that are tested](TESTED_YEARS).
///
/// ```text
/// r = R₃(ERA) R₃(-s) R₃(-E) R₂(d) R₃(E) r_GCRF,   X = sin d cos E,   Y = sin d sin E
/// ```
///
/// with the pole X, Y, and with s = -XY/2 + 0.00381" t - 0.07257" t³, in centuries t, for the origin of the angle.
///
/// # Reference
/// IERS Conventions (2010), equations 5.6 to 5.8 and table 5.2d.
pub fn gcrf_to_planet_fixed(days: f64) -> Rotation {
    let (x, y) = celestial_pole(days);
    let t = days / CENTURY;
    let s = (0.003_81 - 0.072_57 * t * t) * t * ARCSECOND - x * y / 2.0;
    let (e, d) = (atan2(y, x), asin(hypot(x, y)));
    let tilt = rotation_about(1, -d);
    about_pole(earth_rotation_angle(days) - s - e) * tilt * about_pole(e)
}

/// Terms of the nutation: multiples of the arguments l, l', F, D and Ω, the coefficient of their sine in X, and of their cosine in Y, ".
const NUTATION: [([f64; 5], f64, f64); 10] = [
    ([0.0, 0.0, 0.0, 0.0, 1.0], -6.844_318, 9.205_236),
    ([0.0, 0.0, 2.0, -2.0, 2.0], -0.523_908, 0.573_033),
    ([0.0, 0.0, 2.0, 0.0, 2.0], -0.090_552, 0.097_847),
    ([0.0, 0.0, 0.0, 0.0, 2.0], 0.082_169, -0.089_618),
    ([0.0, 1.0, 0.0, 0.0, 0.0], 0.058_707, 0.007_387),
    ([1.0, 0.0, 0.0, 0.0, 0.0], 0.028_288, 0.0),
    ([0.0, 1.0, 2.0, -2.0, 2.0], -0.020_558, 0.022_438),
    ([0.0, 0.0, 2.0, 0.0, 1.0], -0.015_407, 0.020_070),
    ([1.0, 0.0, 2.0, 0.0, 2.0], -0.011_992, 0.012_903),
    ([0.0, 1.0, -2.0, 2.0, -2.0], -0.008_585, -0.009_593),
];

/// X and Y, the direction of the celestial intermediate pole in the geocentric celestial reference frame: frame bias, the precession of
/// IAU 2006 and the greatest terms of the nutation of IAU 2000A, of which those below 0.01" are left out.
///
/// ```text
/// X = -0.016617" + 2004.191898" t - 0.4297829" t² - 0.19861834" t³ + Σ aᵢ sin αᵢ + 0.205833" t cos Ω + 0.012814" t cos 2(F-D+Ω)
/// Y = -0.006951" - 0.025896" t - 22.4072747" t² + 0.00190059" t³ + Σ bᵢ cos αᵢ + 0.153042" t sin Ω + 0.011714" t sin 2(F-D+Ω)
/// ```
///
/// # Reference
/// IERS Conventions (2010), equations 5.16 and 5.43 and tables 5.2a and 5.2b.
fn celestial_pole(days: f64) -> (f64, f64) {
    let t = days / CENTURY;
    // Of the Moon and the Sun: the mean anomalies l and l', F = L - Ω, the elongation D, and the Moon's node Ω, in ".
    let arguments = [
        485_868.249_036 + (1_717_915_923.217_8 + 31.8792 * t) * t,
        1_287_104.793_05 + (129_596_581.048_1 - 0.5532 * t) * t,
        335_779.526_232 + (1_739_527_262.847_8 - 12.7512 * t) * t,
        1_072_260.703_69 + (1_602_961_601.209 - 6.3706 * t) * t,
        450_160.398_036 + (-6_962_890.543_1 + 7.4722 * t) * t,
    ];
    let mut x = -0.016_617 + (2_004.191_898 + (-0.429_782_9 - 0.198_618_34 * t) * t) * t;
    let mut y = -0.006_951 + (-0.025_896 + (-22.407_274_7 + 0.001_900_59 * t) * t) * t;
    for (multiples, of_sine, of_cosine) in NUTATION {
        let argument: f64 = multiples.iter().zip(arguments).map(|(multiple, argument)| multiple * argument).sum();
        let (sine, cosine) = sin_cos(argument * ARCSECOND);
        x += of_sine * sine;
        y += of_cosine * cosine;
    }
    let [_, _, f, d, node] = arguments;
    let (sine, cosine) = sin_cos(node * ARCSECOND);
    x += 0.205_833 * t * cosine;
    y += 0.153_042 * t * sine;
    let (sine, cosine) = sin_cos(2.0 * (f - d + node) * ARCSECOND);
    x += 0.012_814 * t * cosine;
    y += 0.011_714 * t * sine;
    (x * ARCSECOND, y * ARCSECOND)
}
