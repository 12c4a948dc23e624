//! The number densities of the gases above 86 km.

use std::array::from_fn;

use num_dual::Dual64;

use super::{EARTH_RADIUS, GAS_CONSTANT, GRAVITY, MOLECULAR_WEIGHT, TEMPERATURE_AT_86_KM, segment, thermosphere};
use crate::elementary::{exp, ln, pow};

/// `N_A`, 1/kmol (Table 2).
const AVOGADRO: f64 = 6.022_169e26;
/// M of N₂, O, O₂, Ar, He and H, kg/kmol (Table 3).
const WEIGHTS: [f64; 6] = [28.0134, 15.9994, 31.9988, 39.948, 4.0026, 1.007_97];

/// n at 86 km of N₂, O, O₂, Ar and He, 1/m³ (Table 9; helium's exponent of 10 there is a misprint for 14, as its Table VIII shows).
const AT_86_KM: [f64; 5] = [1.129_794e20, 8.6e16, 3.030_898e19, 1.3514e18, 7.5817e14];

/// Where hydrogen begins and where its flux ends, m.
const HYDROGEN: [f64; 2] = [150e3, 500e3];
/// n of hydrogen at 500 km, 1/m³.
const HYDROGEN_AT_500_KM: f64 = 8e10;
/// T₁₁, at 500 km, K (Table 5).
const TEMPERATURE_AT_500_KM: f64 = 999.2356;
/// φ, the flux of hydrogen, 1/(m² s).
const HYDROGEN_FLUX: f64 = 7.2e11;

/// α, a and b of O, O₂, Ar, He and H (Table 6): thermal diffusion, and diffusion D = a (T/273.15)ᵇ/n, m²/s.
const DIFFUSION: [[f64; 3]; 5] = [
    [0.0, 6.986e20, 0.75],
    [0.0, 4.863e20, 0.75],
    [0.0, 4.487e20, 0.87],
    [-0.4, 1.7e21, 0.691],
    [-0.25, 3.305e21, 0.5],
];
/// Q, U and W of O, O₂, Ar and He, in km (Table 7).
const FLUX: [[f64; 3]; 4] = [
    [-5.809_644e-4, 56.903_11, 2.706_240e-5],
    [1.366_212e-4, 86.0, 8.333_333e-5],
    [9.434_079e-5, 86.0, 8.333_333e-5],
    [-2.457_369e-4, 86.0, 6.666_667e-4],
];

/// The integrals from 86 km up to an altitude, of which the number densities are made:
/// of f(Z) + v/(D + K) for N₂, O, O₂, Ar and He (equation 36); of g M/(R* T) for hydrogen, which is τ (equation 40); of
/// φ/D (T/T₁₁)^(1+α) e^τ, 1/m³ (equation 39). The last two begin at 150 km, the last one ends at 500 km.
pub(super) type Integrals = [f64; 7];

/// What the table takes from an altitude: ln ρ and the molecular-scale temperature T M₀/M, with their slopes.
pub(super) struct Point {
    pub(super) log_density: [f64; 2],
    pub(super) molecular_scale_temperature: [f64; 2],
}

/// What all gases have in common at an altitude.
struct Level {
    temperature: f64,
    /// dT/dZ, K/m.
    lapse: f64,
    /// g/(R* T), kmol/(kg m).
    weight: f64,
    /// Whether the air is mixed.
    mixed: bool,
}

impl Level {
    fn at(altitude: f64) -> Self {
        let Dual64 { re: temperature, eps: lapse, .. } = thermosphere(segment(altitude), Dual64::new(altitude, 1.0));
        let weight = gravity(altitude) / (GAS_CONSTANT * temperature);
        Self { temperature, lapse, weight, mixed: altitude < 100e3 }
    }

    /// n of N₂, O, O₂, Ar and He, 1/m³ (equation 36).
    fn heavy_gases(&self, integrals: &Integrals) -> [f64; 5] {
        from_fn(|gas| AT_86_KM[gas] * (TEMPERATURE_AT_86_KM / self.temperature) * exp(-integrals[gas]))
    }

    /// D, m²/s, of O, O₂, Ar, He and H in a background of so many molecules, 1/m³ (equation 8).
    fn diffusion(&self, gas: usize, background: f64) -> f64 {
        let [_, a, b] = DIFFUSION[gas];
        a / background * pow(self.temperature / 273.15, b)
    }

    /// (T/T₁₁)^(1+α) of hydrogen.
    fn hydrogen_ratio(&self) -> f64 {
        pow(self.temperature / TEMPERATURE_AT_500_KM, 1.0 + DIFFUSION[4][0])
    }
}

/// dI/dZ: the integrands at an altitude, m.
pub(super) fn integrands(altitude: f64, integrals: &Integrals) -> Integrals {
    let level = Level::at(altitude);
    let n = level.heavy_gases(integrals);
    let eddies = eddy_diffusion(altitude);
    let mut slopes = [0.0; 7];
    slopes[0] = level.weight * if level.mixed { MOLECULAR_WEIGHT } else { WEIGHTS[0] };
    for gas in 1..5 {
        // O and O₂ diffuse through N₂, argon and helium through these three.
        let background = if gas < 3 { 0..1 } else { 0..3 };
        let number: f64 = n[background.clone()].iter().sum();
        let mass: f64 = background.map(|other| n[other] * WEIGHTS[other]).sum();
        let mean_weight = if level.mixed { MOLECULAR_WEIGHT } else { mass / number };
        let diffusion = level.diffusion(gas - 1, number);
        // f(Z) = g/(R* T) D/(D + K) (M_i + M K/D + α R*/g dT/dZ)   (36)
        let thermal = DIFFUSION[gas - 1][0] * level.lapse / (level.weight * level.temperature);
        let balance = diffusion * (WEIGHTS[gas] + thermal) + mean_weight * eddies;
        slopes[gas] = level.weight * balance / (diffusion + eddies) + flux(altitude, gas - 1);
    }
    if altitude > HYDROGEN[0] {
        slopes[5] = level.weight * WEIGHTS[5];
    }
    if altitude > HYDROGEN[0] && altitude < HYDROGEN[1] {
        let resistance = HYDROGEN_FLUX / level.diffusion(4, n.iter().sum());
        slopes[6] = resistance * level.hydrogen_ratio() * exp(integrals[5]);
    }
    slopes
}

/// The air at an altitude, m, from the integrals there and those at 500 km.
pub(super) fn point(altitude: f64, integrals: &Integrals, at_500_km: &Integrals) -> Point {
    let level = Level::at(altitude);
    let slopes = integrands(altitude, integrals);
    let segment = level.lapse / level.temperature;
    let heavy = level.heavy_gases(integrals);
    let mut gases: [[f64; 2]; 6] = [[0.0; 2]; 6];
    for gas in 0..5 {
        gases[gas] = [heavy[gas], -heavy[gas] * (segment + slopes[gas])];
    }
    if altitude > HYDROGEN[0] {
        // n = (n₁₁ - ∫ from 500 km of φ/D (T/T₁₁)^(1+α) e^τ) (T₁₁/T)^(1+α) e^-τ, with τ = 0 at 500 km   (39)
        let source = HYDROGEN_AT_500_KM * exp(at_500_km[5]) + at_500_km[6] - integrals[6];
        let spread = exp(-integrals[5]) / level.hydrogen_ratio();
        let decay = (1.0 + DIFFUSION[4][0]) * segment + slopes[5];
        gases[5] = [source * spread, -(source * decay + slopes[6]) * spread];
    }
    let sum = |factor: fn(usize) -> f64, part: usize| -> f64 { (0..6).map(|gas| factor(gas) * gases[gas][part]).sum() };
    let [mass, mass_slope] = [0, 1].map(|part| sum(|gas| WEIGHTS[gas], part));
    let [number, number_slope] = [0, 1].map(|part| sum(|_| 1.0, part));
    // p = Σ n k T (33c) = ρ R* T_M/M₀, with R*/N_A for k, which the standard's Table 2 gives 2e-6 larger: it would step p at 86 km.
    let molecular_scale_temperature = level.temperature * (number / mass) * MOLECULAR_WEIGHT;
    let slope = segment + number_slope / number - mass_slope / mass;
    Point {
        log_density: [ln(mass / AVOGADRO), mass_slope / mass],
        molecular_scale_temperature: [molecular_scale_temperature, molecular_scale_temperature * slope],
    }
}

/// g, m/s² (equation 17).
fn gravity(altitude: f64) -> f64 {
    GRAVITY * (EARTH_RADIUS / (EARTH_RADIUS + altitude)).powi(2)
}

/// K, m²/s: 120 up to 95 km, then less, and none from 115 km on (equations 7a to 7c).
fn eddy_diffusion(altitude: f64) -> f64 {
    let height = (altitude - 95e3).max(0.0) / 1000.0;
    if height < 20.0 { 120.0 * exp(1.0 - 400.0 / (400.0 - height * height)) } else { 0.0 }
}

/// v/(D + K), 1/m, of O, O₂, Ar and He (equation 37); from 150 km on less than 1e-7 of what it is added to.
fn flux(altitude: f64, gas: usize) -> f64 {
    let term = |strength: f64, height: f64, width: f64| strength * height.powi(2) * exp(-width * height.powi(3));
    let altitude = altitude / 1000.0;
    let [strength, base, width] = FLUX[gas];
    // Atomic oxygen has a second term, up to 97 km.
    let second = if gas == 0 { term(-3.416_248e-3, (97.0 - altitude).max(0.0), 5.008_765e-4) } else { 0.0 };
    (term(strength, altitude - base, width) + second) / 1000.0
}
