//! Several numbers side by side, for which compilers use the vector registers of the processor.

use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use super::{LookUp, Scalar};
use crate::elementary;

/// `L` numbers that go through the same operations, each by itself: lane by lane the digits are those of `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const L: usize>(pub [f64; L]);

impl<const L: usize> Lanes<L> {
    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(function))
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident, $assigning:ident $assign:ident;)*) => {$(
        impl<const L: usize> $operator for Lanes<L> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|lane| self.0[lane].$method(other.0[lane])))
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
        self.0.map(|number| number < other)
    }

    #[inline(always)]
    fn select(mask: [bool; L], chosen: Self, otherwise: Self) -> Self {
        Self(from_fn(|lane| if mask[lane] { chosen.0[lane] } else { otherwise.0[lane] }))
    }

    #[inline(always)]
    fn pick<const K: usize>(self, row: impl Fn(f64) -> [f64; K]) -> [Self; K] {
        let rows = self.0.map(row);
        from_fn(|k| Self(from_fn(|lane| rows[lane][k])))
    }

    #[inline(always)]
    fn look_up<const N: usize, const K: usize>(at: [Self; N], table: &impl LookUp<N, K>) -> [Self; K] {
        let found: [[f64; K]; L] = from_fn(|lane| table.at(at.map(|number| number.0[lane])));
        from_fn(|k| Self(from_fn(|lane| found[lane][k])))
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
        self.map(elementary::exp)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.map(elementary::ln)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let all = if self.0.iter().all(|angle| elementary::has_few_quadrants(*angle)) {
            self.0.map(elementary::sin_cos_of_few_quadrants)
        } else {
            self.0.map(elementary::sin_cos)
        };
        (Self(all.map(|(sine, _)| sine)), Self(all.map(|(_, cosine)| cosine)))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self(from_fn(|lane| elementary::atan2(self.0[lane], x.0[lane])))
    }
}
