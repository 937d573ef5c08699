//! Where a contact ends, guessed, and that it does not end before
//! ([`crate::crossing::contact_ahead`]).
//!
//! The certificate is the scalar solver's ([`crate::crossing::certificate`]), in pieces of fixed
//! length, which are shorter where finer pieces are asked for.

use super::certificate::LanePiece;
use super::contact::LaneContact;
use super::contact_constants::Forms;
use super::contact_steps::{ContactSteps, LaneParts, choose_each};
use super::guess::zero_between;
use super::root::Fineness;
use super::shape::Shape;
use super::wide::{Mask, Wide};
use crate::crossing::allowances::{
    CONTACT_PIECES, GUESS_STEPS, LANE_FINE_PIECES, MAX_LAST_STEP_RATIO, SLACK,
};
use crate::numeric::real::Real;
use pulp::Simd;

impl<S: Simd> LaneContact<'_, S> {
    /// When the force may first leave its corridor, through which threshold, and where that is
    /// told.
    #[inline(always)]
    pub fn first_exit(&self, orders: [Wide<S>; 4]) -> (Wide<S>, Wide<S>, Mask<S>) {
        let (low, high) = (-self.reference, -self.reference + 1.0);
        let mut here = self.parts(orders);
        let (mut value, mut rate) = (orders[0], orders[1]);
        let mut steps = ContactSteps::of_guess(self.shape, self.forms);
        let zero = value.broadcast(0.0);
        let mut elapsed = zero;
        let mut found = zero.less(zero);
        let mut open = !found;
        let mut chord = (value, zero, rate, zero, zero, zero, zero);
        for _ in 0..GUESS_STEPS {
            let step = steps.now.length;
            here = here.after(&steps.now);
            let [next, next_rate, ..] = here.orders(self.shape, self.reference);
            let over = !next.less(high);
            let leaves = open & (over | !low.less(next));
            let threshold = over.choose(high, low);
            chord = (
                leaves.choose(value - threshold, chord.0),
                leaves.choose(next - threshold, chord.1),
                leaves.choose(rate, chord.2),
                leaves.choose(next_rate, chord.3),
                leaves.choose(elapsed, chord.4),
                leaves.choose(threshold, chord.5),
                leaves.choose(step, chord.6),
            );
            found = found | leaves;
            open = open & !leaves;
            if !open.any() {
                break;
            }
            (value, rate, elapsed) = (next, next_rate, elapsed + step);
            steps.next();
        }
        let (left, right, left_rate, right_rate, from, threshold, step) = chord;
        let share = zero_between(left, right, (left_rate * step, right_rate * step));
        (share.times_plus(step, from), threshold, found)
    }

    /// The lanes in which the force stays inside its corridor from the start to the root, by their
    /// orders: in pieces, whose ends follow from the start in steps of the model's own length.
    #[inline(always)]
    pub fn stays_inside(
        &self,
        first: [Wide<S>; 4],
        last: [Wide<S>; 4],
        length: Wide<S>,
        terms: Wide<S>,
        fineness: Fineness,
    ) -> Mask<S> {
        let Shape { forced_eighth, fast, .. } = *self.shape;
        let (low, high) = (-self.reference, -self.reference + 1.0);
        let mut here = self.parts(first);
        let over = fast.above(0.0);
        let mut eighth = here.eighth(self.shape) + forced_eighth;
        let slack = self.slack(&here, terms);
        let (mut steps, pieces) = match fineness {
            Fineness::Usual => (ContactSteps::of_pieces(self.shape, self.forms), CONTACT_PIECES),
            Fineness::Finer => (ContactSteps::of_guess(self.shape, self.forms), LANE_FINE_PIECES),
        };
        let mut left = first;
        // The start's own value does not count where it is a threshold by the switch that began the
        // contact.
        let mut bare = first[0].is(0.0);
        let mut rest = length;
        let none = bare & !bare;
        let (mut open, mut proved) = (!none, !none);
        for _ in 0..pieces {
            let step = steps.now.length;
            let is_last = rest.less(step * MAX_LAST_STEP_RATIO);
            if self.forms == Forms::Any {
                let shrinking = here.eighth_of_exponentials(self.shape) + forced_eighth;
                eighth = over.choose(shrinking, eighth);
            }
            here = here.after(&steps.now);
            let next = here.orders(self.shape, self.reference);
            let right = choose_each(is_last, last, next);
            let length = is_last.choose(rest, step);
            let piece =
                LanePiece { left, right, length, eighth, bare, double: none, to_root: is_last };
            proved = proved & (piece.stays_between(low, high, slack) | !open);
            open = open & !is_last;
            if !open.any() {
                break;
            }
            (left, bare, rest) = (next, none, rest - step);
            steps.next();
        }
        proved & !open
    }

    /// Rounding room: that of the guard's terms, and what the steps round.
    #[inline(always)]
    fn slack(&self, parts: &LaneParts<S>, terms: Wide<S>) -> Wide<S> {
        let size = parts.size() + self.shape.pulls;
        (terms.larger(self.offset.magnitude()) + 1.0) * SLACK
            + size * (self.shape.roundings * f64::EPSILON)
    }
}
