//! The wind: air that moves against the rotating planet.

use std::sync::Arc;

use crate::interpolation::{self, TableError};

/// The velocity of the air relative to the rotating planet, along east and north of the local horizontal of
/// [`FlightPath`](crate::coordinates::FlightPath).
#[derive(Clone, Debug, PartialEq)]
pub enum Wind {
    /// The air turns with the planet.
    Still,
    /// The same everywhere.
    Constant {
        /// To the east, m/s.
        east: f64,
        /// To the north, m/s.
        north: f64,
    },
    /// By altitude.
    Table(Arc<WindTable>),
}

/// Wind by altitude along the radius vector.
#[derive(Clone, Debug, PartialEq)]
pub struct WindTable {
    range: [f64; 2],
}

impl WindTable {
    /// The table of altitudes, m, ascending, and velocities, m/s.
    ///
    /// # Errors
    /// When these are not a table.
    pub fn new(altitude: &[f64], east: &[f64], north: &[f64]) -> Result<Self, TableError> {
        interpolation::check(altitude, &[east, north])?;
        Ok(Self { range: [altitude[0], altitude[altitude.len() - 1]] })
    }

    /// Its lowest and highest altitude, m.
    pub fn range(&self) -> &[f64; 2] {
        &self.range
    }
}

impl WindTable {
    /// stub
    pub fn velocity<S: crate::scalar::Scalar>(&self, _: usize, _: S, _: &interpolation::Hint) -> [S; 2] {
        [S::zero(), S::zero()]
    }
}
