//! Several numbers side by side, for which compilers use the vector registers of the processor.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use super::{LookUp, Real, Scalar};
use crate::elementary;

/// `L` numbers that go through the same operations, each by itself: lane by lane the digits are those of `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<const L: usize>(pub [f64; L]);

impl<const L: usize> Lanes<L> {
    /// A number for each lane. A plain loop, of which compilers make vectors.
    #[inline(always)]
    fn each(number: impl Fn(usize) -> f64) -> Self {
        let mut lanes = [0.0; L];
        for (lane, place) in lanes.iter_mut().enumerate() {
            *place = number(lane);
        }
        Self(lanes)
    }

    /// Whether something holds of all; of the others it is asked as well.
    #[inline(always)]
    fn all(self, holds: impl Fn(f64) -> bool) -> bool {
        self.0.iter().fold(true, |all, number| all & holds(*number))
    }

    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self::each(|lane| function(self.0[lane]))
    }
}

/// A function of each number, where it is not the same formula for all of them: rare, and out of line, as the program would be long.
#[cold]
#[inline(never)]
fn one_by_one<const L: usize>(numbers: &Lanes<L>, function: fn(f64) -> f64) -> Lanes<L> {
    numbers.map(function)
}

/// The same of the sine and the cosine.
#[cold]
#[inline(never)]
fn sines_and_cosines_one_by_one<const L: usize>(angles: &Lanes<L>) -> (Lanes<L>, Lanes<L>) {
    let [mut sines, mut cosines] = [[0.0; L]; 2];
    for (lane, angle) in angles.0.iter().enumerate() {
        (sines[lane], cosines[lane]) = elementary::sin_cos(*angle);
    }
    (Lanes(sines), Lanes(cosines))
}

/// A row of a table for one lane, out of line: finding it is long, and there are several.
#[inline(never)]
fn picked<const K: usize>(number: f64, row: &impl Fn(f64) -> [f64; K]) -> [f64; K] {
    row(number)
}

/// The same of a look-up.
#[inline(never)]
fn looked_up<const N: usize, const K: usize>(at: [f64; N], table: &impl LookUp<N, K>) -> [f64; K] {
    table.at(at)
}

/// Rows of numbers, one for each lane, as numbers in lanes.
#[inline(always)]
fn transposed<const K: usize, const L: usize>(rows: &[[f64; K]; L]) -> [Lanes<L>; K] {
    let mut columns = [Lanes([0.0; L]); K];
    for (k, column) in columns.iter_mut().enumerate() {
        *column = Lanes::each(|lane| rows[lane][k]);
    }
    columns
}

macro_rules! operators {
    ($($operator:ident $method:ident, $assigning:ident $assign:ident;)*) => {$(
        impl<const L: usize> $operator for Lanes<L> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::each(|lane| self.0[lane].$method(other.0[lane]))
            }
        }

        impl<const L: usize> $operator<f64> for Lanes<L> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.map(|number| number.$method(other))
            }
        }

        impl<const L: usize> $assigning for Lanes<L> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}

operators! {
    Add add, AddAssign add_assign;
    Sub sub, SubAssign sub_assign;
    Mul mul, MulAssign mul_assign;
}

impl<const L: usize> Div for Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self::each(|lane| self.0[lane] / other.0[lane])
    }
}

impl<const L: usize> Div<f64> for Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self.map(|number| number / other)
    }
}

impl<const L: usize> Neg for Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|number| -number)
    }
}

impl<const L: usize> From<f64> for Lanes<L> {
    #[inline(always)]
    fn from(number: f64) -> Self {
        Self([number; L])
    }
}

impl<const L: usize> Zero for Lanes<L> {
    #[inline(always)]
    fn zero() -> Self {
        Self::from(0.0)
    }

    fn is_zero(&self) -> bool {
        self.0.iter().all(f64::is_zero)
    }
}

impl<const L: usize> One for Lanes<L> {
    #[inline(always)]
    fn one() -> Self {
        Self::from(1.0)
    }
}

impl<const L: usize> Scalar for Lanes<L> {
    const WIDTH: usize = L;

    type Mask = [bool; L];
    type Value = Self;

    #[inline(always)]
    fn value(self) -> Self {
        self
    }

    #[inline(always)]
    fn scaled(self, factor: Self) -> Self {
        self * factor
    }

    #[inline(always)]
    fn less_than(self, other: f64) -> [bool; L] {
        let mut mask = [false; L];
        for (answer, number) in mask.iter_mut().zip(self.0) {
            *answer = number < other;
        }
        mask
    }

    #[inline(always)]
    fn any(mask: [bool; L]) -> bool {
        mask.iter().fold(false, |any, one| any | one)
    }

    #[inline(always)]
    fn select(mask: [bool; L], chosen: Self, otherwise: Self) -> Self {
        Self::each(|lane| if mask[lane] { chosen.0[lane] } else { otherwise.0[lane] })
    }

    #[inline(always)]
    fn pick<const K: usize>(self, row: impl Fn(f64) -> [f64; K]) -> [Self; K] {
        let mut rows = [[0.0; K]; L];
        for (place, number) in rows.iter_mut().zip(self.0) {
            *place = picked(number, &row);
        }
        transposed(&rows)
    }

    #[inline(always)]
    fn look_up<const N: usize, const K: usize>(at: [Self; N], table: &impl LookUp<N, K>) -> [Self; K] {
        let mut found = [[0.0; K]; L];
        for (lane, place) in found.iter_mut().enumerate() {
            *place = looked_up(at.map(|number| number.0[lane]), table);
        }
        transposed(&found)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        self.map(f64::recip)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        if self.all(elementary::has_normal_exponential) {
            self.map(elementary::normal_exponential)
        } else {
            one_by_one(&self, elementary::exp)
        }
    }

    #[inline(always)]
    fn ln(self) -> Self {
        if self.all(elementary::is_normal) {
            self.map(elementary::logarithm)
        } else {
            one_by_one(&self, elementary::ln)
        }
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        if !self.all(elementary::has_few_quadrants) {
            return sines_and_cosines_one_by_one(&self);
        }
        let [mut sines, mut cosines] = [[0.0; L]; 2];
        for lane in 0..L {
            (sines[lane], cosines[lane]) = elementary::sin_cos_of_few_quadrants(self.0[lane]);
        }
        (Self(sines), Self(cosines))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let mut angles = self;
        for (angle, x) in angles.0.iter_mut().zip(x.0) {
            *angle = elementary::atan2(*angle, x);
        }
        angles
    }
}

impl<const L: usize> Real for Lanes<L> {
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::each(|lane| self.0[lane].min(other.0[lane]))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::each(|lane| self.0[lane].max(other.0[lane]))
    }
}
