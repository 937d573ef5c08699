//! The oscillator written down as any other system is, which is how engines are asked to run it.

use super::{OscillatorTask, Task, place};
use crate::failure::Failure;
use crate::system::by_hand::{self, mode, until};
use crate::system::{CheckedSystem, Row, System};
use percuss::Parameters;
use std::sync::Arc;

/// p, y, q and v.
const STATES: usize = 4;
/// The column of the coefficient of cos theta in a row.
const COS_COLUMN: usize = STATES;
/// The column of the constant term in a row.
const CONSTANT_COLUMN: usize = STATES + 2;

/// The oscillator as a system; `angle` is omega tau + phi at the start.
///
/// An event puts the state on the surface that it defines by moving p and q, as the engines that
/// know the oscillator do.
#[must_use]
pub fn percussive(parameters: &Parameters, angle: f64) -> System {
    let Parameters { xi, omega, g, .. } = *parameters;
    let two_xi = 2.0 * xi;
    // sign (f - level), with the trial force f.
    let trial = |sign: f64, level: f64| {
        row(&[(1, sign * two_xi), (2, sign), (CONSTANT_COLUMN, -sign * level)])
    };
    // p = q + g, and q such that f is what is imposed.
    let surface = |imposed: f64| {
        let q = [(1, -two_xi), (CONSTANT_COLUMN, imposed)];
        let p = [(1, -two_xi), (CONSTANT_COLUMN, imposed + g)];
        Some(vec![row(&p), state(1), row(&q), state(3)])
    };
    let meets = Some(vec![row(&[(2, 1.0), (CONSTANT_COLUMN, g)]), state(1), state(2), state(3)]);
    let gap = row(&[(0, 1.0), (2, -1.0), (CONSTANT_COLUMN, -g)]);
    let impact = until("impact", gap, meets, vec![(Some(trial(1.0, 1.0)), 2), (None, 1)]);
    let yields = until("give-way", trial(1.0, 1.0), surface(1.0), vec![(None, 2)]);
    let leaves = until("separation", trial(-1.0, 0.0), surface(0.0), vec![(None, 0)]);
    let holds = until("hold", trial(-1.0, 1.0), surface(1.0), vec![(None, 1)]);
    let [flight, contact, progression] = rates(parameters);
    System {
        name: "percussive-oscillator".to_owned(),
        states: ["p", "y", "q", "v"].map(str::to_owned).to_vec(),
        drift: vec![3],
        scales: vec![1.0; STATES],
        time_scale: 1.0 / omega,
        omega,
        phi: angle,
        modes: vec![
            mode("no-contact", &flight, vec![impact]),
            mode("contact", &contact, vec![yields, leaves]),
            mode("progression", &progression, vec![holds]),
        ],
    }
}

/// The rates of the states in each phase.
fn rates(parameters: &Parameters) -> [[Row; STATES]; 3] {
    let Parameters { a, b, xi, .. } = *parameters;
    let two_xi = 2.0 * xi;
    let rate = 1.0 / two_xi;
    let force =
        |extra: &[(usize, f64)]| row(&[&[(COS_COLUMN, a), (CONSTANT_COLUMN, b)], extra].concat());
    // sign (1 - q)/(2 xi).
    let closing = |sign: f64| [(2, -sign * rate), (CONSTANT_COLUMN, sign * rate)];
    let still = || row(&[]);
    [
        [state(1), force(&[]), row(&[(2, -rate)]), still()],
        [state(1), force(&[(1, -two_xi), (2, -1.0)]), state(1), still()],
        [
            row(&closing(1.0)),
            force(&[(CONSTANT_COLUMN, -1.0)]),
            row(&closing(1.0)),
            row(&[&[(1, 1.0)], closing(-1.0).as_slice()].concat()),
        ],
    ]
}

/// A row of which some entries are given and the others are zero.
fn row(entries: &[(usize, f64)]) -> Row {
    by_hand::row(STATES, entries)
}

/// The row that selects one state.
fn state(place: usize) -> Row {
    by_hand::state(STATES, place)
}

impl Task {
    /// A task of the oscillator, as the task of a system.
    ///
    /// # Errors
    /// A start or a horizon that no system has.
    pub fn of_oscillator(task: &OscillatorTask) -> Result<Self, Failure> {
        let system = CheckedSystem::new(percussive(&task.parameters, task.forcing_angle))?;
        let system = Arc::new(system);
        let samples = task.sample_times();
        let run = Self::new(system, place(task.phase), &task.state, task.span, samples)?;
        let oscillator = Some(Arc::new(task.clone()));
        Ok(Self { oscillator, ..run })
    }
}
