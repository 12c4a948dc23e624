//! Linear dispersions: how far outputs of a flight scatter where numbers of its case do, to first order.
//!
//! ```text
//! C = J Σ Jᵀ
//! ```
//!
//! with the slopes J of the outputs by the variables and the covariance Σ of these.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::elementary::atan2;
use nalgebra::{DMatrix, Matrix2, SymmetricEigen};

/// Variables that scatter together, and independently of all others: one, or several of a given covariance.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The places of the variables among the columns of the slopes.
    pub variables: Vec<usize>,
    /// The covariance of the variables, row by row, in their units.
    pub covariance: Vec<Vec<f64>>,
}

impl Group {
    /// One variable with a standard deviation.
    pub fn of_one(variable: usize, standard_deviation: f64) -> Self {
        Self { variables: vec![variable], covariance: vec![vec![standard_deviation * standard_deviation]] }
    }

    /// What the group gives to the covariance of outputs, of each of which `slopes` has a row; row by row.
    pub fn contribution(&self, slopes: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let count = self.variables.len();
        let jacobian = DMatrix::from_fn(slopes.len(), count, |row, column| slopes[row][self.variables[column]]);
        let covariance = DMatrix::from_fn(count, count, |row, column| self.covariance[row][column]);
        let of_outputs = &jacobian * covariance * jacobian.transpose();
        of_outputs.row_iter().map(|row| row.iter().copied().collect()).collect()
    }
}

/// The least eigenvalue of a covariance, over its greatest diagonal element; negative where it is none.
pub fn least_eigenvalue(covariance: &[Vec<f64>]) -> f64 {
    let count = covariance.len();
    // Of the correlations, since the units of the variables may be far apart.
    let deviation = |index: usize| covariance[index][index].sqrt();
    let correlation = DMatrix::from_fn(count, count, |row, column| {
        let scale = deviation(row) * deviation(column);
        if scale > 0.0 { covariance[row][column] / scale } else { covariance[row][column] }
    });
    SymmetricEigen::new(correlation).eigenvalues.min()
}

/// The ellipse of one standard deviation of a plane covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// In the unit of the plane.
    pub semi_major_axis: f64,
    /// In the unit of the plane.
    pub semi_minor_axis: f64,
    /// Of the major axis, clockwise from north, in [0, π), rad.
    pub azimuth: f64,
}

impl Ellipse {
    /// That of a covariance of east and north.
    ///
    /// # Examples
    /// ```
    /// use reentry::solve::dispersions::Ellipse;
    ///
    /// // 5 m along the north-east, 1 m across.
    /// let ellipse = Ellipse::of([[13.0, 12.0], [12.0, 13.0]]);
    /// assert!((ellipse.semi_major_axis - 5.0).abs() < 1e-12 && (ellipse.semi_minor_axis - 1.0).abs() < 1e-12);
    /// assert!((ellipse.azimuth - std::f64::consts::FRAC_PI_4).abs() < 1e-12);
    /// ```
    pub fn of(covariance: [[f64; 2]; 2]) -> Self {
        let [[a, b], [c, d]] = covariance;
        let SymmetricEigen { eigenvalues, eigenvectors } = Matrix2::new(a, b, c, d).symmetric_eigen();
        let major = usize::from(eigenvalues[0] < eigenvalues[1]);
        // A rounding below zero is a variance of none.
        let axis = |index: usize| eigenvalues[index].max(0.0).sqrt();
        let (east, north) = (eigenvectors[(0, major)], eigenvectors[(1, major)]);
        let azimuth = (FRAC_PI_2 - atan2(north, east)).rem_euclid(PI);
        Self {
            semi_major_axis: axis(major),
            semi_minor_axis: axis(1 - major),
            // A rounding below 0 would be a half turn.
            azimuth: if azimuth < PI { azimuth } else { 0.0 },
        }
    }
}
