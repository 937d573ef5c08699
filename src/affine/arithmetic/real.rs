//! Real and complex numbers of several hundred bits, in which a mode's matrix is taken apart once.

use crate::affine::model::rational::Rational;
use crate::numeric::number::{Bound, Number};
use dashu::float::FBig;
use dashu::float::round::mode::HalfEven;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The fewest bits of a number. A projector loses what the gaps between eigenvalues take, at most
/// some hundred bits for twelve eigenvalues that are not merged.
const MIN_BITS: usize = 640;

/// The bits in which a mode is taken apart for an arithmetic: twice its own, and room for what gaps
/// between eigenvalues take.
pub fn bits_for<T: Number>() -> usize {
    if T::WORDS <= 2 { MIN_BITS } else { 106 * T::WORDS + 240 }
}

type BigFloat = FBig<HalfEven, 2>;

/// A real number of at least [`MIN_BITS`] bits. A result has the bits of the longer operand.
#[derive(Clone, Debug)]
pub struct BigReal(BigFloat);

impl BigReal {
    pub fn zero() -> Self {
        Self::exact(0.0)
    }

    pub fn one() -> Self {
        Self::exact(1.0)
    }

    /// A finite f64, exactly.
    pub fn exact(value: f64) -> Self {
        // Norms of large coefficients may overflow f64, and nothing is computed with an infinity.
        // What is not a number does not come from a system that has been read.
        let finite = value.clamp(f64::MIN, f64::MAX);
        let value = BigFloat::try_from(finite).unwrap_or(BigFloat::ZERO);
        Self(value.with_precision(MIN_BITS).value())
    }

    /// A rational number, rounded to so many bits.
    pub fn new(number: &Rational, bits: usize) -> Self {
        Self(number.big().to_float::<HalfEven, 2>(bits).value().with_precision(bits).value())
    }

    /// The bits of the number.
    pub fn bits(&self) -> usize {
        self.0.precision()
    }

    /// The exponent of two by which the number is divided to be at least 1/2 and below 1 in size;
    /// zero for zero.
    pub fn exponent(&self) -> isize {
        if self.is_zero() { 0 } else { self.0.repr().exponent() + self.0.repr().digits() as isize }
    }

    /// The number, rounded to the digits of a bound.
    pub fn bound<B: Bound>(&self) -> B {
        let exponent = self.exponent();
        B::from_f64(self.scaled(-exponent).to_f64()).scaled(exponent as i64)
    }

    pub fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }

    /// The number in two words, the second of which is what rounding to the first left.
    pub fn words(&self) -> (f64, f64) {
        let high = self.to_f64();
        if !high.is_finite() {
            return (high, 0.0);
        }
        (high, (self - &Self::exact(high)).to_f64())
    }

    pub fn is_zero(&self) -> bool {
        self.0 == BigFloat::ZERO
    }

    pub fn abs(&self) -> Self {
        if self.0 < BigFloat::ZERO { -self } else { self.clone() }
    }

    pub fn sqrt(&self) -> Self {
        if self.is_zero() {
            return Self::zero();
        }
        Self(self.0.sqrt().with_precision(self.bits()).value())
    }

    /// `self * 2^exponent`, exactly.
    pub fn scaled(&self, exponent: isize) -> Self {
        Self(if exponent >= 0 {
            self.0.clone() << exponent
        } else {
            self.0.clone() >> exponent.unsigned_abs() as isize
        })
    }
}

impl PartialEq for BigReal {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl PartialOrd for BigReal {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

impl Neg for &BigReal {
    type Output = BigReal;
    fn neg(self) -> BigReal {
        BigReal(-self.0.clone())
    }
}

macro_rules! operation {
    ($trait:ident, $name:ident, $symbol:tt) => {
        impl $trait for &BigReal {
            type Output = BigReal;
            fn $name(self, other: &BigReal) -> BigReal {
                let bits = self.bits().max(other.bits());
                BigReal((&self.0 $symbol &other.0).with_precision(bits).value())
            }
        }
    };
}

operation!(Add, add, +);
operation!(Sub, sub, -);
operation!(Mul, mul, *);
operation!(Div, div, /);

/// A complex number.
#[derive(Clone, Debug)]
pub struct BigComplex {
    pub re: BigReal,
    pub im: BigReal,
}

impl BigComplex {
    pub fn new(re: BigReal, im: BigReal) -> Self {
        Self { re, im }
    }

    pub fn real(re: BigReal) -> Self {
        Self { re, im: BigReal::zero() }
    }

    pub fn norm_square(&self) -> BigReal {
        &(&self.re * &self.re) + &(&self.im * &self.im)
    }

    pub fn norm(&self) -> BigReal {
        self.norm_square().sqrt()
    }

    pub fn inverse(&self) -> Self {
        let square = self.norm_square();
        Self::new(&self.re / &square, &(-&self.im) / &square)
    }
}

impl Add for &BigComplex {
    type Output = BigComplex;
    fn add(self, other: &BigComplex) -> BigComplex {
        BigComplex::new(&self.re + &other.re, &self.im + &other.im)
    }
}

impl Sub for &BigComplex {
    type Output = BigComplex;
    fn sub(self, other: &BigComplex) -> BigComplex {
        BigComplex::new(&self.re - &other.re, &self.im - &other.im)
    }
}

impl Mul for &BigComplex {
    type Output = BigComplex;
    fn mul(self, other: &BigComplex) -> BigComplex {
        let re = &(&self.re * &other.re) - &(&self.im * &other.im);
        let im = &(&self.re * &other.im) + &(&self.im * &other.re);
        BigComplex::new(re, im)
    }
}
