//! Contact with progression: Eqs. (18) and (20), the latter with its sign put right.

use crate::flow::constants::Constants;
use crate::flow::forcing::{EntryAngle, Harmonic};
use crate::flow::{Flow, Jet, Point};
use crate::numeric::number::Number;
use crate::numeric::real::Real;
use crate::numeric::remainders::{Decay, decay};
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
    /// Forcing angle when the progression begins.
    pub angle: EntryAngle<T>,
    /// Drift velocity when the progression begins: zero, without rounding, when it is entered from
    /// contact, and positive from an impact.
    pub drift_rate: T,
    /// Velocity of the slider's top when the progression begins, (1 - q)/(2 xi). When it is entered
    /// from contact this is the mass's velocity y itself, without rounding.
    pub closing: T,
}

impl<T: Number, C: Borrow<Constants<T>>> Flow<T> for Progression<T, C> {
    #[inline(always)]
    fn at(&self, d: T) -> Point<T> {
        let Constants { b, g, rate, two_xi, .. } = *self.constants.borrow();
        let Self { entry: State { y: y0, q: q0, .. }, drift_rate: w0, closing, .. } = *self;
        let harmonic = self.angle.harmonic(&self.constants.borrow().drive(), d);
        let decay = decay(rate * d);
        let slipping =
            Slipping::new([b, rate, two_xi], [y0, q0, w0, closing], d, &harmonic, &decay);
        let Slipped { q, w, drift, terms } =
            if decay.exp > T::exact(0.5) { slipping.early_state() } else { slipping.late_state() };
        let Slipping { y, lag, bends: [slope, bend, third], push_terms, .. } = slipping;
        let orders = [w, slope, bend, third];
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

/// A progression some time after it began, in what early and late times share.
pub struct Slipping<T> {
    begin: [T; 4],
    two_xi: T,
    /// The time, and that times 1/(2 xi).
    times: [T; 2],
    y_change: T,
    moved: T,
    pushed: T,
    remainder: T,
    /// Velocity of the mass.
    pub y: T,
    /// Velocity of the slider's top, (1 - q)/(2 xi).
    pub lag: T,
    /// The first three derivatives of w.
    pub bends: [T; 3],
    /// An upper bound of the terms of what has pushed the mass.
    pub push_terms: T,
}

/// What is computed in one way in early times and in another in late ones.
pub struct Slipped<T> {
    /// Displacement of the slider's top.
    pub q: T,
    /// Drift velocity.
    pub w: T,
    /// Drift since the progression began.
    pub drift: T,
    /// The largest terms of w but for those of what has pushed the mass.
    pub terms: T,
}

impl<T: Real> Slipping<T> {
    /// The progression after a time `d`, from b, 1/(2 xi) and 2 xi, and from y, q, w and (1 - q)/(2
    /// xi) when it began.
    #[inline(always)]
    pub fn new(
        [b, rate, two_xi]: [T; 3],
        begin: [T; 4],
        d: T,
        harmonic: &Harmonic<T>,
        decay: &Decay<T>,
    ) -> Self {
        let [y0, _, _, closing] = begin;
        let pull = b - b.broadcast(1.0);
        let push = pull * d;
        let y_change = push + harmonic.impulse;
        // 1 - q decays; (1 - q)/(2 xi) = y - w at all times.
        let lag = closing * decay.exp;
        let lag_rate = lag * rate;
        let turn = lag_rate * rate;
        Self {
            begin,
            two_xi,
            times: [d, rate * d],
            y_change,
            moved: closing * decay.minus_1,
            pushed: (push * d).times_plus(d.broadcast(0.5), harmonic.displacement),
            remainder: decay.remainder,
            y: y0 + y_change,
            lag,
            bends: [
                (harmonic.force[0] + pull) + lag_rate,
                harmonic.force[1] - turn,
                turn.times_plus(rate, harmonic.force[2]),
            ],
            push_terms: push.magnitude() + harmonic.impulse_terms,
        }
    }

    /// The state by its changes since the progression began, which are small in early times.
    ///
    /// The drift is Eq. (20) with - (p0 - g - 1) exp(..), its linear terms collected: y0 - (1 -
    /// q0)/(2 xi) = w0. 1 - q0 as 2 xi times the closing velocity keeps the digits that q0 near 1
    /// has lost.
    #[inline(always)]
    pub fn early_state(&self) -> Slipped<T> {
        let ([_, q0, w0, closing], [d, _]) = (self.begin, self.times);
        let settling = self.two_xi * closing * self.remainder;
        Slipped {
            q: self.two_xi.times_from(self.moved, q0),
            w: w0 + (self.y_change - self.moved),
            drift: w0 * d + self.pushed + settling,
            terms: w0.magnitude() + self.moved.magnitude(),
        }
    }

    /// The state by what is left of 1 - q0: the changes would lose the digits of a large q0.
    #[inline(always)]
    pub fn late_state(&self) -> Slipped<T> {
        let ([y0, ..], [d, z]) = (self.begin, self.times);
        let one = d.broadcast(1.0);
        Slipped {
            q: self.two_xi.times_from(self.lag, one),
            w: self.y - self.lag,
            drift: y0 * d + self.pushed + self.two_xi * self.moved,
            // The exponential has the rounding of its argument, z times its own.
            terms: y0.magnitude() + self.lag.magnitude() * (one + z),
        }
    }
}
