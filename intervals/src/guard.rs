//! The guards of the three phases as exact functions of the time elapsed, enclosed with their
//! derivatives.
//!
//! A guard is a parabola, a harmonic, in contact a free oscillation, and one exponential that may
//! be quick: the slider's without contact and in progression, the faster of two in over-damped
//! contact. They are written down here once more, from the equations of motion and not from the
//! library's closed forms. What is known exactly at the entry is taken from the phase: the solver's
//! f64 values, and the forcing angle in its two words.

use crate::ball::Ball;
use crate::damping::Damping;
use crate::functions::{INVERSE_FACTORIALS, exp, sin_cos};

/// Derivatives in an expansion, that of order zero included.
pub const ORDERS: usize = 12;

/// The part of the guard that neither forcing nor parabola explain and that is not quick.
#[derive(Clone, Copy)]
pub(crate) enum Free {
    None,
    /// A free oscillation with this value and rate at the entry.
    Oscillation {
        start: [Ball; 2],
        damping: Damping,
        xi: Ball,
    },
    /// A slow exponential with this value at the entry.
    Slow {
        start: Ball,
        rate: Ball,
    },
}

/// The guard of one phase.
pub struct Guard {
    /// The guard's polynomial part: its value at the entry and its derivatives.
    pub(crate) parabola: [Ball; 3],
    /// What cosine and sine of the forcing angle are multiplied by.
    pub(crate) harmonic: [Ball; 2],
    /// Bound of the harmonic's size.
    pub(crate) amplitude: f64,
    pub(crate) omega: Ball,
    /// The forcing angle at the entry.
    pub(crate) angle: Ball,
    pub(crate) free: Free,
    /// The quick exponential at the entry, and its rate of decay.
    pub(crate) quick: Ball,
    pub(crate) rate: Ball,
    /// Value and slope at the entry where they are known exactly.
    pub(crate) start: [Option<Ball>; 2],
    /// The fastest rate at which it changes but for the quick exponential.
    pub pace: f64,
}

/// The guard around some place.
pub struct Expansion {
    /// The derivatives of the guard without the quick exponential.
    pub smooth: [Ball; ORDERS],
    /// The derivatives of the guard.
    pub whole: [Ball; ORDERS],
    /// Bounds of its derivatives of the order after those, from here on, without the quick one and
    /// with it.
    pub bounds: [f64; 2],
    /// The quick exponential.
    pub quick: Ball,
    /// The rate of decay of the quick exponential.
    pub rate: Ball,
    /// Value and derivatives of the parabola.
    pub parabola: [Ball; 3],
    /// Bound of what is neither parabola nor quick, from here on.
    pub amplitude: f64,
}

impl Guard {
    /// Expanded around a time after the entry.
    #[must_use]
    pub fn at(&self, d: Ball) -> Expansion {
        let begins = d.is_exactly_zero();
        let [p0, p1, p2] = self.parabola;
        let parabola = [p0 + d * (p1 + p2.scaled(0.5) * d), p1 + p2 * d, p2];
        let (mut smooth, free_bounds) = self.free_at(d);
        self.add_harmonic(d, &mut smooth);
        for (derivative, term) in smooth.iter_mut().zip(parabola) {
            *derivative = *derivative + term;
        }
        let quick = if begins { self.quick } else { self.quick * exp(-(self.rate * d)) };
        let (mut whole, mut fall) = (smooth, quick);
        for derivative in &mut whole {
            *derivative = *derivative + fall;
            fall = -(fall * self.rate);
        }
        if begins {
            for (derivative, known) in whole.iter_mut().zip(self.start) {
                *derivative = known.unwrap_or(*derivative);
            }
        }
        let high = power(self.omega, ORDERS) * Ball::exact(self.amplitude);
        let bound = (high.size() + free_bounds[1]).next_up();
        let bounds = [bound, (bound + fall.size()).next_up()];
        let amplitude = (self.amplitude + free_bounds[0]).next_up();
        Expansion { smooth, whole, bounds, quick, rate: self.rate, parabola, amplitude }
    }

    /// Adds the harmonic's derivatives.
    fn add_harmonic(&self, d: Ball, orders: &mut [Ball; ORDERS]) {
        let (sin, cos) = sin_cos(self.angle + self.omega * d);
        let [c, s] = self.harmonic;
        let mut turn = [c * cos + s * sin, self.omega * (s * cos - c * sin)];
        let minus_square = -self.omega.square();
        for (k, derivative) in orders.iter_mut().enumerate() {
            *derivative = *derivative + turn[k % 2];
            turn[k % 2] = turn[k % 2] * minus_square;
        }
    }

    /// The free part's derivatives, and bounds from here on of itself and of its next derivative.
    fn free_at(&self, d: Ball) -> ([Ball; ORDERS], [f64; 2]) {
        let mut orders = [Ball::ZERO; ORDERS];
        match self.free {
            Free::None => (orders, [0.0; 2]),
            Free::Slow { start, rate } => {
                let mut value = start * exp(-(rate * d));
                let size = value.size();
                for order in &mut orders {
                    *order = value;
                    value = -(value * rate);
                }
                (orders, [size, value.size()])
            }
            Free::Oscillation { start: [x0, rate0], damping, xi } => {
                let (c, s) = if d.is_exactly_zero() {
                    (Ball::ONE, Ball::ZERO)
                } else {
                    damping.fundamental(xi, d)
                };
                let two_xi = xi.scaled(2.0);
                let (mut x, mut rate) = (x0 * c + rate0 * s, rate0 * (c - two_xi * s) - x0 * s);
                // x^2 + x'^2 never grows, nor that of any derivative.
                let size = energy(x, rate);
                for order in &mut orders {
                    *order = x;
                    (x, rate) = (rate, -(two_xi * rate + x));
                }
                (orders, [size, energy(x, rate)])
            }
        }
    }
}

/// A bound of sqrt(x^2 + y^2).
pub(crate) fn energy(x: Ball, y: Ball) -> f64 {
    let (x, y) = (x.size(), y.size());
    // Three roundings, and the square root's.
    let size = (x * x + y * y).sqrt() * (1.0 + 4.0 * f64::EPSILON);
    // Smaller numbers have no square; a NaN stays one.
    if size < 1e-140 { 1e-140 } else { size }
}

fn power(x: Ball, n: usize) -> Ball {
    (0..n).fold(Ball::ONE, |product, _| product * x)
}

impl Expansion {
    /// The guard's value after a time `length`, by its series.
    pub(crate) fn value_after(&self, length: Ball) -> Ball {
        self.series_after(0, length)
    }

    /// The guard's slope after a time `length`, by its series.
    pub(crate) fn slope_after(&self, length: Ball) -> Ball {
        self.series_after(1, length)
    }

    /// The change of the guard over a time `length`.
    pub(crate) fn change_after(&self, length: Ball) -> Ball {
        let mut from_zero = self.whole;
        from_zero[0] = Ball::ZERO;
        Self { whole: from_zero, ..*self }.series_after(0, length)
    }

    fn series_after(&self, order: usize, length: Ball) -> Ball {
        let terms = ORDERS - order;
        let mut sum = Ball::ZERO;
        for k in (0..terms).rev() {
            sum = sum * length + self.whole[k + order] * INVERSE_FACTORIALS[k];
        }
        let mut rest = Ball::exact(self.bounds[1]) * INVERSE_FACTORIALS[terms];
        for _ in 0..terms {
            rest = rest * length;
        }
        sum.widened(rest.size())
    }
}
