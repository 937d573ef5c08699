//! Real and complex numbers of several hundred bits, in which a mode's matrix is taken apart once.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use dashu_ratio::RBig;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Bits of every number. A projector loses what the gaps between eigenvalues take, at most some
/// hundred bits for twelve eigenvalues that are not merged.
pub const BITS: usize = 640;

type Wide = FBig<HalfEven, 2>;

/// A real number of [`BITS`] bits.
#[derive(Clone, Debug)]
pub struct Real(Wide);

impl Real {
    pub fn zero() -> Self {
        Self::exact(0.0)
    }

    pub fn one() -> Self {
        Self::exact(1.0)
    }

    /// A finite f64, exactly.
    pub fn exact(value: f64) -> Self {
        // Not a number, and infinity, do not come from a system that has been read.
        Self(Wide::try_from(value).unwrap_or(Wide::ZERO).with_precision(BITS).value())
    }

    pub fn of(number: &RBig) -> Self {
        Self(number.to_float::<HalfEven, 2>(BITS).value().with_precision(BITS).value())
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
        self.0 == Wide::ZERO
    }

    pub fn abs(&self) -> Self {
        if self.0 < Wide::ZERO { -self } else { self.clone() }
    }

    pub fn sqrt(&self) -> Self {
        if self.is_zero() {
            return Self::zero();
        }
        Self(self.0.sqrt().with_precision(BITS).value())
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

impl PartialEq for Real {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl PartialOrd for Real {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

impl Neg for &Real {
    type Output = Real;
    fn neg(self) -> Real {
        Real(-self.0.clone())
    }
}

macro_rules! operation {
    ($trait:ident, $name:ident, $symbol:tt) => {
        impl $trait for &Real {
            type Output = Real;
            fn $name(self, other: &Real) -> Real {
                Real((&self.0 $symbol &other.0).with_precision(BITS).value())
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
pub struct Complex {
    pub re: Real,
    pub im: Real,
}

impl Complex {
    pub fn new(re: Real, im: Real) -> Self {
        Self { re, im }
    }

    pub fn real(re: Real) -> Self {
        Self { re, im: Real::zero() }
    }

    pub fn norm_square(&self) -> Real {
        &(&self.re * &self.re) + &(&self.im * &self.im)
    }

    pub fn norm(&self) -> Real {
        self.norm_square().sqrt()
    }

    pub fn inverse(&self) -> Self {
        let square = self.norm_square();
        Self::new(&self.re / &square, &(-&self.im) / &square)
    }
}

impl Add for &Complex {
    type Output = Complex;
    fn add(self, other: &Complex) -> Complex {
        Complex::new(&self.re + &other.re, &self.im + &other.im)
    }
}

impl Sub for &Complex {
    type Output = Complex;
    fn sub(self, other: &Complex) -> Complex {
        Complex::new(&self.re - &other.re, &self.im - &other.im)
    }
}

impl Mul for &Complex {
    type Output = Complex;
    fn mul(self, other: &Complex) -> Complex {
        let re = &(&self.re * &other.re) - &(&self.im * &other.im);
        let im = &(&self.re * &other.im) + &(&self.im * &other.re);
        Complex::new(re, im)
    }
}
