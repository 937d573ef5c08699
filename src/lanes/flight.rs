//! Flights that begin by separation ([`crate::flow::no_contact`]): guess, evaluation, certificate,
//! landing.
//!
//! # Certificate
//!
//! Tangents certify a flight as in [`crate::crossing::tangents`], one flight a lane. Off the
//! surface the spring is compared with the largest force in that interval, where the scalar solver
//! takes the largest force of all times. Flights whose start neither concavity nor sinking clears
//! are certified in finer pieces, by three tangents more in a stretch or as the scalar solver
//! certifies short flights ([`crate::crossing::no_contact`]).

use super::certificate::LanePiece;
use super::forcing::Angle;
use super::functions::shrink;
use super::guess::LaneEnvelope;
use super::root::{Fineness, LanePhase, LaneRoot, find};
use super::series::LATER_ORDERS;
use super::shape::Shape;
use super::wide::{Mask, Wide};
use crate::crossing::allowances::{
    LANE_FORCE_MARGIN, LANE_TIE_TOLERANCE, MAX_WHOLE_PHASE_RADIANS, SLACK, TANGENT_STRETCHES,
};
use crate::crossing::tangents::{EndedFlight, Tangent, TangentBound};
use crate::flow::forcing::{Harmonic, Push};
use crate::flow::no_contact::{Flying, PushedOrders};
use crate::flow::steps::{MAX_PULLING_DECAY_TIMES, MIN_SLIDER_RETURN, SEPARATION_DECAY_TIMES};
use crate::numeric::real::Real;
use crate::numeric::remainders::short_decay;
use crate::numeric::series::REACH;
use pulp::Simd;
use std::f64::consts::TAU;

/// Flights on the contact surface with f = 0.
pub struct Flight<'a, S: Simd> {
    /// The model.
    pub shape: &'a Shape<Wide<S>>,
    /// Forcing angle at the start.
    pub angle: Angle<S>,
    /// Velocity of the mass when the flight begins.
    pub y: Wide<S>,
    /// Displacement of the slider's top when the flight begins.
    pub q: Wide<S>,
}

/// A flight at some time.
#[derive(Clone, Copy)]
pub struct Aloft<S: Simd> {
    /// h and its first three derivatives.
    h: [Wide<S>; 4],
    force: [Wide<S>; 3],
    /// What p has changed by.
    risen: Wide<S>,
    y: Wide<S>,
    q: Wide<S>,
}

/// An impact.
pub struct Impact<S: Simd> {
    /// The time of the end: that of an evaluation, and the step from there to the root.
    pub elapsed: (Wide<S>, Wide<S>),
    /// Velocity of the mass.
    pub y: Wide<S>,
    /// Displacement of the slider's top.
    pub q: Wide<S>,
    /// Trial force.
    pub f: Wide<S>,
    /// The lanes in which the event and all these values are proved.
    pub proved: Mask<S>,
}

/// Decay times after which an exponential is less than 1e-19 of what it was.
const NEGLIGIBLE_DECAY_TIMES: f64 = 45.0;
impl<S: Simd> LanePhase<S> for Flight<'_, S> {
    type At = Aloft<S>;

    #[inline(always)]
    fn at(&self, d: Wide<S>) -> Aloft<S> {
        let Shape { b, rate, .. } = *self.shape;
        let harmonic = self.angle.after(self.shape, d);
        let decay = shrink(rate * d);
        let flying = Flying::new([b, rate], [self.y, self.q], d, &harmonic, &decay);
        let Flying { lift, y_change, p_change, q, sink, bends: [bend, third], .. } = flying;
        let Harmonic { force, displacement, .. } = harmonic;
        let h = (lift - sink) + displacement;
        let h_rate = y_change + self.q * rate * decay.minus_1;
        Aloft {
            h: [h, h_rate, bend, third],
            force: [b + force[0], force[1], force[2]],
            risen: p_change,
            y: self.y + y_change,
            q,
        }
    }

    #[inline(always)]
    fn excess(&self, at: &Aloft<S>) -> [Wide<S>; 4] {
        at.h
    }

    #[inline(always)]
    fn later_orders(&self, at: &Aloft<S>) -> [Wide<S>; LATER_ORDERS] {
        let Shape { b, omega2, rate, .. } = *self.shape;
        let [total, next, _] = at.force;
        let mut higher = PushedOrders::new([omega2, rate], at.q, [total - b, next]);
        [(); LATER_ORDERS].map(|()| higher.step())
    }

    #[inline(always)]
    fn is_short(&self, d: Wide<S>, step: Wide<S>) -> Mask<S> {
        let Shape { pace, rate, .. } = *self.shape;
        let step = step.magnitude();
        (step * pace).below(REACH)
            & ((step * rate).below(REACH) | (rate * (d - step)).above(NEGLIGIBLE_DECAY_TIMES))
    }
}

impl<S: Simd> Flight<'_, S> {
    /// The impacts that end the flights.
    #[inline(always)]
    pub fn impact(&self, fineness: Fineness) -> Impact<S> {
        let Shape { b, two_xi, rate, guess_step, guess_step_decay, .. } = *self.shape;
        let (guess, guessed) = self.slow_envelope().first_root();
        // Within the first step of a short-lived exponential: its end, from where the convex h
        // leads back.
        let hasty = guess.less(guess_step) & guess_step_decay.is(0.0);
        let guess = hasty.choose(guess_step, guess);
        let LaneRoot { at, elapsed, step, slope, found, .. } = find(self, guess, guessed);
        let [total, v, _] = at.force;
        let push = Push::new(self.shape.omega, [total - b, v], step);
        let lost = at.q * short_decay(rate * step);
        let (y, q) = (at.y + b.times_plus(step, push.impulse), at.q + lost);
        let f = two_xi * slope;
        let largest = (two_xi * y).magnitude().larger(q.magnitude());
        let clear = (largest * LANE_TIE_TOLERANCE).less(f)
            & (largest.larger(y.broadcast(1.0)) * LANE_TIE_TOLERANCE).less((f - 1.0).magnitude());
        let root = elapsed + step;
        let certified = match fineness {
            Fineness::Usual => self.stays_below(root, q, fineness),
            Fineness::Finer => {
                let [force, force_rate, _] = push.force;
                self.stays_below(root, q, fineness)
                    | self.hops(root, [slope, q * rate, force + b, force_rate])
            }
        };
        let proved = found & clear & self.q.above(0.0) & certified;
        Impact { elapsed: (elapsed, step), y, q, f, proved }
    }

    /// Displacement of the mass, its velocity and the slider's top at some time, and the rate of
    /// the latter and of the velocity.
    #[inline(always)]
    pub fn state(&self, d: Wide<S>) -> ([Wide<S>; 3], [Wide<S>; 3]) {
        let at = self.at(d);
        let p = (self.q + self.shape.g) + at.risen;
        ([p, at.y, at.q], [at.y, at.force[0], -(at.q * self.shape.rate)])
    }

    #[inline(always)]
    fn slow_envelope(&self) -> LaneEnvelope<'_, S> {
        let Shape { a_over_omega, a_over_omega2, b, .. } = *self.shape;
        let Angle { sin, cos, .. } = self.angle;
        let offset = a_over_omega2.times_plus(cos, self.q);
        LaneEnvelope {
            shape: self.shape,
            offset,
            slope: a_over_omega.times_from(sin, self.y),
            curvature: b,
            amplitude: a_over_omega2,
            sin,
            cos,
            exponential: self.q,
            first: b.broadcast(0.0),
        }
    }

    /// E up to the root, at which the slider's top is `q`.
    #[inline(always)]
    fn bound(&self, root: Wide<S>, q: Wide<S>) -> TangentBound<Wide<S>> {
        let Shape { b, rate, a_over_omega, a_over_omega2, .. } = *self.shape;
        let Angle { sin, cos, .. } = self.angle;
        // No term of the guard is larger than these: its terms at the root.
        let sunk = self.q * rate * root;
        let turned = a_over_omega.times_plus(root, a_over_omega2 * 3.0);
        let lifted = b.magnitude() * root * root * 0.5;
        TangentBound::new(&EndedFlight {
            b,
            a_over_omega,
            a_over_omega2,
            sin_cos: [sin, cos],
            begin: [self.y, self.q],
            root: [root, q, q * rate],
            slack: (sunk + turned + lifted) * SLACK,
        })
    }

    /// Proves that h stays below zero in a stretch by three tangents more in between: at forcing
    /// angles whose sine and cosine are constants. Those before the place where the stretch is
    /// entered do not count.
    #[inline(always)]
    fn stays_below_between(
        &self,
        bound: &TangentBound<Wide<S>>,
        near: &Tangent<Wide<S>>,
        far: &Tangent<Wide<S>>,
        length: Wide<S>,
    ) -> Mask<S> {
        let Shape { halfway_sin, halfway_cos, .. } = *self.shape;
        let zero = length.broadcast(0.0);
        let inner = [
            (0.75, halfway_sin, halfway_cos),
            (0.5, zero, length.broadcast(-1.0)),
            (0.25, -halfway_sin, halfway_cos),
        ];
        let mut last = Tangent { ..*near };
        let mut below = !zero.less(zero);
        for (rest, sin, cos) in inner {
            let from = length.times_from(length.broadcast(rest), far.from);
            let ahead = last.from.less(from);
            let next = last.or_where(ahead, bound.at(from, [sin, cos]));
            below = below & (last.stays_below_to(&next) | !ahead);
            last = next;
        }
        below & last.stays_below_to(far)
    }

    /// The lanes in which one interpolant shows that h is negative from the start to the root, at
    /// which these are h', the slider's velocity, the force and its rate.
    #[inline(always)]
    fn hops(&self, root: Wide<S>, [slope, spring, force, force_rate]: [Wide<S>; 4]) -> Mask<S> {
        let Shape { a, b, omega, omega2, rate, .. } = *self.shape;
        let zero = root.broadcast(0.0);
        let orders = |spring: Wide<S>, force: Wide<S>, force_rate: Wide<S>| {
            [rate.times_from(spring, force), (rate * rate).times_plus(spring, force_rate)]
        };
        let [u, v, _] = self.angle.force(self.shape);
        let [bend, third] = orders(self.q * rate, b + u, v);
        let [last_bend, last_third] = orders(spring, force, force_rate);
        let everywhere = !zero.less(zero);
        let piece = LanePiece {
            left: [zero, zero, bend.smaller(zero), third],
            right: [zero, slope, last_bend, last_third],
            length: root,
            eighth: a * (omega2 * omega2 * omega2),
            bare: everywhere,
            double: everywhere,
            to_root: everywhere,
        };
        let terms = (a + b.magnitude()) * root * root + self.q * (rate * root + 1.0);
        let short = (root * rate).below(MAX_PULLING_DECAY_TIMES)
            & (root * omega).below(MAX_WHOLE_PHASE_RADIANS);
        let lowest = zero.broadcast(f64::NEG_INFINITY);
        short & piece.stays_between(lowest, zero, terms * SLACK)
    }

    /// The lanes in which h is negative from the start to the root, at which the slider's top is
    /// `q`.
    #[inline(always)]
    fn stays_below(&self, root: Wide<S>, q: Wide<S>, fineness: Fineness) -> Mask<S> {
        let Shape { a, b, omega, rate, turning, turning_sin, turning_cos, .. } = *self.shape;
        let Angle { radians: angle, sin, cos } = self.angle;
        let zero = root.broadcast(0.0);
        let bound = self.bound(root, q);

        let concave_at_first = !angle.less(turning) & !(-turning + TAU).less(angle);
        let settled = rate.broadcast(SEPARATION_DECAY_TIMES) / rate;
        let concave_until = ((-turning + TAU) - angle) / omega;
        let Shape { settling_sin, settling_cos, .. } = *self.shape;
        let settled_sin = sin.times_plus(settling_cos, cos * settling_sin);
        let settled_cos = sin.times_from(settling_sin, cos * settling_cos);
        // The largest force until then: at either end, unless a crest lies between.
        let no_crest = settled.times_plus(omega, angle).below(TAU);
        let crest = no_crest.choose(cos.larger(settled_cos), cos.broadcast(1.0));
        let strongest = a.times_plus(crest, b) + (a + b.magnitude()) * LANE_FORCE_MARGIN;
        let sinks = strongest.less(self.q * rate * rate * MIN_SLIDER_RETURN);
        let by_sinking = sinks & !(concave_at_first & settled.less(concave_until));
        let start = by_sinking.choose(settled, concave_until);
        let start_sin = by_sinking.choose(settled_sin, -turning_sin);
        let start_cos = by_sinking.choose(settled_cos, turning_cos);
        let first = bound.at(start, [start_sin, start_cos]);
        let mut proved = (sinks | concave_at_first) & start.less(root) & first.value.less(zero);

        // The stretch of negative force that the flight begins in, or the first one after that.
        let late = (-turning + TAU).less(angle);
        let mut begins = ((turning - angle) + late.choose(zero.broadcast(TAU), zero)) / omega;
        let period = omega.broadcast(TAU) / omega;
        let length = (-turning + std::f64::consts::PI) * 2.0 / omega;
        let mut open = proved;
        for _ in 0..TANGENT_STRETCHES {
            let ends = begins + length;
            // The last stretch rises to the root, and what begins after the root does not count.
            open = open & ends.less(root);
            if !open.any() {
                return proved;
            }
            let near = bound.at(begins, [turning_sin, turning_cos]);
            let near = near.or_where(begins.less(start), first);
            let far = bound.at(ends, [-turning_sin, turning_cos]);
            let below = match fineness {
                Fineness::Usual => near.stays_below_to(&far),
                Fineness::Finer => self.stays_below_between(&bound, &near, &far, length),
            };
            proved = proved & (below | !open | !start.less(ends));
            begins = begins + period;
            open = open & proved;
        }
        proved & !open
    }
}

impl<S: Simd> Tangent<Wide<S>> {
    /// This tangent, or another one where the mask holds.
    #[inline(always)]
    fn or_where(self, mask: Mask<S>, other: Self) -> Self {
        Self {
            from: mask.choose(other.from, self.from),
            value: mask.choose(other.value, self.value),
            slope: mask.choose(other.slope, self.slope),
        }
    }
}
