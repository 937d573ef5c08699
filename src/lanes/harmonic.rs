//! The external force over an elapsed time ([`crate::flow::forcing`]).

use super::functions::{sin_cos, turn_of};
use super::shape::Shape;
use super::wide::Wide;
use super::words::Words;
use crate::flow::forcing::{Drive, EntryAngle, Harmonic};
use crate::numeric::real::{Real, polynomial};
use pulp::Simd;

/// The forcing angle when a phase begins.
pub type Angle<S> = EntryAngle<Wide<S>>;

impl<S: Simd> Angle<S> {
    /// The forcing angle that follows from omega tau0.
    #[inline(always)]
    pub fn new(shape: &Shape<Wide<S>>, angle: Words<S>) -> Self {
        let (_, angle) = angle.plus(Words { high: shape.phi, low: shape.phi_low }).wrapped();
        let (sine, cosine) = sin_cos(angle.high);
        let sin = angle.low.times_plus(cosine, sine);
        let cos = angle.low.times_from(sine, cosine);
        Self { radians: angle.high, sin, cos }
    }

    /// The force less b and its first two derivatives at the beginning.
    #[inline(always)]
    pub fn force(&self, shape: &Shape<Wide<S>>) -> [Wide<S>; 3] {
        let Shape { a, omega, omega2, .. } = *shape;
        [a * self.cos, -(a * omega * self.sin), -(a * omega2 * self.cos)]
    }

    /// The force and its integrals after `d`.
    #[inline(always)]
    pub fn after(&self, shape: &Shape<Wide<S>>, d: Wide<S>) -> Harmonic<Wide<S>> {
        let Shape { a, omega, a_over_omega, a_over_omega2, .. } = *shape;
        let drive = Drive { a, omega, a_over_omega, a_over_omega2 };
        self.turned(&drive, turn_of(omega, None, d))
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
