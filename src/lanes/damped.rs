//! Free oscillation in contact ([`crate::flow::damped`]): a rotation, a series near critical
//! damping, two exponentials above.

use super::contact_shape::Forms;
use super::functions::{Shrink, Turn, cosines, shrink, turn_of};
use super::shape::Shape;
use super::wide::{Mask, Wide};
use pulp::Simd;

/// The fundamental solutions at one elapsed time.
#[derive(Clone, Copy)]
pub struct Free<S: Simd> {
    /// S
    pub s: Wide<S>,
    /// S - d, without cancellation where d is short.
    pub s_minus_d: Wide<S>,
    /// C - 1
    pub c_minus_1: Wide<S>,
    /// S' - 1
    pub s_rate_minus_1: Wide<S>,
    /// exp(-fast d) above critical damping; elsewhere nothing is promised.
    pub quick: Wide<S>,
    /// exp(-xi d), of a rotation; elsewhere nothing is promised.
    pub shrink: Shrink<S>,
    /// Circular functions of nu d, of a rotation; elsewhere nothing is promised.
    pub turn: Turn<S>,
}

/// Up to this size of m = (1 - xi^2) d^2 the series serves near critical damping.
const SERIES: f64 = 0.5;

impl<S: Simd> Free<S> {
    /// The free oscillation after `d`.
    #[inline(always)]
    pub fn after(shape: &Shape<Wide<S>>, forms: Forms, d: Wide<S>) -> Self {
        if forms == Forms::Usual {
            return Self::rotation(shape, d);
        }
        let m = shape.discriminant * d * d;
        let series = shape.near_critical.above(0.0) & m.abs().below(SERIES);
        let over = shape.spread.above(0.0) & !series;
        let turns = !(series | over);
        let mut free = if turns.any() { Self::rotation(shape, d) } else { Self::nothing(d) };
        if series.any() {
            free = free.or_where(series, Self::series(shape, d, m));
        }
        if over.any() {
            free = free.or_where(over, Self::exponentials(shape, d));
        }
        free
    }

    #[inline(always)]
    fn rotation(shape: &Shape<Wide<S>>, d: Wide<S>) -> Self {
        let Shape { xi, nu, nu_low, per_nu, .. } = *shape;
        let turn = turn_of(nu, Some(nu_low), d);
        let shrink = shrink(xi * d);
        let s = shrink.exp * turn.sin * per_nu;
        let s_minus_d = shrink.minus_1.times_plus(turn.sin, turn.sin_minus_x) * per_nu;
        Self { turn, ..Self::shrunk(shape, d, shrink, turn.cos_minus_1, [s, s_minus_d]) }
    }

    /// With m = (1 - xi^2) d^2: S = d exp(-xi d) (1 - m/3! + m^2/5! - ...), C alike.
    #[inline(always)]
    fn series(shape: &Shape<Wide<S>>, d: Wide<S>, m: Wide<S>) -> Self {
        let (cosine_minus_1, sine_over_x_minus_1) = cosines(m);
        let shrink = shrink(shape.xi * d);
        let s = shrink.exp * d * (sine_over_x_minus_1 + 1.0);
        let s_minus_d = d * shrink.exp.times_plus(sine_over_x_minus_1, shrink.minus_1);
        Self::shrunk(shape, d, shrink, cosine_minus_1, [s, s_minus_d])
    }

    /// C - 1 = exp(-xi d) cos - 1 + xi S, in short times without the xi d that two of its parts
    /// share.
    #[inline(always)]
    fn shrunk(
        shape: &Shape<Wide<S>>,
        d: Wide<S>,
        shrink: Shrink<S>,
        cosine_minus_1: Wide<S>,
        [s, s_minus_d]: [Wide<S>; 2],
    ) -> Self {
        let Shape { xi, two_xi, .. } = *shape;
        let turned = shrink.exp * cosine_minus_1;
        let weak = (xi * d).below(0.5);
        let c_minus_1 = weak.choose(
            xi.times_plus(s_minus_d, shrink.remainder + turned),
            xi.times_plus(s, shrink.minus_1 + turned),
        );
        let s_rate_minus_1 = two_xi.times_from(s, c_minus_1);
        Self { s, s_minus_d, c_minus_1, s_rate_minus_1, shrink, ..Self::nothing(d) }
    }

    /// S = exp(-slow d) (1 - exp(-spread d))/spread, C = exp(-slow d) + slow S and S' = exp(-fast
    /// d) - slow S.
    #[inline(always)]
    fn exponentials(shape: &Shape<Wide<S>>, d: Wide<S>) -> Self {
        let Shape { lasting: slow, spread, .. } = *shape;
        let (lasting, ratio) = (shrink(slow * d), shrink(spread * d));
        let bare = -(ratio.minus_1 / spread);
        let s = lasting.exp * bare;
        let quick_minus_1 = lasting.exp.times_plus(ratio.minus_1, lasting.minus_1);
        Self {
            s,
            s_minus_d: lasting.minus_1.times_plus(bare, -(ratio.remainder / spread)),
            c_minus_1: slow.times_plus(s, lasting.minus_1),
            s_rate_minus_1: slow.times_from(s, quick_minus_1),
            quick: lasting.exp * ratio.exp,
            ..Self::nothing(d)
        }
    }

    #[inline(always)]
    fn nothing(d: Wide<S>) -> Self {
        let zero = d.same(0.0);
        Self {
            s: zero,
            s_minus_d: zero,
            c_minus_1: zero,
            s_rate_minus_1: zero,
            quick: zero,
            shrink: Shrink { exp: zero, minus_1: zero, remainder: zero },
            turn: Turn { sin: zero, cos_minus_1: zero, sin_minus_x: zero },
        }
    }

    /// Another form's solutions where the mask holds.
    #[inline(always)]
    fn or_where(self, mask: Mask<S>, other: Self) -> Self {
        Self {
            s: mask.choose(other.s, self.s),
            s_minus_d: mask.choose(other.s_minus_d, self.s_minus_d),
            c_minus_1: mask.choose(other.c_minus_1, self.c_minus_1),
            s_rate_minus_1: mask.choose(other.s_rate_minus_1, self.s_rate_minus_1),
            quick: mask.choose(other.quick, self.quick),
            ..self
        }
    }
}
