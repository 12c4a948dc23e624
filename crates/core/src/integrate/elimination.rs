//! Linear equations of a few unknowns.

use std::array::from_fn;

use nalgebra::Complex;

use crate::scalar::Scalar;

/// A matrix of complex numbers in triangular factors, by Gauss's elimination with the greatest pivot of each column.
pub(super) struct Factors<const N: usize> {
    /// Above the diagonal the upper factor, below it the lower one, on it one over the pivots.
    rows: [[Complex<f64>; N]; N],
    /// Which equation each row is.
    equations: [usize; N],
}

impl<const N: usize> Factors<N> {
    /// None of a matrix that is singular or not finite.
    pub(super) fn of(mut rows: [[Complex<f64>; N]; N]) -> Option<Self> {
        let mut equations = from_fn(|i| i);
        for column in 0..N {
            let greatest =
                (column..N).max_by(|a, b| rows[*a][column].norm_sqr().total_cmp(&rows[*b][column].norm_sqr()))?;
            rows.swap(column, greatest);
            equations.swap(column, greatest);
            let over_pivot = rows[column][column].inv();
            if !over_pivot.is_finite() {
                return None;
            }
            rows[column][column] = over_pivot;
            let pivot_row = rows[column];
            for row in &mut rows[column + 1..] {
                let factor = row[column] * over_pivot;
                row[column] = factor;
                for (number, above) in row[column + 1..].iter_mut().zip(&pivot_row[column + 1..]) {
                    *number -= factor * above;
                }
            }
        }
        Some(Self { rows, equations })
    }

    /// The solution for a right-hand side of a real and an imaginary part, both of which may carry derivatives.
    pub(super) fn solve<S: Scalar<Value = f64>>(&self, [real, imaginary]: [[S; N]; 2]) -> [[S; N]; 2] {
        let mut solution = self.equations.map(|equation| [real[equation], imaginary[equation]]);
        for i in 0..N {
            for j in 0..i {
                subtract(&mut solution, i, self.rows[i][j], j);
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                subtract(&mut solution, i, self.rows[i][j], j);
            }
            solution[i] = product(self.rows[i][i], solution[i]);
        }
        [0, 1].map(|part| solution.map(|number| number[part]))
    }
}

/// Takes a multiple of one number from another.
#[inline(always)]
fn subtract<S: Scalar<Value = f64>>(numbers: &mut [[S; 2]], from: usize, factor: Complex<f64>, of: usize) {
    let [real, imaginary] = product(factor, numbers[of]);
    numbers[from][0] -= real;
    numbers[from][1] -= imaginary;
}

#[inline(always)]
fn product<S: Scalar<Value = f64>>(factor: Complex<f64>, [real, imaginary]: [S; 2]) -> [S; 2] {
    [real * factor.re - imaginary * factor.im, real * factor.im + imaginary * factor.re]
}
