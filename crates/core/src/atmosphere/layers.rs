//! An atmosphere of layers, each with a scale height of its own.

use super::{SENSIBLE_SCALE_HEIGHTS, falling, us76};
use crate::elementary::ln;
use crate::interpolation::TableError;
use crate::scalar::Scalar;

/// The bases of [`Layers::earth_seven_layer`], and the altitude where its last layer meets the standard once more, m.
const EARTH_BASES: [f64; 8] = [0.0, 10e3, 43e3, 68e3, 82e3, 112e3, 120e3, 130e3];

/// Density ρ e^(-(h - base)/H) from its base to the base of the next layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// m.
    pub base_altitude: f64,
    /// ρ at the base, kg/m³.
    pub density: f64,
    /// H, m.
    pub scale_height: f64,
}

/// Layers from the lowest to the highest; the first reaches down, the last up without end.
///
/// Where the density of a layer at its top is not that of the next at its base, the density jumps there.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    all: Vec<Layer>,
    /// Where one layer ends and the next begins, m.
    boundaries: Vec<f64>,
    sensible_altitude: f64,
    scale_height: f64,
}

impl Layers {
    /// The layers, whose bases ascend.
    ///
    /// # Errors
    /// When there are none, their bases do not ascend, or a number cannot be: densities are at least, scale heights greater than 0.
    pub fn new(layers: Vec<Layer>) -> Result<Self, TableError> {
        let bases: Vec<f64> = layers.iter().map(|layer| layer.base_altitude).collect();
        crate::interpolation::check(&bases, &[])?;
        let sound = |layer: &Layer| {
            let Layer { density, scale_height, .. } = *layer;
            density >= 0.0 && density.is_finite() && scale_height > 0.0 && scale_height.is_finite()
        };
        match layers.iter().position(|layer| !sound(layer)) {
            Some(index) => Err(TableError::OutOfBounds { index }),
            None => Ok(Self::of(layers)),
        }
    }

    /// Sound layers. What every step of a flight asks for is found here once: there may be thousands of them.
    fn of(layers: Vec<Layer>) -> Self {
        let boundaries: Vec<f64> = layers.iter().skip(1).map(|layer| layer.base_altitude).collect();
        let sensible_altitude = sensible_altitude(&layers, &boundaries);
        let scale_height = layers.iter().map(|layer| layer.scale_height).fold(f64::MAX, f64::min);
        Self { all: layers, boundaries, sensible_altitude, scale_height }
    }

    /// Seven layers near the U.S. Standard Atmosphere, 1976: at the bases, 0, 10, 43, 68, 82, 112 and 120 km, and at 130 km, their density
    /// is the standard's, and each layer has the scale height by which it meets the next.
    ///
    /// Of all such bases in whole kilometres these keep nearest to the standard between 0 and 130 km: within 5.0 %, and within
    /// 3.4 % below 10 km. From there on the air thins too fast: it is 12 % less at 136 km,
    /// 47 % at 150 km, 97 % at 200 km.
    pub fn earth_seven_layer() -> Self {
        let layers = EARTH_BASES.windows(2).map(|pair| {
            let (base_altitude, top) = (pair[0], pair[1]);
            let density = us76::density(base_altitude);
            let scale_height = (top - base_altitude) / ln(density / us76::density(top));
            Layer { base_altitude, density, scale_height }
        });
        Self::of(layers.collect())
    }

    /// The layers, from the lowest to the highest.
    pub fn layers(&self) -> &[Layer] {
        &self.all
    }

    /// Where one layer ends and the next begins, m, ascending.
    pub fn boundaries(&self) -> &[f64] {
        &self.boundaries
    }

    /// Density, kg/m³, at an altitude, m, by the formula of a layer, as if it had no end.
    #[inline(always)]
    pub fn density<S: Scalar>(&self, layer: usize, altitude: S) -> S {
        self.all[layer].density_at(altitude)
    }

    /// The altitude, m, above which the density is less than e⁻³⁷ ≈ 10⁻¹⁶ of the greatest from altitude 0 on; 0 where there is no air.
    pub fn sensible_altitude(&self) -> f64 {
        self.sensible_altitude
    }

    /// The least scale height, m.
    pub fn scale_height(&self) -> f64 {
        self.scale_height
    }
}

impl Layer {
    /// Density, kg/m³, at an altitude, m.
    #[inline(always)]
    fn density_at<S: Scalar>(&self, altitude: S) -> S {
        falling(self.density, altitude - self.base_altitude, self.scale_height)
    }
}

fn sensible_altitude(layers: &[Layer], boundaries: &[f64]) -> f64 {
    let at_0 = layers[boundaries.iter().filter(|boundary| **boundary <= 0.0).count()].density_at(0.0);
    let above_0 = layers.iter().filter(|layer| layer.base_altitude > 0.0);
    let greatest = above_0.fold(at_0, |greatest: f64, layer| greatest.max(layer.density));
    // The highest layer that begins with sensible air, and where in it this ends.
    let sensible = layers.iter().enumerate().rev().find_map(|(number, layer)| {
        let reach = layer.scale_height * (ln(layer.density / greatest) + SENSIBLE_SCALE_HEIGHTS);
        let top = boundaries.get(number).copied().unwrap_or(f64::MAX);
        (reach > 0.0).then(|| (layer.base_altitude + reach).min(top))
    });
    sensible.unwrap_or(0.0)
}
