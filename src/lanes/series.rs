//! A guard continued from an evaluation by its own derivatives ([`crate::crossing::series`]).

use super::wide::{Mask, Wide};
use crate::numeric::real::Real;
use crate::numeric::series::{Series, TERMS};
use pulp::Simd;

/// Orders that an evaluation does not give by itself.
pub const LATER_ORDERS: usize = TERMS - 4;

impl<S: Simd> Series<Wide<S>, TERMS> {
    /// The series of the first four orders and the later ones.
    #[inline(always)]
    pub fn of_orders(orders: [Wide<S>; 4], later: [Wide<S>; LATER_ORDERS]) -> Self {
        let mut all = [orders[0]; TERMS];
        all[..4].copy_from_slice(&orders);
        all[4..].copy_from_slice(&later);
        Self(all)
    }

    /// The root next to a step that is one of the series' first four terms; the slope there, and
    /// where both are settled.
    #[inline(always)]
    pub fn polish(&self, step: Wide<S>) -> (Wide<S>, Wide<S>, Mask<S>) {
        /// The square of what Newton's step changes the slope by is left out of the time: 1e-10 of
        /// a step that is mostly below 1e-7 itself, and next to a flat inflection below 1e-4.
        const SLOPE_CHANGE_TOLERANCE: f64 = 1e-5;
        let (value, slope) = self.value_and_slope(step);
        let inverse = slope.broadcast(1.0) / slope;
        let change = -(value * inverse);
        // To fifth order, which leaves 3e-8 of what the change does to the slope.
        let gain = change * change.times_plus(self.0[3] * 0.5, self.bend(step));
        let settled = gain.magnitude().less(slope.magnitude() * SLOPE_CHANGE_TOLERANCE);
        let bent = (gain * 0.5) * inverse;
        (step + bent.times_from(change, change), slope + gain, settled)
    }
}
