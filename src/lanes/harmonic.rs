//! The external force over an elapsed time ([`crate::flow::forcing`]).

use super::functions::{sin_cos, turn_of};
use super::shape::Shape;
use super::wide::Wide;
use super::words::Words;
use crate::flow::forcing::{Drive, EntryAngle, Harmonic};
use crate::numeric::real::Real;
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
