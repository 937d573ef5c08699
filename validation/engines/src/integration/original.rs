//! The differential equations in the paper's original co-ordinates (x, y, z, v), Eqs. (1) to (9).
//!
//! Displacements of the mass, of the slider's top and of its bottom are integrated as they are,
//! unbounded; p = x - v and q = z - v are formed only for the scores. That the same bounded motion
//! and the same drift come out is the paper's decoupling, tested. At an event x and z move onto the
//! surface and v stays, as in the bounded co-ordinates.

use super::field::{Coordinates, GUARDS, count, settle, successor};
use crate::engine::{Task, place};
use crate::equations::{Entered, Equations, NO_GUARD};
use percuss::{Parameters, Phase};

/// The reason why an engine with the oscillator's own co-ordinates does not run another system.
pub const NOT_THE_OSCILLATOR: &str = "its co-ordinates are the oscillator's";

/// The model in the original co-ordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OriginalOscillator {
    a: f64,
    b: f64,
    omega: f64,
    g: f64,
    two_xi: f64,
    angle: f64,
}

impl OriginalOscillator {
    fn force(&self, t: f64) -> f64 {
        self.a * (self.omega * t + self.angle).cos() + self.b
    }

    /// Eq. (4) with z' = x'.
    fn contact_force(&self, u: &[f64]) -> f64 {
        self.two_xi * u[1] + (u[2] - u[3])
    }
}

impl Coordinates for OriginalOscillator {
    fn describe(task: &Task) -> Result<(), &'static str> {
        let is_oscillator = task.oscillator.is_some();
        if is_oscillator { Ok(()) } else { Err(NOT_THE_OSCILLATOR) }
    }

    fn new(parameters: &Parameters, angle: f64) -> Self {
        let Parameters { a, b, xi, omega, g, .. } = *parameters;
        Self { a, b, omega, g, two_xi: 2.0 * xi, angle }
    }

    fn of_bounded(&self, state: &[f64; 4]) -> [f64; 4] {
        let [p, y, q, v] = *state;
        [p + v, y, q + v, v]
    }
}

impl Equations for OriginalOscillator {
    type State = [f64; 4];
    type Guards = [f64; GUARDS];

    fn dimension(&self) -> usize {
        4
    }

    fn most_guards(&self) -> usize {
        GUARDS
    }

    fn count(&self, mode: usize) -> usize {
        count(Phase::ALL[mode])
    }

    fn reported(&self, u: &[f64; 4]) -> [f64; 4] {
        let [x, y, z, v] = *u;
        [x - v, y, z - v, v]
    }

    fn derivatives(&self, mode: usize, t: f64, u: &[f64], du: &mut [f64]) {
        let (y, q) = (u[1], u[2] - u[3]);
        let force = self.force(t);
        let rates = match Phase::ALL[mode] {
            Phase::NoContact => [y, force, -q / self.two_xi, 0.0],
            Phase::Contact => [y, -self.two_xi * y - q + force, y, 0.0],
            Phase::Progression => [y, force - 1.0, y, y + (q - 1.0) / self.two_xi],
        };
        du[..4].copy_from_slice(&rates);
    }

    fn jacobian_product(&self, mode: usize, w: &[f64], dw: &mut [f64]) {
        let (y, q) = (w[1], w[2] - w[3]);
        let rates = match Phase::ALL[mode] {
            Phase::NoContact => [y, 0.0, -q / self.two_xi, 0.0],
            Phase::Contact => [y, -self.two_xi * y - q, y, 0.0],
            Phase::Progression => [y, 0.0, y, y + q / self.two_xi],
        };
        dw[..4].copy_from_slice(&rates);
    }

    fn guards(&self, mode: usize, _: f64, u: &[f64]) -> [f64; GUARDS] {
        match Phase::ALL[mode] {
            Phase::NoContact => [u[0] - u[2] - self.g, NO_GUARD],
            Phase::Contact => [self.contact_force(u) - 1.0, -self.contact_force(u)],
            Phase::Progression => [1.0 - self.contact_force(u), NO_GUARD],
        }
    }

    fn rates(&self, mode: usize, t: f64, u: &[f64]) -> [f64; GUARDS] {
        if Phase::ALL[mode] == Phase::NoContact {
            return [self.contact_force(u) / self.two_xi, 0.0];
        }
        let mut du = [0.0; 4];
        self.derivatives(mode, t, u, &mut du);
        let rate = self.two_xi * du[1] + (du[2] - du[3]);
        if Phase::ALL[mode] == Phase::Contact { [rate, -rate] } else { [-rate, 0.0] }
    }

    fn after_event(&self, mode: usize, guard: usize, _: f64, u: &[f64; 4]) -> (usize, [f64; 4]) {
        let [_, y, mut z, v] = *u;
        let (next, imposed) = successor(Phase::ALL[mode], guard, self.contact_force(u));
        if let Some(force) = imposed {
            z = v + (force - self.two_xi * y);
        }
        (place(next), [z + self.g, y, z, v])
    }

    fn settle(&self, _: Entered, u: &[f64], guards: &mut [f64; GUARDS]) {
        settle(u, guards);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integration::field::Oscillator;

    /// Eq. (10) turns one set of equations into the other, in every phase and at every event.
    #[test]
    fn the_transformation_decouples() {
        let parameters = Parameters::default();
        let bounded = Oscillator::new(&parameters, 0.3);
        let original = OriginalOscillator::new(&parameters, 0.3);
        let state = [0.62, 1.7, 0.6, 2.5];
        let near = |left: [f64; 4], right: [f64; 4]| {
            left.iter().zip(right).all(|(a, b)| (a - b).abs() <= 1e-13 * (1.0 + b.abs()))
        };
        for phase in Phase::ALL.map(place) {
            let u = original.of_bounded(&state);
            let (mut du, mut expected) = ([0.0; 4], [0.0; 4]);
            original.derivatives(phase, 0.7, &u, &mut du);
            bounded.derivatives(phase, 0.7, &state, &mut expected);
            assert!(near(original.reported(&du), expected), "{phase}");
            original.jacobian_product(phase, &u, &mut du);
            bounded.jacobian_product(phase, &state, &mut expected);
            assert!(near(original.reported(&du), expected), "{phase}");
            for guard in 0..GUARDS {
                let (next, there) = original.after_event(phase, guard, 0.7, &u);
                let (expected, state) = bounded.after_event(phase, guard, 0.7, &state);
                assert_eq!(next, expected);
                assert!(near(original.reported(&there), state), "{phase} {guard}");
            }
            let differences = [
                original.guards(phase, 0.7, &u)[0] - bounded.guards(phase, 0.7, &state)[0],
                original.rates(phase, 0.7, &u)[0] - bounded.rates(phase, 0.7, &state)[0],
            ];
            assert!(differences.iter().all(|it| it.abs() < 1e-12), "{phase} {differences:?}");
        }
    }
}
