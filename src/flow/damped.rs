//! Free oscillation in contact: x'' + 2 xi x' + x = 0 for every xi > 0.
//!
//! C and S are its solutions with C(0) = 1, C'(0) = 0 and S(0) = 0, S'(0) = 1. The paper's Eqs.
//! (15)-(17) have sqrt(1 - xi^2) in a denominator and exist below critical damping only; C and S
//! are entire functions of 1 - xi^2 and exist everywhere. C' = -S and S' = C - 2 xi S.

use crate::numeric::number::Number;
use crate::numeric::real::Real;
use crate::numeric::remainders::{Circular, Decay, circular_of, decay};

/// How the free oscillation is computed at this damping ratio.
#[derive(Clone, Copy, Debug)]
pub enum Damping<T> {
    /// xi < 1 and not near it: exp(-xi d) times a rotation.
    Under {
        /// Damping ratio.
        xi: T,
        /// Damped frequency sqrt(1 - xi^2)
        nu: T,
        /// What rounding took from nu.
        nu_low: T,
    },
    /// xi near 1: a series in m = (1 - xi^2) d^2 as long as that is small.
    NearCritical {
        /// Damping ratio.
        xi: T,
        /// (1 - xi)(1 + xi), of either sign.
        discriminant: T,
    },
    /// xi > 1 and not near it: two exponentials.
    Over {
        /// The larger rate, xi + sqrt(xi^2 - 1).
        fast: T,
        /// The smaller rate, 1/fast: as a difference it would lose its digits.
        slow: T,
        /// 2 sqrt(xi^2 - 1)
        spread: T,
    },
}

/// The fundamental solutions at one elapsed time.
#[derive(Clone, Copy, Debug)]
pub struct Free<T> {
    /// S
    pub s: T,
    /// S - d, without cancellation where d is short
    pub s_minus_d: T,
    /// C - 1
    pub c_minus_1: T,
    /// S' - 1
    pub s_rate_minus_1: T,
    /// exp(-fast d), the part that dies out first above critical damping; zero elsewhere.
    pub fast_exponential: T,
    /// The damped rotation (all zero near and above critical damping, where nothing reads it).
    pub rotation: Rotation<T>,
}

/// The factors of exp((-xi + i nu) d), from which resonance takes its divided difference.
#[derive(Clone, Copy, Debug)]
pub struct Rotation<T> {
    /// exp(-xi d) and its remainders
    pub shrink: Decay<T>,
    /// Sine and cosine of nu d and their remainders
    pub turn: Circular<T>,
}

/// The largest |1 - xi^2| at which the series may serve.
const MAX_SERIES_DISCRIMINANT: f64 = 0.5;

impl<T: Number> Damping<T> {
    /// Picks the form for this damping ratio.
    #[must_use]
    pub fn new(xi: T) -> Self {
        let discriminant = (T::one() - xi) * (T::one() + xi);
        if discriminant > T::exact(MAX_SERIES_DISCRIMINANT) {
            let (nu, nu_low) = T::damped_frequency(xi);
            Self::Under { xi, nu, nu_low }
        } else if discriminant.abs() <= T::exact(MAX_SERIES_DISCRIMINANT) {
            Self::NearCritical { xi, discriminant }
        } else {
            let root = (-discriminant).sqrt();
            let fast = xi + root;
            Self::Over { fast, slow: T::one() / fast, spread: root + root }
        }
    }

    /// The fundamental solutions after `d >= 0`.
    #[inline]
    pub fn at(&self, d: T) -> Free<T> {
        match *self {
            Self::Under { xi, nu, nu_low } => under_damped(xi, nu, nu_low, d),
            Self::NearCritical { xi, discriminant } => {
                let m = discriminant * d * d;
                if m.abs() < T::exact(0.5) {
                    return near_critical(xi, m, d);
                }
                let root = discriminant.abs().sqrt();
                if discriminant > T::zero() {
                    under_damped(xi, root, T::zero(), d)
                } else {
                    over_damped(T::one() / (xi + root), root + root, d)
                }
            }
            // No series here: for strong damping it would lose xi d, where this form loses nothing.
            Self::Over { slow, spread, .. } => over_damped(slow, spread, d),
        }
    }
}

#[inline]
fn under_damped<T: Number>(xi: T, nu: T, nu_low: T, d: T) -> Free<T> {
    let angle = nu * d;
    let turn = circular_of(angle, nu.product_error(d) + nu_low * d);
    let shrink = decay(xi * d);
    let s = shrink.exp * turn.sin / nu;
    let s_minus_d = (shrink.minus_1 * turn.sin + turn.sin_minus_x) / nu;
    let rotation = Rotation { shrink, turn };
    Free { rotation, ..Free::shrunk(xi, d, &shrink, turn.cos_minus_1, [s, s_minus_d]) }
}

#[inline]
fn near_critical<T: Number>(xi: T, m: T, d: T) -> Free<T> {
    let (mut cosine, mut sine) = (T::zero(), T::zero());
    for k in (0..T::TERMS).rev() {
        cosine = T::inverse_factorial(2 * k + 2) - m * cosine;
        sine = T::inverse_factorial(2 * k + 3) - m * sine;
    }
    Free::of_series(xi, d, &decay(xi * d), [-(m * cosine), -(m * sine)])
}

impl<T: Real> Free<T> {
    /// S = d exp(-xi d) (1 - m/3! + m^2/5! - ...) with m = (1 - xi^2) d^2, and C by the series of
    /// the cosine. Both series are given without their leading one.
    #[inline(always)]
    pub fn of_series(
        xi: T,
        d: T,
        shrink: &Decay<T>,
        [cosine_minus_1, sine_over_x_minus_1]: [T; 2],
    ) -> Self {
        let s = shrink.exp * d * (d.broadcast(1.0) + sine_over_x_minus_1);
        let s_minus_d = d * shrink.exp.times_plus(sine_over_x_minus_1, shrink.minus_1);
        Self::shrunk(xi, d, shrink, cosine_minus_1, [s, s_minus_d])
    }

    /// C - 1 = exp(-xi d) cos - 1 + xi S, in short times without the xi d that two of its parts
    /// share.
    #[inline(always)]
    pub fn shrunk(
        xi: T,
        d: T,
        shrink: &Decay<T>,
        cosine_minus_1: T,
        [s, s_minus_d]: [T; 2],
    ) -> Self {
        let turned = shrink.exp * cosine_minus_1;
        let weak = (xi * d).less(d.broadcast(0.5));
        let rest = T::choose(weak, shrink.remainder, shrink.minus_1);
        let c_minus_1 = xi.times_plus(T::choose(weak, s_minus_d, s), rest + turned);
        let s_rate_minus_1 = (xi + xi).times_from(s, c_minus_1);
        Self { s, s_minus_d, c_minus_1, s_rate_minus_1, ..Self::zero(d) }
    }

    /// With S = exp(-slow d) (1 - exp(-spread d))/spread nothing cancels, however small the spread;
    /// C = exp(-slow d) + slow S and S' = exp(-fast d) - slow S. The exponentials are given.
    #[inline(always)]
    pub fn of_exponentials(slow: T, spread: T, lasting: &Decay<T>, ratio: &Decay<T>) -> Self {
        let bare = -(ratio.minus_1 / spread);
        let s = lasting.exp * bare;
        let quick_minus_1 = lasting.exp.times_plus(ratio.minus_1, lasting.minus_1);
        Self {
            s,
            s_minus_d: lasting.minus_1.times_plus(bare, -(ratio.remainder / spread)),
            c_minus_1: slow.times_plus(s, lasting.minus_1),
            s_rate_minus_1: slow.times_from(s, quick_minus_1),
            fast_exponential: lasting.exp * ratio.exp,
            ..Self::zero(s)
        }
    }

    /// All zero, in the lanes of a number.
    #[inline(always)]
    pub fn zero(number: T) -> Self {
        let zero = number.broadcast(0.0);
        let shrink = Decay { exp: zero, minus_1: zero, remainder: zero };
        let turn = Circular { sin: zero, cos_minus_1: zero, sin_minus_x: zero };
        let rotation = Rotation { shrink, turn };
        let fast_exponential = zero;
        Self {
            s: zero,
            s_minus_d: zero,
            c_minus_1: zero,
            s_rate_minus_1: zero,
            fast_exponential,
            rotation,
        }
    }
}

#[inline]
fn over_damped<T: Number>(slow: T, spread: T, d: T) -> Free<T> {
    Free::of_exponentials(slow, spread, &decay(slow * d), &decay(spread * d))
}
