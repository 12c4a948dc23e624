//! An atmosphere of layers, each with a scale height of its own.

use crate::interpolation::TableError;

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
    layers: Vec<Layer>,
    /// Where one layer ends and the next begins, m.
    boundaries: Vec<f64>,
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
            None => Ok(Self { boundaries: bases[1..].to_vec(), layers }),
        }
    }

    /// The Earth's, in seven layers.
    pub fn earth_seven_layer() -> Self {
        let layer = Layer { base_altitude: 0.0, density: 1.225, scale_height: 7200.0 };
        Self { layers: vec![layer], boundaries: Vec::new() }
    }

    /// The layers, from the lowest to the highest.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// Where one layer ends and the next begins, m, ascending.
    pub fn boundaries(&self) -> &[f64] {
        &self.boundaries
    }
}
