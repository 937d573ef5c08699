//! Contact with progression: Eqs. (18) and (20), the latter with its sign put right.

use crate::flow::constants::Constants;
use crate::flow::forcing::EntryAngle;
use crate::flow::{Flow, Jet, Point};
use crate::numeric::number::Number;
use crate::numeric::remainders::decay;
use crate::state::State;
use std::borrow::Borrow;

/// One progression; its guard is the drift velocity w = v' = (f - 1)/(2 xi), positive until the
/// slider's bottom stops. In w the exit state keeps the digits that f - 1 would cost it.
#[derive(Clone, Copy, Debug)]
pub struct Progression<T, C = Constants<T>> {
    /// The model's constants: its own, or borrowed while a switch is looked for.
    pub constants: C,
    /// State when the progression begins; p = q + g.
    pub entry: State<T>,
    /// Forcing angle then.
    pub angle: EntryAngle<T>,
    /// Drift velocity then: 0 exactly when entered from contact, positive from an impact.
    pub drift_rate: T,
    /// Velocity of the slider's top then, (1 - q)/(2 xi): y exactly when entered from contact.
    pub closing: T,
}

impl<T: Number, C: Borrow<Constants<T>>> Flow<T> for Progression<T, C> {
    #[inline(always)]
    fn at(&self, d: T) -> Point<T> {
        let Constants { b, g, rate, two_xi, .. } = *self.constants.borrow();
        let Self { entry: State { y: y0, q: q0, .. }, drift_rate: w0, closing, .. } = *self;
        let harmonic = self.angle.harmonic(self.constants.borrow(), d);
        let decay = decay(rate * d);
        let one = T::one();

        let push = (b - one) * d;
        let y_change = push + harmonic.impulse;
        let y = y0 + y_change;
        // 1 - q decays; (1 - q)/(2 xi) = y - w at all times. Early everything is taken by its
        // change, late by what is left of 1 - q0: else the digits of a large q0 are lost.
        let lag = closing * decay.exp;
        let moved = closing * decay.minus_1;
        let pushed = push * d * T::exact(0.5) + harmonic.displacement;
        let push_terms = push.abs() + harmonic.impulse_terms;
        let early = decay.exp > T::exact(0.5);
        // Eq. (20) with - (p0 - g - 1) exp(..), its linear terms collected: y0 - (1 - q0)/(2 xi) =
        // w0. 1 - q0 as 2 xi times the closing velocity keeps the digits that q0 near 1 has lost.
        let (q, w, drift, terms) = if early {
            let settling = two_xi * closing * decay.remainder;
            let drift = w0 * d + pushed + settling;
            (q0 - two_xi * moved, w0 + (y_change - moved), drift, w0.abs() + moved.abs())
        } else {
            let drift = y0 * d + pushed + two_xi * moved;
            // The exponential has the rounding of its argument, z times its own.
            let terms = y0.abs() + lag.abs() * (one + rate * d);
            (one - two_xi * lag, y - lag, drift, terms)
        };

        let lag_rate = lag * rate;
        let orders = [
            w,
            (harmonic.force[0] + (b - one)) + lag_rate,
            harmonic.force[1] - lag_rate * rate,
            harmonic.force[2] + lag_rate * rate * rate,
        ];
        let largest_term = terms + push_terms;
        Point {
            elapsed: d,
            state: State { p: q + g, y, q },
            slider_velocity: lag,
            drift,
            force: harmonic.force,
            guard: Jet { orders, largest_term },
        }
    }
}
