//! Time, and the angle of the forcing, as a sum of two numbers that is never rounded to one.

use super::real::{BigReal, bits_for};
use super::vector::{is_f64, rounded, turned};
use crate::affine::model::rational::Rational;
use crate::affine::model::system::Forcing;
use crate::numeric::number::{Bound, Number};

/// A time in two words of an arithmetic.
#[derive(Clone, Copy, Debug)]
pub struct Time<T> {
    /// The time, rounded.
    pub high: T,
    /// The rounding error of `high`.
    pub low: T,
}

/// The phase of the forcing, theta = omega t + phi, at any time.
#[derive(Clone, Copy, Debug)]
pub struct Clock<T> {
    omega: Time<T>,
    phi: Time<T>,
}

impl<T: Number> Time<T> {
    /// A rational time, rounded to two words.
    #[must_use]
    pub fn new(number: &Rational) -> Self {
        let real = BigReal::new(number, bits_for::<T>());
        if is_f64::<T>() {
            let (high, low) = real.words();
            return Self { high: T::exact(high), low: T::exact(low) };
        }
        Self { high: rounded(&real), low: T::zero() }
    }

    /// A time later, or earlier.
    #[must_use]
    #[inline]
    pub fn after(&self, elapsed: T) -> Self {
        let Self { high, low } = sum(self.high, elapsed);
        sum(high, low + self.low)
    }

    /// The time from another time to this one, in two words.
    #[must_use]
    #[inline]
    pub(in crate::affine) fn since(&self, other: &Self) -> Self {
        self.after(-other.high).after(-other.low)
    }

    /// This time, rounded to one number.
    #[must_use]
    #[inline]
    pub fn value(&self) -> T {
        self.high + self.low
    }
}

/// A sum of two numbers and its rounding error.
#[inline]
fn sum<T: Number>(a: T, b: T) -> Time<T> {
    let high = a + b;
    let seen = high - a;
    Time { high, low: (a - (high - seen)) + (b - seen) }
}

impl<T: Number> Clock<T> {
    pub fn new(forcing: &Forcing) -> Self {
        Self { omega: Time::new(&forcing.omega), phi: Time::new(&forcing.phi) }
    }

    /// A bound of the rounding error of theta at a time: omega, times and their sums are rounded to
    /// 106 bits, whether those are one number or two, or to the bits of a wider arithmetic.
    #[inline]
    pub fn rounding(&self, time: &Time<T>) -> T::Bound {
        let unit = T::unit().min(T::Bound::from_f64(f64::EPSILON * f64::EPSILON));
        let size = (self.omega.high * time.high).bound().abs() + self.phi.high.bound().abs();
        unit * size
    }

    /// Sine and cosine of theta at a time.
    #[inline]
    pub fn sin_cos(&self, time: &Time<T>) -> (T, T) {
        let product = self.omega.high * time.high;
        let rest = self.omega.high.product_error(time.high)
            + (self.omega.high * time.low + self.omega.low * time.high);
        let Time { high, low } = sum(product, self.phi.high);
        let low = low + (rest + self.phi.low);
        turned(high.sin_cos(), low)
    }
}

/// 2 pi, by Newton's method for the zero of the sine, which triples the digits each time.
pub fn full_turn<T: Number>() -> T {
    /// The number of Newton's steps that lead from an f64 to more than 1,400 digits.
    const STEPS: usize = 4;
    let half = (0..STEPS).fold(T::exact(std::f64::consts::PI), |half, _| half + half.sin_cos().0);
    half + half
}
