//! Forced oscillation in contact ([`crate::flow::forced`]): divided by P, and near resonance as a
//! divided difference.

use super::complex::Complex;
use super::contact_shape::Forms;
use super::damped::Free;
use super::functions::{Turn, short_turn};
use super::shape::Shape;
use super::wide::Wide;
use pulp::Simd;

/// The response to exp(i omega d) from rest.
#[derive(Clone, Copy)]
pub struct Response<S: Simd> {
    /// Velocity.
    pub rate: Complex<S>,
    /// Trial force.
    pub force: Complex<S>,
    /// Displacement.
    pub displacement: Complex<S>,
}

impl<S: Simd> Response<S> {
    /// The forced oscillation after `d`; `turn` belongs to `omega d`, `free` to `d`.
    #[inline(always)]
    pub fn after(
        shape: &Shape<Wide<S>>,
        forms: Forms,
        d: Wide<S>,
        turn: &Turn<S>,
        free: &Free<S>,
    ) -> Self {
        let resonant = shape.half_over_nu.above(0.0);
        if forms == Forms::Usual || !resonant.any() {
            return Self::plain(shape, d, turn, free);
        }
        let near = Self::resonant(shape, d, turn, free);
        if !(!resonant).any() {
            return near;
        }
        let far = Self::plain(shape, d, turn, free);
        Self {
            rate: Complex::choose(resonant, near.rate, far.rate),
            force: Complex::choose(resonant, near.force, far.force),
            displacement: Complex::choose(resonant, near.displacement, far.displacement),
        }
    }

    #[inline(always)]
    fn plain(shape: &Shape<Wide<S>>, d: Wide<S>, turn: &Turn<S>, free: &Free<S>) -> Self {
        let Shape { two_xi, omega, response, response_im, .. } = *shape;
        let Turn { sin, cos_minus_1, sin_minus_x } = *turn;
        let Free { s, s_minus_d, c_minus_1, s_rate_minus_1, .. } = *free;
        let short = d.below(1.0);
        let sines =
            short.choose(omega.times_from(s_minus_d, sin_minus_x), omega.times_from(s, sin));
        let rate = Complex::new(omega.times_from(sin, s), omega * (cos_minus_1 - s_rate_minus_1));
        let force = Complex::new(
            (two_xi * omega).times_from(sin, cos_minus_1 - s_rate_minus_1),
            two_xi.times_plus(rate.im, sines),
        );
        let inverse = Complex::new(response, response_im);
        let displacement = Complex::new(cos_minus_1 - c_minus_1, sines) * inverse;
        Self { rate: rate * inverse, force: force * inverse, displacement }
    }

    #[inline(always)]
    fn resonant(shape: &Shape<Wide<S>>, d: Wide<S>, turn: &Turn<S>, free: &Free<S>) -> Self {
        let Shape { xi, two_xi, half_over_nu, .. } = *shape;
        let parts = Parts::after(shape, d, turn, free);
        // 1/(2 i nu) = -i/(2 nu)
        let Complex { re, im } = parts.difference.scale(half_over_nu);
        let displacement = Complex::new(im, -re);
        let rate = parts.sum.scale(xi.same(0.5)) - displacement.scale(xi);
        let force = Complex::new(
            two_xi.times_plus(rate.re, displacement.re),
            two_xi.times_plus(rate.im, displacement.im),
        );
        Self { rate, force, displacement }
    }
}

/// D+ and D- of the divided difference.
#[derive(Clone, Copy)]
struct Parts<S: Simd> {
    sum: Complex<S>,
    difference: Complex<S>,
}

impl<S: Simd> Parts<S> {
    #[inline(always)]
    fn after(shape: &Shape<Wide<S>>, d: Wide<S>, turn: &Turn<S>, free: &Free<S>) -> Self {
        // Neither in short times nor in step is delta d more than one.
        let beat = short_turn(shape.delta * d);
        let short = d.below(1.0);
        if !short.any() {
            return Self::long(shape, d, &beat, turn, free);
        }
        let early = Self::short(shape, d, &beat, turn, free);
        if !(!short).any() {
            return early;
        }
        let late = Self::long(shape, d, &beat, turn, free);
        Self {
            sum: Complex::choose(short, early.sum, late.sum),
            difference: Complex::choose(short, early.difference, late.difference),
        }
    }

    /// Takes the beat as long as the two oscillations are in step, and the two of them apart
    /// afterwards.
    #[inline(always)]
    fn long(
        shape: &Shape<Wide<S>>,
        d: Wide<S>,
        beat: &Turn<S>,
        turn: &Turn<S>,
        free: &Free<S>,
    ) -> Self {
        let damped = Complex::new(free.turn.cos_minus_1 + 1.0, free.turn.sin);
        let forcing = Complex::new(turn.cos_minus_1 + 1.0, turn.sin);
        let apart = forcing - damped.scale(free.shrink.exp);
        let together = damped * Complex::new(beat.cos_minus_1 - free.shrink.minus_1, beat.sin);
        let lag = Complex::choose(d.less(shape.in_step), together, apart);
        let slow = lag * Complex::new(shape.slow, shape.slow_im);
        let quick = (forcing - damped.conjugate().scale(free.shrink.exp))
            * Complex::new(shape.quick, shape.quick_im);
        Self { sum: slow + quick, difference: slow - quick }
    }

    /// D+ - d and D- - d, both of the order of d^2.
    #[inline(always)]
    fn short(
        shape: &Shape<Wide<S>>,
        d: Wide<S>,
        beat: &Turn<S>,
        turn: &Turn<S>,
        free: &Free<S>,
    ) -> Self {
        let Free { shrink, turn: Turn { sin, cos_minus_1, sin_minus_x }, .. } = *free;
        let beating = Complex::new(beat.cos_minus_1 - shrink.remainder, beat.sin_minus_x);
        let lag = beating * Complex::new(shape.slow, shape.slow_im);
        let slow = lag + Complex::new(cos_minus_1, sin) * Complex::new(d + lag.re, lag.im);
        let cosines = turn.cos_minus_1 - shrink.exp.times_plus(cos_minus_1, shrink.remainder);
        let sines = turn.sin_minus_x + shrink.minus_1.times_plus(sin, sin_minus_x);
        let quick = Complex::new(cosines, sines) * Complex::new(shape.quick, shape.quick_im);
        let sum = slow + quick;
        Self { sum: Complex::new(sum.re + (d + d), sum.im), difference: slow - quick }
    }
}
