//! What the lanes need of the parameters: of one model, and of as many as there are lanes.

use super::wide::{LaneValues, Wide};
use crate::crossing::allowances::NEGLIGIBLE_DECAY;
use crate::flow::constants::Constants;
use crate::flow::steps::Steps;
use crate::model::Model;
use pulp::Simd;

macro_rules! shape {
    ($($(#[$text:meta])* $name:ident,)*) => {
        /// Constants of the closed forms, in one arithmetic.
        #[derive(Clone, Copy, Debug, Default)]
        pub struct Shape<T> {
            $($(#[$text])* pub $name: T,)*
        }

        impl Shape<LaneValues> {
            /// Takes one lane's constants.
            pub fn set(&mut self, lane: usize, shape: &Shape<f64>) {
                $(self.$name[lane] = shape.$name;)*
            }

            /// Loads the constants of all lanes.
            #[inline(always)]
            pub fn load<S: Simd>(&self, simd: S) -> Shape<Wide<S>> {
                Shape { $($name: Wide::load(simd, &self.$name),)* }
            }
        }
    };
}

shape! {
    /// Amplitude of the harmonic force.
    a,
    /// Static force.
    b,
    /// Gap.
    g,
    /// Forcing frequency.
    omega,
    /// omega^2
    omega2,
    /// First word of the phase of the harmonic force, radians.
    phi,
    /// The second word of the phase.
    phi_low,
    /// a/omega
    a_over_omega,
    /// a/omega^2
    a_over_omega2,
    /// Damping ratio.
    xi,
    /// 2 xi
    two_xi,
    /// 1/(2 xi)
    rate,
    /// The faster of 1 and omega.
    pace,
    /// The forcing angle from which on the force is negative, up to 2 pi less this.
    turning,
    /// Sine of that forcing angle, whose cosine is -b/a.
    turning_sin,
    /// Cosine of that forcing angle.
    turning_cos,
    /// Sine of the angle halfway from there to pi.
    halfway_sin,
    /// Cosine of that angle.
    halfway_cos,
    /// Sine of omega times two decay times of the slider.
    settling_sin,
    /// Cosine of that angle.
    settling_cos,
    /// A step of a guess, outside contact.
    guess_step,
    /// Sine of omega times that.
    guess_step_sin,
    /// Cosine of omega times that.
    guess_step_cos,
    /// exp(-rate guess_step), zero if there is little left.
    guess_step_decay,
    /// Damped frequency; this and the next two are zero at and above critical damping.
    nu,
    /// What rounding took from the damped frequency.
    nu_low,
    /// 1/nu
    per_nu,
    /// Whether a model is near resonance or near critical damping or above: one there, zero
    /// elsewhere.
    unusual,
    /// Whether a model is near critical damping: one there, zero elsewhere.
    near_critical,
    /// 1 - xi^2 near critical damping, zero elsewhere.
    discriminant,
    /// The difference of the two rates above critical damping, zero elsewhere.
    spread,
    /// The smaller one of the two rates above critical damping, zero elsewhere.
    lasting,
    /// The larger rate clearly above critical damping, zero elsewhere.
    fast,
    /// The eighth power of the larger rate.
    fast8,
    /// The eighth power of the smaller rate.
    lasting8,
    /// The fastest rate of a contact.
    quickest,
    /// 1/(1 - omega^2 + 2 i xi omega), real part; zero near resonance.
    response,
    /// Imaginary part of 1/(1 - omega^2 + 2 i xi omega).
    response_im,
    /// 1/(2 nu) near resonance, zero elsewhere: which of the two forms serves.
    half_over_nu,
    /// omega - nu
    delta,
    /// 1/(xi + i delta), real part.
    near_pole,
    /// Imaginary part of 1/(xi + i delta).
    near_pole_im,
    /// The time after which forced and free oscillation are out of step.
    in_step,
    /// 1/(xi + i (omega + nu)), real part.
    far_pole,
    /// Imaginary part of 1/(xi + i (omega + nu)).
    far_pole_im,
    /// What the steady trial force takes of F - b.
    steady,
    /// What the steady trial force takes of F'.
    steady_rate,
    /// A bound of the eighth derivative of the forced trial force.
    forced_eighth,
    /// A step of a guess in contact.
    contact_guess_step,
    /// Sine of omega times that.
    contact_guess_step_sin,
    /// Cosine of omega times that.
    contact_guess_step_cos,
    /// C of the free oscillation after that step.
    contact_guess_step_c,
    /// S of the free oscillation after that step.
    contact_guess_step_s,
    /// S' of the free oscillation after that step.
    contact_guess_step_s_rate,
    /// A piece of a certificate in contact.
    piece,
    /// Sine of omega times that.
    piece_sin,
    /// Cosine of omega times that.
    piece_cos,
    /// C of the free oscillation after that piece.
    piece_c,
    /// S of the free oscillation after that piece.
    piece_s,
    /// S' of the free oscillation after that piece.
    piece_s_rate,
    /// What the first step and the first piece in contact are of all others: one but clearly above
    /// critical damping, where C, S and S' are the slow exponential, zero and the fast one.
    early,
    /// Sine of omega times the first step.
    early_contact_guess_step_sin,
    /// Cosine of omega times the first step.
    early_contact_guess_step_cos,
    /// C of the free oscillation after the first step.
    early_contact_guess_step_c,
    /// S' of the free oscillation after the first step.
    early_contact_guess_step_s_rate,
    /// Sine of omega times the first piece.
    early_piece_sin,
    /// Cosine of omega times the first piece.
    early_piece_cos,
    /// C of the free oscillation after the first piece.
    early_piece_c,
    /// S' of the free oscillation after the first piece.
    early_piece_s_rate,
    /// What the steps may round off, in eps of the parts' size.
    roundings,
    /// What counts with the parts' size there: |b|, and a as well clearly above critical damping.
    pulls,
}

/// A step of a guess outside contact, radians of the forcing: the cubic between two places errs by
/// 1/384 of the amplitude, which the series puts right.
const GUESS_STEP_RADIANS: f64 = 1.0;

impl Shape<f64> {
    /// The constants of a model; `None` without forcing or where the force never changes sign to
    /// positive, and where powers of the parameters come near the ends of the f64 range.
    pub fn new(model: &Model) -> Option<Self> {
        let Constants { a, b, g, xi, omega, omega2, two_xi, rate, .. } = *model.constants();
        let moderate = |x: f64, low: f64, high: f64| x >= low && x <= high;
        let suits = moderate(a, 1e-6, 1e6)
            && moderate(b, -a, 1e6)
            && moderate(g, 0.0, 1e6)
            && moderate(xi, 1e-6, 1e2)
            && moderate(omega, 1e-3, 1e3);
        if !suits {
            return None;
        }
        let Steps { turning, separation_interval: interval, .. } = *model.steps();
        let (halfway_sin, halfway_cos) = libm::sincos(0.5 * (turning.angle + std::f64::consts::PI));
        let (guess_step_sin, guess_step_cos) = libm::sincos(GUESS_STEP_RADIANS);
        let guess_step = GUESS_STEP_RADIANS / omega;
        let guess_step_decay = libm::exp(-rate * guess_step);
        let pace = omega.max(1.0);
        let phi = model.phi();
        Some(Self {
            a,
            b,
            g,
            omega,
            omega2,
            phi: phi.high,
            phi_low: phi.low,
            a_over_omega: a / omega,
            a_over_omega2: a / omega2,
            xi,
            two_xi,
            rate,
            pace,
            turning: turning.angle,
            turning_sin: turning.sin,
            turning_cos: turning.cos,
            halfway_sin,
            halfway_cos,
            settling_sin: interval.sin,
            settling_cos: interval.cos,
            guess_step,
            guess_step_sin,
            guess_step_cos,
            guess_step_decay: if guess_step_decay < NEGLIGIBLE_DECAY {
                0.0
            } else {
                guess_step_decay
            },
            ..Self::of_contact(model.constants())
        })
    }
}
