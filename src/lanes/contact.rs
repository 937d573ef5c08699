//! Contacts ([`crate::flow::contact`]), up to critical damping and near it: guess, evaluation, certificate, landing.
//!
//! The certificate is the scalar solver's ([`crate::crossing::certificate`]), in pieces of fixed length, which are
//! shorter where great care is taken.

use super::certificate::Piece;
use super::complex::Complex;
use super::damped::Free;
use super::forced::Response;
use super::guess::meeting;
use super::harmonic::{Angle, Harmonic, shifted};
use super::root::{Care, Found, Phase, SHORT, find};
use super::shape::Shape;
use super::swing::{Parts, of_guess, of_piece};
use super::wide::{Mask, Wide};
use pulp::Simd;

/// Contacts; their guard is the trial force less `reference`.
pub struct Contact<'a, S: Simd> {
    /// The model.
    pub shape: &'a Shape<Wide<S>>,
    /// Forcing angle at the start.
    pub angle: Angle<S>,
    /// Velocity of the mass then.
    pub y: Wide<S>,
    /// The guard then.
    pub offset: Wide<S>,
    /// The threshold, 0 or 1, from which it counts.
    pub reference: Wide<S>,
}

/// A contact at some time.
#[derive(Clone, Copy)]
pub struct Pressed<S: Simd> {
    /// The guard and its first three derivatives.
    f: [Wide<S>; 4],
    /// F - b and its first two derivatives.
    force: [Wide<S>; 3],
    y: Wide<S>,
    q: Wide<S>,
    /// The largest terms of the guard.
    terms: Wide<S>,
}

/// The trial force reaches a threshold.
pub struct Release<S: Simd> {
    /// When: an evaluation, and from there to the root.
    pub elapsed: (Wide<S>, Wide<S>),
    /// Velocity of the mass.
    pub y: Wide<S>,
    /// Where it is the upper threshold.
    pub rises: Mask<S>,
    /// Where all this is proved.
    pub fine: Mask<S>,
}

/// A contact with the threshold that it is guessed to leave through.
struct Leaving<'a, 'b, S: Simd> {
    contact: &'b Contact<'a, S>,
    threshold: Wide<S>,
}

/// Pieces of a certificate, after which a lane is left to the scalar solver,
const PIECES: usize = 8;
/// the same with great care,
const FINE_PIECES: usize = 16;
/// and how much longer than a stride the last one may be.
const REST: f64 = 1.3;
/// Strides of a guess, after which a lane is left to the scalar solver.
const STRIDES: usize = 24;

impl<S: Simd> Phase<S> for Leaving<'_, '_, S> {
    type At = Pressed<S>;

    #[inline(always)]
    fn at(&self, d: Wide<S>) -> Pressed<S> {
        self.contact.at(d)
    }

    #[inline(always)]
    fn excess(&self, at: &Pressed<S>) -> [Wide<S>; 4] {
        let [value, slope, bend, third] = at.f;
        [value - self.threshold, slope, bend, third]
    }

    #[inline(always)]
    fn is_short(&self, _: Wide<S>, step: Wide<S>) -> Mask<S> {
        (step.abs() * self.contact.shape.quickest).below(SHORT)
    }
}

impl<S: Simd> Contact<'_, S> {
    /// The motion after `d`.
    #[inline(always)]
    fn at(&self, d: Wide<S>) -> Pressed<S> {
        let Shape { a, b, two_xi, .. } = *self.shape;
        let Harmonic { force, turn, .. } = self.angle.after(self.shape, d);
        let free = Free::after(self.shape, d);
        let Free { s, c_minus_1, s_rate_minus_1, .. } = free;
        let response = Response::after(self.shape, d, &turn, &free);
        let steady = |it: Complex<S>| a * self.angle.sin.times_from(it.im, self.angle.cos * it.re);
        let (driven, y_driven) = (steady(response.force), steady(response.rate));
        let driven_bound = a * (response.force.re.abs() + response.force.im.abs());

        let level = self.offset + (self.reference - b);
        let relaxing = level * s_rate_minus_1;
        let f_change = self.y.times_plus(s, relaxing) + driven;
        let y_change = level.times_from(s, self.y * c_minus_1) + y_driven;
        let excess = self.offset + f_change;
        let y = self.y + y_change;
        let one = d.same(1.0);
        let pulls = force[0].abs() + (b - self.reference).abs();
        let carried = self.y.abs() * d.smaller(one)
            + level.abs() * (d * d).smaller(one)
            + (pulls + pulls) * (two_xi * d).smaller(one);
        let terms = self.offset.abs() + relaxing.abs() + carried + driven_bound;
        let q = two_xi.times_from(y, excess + self.reference);
        Pressed { f: self.orders(force, excess, y), force, y, q, terms }
    }

    /// The guard and its derivatives; `force` is F - b, F', F''.
    #[inline(always)]
    fn orders(&self, force: [Wide<S>; 3], excess: Wide<S>, y: Wide<S>) -> [Wide<S>; 4] {
        let Shape { b, two_xi, .. } = *self.shape;
        let pull = (force[0] + (b - self.reference)) - excess;
        let rate = two_xi.times_plus(pull, y);
        let pull_rate = force[1] - rate;
        let bend = two_xi.times_plus(pull_rate, pull);
        let pull_bend = force[2] - bend;
        [excess, rate, bend, two_xi.times_plus(pull_bend, pull_rate)]
    }

    /// The switches that end the contacts.
    #[inline(always)]
    pub fn release(&self, care: Care) -> Release<S> {
        let first = self.orders(self.angle.force(self.shape), self.offset, self.y);
        let (guess, threshold, guessed) = self.first_exit(first);
        let Found { at, elapsed, step, fine } =
            find(&Leaving { contact: self, threshold }, guess, guessed);
        // y' = F - f
        let force = shifted(self.shape.omega2, at.force, step);
        let [f, f1, f2, f3] = at.f;
        let [u, v, w] = at.force;
        let pull = (u + (self.shape.b - self.reference)) - f;
        let next = -(self.shape.omega2 * v) - f3;
        let bent = step.times_plus(next * (1.0 / 24.0), (w - f2) * (1.0 / 6.0));
        let turning = step.times_plus(bent, (v - f1) * 0.5);
        let y = at.y + step * step.times_plus(turning, pull);
        let last = self.orders(force, threshold, y);
        let rises = !(threshold + self.reference).below(0.5);
        let outward = rises.choose(last[1], -last[1]).above(0.0);
        let fine = fine & outward & self.stays_inside(first, last, elapsed + step, at.terms, care);
        Release { elapsed: (elapsed, step), y, rises, fine }
    }

    /// Displacement of the slider's top, velocity and guard at some time, and their rates.
    #[inline(always)]
    pub fn state(&self, d: Wide<S>) -> ([Wide<S>; 3], [Wide<S>; 3]) {
        let at = self.at(d);
        let pull = (at.force[0] + (self.shape.b - self.reference)) - at.f[0];
        ([at.q, at.y, at.f[0]], [at.y, pull, at.f[1]])
    }

    /// The force in parts at the start, from its orders there.
    #[inline(always)]
    fn parts(&self, [f, f1, ..]: [Wide<S>; 4]) -> Parts<S> {
        let Shape { b, omega, steady, steady_rate, .. } = *self.shape;
        let [u, v, w] = self.angle.force(self.shape);
        let level = b - self.reference;
        let free = (f - level) - steady_rate.times_plus(v, steady * u);
        let free_rate = f1 - steady_rate.times_plus(w, steady * v);
        Parts { free, free_rate, forced: (f - level) - free, quarter: (f1 - free_rate) / omega }
    }

    /// When the force may first leave its corridor, through which threshold, and where that is told.
    #[inline(always)]
    fn first_exit(&self, orders: [Wide<S>; 4]) -> (Wide<S>, Wide<S>, Mask<S>) {
        let Shape { b, omega, swing: stride, .. } = *self.shape;
        let swing = of_guess(self.shape);
        let level = b - self.reference;
        let (low, high) = (-self.reference, -self.reference + 1.0);
        let mut here = self.parts(orders);
        let (mut value, mut rate) = (orders[0], orders[1]);
        let zero = b.same(0.0);
        let mut elapsed = zero;
        let mut found = zero.less(zero);
        let mut open = !found;
        let mut chord = (value, zero, rate, zero, zero, zero);
        for _ in 0..STRIDES {
            here = here.after(swing);
            let next = level + here.free + here.forced;
            let next_rate = omega.times_plus(here.quarter, here.free_rate);
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
            );
            found = found | leaves;
            open = open & !leaves;
            if !open.any() {
                break;
            }
            (value, rate, elapsed) = (next, next_rate, elapsed + stride);
        }
        let (left, right, left_rate, right_rate, from, threshold) = chord;
        let share = meeting(left, right, (left_rate * stride, right_rate * stride));
        (share.times_plus(stride, from), threshold, found)
    }

    /// Where the force stays inside its corridor from the start to the root, by their orders: in pieces, whose
    /// ends follow from the start in strides of the model's own length.
    #[inline(always)]
    fn stays_inside(
        &self,
        first: [Wide<S>; 4],
        last: [Wide<S>; 4],
        length: Wide<S>,
        terms: Wide<S>,
        care: Care,
    ) -> Mask<S> {
        let Shape { two_xi, forced_eighth, .. } = *self.shape;
        let (low, high) = (-self.reference, -self.reference + 1.0);
        let mut here = self.parts(first);
        let (mut x, mut rate) = (here.free, here.free_rate);
        for _ in 0..8 {
            (x, rate) = (rate, -two_xi.times_plus(rate, x));
        }
        let eighth = x.times_plus(x, rate * rate).sqrt() + forced_eighth;
        let slack = self.slack(&here, terms);
        let (stride, swing, pieces) = match care {
            Care::Usual => (self.shape.piece, of_piece(self.shape), PIECES),
            Care::Great => (self.shape.swing, of_guess(self.shape), FINE_PIECES),
        };
        let mut left = first;
        // The start's own value does not count where it is a threshold by the switch that began the contact.
        let mut bare = first[0].is(0.0);
        let mut rest = length;
        let none = bare & !bare;
        let (mut open, mut fine) = (!none, !none);
        for _ in 0..pieces {
            let is_last = rest.less(stride * REST);
            here = here.after(swing);
            let next = here.orders(self.shape, self.reference);
            let right: [Wide<S>; 4] = std::array::from_fn(|k| is_last.choose(last[k], next[k]));
            let length = is_last.choose(rest, stride);
            let piece = Piece { left, right, length, eighth, bare, double: none, to_root: is_last };
            fine = fine & (piece.stays_between(low, high, slack) | !open);
            open = open & !is_last;
            if !open.any() {
                break;
            }
            (left, bare, rest) = (next, none, rest - stride);
        }
        fine & !open
    }

    /// Rounding room: four eps of the guard's terms, and what the strides round.
    #[inline(always)]
    fn slack(&self, parts: &Parts<S>, terms: Wide<S>) -> Wide<S> {
        let size = parts.free.abs()
            + parts.free_rate.abs()
            + parts.forced.abs()
            + parts.quarter.abs()
            + self.shape.b.abs();
        (terms.larger(self.offset.abs()) + 1.0) * (4.0 * f64::EPSILON)
            + size * (16.0 * f64::EPSILON)
    }
}
