//! A complex number over any [`Number`], with the three operations that the forced response needs.

use crate::numeric::number::Number;
use std::ops::{Add, Mul, Sub};

/// re + i im
#[derive(Clone, Copy, Debug)]
pub struct Complex<T> {
    /// Real part.
    pub re: T,
    /// Imaginary part.
    pub im: T,
}

impl<T: Number> Complex<T> {
    /// re + i im
    pub fn new(re: T, im: T) -> Self {
        Self { re, im }
    }

    /// re - i im
    pub fn conjugate(self) -> Self {
        Self::new(self.re, -self.im)
    }

    /// Times a real factor.
    pub fn scale(self, factor: T) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    /// The inverse of the number.
    pub fn inverse(self) -> Self {
        self.conjugate().scale(T::one() / (self.re * self.re + self.im * self.im))
    }
}

impl<T: Number> Add for Complex<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl<T: Number> Sub for Complex<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl<T: Number> Mul for Complex<T> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)
    }
}
