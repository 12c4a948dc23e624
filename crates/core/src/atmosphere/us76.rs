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
/// Z₁₂, where the standard ends, m.
const TOP: f64 = 1000e3;

/// The geometric altitudes, m, upward, at which the density or one of its first three derivatives jumps.
///
/// The layers of the mixed air (Table 4), then 86 km; 91, 110 and 120 km, where the temperature changes its formula (Table 5);
/// 95 and 97 km, where eddies begin to weaken and a flux of atomic oxygen ends (equation 37 and its neighbours); 100 km, where the air
/// stops being mixed; 150 and 500 km, between which hydrogen flows upward; 1000 km.
pub const BOUNDARIES: [f64; 16] = [
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

/// Density, kg/m³, at a geometric altitude, m.
#[inline(always)]
pub fn density<S: Scalar>(altitude: S) -> S {
    Place::of(altitude).density()
}

/// The air at a geometric altitude, m.
///
/// ```text
/// p = ρ R* T_M/M₀,  T_M = T M₀/M                   (42, 22)
/// C_s = √(γ R* T_M/M₀)                             (50), above 86 km with T in place of T_M
/// ```
#[inline(always)]
pub fn sample<S: Scalar>(altitude: S) -> AtmosphereSample<S> {
    let place = Place::of(altitude);
    let density = place.density();
    let molecular_scale_temperature = place.molecular_scale_temperature();
    let mixed = place.altitude.less_than(MIXED_TOP);
    let in_mixed_air = molecular_scale_temperature * weight_ratio(place.altitude);
    let temperature = S::select(mixed, in_mixed_air, thermosphere(place.altitude));
    let of_sound = S::select(mixed, molecular_scale_temperature, temperature);
    AtmosphereSample {
        density,
        temperature: Some(temperature),
        pressure: Some(density * molecular_scale_temperature * (GAS_CONSTANT / MOLECULAR_WEIGHT)),
        speed_of_sound: Some((of_sound * (HEAT_RATIO * GAS_CONSTANT / MOLECULAR_WEIGHT)).sqrt()),
    }
}

/// An altitude, and its abscissa in the table.
struct Place<S> {
    /// Z, m, within the bounds of the model.
    altitude: S,
    /// H below 86 km, Z above, m.
    abscissa: S,
}

impl<S: Scalar> Place<S> {
    #[inline(always)]
    fn of(altitude: S) -> Self {
        let (lowest, highest) = (-0.5 * EARTH_RADIUS, 1e8);
        let altitude = S::select(altitude.less_than(lowest), S::from(lowest), altitude);
        let altitude = S::select(altitude.less_than(highest), altitude, S::from(highest));
        Self { altitude, abscissa: S::select(altitude.less_than(MIXED_TOP), geopotential(altitude), altitude) }
    }

    #[inline(always)]
    fn density(&self) -> S {
        let table = &*TABLE;
        let [base, power, growth, c0, c1, c2, c3, c4, c5] = self.abscissa.pick(|abscissa| table.log_density(abscissa));
        let x = self.abscissa - base;
        ((growth * x + 1.0).ln() * power + polynomial(x, [c0, c1, c2, c3, c4, c5])).exp()
    }

    #[inline(always)]
    fn molecular_scale_temperature(&self) -> S {
        let table = &*TABLE;
        let [base, c0, c1, c2, c3, c4, c5] = self.abscissa.pick(|abscissa| table.temperature(abscissa));
        polynomial(self.abscissa - base, [c0, c1, c2, c3, c4, c5])
    }
}

/// c₀ + c₁x + … + c₅x⁵, in pairs, which do not wait for each other.
#[inline(always)]
fn polynomial<S: Scalar>(x: S, [c0, c1, c2, c3, c4, c5]: [S; 6]) -> S {
    let square = x * x;
    (c5 * x + c4) * (square * square) + ((c3 * x + c2) * square + (c1 * x + c0))
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

/// The kinetic temperature above 86 km, K.
///
/// ```text
/// T = T_c + A √(1 - ((Z - Z₈)/a)²)                                  to 110 km, constant below Z₈ = 91 km   (25, 27)
/// T = T₉ + L (Z - Z₉)                                               to 120 km                              (29)
/// T = T∞ - (T∞ - T₁₀) exp(-λ ξ),  ξ = (Z - Z₁₀) (r₀ + Z₁₀)/(r₀ + Z)  above                                 (31)
/// ```
///
/// `T_c`, A and a are those that join the ellipse to its neighbours with its slope (appendix B, equations 5, 8 and 9), to all
/// digits: the printed 263.1905 K, -76.3232 K and 19.9429 km would step the density at 110 km by 1e-6.
#[inline(always)]
fn thermosphere<S: Scalar>(altitude: S) -> S {
    const CENTRE: f64 = 263.190_480_022_031_5;
    const WIDTH: f64 = 19_942.874_919_000_1;
    let into_ellipse = S::select(altitude.less_than(91e3), S::zero(), altitude - 91e3) * (1.0 / WIDTH);
    let ellipse = (-into_ellipse * into_ellipse + 1.0).sqrt() * (TEMPERATURE_AT_86_KM - CENTRE) + CENTRE;
    let line = (altitude - 110e3) * 0.012 + 240.0;
    let xi = (altitude - 120e3) * (altitude + EARTH_RADIUS).recip() * (EARTH_RADIUS + 120e3);
    let exponential = (xi * -0.018_75e-3).exp() * -640.0 + 1000.0;
    let above_110 = S::select(altitude.less_than(120e3), line, exponential);
    S::select(altitude.less_than(110e3), ellipse, above_110)
}
