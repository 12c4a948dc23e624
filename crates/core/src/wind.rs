//! The wind: air that moves against the rotating planet.

use std::sync::Arc;

use crate::interpolation::{Cubics, Hint, TableError};
use crate::scalar::Scalar;

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

/// Wind by altitude along the radius vector; below the first altitude and above the last it stays as it is there.
#[derive(Clone, Debug, PartialEq)]
pub struct WindTable {
    /// To the east and to the north, m/s.
    velocity: Cubics<2>,
}

impl WindTable {
    /// The table of altitudes, m, ascending, and velocities, m/s.
    ///
    /// # Errors
    /// When these are not a table.
    pub fn new(altitude: &[f64], east: &[f64], north: &[f64]) -> Result<Self, TableError> {
        Ok(Self { velocity: Cubics::new(altitude, [east, north])? })
    }

    /// Its lowest and highest altitude, m.
    pub fn range(&self) -> &[f64; 2] {
        self.velocity.range()
    }

    /// The altitudes between them, m.
    pub fn inner(&self) -> &[f64] {
        self.velocity.inner()
    }

    /// The velocity to the east and to the north, m/s, at an altitude, m, by the formula of a segment: 0 below the table, 1 inside, 2 above.
    #[inline(always)]
    pub fn velocity<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> [S; 2] {
        self.velocity.at(segment, altitude, hint)
    }
}
