//! No contact: Eq. (14). The mass flies, the slider's top returns to its rest.

use crate::flow::constants::Constants;
use crate::flow::forcing::{EntryAngle, Harmonic};
use crate::flow::{Flow, Jet, Point};
use crate::numeric::number::Number;
use crate::numeric::real::Real;
use crate::numeric::remainders::{Decay, decay};
use crate::state::State;
use std::borrow::Borrow;

/// One flight; its guard is h = p - q - g, negative until the impact.
#[derive(Clone, Copy, Debug)]
pub struct NoContact<T, C = Constants<T>> {
    /// The model's constants: its own, or borrowed while a switch is looked for.
    pub constants: C,
    /// State when the flight begins.
    pub entry: State<T>,
    /// Forcing angle when the flight begins.
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
        let harmonic = self.angle.harmonic(&self.constants.borrow().drive(), d);
        let decay = decay(rate * d);

        let flying = Flying::new([b, rate], [y0, q0], d, &harmonic, &decay);
        let Flying { lift, y_change, p_change, q, spring, sink, bends: [bend, third] } = flying;
        let y = y0 + y_change;
        // q carries the rounding of its exponent, z times: it dies out with q.
        let q_terms = q.abs() + (spring * d).abs();
        let height = self.height();
        let direct_terms = height.abs() + (y0 * d).abs() + lift.abs() + q_terms;
        let (h, h_rate, terms) = match self.surface {
            // The remainder is the better form where z is short, and everywhere after a separation,
            // where its linear term is the flight's own.
            Some(h_rate) if h_rate == T::zero() || rate * d < T::one() => {
                // h = h' d - q0 (exp(-z) - 1 + z) + b d^2/2 + ..., because p0 = q0 + g.
                let h = (h_rate * d + (lift - sink)) + harmonic.displacement;
                let terms = (h_rate * d).abs() + lift.abs() + sink.abs();
                (h, h_rate + (y_change + q0 * rate * decay.minus_1), terms)
            }
            _ => ((height + p_change) - q, y + spring, direct_terms),
        };
        let largest_term = terms + harmonic.displacement_terms;
        let orders = [h, h_rate, bend, third];
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

/// The change of the motion over a time in flight, however the flight began.
pub struct Flying<T> {
    /// What the static force lifts the mass by.
    pub lift: T,
    /// What the velocity of the mass changes by.
    pub y_change: T,
    /// What the displacement of the mass changes by.
    pub p_change: T,
    /// Displacement of the slider's top.
    pub q: T,
    /// The rate at which the slider's top returns.
    pub spring: T,
    /// q0 (exp(-z) - 1 + z)
    pub sink: T,
    /// The second and the third derivative of h.
    pub bends: [T; 2],
}

impl<T: Real> Flying<T> {
    /// The flight after a time `d`, from b and 1/(2 xi), and from y and q when it began.
    #[inline(always)]
    pub fn new(
        [b, rate]: [T; 2],
        [y0, q0]: [T; 2],
        d: T,
        harmonic: &Harmonic<T>,
        decay: &Decay<T>,
    ) -> Self {
        let lift = b * d * d * d.broadcast(0.5);
        let q = q0 * decay.exp;
        let spring = q * rate;
        let returns = spring * rate;
        Self {
            lift,
            y_change: b.times_plus(d, harmonic.impulse),
            p_change: y0.times_plus(d, lift + harmonic.displacement),
            q,
            spring,
            sink: q0 * decay.remainder,
            bends: [(b + harmonic.force[0]) - returns, returns.times_plus(rate, harmonic.force[1])],
        }
    }
}

/// The orders of a guard that a harmonic force and an exponential make: the gap of a flight, and
/// the drift velocity in a progression.
pub struct PushedOrders<T> {
    omega2: T,
    rate: T,
    exponential: T,
    force: T,
    next: T,
}

impl<T: Real> PushedOrders<T> {
    /// The derivatives from the exponential that is left, whose third derivative is `rate`^3 times
    /// that, and the force with its derivative.
    #[inline(always)]
    pub fn new([omega2, rate]: [T; 2], left: T, [force, next]: [T; 2]) -> Self {
        Self { omega2, rate, exponential: left * (rate * rate * rate), force, next }
    }

    /// The next order.
    #[inline(always)]
    pub fn step(&mut self) -> T {
        self.exponential = -(self.exponential * self.rate);
        (self.force, self.next) = (self.next, -(self.omega2 * self.force));
        self.next + self.exponential
    }
}
