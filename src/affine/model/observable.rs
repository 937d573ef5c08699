//! Affine functions of a system's state and forcing, such as the quantities that a picture shows.

use super::system::Row;

/// An affine function of the states, and of the forcing's cos theta and sin theta.
#[derive(Clone, Debug, PartialEq)]
pub struct Observable {
    /// The factors of the states, of cos theta, of sin theta and of 1.
    factors: Vec<f64>,
    /// The frequency and the phase of the forcing; zero without one.
    forcing: [f64; 2],
}

impl Observable {
    /// The function of these exact factors.
    pub(super) fn new(factors: &Row, forcing: [f64; 2]) -> Self {
        Self { factors: factors.iter().map(super::rational::Rational::to_f64).collect(), forcing }
    }

    /// The value at a time for these states, in the order of the system's file.
    #[must_use]
    pub fn value(&self, time: f64, state: &[f64]) -> f64 {
        let states = self.factors.len() - 3;
        let products =
            self.factors[..states].iter().zip(state).filter(|(factor, _)| **factor != 0.0);
        let of_states: f64 = products.map(|(factor, value)| factor * value).sum();
        let [cos, sin, one] = [0, 1, 2].map(|n| self.factors[states + n]);
        let turning = if cos == 0.0 && sin == 0.0 {
            0.0
        } else {
            let theta = self.forcing[0] * time + self.forcing[1];
            cos * theta.cos() + sin * theta.sin()
        };
        of_states + turning + one
    }
}
