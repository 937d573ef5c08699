//! The small interface through which the closed forms see a number.
//!
//! The formulas are written once and evaluated in f64, in double-double for the truth, and in any
//! other arithmetic that wraps itself in this trait.

pub use crate::numeric::bound::{Bound, ScaledF64};
use crate::numeric::circle;
use crate::numeric::exponential;
use crate::numeric::two_word::TwoWord;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, as the closed forms need it.
pub trait Number:
    Copy
    + Send
    + Sync
    + Debug
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The number of terms that a Taylor series with factorials needs at argument 1 to reach the
    /// last digit: the least n with 1/(2 n + 1)! below half a unit (9 for f64, 14 for 106 bits).
    const TERMS: usize;

    /// The number of f64 that are summed to a number that has all of its digits.
    const WORDS: usize;

    /// The numbers in which bounds of errors are kept: f64, unless it has too few exponents.
    type Bound: Bound;

    /// The unit roundoff: a bound of the relative error of each operation.
    fn unit() -> Self::Bound;

    /// The number, rounded to the digits of a bound.
    fn bound(self) -> Self::Bound;

    /// The number with the value of a bound, exactly.
    fn of_bound(bound: Self::Bound) -> Self;

    /// The number times a power of two.
    #[must_use]
    fn scaled(self, exponent: i64) -> Self;

    /// The number with this f64 value, exactly.
    fn exact(value: f64) -> Self;

    /// Rounded to f64.
    fn to_f64(self) -> f64;

    /// Sine and cosine, radians.
    fn sin_cos(self) -> (Self, Self);

    /// The exponential function.
    fn exp(self) -> Self;

    /// The square root of a number that is not negative.
    fn sqrt(self) -> Self;

    /// What rounding took from the product `self * other` (zero where it does not matter).
    fn product_error(self, other: Self) -> Self;

    /// sqrt(1 - xi^2) for 0 < xi < 1 and what rounding took from it.
    fn damped_frequency(xi: Self) -> (Self, Self);

    /// 1/n! for n <= 2 `TERMS` + 2, correctly rounded.
    fn inverse_factorial(n: usize) -> Self;

    /// Zero.
    #[must_use]
    fn zero() -> Self {
        Self::exact(0.0)
    }

    /// One.
    #[must_use]
    fn one() -> Self {
        Self::exact(1.0)
    }

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self {
        if self < Self::zero() { -self } else { self }
    }
}

/// 1/n!
const INVERSE_FACTORIALS: [f64; 21] = {
    let mut table = [1.0; 21];
    let mut factorial = 1_u64;
    let mut n = 1;
    while n < 21 {
        factorial *= n as u64; // 20! < 2^63, and its odd part < 2^53: exact as f64
        table[n] = 1.0 / factorial as f64;
        n += 1;
    }
    table
};

impl Number for f64 {
    const TERMS: usize = 9;

    const WORDS: usize = 1;

    type Bound = Self;

    #[inline]
    fn unit() -> Self {
        0.5 * Self::EPSILON
    }

    #[inline]
    fn bound(self) -> Self {
        self
    }

    #[inline]
    fn of_bound(bound: Self) -> Self {
        bound
    }

    fn scaled(self, exponent: i64) -> Self {
        Bound::scaled(self, exponent)
    }

    #[inline]
    fn exact(value: f64) -> Self {
        value
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        circle::sin_cos(self)
    }

    #[inline]
    fn exp(self) -> Self {
        exponential::exp(self)
    }

    #[inline]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline]
    fn product_error(self, other: Self) -> Self {
        TwoWord::product(self, other).low
    }

    fn damped_frequency(xi: Self) -> (Self, Self) {
        let square = TwoWord::new(1.0).minus(TwoWord::product(xi, xi));
        let nu = square.value().sqrt();
        let rest = square.minus(TwoWord::product(nu, nu));
        (nu, rest.value() / (2.0 * nu))
    }

    #[inline]
    fn inverse_factorial(n: usize) -> Self {
        INVERSE_FACTORIALS[n]
    }

    #[inline]
    fn abs(self) -> Self {
        self.abs()
    }
}
