//! What is left of sine, cosine and exponential after their leading terms, without cancellation.
//!
//! In Eqs. (14), (18) and (20) differences such as cos(omega tau) - cos(omega tau0) + omega (tau -
//! tau0) sin(omega tau0) lose every digit in short phases. In the elapsed time d they are
//! combinations of the remainders below, each computed to within a few units in the last place.

use crate::numeric::number::Number;
use crate::numeric::real::{Real, polynomial};

/// Sine and cosine of x with their remainders.
#[derive(Clone, Copy, Debug)]
pub struct Circular<T> {
    /// sin x
    pub sin: T,
    /// cos x - 1
    pub cos_minus_1: T,
    /// sin x - x
    pub sin_minus_x: T,
}

/// exp(-z) with its remainders.
#[derive(Clone, Copy, Debug)]
pub struct Decay<T> {
    /// exp(-z)
    pub exp: T,
    /// exp(-z) - 1
    pub minus_1: T,
    /// exp(-z) - 1 + z
    pub remainder: T,
}

/// Sine, cosine and remainders of `x`: relative error of a few eps for `|x| <= 1`, absolute beyond.
#[inline(always)]
pub fn circular<T: Number>(x: T) -> Circular<T> {
    if x.abs() < T::one() {
        let square = x * x;
        let cos_minus_1 = square * alternating::<T>(square, 2);
        let sin_minus_x = x * square * alternating::<T>(square, 3);
        return Circular { sin: x + sin_minus_x, cos_minus_1, sin_minus_x };
    }
    let (s, c) = (x * T::exact(0.5)).sin_cos();
    let two = T::exact(2.0);
    let sin = two * s * c;
    Circular { sin, cos_minus_1: -(two * s * s), sin_minus_x: sin - x }
}

/// Circular functions of the product `rate * time`, whose rounding error is known and put back.
#[inline(always)]
pub fn circular_of<T: Number>(x: T, correction: T) -> Circular<T> {
    circular(x).corrected(correction)
}

impl<T: Real> Circular<T> {
    /// The functions at an argument that is larger by `correction`, to first order: the correction
    /// is below eps of the argument.
    #[inline(always)]
    pub fn corrected(self, correction: T) -> Self {
        let Self { sin, cos_minus_1, sin_minus_x } = self;
        let cos_minus_1_then = correction.times_from(sin, cos_minus_1);
        Self {
            sin: sin + correction.times_plus(cos_minus_1, correction),
            cos_minus_1: cos_minus_1_then,
            sin_minus_x: correction.times_plus(cos_minus_1_then, sin_minus_x),
        }
    }
}

/// exp(-z) and its remainders: relative error of a few eps where `|z| <= 1/2`, absolute beyond.
#[inline(always)]
pub fn decay<T: Number>(z: T) -> Decay<T> {
    if z.abs() < T::exact(0.5) {
        let square = z * z;
        // Even and odd powers apart, so that the two chains run side by side.
        let even = same_sign::<T>(square, 2);
        let odd = same_sign::<T>(square, 3);
        let remainder = square * (even - z * odd);
        let minus_1 = remainder - z;
        return Decay { exp: T::one() + minus_1, minus_1, remainder };
    }
    let exp = (-z).exp();
    let minus_1 = exp - T::one();
    Decay { exp, minus_1, remainder: minus_1 + z }
}

/// -1/n! + s/(n+2)! - s^2/(n+4)! + ...
#[inline]
fn alternating<T: Number>(square: T, n: usize) -> T {
    let (even, odd) = every_other(square, n, T::TERMS);
    square * odd - even
}

/// 1/n! + s/(n+2)! + s^2/(n+4)! + ...
#[inline]
fn same_sign<T: Number>(square: T, n: usize) -> T {
    // s < 1/4 here: one term in four less than at argument 1.
    let (even, odd) = every_other(square, n, T::TERMS - T::TERMS / 4);
    even + square * odd
}

/// 1/n! + s^2/(n+4)! + ... and 1/(n+2)! + s^2/(n+6)! + ..., so many terms in all: two chains that
/// run side by side, each half as long.
#[inline(always)]
fn every_other<T: Number>(square: T, n: usize, terms: usize) -> (T, T) {
    let fourth = square * square;
    let mut sums = [T::zero(); 2];
    for k in (0..terms).rev() {
        sums[k % 2] = T::inverse_factorial(n + 2 * k) + fourth * sums[k % 2];
    }
    let [even, odd] = sums;
    (even, odd)
}

/// exp(-z) - 1 for |z| up to [`REACH`](crate::numeric::series::REACH).
#[inline(always)]
pub fn short_decay<T: Real>(z: T) -> T {
    let square = z * z;
    let even = polynomial(square, [0.5, 1.0 / 24.0, 1.0 / 720.0, 1.0 / 40320.0]);
    let odd = polynomial(square, [1.0 / 6.0, 1.0 / 120.0, 1.0 / 5040.0]);
    square.times_plus(z.times_from(odd, even), -z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::series::{INVERSE_FACTORIALS, REACH};

    #[test]
    fn a_short_decay_is_good_to_the_last_digit() {
        for k in -300..=300_i32 {
            let z = REACH * f64::from(k) / 300.0;
            let exact = libm::expm1(-z);
            let off = (short_decay(z) - exact).abs();
            // Half a unit each of the function and of the last difference, and of z^2/2 a little.
            assert!(off <= 1.1 * f64::EPSILON * z.abs(), "{z}: {off:e}");
        }
    }

    /// Within [`REACH`] the last terms are below rounding; at z = 1 all eight of them show.
    #[test]
    fn a_short_decay_has_the_terms_of_the_exponential() {
        for z in [1.0, -1.0_f64] {
            let terms = (1..=8).map(|k| (-z).powi(k) * INVERSE_FACTORIALS[k as usize]);
            let exact: f64 = terms.sum();
            let off = (short_decay(z) - exact).abs();
            // Eight terms of at most 1, each rounded once here and once there.
            assert!(off <= 16.0 * f64::EPSILON, "{z}: {off:e}");
        }
    }
}
