//! No contact: Eq. (14). The mass flies, the slider's top returns to its rest.

use crate::flow::constants::Constants;
use crate::flow::forcing::EntryAngle;
use crate::flow::{Flow, Jet, Point};
use crate::numeric::number::Number;
use crate::numeric::remainders::decay;
use crate::state::State;
use std::borrow::Borrow;

/// One flight; its guard is h = p - q - g, negative until the impact.
#[derive(Clone, Copy, Debug)]
pub struct NoContact<T, C = Constants<T>> {
    /// The model's constants: its own, or borrowed while a switch is looked for.
    pub constants: C,
    /// State when the flight begins.
    pub entry: State<T>,
    /// Forcing angle then.
    pub angle: EntryAngle<T>,
    /// If the flight begins on the contact surface, h = 0 there exactly, and this is h': zero at a
    /// separation (f = 0), negative where a start state has f < 0.
    pub surface: Option<T>,
}

impl<T: Number, C: Borrow<Constants<T>>> NoContact<T, C> {
    /// p0 - g when the flight begins: a start's p0 and g are given; on the surface it is q0, of
    /// which a p0 beside a large g has lost digits.
    #[inline(always)]
    pub(crate) fn height(&self) -> T {
        let State { p, q, .. } = self.entry;
        if self.surface.is_some() { q } else { p - self.constants.borrow().g }
    }
}

impl<T: Number, C: Borrow<Constants<T>>> Flow<T> for NoContact<T, C> {
    #[inline(always)]
    fn at(&self, d: T) -> Point<T> {
        let Constants { b, rate, .. } = *self.constants.borrow();
        let State { p: p0, y: y0, q: q0 } = self.entry;
        let harmonic = self.angle.harmonic(self.constants.borrow(), d);
        let decay = decay(rate * d);

        let lift = b * d * d * T::exact(0.5);
        let y_change = b * d + harmonic.impulse;
        let p_change = y0 * d + (lift + harmonic.displacement);
        let y = y0 + y_change;
        let q = q0 * decay.exp;

        let force = b + harmonic.force[0];
        let spring = q * rate;
        // q carries the rounding of its exponent, z times: it dies out with q.
        let q_terms = q.abs() + (spring * d).abs();
        let height = self.height();
        let direct_terms = height.abs() + (y0 * d).abs() + lift.abs() + q_terms;
        let (h, h_rate, terms) = match self.surface {
            // The remainder is the better form where z is short, and everywhere after a separation,
            // where its linear term is the flight's own.
            Some(h_rate) if h_rate == T::zero() || rate * d < T::one() => {
                // h = h' d - q0 (exp(-z) - 1 + z) + b d^2/2 + ..., because p0 = q0 + g.
                let sink = q0 * decay.remainder;
                let h = (h_rate * d + (lift - sink)) + harmonic.displacement;
                let terms = (h_rate * d).abs() + lift.abs() + sink.abs();
                (h, h_rate + (y_change + q0 * rate * decay.minus_1), terms)
            }
            _ => ((height + p_change) - q, y + spring, direct_terms),
        };
        let largest_term = terms + harmonic.displacement_terms;
        let orders = [h, h_rate, force - spring * rate, harmonic.force[1] + spring * rate * rate];
        Point {
            elapsed: d,
            state: State { p: p0 + p_change, y, q },
            slider_velocity: -spring,
            drift: T::zero(),
            force: harmonic.force,
            guard: Jet { orders, largest_term },
        }
    }
}
