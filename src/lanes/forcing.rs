//! What the external force does ([`crate::flow::forcing`]): its integrals, and the oscillation that
//! it drives in contact, divided by P, and near resonance as a divided difference, each only where
//! some lane needs it.

use super::contact_constants::Forms;
use super::functions::{short_turn, sin_cos, turn_of};
use super::shape::Shape;
use super::wide::Wide;
use super::words::Words;
use crate::flow::damped::Free;
use crate::flow::forcing::{Differences, Drive, EntryAngle, Harmonic, Response, Together};
use crate::numeric::complex::Complex;
use crate::numeric::real::Real;
use crate::numeric::remainders::Circular;
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

impl<S: Simd> Response<Wide<S>> {
    /// The forced oscillation after `d`; `turn` belongs to `omega d`, `free` to `d`.
    #[inline(always)]
    pub fn after(
        shape: &Shape<Wide<S>>,
        forms: Forms,
        d: Wide<S>,
        turn: &Circular<Wide<S>>,
        free: &Free<Wide<S>>,
    ) -> Self {
        let resonant = shape.half_over_nu.above(0.0);
        if forms == Forms::Usual || !resonant.any() {
            return Self::far_from_resonance(shape, d, turn, free);
        }
        let near = Self::near_resonance(shape, d, turn, free);
        if !(!resonant).any() {
            return near;
        }
        let far = Self::far_from_resonance(shape, d, turn, free);
        Self {
            rate: Complex::choose(resonant, near.rate, far.rate),
            force: Complex::choose(resonant, near.force, far.force),
            displacement: Complex::choose(resonant, near.displacement, far.displacement),
        }
    }

    #[inline(always)]
    fn far_from_resonance(
        shape: &Shape<Wide<S>>,
        d: Wide<S>,
        turn: &Circular<Wide<S>>,
        free: &Free<Wide<S>>,
    ) -> Self {
        let Shape { two_xi, omega, response, response_im, .. } = *shape;
        let sines = d.below(1.0).choose(
            omega.times_from(free.s_minus_d, turn.sin_minus_x),
            omega.times_from(free.s, turn.sin),
        );
        Self::plain_quotients(two_xi, omega, Complex::new(response, response_im), sines, turn, free)
    }

    #[inline(always)]
    fn near_resonance(
        shape: &Shape<Wide<S>>,
        d: Wide<S>,
        turn: &Circular<Wide<S>>,
        free: &Free<Wide<S>>,
    ) -> Self {
        let Shape { near_pole, near_pole_im, far_pole, far_pole_im, .. } = *shape;
        let inverses = [Complex::new(near_pole, near_pole_im), Complex::new(far_pole, far_pole_im)];
        let together = Together { turn, rotation: &free.rotation, inverses };
        // Neither in short times nor in step is delta d more than one.
        let beat = short_turn(shape.delta * d);
        let in_step = d.less(shape.in_step);
        let lag = Complex::choose(in_step, together.lag_by_beat(&beat), together.lag());
        let mut parts = together.in_long_times(lag);
        let short = d.below(1.0);
        if short.any() {
            let early = together.in_short_times(d, &beat);
            parts = Differences {
                sum: Complex::choose(short, early.sum, parts.sum),
                difference: Complex::choose(short, early.difference, parts.difference),
            };
        }
        parts.response(shape.xi, shape.half_over_nu)
    }
}
