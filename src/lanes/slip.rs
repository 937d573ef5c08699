//! Progressions ([`crate::flow::progression`]): guess, evaluation, certificate, landing.
//!
//! The certificate is the solver's inequality ([`crate::crossing::progression::stops_once`]); other
//! progressions are left to the scalar solver.

use super::forcing::Angle;
use super::functions::shrink;
use super::guess::LaneEnvelope;
use super::root::{LanePhase, LaneRoot, find};
use super::series::LATER_ORDERS;
use super::shape::Shape;
use super::wide::{Mask, Wide};
use crate::crossing::progression::stops_once;
use crate::flow::no_contact::PushedOrders;
use crate::flow::progression::{Slipped, Slipping};
use crate::numeric::real::Real;
use crate::numeric::remainders::short_decay;
use crate::numeric::series::REACH;
use pulp::Simd;

/// Progressions.
pub struct Slip<'a, S: Simd> {
    /// The model.
    pub shape: &'a Shape<Wide<S>>,
    /// Forcing angle at the start.
    pub angle: Angle<S>,
    /// Velocity of the mass when the progression begins.
    pub y: Wide<S>,
    /// Displacement of the slider's top when the progression begins.
    pub q: Wide<S>,
    /// Drift velocity when the progression begins.
    pub drift_rate: Wide<S>,
    /// Velocity of the slider's top when the progression begins.
    pub closing: Wide<S>,
}

/// A progression at some time.
#[derive(Clone, Copy)]
pub struct Sliding<S: Simd> {
    /// w and its first three derivatives.
    w: [Wide<S>; 4],
    /// Velocity of the slider's top.
    lag: Wide<S>,
    y: Wide<S>,
    q: Wide<S>,
    /// The rate of the velocity of the mass.
    y_rate: Wide<S>,
    /// The force's first two derivatives.
    force: [Wide<S>; 2],
    drift: Wide<S>,
    /// The largest terms of w.
    terms: Wide<S>,
}

/// A progression as strobes show it.
pub struct SlipStrobe<S: Simd> {
    /// Displacement of the slider's top, velocity of the mass, drift since the start, drift
    /// velocity.
    pub values: [Wide<S>; 4],
    /// The rates of those four.
    pub rates: [Wide<S>; 4],
    /// Velocity of the slider's top.
    pub lag: Wide<S>,
    /// The largest term of the drift velocity.
    pub terms: Wide<S>,
}

/// The slider's bottom stops.
pub struct Stop<S: Simd> {
    /// The time of the end: that of an evaluation, and the step from there to the root.
    pub elapsed: (Wide<S>, Wide<S>),
    /// Velocity of the mass, and of the slider's top.
    pub y: Wide<S>,
    /// Drift since the start.
    pub drift: Wide<S>,
    /// The lanes in which the event and all these values are proved.
    pub proved: Mask<S>,
}

impl<S: Simd> LanePhase<S> for Slip<'_, S> {
    type At = Sliding<S>;

    #[inline(always)]
    fn at(&self, d: Wide<S>) -> Sliding<S> {
        let Shape { b, rate, two_xi, .. } = *self.shape;
        let Self { y, q, drift_rate, closing, .. } = *self;
        let harmonic = self.angle.after(self.shape, d);
        let decay = shrink(rate * d);
        let begin = [y, q, drift_rate, closing];
        let slipping = Slipping::new([b, rate, two_xi], begin, d, &harmonic, &decay);
        let Slipped { q, w, drift, terms } =
            slipping.late_state().or_where(decay.exp.above(0.5), slipping.early_state());
        let Slipping { y, lag, bends: [slope, bend, third], push_terms, .. } = slipping;
        let [force, first, second] = harmonic.force;
        Sliding {
            w: [w, slope, bend, third],
            lag,
            y,
            q,
            y_rate: force + (b - 1.0),
            force: [first, second],
            drift,
            terms: terms + push_terms,
        }
    }

    #[inline(always)]
    fn excess(&self, at: &Sliding<S>) -> [Wide<S>; 4] {
        at.w
    }

    #[inline(always)]
    fn later_orders(&self, at: &Sliding<S>) -> [Wide<S>; LATER_ORDERS] {
        let Shape { omega2, rate, .. } = *self.shape;
        let mut higher = PushedOrders::new([omega2, rate], at.lag, at.force);
        [(); LATER_ORDERS].map(|()| higher.step())
    }

    #[inline(always)]
    fn is_short(&self, _: Wide<S>, step: Wide<S>) -> Mask<S> {
        let Shape { pace, rate, .. } = *self.shape;
        (step.magnitude() * pace.larger(rate)).below(REACH)
    }
}

impl<S: Simd> Slip<'_, S> {
    /// The stop of the slider's bottom.
    #[inline(always)]
    pub fn stop(&self) -> Stop<S> {
        let Shape { a, b, omega, rate, .. } = *self.shape;
        let (guess, guessed) = self.slow_envelope().first_root();
        let LaneRoot { at, elapsed, series, step, slope, found } = find(self, guess, guessed);
        let lag = at.lag + at.lag * short_decay(rate * step);
        let drift = at.drift + series.integral(step);
        let begin = [self.closing, self.drift_rate];
        let certified = stops_once([a, b, omega, rate], begin, lag);
        let proved = found & certified & slope.below(0.0);
        Stop { elapsed: (elapsed, step), y: lag, drift, proved }
    }

    /// The progressions at some time.
    #[inline(always)]
    pub fn state(&self, d: Wide<S>) -> SlipStrobe<S> {
        let Sliding { w, lag, y, q, y_rate, drift, terms, .. } = self.at(d);
        SlipStrobe { values: [q, y, drift, w[0]], rates: [lag, y_rate, w[0], w[1]], lag, terms }
    }

    #[inline(always)]
    fn slow_envelope(&self) -> LaneEnvelope<'_, S> {
        let Shape { a_over_omega, b, guess_step_decay, .. } = *self.shape;
        let Angle { sin, cos, .. } = self.angle;
        let zero = b.broadcast(0.0);
        LaneEnvelope {
            shape: self.shape,
            offset: a_over_omega.times_plus(sin, -self.y),
            slope: -b + 1.0,
            curvature: zero,
            amplitude: a_over_omega,
            sin: -cos,
            cos: sin,
            exponential: -self.closing,
            first: guess_step_decay.is(0.0).choose(-self.y, -self.drift_rate),
        }
    }
}

impl<S: Simd> Slipped<Wide<S>> {
    /// These values, or those of another progression where the mask holds.
    #[inline(always)]
    fn or_where(self, mask: Mask<S>, other: Self) -> Self {
        Self {
            q: mask.choose(other.q, self.q),
            w: mask.choose(other.w, self.w),
            drift: mask.choose(other.drift, self.drift),
            terms: mask.choose(other.terms, self.terms),
        }
    }
}
