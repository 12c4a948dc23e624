//! An atmosphere by a table.

use crate::interpolation::{self, TableError};

/// Density by altitude and, where they are given, temperature and pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    range: [f64; 2],
    has_temperature: bool,
    has_pressure: bool,
}

impl Table {
    /// The table of altitudes, m, ascending, densities, kg/m³, temperatures, K, and pressures, Pa, all of them greater than 0.
    ///
    /// # Errors
    /// When these are not a table of at least two altitudes.
    pub fn new(
        altitude: &[f64],
        density: &[f64],
        temperature: Option<&[f64]>,
        pressure: Option<&[f64]>,
    ) -> Result<Self, TableError> {
        interpolation::check(altitude, &[density])?;
        Ok(Self {
            range: [altitude[0], altitude[altitude.len() - 1]],
            has_temperature: temperature.is_some(),
            has_pressure: pressure.is_some(),
        })
    }

    /// Its lowest and highest altitude, m.
    pub fn range(&self) -> &[f64; 2] {
        &self.range
    }

    /// Whether it knows the temperature.
    pub fn has_temperature(&self) -> bool {
        self.has_temperature
    }

    /// Whether it knows the pressure.
    pub fn has_pressure(&self) -> bool {
        self.has_pressure
    }
}
