//! Free oscillation in contact ([`crate::flow::damped`]): a rotation, a series near critical
//! damping, two exponentials above.

use super::contact_constants::Forms;
use super::functions::{cosines, shrink, turn_of};
use super::shape::Shape;
use super::wide::{Mask, Wide};
use crate::flow::damped::{Free, Rotation};
use crate::numeric::real::Real;
use pulp::Simd;

/// The size of m = (1 - xi^2) d^2 up to which the series serves near critical damping.
const MAX_SERIES_ARGUMENT: f64 = 0.5;

impl<S: Simd> Free<Wide<S>> {
    /// The free oscillation after `d`.
    #[inline(always)]
    pub fn after(shape: &Shape<Wide<S>>, forms: Forms, d: Wide<S>) -> Self {
        if forms == Forms::Usual {
            return Self::rotation(shape, d);
        }
        let m = shape.discriminant * d * d;
        let series = shape.near_critical.above(0.0) & m.magnitude().below(MAX_SERIES_ARGUMENT);
        let over = shape.spread.above(0.0) & !series;
        let turns = !(series | over);
        let mut free = if turns.any() { Self::rotation(shape, d) } else { Self::zero(d) };
        if series.any() {
            let (cosine_minus_1, sine_over_x_minus_1) = cosines(m);
            let sums = [cosine_minus_1, sine_over_x_minus_1];
            free = free.or_where(series, Self::of_series(shape.xi, d, &shrink(shape.xi * d), sums));
        }
        if over.any() {
            let Shape { lasting: slow, spread, .. } = *shape;
            let exponentials =
                Self::of_exponentials(slow, spread, &shrink(slow * d), &shrink(spread * d));
            free = free.or_where(over, exponentials);
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
        let free = Self::shrunk(xi, d, &shrink, turn.cos_minus_1, [s, s_minus_d]);
        Self { rotation: Rotation { shrink, turn }, ..free }
    }

    /// These solutions, or those of another form where the mask holds.
    #[inline(always)]
    fn or_where(self, mask: Mask<S>, other: Self) -> Self {
        Self {
            s: mask.choose(other.s, self.s),
            s_minus_d: mask.choose(other.s_minus_d, self.s_minus_d),
            c_minus_1: mask.choose(other.c_minus_1, self.c_minus_1),
            s_rate_minus_1: mask.choose(other.s_rate_minus_1, self.s_rate_minus_1),
            fast_exponential: mask.choose(other.fast_exponential, self.fast_exponential),
            ..self
        }
    }
}
