//! The arithmetic in which the solver and its vectors share their formulas.
//!
//! A formula that is written over [`Real`] is one text for f64, for 106 bits and for all lanes of a
//! vector, and so is the theorem behind it. Every [`Number`] is such a real number, which rounds
//! products and sums one by one; a vector rounds them once where [`Real::times_plus`] says so.
//!
//! Functions over it are always inlined: a vector's instructions are chosen where it is used.

use crate::numeric::number::Number;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A real number, or one of each lane.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Whether something holds, or in which lanes.
    type Mask: Copy
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + Not<Output = Self::Mask>;

    /// An f64, exactly, in all lanes of this one.
    #[must_use]
    fn broadcast(self, value: f64) -> Self;

    /// `self * factor + term`.
    #[must_use]
    fn times_plus(self, factor: Self, term: Self) -> Self;

    /// `term - self * factor`.
    #[must_use]
    fn times_from(self, factor: Self, term: Self) -> Self;

    /// The absolute value.
    #[must_use]
    fn magnitude(self) -> Self;

    /// Whether it is less than another; not if either is a NaN.
    fn less(self, other: Self) -> Self::Mask;

    /// One value where the mask holds, the other elsewhere.
    #[must_use]
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The larger one; of a NaN nothing is promised.
    #[inline(always)]
    #[must_use]
    fn larger(self, other: Self) -> Self {
        Self::choose(self.less(other), other, self)
    }

    /// The smaller one; of a NaN nothing is promised.
    #[inline(always)]
    #[must_use]
    fn smaller(self, other: Self) -> Self {
        Self::choose(other.less(self), other, self)
    }
}

impl<T: Number> Real for T {
    type Mask = bool;

    #[inline(always)]
    fn broadcast(self, value: f64) -> Self {
        T::exact(value)
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        self * factor + term
    }

    #[inline(always)]
    fn times_from(self, factor: Self, term: Self) -> Self {
        term - self * factor
    }

    #[inline(always)]
    fn magnitude(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn choose(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

/// A polynomial, lowest coefficient first.
#[inline(always)]
pub fn polynomial<T: Real, const N: usize>(x: T, coefficients: [f64; N]) -> T {
    let mut sum = x.broadcast(coefficients[N - 1]);
    for coefficient in coefficients.into_iter().rev().skip(1) {
        sum = sum.times_plus(x, x.broadcast(coefficient));
    }
    sum
}
