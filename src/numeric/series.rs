//! A guard continued from an evaluation by its Taylor series.
//!
//! All derivatives of a guard are known: a harmonic's repeat, an exponential's are multiples of it,
//! and the contact's follow from its equation of motion. Where a step is shorter than [`REACH`]
//! against the fastest rate of the motion, ten terms give the guard and its first three derivatives
//! to the last digit: what is left out of the third is REACH^8/8! = 2e-17 of its size. A guess that
//! comes so close is finished without a second evaluation, and the state is carried along in one
//! step, which rounds it once, as a second evaluation would. Most guesses come closer than
//! [`SHORT_REACH`]: there five terms leave SHORT_REACH^5/5! = 8e-18 of the slope, and the higher
//! derivatives follow from the equation of motion.

use crate::numeric::real::Real;

/// The longest step against the fastest rate of the motion.
pub const REACH: f64 = 0.03;

/// Terms that are kept for steps up to [`REACH`], that of order zero included.
pub const TERMS: usize = 11;

/// The longest step for which [`SHORT_TERMS`] do, against the fastest rate of the motion.
pub const SHORT_REACH: f64 = 1e-3;

/// Terms that are kept for steps up to [`SHORT_REACH`].
pub const SHORT_TERMS: usize = 6;

/// 1/k!
pub const INVERSE_FACTORIALS: [f64; TERMS + 1] = {
    let mut table = [1.0; TERMS + 1];
    let mut k = 1;
    while k <= TERMS {
        table[k] = table[k - 1] / k as f64;
        k += 1;
    }
    table
};

/// The derivatives of orders 0 and on at an evaluation.
#[derive(Clone, Copy, Debug)]
pub struct Series<T, const N: usize>(pub [T; N]);

impl<const N: usize> Series<f64, N> {
    /// The guard's own orders, completed by its derivatives of orders four and on, one by one.
    #[inline]
    pub fn new(orders: &[f64; 4], mut next: impl FnMut() -> f64) -> Self {
        let mut derivatives = [0.0; N];
        derivatives[..4].copy_from_slice(orders);
        for derivative in &mut derivatives[4..] {
            *derivative = next();
        }
        Self(derivatives)
    }

    /// Second and third derivative a time `step` later.
    #[inline]
    pub fn bend_and_third(&self, step: f64) -> (f64, f64) {
        let (mut bend, mut third) = (0.0, 0.0);
        for k in (3..N).rev() {
            bend = self.0[k] * INVERSE_FACTORIALS[k - 2] + step * bend;
            third = self.0[k] * INVERSE_FACTORIALS[k - 3] + step * third;
        }
        (self.0[2] + step * bend, third)
    }
}

impl<T: Real, const N: usize> Series<T, N> {
    /// Value and slope a time `step` later; even and odd powers apart, so that the chains run side
    /// by side.
    #[inline(always)]
    pub fn value_and_slope(&self, step: T) -> (T, T) {
        let square = step * step;
        let zero = step.broadcast(0.0);
        let (mut value, mut slope) = ([zero; 2], [zero; 2]);
        for k in (1..N).rev() {
            let (side, order) = (k % 2, self.0[k]);
            let [now, before] =
                [step.broadcast(INVERSE_FACTORIALS[k]), step.broadcast(INVERSE_FACTORIALS[k - 1])];
            value[side] = value[side].times_plus(square, order * now);
            slope[side] = slope[side].times_plus(square, order * before);
        }
        let [even, odd] = value;
        let [odd_slope, even_slope] = slope;
        let change = step.times_plus(odd, square * even);
        (self.0[0] + change, step.times_plus(odd_slope, even_slope))
    }

    /// Second derivative a time `step` later, without terms above order five.
    #[inline(always)]
    pub fn bend(&self, step: T) -> T {
        let [second, third, fourth, fifth] = [self.0[2], self.0[3], self.0[4], self.0[5]];
        let higher =
            (step * step.broadcast(1.0 / 6.0)).times_plus(fifth, fourth * step.broadcast(0.5));
        step.times_plus(step.times_plus(higher, third), second)
    }

    /// Integral from the evaluation to a time `step` later.
    #[inline(always)]
    pub fn integral(&self, step: T) -> T {
        let mut sum = step.broadcast(0.0);
        for k in (0..N).rev() {
            sum = sum.times_plus(step, self.0[k] * step.broadcast(INVERSE_FACTORIALS[k + 1]));
        }
        step * sum
    }
}
