//! The external force over an elapsed time ([`crate::flow::forcing`]).

use super::functions::{Turn, polynomial, sin_cos, turn_of};
use super::shape::Shape;
use super::wide::Wide;
use super::words::Words;
use pulp::Simd;

/// The forcing angle when a phase begins.
#[derive(Clone, Copy)]
pub struct Angle<S: Simd> {
    /// omega tau0 + phi within `[0, 2 pi)`, rounded.
    pub value: Wide<S>,
    /// Sine of the forcing angle.
    pub sin: Wide<S>,
    /// Cosine of the forcing angle.
    pub cos: Wide<S>,
}

/// The harmonic force after some time.
#[derive(Clone, Copy)]
pub struct Harmonic<S: Simd> {
    /// a cos(omega tau + phi) and its first two derivatives.
    pub force: [Wide<S>; 3],
    /// The integral of the force.
    pub impulse: Wide<S>,
    /// The second integral of the force.
    pub displacement: Wide<S>,
    /// Circular functions of omega d.
    pub turn: Turn<S>,
}

impl<S: Simd> Angle<S> {
    /// The forcing angle that follows from omega tau0.
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

/// The harmonic force after a short step, and what it has done to the velocity
/// ([`crate::crossing::series`]).
pub struct Push<S: Simd> {
    /// The force less b with its first two derivatives.
    pub force: [Wide<S>; 3],
    /// The integral of the force over the step.
    pub impulse: Wide<S>,
}

impl<S: Simd> Push<S> {
    /// The push over a `step` from an evaluation, from the force less b and its rate there.
    #[inline(always)]
    pub fn new(shape: &Shape<Wide<S>>, [u, v]: [Wide<S>; 2], step: Wide<S>) -> Self {
        let omega2 = shape.omega2;
        let square = omega2 * step * step;
        let time = step * polynomial(square, [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0]);
        let area =
            step * step * polynomial(square, [0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40320.0]);
        // u'' = -omega^2 u
        let force = time.times_plus(v, (omega2 * area).times_from(u, u));
        let rate = (omega2 * time).times_from(u, (omega2 * area).times_from(v, v));
        let impulse = time.times_plus(u, area * v);
        Self { force: [force, rate, -(omega2 * force)], impulse }
    }
}

/// exp(-z) - 1 of a short z, of either sign.
#[inline(always)]
pub fn short_decay<S: Simd>(z: Wide<S>) -> Wide<S> {
    let square = z * z;
    let even = polynomial(square, [0.5, 1.0 / 24.0, 1.0 / 720.0, 1.0 / 40320.0]);
    let odd = polynomial(square, [1.0 / 6.0, 1.0 / 120.0, 1.0 / 5040.0]);
    square.times_plus(z.times_from(odd, even), -z)
}
