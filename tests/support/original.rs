//! An integrator that knows only the differential equations (1)-(9) in the original co-ordinates
//! (x, y, z, v): Taylor series of fixed order, short steps. It shares nothing with the closed
//! forms.

use percuss::{Parameters, Phase};

/// Terms of the series; with steps of at most a quarter of the fastest time 0.25^25/25! is far
/// below the rounding.
const ORDER: usize = 24;

/// The equations of one phase.
#[derive(Clone, Copy, Debug)]
pub struct Equations {
    pub phase: Phase,
    pub parameters: Parameters,
}

impl Equations {
    /// The fastest rate of this phase.
    pub fn rate(&self) -> f64 {
        let Parameters { xi, omega, .. } = self.parameters;
        match self.phase {
            Phase::Contact => omega.max(1.0).max(2.0 * xi),
            Phase::NoContact | Phase::Progression => omega.max(1.0).max(0.5 / xi),
        }
    }

    /// Steps that an integration over `span` takes.
    pub fn steps(&self, span: f64) -> f64 {
        (4.0 * span * self.rate()).ceil().max(1.0)
    }

    /// The rates of x, y, z, v, without the external force's share.
    fn rates(&self, [_, y, z, v]: [f64; 4], one: f64) -> [f64; 4] {
        let two_xi = 2.0 * self.parameters.xi;
        match self.phase {
            Phase::NoContact => [y, 0.0, -(z - v) / two_xi, 0.0],
            Phase::Contact => [y, -(two_xi * y + (z - v)), y, 0.0],
            Phase::Progression => [y, -one, y, y + (z - v - one) / two_xi],
        }
    }

    /// One step; `theta` is the forcing angle omega tau + phi where it begins.
    fn step(&self, theta: f64, state: [f64; 4], step: f64) -> [f64; 4] {
        let Parameters { a, b, omega, .. } = self.parameters;
        let (sin, cos) = theta.sin_cos();
        // Derivatives of a cos(theta + omega d): cos, -sin, -cos, sin, ...
        let cycle = [cos, -sin, -cos, sin];
        let mut coefficients = state; // of d^k/k!, scaled by step^k/k!
        let (mut sum, mut scale, mut one) = (state, 1.0, 1.0);
        for k in 0..ORDER {
            let force = a * cycle[k % 4] * scale + if k == 0 { b } else { 0.0 };
            let mut next = self.rates(coefficients, one);
            next[1] += force;
            for (sum, next) in sum.iter_mut().zip(&mut next) {
                *next *= step / (k + 1) as f64;
                *sum += *next;
            }
            coefficients = next;
            scale *= omega * step / (k + 1) as f64;
            one = 0.0;
        }
        sum
    }

    /// The state a time `span` later.
    pub fn integrate(&self, theta: f64, mut state: [f64; 4], span: f64) -> [f64; 4] {
        let steps = self.steps(span);
        for k in 0..steps as u64 {
            let passed = self.parameters.omega * (span * (k as f64 / steps));
            state = self.step(theta + passed, state, span / steps);
        }
        state
    }
}
