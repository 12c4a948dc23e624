//! Interpolation by two arguments.

use super::{AT_END, Axis, Hint, TableError, check, cubics, polynomial, slope_between};
use crate::scalar::{LookUp, Plain, Scalar};

/// Two functions of two arguments, of which the table has a row for every value of the first.
///
/// The rows are interpolated as [`Cubics`](super::Cubics) are, by the second argument; between them runs the cubic that the same
/// method lays through the values that the rows have there. Both first derivatives are continuous, and along the lines of the grid
/// both functions are those of one argument.
/// Between two rows the functions are monotone by the first argument, wherever the second is; therefore in every cell they stay
/// between the least and the greatest of its four corners, but for rounding. By the second argument they are monotone where all rows
/// are straight, and on the rows themselves; between bent rows they need not be. What is linear in each argument comes back as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Surfaces {
    first: Axis,
    second: Axis,
    /// Of every cell of the first argument.
    across: Vec<Across>,
    /// Where the cells of the second argument begin.
    origins: Vec<f64>,
    /// Of every cell of the second argument the cubics of all rows: of both functions side by side, from the constant on.
    along: Vec<[[f64; 2]; 4]>,
    /// How many rows there are.
    rows: usize,
}

/// What leads from row to row.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Across {
    /// The first argument on the row before, and one over the width of the cell.
    cell: [f64; 2],
    /// One over the widths of the neighbours before and after; 0 where there is none.
    per_width: [f64; 2],
    /// The weights of the secants before, on the row before and on the row after.
    weights: [f64; 2],
    /// On the first and on the last row, to which no secant leads, so much of the cell's secant and of the slope on the other row.
    ends: [[f64; 2]; 2],
    /// Where the cubics of four rows begin: those on both sides, and their neighbours as far as there are any.
    rows: [usize; 4],
}

impl Surfaces {
    /// The functions through the given matrices, of one row for each entry of `first` and one column for each of `second`.
    ///
    /// # Errors
    /// When there is no entry, a matrix has not the size of the others, abscissae do not ascend, or the entries are too steep.
    pub fn new(first: &[f64], second: &[f64], matrices: [&[Vec<f64>]; 2]) -> Result<Self, TableError> {
        check(first, &[])?;
        check(second, &[])?;
        for matrix in matrices {
            if matrix.len() != first.len() {
                return Err(TableError::LengthsDiffer { entries: matrix.len(), expected: first.len() });
            }
        }
        let rows = first.len();
        let (first_axis, second_axis) = (Axis::new(first), Axis::new(second));
        let mut origins = vec![0.0; second_axis.cells()];
        let mut along = vec![[[0.0; 2]; 4]; second_axis.cells() * rows];
        for (k, matrix) in matrices.into_iter().enumerate() {
            for (number, row) in matrix.iter().enumerate() {
                check(second, &[row]).map_err(|error| in_matrix(error, number, second.len()))?;
                for (cell, [origin, cubic @ ..]) in cubics(second, row)?.into_iter().enumerate() {
                    origins[cell] = origin;
                    for (both, coefficient) in along[cell * rows + number].iter_mut().zip(cubic) {
                        both[k] = coefficient;
                    }
                }
            }
        }
        let across: Vec<_> = (0..first_axis.cells()).map(|cell| Across::of(first, cell)).collect();
        let greatest =
            matrices.into_iter().flatten().flatten().fold(0.0, |greatest: f64, value| greatest.max(value.abs()));
        let too_steep = |across: &Across| {
            let per_width = across.per_width.into_iter().chain([across.cell[1]]);
            per_width.into_iter().any(|per| !(16.0 * greatest * per * per.max(1.0)).is_finite())
        };
        match across.iter().position(too_steep) {
            Some(index) => Err(TableError::TooSteep { index }),
            None => Ok(Self { first: first_axis, second: second_axis, across, origins, along, rows }),
        }
    }

    /// The first and the last entry of both arguments.
    pub fn ranges(&self) -> [&[f64; 2]; 2] {
        [&self.first.range, &self.second.range]
    }

    /// The entries of both arguments between the first and the last, at which the second derivatives jump.
    pub fn inner(&self) -> [&[f64]; 2] {
        [self.first.inner(), self.second.inner()]
    }

    /// The functions by the formulas of a segment of each argument; outside they stay as they are at the ends.
    #[inline(always)]
    pub fn at<S: Scalar>(&self, segments: [usize; 2], arguments: [S; 2], hints: &[Hint; 2]) -> [S; 2] {
        let inside = |axis: &Axis, segment: usize, x: S| match segment {
            0 => S::from(axis.range[0]),
            1 => axis.within_reach(x),
            _ => S::from(axis.range[1]),
        };
        let x = inside(&self.first, segments[0], arguments[0]);
        let y = inside(&self.second, segments[1], arguments[1]);
        S::look_up([x, y], &Inside { surfaces: self, hints })
    }
}

/// A look-up in the cells.
struct Inside<'a> {
    surfaces: &'a Surfaces,
    hints: &'a [Hint; 2],
}

impl LookUp<2, 2> for Inside<'_> {
    #[inline(always)]
    fn at<S: Plain>(&self, [x, y]: [S; 2]) -> [S; 2] {
        let Surfaces { first, second, across, origins, along, rows } = self.surfaces;
        let across = &across[first.cell(x.value(), &self.hints[0])];
        let cell = second.cell(y.value(), &self.hints[1]);
        let y = y - origins[cell];
        let mut on_rows = [[S::zero(); 4]; 2];
        for (place, row) in across.rows.into_iter().enumerate() {
            let [c0, c1, c2, c3] = &along[cell * rows + row];
            for (k, values) in on_rows.iter_mut().enumerate() {
                values[place] = polynomial(y, [c0[k], c1[k], c2[k], c3[k]]);
            }
        }
        let [first, second] = on_rows;
        [across.between_rows(x, first), across.between_rows(x, second)]
    }
}

/// The fault of a row as that of the matrix.
fn in_matrix(error: TableError, row: usize, columns: usize) -> TableError {
    match error {
        TableError::OutOfBounds { index } => TableError::OutOfBounds { index: row * columns + index },
        other => other,
    }
}

impl Across {
    fn of(abscissae: &[f64], cell: usize) -> Self {
        let last = abscissae.len() - 1;
        let width = |cell: Option<usize>| {
            let left = cell.filter(|left| *left < last)?;
            Some(abscissae[left + 1] - abscissae[left])
        };
        let widths = [width(cell.checked_sub(1)), width(Some(cell)), width(Some(cell + 1))];
        let weight = |before: Option<f64>, after: Option<f64>| match (before, after) {
            (Some(before), Some(after)) => after / (before + after),
            _ => 0.0,
        };
        // Of two rows alone both slopes are the secant.
        let end = |own: Option<f64>, other: Option<f64>| match (own, other) {
            (Some(_), _) => [0.0, 0.0],
            (None, Some(_)) => AT_END,
            (None, None) => [1.0, 0.0],
        };
        let [before, own, after] = widths;
        let per = |width: Option<f64>| width.map_or(0.0, f64::recip);
        Self {
            cell: [abscissae[cell], per(own)],
            per_width: [per(before), per(after)],
            weights: [weight(before, own), weight(own, after)],
            ends: [end(before, after), end(after, before)],
            rows: [cell.saturating_sub(1), cell, (cell + 1).min(last), (cell + 2).min(last)],
        }
    }

    /// The cubic between the second and the third of four rows, from the values that they have.
    ///
    /// On the first and on the last row, the secant that does not exist is zero, and so is the slope that it gives.
    #[inline(always)]
    fn between_rows<S: Scalar>(&self, x: S, [a, b, c, d]: [S; 4]) -> S {
        let Self { cell: [origin, own], per_width: [before, after], weights: [w0, w1], ends: [first, last], .. } =
            *self;
        let secant = (c - b) * own;
        let inner0 = slope_between((b - a) * before, secant, w0);
        let inner1 = slope_between(secant, (d - c) * after, w1);
        let slope0 = inner0 + secant * first[0] + inner1 * first[1];
        let slope1 = inner1 + secant * last[0] + inner0 * last[1];
        let bend = (secant * 3.0 - slope0 * 2.0 - slope1) * own;
        let twist = (slope0 + slope1 - secant * 2.0) * (own * own);
        let x = x - origin;
        ((twist * x + bend) * x + slope0) * x + b
    }
}
