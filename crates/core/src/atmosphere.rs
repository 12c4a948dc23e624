//! The atmosphere: density by altitude.

pub mod us76;

use crate::scalar::Scalar;

/// A model of the atmosphere, which turns with the planet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Atmosphere {
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
    /// The kinetic temperature, K.
    pub temperature: S,
    /// Pa.
    pub pressure: S,
    /// m/s.
    pub speed_of_sound: S,
}

impl Atmosphere {
    /// The exponential atmosphere of the thesis.
    pub const EARTH_JAMESON: Self = Self::Exponential { surface_density: 1.547_93, scale_height: 6935.0 };

    /// Density, kg/m³, at an altitude above the surface along the radius vector, m.
    ///
    /// From 700 scale heights below the surface on, where hardly more than trial stages of the integrator come,
    /// the density grows no more: there it is e⁷⁰⁰ times its surface value, and further down no number would hold it.
    #[inline(always)]
    pub fn density<S: Scalar>(&self, altitude: S) -> S {
        let Self::Exponential { surface_density, scale_height } = *self;
        // Of a subnormal scale height the reciprocal would be infinite, and its product with no altitude no number.
        let height = altitude * scale_height.recip().min(f64::MAX);
        let clamped = S::select(height.less_than(-700.0), S::from(-700.0), height);
        (-clamped).exp() * surface_density
    }

    /// The altitude, m, above which the air is so thin (e⁻³⁷ ≈ 10⁻¹⁶ of the surface's) that an integrator may not notice it coming.
    pub fn sensible_altitude(&self) -> f64 {
        37.0 * self.scale_height()
    }

    /// The height, m, over which the density changes by e.
    pub fn scale_height(&self) -> f64 {
        let Self::Exponential { scale_height, .. } = *self;
        scale_height
    }
}
