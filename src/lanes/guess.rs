//! Guesses of roots outside contact: the slow part of a guard and its harmonic, looked at in
//! steps ([`crate::crossing::slow_envelope`]).

use super::functions::{MAX_ARGUMENT, sin_cos};
use super::shape::Shape;
use super::wide::{Mask, Wide};
use crate::crossing::allowances::GUESS_STEPS;
use crate::numeric::real::Real;
use pulp::Simd;

/// The guard, counted so that it rises to zero: c + s d + k d^2/2 - K cos(omega d + angle) - e
/// exp(-rate d).
pub struct LaneEnvelope<'a, S: Simd> {
    /// The model.
    pub shape: &'a Shape<Wide<S>>,
    /// c
    pub offset: Wide<S>,
    /// s
    pub slope: Wide<S>,
    /// k
    pub curvature: Wide<S>,
    /// K
    pub amplitude: Wide<S>,
    /// Sine of `angle`.
    pub sin: Wide<S>,
    /// Cosine of `angle`.
    pub cos: Wide<S>,
    /// e
    pub exponential: Wide<S>,
    /// The guard at the beginning, without its exponential where that lives less than a step.
    pub first: Wide<S>,
}

struct LanePlace<S: Simd> {
    elapsed: Wide<S>,
    sin: Wide<S>,
    cos: Wide<S>,
    lasting: Wide<S>,
    value: Wide<S>,
    rate: Wide<S>,
}

impl<S: Simd> LaneEnvelope<'_, S> {
    /// When the guard may first rise to zero, and in which lanes that is told.
    #[inline(always)]
    pub fn first_root(&self) -> (Wide<S>, Mask<S>) {
        let Shape { guess_step, guess_step_sin, guess_step_cos, guess_step_decay, omega, .. } =
            *self.shape;
        let zero = guess_step.broadcast(0.0);
        let alive = guess_step_decay.above(0.0);
        let lasting = alive.choose(self.exponential, zero);
        let mut here = self.place(zero, self.sin, self.cos, lasting);
        here.value = self.first;
        let mut chord = (here.value, zero, here.rate, zero, zero);
        let mut open = !(zero.less(zero));
        let mut found = zero.less(zero);
        for _ in 0..GUESS_STEPS {
            let closed = open & (self.parabola(here.elapsed) + self.amplitude).less(zero);
            if closed.any() {
                here = self.skip(here, closed);
            }
            let next = self.place(
                here.elapsed + guess_step,
                here.sin.times_plus(guess_step_cos, here.cos * guess_step_sin),
                here.sin.times_from(guess_step_sin, here.cos * guess_step_cos),
                here.lasting * guess_step_decay,
            );
            let risen = open & !next.value.less(zero);
            chord = (
                risen.choose(here.value, chord.0),
                risen.choose(next.value, chord.1),
                risen.choose(here.rate, chord.2),
                risen.choose(next.rate, chord.3),
                risen.choose(here.elapsed, chord.4),
            );
            found = found | risen;
            open = open & !risen & (next.elapsed * omega).below(MAX_ARGUMENT);
            if !open.any() {
                break;
            }
            here = next;
        }
        let (left, right, left_rate, right_rate, from) = chord;
        let share = zero_between(left, right, (left_rate * guess_step, right_rate * guess_step));
        (share.times_plus(guess_step, from), found)
    }

    #[inline(always)]
    fn place(
        &self,
        elapsed: Wide<S>,
        sin: Wide<S>,
        cos: Wide<S>,
        lasting: Wide<S>,
    ) -> LanePlace<S> {
        let Self { slope, curvature, amplitude, .. } = *self;
        let Shape { omega, rate: decay, .. } = *self.shape;
        let value = self.parabola(elapsed) - amplitude.times_plus(cos, lasting);
        let rise = curvature.times_plus(elapsed, slope);
        let rate = (amplitude * omega).times_plus(sin, decay.times_plus(lasting, rise));
        LanePlace { elapsed, sin, cos, lasting, value, rate }
    }

    #[inline(always)]
    fn parabola(&self, d: Wide<S>) -> Wide<S> {
        d.times_plus(d.times_plus(self.curvature * 0.5, self.slope), self.offset)
    }

    /// Skips the time in which the parabola lies below minus the amplitude: the place where it no
    /// longer does.
    #[inline(always)]
    fn skip(&self, here: LanePlace<S>, closed: Mask<S>) -> LanePlace<S> {
        let Shape { omega, guess_step, .. } = *self.shape;
        let value = self.parabola(here.elapsed) + self.amplitude;
        let rising = self.curvature.times_plus(here.elapsed, self.slope);
        let square =
            (self.curvature * value * 2.0).times_from(value.broadcast(1.0), rising * rising);
        let root = square.sqrt();
        // One of the root's two forms subtracts numbers that may be close; this takes the other.
        let falling = rising.below(0.0);
        let above = falling.choose(root - rising, value * -2.0);
        let time = above / falling.choose(self.curvature, rising + root);
        // A NaN is no place further on.
        let further = closed & guess_step.less(time) & (time * omega).below(MAX_ARGUMENT);
        let opens = further.choose(here.elapsed + time, here.elapsed);
        let (sin, cos) = sin_cos(omega * opens);
        let moved = self.place(
            opens,
            self.sin.times_plus(cos, self.cos * sin),
            self.sin.times_from(sin, self.cos * cos),
            opens.broadcast(0.0),
        );
        LanePlace {
            elapsed: opens,
            sin: further.choose(moved.sin, here.sin),
            cos: further.choose(moved.cos, here.cos),
            lasting: further.choose(moved.lasting, here.lasting),
            value: further.choose(moved.value, here.value),
            rate: further.choose(moved.rate, here.rate),
        }
    }
}

/// The place at which the cubic through two values with these slopes, all in units of the step, is
/// zero; if it begins with a zero, the one after that.
#[inline(always)]
pub fn zero_between<S: Simd>(
    left: Wide<S>,
    right: Wide<S>,
    (left_slope, right_slope): (Wide<S>, Wide<S>),
) -> Wide<S> {
    // A guard that falls is looked at upside down: below, the zero is where it rises.
    let falls = left.above(0.0);
    let rising = |x: Wide<S>| falls.choose(-x, x);
    let (left, right) = (rising(left), rising(right));
    let (left_slope, right_slope) = (rising(left_slope), rising(right_slope));
    let rise = right - left;
    let second = (rise * 3.0 - left_slope * 2.0) - right_slope;
    let third = (left_slope + right_slope) - rise * 2.0;
    let cubic =
        |t: Wide<S>| t.times_plus(t.times_plus(t.times_plus(third, second), left_slope), left);
    // The third in which it is: behind a crest Newton's method would go astray.
    let third_of = left.broadcast(1.0 / 3.0);
    let (early, later) = (cubic(third_of), cubic(third_of + third_of));
    let (in_first, in_second) = (!early.below(0.0), !later.below(0.0));
    let (zero, one) = (left.broadcast(0.0), left.broadcast(1.0));
    let from = in_first.choose(zero, in_second.choose(third_of, third_of + third_of));
    let here = in_first.choose(left, in_second.choose(early, later));
    let there = in_first.choose(early, in_second.choose(later, right));
    let mut t = from - third_of * (here / (there - here));
    for _ in 0..2 {
        let slope = t.times_plus(t.times_plus(third * 3.0, second * 2.0), left_slope);
        t = (t - cubic(t) / slope).larger(from).smaller(from + third_of);
    }
    let deflated = left.is(0.0);
    if deflated.any() {
        // left_slope + second t + third t^2 = 0
        let root = (third * left_slope * 4.0).times_from(t.broadcast(1.0), second * second).sqrt();
        let sign = second.below(0.0).choose(-root, root);
        let sum = (second + sign) * -0.5;
        let (one, other) = (left_slope / sum, sum / third);
        let inside = |x: Wide<S>| x.above(0.0) & x.below(1.0);
        t = deflated.choose(inside(one).choose(one, other), t);
    }
    // A NaN becomes the middle.
    let ordered = t.above(-1e300) & t.below(1e300);
    ordered.choose(t, t.broadcast(0.5)).larger(zero).smaller(one)
}
