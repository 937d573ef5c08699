//! Heun's method with fixed steps: an engine in a crate of its own, scored and reported by the
//! whole program.
//!
//! `cargo run --release -p percuss-validation --example engine -- validate -e '^(exact|heun)$'`

use percuss::Phase;
use percuss_validation::engine::{
    Accuracy, Colours, Declaration, Engine, Equations, Event, Failure, Limits, Location,
    Oscillator, Outcome, Role, Stepping, Task, Work, shortest_time,
};
use std::process::ExitCode;

/// Heun's method: a step of Euler, then one by the trapezoidal rule.
pub struct Heun;

impl Engine for Heun {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: "heun",
            library: "an example",
            version: "1.0.0".to_owned(),
            method: "Heun, fixed steps",
            order: Some(2),
            events: Location::Harness,
            dense_output: false,
            stepping: Stepping::Fixed { order: 2 },
            role: Role::Rows,
            colours: Colours::OTHERS,
        }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let step = accuracy.step().ok_or_else(|| Failure::new("needs a step"))?;
        let step = step * shortest_time(&task.parameters);
        let mut walk = HeunRun {
            equations: Oscillator::of(&task.parameters, task.forcing_angle),
            work: Work::default(),
        };
        let times = task.sample_times();
        let mut outcome = Outcome { samples: vec![task.state], ..Outcome::default() };
        let (mut t, mut phase, mut state) = (0.0, task.phase, task.state);
        while t < task.span {
            if walk.work.rhs_evaluations > limits.calls {
                return Err(Failure::new("gave up"));
            }
            let whole = step.min(task.span - t);
            let found = walk.guard_that_rises(phase, t, &state, whole);
            let length = found.map_or(whole, |guard| walk.locate(phase, t, &state, whole, guard));
            while let Some(time) = times.get(outcome.samples.len()).filter(|it| **it <= t + length)
            {
                outcome.samples.push(walk.step(phase, t, &state, time - t));
            }
            state = walk.step(phase, t, &state, length);
            t = if length < task.span - t { t + length } else { task.span };
            walk.work.steps += 1;
            if let Some(guard) = found {
                (phase, state) = walk.equations.switch(phase, guard, t, &state);
                outcome.events.push(Event { event: guard, mode: phase, elapsed: t, state });
            }
        }
        (outcome.end, outcome.work) = (state, walk.work);
        Ok(outcome)
    }
}

/// The equations, and what was counted.
struct HeunRun {
    equations: Oscillator,
    work: Work,
}

impl HeunRun {
    fn step(&mut self, phase: Phase, t: f64, state: &[f64; 4], length: f64) -> [f64; 4] {
        let (mut here, mut there) = ([0.0; 4], [0.0; 4]);
        self.equations.derivatives(phase, t, state, &mut here);
        let euler: [f64; 4] = std::array::from_fn(|k| state[k] + length * here[k]);
        self.equations.derivatives(phase, t + length, &euler, &mut there);
        self.work.rhs_evaluations += 2;
        std::array::from_fn(|k| state[k] + 0.5 * length * (here[k] + there[k]))
    }

    /// A guard that is positive after a step, and not on its way back: separation begins with a
    /// double zero of the gap, which rounding turns into a crossing in either direction.
    fn guard_that_rises(
        &mut self,
        phase: Phase,
        t: f64,
        state: &[f64; 4],
        length: f64,
    ) -> Option<usize> {
        let after = self.step(phase, t, state, length);
        let guards = self.equations.guards(phase, t + length, &after);
        let rates = self.equations.rates(phase, t + length, &after);
        (0..guards.len()).find(|k| guards[*k] > 0.0 && rates[*k] > 0.0)
    }

    /// The length of the step that ends where the guard is zero, by bisection.
    fn locate(&mut self, phase: Phase, t: f64, state: &[f64; 4], whole: f64, guard: usize) -> f64 {
        let (mut inside, mut outside) = (0.0, whole);
        for _ in 0..52 {
            let middle = 0.5 * (inside + outside);
            if self.guard_that_rises(phase, t, state, middle) == Some(guard) {
                outside = middle;
            } else {
                inside = middle;
            }
        }
        outside
    }
}

/// The whole command line of percuss, with this engine beside its own.
pub fn main() -> ExitCode {
    percuss_validation::cli::run_with(&[&Heun], std::env::args_os())
}
