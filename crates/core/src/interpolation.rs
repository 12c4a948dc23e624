//! Smooth interpolation in tables: between neighbouring entries a cubic, which has at each entry the slope of its neighbour and
//! never leaves the range of the two.
//!
//! # Method
//!
//! Of an entry with the secants a before and b after it, over the intervals hₐ and `h_b`, the slope is that of the parabola through
//! the three entries, times a factor of 1 between equal secants, which vanishes between secants of opposite signs:
//!
//! ```text
//! d = (a h_b + b hₐ)/(hₐ + h_b) (1 - δ²)² (1 + 2δ²),   δ = (b - a)/(b + a),   |δ| < 1;   otherwise d = 0
//! d = (3b - d₂)/2   for the first entry, d₂ being the slope of the second; likewise for the last
//! ```
//!
//! For all intervals |d| is less than 2.93 of the lesser secant, and 3 of it are allowed to a monotone cubic (Fritsch and Carlson).
//! The slopes of the first and the last entry let the second derivative vanish there. Straight lines come back as they are.
//! The usual factors have corners as functions of the entries; this one has none, so that the entries may themselves be
//! functions of another argument: the interpolation by two arguments then has continuous slopes along both.
//!
//! # Segments
//!
//! A table has three: 0 below its first entry, 1 inside, 2 above its last. The caller says which, since a step of the integration ends
//! where another begins; trial stages that look over such an end find the formula of their own segment continued. That of
//! the inside goes on as far as the cells at the ends are wide, and stays constant from there on.
//!
//! # Reference
//!
//! F. N. Fritsch and R. E. Carlson, Monotone piecewise cubic interpolation, SIAM Journal on Numerical Analysis 17 (1980), 238-246.

mod cubics;
mod surfaces;

pub use cubics::Cubics;
pub use surfaces::Surfaces;

use std::cell::Cell;

use crate::scalar::Scalar;

/// Why numbers are not a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// Too few entries.
    #[error("must have at least {least} entries, got {entries}")]
    TooShort {
        /// How many there are.
        entries: usize,
        /// How many are needed.
        least: usize,
    },
    /// Lists of different lengths.
    #[error("must have as many entries as the others, {expected}, got {entries}")]
    LengthsDiffer {
        /// How many there are.
        entries: usize,
        /// How many the others have.
        expected: usize,
    },
    /// The abscissae do not ascend.
    #[error("must ascend, but entry {index} is not greater than the one before it")]
    NotAscending {
        /// Of the first that does not.
        index: usize,
    },
    /// A number that the table cannot hold.
    #[error("entry {index} is out of bounds")]
    OutOfBounds {
        /// Of the first; in a matrix counted row by row.
        index: usize,
    },
    /// Neighbouring entries so unlike, or so near, that no number holds the slope between them.
    #[error("is too steep after entry {index}")]
    TooSteep {
        /// Of the first of two neighbours along the abscissae.
        index: usize,
    },
}

/// Whether the abscissae ascend strictly, and every column has as many finite numbers.
///
/// # Errors
/// With the first fault.
pub fn check(abscissae: &[f64], columns: &[&[f64]]) -> Result<(), TableError> {
    if abscissae.is_empty() {
        return Err(TableError::TooShort { entries: 0, least: 1 });
    }
    if let Some(column) = columns.iter().find(|column| column.len() != abscissae.len()) {
        return Err(TableError::LengthsDiffer { entries: column.len(), expected: abscissae.len() });
    }
    for numbers in columns.iter().chain([&abscissae]) {
        if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
            return Err(TableError::OutOfBounds { index });
        }
    }
    match abscissae.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(before) => Err(TableError::NotAscending { index: before + 1 }),
        None => Ok(()),
    }
}

/// The cell in which a look-up found its argument, where the next one begins to look.
#[derive(Clone, Debug, Default)]
pub struct Hint(Cell<usize>);

/// The abscissae of a table: the ends of its cells.
#[derive(Clone, Debug, PartialEq)]
struct Axis {
    /// The first and the last abscissa.
    range: [f64; 2],
    /// How far the cells at the ends continue outside.
    reach: [f64; 2],
    /// Where the cells begin; the first and the last are without end.
    edges: Vec<f64>,
}

impl Axis {
    /// The axis of at least one ascending number; one alone makes a cell without width.
    fn new(abscissae: &[f64]) -> Self {
        let (first, last) = (abscissae[0], abscissae[abscissae.len() - 1]);
        let inner = abscissae.get(1..abscissae.len() - 1).unwrap_or_default();
        let width = |pair: Option<&[f64]>| pair.map_or(0.0, |pair| pair[1] - pair[0]);
        let [below, above] = [width(abscissae.windows(2).next()), width(abscissae.windows(2).next_back())];
        Self {
            range: [first, last],
            reach: [(first - below).max(f64::MIN), (last + above).min(f64::MAX)],
            edges: [&[f64::NEG_INFINITY], inner, &[f64::INFINITY]].concat(),
        }
    }

    /// The abscissae between the first and the last.
    fn inner(&self) -> &[f64] {
        &self.edges[1..self.cells()]
    }

    /// How many cells there are.
    fn cells(&self) -> usize {
        self.edges.len() - 1
    }

    /// The cell that holds a number, or is the nearest to it.
    #[inline(always)]
    fn cell(&self, x: f64, hint: &Hint) -> usize {
        let last = hint.0.get();
        match self.edges.get(last..last + 2) {
            Some(&[left, right]) if left <= x && x < right => last,
            _ => self.search(x, hint),
        }
    }

    /// The cell that holds a number, of which the hint is wrong.
    #[cold]
    fn search(&self, x: f64, hint: &Hint) -> usize {
        let last = hint.0.get();
        let holds =
            |cell: &usize| matches!(self.edges.get(*cell..*cell + 2), Some(&[left, right]) if left <= x && x < right);
        let inner = self.inner();
        let found = [last + 1, last.saturating_sub(1)].into_iter().find(holds);
        let found = found.unwrap_or_else(|| inner.partition_point(|edge| *edge <= x));
        hint.0.set(found);
        found
    }

    /// The nearest number to which the cells at the ends continue.
    #[inline(always)]
    fn within_reach<S: Scalar>(&self, x: S) -> S {
        let [low, high] = self.reach;
        let x = S::select(x.less_than(low), S::from(low), x);
        S::select(x.less_than(high), x, S::from(high))
    }
}

/// The slope between two secants; the weight is that of the one before. Where both are 0 the slope is 0, with all its derivatives.
#[inline(always)]
fn slope_between<S: Scalar>(before: S, after: S, weight: f64) -> S {
    let delta = (after - before) * (before + after).recip();
    let square = delta * delta;
    let rest = -square + 1.0;
    let mean = after + (before - after) * weight;
    S::select(square.less_than(1.0), mean * (rest * rest * (square * 2.0 + 1.0)), S::zero())
}

/// The slope at the first or last entry: so much of the secant of its cell, and of the slope at the other end.
const AT_END: [f64; 2] = [1.5, -0.5];

fn slope_at_end(secant: f64, other: f64) -> f64 {
    AT_END[0] * secant + AT_END[1] * other
}

/// The slopes at all entries; more than one.
fn slopes(abscissae: &[f64], values: &[f64]) -> Vec<f64> {
    let lengths: Vec<f64> = abscissae.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let secants: Vec<f64> =
        values.windows(2).zip(&lengths).map(|(pair, length)| (pair[1] - pair[0]) / length).collect();
    let inner = secants
        .windows(2)
        .zip(lengths.windows(2))
        .map(|(secants, lengths)| slope_between(secants[0], secants[1], lengths[1] / (lengths[0] + lengths[1])));
    let inner: Vec<f64> = inner.collect();
    let (first, last) = (secants[0], secants[secants.len() - 1]);
    let after_first = inner.first().copied().unwrap_or(first);
    let before_last = inner.last().copied().unwrap_or(last);
    [&[slope_at_end(first, after_first)], &inner[..], &[slope_at_end(last, before_last)]].concat()
}

/// A cubic: its origin and its coefficients, from the constant on.
type Cubic = [f64; 5];

/// The cubic of a cell: its ends, its values and its slopes.
fn hermite([left, right]: [f64; 2], [f0, f1]: [f64; 2], [d0, d1]: [f64; 2]) -> Cubic {
    let length = right - left;
    let secant = (f1 - f0) / length;
    [left, f0, d0, (3.0 * secant - 2.0 * d0 - d1) / length, (d0 + d1 - 2.0 * secant) / length / length]
}

/// The cubics of all cells of a column.
///
/// # Errors
/// When a coefficient is too large for a number.
fn cubics(abscissae: &[f64], values: &[f64]) -> Result<Vec<Cubic>, TableError> {
    if let ([only], [value]) = (abscissae, values) {
        return Ok(vec![[*only, *value, 0.0, 0.0, 0.0]]);
    }
    let slopes = slopes(abscissae, values);
    let cells = abscissae.windows(2).zip(values.windows(2)).zip(slopes.windows(2));
    let cubics = cells.map(|((x, f), d)| hermite([x[0], x[1]], [f[0], f[1]], [d[0], d[1]]));
    let cubics: Vec<Cubic> = cubics.collect();
    match cubics.iter().position(|cubic| !cubic.iter().all(|number| number.is_finite())) {
        Some(index) => Err(TableError::TooSteep { index }),
        None => Ok(cubics),
    }
}

/// c₀ + c₁x + c₂x² + c₃x³.
#[inline(always)]
fn polynomial<S: Scalar>(x: S, [c0, c1, c2, c3]: [f64; 4]) -> S {
    ((x * c3 + c2) * x + c1) * x + c0
}
