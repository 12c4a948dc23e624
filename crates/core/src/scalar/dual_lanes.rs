//! Dual numbers side by side.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use num_dual::Dual64;
use num_traits::{One, Zero};

use super::{Lanes, LookUp, Scalar};

/// `L` numbers with their rates of change: lane by lane the digits are those of [`Dual64`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DualLanes<const L: usize> {
    /// The numbers.
    pub re: Lanes<L>,
    /// Their rates.
    pub eps: Lanes<L>,
}

impl<const L: usize> DualLanes<L> {
    /// Numbers with their rates.
    #[inline(always)]
    pub fn new(re: Lanes<L>, eps: Lanes<L>) -> Self {
        Self { re, eps }
    }

    /// That of one lane.
    #[inline(always)]
    pub fn of_lane(&self, lane: usize) -> Dual64 {
        Dual64::new(self.re.0[lane], self.eps.0[lane])
    }

    /// A function of the numbers, by its values and slopes there.
    #[inline(always)]
    fn chain(self, value: Lanes<L>, slope: Lanes<L>) -> Self {
        Self::new(value, self.eps * slope)
    }
}

impl<const L: usize> Add for DualLanes<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.eps + other.eps)
    }
}

impl<const L: usize> Sub for DualLanes<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.eps - other.eps)
    }
}

impl<const L: usize> Mul for DualLanes<L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self.re * other.re, self.eps * other.re + other.eps * self.re)
    }
}

macro_rules! with_constants {
    ($($number:ty),*) => {$(
        impl<const L: usize> Add<$number> for DualLanes<L> {
            type Output = Self;

            #[inline(always)]
            fn add(self, other: $number) -> Self {
                Self::new(self.re + other, self.eps)
            }
        }

        impl<const L: usize> Mul<$number> for DualLanes<L> {
            type Output = Self;

            #[inline(always)]
            fn mul(self, other: $number) -> Self {
                Self::new(self.re * other, self.eps * other)
            }
        }
    )*};
}

with_constants!(f64, Lanes<L>);

impl<const L: usize> Sub<f64> for DualLanes<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        Self::new(self.re - other, self.eps)
    }
}

impl<const L: usize> Div<f64> for DualLanes<L> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: f64) -> Self {
        Self::new(self.re / other, self.eps / other)
    }
}

impl<const L: usize> Neg for DualLanes<L> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.re, -self.eps)
    }
}

macro_rules! assigning {
    ($($operator:ident $method:ident, $assigning:ident $assign:ident;)*) => {$(
        impl<const L: usize> $assigning for DualLanes<L> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}

assigning! {
    Add add, AddAssign add_assign;
    Sub sub, SubAssign sub_assign;
    Mul mul, MulAssign mul_assign;
}

impl<const L: usize> From<f64> for DualLanes<L> {
    #[inline(always)]
    fn from(number: f64) -> Self {
        Self::new(Lanes::from(number), Lanes::zero())
    }
}

impl<const L: usize> Zero for DualLanes<L> {
    #[inline(always)]
    fn zero() -> Self {
        Self::from(0.0)
    }

    fn is_zero(&self) -> bool {
        self.re.is_zero() && self.eps.is_zero()
    }
}

impl<const L: usize> One for DualLanes<L> {
    #[inline(always)]
    fn one() -> Self {
        Self::from(1.0)
    }
}

impl<const L: usize> Scalar for DualLanes<L> {
    const WIDTH: usize = L;

    type Mask = [bool; L];
    type Value = Lanes<L>;

    #[inline(always)]
    fn value(self) -> Lanes<L> {
        self.re
    }

    #[inline(always)]
    fn scaled(self, factor: Lanes<L>) -> Self {
        self * factor
    }

    #[inline(always)]
    fn less_than(self, other: f64) -> [bool; L] {
        self.re.less_than(other)
    }

    #[inline(always)]
    fn any(mask: [bool; L]) -> bool {
        Lanes::any(mask)
    }

    #[inline(always)]
    fn select(mask: [bool; L], chosen: Self, otherwise: Self) -> Self {
        Self::new(Lanes::select(mask, chosen.re, otherwise.re), Lanes::select(mask, chosen.eps, otherwise.eps))
    }

    #[inline(always)]
    fn pick<const K: usize>(self, row: impl Fn(f64) -> [f64; K]) -> [Self; K] {
        self.re.pick(row).map(|numbers| Self::new(numbers, Lanes::zero()))
    }

    #[inline(always)]
    fn look_up<const N: usize, const K: usize>(at: [Self; N], table: &impl LookUp<N, K>) -> [Self; K] {
        let mut found = [Self::zero(); K];
        for lane in 0..L {
            let of_lane = looked_up(at.map(|number| number.of_lane(lane)), table);
            for (numbers, number) in found.iter_mut().zip(of_lane) {
                (numbers.re.0[lane], numbers.eps.0[lane]) = (number.re, number.eps);
            }
        }
        found
    }

    #[inline(always)]
    fn recip(self) -> Self {
        let reciprocal = self.re.recip();
        self.chain(reciprocal, -reciprocal * reciprocal)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.re.sqrt();
        let with_slope = self.chain(root, root * self.re.recip() * 0.5);
        // Only that of zero is so small.
        Self::select(root.less_than(f64::MIN_POSITIVE), Self::new(root, Lanes::zero()), with_slope)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let value = self.re.exp();
        self.chain(value, value)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.re.ln(), self.re.recip())
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.re.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let square = self.re * self.re + x.re * x.re;
        let [by_self, by_x] = [x.re / square, -self.re / square];
        Self::new(self.re.atan2(x.re), self.eps * by_self + x.eps * by_x)
    }
}

/// A look-up of one lane, out of line: finding the cell is long.
#[inline(never)]
fn looked_up<const N: usize, const K: usize>(at: [Dual64; N], table: &impl LookUp<N, K>) -> [Dual64; K] {
    table.at(at)
}
