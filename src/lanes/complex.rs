//! A complex number a lane.

use super::wide::{Mask, Wide};
use pulp::Simd;
use std::ops::{Add, Mul, Sub};

/// re + i im
#[derive(Clone, Copy)]
pub struct Complex<S: Simd> {
    /// Real part.
    pub re: Wide<S>,
    /// Imaginary part.
    pub im: Wide<S>,
}

impl<S: Simd> Complex<S> {
    /// re + i im
    #[inline(always)]
    pub fn new(re: Wide<S>, im: Wide<S>) -> Self {
        Self { re, im }
    }

    /// re - i im
    #[inline(always)]
    pub fn conjugate(self) -> Self {
        Self::new(self.re, -self.im)
    }

    /// Times a real factor.
    #[inline(always)]
    pub fn scale(self, factor: Wide<S>) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    /// Takes one number where the mask holds, the other elsewhere.
    #[inline(always)]
    pub fn choose(mask: Mask<S>, yes: Self, no: Self) -> Self {
        Self::new(mask.choose(yes.re, no.re), mask.choose(yes.im, no.im))
    }
}

impl<S: Simd> Add for Complex<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl<S: Simd> Sub for Complex<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl<S: Simd> Mul for Complex<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.im.times_from(other.im, self.re * other.re),
            self.im.times_plus(other.re, self.re * other.im),
        )
    }
}
