//! The atmosphere: density by altitude, and what else a model knows of the air.

mod layers;
pub mod nrlmsise00;
mod table;
pub mod us76;

pub use layers::{Layer, Layers};
use nrlmsise00::Nrlmsise00;
pub use table::{Gas, MOLAR_GAS_CONSTANT, Table};

use std::sync::Arc;

use crate::interpolation::Hint;
use crate::scalar::{Scalar, apart};

/// Scale heights over which the density falls to e⁻³⁷ ≈ 10⁻¹⁶, so thin that an integrator may not notice it coming.
const SENSIBLE_SCALE_HEIGHTS: f64 = 37.0;
/// What stands for a scale height where there is no air, m.
const VACUUM_SCALE_HEIGHT: f64 = 10e3;

/// The density at altitude 0, kg/m³, and the scale height, m, of the thesis (Jameson 2006, equations 39 and 40).
pub const EARTH_JAMESON: [f64; 2] = [1.547_93, 6935.0];

/// A model of the atmosphere, by the altitude along the radius vector; it turns with the planet.
#[derive(Clone, Debug, PartialEq)]
pub enum Atmosphere {
    /// No air.
    Vacuum,
    /// The U.S. Standard Atmosphere, 1976.
    Us76,
    /// NRLMSISE-00, by place and time; what takes the altitude alone gives the air above latitude 0 and longitude 0 at t = 0.
    Nrlmsise00(Arc<Nrlmsise00>),
    /// Layers of one scale height each.
    Layers(Arc<Layers>),
    /// A table.
    Table(Arc<Table>),
    /// ρ = ρ₀ e^(-h/H).
    ///
    /// # Reference
    /// Jameson 2006, equation 38; its numbers (equations 39 and 40) are [`Atmosphere::EARTH_JAMESON`].
    Exponential {
        /// ρ₀, density at altitude 0, kg/m³.
        surface_density: f64,
        /// H = 1/β, the height over which the density falls by e, m.
        scale_height: f64,
    },
}

/// The air at an altitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtmosphereSample<S> {
    /// kg/m³.
    pub density: S,
    /// The kinetic temperature, K, if the model has one.
    pub temperature: Option<S>,
    /// Pa, if the model has one.
    pub pressure: Option<S>,
    /// m/s, if the model has one.
    pub speed_of_sound: Option<S>,
}

impl Atmosphere {
    /// The exponential atmosphere of the thesis.
    pub const EARTH_JAMESON: Self = {
        let [surface_density, scale_height] = EARTH_JAMESON;
        Self::Exponential { surface_density, scale_height }
    };

    /// The density at altitude 0, kg/m³, where that is a number of the model: of the exponential one alone.
    pub(crate) fn surface_density(&self) -> Option<f64> {
        match self {
            Self::Exponential { surface_density, .. } => Some(*surface_density),
            _ => None,
        }
    }

    /// The altitudes, m, ascending, at which the formula changes: between them lie the segments, of which the first, 0, has no lower
    /// end, and the last no upper one.
    pub fn boundaries(&self) -> &[f64] {
        match self {
            Self::Vacuum | Self::Exponential { .. } => &[],
            Self::Us76 => &us76::BOUNDARIES,
            Self::Nrlmsise00(_) => &nrlmsise00::BOUNDARIES,
            Self::Layers(layers) => layers.boundaries(),
            Self::Table(table) => table.range(),
        }
    }

    /// Density, kg/m³, at an altitude above the surface along the radius vector, m, by the formula of a segment between
    /// [`boundaries`](Self::boundaries), which goes on beyond its ends.
    ///
    /// From 700 scale heights below the surface on, where hardly more than trial stages of the integrator come,
    /// the density grows no more: there it is e⁷⁰⁰ times its surface value, and further down no number would hold it.
    #[inline(always)]
    pub fn density<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> S {
        match *self {
            Self::Exponential { surface_density, scale_height } => falling(surface_density, altitude, scale_height),
            // So that flights by the exponential one do not carry the instructions of the others.
            _ => apart(|| self.density_of_segment(segment, altitude, hint)),
        }
    }

    #[inline(always)]
    fn density_of_segment<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> S {
        match self {
            Self::Vacuum => S::zero(),
            Self::Us76 => us76::density_in(segment, altitude),
            Self::Nrlmsise00(model) => model.above_origin(altitude).density,
            Self::Layers(layers) => layers.density(segment, altitude),
            Self::Table(table) => table.density(segment, altitude, hint),
            Self::Exponential { surface_density, scale_height } => falling(*surface_density, altitude, *scale_height),
        }
    }

    /// Density, kg/m³, and speed of sound, m/s, at an altitude, m, by the formulas of a segment; of a model that has no speed of sound
    /// it is 1 m/s.
    #[inline(always)]
    pub fn density_and_sound<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> (S, S) {
        apart(|| self.density_and_sound_of_segment(segment, altitude, hint))
    }

    #[inline(always)]
    fn density_and_sound_of_segment<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> (S, S) {
        match self {
            Self::Us76 => us76::density_and_sound_in(segment, altitude),
            Self::Nrlmsise00(model) => {
                let sample = model.above_origin(altitude);
                (sample.density, sample.speed_of_sound.unwrap_or_else(S::one))
            }
            Self::Table(table) => {
                let sound = table.speed_of_sound(segment, altitude, hint);
                (table.density(segment, altitude, hint), sound.unwrap_or_else(S::one))
            }
            Self::Vacuum | Self::Layers(_) | Self::Exponential { .. } => {
                (self.density(segment, altitude, hint), S::one())
            }
        }
    }

    /// Density, kg/m³, and pressure, Pa, if the model has one, at an altitude, m, by the formulas of a segment. Out of line, in lanes as well: few
    /// flights take it.
    #[inline(never)]
    pub(crate) fn density_and_pressure<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> (S, Option<S>) {
        match self {
            Self::Us76 => {
                let (density, pressure) = us76::density_and_pressure_in(segment, altitude);
                (density, Some(pressure))
            }
            Self::Nrlmsise00(model) => {
                let AtmosphereSample { density, pressure, .. } = model.above_origin(altitude);
                (density, pressure)
            }
            Self::Table(table) => (table.density(segment, altitude, hint), table.pressure(segment, altitude, hint)),
            Self::Vacuum | Self::Layers(_) | Self::Exponential { .. } => (self.density(segment, altitude, hint), None),
        }
    }

    /// The air at an altitude, m, by the formulas of a segment.
    pub fn sample<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> AtmosphereSample<S> {
        match self {
            Self::Us76 => us76::sample_in(segment, altitude),
            Self::Nrlmsise00(model) => model.above_origin(altitude),
            Self::Table(table) => table.sample(segment, altitude, hint),
            Self::Vacuum | Self::Layers(_) | Self::Exponential { .. } => AtmosphereSample {
                density: self.density(segment, altitude, hint),
                temperature: None,
                pressure: None,
                speed_of_sound: None,
            },
        }
    }

    /// Whether the model has a speed of sound, and with it flights have a Mach number.
    pub fn has_speed_of_sound(&self) -> bool {
        match self {
            Self::Vacuum | Self::Layers(_) | Self::Exponential { .. } => false,
            Self::Us76 | Self::Nrlmsise00(_) => true,
            Self::Table(table) => table.has_speed_of_sound(),
        }
    }

    /// Whether the model has a temperature.
    pub fn has_temperature(&self) -> bool {
        match self {
            Self::Vacuum | Self::Layers(_) | Self::Exponential { .. } => false,
            Self::Us76 | Self::Nrlmsise00(_) => true,
            Self::Table(table) => table.has_temperature(),
        }
    }

    /// Whether the model has a pressure.
    pub fn has_pressure(&self) -> bool {
        match self {
            Self::Vacuum | Self::Layers(_) | Self::Exponential { .. } => false,
            Self::Us76 | Self::Nrlmsise00(_) => true,
            Self::Table(table) => table.has_pressure(),
        }
    }

    /// The altitude, m, above which the air is so thin (e⁻³⁷ ≈ 10⁻¹⁶ of the surface's) that an integrator may not notice it coming.
    pub fn sensible_altitude(&self) -> f64 {
        match self {
            Self::Vacuum => 0.0,
            Self::Exponential { scale_height, .. } => SENSIBLE_SCALE_HEIGHTS * scale_height,
            Self::Us76 => us76::SENSIBLE_ALTITUDE,
            Self::Nrlmsise00(_) => nrlmsise00::SENSIBLE_ALTITUDE,
            Self::Layers(layers) => layers.sensible_altitude(),
            Self::Table(table) => table.sensible_altitude(),
        }
    }

    /// The height, m, over which the density changes by e; the least where it differs.
    pub fn scale_height(&self) -> f64 {
        match self {
            Self::Vacuum => VACUUM_SCALE_HEIGHT,
            Self::Exponential { scale_height, .. } => *scale_height,
            Self::Us76 => us76::LEAST_SCALE_HEIGHT,
            Self::Nrlmsise00(_) => nrlmsise00::LEAST_SCALE_HEIGHT,
            Self::Layers(layers) => layers.scale_height(),
            Self::Table(table) => table.scale_height(),
        }
    }
}

/// ρ e^(-h/H), kg/m³, up to e⁷⁰⁰ρ: so much air is at this height, m, over the place whose density is ρ.
#[inline(always)]
fn falling<S: Scalar>(density: f64, height: S, scale_height: f64) -> S {
    // Of a subnormal scale height the reciprocal would be infinite, and its product with no height no number.
    let height = height * scale_height.recip().min(f64::MAX);
    let clamped = S::select(height.less_than(-700.0), S::from(-700.0), height);
    (-clamped).exp() * density
}
