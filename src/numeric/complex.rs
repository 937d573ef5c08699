//! A complex number over any `Real`, with what the forced response needs.

use crate::numeric::real::Real;
use std::ops::{Add, Mul, Sub};

/// re + i im
#[derive(Clone, Copy, Debug)]
pub struct Complex<T> {
    /// Real part.
    pub re: T,
    /// Imaginary part.
    pub im: T,
}

impl<T: Real> Complex<T> {
    /// re + i im
    #[inline(always)]
    pub fn new(re: T, im: T) -> Self {
        Self { re, im }
    }

    /// re - i im
    #[inline(always)]
    pub fn conjugate(self) -> Self {
        Self::new(self.re, -self.im)
    }

    /// Times a real factor.
    #[inline(always)]
    pub fn scale(self, factor: T) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    /// The inverse of the number.
    pub fn inverse(self) -> Self {
        self.conjugate().scale(self.re.broadcast(1.0) / (self.re * self.re + self.im * self.im))
    }

    /// One number where the mask holds, the other elsewhere.
    #[inline(always)]
    pub fn choose(mask: T::Mask, yes: Self, no: Self) -> Self {
        Self::new(T::choose(mask, yes.re, no.re), T::choose(mask, yes.im, no.im))
    }
}

impl<T: Real> Add for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl<T: Real> Sub for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl<T: Real> Mul for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.im.times_from(other.im, self.re * other.re),
            self.im.times_plus(other.re, self.re * other.im),
        )
    }
}
