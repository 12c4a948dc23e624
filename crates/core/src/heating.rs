//! Heating of the stagnation point of a blunt nose: correlations of the heat flux with density, speed and nose radius.
//!
//! All are of the Earth's air in equilibrium, but [`sutton_graves`] with the constant of another gas, [`tauber_sutton_mars`] and
//! [`craig_lyne`]; of a laminar continuum, and of a wall that is cold, and fully catalytic: in free-molecular flow, above some 90 km, they give too much, which hardly matters to the heat load; a hot wall takes less than they say, by
//! the ratio of the enthalpies. The heat load is the integral of both fluxes; the wall temperature is that at which a wall radiates as
//! much as it gets, and knows no conduction.
//!
//! Jameson 2006 proposes Vinh's relation in its last chapter (Vinh, Busemann and Culp, Hypersonic and Planetary Entry Flight Mechanics,
//! 1980, pages 141 to 156): stagnation heating as √ρ V³, which is [`sutton_graves`] and [`chapman`] without their constants. In the variables of
//! the thesis, with `η = ρSC_D/(2mβ)`, the flux of a ballistic entry is in proportion to √η V³ and greatest where η = |sin γ|/6 and
//! `V = e^(-1/6) V_e`; the tests hold the flights to that.

use crate::elementary::{ln, pow};
use crate::scalar::Scalar;

/// Which correlations give the heat flux, and how the wall radiates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heating {
    /// The flux by convection.
    pub convective: Convective,
    /// The flux by radiation of the shocked air.
    pub radiative: Radiative,
    /// Of the wall, from 0 to 1.
    pub emissivity: f64,
}

/// Sutton and Graves's convection in air, no radiation, and the emissivity of a wall that is meant to radiate.
impl Default for Heating {
    fn default() -> Self {
        Self { convective: Convective::SUTTON_GRAVES, radiative: Radiative::None, emissivity: 0.85 }
    }
}

/// Correlations of the convective flux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Convective {
    /// [`sutton_graves`].
    SuttonGraves {
        /// k, √kg/m; of air [`SUTTON_GRAVES_AIR`].
        constant: f64,
    },
    /// [`detra_kemp_riddell`].
    DetraKempRiddell,
    /// [`chapman`].
    Chapman,
}

/// Correlations of the radiative flux.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Radiative {
    /// No radiation.
    None,
    /// [`tauber_sutton`], in the Earth's air.
    TauberSutton,
    /// [`tauber_sutton_mars`].
    TauberSuttonMars,
    /// [`craig_lyne`], in the air of Venus.
    CraigLyne,
}

/// The heat fluxes into the stagnation point, W/m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatFlux<S> {
    /// By convection.
    pub convective: S,
    /// By radiation.
    pub radiative: S,
}

impl<S: Scalar> HeatFlux<S> {
    /// Both together.
    #[inline(always)]
    pub fn total(&self) -> S {
        self.convective + self.radiative
    }
}

/// The heating of a nose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stagnation {
    /// By which correlations.
    pub heating: Heating,
    /// m.
    pub nose_radius: f64,
    /// Its logarithm, which the radiation wants at every instant.
    ln_nose_radius: f64,
}

impl Stagnation {
    /// The heating of a nose of a radius, m.
    pub fn new(heating: Heating, nose_radius: f64) -> Self {
        Self { heating, nose_radius, ln_nose_radius: ln(nose_radius) }
    }

    /// The fluxes in air of a density, kg/m³, at a speed relative to it, m/s, by the formula of a segment of
    /// [`boundaries`](Self::boundaries).
    #[inline(always)]
    pub fn heat_flux<S: Scalar>(&self, segment: usize, density: S, air_speed: S) -> HeatFlux<S> {
        let convective = match self.heating.convective {
            Convective::SuttonGraves { constant } => sutton_graves(constant, density, air_speed, self.nose_radius),
            Convective::DetraKempRiddell => detra_kemp_riddell(density, air_speed, self.nose_radius),
            Convective::Chapman => chapman(density, air_speed, self.nose_radius),
        };
        let radiative = match self.heating.radiative {
            Radiative::None => S::zero(),
            Radiative::TauberSutton => radiation(segment, density, air_speed, [self.nose_radius, self.ln_nose_radius]),
            Radiative::TauberSuttonMars => tauber_sutton_mars(segment, density, air_speed, self.nose_radius),
            Radiative::CraigLyne => craig_lyne(segment, density, air_speed, self.nose_radius),
        };
        HeatFlux { convective, radiative }
    }

    /// The speeds relative to the air, m/s, ascending, at which the formula of the flux changes.
    pub fn boundaries(&self) -> &'static [f64] {
        match self.heating.radiative {
            Radiative::None => &[],
            Radiative::TauberSutton => &TAUBER_SUTTON_SPEED,
            Radiative::TauberSuttonMars => &TAUBER_SUTTON_MARS_SPEED,
            Radiative::CraigLyne => &CRAIG_LYNE_SPEED,
        }
    }

    /// The temperature, K, at which the wall radiates a flux, W/m².
    ///
    /// ```text
    /// q̇ = ε σ T⁴
    /// ```
    pub fn wall_temperature<S: Scalar>(&self, heat_flux: S) -> S {
        // Root by root: of the smallest emissivities there are, the product with σ is 0.
        (heat_flux / STEFAN_BOLTZMANN).sqrt().sqrt() / self.heating.emissivity.sqrt().sqrt()
    }
}

/// σ, W/(m² K⁴). CODATA 2018.
pub const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// k of air in [`sutton_graves`], √kg/m.
pub const SUTTON_GRAVES_AIR: f64 = 1.7415e-4;

/// The convective flux by Sutton and Graves, W/m².
///
/// ```text
/// q̇ = k √(ρ/r_n) V³,   in air k = 1.7415e-4 √kg/m
/// ```
///
/// | symbol | argument      | unit  |
/// |--------|---------------|-------|
/// | k      | `constant`    | √kg/m |
/// | ρ      | `density`     | kg/m³ |
/// | V      | `speed`       | m/s   |
/// | `r_n`  | `nose_radius` | m     |
///
/// The report has `K √(p_s/r_n) (h_s - h_w)`, with K = 0.1113 kg/(s m^1.5 atm^0.5) for air; with `p_s` = ρV², `h_s` = V²/2 and a cold wall
/// that makes 1.748e-4, of which 1.7415e-4 is the customary rounding. Other gases have other constants in its table II. Its average error against the solutions behind it is 3.3 %.
/// Valid for stagnation enthalpies from 2.3 to 116.2 MJ/kg and pressures from 0.001 to 100 atm ([`Range`]).
///
/// # Reference
/// K. Sutton and R. A. Graves, A General Stagnation-Point Convective-Heating Equation for Arbitrary Gas Mixtures, NASA TR R-376, 1971,
/// equation 33 and table II; 1.7415e-4 as in NASA's Thermal and Fluids Analysis Workshop, Aerothermodynamics course, 2012.
///
/// # Examples
/// ```
/// // The course's own example: 13.6 W/cm².
/// use reentry::heating::{SUTTON_GRAVES_AIR, sutton_graves};
///
/// let flux = sutton_graves(SUTTON_GRAVES_AIR, 3.1459e-4_f64, 3535.0, 1.0);
/// assert!((flux - 13.6e4).abs() < 0.05e4);
/// ```
#[inline(always)]
pub fn sutton_graves<S: Scalar>(constant: f64, density: S, speed: S, nose_radius: f64) -> S {
    (density / nose_radius).sqrt() * (speed * speed * speed) * constant
}

/// The convective flux by Detra, Kemp and Riddell, W/m².
///
/// ```text
/// q̇ = C/√r_n √(ρ/ρ₀) (V/V_c)^3.15,   C = 1.103483e8 W/m^1.5,   ρ₀ = 1.225 kg/m³,   V_c = 7924.8 m/s
/// ```
///
/// The symbols are those of [`sutton_graves`]. In its own units, C is 17 600 BTU/(ft^1.5 s) and `V_c` 26 000 ft/s; 1 BTU/(ft² s) is
/// 11 356.527 W/m². The factor `(h_s - h_w)/(h_s - h_w300)` is that of a cold wall, 1. Valid up to 8 km/s, to some 10 %. Programs that
/// are built on POST call this formula Chapman's.
///
/// # Reference
/// R. W. Detra, N. H. Kemp and F. R. Riddell, Addendum to "Heat Transfer to Satellite Vehicles Re-entering the Atmosphere", Jet Propulsion 27
/// (1957), 1256-1257.
#[inline(always)]
pub fn detra_kemp_riddell<S: Scalar>(density: S, speed: S, nose_radius: f64) -> S {
    (density / (SEA_LEVEL_DENSITY * nose_radius)).sqrt()
        * power(speed * CIRCULAR_SPEED.recip(), 3.15)
        * FLUX_AT_CIRCULAR_SPEED
}

/// The convective flux by Chapman, W/m².
///
/// ```text
/// q̇ = C/√r_n √(ρ/ρ₀) (V/V_c)³
/// ```
///
/// The symbols and the constants are those of [`detra_kemp_riddell`], with which it agrees at the circular speed; the exponent is that for
/// which Chapman's heating function of an entry is `u^(5/2) Z^(1/2)`. Textbooks of Delft have C = 1.1097e8 and `V_c` = 7920 m/s, 0.7 % more.
/// Of laminar entries up to the speed of escape, 11.2 km/s.
///
/// # Reference
/// D. R. Chapman, An Approximate Analytical Method for Studying Entry into Planetary Atmospheres, NASA TR R-11, 1959.
#[inline(always)]
pub fn chapman<S: Scalar>(density: S, speed: S, nose_radius: f64) -> S {
    let speed = speed * CIRCULAR_SPEED.recip();
    (density / (SEA_LEVEL_DENSITY * nose_radius)).sqrt() * (speed * speed * speed) * FLUX_AT_CIRCULAR_SPEED
}

/// kg/m³.
const SEA_LEVEL_DENSITY: f64 = 1.225;
/// 26 000 ft/s, m/s.
const CIRCULAR_SPEED: f64 = 26_000.0 * 0.3048;
/// 17 600 BTU/(ft^1.5 s), W/m^1.5: 17 600 · 11 356.527 · √0.3048.
const FLUX_AT_CIRCULAR_SPEED: f64 = 1.103_483e8;

/// The radiative flux of the shocked air by Tauber and Sutton, W/m².
///
/// ```text
/// q̇ = C r_n^a ρ^1.22 f(V),   C = 4.736e8,   a = 1.072e6 V^-1.88 ρ^-0.325
/// a ≤ 1,   a ≤ 0.6 where r_n > 1 m,   a ≤ 0.5 where r_n > 2 m
/// ```
///
/// The symbols and their units are those of [`sutton_graves`]; the paper's C = 4.736e4 gives W/cm². f is tabulated from 9 to 16 km/s,
/// with straight lines between; below there is no radiation, and above f stays what it is at 16 km/s. `segment` counts the entries of the
/// table below the speed. Valid from 10 to 16 km/s, for densities from 6.66e-5 to 6.31e-4 kg/m³, which is from 72 down to 54 km, and nose radii
/// from 0.3 to 3 m, to some 20 to 30 % ([`Range`]).
///
/// # Reference
/// M. E. Tauber and K. Sutton, Stagnation-Point Radiative Heating Relations for Earth and Mars Entries, Journal of Spacecraft and Rockets 28
/// (1991), 40-42, equations 1 and 2 and table 1.
///
/// # Examples
/// ```
/// // At 11.5 km/s, the tenth of the entries, f is 238; to a power of 1 m nothing adds.
/// let flux = reentry::heating::tauber_sutton(10, 1e-4_f64, 11_500.0, 1.0);
/// assert!((flux - 4.736e8 * 1e-4_f64.powf(1.22) * 238.0).abs() < 1e-6 * flux);
/// ```
#[inline(always)]
pub fn tauber_sutton<S: Scalar>(segment: usize, density: S, speed: S, nose_radius: f64) -> S {
    radiation(segment, density, speed, [nose_radius, ln(nose_radius)])
}

/// The flux, with the logarithm of the nose radius.
#[inline(always)]
fn radiation<S: Scalar>(segment: usize, density: S, speed: S, [nose_radius, ln_nose_radius]: [f64; 2]) -> S {
    if segment == 0 {
        return S::zero();
    }
    let f = tabulated(segment, speed, &TAUBER_SUTTON_SPEED, &TAUBER_SUTTON_F);
    let greatest = match nose_radius {
        radius if radius <= 1.0 => 1.0,
        radius if radius <= 2.0 => 0.6,
        _ => 0.5,
    };
    let thin = density.less_than(f64::MIN_POSITIVE);
    let ln_density = S::select(thin, S::one(), density).ln();
    let exponent = (speed.ln() * -1.88 - ln_density * 0.325).exp() * 1.072e6;
    let exponent = S::select(exponent.less_than(greatest), exponent, S::from(greatest));
    let flux = (exponent * ln_nose_radius + ln_density * 1.22).exp() * f * 4.736e8;
    S::select(thin, S::zero(), flux)
}

/// What is tabulated by speed, in a segment after the first, with straight lines between the entries, and above the last what it is there.
#[inline(always)]
fn tabulated<S: Scalar, const N: usize>(segment: usize, speed: S, speeds: &[f64; N], values: &[f64; N]) -> S {
    if segment >= N {
        return S::from(values[N - 1]);
    }
    let [(v0, f0), (v1, f1)] = [segment - 1, segment].map(|entry| (speeds[entry], values[entry]));
    (speed - v0) * ((f1 - f0) / (v1 - v0)) + f0
}

/// The radiative flux of the shocked air of Mars by Tauber and Sutton, W/m².
///
/// ```text
/// q̇ = C r_n^0.526 ρ^1.19 f(V),   C = 2.35e8
/// ```
///
/// The symbols and their units are those of [`sutton_graves`]; the paper's C = 2.35e4 gives W/cm². f is tabulated from 6 to 9 km/s, and used
/// as that of [`tauber_sutton`] is: no radiation below, and above what it is at 9 km/s. Valid from 6.5 to 9 km/s ([`Range`]).
///
/// # Reference
/// Tauber and Sutton 1991, as of [`tauber_sutton`], equation 1 and table 1, column of Mars.
///
/// # Examples
/// ```
/// // At 7 km/s, the seventh of the entries, f is 8.1.
/// let flux = reentry::heating::tauber_sutton_mars(7, 1e-3_f64, 7000.0, 1.0);
/// assert!((flux - 2.35e8 * 1e-3_f64.powf(1.19) * 8.1).abs() < 1e-9 * flux);
/// ```
#[inline(always)]
pub fn tauber_sutton_mars<S: Scalar>(segment: usize, density: S, speed: S, nose_radius: f64) -> S {
    if segment == 0 {
        return S::zero();
    }
    let f = tabulated(segment, speed, &TAUBER_SUTTON_MARS_SPEED, &TAUBER_SUTTON_MARS_F);
    power(density, 1.19) * f * (2.35e8 * pow(nose_radius, 0.526))
}

/// The radiative flux of the shocked air of Venus by Craig and Lyne, W/m².
///
/// ```text
/// q̇ = C V^n ρ^1.2 r_n^0.49
///
/// V below 8 km/s          C = 3.33e-30   n = 10
/// V from 8 to 10 km/s     C = 1.22e-12   n = 5.5
/// V above 10 km/s         C = 3.07e-44   n = 13.4
/// ```
///
/// The symbols and their units are those of [`sutton_graves`]; the paper's C, smaller by 1e4, give W/cm². At 8 and at 10 km/s the flux steps
/// by less than 0.3 %. `segment` counts the speeds of 8 and 10 km/s below the speed.
///
/// # Reference
/// S. Craig and J. E. Lyne, Parametric Study of Aerocapture for Missions to Venus, Journal of Spacecraft and Rockets 42 (2005), 1035-1038; the
/// numbers as AMAT and a course of Purdue University have them.
///
/// # Examples
/// ```
/// let flux = reentry::heating::craig_lyne(2, 1e-3_f64, 11_000.0, 1.0);
/// assert!((flux - 3.07e-44 * 11_000_f64.powf(13.4) * 1e-3_f64.powf(1.2)).abs() < 1e-9 * flux);
/// ```
#[inline(always)]
pub fn craig_lyne<S: Scalar>(segment: usize, density: S, speed: S, nose_radius: f64) -> S {
    let [constant, exponent] = CRAIG_LYNE_POWERS[segment.min(CRAIG_LYNE_SPEED.len())];
    power(speed, exponent) * power(density, 1.2) * (constant * pow(nose_radius, 0.49))
}

/// A power of a number that is not negative; of none, none.
#[inline(always)]
fn power<S: Scalar>(base: S, exponent: f64) -> S {
    let none = base.less_than(f64::MIN_POSITIVE);
    S::select(none, S::zero(), (S::select(none, S::one(), base).ln() * exponent).exp())
}

/// V of table 1, m/s.
const TAUBER_SUTTON_SPEED: [f64; 19] = [
    9000.0, 9250.0, 9500.0, 9750.0, 10_000.0, 10_250.0, 10_500.0, 10_750.0, 11_000.0, 11_500.0, 12_000.0, 12_500.0,
    13_000.0, 13_500.0, 14_000.0, 14_500.0, 15_000.0, 15_500.0, 16_000.0,
];
/// f of table 1.
const TAUBER_SUTTON_F: [f64; 19] = [
    1.5, 4.3, 9.7, 19.5, 35.0, 55.0, 81.0, 115.0, 151.0, 238.0, 359.0, 495.0, 660.0, 850.0, 1065.0, 1313.0, 1550.0,
    1780.0, 2040.0,
];

/// V of table 1 for Mars, m/s.
const TAUBER_SUTTON_MARS_SPEED: [f64; 17] = [
    6000.0, 6150.0, 6300.0, 6500.0, 6700.0, 6900.0, 7000.0, 7200.0, 7400.0, 7600.0, 7800.0, 8000.0, 8200.0, 8400.0,
    8600.0, 8800.0, 9000.0,
];
/// f of table 1 for Mars.
const TAUBER_SUTTON_MARS_F: [f64; 17] =
    [0.2, 1.0, 1.95, 3.42, 5.1, 7.1, 8.1, 10.2, 12.5, 14.8, 17.1, 19.2, 21.4, 24.1, 26.0, 28.9, 32.8];
/// V at which the power of Craig and Lyne changes, m/s.
const CRAIG_LYNE_SPEED: [f64; 2] = [8000.0, 10_000.0];
/// C and n of Craig and Lyne.
const CRAIG_LYNE_POWERS: [[f64; 2]; 3] = [[3.33e-30, 10.0], [1.22e-12, 5.5], [3.07e-44, 13.4]];

/// For what a correlation was made, each from and to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Whose it is.
    pub correlation: &'static str,
    /// Relative to the air, m/s.
    pub speed: [f64; 2],
    /// kg/m³.
    pub density: [f64; 2],
    /// ρV², about the pressure at the stagnation point, Pa.
    pub pressure: [f64; 2],
    /// m.
    pub nose_radius: [f64; 2],
}

impl Range {
    const ANY: Self = {
        let any = [0.0, f64::INFINITY];
        Self { correlation: "", speed: any, density: any, pressure: any, nose_radius: any }
    };
}

impl Convective {
    /// [`sutton_graves`] in air.
    pub const SUTTON_GRAVES: Self = Self::SuttonGraves { constant: SUTTON_GRAVES_AIR };

    /// For what it was made: the enthalpies of Sutton and Graves are speeds of √(2h).
    pub fn range(self) -> Range {
        match self {
            Self::SuttonGraves { .. } => Range {
                correlation: "Relation of Sutton and Graves",
                speed: [2145.0, 15_245.0],
                pressure: [101.325, 1.013_25e7],
                ..Range::ANY
            },
            Self::DetraKempRiddell => {
                Range { correlation: "Relation of Detra, Kemp and Riddell", speed: [0.0, 8000.0], ..Range::ANY }
            }
            Self::Chapman => Range { correlation: "Chapman's relation", speed: [0.0, 11_200.0], ..Range::ANY },
        }
    }
}

impl Radiative {
    /// For what it was made.
    pub fn range(self) -> Range {
        match self {
            Self::None => Range::ANY,
            Self::TauberSutton => Range {
                correlation: "Relation of Tauber and Sutton",
                speed: [10_000.0, 16_000.0],
                density: [6.66e-5, 6.31e-4],
                nose_radius: [0.3, 3.0],
                ..Range::ANY
            },
            Self::TauberSuttonMars => {
                Range { correlation: "Relation of Tauber and Sutton for Mars", speed: [6500.0, 9000.0], ..Range::ANY }
            }
            Self::CraigLyne => Range { correlation: "Relation of Craig and Lyne", ..Range::ANY },
        }
    }
}
