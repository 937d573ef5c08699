//! Numbers for bounds of errors: the digits of f64 are enough for them, its exponents are not where
//! an arithmetic has more than some thousand bits, or numbers of any size.

use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

/// A number for bounds, with the digits of f64.
pub trait Bound:
    Copy
    + Send
    + Sync
    + Debug
    + Default
    + PartialOrd
    + PartialOrd<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + MulAssign
    + MulAssign<f64>
    + Sum
{
    /// Zero.
    const ZERO: Self;

    /// Infinity.
    const INFINITY: Self;

    /// A bound of the error that underflow makes in a few operations; nothing in f64 is smaller
    /// than one 64th of it. Zero for numbers that do not underflow.
    const UNDERFLOW: Self;

    /// More than [`Bound::UNDERFLOW`] where it need not be sharp: sums and products of it are no
    /// subnormal numbers, with which processors are slow.
    const COARSE_UNDERFLOW: Self;

    /// A bound of the error where the last word of a number underflows.
    const LAST_WORD_UNDERFLOW: Self;

    /// The number with this f64 value.
    fn from_f64(value: f64) -> Self;

    /// The f64 next to it: infinite or zero where f64 has no such exponents.
    fn to_f64(self) -> f64;

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// The larger one; the other one of a NaN.
    #[must_use]
    fn max(self, other: Self) -> Self;

    /// The smaller one; the other one of a NaN.
    #[must_use]
    fn min(self, other: Self) -> Self;

    /// The square root of a number that is not negative.
    #[must_use]
    fn sqrt(self) -> Self;

    /// Whether it is neither infinite nor a NaN.
    fn is_finite(self) -> bool;

    /// The exponential function.
    fn exp(exponent: f64) -> Self;

    /// The number times a power of two.
    #[must_use]
    fn scaled(self, exponent: i64) -> Self;

    /// A root of any degree, good to some per cent.
    #[must_use]
    fn approximate_root(self, degree: usize) -> Self;

    /// The mantissa, at least 1 and below 2 in size, and the exponent of two; the mantissa is the
    /// number itself where that is zero, infinite or a NaN.
    fn parts(self) -> (f64, i64);
}

impl Bound for f64 {
    const ZERO: Self = 0.0;
    const INFINITY: Self = Self::INFINITY;
    const UNDERFLOW: Self = Self::from_bits(64);
    const COARSE_UNDERFLOW: Self = 1e-300;
    const LAST_WORD_UNDERFLOW: Self = 1e-280;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline]
    fn max(self, other: Self) -> Self {
        self.max(other)
    }

    #[inline]
    fn min(self, other: Self) -> Self {
        self.min(other)
    }

    #[inline]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.is_finite()
    }

    #[inline]
    fn exp(exponent: f64) -> Self {
        libm::exp(exponent)
    }

    fn scaled(self, exponent: i64) -> Self {
        libm::scalbn(self, exponent.clamp(-5000, 5000) as i32)
    }

    /// The bits of a number are nearly its logarithm, which is divided.
    #[inline]
    fn approximate_root(self, degree: usize) -> Self {
        const ONE: u64 = 1.0_f64.to_bits();
        if self == 0.0 || self == Self::INFINITY || self.is_nan() {
            return self;
        }
        let bits = self.to_bits();
        let share = |bits: u64| bits / degree as u64;
        Self::from_bits(if bits >= ONE { ONE + share(bits - ONE) } else { ONE - share(ONE - bits) })
    }

    fn parts(self) -> (f64, i64) {
        if self == 0.0 || !self.is_finite() {
            return (self, 0);
        }
        let (mantissa, exponent) = libm::frexp(self);
        (2.0 * mantissa, i64::from(exponent) - 1)
    }
}

/// A number with the digits of f64 and an exponent of its own.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScaledF64 {
    /// At least 1 and below 2 in size, or zero, infinite or a NaN with an exponent of zero.
    mantissa: f64,
    exponent: i64,
}

impl ScaledF64 {
    /// `mantissa * 2^exponent`.
    #[inline]
    #[must_use]
    pub fn new(mantissa: f64, exponent: i64) -> Self {
        let (mantissa, shift) = mantissa.parts();
        if mantissa == 0.0 || !mantissa.is_finite() {
            return Self { mantissa, exponent: 0 };
        }
        Self { mantissa, exponent: exponent.saturating_add(shift) }
    }

    /// The number as a bound of any kind.
    #[must_use]
    pub fn rounded<B: Bound>(self) -> B {
        B::from_f64(self.mantissa).scaled(self.exponent)
    }

    /// Whether the exponent has a meaning.
    #[inline]
    fn is_ordinary(self) -> bool {
        self.mantissa != 0.0 && self.mantissa.is_finite()
    }
}

impl PartialEq for ScaledF64 {
    fn eq(&self, other: &Self) -> bool {
        self.mantissa == other.mantissa && self.exponent == other.exponent
    }
}

impl PartialOrd for ScaledF64 {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        let same_sign = (self.mantissa < 0.0) == (other.mantissa < 0.0);
        if !(self.is_ordinary() && other.is_ordinary() && same_sign) {
            return self.mantissa.partial_cmp(&other.mantissa);
        }
        let exponents = self.exponent.cmp(&other.exponent);
        let exponents = if self.mantissa < 0.0 { exponents.reverse() } else { exponents };
        if exponents.is_ne() {
            return Some(exponents);
        }
        self.mantissa.partial_cmp(&other.mantissa)
    }
}

impl PartialEq<f64> for ScaledF64 {
    fn eq(&self, other: &f64) -> bool {
        *self == Self::from_f64(*other)
    }
}

impl PartialOrd<f64> for ScaledF64 {
    fn partial_cmp(&self, other: &f64) -> Option<std::cmp::Ordering> {
        self.partial_cmp(&Self::from_f64(*other))
    }
}

impl Add for ScaledF64 {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        /// The largest difference of exponents at which the smaller number is above the rounding of
        /// the larger.
        const MAX_EXPONENT_GAP: i64 = 64;
        if !(self.is_ordinary() && other.is_ordinary()) {
            if self.mantissa == 0.0 {
                return other;
            }
            if other.mantissa == 0.0 {
                return self;
            }
            return Self::new(self.mantissa + other.mantissa, 0);
        }
        let (large, small) =
            if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        let apart = large.exponent.saturating_sub(small.exponent);
        if apart > MAX_EXPONENT_GAP {
            return large;
        }
        let share = f64::from_bits(((1023 - apart) as u64) << 52);
        Self::new(large.mantissa + small.mantissa * share, large.exponent)
    }
}

impl Neg for ScaledF64 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { mantissa: -self.mantissa, ..self }
    }
}

impl Sub for ScaledF64 {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for ScaledF64 {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::new(self.mantissa * other.mantissa, self.exponent.saturating_add(other.exponent))
    }
}

impl Div for ScaledF64 {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        Self::new(self.mantissa / other.mantissa, self.exponent.saturating_sub(other.exponent))
    }
}

impl Mul<f64> for ScaledF64 {
    type Output = Self;
    #[inline]
    fn mul(self, other: f64) -> Self {
        self * Self::from_f64(other)
    }
}

impl Div<f64> for ScaledF64 {
    type Output = Self;
    #[inline]
    fn div(self, other: f64) -> Self {
        self / Self::from_f64(other)
    }
}

impl AddAssign for ScaledF64 {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl MulAssign for ScaledF64 {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl MulAssign<f64> for ScaledF64 {
    #[inline]
    fn mul_assign(&mut self, other: f64) {
        *self = *self * other;
    }
}

impl Sum for ScaledF64 {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::ZERO, |sum, it| sum + it)
    }
}

impl Bound for ScaledF64 {
    const ZERO: Self = Self { mantissa: 0.0, exponent: 0 };
    const INFINITY: Self = Self { mantissa: f64::INFINITY, exponent: 0 };
    const UNDERFLOW: Self = Self::ZERO;
    const COARSE_UNDERFLOW: Self = Self::ZERO;
    const LAST_WORD_UNDERFLOW: Self = Self::ZERO;

    #[inline]
    fn from_f64(value: f64) -> Self {
        Self::new(value, 0)
    }

    fn to_f64(self) -> f64 {
        self.mantissa.scaled(self.exponent)
    }

    #[inline]
    fn abs(self) -> Self {
        Self { mantissa: self.mantissa.abs(), ..self }
    }

    #[inline]
    fn max(self, other: Self) -> Self {
        if self >= other || other.mantissa.is_nan() { self } else { other }
    }

    #[inline]
    fn min(self, other: Self) -> Self {
        if self <= other || other.mantissa.is_nan() { self } else { other }
    }

    fn sqrt(self) -> Self {
        let odd = self.exponent.rem_euclid(2);
        let mantissa = if odd == 1 { 2.0 * self.mantissa } else { self.mantissa };
        Self::new(mantissa.sqrt(), (self.exponent - odd) / 2)
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.mantissa.is_finite()
    }

    fn exp(exponent: f64) -> Self {
        /// The largest exponent at which an f64 tells one power of two from the next.
        const MAX_EXPONENT: f64 = 1e15;
        let powers = (exponent / std::f64::consts::LN_2).round();
        if exponent < -MAX_EXPONENT {
            return Self::ZERO;
        }
        if powers.abs() > MAX_EXPONENT || exponent.is_nan() {
            return Self { mantissa: exponent, exponent: 0 };
        }
        // The logarithm of two in two words.
        const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
        const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
        let rest = (exponent - powers * LN_2_HIGH) - powers * LN_2_LOW;
        Self::new(libm::exp(rest), powers as i64)
    }

    fn scaled(self, exponent: i64) -> Self {
        Self::new(self.mantissa, self.exponent.saturating_add(exponent))
    }

    fn approximate_root(self, degree: usize) -> Self {
        if !self.is_ordinary() {
            return self;
        }
        let degree = degree as i64;
        let rest = self.exponent.rem_euclid(degree);
        let logarithm = libm::log2(self.mantissa) + rest as f64;
        let root = libm::exp2(logarithm / degree as f64);
        Self::new(root, (self.exponent - rest) / degree)
    }

    fn parts(self) -> (f64, i64) {
        (self.mantissa, self.exponent)
    }
}
