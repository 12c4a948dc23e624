//! The number types in which the physics is written once: `f64`, the dual numbers of `num-dual`, which carry derivatives,
//! and [`Lanes`] of several numbers, with derivatives [`DualLanes`].

mod dual_lanes;
mod lanes;

pub use dual_lanes::DualLanes;
pub use lanes::Lanes;

use std::ops::{Add, Div, Mul, Neg, Sub};

use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign, Vector3};
use num_dual::{Dual2_64, Dual64, DualNum, DualSVec64, DualStruct};
use num_traits::{One, Zero};

use crate::elementary;

/// A real number, with or without derivatives.
///
/// Formulas keep their constants on the right (`speed * speed * 0.5`), so that these bounds suffice,
/// and choose with [`select`](Self::select) in place of `if`, since lanes may choose differently.
/// The value of a dual number goes through the very operations that `f64` goes through, so that both give the same digits:
/// therefore there is no division, which dual numbers round in another way, but [`recip`](Self::recip).
pub trait Scalar:
    nalgebra::Scalar
    + Copy
    + Zero
    + One
    + From<f64>
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// How many numbers it holds side by side.
    const WIDTH: usize;

    /// The answer to a comparison.
    type Mask: Copy;

    /// The number without its derivatives.
    type Value: Scalar<Value = Self::Value, Mask = Self::Mask>;

    /// The number without its derivatives.
    fn value(self) -> Self::Value;

    /// The number times one without derivatives.
    #[must_use]
    fn scaled(self, factor: Self::Value) -> Self;

    /// Whether the value is less than `other`.
    fn less_than(self, other: f64) -> Self::Mask;

    /// Whether the answer is yes for any of the numbers.
    fn any(mask: Self::Mask) -> bool;

    /// `chosen` where the mask holds, `otherwise` where it does not.
    fn select(mask: Self::Mask, chosen: Self, otherwise: Self) -> Self;

    /// What a table holds for the value: a row of numbers without derivatives, each lane its own.
    fn pick<const K: usize>(self, row: impl Fn(f64) -> [f64; K]) -> [Self; K];

    /// What a look-up gives for some arguments, each lane its own.
    fn look_up<const N: usize, const K: usize>(at: [Self; N], table: &impl LookUp<N, K>) -> [Self; K];

    /// One over the number.
    #[must_use]
    fn recip(self) -> Self;

    /// The square root; at zero its slope is taken as zero, that of the length of a vector at its smallest.
    #[must_use]
    fn sqrt(self) -> Self;

    /// e to the power of `self`.
    #[must_use]
    fn exp(self) -> Self;

    /// The natural logarithm.
    #[must_use]
    fn ln(self) -> Self;

    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);

    /// The angle of the point (`x`, `self`), in (-π, π].
    #[must_use]
    fn atan2(self, x: Self) -> Self;
}

impl<D> Scalar for D
where
    D: DualNum<Primitive = f64> + DualStruct<Real = f64> + nalgebra::Scalar + Copy + Chain,
{
    const WIDTH: usize = 1;

    type Mask = bool;
    type Value = f64;

    #[inline(always)]
    fn value(self) -> f64 {
        self.re()
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }

    #[inline(always)]
    fn less_than(self, other: f64) -> bool {
        self.re() < other
    }

    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }

    #[inline(always)]
    fn select(mask: bool, chosen: Self, otherwise: Self) -> Self {
        if mask { chosen } else { otherwise }
    }

    #[inline(always)]
    fn pick<const K: usize>(self, row: impl Fn(f64) -> [f64; K]) -> [Self; K] {
        row(self.re()).map(Self::from)
    }

    #[inline(always)]
    fn look_up<const N: usize, const K: usize>(at: [Self; N], table: &impl LookUp<N, K>) -> [Self; K] {
        table.at(at)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        DualNum::recip(&self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        if self.re() == 0.0 { Self::from(self.re()) } else { DualNum::sqrt(&self) }
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let value = elementary::exp(self.re());
        self.chain([value; 3])
    }

    #[inline(always)]
    fn ln(self) -> Self {
        let slope = self.re().recip();
        self.chain([elementary::ln(self.re()), slope, -slope * slope])
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = elementary::sin_cos(self.re());
        (self.chain([sine, cosine, -sine]), self.chain([cosine, -sine, -cosine]))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        // One over a complex number, whose imaginary part is against the slopes.
        let square = self.re() * self.re() + x.re() * x.re();
        self.angle(x, elementary::atan2(self.re(), x.re()), [x.re() / square, -self.re() / square])
    }
}

/// A number to which the chain rule applies: without derivatives, or with those of the first order, or of the first two.
pub trait Chain: Copy {
    /// A function of the number, by the values that it and its first two derivatives have there.
    #[must_use]
    fn chain(self, function: [f64; 3]) -> Self;

    /// A function of two numbers, by its value and its slopes there; of derivatives beyond the first order nothing is known.
    #[must_use]
    fn angle(self, other: Self, value: f64, slopes: [f64; 2]) -> Self;
}

impl Chain for f64 {
    #[inline(always)]
    fn chain(self, [value, ..]: [f64; 3]) -> Self {
        value
    }

    #[inline(always)]
    fn angle(self, _: Self, value: f64, _: [f64; 2]) -> Self {
        value
    }
}

impl Chain for Dual64 {
    #[inline(always)]
    fn chain(self, [value, slope, _]: [f64; 3]) -> Self {
        Self::new(value, self.eps * slope)
    }

    #[inline(always)]
    fn angle(self, other: Self, value: f64, [by_self, by_other]: [f64; 2]) -> Self {
        Self::new(value, self.eps * by_self + other.eps * by_other)
    }
}

impl<const K: usize> Chain for DualSVec64<K> {
    #[inline(always)]
    fn chain(self, [value, slope, _]: [f64; 3]) -> Self {
        Self { re: value, eps: self.eps * slope }
    }

    #[inline(always)]
    fn angle(self, other: Self, value: f64, [by_self, by_other]: [f64; 2]) -> Self {
        Self { re: value, eps: self.eps * by_self + other.eps * by_other }
    }
}

impl Chain for Dual2_64 {
    fn chain(self, [value, slope, bend]: [f64; 3]) -> Self {
        Self::new(value, self.v1 * slope, self.v2 * slope + self.v1 * self.v1 * bend)
    }

    fn angle(self, other: Self, value: f64, [by_self, by_other]: [f64; 2]) -> Self {
        Self::new(value, self.v1 * by_self + other.v1 * by_other, f64::NAN)
    }
}

/// Calls a function out of line that other flights do not need, and that is not to be in their way. In lanes it leaves their instructions; in line,
/// all models together make functions that take minutes to compile.
#[inline(never)]
pub(crate) fn apart<R>(function: impl FnOnce() -> R) -> R {
    function()
}

/// A number without derivatives, `f64` or lanes of it: only of such a one are there quotients, magnitudes and limits.
pub trait Real: Scalar<Value = Self> + Div<Output = Self> {
    /// The magnitude.
    #[must_use]
    fn abs(self) -> Self;

    /// The smaller of two numbers, or the one that is a number.
    #[must_use]
    fn min(self, other: Self) -> Self;

    /// The greater of two numbers, or the one that is a number.
    #[must_use]
    fn max(self, other: Self) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.min(other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.max(other)
    }
}

/// `K` functions of `N` arguments that go by cells: which cell it is, depends on the values of the arguments.
pub trait LookUp<const N: usize, const K: usize> {
    /// The functions of arguments that have one value each.
    fn at<S: Plain>(&self, arguments: [S; N]) -> [S; K];
}

/// A number that has one value: `f64`, or a dual number.
pub trait Plain: Scalar<Value = f64, Mask = bool> + DualNum<Primitive = f64> + DualStruct<Real = f64> {}

impl<S: Scalar<Value = f64, Mask = bool> + DualNum<Primitive = f64> + DualStruct<Real = f64>> Plain for S {}

/// A number that can be added to and multiplied by a parameter: `f64`, or a number of its own kind.
pub trait Over<P>: Scalar + Add<P, Output = Self> + Mul<P, Output = Self> {}

impl<P, S: Scalar + Add<P, Output = S> + Mul<P, Output = S>> Over<P> for S {}

/// The length of a vector.
#[inline(always)]
pub fn length<S: Scalar>(vector: &Vector3<S>) -> S {
    vector.dot(vector).sqrt()
}

/// One over a length; 1 over none, so that the direction of the zero vector is the zero vector.
#[inline(always)]
pub fn reciprocal_or_one<S: Scalar>(length: S) -> S {
    length_or_one(length).recip()
}

/// [One over](reciprocal_or_one) each of two lengths, and one over their product. One division serves all three.
#[inline(always)]
pub fn reciprocals_or_one<S: Scalar>([one, other]: [S; 2]) -> ([S; 2], S) {
    let [one, other] = [one, other].map(length_or_one);
    let over_both = (one * other).recip();
    ([over_both * other, over_both * one], over_both)
}

/// The length; 1 in place of none.
#[inline(always)]
fn length_or_one<S: Scalar>(length: S) -> S {
    S::select(length.less_than(f64::MIN_POSITIVE), S::one(), length)
}
