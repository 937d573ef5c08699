//! The free oscillation in contact, enclosed.

use crate::ball::Ball;
use crate::functions::{exp, exp_less_1, sin_cos};

/// The form of the free oscillation in contact.
#[derive(Clone, Copy)]
pub(crate) enum Damping {
    Under {
        nu: Ball,
    },
    Critical,
    /// Over-damped but not far above: spread is 2 sqrt(xi^2 - 1), slow is 1/(xi + spread/2).
    Above {
        slow: Ball,
        spread: Ball,
    },
    /// Far above: the two exponentials apart.
    Far {
        slow: Ball,
        fast: Ball,
    },
}

/// The damping from which on the free oscillation is taken apart into two exponentials.
const MIN_SPLIT_DAMPING: f64 = 1.25;

impl Damping {
    /// The form for this damping ratio.
    pub(crate) fn new(xi: f64) -> Self {
        let (one, x) = (Ball::ONE, Ball::exact(xi));
        let discriminant = (one - x) * (one + x);
        if xi < 1.0 {
            return Self::Under { nu: discriminant.sqrt() };
        }
        if xi == 1.0 {
            return Self::Critical;
        }
        let root = (-discriminant).sqrt();
        let fast = x + root;
        let slow = one / fast;
        if xi < MIN_SPLIT_DAMPING {
            Self::Above { slow, spread: root.scaled(2.0) }
        } else {
            Self::Far { slow, fast }
        }
    }

    /// The solutions C and S of x'' + 2 xi x' + x = 0 with C = 1, C' = 0 and S = 0, S' = 1 at the
    /// start.
    pub(crate) fn fundamental(&self, xi: Ball, d: Ball) -> (Ball, Ball) {
        match *self {
            Self::Under { nu } => {
                let (sin, cos) = sin_cos(nu * d);
                let shrunk = exp(-(xi * d));
                let s = shrunk * sin / nu;
                (shrunk * cos + xi * s, s)
            }
            Self::Critical => {
                let shrunk = exp(-d);
                (shrunk * (Ball::ONE + d), shrunk * d)
            }
            Self::Above { slow, spread } => {
                let lasting = exp(-(slow * d));
                let s = -(lasting * exp_less_1(-(spread * d)) / spread);
                (lasting + slow * s, s)
            }
            Self::Far { .. } => (Ball::ZERO, Ball::ZERO),
        }
    }
}
