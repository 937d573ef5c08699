//! A contact followed in strides of fixed length ([`crate::crossing::swing`]).

use super::shape::Shape;
use super::wide::Wide;
use pulp::Simd;

/// The trial force in parts.
#[derive(Clone, Copy)]
pub struct Parts<S: Simd> {
    /// Free part.
    pub free: Wide<S>,
    /// Its rate.
    pub free_rate: Wide<S>,
    /// Forced part.
    pub forced: Wide<S>,
    /// Its rate over omega.
    pub quarter: Wide<S>,
}

impl<S: Simd> Parts<S> {
    /// After a stride with these sine, cosine, C, S and S'.
    #[inline(always)]
    pub fn after(&self, [sin, cos, c, s, s_rate]: [Wide<S>; 5]) -> Self {
        Self {
            free: self.free.times_plus(c, self.free_rate * s),
            free_rate: self.free.times_from(s, self.free_rate * s_rate),
            forced: self.forced.times_plus(cos, self.quarter * sin),
            quarter: self.forced.times_from(sin, self.quarter * cos),
        }
    }

    /// The guard, which counts from `reference`, and its first three derivatives.
    #[inline(always)]
    pub fn orders(&self, shape: &Shape<Wide<S>>, reference: Wide<S>) -> [Wide<S>; 4] {
        let Shape { b, two_xi, omega, omega2, .. } = *shape;
        let Self { free, free_rate, forced, quarter } = *self;
        // x'' + 2 xi x' + x = 0
        let bend = -two_xi.times_plus(free_rate, free);
        let third = -two_xi.times_plus(bend, free_rate);
        [
            (b - reference) + free + forced,
            omega.times_plus(quarter, free_rate),
            omega2.times_from(forced, bend),
            (omega * omega2).times_from(quarter, third),
        ]
    }
}

/// Sine and cosine of a stride of a guess, and its C, S and S'.
#[inline(always)]
pub fn of_guess<S: Simd>(shape: &Shape<Wide<S>>) -> [Wide<S>; 5] {
    let Shape { swing_sin, swing_cos, swing_c, swing_s, swing_s_rate, .. } = *shape;
    [swing_sin, swing_cos, swing_c, swing_s, swing_s_rate]
}

/// Those of a piece of a certificate.
#[inline(always)]
pub fn of_piece<S: Simd>(shape: &Shape<Wide<S>>) -> [Wide<S>; 5] {
    let Shape { piece_sin, piece_cos, piece_c, piece_s, piece_s_rate, .. } = *shape;
    [piece_sin, piece_cos, piece_c, piece_s, piece_s_rate]
}
