//! The external force a cos(omega tau + phi) + b and its integrals over elapsed time.

use crate::flow::constants::Constants;
use crate::numeric::number::Number;
use crate::numeric::real::Real;
use crate::numeric::remainders::{Circular, circular_of};
use std::f64::consts::TAU;

/// The forcing angle `omega tau + phi` when the phase begins.
#[derive(Clone, Copy, Debug)]
pub struct EntryAngle<T> {
    /// omega tau0 + phi within `[0, 2 pi)`, rounded: certificates find the force's changes of sign
    /// by it. The motion itself is computed from its sine and cosine.
    pub radians: T,
    /// sin(omega tau0 + phi)
    pub sin: T,
    /// cos(omega tau0 + phi)
    pub cos: T,
}

/// The harmonic force over an elapsed time d, by its remainders.
#[derive(Clone, Copy, Debug)]
pub struct Harmonic<T> {
    /// a cos(omega tau + phi) and its first two derivatives.
    pub force: [T; 3],
    /// The forcing's integral from 0 to d: (a/omega) (sin(omega tau + phi) - sin(omega tau0 +
    /// phi)).
    pub impulse: T,
    /// The forcing's second integral: -(a/omega^2) (cos(omega tau + phi) - cos(omega tau0 + phi) +
    /// omega d sin(omega tau0 + phi)).
    pub displacement: T,
    /// An upper bound of the terms that made `displacement`.
    pub displacement_terms: T,
    /// An upper bound of the terms that made `impulse`.
    pub impulse_terms: T,
    /// The remainders themselves.
    pub turn: Circular<T>,
}

impl<T: Number> EntryAngle<T> {
    /// The harmonic force and its integrals after `d` (Eqs. 14, 18, 20, without cancellation).
    #[inline(always)]
    pub fn harmonic(&self, constants: &Constants<T>, d: T) -> Harmonic<T> {
        let Constants { a, omega, a_over_omega, a_over_omega2, .. } = *constants;
        let angle = omega * d;
        let turn = circular_of(angle, omega.product_error(d));
        self.turned(&Drive { a, omega, a_over_omega, a_over_omega2 }, turn)
    }
}

/// What the harmonic force needs of the parameters.
pub struct Drive<T> {
    /// a
    pub a: T,
    /// omega
    pub omega: T,
    /// a/omega
    pub a_over_omega: T,
    /// a/omega^2
    pub a_over_omega2: T,
}

impl<T: Real> EntryAngle<T> {
    /// The harmonic force and its integrals when the forcing has turned so far.
    #[inline(always)]
    pub fn turned(&self, drive: &Drive<T>, turn: Circular<T>) -> Harmonic<T> {
        let Drive { a, omega, a_over_omega, a_over_omega2 } = *drive;
        let Circular { sin, cos_minus_1, sin_minus_x } = turn;
        let fallen = self.sin.times_from(sin, self.cos * cos_minus_1);
        let risen = self.cos.times_plus(sin, self.sin * cos_minus_1);
        let (cosine, sine) = (self.cos + fallen, self.sin + risen);
        let sunk = self.sin.times_from(sin_minus_x, self.cos * cos_minus_1);
        Harmonic {
            force: [a * cosine, -(a * omega * sine), -(a * omega * omega * cosine)],
            impulse: a_over_omega * risen,
            displacement: -(a_over_omega2 * sunk),
            displacement_terms: a_over_omega2 * (sin_minus_x.magnitude() - cos_minus_1),
            impulse_terms: a_over_omega * (sin.magnitude() - cos_minus_1),
            turn,
        }
    }
}

impl EntryAngle<f64> {
    /// The forcing angle a time `elapsed` later, where the harmonic force and its rate are these,
    /// for guesses: a times its sine and cosine are good to some roundings of the force.
    #[inline]
    pub(crate) fn roughly_after(
        &self,
        constants: &Constants<f64>,
        elapsed: f64,
        force: &[f64; 3],
    ) -> Self {
        let Constants { omega, per_a, per_omega, .. } = *constants;
        let radians = self.radians + omega * elapsed;
        let turns = (radians * (1.0 / TAU)) as i64 as f64;
        Self {
            radians: radians - turns * TAU,
            sin: -(force[1] * (per_a * per_omega)),
            cos: force[0] * per_a,
        }
    }
}
