//! What the lanes need of a model in contact.

use super::shape::Shape;
use super::wide::Wide;
use crate::crossing::allowances::STEP_ROUNDINGS;
use crate::flow::constants::Constants;
use crate::flow::damped::Damping;
use crate::flow::forcing::Forced;
use crate::flow::steps::{ContactStep, PIECE_RADIANS};
use pulp::Simd;

/// Which closed forms the contacts of a vector have: what no lane needs is not asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Forms {
    /// All lanes are below 0.7 of critical damping and away from resonance.
    Usual,
    /// Each lane has its own forms.
    Any,
}

impl Forms {
    /// The closed forms that these models need.
    #[inline(always)]
    pub fn new<S: Simd>(shape: &Shape<Wide<S>>) -> Self {
        if shape.unusual.above(0.0).any() { Self::Any } else { Self::Usual }
    }
}

/// A step of a guess, radians of the faster of forcing and free oscillation: the cubic between two
/// places errs by 0.8^4/384 = 1.1e-3 of the amplitude, which the series corrects.
const GUESS_STEP_RADIANS: f64 = 0.8;

/// The first step is at least this much of all others: each doubling doubles what it has rounded
/// off.
const MIN_FIRST_STEP_SHARE: f64 = 1.0 / 256.0;

/// The steps of a contact.
struct ContactPace {
    /// The rate that measures a step.
    full: f64,
    /// The first step, as a part of the others.
    early: f64,
}

impl ContactPace {
    fn new(omega: f64, damping: &Damping<f64>) -> Self {
        let Damping::Over { fast, slow, .. } = *damping else {
            return Self { full: omega.max(1.0), early: 1.0 };
        };
        let full = omega.max(slow).max(fast * MIN_FIRST_STEP_SHARE);
        let mut early = 1.0;
        while early * fast > full {
            early *= 0.5;
        }
        Self { full, early }
    }
}

/// A step in contact, with both exponentials of the free part clearly above critical damping.
fn contact_step(length: f64, omega: f64, damping: &Damping<f64>) -> ContactStep<f64> {
    let Damping::Over { fast, slow, .. } = *damping else {
        return ContactStep::new(length, omega, damping);
    };
    let (sin, cos) = libm::sincos(omega * length);
    let [c, s_rate] = [libm::exp(-slow * length), libm::exp(-fast * length)];
    ContactStep { length, sin, cos, c, s: 0.0, s_rate }
}

impl Shape<f64> {
    /// The constants of contacts.
    pub(super) fn of_contact(constants: &Constants<f64>) -> Self {
        let Constants { a, b, omega, damping, steady, forced_eighth, .. } = *constants;
        let pace = ContactPace::new(omega, &damping);
        let step = |radians: f64| contact_step(radians / pace.full, omega, &damping);
        let full = [GUESS_STEP_RADIANS, PIECE_RADIANS].map(step);
        let first = [GUESS_STEP_RADIANS * pace.early, PIECE_RADIANS * pace.early];
        let early = if pace.early < 1.0 { first.map(step) } else { full };
        let ([contact_guess_step, piece], [early_contact_guess_step, early_piece]) = (full, early);
        // Clearly above critical damping the exponentials come from the whole force at the start,
        // and after n doublings the steps have lost less than 2^(n + 2) eps.
        let (roundings, pulls) = match damping {
            Damping::Over { .. } => (STEP_ROUNDINGS + 4.0 / pace.early, b.abs() + a),
            _ => (STEP_ROUNDINGS, b.abs()),
        };
        Self {
            steady: steady.orders([1.0, 0.0, 0.0])[0],
            steady_rate: steady.orders([0.0, 1.0, 0.0])[0],
            forced_eighth,
            contact_guess_step: contact_guess_step.length,
            contact_guess_step_sin: contact_guess_step.sin,
            contact_guess_step_cos: contact_guess_step.cos,
            contact_guess_step_c: contact_guess_step.c,
            contact_guess_step_s: contact_guess_step.s,
            contact_guess_step_s_rate: contact_guess_step.s_rate,
            piece: piece.length,
            piece_sin: piece.sin,
            piece_cos: piece.cos,
            piece_c: piece.c,
            piece_s: piece.s,
            piece_s_rate: piece.s_rate,
            early: pace.early,
            early_contact_guess_step_sin: early_contact_guess_step.sin,
            early_contact_guess_step_cos: early_contact_guess_step.cos,
            early_contact_guess_step_c: early_contact_guess_step.c,
            early_contact_guess_step_s_rate: early_contact_guess_step.s_rate,
            early_piece_sin: early_piece.sin,
            early_piece_cos: early_piece.cos,
            early_piece_c: early_piece.c,
            early_piece_s_rate: early_piece.s_rate,
            roundings,
            pulls,
            ..Self::of_forced(&constants.forced, Self::of_free(&damping, omega.max(1.0)))
        }
    }

    /// What the free oscillation needs.
    fn of_free(damping: &Damping<f64>, pace: f64) -> Self {
        let free = Self { quickest: pace, ..Self::default() };
        let strong = Self { unusual: 1.0, ..free };
        match *damping {
            Damping::Under { nu, nu_low, .. } => Self { nu, nu_low, per_nu: 1.0 / nu, ..free },
            Damping::NearCritical { xi, discriminant } => {
                let root = discriminant.abs().sqrt();
                let quickest = pace.max(2.0 * xi);
                let near = Self { near_critical: 1.0, discriminant, quickest, ..strong };
                if discriminant > 0.0 {
                    Self { nu: root, per_nu: 1.0 / root, ..near }
                } else {
                    Self { spread: root + root, lasting: 1.0 / (xi + root), ..near }
                }
            }
            Damping::Over { fast, slow, spread } => Self {
                spread,
                lasting: slow,
                fast,
                fast8: eighth_power(fast),
                lasting8: eighth_power(slow),
                quickest: pace.max(fast),
                ..strong
            },
        }
    }

    /// What the forced oscillation needs.
    fn of_forced(forced: &Forced<f64>, free: Self) -> Self {
        match *forced {
            Forced::Plain { inverse, .. } => {
                Self { response: inverse.re, response_im: inverse.im, ..free }
            }
            Forced::Resonant { half_over_nu, delta, near_pole, in_step, far_pole, .. } => Self {
                unusual: 1.0,
                half_over_nu,
                delta,
                near_pole: near_pole.re,
                near_pole_im: near_pole.im,
                in_step,
                far_pole: far_pole.re,
                far_pole_im: far_pole.im,
                ..free
            },
        }
    }
}

fn eighth_power(x: f64) -> f64 {
    let square = x * x;
    let fourth = square * square;
    fourth * fourth
}
