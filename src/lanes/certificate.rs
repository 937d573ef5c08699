//! The proof that a guard stays inside its corridor in a piece: [`crate::crossing::certificate`].

use super::wide::{Mask, Wide};
use crate::crossing::certificate::{REMAINDER_DIVISOR, coefficients};
use crate::numeric::real::Real;
use pulp::Simd;

/// A guard on a piece.
pub struct LanePiece<S: Simd> {
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

impl<S: Simd> LanePiece<S> {
    /// The lanes in which the guard stays between two values, with this room for rounding and that
    /// of the coefficients' own sums.
    #[inline(always)]
    pub fn stays_between(&self, low: Wide<S>, high: Wide<S>, slack: Wide<S>) -> Mask<S> {
        let square = self.length * self.length;
        let fourth = square * square;
        let lift = self.eighth * (fourth * fourth) * (1.0 / REMAINDER_DIVISOR);
        let ([[a, h], [b, g], [c, f], [d, e]], middle) =
            coefficients(&self.left, &self.right, self.length);
        let inner = [
            self.bare.choose(middle, a),
            self.double.choose(middle, b),
            c,
            d,
            e,
            f,
            // Next to a root the sign alone is asked for: the slope there is known to be outward.
            self.to_root.choose(middle, g),
            self.to_root.choose(middle, h),
        ];
        let (mut most, mut least) = (middle + lift, middle - lift);
        for coefficient in inner {
            (most, least) = (most.larger(coefficient), least.smaller(coefficient));
        }
        // Any NaN is one in the middle coefficient.
        let known = middle.below(f64::INFINITY);
        let sign = g.less(high) & low.less(g);
        let slack = slack + most.larger(-least) * f64::EPSILON;
        most.less(high - slack) & (low + slack).less(least) & known & sign
    }
}
