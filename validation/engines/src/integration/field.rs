//! The differential equations of the three phases, their guards and their events, as an
//! integrator's user writes them: Eqs. (11) to (13) on plain slices (p, y, q, v).
//!
//! Guards are negative inside a phase and rise to zero where it ends. A crossing counts only if the
//! guard rises there: separation begins with a double zero of the gap, which rounding turns into a
//! crossing in either direction. At an event the state is put on the surface that the event
//! defines (p = q + g, and q = 0 or 1 - 2 xi y where the trial force is known), always by moving q
//! and p, because y = (1 - q)/(2 xi) would multiply what is left of the error by 1/(2 xi).

use crate::engine::{Task, place};
use crate::equations::{Entered, Equations, NO_GUARD};
use percuss::{Parameters, Phase};

/// Number of guards; a phase that has one leaves the other at -1.
pub const GUARDS: usize = 2;

/// The distance from its surface at which rounding may put the beginning of a phase, relative to
/// displacements: 64 roundings.
const SURFACE_TOLERANCE: f64 = 64.0 * f64::EPSILON;

/// The oscillator in some co-ordinates.
pub(crate) trait Coordinates: Equations<State = [f64; 4], Guards = [f64; GUARDS]> {
    /// Whether a task's system has these co-ordinates: the paper's bounded ones are a system's own
    /// states, others are defined for the oscillator alone.
    ///
    /// # Errors
    /// Why it does not.
    fn describe(_task: &Task) -> Result<(), &'static str> {
        Ok(())
    }

    /// The model's equations; `angle` is omega tau + phi at the start.
    fn new(parameters: &Parameters, angle: f64) -> Self;

    /// p, y, q and v in these co-ordinates.
    fn of_bounded(&self, state: &[f64; 4]) -> [f64; 4];
}

/// The number of the guard that has ended a phase, given the phase that follows.
#[must_use]
pub fn event_between(phase: Phase, next: Phase) -> usize {
    usize::from(phase == Phase::Contact && next == Phase::NoContact)
}

/// The number of guards of a phase: the gap in flight; the trial force at 1 and at 0 in contact;
/// the trial force at 1 in progression.
pub(crate) fn count(phase: Phase) -> usize {
    if phase == Phase::Contact { GUARDS } else { 1 }
}

/// A phase begins on a surface, but for the rounding of its displacements. Separation begins on a
/// double zero, and a gap of some roundings that seems to close is none.
pub(crate) fn settle(u: &[f64], guards: &mut [f64; GUARDS]) {
    let rounding = SURFACE_TOLERANCE * u.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
    for guard in guards.iter_mut().filter(|guard| guard.abs() <= rounding) {
        *guard = 0.0;
    }
}

/// The phase that follows where a guard has risen to zero, and the trial force that is known there.
pub(crate) fn successor(phase: Phase, guard: usize, trial_force: f64) -> (Phase, Option<f64>) {
    match (phase, guard) {
        (Phase::NoContact, _) if trial_force < 1.0 => (Phase::Contact, None),
        (Phase::NoContact, _) => (Phase::Progression, None),
        (Phase::Contact, 0) => (Phase::Progression, Some(1.0)),
        (Phase::Contact, _) => (Phase::NoContact, Some(0.0)),
        (Phase::Progression, _) => (Phase::Contact, Some(1.0)),
    }
}

/// The model in the paper's bounded co-ordinates.
#[derive(Clone, Copy, Debug)]
pub struct Oscillator {
    a: f64,
    b: f64,
    omega: f64,
    g: f64,
    two_xi: f64,
    angle: f64,
}

impl Oscillator {
    /// The model's equations; `angle` is omega tau + phi at the start.
    #[must_use]
    pub fn new(parameters: &Parameters, angle: f64) -> Self {
        let Parameters { a, b, xi, omega, g, .. } = *parameters;
        Self { a, b, omega, g, two_xi: 2.0 * xi, angle }
    }

    fn force(&self, t: f64) -> f64 {
        self.a * (self.omega * t + self.angle).cos() + self.b
    }

    fn trial_force(&self, u: &[f64]) -> f64 {
        self.two_xi * u[1] + u[2]
    }
}

impl Coordinates for Oscillator {
    fn new(parameters: &Parameters, angle: f64) -> Self {
        Self::new(parameters, angle)
    }

    fn of_bounded(&self, state: &[f64; 4]) -> [f64; 4] {
        *state
    }
}

impl Equations for Oscillator {
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

    /// Eqs. (11), (12), (13) and the drift's velocity.
    fn derivatives(&self, mode: usize, t: f64, u: &[f64], du: &mut [f64]) {
        let (y, q) = (u[1], u[2]);
        let force = self.force(t);
        let rates = match Phase::ALL[mode] {
            Phase::NoContact => [y, force, -q / self.two_xi, 0.0],
            Phase::Contact => [y, -self.two_xi * y - q + force, y, 0.0],
            Phase::Progression => {
                let closing = (1.0 - q) / self.two_xi;
                [closing, force - 1.0, closing, y - closing]
            }
        };
        du[..4].copy_from_slice(&rates);
    }

    fn jacobian_product(&self, mode: usize, w: &[f64], dw: &mut [f64]) {
        let (y, q) = (w[1], w[2]);
        let rates = match Phase::ALL[mode] {
            Phase::NoContact => [y, 0.0, -q / self.two_xi, 0.0],
            Phase::Contact => [y, -self.two_xi * y - q, y, 0.0],
            Phase::Progression => {
                let closing = -q / self.two_xi;
                [closing, 0.0, closing, y - closing]
            }
        };
        dw[..4].copy_from_slice(&rates);
    }

    fn guards(&self, mode: usize, _: f64, u: &[f64]) -> [f64; GUARDS] {
        match Phase::ALL[mode] {
            Phase::NoContact => [u[0] - u[2] - self.g, NO_GUARD],
            Phase::Contact => [self.trial_force(u) - 1.0, -self.trial_force(u)],
            Phase::Progression => [1.0 - self.trial_force(u), NO_GUARD],
        }
    }

    fn rates(&self, mode: usize, t: f64, u: &[f64]) -> [f64; GUARDS] {
        if Phase::ALL[mode] == Phase::NoContact {
            return [self.trial_force(u) / self.two_xi, 0.0];
        }
        let mut du = [0.0; 4];
        self.derivatives(mode, t, u, &mut du);
        let rate = self.two_xi * du[1] + du[2];
        if Phase::ALL[mode] == Phase::Contact { [rate, -rate] } else { [-rate, 0.0] }
    }

    fn after_event(&self, mode: usize, guard: usize, _: f64, u: &[f64; 4]) -> (usize, [f64; 4]) {
        let mut state = *u;
        let (next, imposed) = successor(Phase::ALL[mode], guard, self.trial_force(u));
        if let Some(force) = imposed {
            state[2] = force - self.two_xi * state[1];
        }
        state[0] = state[2] + self.g;
        (place(next), state)
    }

    fn settle(&self, _: Entered, u: &[f64], guards: &mut [f64; GUARDS]) {
        settle(u, guards);
    }
}
