//! The proof that a guard stays inside its corridor in a piece: [`crate::crossing::certificate`].

use super::wide::{Mask, Wide};
use crate::numeric::real::Real;
use pulp::Simd;

/// A guard on a piece.
pub struct Piece<S: Simd> {
    /// Value and three derivatives at the left end.
    pub left: [Wide<S>; 4],
    /// Value and three derivatives at the right end.
    pub right: [Wide<S>; 4],
    /// Length of the piece.
    pub length: Wide<S>,
    /// A bound of the eighth derivative's size.
    pub eighth: Wide<S>,
    /// The lanes in which the left value is a threshold by the switch that began the phase.
    pub bare: Mask<S>,
    /// The lanes in which the left slope is zero as well.
    pub double: Mask<S>,
    /// The lanes in which the right end is a root, through which the guard is known to leave.
    pub to_root: Mask<S>,
}

impl<S: Simd> Piece<S> {
    /// The lanes in which the guard stays between two values, with this room for rounding.
    #[inline(always)]
    pub fn stays_between(&self, low: Wide<S>, high: Wide<S>, slack: Wide<S>) -> Mask<S> {
        /// 1/(8! C(8, 4))
        const MIDDLE: f64 = 1.0 / 2_822_400.0;
        let square = self.length * self.length;
        let fourth = square * square;
        let lift = self.eighth * (fourth * fourth) * MIDDLE;
        let [a, b, c, d] = from_end(self.left, self.length);
        let [h, g, f, e] = from_end(self.right, -self.length);
        let middle = (d + e) * 0.5;
        let second = (b * 7.0 + a) * 0.125;
        let beside = (g * 7.0 + h) * 0.125;
        let inner = [
            self.bare.choose(middle, a),
            self.double.choose(middle, second),
            (c * 3.0 + b) * 0.25,
            (c * 3.0 + d * 5.0) * 0.125,
            (e * 5.0 + f * 3.0) * 0.125,
            (f * 3.0 + g) * 0.25,
            // Next to a root the sign alone is asked for: the slope there is known to be outward.
            self.to_root.choose(middle, beside),
            self.to_root.choose(middle, h),
        ];
        let (mut most, mut least) = (middle + lift, middle - lift);
        for coefficient in inner {
            (most, least) = (most.larger(coefficient), least.smaller(coefficient));
        }
        // Any NaN is one in the middle coefficient.
        let known = middle.below(f64::INFINITY);
        let sign = beside.less(high) & low.less(beside);
        most.less(high - slack) & (low + slack).less(least) & known & sign
    }
}

/// The four Bernstein coefficients of degree seven next to an end.
#[inline(always)]
fn from_end<S: Simd>(orders: [Wide<S>; 4], length: Wide<S>) -> [Wide<S>; 4] {
    let seventh = length * (1.0 / 7.0);
    let first = orders[1] * seventh;
    let second = orders[2] * (seventh * length * (1.0 / 6.0));
    let third = orders[3] * (seventh * length * length * (1.0 / 30.0));
    let value = orders[0];
    [value, value + first, value + (first * 2.0 + second), value + ((first + second) * 3.0 + third)]
}
