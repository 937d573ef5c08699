//! An upper bound of a flight's guard, and what its tangents prove ([`super::flight`]).

use super::wide::{Mask, Wide};
use crate::numeric::real::Real;
use pulp::Simd;

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
    /// Its constant.
    pub offset: Wide<S>,
    /// The rate of its linear part.
    pub slope: Wide<S>,
    /// The second derivative of its parabola.
    pub curvature: Wide<S>,
    /// What the cosine of the forcing angle is taken from it with.
    pub amplitude: Wide<S>,
    /// The amplitude times the forcing frequency.
    pub speed: Wide<S>,
}

impl<S: Simd> Bound<S> {
    /// Value and slope where the forcing angle has this sine and cosine.
    #[inline(always)]
    pub fn at(&self, d: Wide<S>, sin: Wide<S>, cos: Wide<S>) -> (Wide<S>, Wide<S>) {
        let Self { offset, slope, curvature, amplitude, speed } = *self;
        let parabola = d.times_plus(d.times_plus(curvature * 0.5, slope), offset);
        let rise = curvature.times_plus(d, slope);
        (amplitude.times_from(cos, parabola), speed.times_plus(sin, rise))
    }
}
