//! Contact without progression: Eqs. (15)-(17), for every damping ratio and through resonance.

use crate::flow::complex::Complex;
use crate::flow::constants::Constants;
use crate::flow::damped::{Damping, Free};
use crate::flow::forcing::EntryAngle;
use crate::flow::{Flow, Jet, Point};
use crate::numeric::number::Number;
use crate::state::State;
use std::borrow::Borrow;

/// One contact. Its guard is the trial force f = 2 xi y + q, which stays between 0 and 1; it is
/// carried as f less `reference`, so that a switch at either threshold begins with an exact zero.
#[derive(Clone, Copy, Debug)]
pub struct Contact<T, C = Constants<T>> {
    /// The model's constants: its own, or borrowed while a switch is looked for.
    pub constants: C,
    /// State when the contact begins; p = q + g.
    pub entry: State<T>,
    /// Forcing angle then.
    pub angle: EntryAngle<T>,
    /// f - `reference` when the contact begins: 0 exactly after a progression.
    pub offset: T,
    /// The threshold, 0 or 1, from which the guard counts.
    pub reference: T,
}

impl<T: Number, C: Borrow<Constants<T>>> Flow<T> for Contact<T, C> {
    #[inline(always)]
    fn at(&self, d: T) -> Point<T> {
        let Constants { a, b, g, two_xi, damping, forced, .. } = *self.constants.borrow();
        let State { y: y0, q: q0, .. } = self.entry;
        let harmonic = self.angle.harmonic(self.constants.borrow(), d);
        let free = damping.at(d);
        let response = forced.at(d, &harmonic.turn, &free);
        let steady = |r: Complex<T>| a * (self.angle.cos * r.re - self.angle.sin * r.im);

        let f_less_b = self.offset + (self.reference - b);
        let q_less_b = q0 - b;
        let driven_force = steady(response.force);
        let (relaxing, swinging) = (f_less_b * free.s_rate_minus_1, y0 * free.s);
        let f_change = (relaxing + swinging) + driven_force;
        let y_change = (y0 * free.c_minus_1 - f_less_b * free.s) + steady(response.rate);
        let q_change = (q_less_b * free.c_minus_1 + swinging) + steady(response.displacement);
        let (y, q) = (y0 + y_change, q0 + q_change);

        let excess = self.offset + f_change;
        let orders = self.orders(d, &harmonic.force, &free, excess, y);
        let driven_bound = a * (response.force.re.abs() + response.force.im.abs());
        // The slopes count as well, times the length of a certificate: they carry the rounding of
        // y0 and of f - b even where the oscillation passes through zero or has died out, and that
        // of 2 xi (F - f), twice for the up to four times of decay.
        let at_most_one = |x: T| if x < T::one() { x } else { T::one() };
        let pulls = harmonic.force[0].abs() + (b - self.reference).abs();
        let carried = y0.abs() * at_most_one(d)
            + f_less_b.abs() * at_most_one(d * d)
            + (pulls + pulls) * at_most_one(two_xi * d);
        let largest_term = self.offset.abs() + relaxing.abs() + carried + driven_bound;
        Point {
            elapsed: d,
            state: State { p: q + g, y, q },
            slider_velocity: y,
            drift: T::zero(),
            force: harmonic.force,
            guard: Jet { orders, largest_term },
        }
    }
}

impl<T: Number, C: Borrow<Constants<T>>> Contact<T, C> {
    /// The guard and its derivatives from its value and y; `force` is F - b, F', F''.
    #[inline]
    fn orders(&self, d: T, force: &[T; 3], free: &Free<T>, excess: T, y: T) -> [T; 4] {
        let Constants { b, two_xi, damping, .. } = *self.constants.borrow();
        if let Damping::Over { fast, slow, spread } = damping
            && fast * d > T::one()
        {
            return self.slow_and_fast(force, [fast, slow, spread], free.quick, excess);
        }
        // y' = F - f and f' = 2 xi (F - f) + y, differentiated twice more. F and f may both be near
        // the threshold: it is taken off first.
        let pull = (force[0] + (b - self.reference)) - excess;
        let rate = two_xi * pull + y;
        let pull_rate = force[1] - rate;
        let rate2 = two_xi * pull_rate + pull;
        let pull_rate2 = force[2] - rate2;
        [excess, rate, rate2, two_xi * pull_rate2 + pull_rate]
    }

    /// Above critical damping, once the fast exponential has begun to die out: the equations of
    /// motion would multiply the rounding of f by 2 xi with each derivative, although what is left
    /// of f moves slowly. So its parts are differentiated one by one.
    #[inline]
    fn slow_and_fast(
        &self,
        force: &[T; 3],
        [fast, slow, spread]: [T; 3],
        quick: T,
        excess: T,
    ) -> [T; 4] {
        let Constants { a, b, two_xi, omega, steady, .. } = *self.constants.borrow();
        let EntryAngle { sin, cos, .. } = self.angle;
        let (a_cos, a_sin_omega) = (a * cos, a * sin * omega);
        let [then, then_rate, ..] = steady.orders([a_cos, -a_sin_omega, -(omega * omega * a_cos)]);
        let level = self.reference - b;
        // x = f - b - steady obeys x'' + 2 xi x' + x = 0: x' + slow x = -spread (fast part).
        let rate0 = two_xi * (a_cos - (self.offset + level)) + self.entry.y;
        let fast_part0 = -((rate0 - then_rate) + slow * (self.offset + level - then)) / spread;
        let forced = steady.orders(*force);
        let quickly = fast_part0 * quick;
        let slowly = (excess + level - forced[0]) - quickly;
        let (quickly1, slowly1) = (fast * quickly, slow * slowly);
        let (quickly2, slowly2) = (fast * quickly1, slow * slowly1);
        [
            excess,
            forced[1] - (slowly1 + quickly1),
            forced[2] + (slowly2 + quickly2),
            forced[3] - (slow * slowly2 + fast * quickly2),
        ]
    }
}
