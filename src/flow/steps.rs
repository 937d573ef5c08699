//! Steps of fixed length, whose sine, cosine and exponential belong to the model.
//!
//! By such steps the motion is followed from any evaluation to places around it, for guesses and
//! for certificates, without a library function.

use crate::flow::damped::Damping;
use crate::flow::forcing::Steady;
use crate::numeric::remainders::{Circular, circular};
use crate::parameters::Parameters;
use std::f64::consts::{PI, TAU};

/// A step of fixed length outside contact.
#[derive(Clone, Copy, Debug)]
pub struct FreeStep {
    /// Length of the step.
    pub length: f64,
    /// Sine of x = omega times the length.
    pub sin: f64,
    /// Cosine of x.
    pub cos: f64,
    /// exp(-rate length)
    pub decay: f64,
    /// sin x/omega: what a harmonic adds to its integral.
    pub speed: f64,
    /// (1 - cos x)/omega: what the harmonic a quarter period away adds to that integral.
    pub sag: f64,
    /// (1 - cos x)/omega^2: what a harmonic adds to its second integral.
    pub fall: f64,
    /// (x - sin x)/omega^2: what the harmonic a quarter period away adds to that integral.
    pub drop: f64,
}

impl FreeStep {
    fn new(length: f64, omega: f64, rate: f64) -> Self {
        let Circular { sin, cos_minus_1, sin_minus_x } = circular(omega * length);
        let omega2 = omega * omega;
        Self {
            length,
            sin,
            cos: 1.0 + cos_minus_1,
            decay: libm::exp(-rate * length),
            speed: sin / omega,
            sag: -cos_minus_1 / omega,
            fall: -cos_minus_1 / omega2,
            drop: -sin_minus_x / omega2,
        }
    }

    /// The step of the same length backwards in time.
    #[inline]
    #[must_use]
    pub fn reversed(&self) -> Self {
        let Self { length, sin, decay, speed, drop, .. } = *self;
        let growth = if decay > f64::MIN_POSITIVE { 1.0 / decay } else { f64::MAX };
        Self { length: -length, sin: -sin, decay: growth, speed: -speed, drop: -drop, ..*self }
    }
}

/// A step of fixed length in contact.
#[derive(Clone, Copy, Debug)]
pub struct ContactStep<T> {
    /// Length of the step.
    pub length: T,
    /// Sine of omega times the length.
    pub sin: T,
    /// Cosine of omega times the length.
    pub cos: T,
    /// C of the free oscillation ([`crate::flow::damped`]).
    pub c: T,
    /// S of the free oscillation.
    pub s: T,
    /// S' of the free oscillation.
    pub s_rate: T,
}

impl ContactStep<f64> {
    /// A step of this length.
    pub fn new(length: f64, omega: f64, damping: &Damping<f64>) -> Self {
        let (sin, cos) = libm::sincos(omega * length);
        let free = damping.at(length);
        let (c, s_rate) = (1.0 + free.c_minus_1, 1.0 + free.s_rate_minus_1);
        Self { length, sin, cos, c, s: free.s, s_rate }
    }
}

/// The forcing angles at which the force changes its sign: it is negative from this forcing angle
/// to 2 pi less it.
#[derive(Clone, Copy, Debug)]
pub struct Turning {
    /// t within `[0, pi]`, cos t = -b/a; pi if the force is never negative, 0 if it is never
    /// positive.
    pub angle: f64,
    /// sin t
    pub sin: f64,
    /// cos t
    pub cos: f64,
    /// How long the force is negative in a period.
    pub length: f64,
    /// The forcing period.
    pub period: f64,
}

impl Turning {
    fn new(parameters: &Parameters) -> Self {
        let Parameters { a, b, omega, .. } = *parameters;
        // Without harmonic the quotient is infinite, or no number where there is no force at all.
        let cos = (-b / a).clamp(-1.0, 1.0);
        let cos = if cos.is_nan() { -1.0 } else { cos };
        let angle = libm::acos(cos);
        let length = 2.0 * (PI - angle) / omega;
        Self { angle, sin: libm::sin(angle), cos, length, period: TAU / omega }
    }

    /// The forcing angle up to which the force is negative from `radians` on, within `[0, 2 pi)`;
    /// none if it is not negative there.
    #[inline]
    #[must_use]
    pub fn negative_until(&self, radians: f64) -> Option<f64> {
        let end = TAU - self.angle;
        (radians >= self.angle && radians < end).then_some(end)
    }
}

/// The length of a certificate's pieces, measured against the faster of forcing and free
/// oscillation, radians: the interpolant's error is 2^8/2822400 = 1e-4 of the amplitude.
pub const PIECE_RADIANS: f64 = 2.0;

/// The length of a guess's steps: the cubic between two places errs by 0.5^4/384 = 2e-4 of the
/// amplitude.
const GUESS_STEP_RADIANS: f64 = 0.5;

/// The longest step of a contact's guess: the free oscillation sets it, unless the forced one is so
/// strong and so fast that the cubic between two places would err by more than a thousandth of the
/// corridor.
fn contact_guess_step(parameters: &Parameters) -> f64 {
    /// The largest error of the cubic between two places, beside the corridor.
    const GUESS_TOLERANCE: f64 = 1e-3;
    let Parameters { a, xi, omega, .. } = *parameters;
    let amplitude = Steady::new(a, xi, omega).amplitude;
    GUESS_STEP_RADIANS.min((384.0 * GUESS_TOLERANCE / amplitude).sqrt().sqrt() / omega)
}

/// Decay times up to which an exponential that pulls the guard inwards stays in one piece: its
/// eighth derivative helps, and at twelve its third derivative begins to lift the coefficients.
pub const MAX_PULLING_DECAY_TIMES: f64 = 10.0;

/// Decay times after which a flight has got off the surface for certain, where its spring was
/// stronger than any force ([`MIN_SLIDER_RETURN`]).
pub const SEPARATION_DECAY_TIMES: f64 = 2.0;

/// The share of q0 z^2/2 to which the slider's return q0 (exp(-z) - 1 + z) comes at z =
/// [`SEPARATION_DECAY_TIMES`]; before it is larger, because the quotient of the two only falls.
pub const MIN_SLIDER_RETURN: f64 = 0.5676;

/// Factor on the largest force, by which a flight is shown to sink away from the slider. The
/// solver bounds the force by its amplitudes, so that this margin costs no proof; lanes have a
/// smaller one ([`LANE_FORCE_MARGIN`](crate::crossing::allowances::LANE_FORCE_MARGIN)).
pub const FORCE_FACTOR: f64 = 1.0 + 1e-9;

/// Decay times up to which an exponential that pushes the guard outwards stays in one piece:
/// its eighth derivative then costs 0.02 of its own size.
pub const MAX_PUSHING_DECAY_TIMES: f64 = 4.0;

/// The steps of a model.
#[derive(Clone, Copy, Debug)]
pub struct Steps {
    /// The step from piece to piece of a certificate.
    pub piece: FreeStep,
    /// The step over the life of an exponential that pulls inwards.
    pub pulling: FreeStep,
    /// The step until a flight has got off the surface.
    pub separation_interval: FreeStep,
    /// The step over the life of an exponential that pushes outwards.
    pub pushing: FreeStep,
    /// The step from place to place of a guess.
    pub guess_step: FreeStep,
    /// The step from piece to piece of a contact's certificate.
    pub contact_piece: ContactStep<f64>,
    /// The step of a contact's guess while a fast part lives, above critical damping.
    pub quick_guess_step: ContactStep<f64>,
    /// The step from place to place of a contact's guess.
    pub contact_guess_step: ContactStep<f64>,
    /// The step of a contact's guess above critical damping, when the fast part has died out.
    pub slow_guess_step: ContactStep<f64>,
    /// The forcing angles at which the force changes its sign.
    pub turning: Turning,
}

impl Steps {
    /// The steps of a model with these parameters.
    #[must_use]
    pub fn new(parameters: &Parameters) -> Self {
        let Parameters { omega, xi, .. } = *parameters;
        let rate = 0.5 / xi;
        let damping = &Damping::new(xi);
        let free_step = |length: f64| FreeStep::new(length, omega, rate);
        let fastest = omega.max(1.0);
        let (slowest, quickest) = match damping {
            Damping::Over { slow, fast, .. } => (slow.max(omega).min(1.0), *fast),
            _ => (1.0, 1.0),
        };
        Self {
            piece: free_step(PIECE_RADIANS / omega),
            pulling: free_step(0.9 * MAX_PULLING_DECAY_TIMES / rate),
            separation_interval: free_step(SEPARATION_DECAY_TIMES / rate),
            pushing: free_step(0.9 * MAX_PUSHING_DECAY_TIMES / rate),
            guess_step: free_step(GUESS_STEP_RADIANS / omega),
            contact_piece: ContactStep::new(PIECE_RADIANS / fastest, omega, damping),
            quick_guess_step: ContactStep::new(GUESS_STEP_RADIANS / quickest, omega, damping),
            contact_guess_step: ContactStep::new(contact_guess_step(parameters), omega, damping),
            slow_guess_step: ContactStep::new(GUESS_STEP_RADIANS / slowest, omega, damping),
            turning: Turning::new(parameters),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::remainders::decay;

    #[test]
    fn the_grip_is_least_at_parting() {
        let share = |z: f64| decay(z).remainder / (0.5 * z * z);
        let shares: Vec<f64> =
            (1..=1000).map(|k| share(SEPARATION_DECAY_TIMES * f64::from(k) / 1000.0)).collect();
        assert!(shares.windows(2).all(|pair| pair[1] < pair[0]));
        assert!(shares[999] > MIN_SLIDER_RETURN && shares[999] - MIN_SLIDER_RETURN < 1e-4);
    }
}
