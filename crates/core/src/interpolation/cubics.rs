//! Interpolation by one argument.

use super::{Axis, Cubic, Hint, TableError, check, cubics, polynomial};
use crate::scalar::{LookUp, Plain, Scalar};

/// `K` functions of one argument.
#[derive(Clone, Debug, PartialEq)]
pub struct Cubics<const K: usize> {
    axis: Axis,
    /// Of every cell.
    cells: Vec<[Cubic; K]>,
    /// At the first and the last entry.
    ends: [[End; K]; 2],
}

/// A function at an end of its table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct End {
    value: f64,
    slope: f64,
}

impl<const K: usize> Cubics<K> {
    /// The functions through the given entries.
    ///
    /// # Errors
    /// When there is no entry, the columns are not as long as the abscissae, these do not ascend, or the entries are too steep.
    pub fn new(abscissae: &[f64], columns: [&[f64]; K]) -> Result<Self, TableError> {
        check(abscissae, &columns)?;
        let axis = Axis::new(abscissae);
        let mut cells = vec![[[0.0; 5]; K]; axis.cells()];
        for (k, column) in columns.into_iter().enumerate() {
            for (cell, cubic) in cells.iter_mut().zip(cubics(abscissae, column)?) {
                cell[k] = cubic;
            }
        }
        let last = abscissae.len() - 1;
        let first_ends = cells[0].map(|[_, value, slope, ..]| End { value, slope });
        let mut last_ends = cells[cells.len() - 1].map(|[origin, _, c1, c2, c3]| {
            let x = abscissae[last] - origin;
            End { value: 0.0, slope: (3.0 * c3 * x + 2.0 * c2) * x + c1 }
        });
        for (end, column) in last_ends.iter_mut().zip(columns) {
            end.value = column[last];
        }
        Ok(Self { axis, cells, ends: [first_ends, last_ends] })
    }

    /// The first and the last abscissa.
    pub fn range(&self) -> &[f64; 2] {
        &self.axis.range
    }

    /// The abscissae between the first and the last, at which the second derivatives jump.
    pub fn inner(&self) -> &[f64] {
        self.axis.inner()
    }

    /// The slopes at the first and the last entry.
    pub fn end_slopes(&self) -> [[f64; K]; 2] {
        self.ends.map(|ends| ends.map(|end| end.slope))
    }

    /// The functions by the formula of a segment; outside they stay as they are at the ends.
    #[inline(always)]
    pub fn at<S: Scalar>(&self, segment: usize, x: S, hint: &Hint) -> [S; K] {
        match segment {
            0 => self.ends[0].map(|end| S::from(end.value)),
            1 => self.inside(x, hint),
            _ => self.ends[1].map(|end| S::from(end.value)),
        }
    }

    /// The functions by the formula of a segment; outside they go on in straight lines.
    #[inline(always)]
    pub fn extrapolated<S: Scalar>(&self, segment: usize, x: S, hint: &Hint) -> [S; K] {
        let [first, last] = self.axis.range;
        let line = |ends: &[End; K], origin: f64| ends.map(|End { value, slope }| (x - origin) * slope + value);
        match segment {
            0 => line(&self.ends[0], first),
            1 => self.inside(x, hint),
            _ => line(&self.ends[1], last),
        }
    }

    #[inline(always)]
    fn inside<S: Scalar>(&self, x: S, hint: &Hint) -> [S; K] {
        S::look_up([self.axis.within_reach(x)], &Inside { cubics: self, hint })
    }
}

/// A look-up in the cells.
struct Inside<'a, const K: usize> {
    cubics: &'a Cubics<K>,
    hint: &'a Hint,
}

impl<const K: usize> LookUp<1, K> for Inside<'_, K> {
    #[inline(always)]
    fn at<S: Plain>(&self, [x]: [S; 1]) -> [S; K] {
        let cell = &self.cubics.cells[self.cubics.axis.cell(x.value(), self.hint)];
        let mut values = [S::zero(); K];
        for (value, [origin, coefficients @ ..]) in values.iter_mut().zip(cell) {
            *value = polynomial(x - *origin, *coefficients);
        }
        values
    }
}
