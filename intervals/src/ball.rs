//! Intervals as a midpoint in two words and a radius, with outward rounding.
//!
//! The midpoints follow the algorithms for which Joldes, Muller and Popescu (ACM TOMS 44, 2017,
//! article 15) prove bounds: a sum errs by at most 3 u^2 + 13 u^3 of itself, a product by at most 7
//! u^2, with u = 2^-53 (formally verified by Muller and Rideau, ACM TOMS 48, 2022). The radius
//! takes four and eight. It is itself computed in f64 and enlarged by more than its own roundings.
//! No function of a library is called but the square root of an f64, whose result is checked.

use percuss::TwoWord;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers within `radius` of `high + low`.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    high: f64,
    low: f64,
    radius: f64,
}

/// The relative error of a sum, 4 u^2.
const SUM_ERROR: f64 = 1.0 / (1_u128 << 104) as f64;
/// The relative error of a product, 8 u^2.
const PRODUCT_ERROR: f64 = 2.0 * SUM_ERROR;
/// The factor by which a radius is raised: more than eight roundings of it.
const RADIUS_FACTOR: f64 = 1.0 + 8.0 * f64::EPSILON;
/// A bound of the error that underflow adds to a product, a quotient or a square root.
const UNDERFLOW_ERROR: f64 = 1e-290;

impl Ball {
    /// Zero, exactly.
    pub const ZERO: Self = Self::exact(0.0);
    /// The number one, without any error.
    pub const ONE: Self = Self::exact(1.0);

    /// The ball of one number, without any error.
    #[inline]
    #[must_use]
    pub const fn exact(value: f64) -> Self {
        Self { high: value, low: 0.0, radius: 0.0 }
    }

    /// The sum of two words, exactly.
    #[must_use]
    pub const fn words(value: TwoWord) -> Self {
        let TwoWord { high, low } = TwoWord::sum(value.high, value.low);
        Self { high, low, radius: 0.0 }
    }

    /// All that is no further than `more >= 0` from a member.
    #[inline]
    #[must_use]
    pub const fn widened(self, more: f64) -> Self {
        Self { radius: (self.radius + more) * RADIUS_FACTOR, ..self }
    }

    /// A number not below any member; a NaN if nothing is known.
    #[inline]
    #[must_use]
    pub const fn upper(self) -> f64 {
        (self.high + (self.low + self.radius).next_up()).next_up()
    }

    /// A number not above any member.
    #[inline]
    #[must_use]
    pub const fn lower(self) -> f64 {
        (self.high + (self.low - self.radius).next_down()).next_down()
    }

    /// A number not below any member's size.
    #[inline]
    #[must_use]
    pub const fn size(self) -> f64 {
        ((self.high.abs() + self.low.abs()) + self.radius) * RADIUS_FACTOR
    }

    /// The distance of the bounds, for decisions that prove nothing.
    #[must_use]
    pub const fn width(self) -> f64 {
        self.radius
    }

    /// The midpoint, rounded: for decisions that prove nothing.
    #[must_use]
    pub const fn about(self) -> f64 {
        self.high
    }

    /// A word and how far members may be from it.
    #[inline]
    #[must_use]
    pub const fn word_and_error(self) -> (f64, f64) {
        (self.high, (self.low.abs() + self.radius) * RADIUS_FACTOR)
    }

    /// Whether the ball is the number zero alone.
    #[must_use]
    pub const fn is_exactly_zero(self) -> bool {
        self.high == 0.0 && self.low == 0.0 && self.radius == 0.0
    }

    /// Times a power of two that neither over- nor underflows.
    #[inline]
    #[must_use]
    pub const fn scaled(self, power: f64) -> Self {
        Self { high: self.high * power, low: self.low * power, radius: self.radius * power }
    }

    /// The sum.
    #[inline]
    #[must_use]
    pub const fn plus(self, other: Self) -> Self {
        let high = TwoWord::sum(self.high, other.high);
        let low = TwoWord::sum(self.low, other.low);
        let TwoWord { high, low: carried } = quick_sum(high.high, high.low + low.high);
        let TwoWord { high, low } = quick_sum(high, carried + low.low);
        let radius = ((self.radius + other.radius) + SUM_ERROR * high.abs()) * RADIUS_FACTOR;
        Self { high, low, radius }
    }

    /// The product.
    #[inline]
    #[must_use]
    pub const fn times(self, other: Self) -> Self {
        self.times_with(other, TwoWord::product(self.high, other.high))
    }

    /// The product, where that of the first words is known.
    #[inline]
    const fn times_with(self, other: Self, product: TwoWord) -> Self {
        let mixed = self.high * other.low + self.low * other.high;
        let TwoWord { high, low } = quick_sum(product.high, product.low + mixed);
        let (x, y) = (self.high.abs(), other.high.abs());
        let spread = x * other.radius + (y + other.radius) * self.radius;
        let radius = (spread + PRODUCT_ERROR * high.abs()) * RADIUS_FACTOR + UNDERFLOW_ERROR;
        Self { high, low, radius }
    }

    /// The negative.
    #[inline]
    #[must_use]
    pub const fn negated(self) -> Self {
        Self { high: -self.high, low: -self.low, radius: self.radius }
    }

    /// The quotient; of a divisor that may be zero nothing is known.
    #[must_use]
    pub const fn over(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self.plus(other.times(Self::exact(first)).negated());
        let middle = quick_sum(first, rest.high / other.high);
        let quotient = Self { high: middle.high, low: middle.low, radius: 0.0 };
        // x/y - m = (x - m y)/y
        let rest = self.plus(other.times(quotient).negated());
        let least = larger(other.lower(), -other.upper());
        let radius = if least > 0.0 {
            rest.size() / least * RADIUS_FACTOR + UNDERFLOW_ERROR
        } else {
            f64::NAN
        };
        Self { radius, ..quotient }
    }

    /// The square root of positive members; nothing is known where one may not be.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let first = self.high.sqrt();
        let rest = self - Self::exact(first) * Self::exact(first);
        let middle = quick_sum(first, rest.high / (2.0 * first));
        let root = Self { high: middle.high, low: middle.low, radius: 0.0 };
        // sqrt(x) - m = (x - m^2)/(sqrt(x) + m)
        let (rest, least) = (self - root * root, root.lower());
        let known = self.lower() > 0.0 && least > 0.0;
        let radius =
            if known { rest.size() / least * RADIUS_FACTOR + UNDERFLOW_ERROR } else { f64::NAN };
        Self { radius, ..root }
    }

    /// The square of the ball.
    #[must_use]
    pub fn square(self) -> Self {
        self * self
    }
}

/// The exact product of two words, unless it underflows; in one instruction where the processor has
/// it.
#[inline(always)]
fn product(a: f64, b: f64) -> TwoWord {
    if cfg!(target_feature = "fma") {
        let high = a * b;
        TwoWord { high, low: a.mul_add(b, -high) }
    } else {
        TwoWord::product(a, b)
    }
}

/// The exact sum where `|a| >= |b|`.
#[inline]
const fn quick_sum(a: f64, b: f64) -> TwoWord {
    let high = a + b;
    TwoWord { high, low: b - (high - a) }
}

const fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

impl Add for Ball {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.plus(other)
    }
}

impl Sub for Ball {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.plus(other.negated())
    }
}

impl Mul for Ball {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.times_with(other, product(self.high, other.high))
    }
}

impl Div for Ball {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.over(other)
    }
}

impl Neg for Ball {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.negated()
    }
}
