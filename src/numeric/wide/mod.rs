//! Floating-point numbers of a chosen number of bits, for runs that 106 bits do not decide.
//!
//! A number is a sign, so many words of 64 bits, and an exponent that neither overflows nor
//! underflows. It is copied like an f64, so the solver's generic code serves it as it stands. Each
//! operation is good to two units of the last word's last bit; an arithmetic declares fewer bits
//! than its words have, so that a few operations stay within its unit ([`Number::unit`]).
//!
//! [`limbs`] has sums, shifts and products of words; this file the numbers and their arithmetic;
//! [`functions`] roots, the exponential, and sine and cosine. Read this file first.
//!
//! [`Number::unit`]: crate::number::Number::unit

mod functions;
mod limbs;

use crate::numeric::bound::{Bound, ScaledF64};
use crate::numeric::number::Number;
use limbs::{add_into, compare, quotient_by_word, shifted_left, shifted_right, subtract_from};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The largest number of words of a number.
const MAX_WORDS: usize = 54;

/// A number of `WORDS` words, of which the arithmetic declares `BITS` bits.
#[derive(Clone, Copy)]
pub struct Wide<const WORDS: usize, const BITS: usize> {
    kind: Kind,
    is_negative: bool,
    /// The number is 0.words times this power of two; the highest bit of the words is set.
    exponent: i64,
    /// The lowest word first.
    words: [u64; WORDS],
}

/// Numbers of 212 bits.
pub type Bits212 = Wide<4, 212>;

/// Numbers of 424 bits.
pub type Bits424 = Wide<7, 424>;

/// Numbers of 848 bits.
pub type Bits848 = Wide<14, 848>;

/// Numbers of 1696 bits.
pub type Bits1696 = Wide<27, 1696>;

/// Numbers of 3392 bits.
pub type Bits3392 = Wide<54, 3392>;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Zero,
    Ordinary,
    /// Not a number, or infinite: nothing follows from it.
    Unknown,
}

impl<const WORDS: usize, const BITS: usize> Wide<WORDS, BITS> {
    const ZERO: Self =
        Self { kind: Kind::Zero, is_negative: false, exponent: 0, words: [0; WORDS] };
    const UNKNOWN: Self = Self { kind: Kind::Unknown, ..Self::ZERO };

    /// The number of the highest words of `words`, lowest first, times a power of two: they are a
    /// fraction, rounded here.
    fn rounded(is_negative: bool, exponent: i64, words: &mut [u64]) -> Self {
        let Some(top) = words.iter().rposition(|it| *it != 0) else { return Self::ZERO };
        let zeros = 64 * (words.len() - 1 - top) + words[top].leading_zeros() as usize;
        shifted_left(words, zeros);
        let mut exponent = exponent - zeros as i64;
        let mut kept = [0; WORDS];
        let below = words.len().saturating_sub(WORDS);
        kept[WORDS - (words.len() - below)..].copy_from_slice(&words[below..]);
        if below > 0 && words[below - 1] >> 63 == 1 && add_into(&mut kept, &[1]) {
            // All bits were set.
            kept[WORDS - 1] = 1 << 63;
            exponent += 1;
        }
        Self { kind: Kind::Ordinary, is_negative, exponent, words: kept }
    }

    /// A whole number.
    fn from_whole(value: u64) -> Self {
        Self::rounded(false, 64, &mut [value])
    }

    /// A fraction of constant words, lowest first, times a power of two.
    fn constant(words: &[u64], exponent: i64) -> Self {
        let mut copy = [0; MAX_WORDS + 2];
        copy[..words.len()].copy_from_slice(words);
        Self::rounded(false, exponent, &mut copy[..words.len()])
    }

    /// The number divided by a small whole one.
    fn over(self, divisor: u64) -> Self {
        if self.kind != Kind::Ordinary {
            return self;
        }
        let mut words = [0; MAX_WORDS + 1];
        words[1..=WORDS].copy_from_slice(&self.words);
        quotient_by_word(&mut words[..=WORDS], divisor);
        Self::rounded(self.is_negative, self.exponent, &mut words[..=WORDS])
    }

    /// The order of two sizes.
    fn compare_sizes(&self, other: &Self) -> Ordering {
        self.exponent.cmp(&other.exponent).then_with(|| compare(&self.words, &other.words))
    }

    /// The sum, or the difference, of the sizes of two ordinary numbers; the first is the larger.
    fn join(large: &Self, small: &Self, is_sum: bool) -> Self {
        let apart = (large.exponent - small.exponent) as u64;
        if apart >= 64 * (WORDS as u64 + 1) {
            return *large;
        }
        // One word below both for what is shifted out of the small one, one above for a carry.
        let (mut sum, mut other) = ([0; MAX_WORDS + 2], [0; MAX_WORDS + 2]);
        let (sum, other) = (&mut sum[..WORDS + 2], &mut other[..WORDS + 2]);
        sum[1..=WORDS].copy_from_slice(&large.words);
        other[1..=WORDS].copy_from_slice(&small.words);
        shifted_right(other, apart as usize);
        if is_sum {
            add_into(sum, other);
        } else {
            subtract_from(sum, other);
        }
        Self::rounded(large.is_negative, large.exponent + 64, sum)
    }
}

impl<const WORDS: usize, const BITS: usize> Default for Wide<WORDS, BITS> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const WORDS: usize, const BITS: usize> Wide<WORDS, BITS> {
    /// The number rounded to f64; infinite or zero where f64 has no such exponent.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        Number::to_f64(self)
    }
}

impl<const WORDS: usize, const BITS: usize> std::fmt::Debug for Wide<WORDS, BITS> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}", self.bound())
    }
}

impl<const WORDS: usize, const BITS: usize> PartialEq for Wide<WORDS, BITS> {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl<const WORDS: usize, const BITS: usize> PartialOrd for Wide<WORDS, BITS> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        let sign = |it: &Self| match it.kind {
            Kind::Zero => Some(0),
            Kind::Ordinary => Some(if it.is_negative { -1 } else { 1 }),
            Kind::Unknown => None,
        };
        let (own, others) = (sign(self)?, sign(other)?);
        if own != others || own == 0 {
            return Some(own.cmp(&others));
        }
        let sizes = self.compare_sizes(other);
        Some(if own < 0 { sizes.reverse() } else { sizes })
    }
}

impl<const WORDS: usize, const BITS: usize> Neg for Wide<WORDS, BITS> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { is_negative: !self.is_negative, ..self }
    }
}

impl<const WORDS: usize, const BITS: usize> Add for Wide<WORDS, BITS> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        match (self.kind, other.kind) {
            (Kind::Unknown, _) | (_, Kind::Unknown) => return Self::UNKNOWN,
            (Kind::Zero, _) => return other,
            (_, Kind::Zero) => return self,
            _ => {}
        }
        let is_sum = self.is_negative == other.is_negative;
        match self.compare_sizes(&other) {
            Ordering::Equal if !is_sum => Self::ZERO,
            Ordering::Less => Self::join(&other, &self, is_sum),
            _ => Self::join(&self, &other, is_sum),
        }
    }
}

impl<const WORDS: usize, const BITS: usize> Sub for Wide<WORDS, BITS> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const WORDS: usize, const BITS: usize> Mul for Wide<WORDS, BITS> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        match (self.kind, other.kind) {
            (Kind::Unknown, _) | (_, Kind::Unknown) => return Self::UNKNOWN,
            (Kind::Zero, _) | (_, Kind::Zero) => return Self::ZERO,
            _ => {}
        }
        let mut product = [0; MAX_WORDS + 2];
        let product = &mut product[..WORDS + 2];
        limbs::high_product(&self.words, &other.words, product);
        let is_negative = self.is_negative != other.is_negative;
        Self::rounded(is_negative, self.exponent + other.exponent, product)
    }
}

impl<const WORDS: usize, const BITS: usize> Div for Wide<WORDS, BITS> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        match (self.kind, other.kind) {
            (Kind::Unknown, _) | (_, Kind::Unknown | Kind::Zero) => return Self::UNKNOWN,
            (Kind::Zero, _) => return Self::ZERO,
            _ => {}
        }
        if other.words[..WORDS - 1].iter().all(|it| *it == 0) {
            // A whole number, most often.
            let quotient = self.over(other.words[WORDS - 1]);
            let is_negative = self.is_negative != other.is_negative;
            return Self { is_negative, ..quotient.scaled(64 - other.exponent) };
        }
        let inverse = other.inverse();
        let quotient = self * inverse;
        // One more step of Newton's, because the product of two roundings may be two units off.
        quotient + (self - quotient * other) * inverse
    }
}

impl<const WORDS: usize, const BITS: usize> Number for Wide<WORDS, BITS> {
    type Bound = ScaledF64;

    const TERMS: usize = terms(BITS);

    const WORDS: usize = BITS.div_ceil(53) + 1;

    fn unit() -> ScaledF64 {
        ScaledF64::new(1.0, -(BITS as i64))
    }

    fn exact(value: f64) -> Self {
        if !value.is_finite() {
            return Self::UNKNOWN;
        }
        let (mantissa, exponent) = value.parts();
        if mantissa == 0.0 {
            return Self::ZERO;
        }
        // 1 or more and below 2: 53 bits.
        let whole = (mantissa.abs() * (1_u64 << 52) as f64) as u64;
        Self::rounded(value < 0.0, exponent + 12, &mut [whole])
    }

    fn to_f64(self) -> f64 {
        self.bound().to_f64()
    }

    fn bound(self) -> ScaledF64 {
        match self.kind {
            Kind::Zero => ScaledF64::ZERO,
            Kind::Unknown => ScaledF64::from_f64(f64::NAN),
            Kind::Ordinary => {
                // An odd word keeps on which side of a tie the others are.
                let rest = self.words[..WORDS - 1].iter().any(|it| *it != 0);
                let top = (self.words[WORDS - 1] | u64::from(rest)) as f64;
                let size = if self.is_negative { -top } else { top };
                ScaledF64::new(size, self.exponent - 64)
            }
        }
    }

    fn of_bound(bound: ScaledF64) -> Self {
        let (mantissa, exponent) = bound.parts();
        Self::exact(mantissa).scaled(exponent)
    }

    fn scaled(self, exponent: i64) -> Self {
        Self { exponent: self.exponent + exponent, ..self }
    }

    fn sin_cos(self) -> (Self, Self) {
        self.sine_and_cosine()
    }

    fn exp(self) -> Self {
        self.exponential()
    }

    fn sqrt(self) -> Self {
        self.square_root()
    }

    fn product_error(self, _: Self) -> Self {
        Self::ZERO
    }

    fn damped_frequency(xi: Self) -> (Self, Self) {
        ((Self::one() - xi * xi).sqrt(), Self::ZERO)
    }

    fn inverse_factorial(n: usize) -> Self {
        (2..=n as u64).fold(Self::one(), Self::over)
    }

    fn one() -> Self {
        Self::from_whole(1)
    }

    fn abs(self) -> Self {
        Self { is_negative: false, ..self }
    }
}

/// The least n with 1/(2 n + 1)! below half a unit of so many bits.
const fn terms(bits: usize) -> usize {
    let (mut n, mut factorial, mut powers) = (1, 6.0, 0);
    loop {
        while factorial >= 2.0 {
            factorial *= 0.5;
            powers += 1;
        }
        if powers > bits {
            return n;
        }
        n += 1;
        factorial *= (2 * n * (2 * n + 1)) as f64;
    }
}

#[cfg(test)]
mod tests;
