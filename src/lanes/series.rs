//! A guard continued from an evaluation by its own derivatives ([`crate::crossing::series`]).

use super::wide::{Mask, Wide};
use crate::crossing::series::{INVERSE_FACTORIALS, TERMS};
use crate::numeric::real::Real;
use pulp::Simd;

/// Orders that an evaluation does not give by itself.
pub const LATER: usize = TERMS - 4;

/// The guard's excess over its threshold with its derivatives at an evaluation.
#[derive(Clone, Copy)]
pub struct Series<S: Simd>([Wide<S>; TERMS]);

impl<S: Simd> Series<S> {
    /// The series of the first four orders and the later ones.
    #[inline(always)]
    pub fn new(orders: [Wide<S>; 4], later: [Wide<S>; LATER]) -> Self {
        let mut all = [orders[0]; TERMS];
        all[..4].copy_from_slice(&orders);
        all[4..].copy_from_slice(&later);
        Self(all)
    }

    /// Value and slope after a step; even and odd powers apart, so that the chains run side by
    /// side.
    #[inline(always)]
    fn value_and_slope(&self, step: Wide<S>) -> (Wide<S>, Wide<S>) {
        let square = step * step;
        let zero = step.same(0.0);
        let (mut value, mut slope) = ([zero; 2], [zero; 2]);
        for k in (1..TERMS).rev() {
            let side = k % 2;
            let order = self.0[k];
            value[side] = value[side].times_plus(square, order * INVERSE_FACTORIALS[k]);
            slope[side] = slope[side].times_plus(square, order * INVERSE_FACTORIALS[k - 1]);
        }
        let [even, odd] = value;
        let [odd_slope, even_slope] = slope;
        let change = step.times_plus(odd, square * even);
        (self.0[0] + change, step.times_plus(odd_slope, even_slope))
    }

    /// The root next to a step that is one of the series' first four terms; the slope there, and
    /// where both are settled.
    #[inline(always)]
    pub fn polished(&self, step: Wide<S>) -> (Wide<S>, Wide<S>, Mask<S>) {
        /// Of what Newton's step changes the slope by the square is left out of the time: 1e-10 of
        /// a step that is mostly below 1e-7 itself, and next to a flat inflection below 1e-4.
        const SETTLED: f64 = 1e-5;
        let (value, slope) = self.value_and_slope(step);
        // To fifth order, which leaves 3e-8 of what the change does to the slope.
        let [_, _, second, third, fourth, fifth, ..] = self.0;
        let higher = step.times_plus(fifth * (1.0 / 6.0), fourth * 0.5);
        let bend = step.times_plus(step.times_plus(higher, third), second);
        let inverse = slope.same(1.0) / slope;
        let change = -(value * inverse);
        let gain = change * change.times_plus(third * 0.5, bend);
        let settled = gain.magnitude().less(slope.magnitude() * SETTLED);
        let bent = (gain * 0.5) * inverse;
        (step + bent.times_from(change, change), slope + gain, settled)
    }

    /// Integral over a step.
    #[inline(always)]
    pub fn integral(&self, step: Wide<S>) -> Wide<S> {
        let mut sum = step.same(0.0);
        for k in (0..TERMS).rev() {
            sum = sum.times_plus(step, self.0[k] * INVERSE_FACTORIALS[k + 1]);
        }
        step * sum
    }
}
