//! The atmosphere: density by altitude, and what else a model knows of the air.

mod layers;
mod table;
pub mod us76;

pub use layers::{Layer, Layers};
pub use table::Table;

use std::sync::Arc;

use crate::scalar::Scalar;

/// A model of the atmosphere, by the altitude along the radius vector; it turns with the planet.
#[derive(Clone, Debug, PartialEq)]
pub enum Atmosphere {
    /// No air.
    Vacuum,
    /// The U.S. Standard Atmosphere, 1976.
    Us76,
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
    /// m/s, if the model has a temperature.
    pub speed_of_sound: Option<S>,
}

impl Atmosphere {
    /// The exponential atmosphere of the thesis.
    pub const EARTH_JAMESON: Self = Self::Exponential { surface_density: 1.547_93, scale_height: 6935.0 };

    /// Density, kg/m³, at an altitude above the surface along the radius vector, m.
    ///
    /// From 700 scale heights below the surface on, where hardly more than trial stages of the integrator come,
    /// the density grows no more: there it is e⁷⁰⁰ times its surface value, and further down no number would hold it.
    #[inline(always)]
    pub fn density<S: Scalar>(&self, _: usize, altitude: S) -> S {
        if let Self::Us76 = self { return Self::other(altitude) }
        let (surface_density, scale_height) = match *self {
            Self::Exponential { surface_density, scale_height } => (surface_density, scale_height),
            _ => (0.0, 6935.0),
        };
        // Of a subnormal scale height the reciprocal would be infinite, and its product with no altitude no number.
        let height = altitude * scale_height.recip().min(f64::MAX);
        let clamped = S::select(height.less_than(-700.0), S::from(-700.0), height);
        (-clamped).exp() * surface_density
    }

    #[inline(never)]
    fn other<S: Scalar>(altitude: S) -> S { us76::density(altitude) }
    /// stub
    #[inline(never)]
    pub fn density_and_sound<S: Scalar>(&self, _: usize, altitude: S) -> (S, S) {
        let sample = us76::sample(altitude);
        (sample.density, sample.speed_of_sound.unwrap_or(S::zero()))
    }

    /// stub
    pub fn sample<S: Scalar>(&self, layer: usize, altitude: S) -> AtmosphereSample<S> {
        match self { Self::Us76 => us76::sample(altitude),
        _ => AtmosphereSample { density: self.density(layer, altitude), temperature: None, pressure: None, speed_of_sound: None } }
    }

    /// stub
    pub fn boundaries(&self) -> &[f64] {
        match self { Self::Us76 => &us76::BOUNDARIES, _ => &[] }
    }

    /// Whether the model has a temperature, and with it a speed of sound.
    pub fn has_temperature(&self) -> bool {
        match self {
            Self::Vacuum | Self::Layers(_) | Self::Exponential { .. } => false,
            Self::Us76 => true,
            Self::Table(table) => table.has_temperature(),
        }
    }

    /// Whether the model has a pressure.
    pub fn has_pressure(&self) -> bool {
        match self {
            Self::Vacuum | Self::Layers(_) | Self::Exponential { .. } => false,
            Self::Us76 => true,
            Self::Table(table) => table.has_pressure(),
        }
    }

    /// The altitude, m, above which the air is so thin (e⁻³⁷ ≈ 10⁻¹⁶ of the surface's) that an integrator may not notice it coming.
    pub fn sensible_altitude(&self) -> f64 {
        37.0 * self.scale_height()
    }

    /// The height, m, over which the density changes by e.
    pub fn scale_height(&self) -> f64 {
        match *self {
            Self::Exponential { scale_height, .. } => scale_height,
            _ => 6935.0,
        }
    }
}
