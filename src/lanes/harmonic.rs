//! The external force over an elapsed time ([`crate::flow::forcing`]).

use super::functions::{Turn, sin_cos, turn_of};
use super::shape::Shape;
use super::wide::Wide;
use super::words::Words;
use pulp::Simd;

/// The forcing angle when a phase begins.
#[derive(Clone, Copy)]
pub struct Angle<S: Simd> {
    /// omega tau0 + phi within `[0, 2 pi)`, rounded.
    pub value: Wide<S>,
    /// Its sine.
    pub sin: Wide<S>,
    /// And cosine.
    pub cos: Wide<S>,
}

/// The harmonic force after some time.
#[derive(Clone, Copy)]
pub struct Harmonic<S: Simd> {
    /// a cos(omega tau + phi) and its first two derivatives.
    pub force: [Wide<S>; 3],
    /// Its integral.
    pub impulse: Wide<S>,
    /// Its second integral.
    pub displacement: Wide<S>,
    /// Circular functions of omega d.
    pub turn: Turn<S>,
}

impl<S: Simd> Angle<S> {
    /// From omega tau0.
    #[inline(always)]
    pub fn new(shape: &Shape<Wide<S>>, angle: Words<S>) -> Self {
        let (_, angle) = angle.plus(Words { high: shape.phi, low: shape.phi_low }).wrapped();
        let (sine, cosine) = sin_cos(angle.high);
        let sin = angle.low.times_plus(cosine, sine);
        let cos = angle.low.times_from(sine, cosine);
        Self { value: angle.high, sin, cos }
    }

    /// The force less b and its first two derivatives at the beginning.
    #[inline(always)]
    pub fn force(&self, shape: &Shape<Wide<S>>) -> [Wide<S>; 3] {
        let Shape { a, omega, omega2, .. } = *shape;
        [a * self.cos, -(a * omega * self.sin), -(a * omega2 * self.cos)]
    }

    /// The force and its integrals after `d`.
    #[inline(always)]
    pub fn after(&self, shape: &Shape<Wide<S>>, d: Wide<S>) -> Harmonic<S> {
        let Shape { a, omega, omega2, a_over_omega, a_over_omega2, .. } = *shape;
        let turn = turn_of(omega, None, d);
        let Turn { sin, cos_minus_1, sin_minus_x } = turn;
        let fallen = self.sin.times_from(sin, self.cos * cos_minus_1);
        let risen = self.cos.times_plus(sin, self.sin * cos_minus_1);
        let (cosine, sine) = (self.cos + fallen, self.sin + risen);
        Harmonic {
            force: [a * cosine, -(a * omega * sine), -(a * omega2 * cosine)],
            impulse: a_over_omega * risen,
            displacement: -(a_over_omega2
                * self.sin.times_from(sin_minus_x, self.cos * cos_minus_1)),
            turn,
        }
    }
}

/// The force less b and its first two derivatives a short step later: what is left out is the fourth power
/// of omega times the step.
#[inline(always)]
pub fn shifted<S: Simd>(
    omega2: Wide<S>,
    [force, rate, bend]: [Wide<S>; 3],
    step: Wide<S>,
) -> [Wide<S>; 3] {
    let turn = -(omega2 * rate);
    let force = taylor(force, [rate, bend, turn], step);
    let rate = taylor(rate, [bend, turn, -(omega2 * bend)], step);
    [force, rate, -(omega2 * force)]
}

/// Three terms of a Taylor series.
#[inline(always)]
pub fn taylor<S: Simd>(value: Wide<S>, derivatives: [Wide<S>; 3], step: Wide<S>) -> Wide<S> {
    value + change(derivatives, step)
}

/// What they add.
#[inline(always)]
pub fn change<S: Simd>([first, second, third]: [Wide<S>; 3], step: Wide<S>) -> Wide<S> {
    let slope = step.times_plus(third * (1.0 / 6.0), second * 0.5);
    step * step.times_plus(slope, first)
}

/// exp(-z) - 1 of a short z, of either sign.
#[inline(always)]
pub fn short_decay<S: Simd>(z: Wide<S>) -> Wide<S> {
    super::functions::polynomial(z, [0.0, -1.0, 0.5, -1.0 / 6.0, 1.0 / 24.0, -1.0 / 120.0])
}
