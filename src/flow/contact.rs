//! Contact without progression: Eqs. (15)-(17), for every damping ratio and through resonance.

use crate::constants::Constants;
use crate::flow::complex::Complex;
use crate::flow::forcing::EntryAngle;
use crate::flow::{Flow, Jet, Point};
use crate::number::Number;
use crate::state::State;

/// One contact. Its guard is the trial force f = 2 xi y + q, which stays between 0 and 1; it is
/// carried as f less `reference`, so that a switch at either threshold begins with an exact zero.
#[derive(Clone, Copy, Debug)]
pub struct Contact<T> {
    /// The model's constants.
    pub constants: Constants<T>,
    /// State when the contact begins; p = q + g.
    pub entry: State<T>,
    /// Forcing angle then.
    pub angle: EntryAngle<T>,
    /// f - `reference` when the contact begins: 0 exactly after a progression.
    pub offset: T,
    /// The threshold, 0 or 1, from which the guard counts.
    pub reference: T,
}

impl<T: Number> Flow<T> for Contact<T> {
    #[inline]
    fn at(&self, d: T) -> Point<T> {
        let Constants { a, b, g, two_xi, damping, forced, .. } = self.constants;
        let State { y: y0, q: q0, .. } = self.entry;
        let harmonic = self.angle.harmonic(&self.constants, d);
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

        let force = b + harmonic.force[0];
        let excess = self.offset + f_change;
        // y' = F - f and f' = 2 xi (F - f) + y, differentiated twice more. F and f may both be near the
        // threshold: it is taken off first.
        let pull = (harmonic.force[0] + (b - self.reference)) - excess;
        let f_rate = two_xi * pull + y;
        let pull_rate = harmonic.force[1] - f_rate;
        let f_rate2 = two_xi * pull_rate + pull;
        let pull_rate2 = harmonic.force[2] - f_rate2;
        let f_rate3 = two_xi * pull_rate2 + pull_rate;
        let driven_bound = a * (response.force.re.abs() + response.force.im.abs());
        // The slopes count as well, times the length of a certificate: they carry the rounding of y0 and
        // of f - b even where the oscillation passes through zero or has died out, and that of
        // 2 xi (F - f), twice for the up to four times of decay.
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
            force: [force, harmonic.force[1], harmonic.force[2]],
            guard: Jet { orders: [excess, f_rate, f_rate2, f_rate3], largest_term },
        }
    }
}
