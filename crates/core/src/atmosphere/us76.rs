//! The U.S. Standard Atmosphere, 1976, from 5 km below sea level to 1000 km: the steady, mean air of the middle latitudes
//! at moderate activity of the Sun, without wind, weather, seasons or humidity.
//!
//! Below 86 km the air is mixed, and density, pressure and temperature are the standard's closed forms in the geopotential
//! altitude H. Above, each gas has its own number density, an integral of its diffusion equation (`us76/gases.rs`).
//! The integrals are taken once, when the first density is asked for, which lasts milliseconds. Polynomials of degree 5 between
//! knots every 250 m below 150 km and every 5 km above give back ln ρ, with its slope, at the knots and half-way:
//! to 2e-9 everywhere, while the printed tables have four digits.
//!
//! # Where the standard leaves a choice
//!
//! - By the printed constants the density is 8e-6 larger on the upper side of 86 km. The density above is made smaller by that,
//!   far less than the half unit of its last printed digit. The pressure still steps by 4e-7 of itself.
//! - Hydrogen, which the standard gives from 150 km on, steps the density there by 3e-7 and the pressure by 7e-6 of itself.
//! - The standard has a speed of sound below 86 km only. Above, it is √(γ R* T/M₀) of the kinetic temperature, as if the air were
//!   still mixed: a unit of speed and no more, which begins 2e-4 of itself lower.
//! - Above 1000 km the density falls on by the scale height that it has there, the mean molecular weight stays, and the temperature
//!   goes on towards 1000 K. Below -5 km the lowest layer continues.
//! - Down from half the Earth's radius and up from 10⁸ m, where only trial stages of an integrator come, the air stays as it is there:
//!   so that everything is a finite positive number everywhere.
//!
//! # Stretches
//!
//! An integrator takes the formula of one segment between [`BOUNDARIES`] at a time, and continues it where a trial stage looks over its
//! end: the layer of mixed air keeps its lapse rate, until the temperature is a tenth of that at its base. The density above 86 km
//! has one formula for all segments; below 86 km, where a trial stage may bring it, its logarithm goes on in a straight line.
//!
//! # Reference
//! U.S. Standard Atmosphere, 1976, NOAA-S/T 76-1562, U.S. Government Printing Office, Washington, D.C., October 1976: "the standard" here.
//! Its equations and tables are cited by number.

mod gases;
mod table;

use super::AtmosphereSample;
use crate::scalar::Scalar;
use table::TABLE;

/// r₀, the Earth's radius that goes with g₀, m (equation 18).
const EARTH_RADIUS: f64 = 6_356_766.0;
/// g₀, m/s² (Table 2).
const GRAVITY: f64 = 9.806_65;
/// R*, J/(kmol K) (Table 2).
const GAS_CONSTANT: f64 = 8314.32;
/// M₀, the mean molecular weight of mixed air, kg/kmol (equation 20).
const MOLECULAR_WEIGHT: f64 = 28.9644;
/// γ, the ratio of specific heats (Table 2).
const HEAT_RATIO: f64 = 1.4;

/// T₇, K (Table 5).
const TEMPERATURE_AT_86_KM: f64 = 186.8673;
/// Z₇, where the mixed air ends, m.
const MIXED_TOP: f64 = 86e3;
/// Where the standard begins, m.
const BOTTOM: f64 = -5e3;
/// Z₁₂, where the standard ends, m.
const TOP: f64 = 1000e3;
/// Above it the density is less than 3e-15 of that at sea level, m, and almost all of it hydrogen and helium.
pub(super) const SENSIBLE_ALTITUDE: f64 = TOP;
/// From here on the air stays as it is, m.
const HIGHEST: f64 = 1e8;
/// Down from here it stays as it is, m, where a formula from higher up is continued.
const LOWEST_OF_TRIALS: f64 = -1e6;
/// The height, m, over which the density falls by e at 110 km, where the temperature begins to rise; it is greater elsewhere.
pub(super) const LEAST_SCALE_HEIGHT: f64 = 5424.0;

/// The geometric altitudes, m, upward, at which the standard begins and ends, and between them at which the density or one of its first
/// three derivatives jumps.
///
/// -5 km; the layers of the mixed air (Table 4), then 86 km; 91, 110 and 120 km, where the temperature changes its formula (Table 5);
/// 95 and 97 km, where eddies begin to weaken and a flux of atomic oxygen ends (equation 37 and its neighbours); 100 km, where the air
/// stops being mixed; 150 and 500 km, between which hydrogen flows upward; 1000 km.
pub const BOUNDARIES: [f64; 17] = [
    BOTTOM,
    geometric(11e3),
    geometric(20e3),
    geometric(32e3),
    geometric(47e3),
    geometric(51e3),
    geometric(71e3),
    MIXED_TOP,
    91e3,
    95e3,
    97e3,
    100e3,
    110e3,
    120e3,
    150e3,
    500e3,
    TOP,
];

/// How many of the [`BOUNDARIES`] lie at or below a geometric altitude, m: the segment in which it is.
#[inline(always)]
pub fn segment<S: Scalar<Mask = bool>>(altitude: S) -> usize {
    BOUNDARIES.iter().filter(|boundary| !altitude.less_than(**boundary)).count()
}

/// Density, kg/m³, at a geometric altitude, m.
#[inline(always)]
pub fn density<S: Scalar<Mask = bool>>(altitude: S) -> S {
    density_in(segment(altitude), altitude)
}

/// The air at a geometric altitude, m.
#[inline(always)]
pub fn sample<S: Scalar<Mask = bool>>(altitude: S) -> AtmosphereSample<S> {
    sample_in(segment(altitude), altitude)
}

/// Density, kg/m³, at a geometric altitude, m, by the formula of a segment.
#[inline(always)]
pub fn density_in<S: Scalar>(segment: usize, altitude: S) -> S {
    let altitude = within_bounds(segment, altitude);
    match TABLE.layers.get(segment) {
        Some(layer) => layer.density(&layer.place(altitude)),
        None => TABLE.density_of_gases(altitude),
    }
}

/// Density, kg/m³, and speed of sound, m/s, at a geometric altitude, m, by the formulas of a segment.
#[inline(always)]
pub fn density_and_sound_in<S: Scalar>(segment: usize, altitude: S) -> (S, S) {
    let altitude = within_bounds(segment, altitude);
    match TABLE.layers.get(segment) {
        Some(layer) => {
            let place = layer.place(altitude);
            (layer.density(&place), speed_of_sound(layer.molecular_scale_temperature(&place)))
        }
        None => (TABLE.density_of_gases(altitude), speed_of_sound(thermosphere(segment, altitude))),
    }
}

/// Density, kg/m³, and pressure, Pa, at a geometric altitude, m, by the formulas of a segment.
#[inline(always)]
pub fn density_and_pressure_in<S: Scalar>(segment: usize, altitude: S) -> (S, S) {
    let altitude = within_bounds(segment, altitude);
    let (density, molecular_scale_temperature) = match TABLE.layers.get(segment) {
        Some(layer) => {
            let place = layer.place(altitude);
            (layer.density(&place), layer.molecular_scale_temperature(&place))
        }
        None => (TABLE.density_of_gases(altitude), TABLE.molecular_scale_temperature_of_gases(altitude)),
    };
    (density, pressure(density, molecular_scale_temperature))
}

/// By the law of gases, Pa (equation 42).
#[inline(always)]
fn pressure<S: Scalar>(density: S, molecular_scale_temperature: S) -> S {
    density * molecular_scale_temperature * (GAS_CONSTANT / MOLECULAR_WEIGHT)
}

/// The air at a geometric altitude, m, by the formulas of a segment.
///
/// ```text
/// p = ρ R* T_M/M₀,  T_M = T M₀/M                   (42, 22)
/// C_s = √(γ R* T_M/M₀)                             (50), above 86 km with T in place of T_M
/// ```
#[inline(always)]
pub fn sample_in<S: Scalar>(segment: usize, altitude: S) -> AtmosphereSample<S> {
    let altitude = within_bounds(segment, altitude);
    let (density, molecular_scale_temperature, temperature, of_sound) = if let Some(layer) = TABLE.layers.get(segment) {
        let place = layer.place(altitude);
        let temperature = layer.molecular_scale_temperature(&place);
        (layer.density(&place), temperature, temperature * weight_ratio(altitude), temperature)
    } else {
        let temperature = thermosphere(segment, altitude);
        let molecular_scale_temperature = TABLE.molecular_scale_temperature_of_gases(altitude);
        (TABLE.density_of_gases(altitude), molecular_scale_temperature, temperature, temperature)
    };
    AtmosphereSample {
        density,
        temperature: Some(temperature),
        pressure: Some(pressure(density, molecular_scale_temperature)),
        speed_of_sound: Some(speed_of_sound(of_sound)),
    }
}

/// γ R*/M₀: the square of the speed of sound in mixed air over its temperature, m²/(s² K).
pub(super) const SOUND_OF_KELVIN: f64 = HEAT_RATIO * GAS_CONSTANT / MOLECULAR_WEIGHT;

/// The speed of sound in mixed air of a temperature, K, in m/s (equation 50).
#[inline(always)]
fn speed_of_sound<S: Scalar>(temperature: S) -> S {
    (temperature * SOUND_OF_KELVIN).sqrt()
}

/// The altitude, m, or the nearest at which the formulas of a segment are still used.
#[inline(always)]
fn within_bounds<S: Scalar>(segment: usize, altitude: S) -> S {
    let lowest = if segment <= 1 { -0.5 * EARTH_RADIUS } else { LOWEST_OF_TRIALS };
    let altitude = S::select(altitude.less_than(lowest), S::from(lowest), altitude);
    S::select(altitude.less_than(HIGHEST), altitude, S::from(HIGHEST))
}

/// The geopotential altitude of a geometric one, m (equation 18).
#[inline(always)]
fn geopotential<S: Scalar>(altitude: S) -> S {
    altitude * (altitude + EARTH_RADIUS).recip() * EARTH_RADIUS
}

/// The geometric altitude of a geopotential one, m (equation 19).
const fn geometric(geopotential: f64) -> f64 {
    EARTH_RADIUS * geopotential / (EARTH_RADIUS - geopotential)
}

/// M/M₀ below 86 km, from 80 km on by the lines between the entries of Table 8.
#[inline(always)]
fn weight_ratio<S: Scalar>(altitude: S) -> S {
    const FIRST: f64 = 80e3;
    const INTERVAL: f64 = 500.0;
    const RATIOS: [f64; 13] = [
        1.0, 0.999_996, 0.999_989, 0.999_971, 0.999_941, 0.999_909, 0.999_870, 0.999_829, 0.999_786, 0.999_741,
        0.999_694, 0.999_641, 0.999_579,
    ];
    let [base, ratio, slope] = altitude.pick(|altitude| {
        let row = table::cell(altitude, FIRST, INTERVAL).min(RATIOS.len() - 2);
        let slope = (RATIOS[row + 1] - RATIOS[row]) / INTERVAL;
        [FIRST + table::offset(row, INTERVAL), RATIOS[row], slope]
    });
    S::select(altitude.less_than(FIRST), S::one(), (altitude - base) * slope + ratio)
}

/// The kinetic temperature above 86 km, K, by the formula of a segment.
///
/// ```text
/// T = T_c + A √(1 - ((Z - Z₈)/a)²)                                  to 110 km, constant below Z₈ = 91 km   (25, 27)
/// T = T₉ + L (Z - Z₉)                                               to 120 km                              (29)
/// T = T∞ - (T∞ - T₁₀) exp(-λ ξ),  ξ = (Z - Z₁₀) (r₀ + Z₁₀)/(r₀ + Z)  above                                 (31)
/// ```
///
/// `T_c`, A and a are those that join the ellipse to its neighbours with its slope (appendix B, equations 5, 8 and 9), to all
/// digits: the printed 263.1905 K, -76.3232 K and 19.9429 km would step the density at 110 km by 1e-6.
/// Above 110 km, where the ellipse ends soon, its tangent continues it; below 86 km nothing gets colder than 100 K.
#[inline(always)]
fn thermosphere<S: Scalar>(segment: usize, altitude: S) -> S {
    const CENTRE: f64 = 263.190_480_022_031_5;
    const WIDTH: f64 = 19_942.874_919_000_1;
    const LAPSE: f64 = 0.012;
    const COLDEST: f64 = 100.0;
    let temperature = match segment {
        ..=12 => {
            let on_ellipse = S::select(altitude.less_than(110e3), altitude, S::from(110e3));
            let into_ellipse = S::select(on_ellipse.less_than(91e3), S::zero(), on_ellipse - 91e3) * (1.0 / WIDTH);
            let ellipse = (-into_ellipse * into_ellipse + 1.0).sqrt() * (TEMPERATURE_AT_86_KM - CENTRE) + CENTRE;
            ellipse + (altitude - on_ellipse) * LAPSE
        }
        13 => (altitude - 110e3) * LAPSE + 240.0,
        _ => {
            let xi = (altitude - 120e3) * (altitude + EARTH_RADIUS).recip() * (EARTH_RADIUS + 120e3);
            (xi * -0.018_75e-3).exp() * -640.0 + 1000.0
        }
    };
    S::select(temperature.less_than(COLDEST), S::from(COLDEST), temperature)
}
