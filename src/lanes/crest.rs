//! An upper bound of a flight's guard, and what its tangents prove ([`super::flight`]).

use super::flight::Flight;
use super::harmonic::Angle;
use super::shape::Shape;
use super::wide::{Mask, Wide};
use pulp::Simd;
use std::f64::consts::TAU;

/// A concave function at one place.
pub struct Tangent<S: Simd> {
    /// Where.
    pub from: Wide<S>,
    /// Value there.
    pub value: Wide<S>,
    /// Slope there.
    pub slope: Wide<S>,
}

impl<S: Simd> Tangent<S> {
    /// Whether the function is negative up to a place further on, by the tangents at both.
    #[inline(always)]
    pub fn stays_below_to(&self, end: &Self) -> Mask<S> {
        let zero = self.value.same(0.0);
        let width = end.from - self.from;
        let peaks = self.slope.above(0.0) & end.slope.below(0.0);
        let drop = end.slope.times_from(width, end.value) - self.value;
        let share = drop / (self.slope - end.slope);
        let peak = peaks.choose(self.slope.times_plus(share, self.value), self.value);
        self.value.less(zero) & end.value.less(zero) & peak.less(zero)
    }
}

/// E: the flight without its exponential, and with the tangent of that at the root.
pub struct Bound<S: Simd> {
    offset: Wide<S>,
    slope: Wide<S>,
    curvature: Wide<S>,
    amplitude: Wide<S>,
    speed: Wide<S>,
}

impl<S: Simd> Bound<S> {
    /// The bound, raised by what its terms may round off.
    #[inline(always)]
    pub fn new(flight: &Flight<'_, S>, root: Wide<S>, q: Wide<S>) -> Self {
        const ROOM: f64 = 16.0 * f64::EPSILON;
        let Shape { b, rate, a_over_omega, a_over_omega2, .. } = *flight.shape;
        let spring = q * rate;
        let Angle { sin, cos, .. } = flight.angle;
        let slope = a_over_omega.times_from(sin, flight.y) + spring;
        let offset = a_over_omega2.times_plus(cos, flight.q) - spring.times_plus(root, q);
        let speeds = flight.y.abs() + a_over_omega + b.abs() * root + spring;
        let terms = flight.q + a_over_omega2 * TAU + q + speeds * root;
        Self {
            offset: offset + terms * ROOM,
            slope,
            curvature: b,
            amplitude: a_over_omega2,
            speed: a_over_omega,
        }
    }

    /// Value and slope where the forcing angle has this sine and cosine.
    #[inline(always)]
    pub fn at(&self, d: Wide<S>, sin: Wide<S>, cos: Wide<S>) -> (Wide<S>, Wide<S>) {
        let Self { offset, slope, curvature, amplitude, speed } = *self;
        let parabola = d.times_plus(d.times_plus(curvature * 0.5, slope), offset);
        let rise = curvature.times_plus(d, slope);
        (amplitude.times_from(cos, parabola), speed.times_plus(sin, rise))
    }
}
