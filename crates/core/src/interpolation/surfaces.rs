//! Interpolation by two arguments.

use super::{Axis, Cubic, Hint, TableError, check, cubics, polynomial, slope_at_end, slope_between};
use crate::scalar::Scalar;

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
    /// Of every cell of the second argument the cubics of all rows, both functions.
    along: Vec<[Cubic; 2]>,
    /// How many rows there are.
    rows: usize,
}

/// What leads from row to row.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Across {
    /// The first argument on the row before.
    origin: f64,
    /// One over the widths of the neighbour before, the cell itself and the neighbour after; 0 where there is none.
    per_width: [f64; 3],
    /// The weights of the secants before, on the row before and on the row after; -1 on the first and on the last row.
    weights: [f64; 2],
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
        let mut along = vec![[[0.0; 5]; 2]; second_axis.cells() * rows];
        for (k, matrix) in matrices.into_iter().enumerate() {
            for (number, row) in matrix.iter().enumerate() {
                check(second, &[row]).map_err(|error| in_matrix(error, number, second.len()))?;
                for (cell, cubic) in cubics(second, row)?.into_iter().enumerate() {
                    along[cell * rows + number][k] = cubic;
                }
            }
        }
        let across: Vec<_> = (0..first_axis.cells()).map(|cell| Across::of(first, cell)).collect();
        let greatest =
            matrices.into_iter().flatten().flatten().fold(0.0, |greatest: f64, value| greatest.max(value.abs()));
        let too_steep =
            |across: &Across| across.per_width.iter().any(|per| !(16.0 * greatest * per * per.max(1.0)).is_finite());
        match across.iter().position(too_steep) {
            Some(index) => Err(TableError::TooSteep { index }),
            None => Ok(Self { first: first_axis, second: second_axis, across, along, rows }),
        }
    }

    /// The first and the last entry of both arguments.
    pub fn ranges(&self) -> [&[f64; 2]; 2] {
        [&self.first.range, &self.second.range]
    }

    /// The functions by the formulas of a stretch of each argument; outside they stay as they are at the ends.
    #[inline(always)]
    pub fn at<S: Scalar>(&self, stretches: [usize; 2], arguments: [S; 2], hints: &[Hint; 2]) -> [S; 2] {
        let inside = |axis: &Axis, stretch: usize, x: S| match stretch {
            0 => S::from(axis.range[0]),
            1 => axis.within_reach(x),
            _ => S::from(axis.range[1]),
        };
        let x = inside(&self.first, stretches[0], arguments[0]);
        let y = inside(&self.second, stretches[1], arguments[1]);
        let picked = S::pick_rows([x, y], |[x, y]| {
            let across = self.across[self.first.cell(x, &hints[0])];
            let begin = self.second.cell(y, &hints[1]) * self.rows;
            let ([before, own, after], [w0, w1]) = (across.per_width, across.weights);
            let [a, b, c, d] = across.rows.map(|row| self.along[begin + row]);
            let extended = |[origin, c0, c1, c2, c3]: Cubic| [origin, c0, c1, c2, c3, 0.0];
            let [row_a, row_b, row_c, row_d] = [a, b, c, d].map(|row| row.map(extended));
            [
                [across.origin, before, own, after, w0, w1],
                row_a[0],
                row_b[0],
                row_c[0],
                row_d[0],
                row_a[1],
                row_b[1],
                row_c[1],
                row_d[1],
            ]
        });
        let [cell, a0, b0, c0, d0, a1, b1, c1, d1] = picked;
        let value = |[origin, c0, c1, c2, c3, _]: [S; 6]| polynomial(y - origin, [c0, c1, c2, c3]);
        [[a0, b0, c0, d0], [a1, b1, c1, d1]].map(|rows| between_rows(x, cell, rows.map(value)))
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
            _ => -1.0,
        };
        Self {
            origin: abscissae[cell],
            per_width: widths.map(|width| width.map_or(0.0, f64::recip)),
            weights: [weight(widths[0], widths[1]), weight(widths[1], widths[2])],
            rows: [cell.saturating_sub(1), cell, (cell + 1).min(last), (cell + 2).min(last)],
        }
    }
}

/// The cubic between the second and the third of four rows, from the values that they have.
#[inline(always)]
fn between_rows<S: Scalar>(x: S, [origin, before, own, after, w0, w1]: [S; 6], [a, b, c, d]: [S; 4]) -> S {
    let secant = (c - b) * own;
    let on_first = w0.less_than(0.0);
    let on_last = w1.less_than(0.0);
    // Of two rows alone both slopes are the secant.
    let inner0 = S::select(on_first, secant, slope_between((b - a) * before, secant, w0));
    let inner1 = S::select(on_last, secant, slope_between(secant, (d - c) * after, w1));
    let slope0 = S::select(on_first, slope_at_end(secant, inner1), inner0);
    let slope1 = S::select(on_last, slope_at_end(secant, inner0), inner1);
    let bend = (secant * 3.0 - slope0 * 2.0 - slope1) * own;
    let twist = (slope0 + slope1 - secant * 2.0) * own * own;
    polynomial(x - origin, [b, slope0, bend, twist])
}
