//! Heun's method with fixed steps: an engine in a crate of its own, scored and reported by the
//! whole program, on the oscillator and on every other system alike.
//!
//! `cargo run --release -p percuss-validation --example engine -- validate -e '^(exact|heun)$'`

use percuss_validation::engine::{
    Accuracy, Class, Colours, Declaration, Engine, Equations, Event, Failure, Limits, Location,
    Numbers, Outcome, Role, Stepping, Task, Work,
};
use percuss_validation::system::{AffineEquations, Values};
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
            class: Some(Class::Explicit),
            order: Some(2),
            events: Location::Harness,
            dense_output: false,
            stepping: Stepping::Fixed { order: 2 },
            role: Role::Rows,
            colours: Colours::OTHERS,
        }
    }

    fn takes(&self, task: &Task) -> Result<(), &'static str> {
        let watches = task.system.system().modes.iter().any(|mode| !mode.watch.is_empty());
        match task.system.is_backward() {
            true => Err("it does not run back in time"),
            false if watches => Err("it reports no events that end no mode"),
            false => Ok(()),
        }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        self.takes(task).map_err(Failure::new)?;
        let step = accuracy.step().ok_or_else(|| Failure::new("needs a step"))?;
        let step = step * task.shortest_time();
        let equations = AffineEquations::new(&task.system);
        let mut heun = HeunRun { equations, work: Work::default() };
        let mut outcome = Outcome::default();
        let (mut t, mut mode, mut state) = (0.0, task.mode, task.state);
        let mut entered = equations.enter(None, mode, t, &state);
        while t < task.span || entered.fires.is_some() {
            if heun.work.rhs_evaluations > limits.calls || outcome.events.len() > limits.events {
                return Err(Failure::new(format!("gave up at {t}")));
            }
            let whole = step.min(task.span - t);
            let found = entered.fires.map(|guard| (guard, 0.0));
            let found = found.or_else(|| heun.first_rise(mode, t, &state, whole));
            let length = found.map_or(whole, |(_, length)| length);
            let due = |time: &&f64| **time <= t + length;
            while let Some(time) = task.samples.get(outcome.samples.len()).filter(due) {
                outcome.samples.push(heun.step(mode, t, &state, time - t));
            }
            state = heun.step(mode, t, &state, length);
            t = if length < task.span - t { t + length } else { task.span };
            heun.work.steps += 1;
            if let Some((guard, _)) = found {
                let (left, before) = (mode, Some(state));
                (mode, state) = equations.after_event(left, guard, t, &state);
                entered = equations.enter(Some((left, guard)), mode, t, &state);
                outcome.events.push(Event { event: guard, mode, elapsed: t, state, before });
            }
        }
        (outcome.end, outcome.ended_at, outcome.work) = (state, t, heun.work);
        outcome.samples.resize(task.samples.len(), state);
        Ok(outcome)
    }
}

/// The equations, and what was counted.
struct HeunRun<'a> {
    equations: AffineEquations<'a>,
    work: Work,
}

impl HeunRun<'_> {
    fn step(&mut self, mode: usize, t: f64, state: &Values, length: f64) -> Values {
        let rates = Values::all(state.len(), 0.0);
        let (mut here, mut there, mut euler) = (rates, rates, *state);
        self.equations.derivatives(mode, t, state, &mut here);
        euler.iter_mut().zip(&*here).for_each(|(value, rate)| *value += length * rate);
        self.equations.derivatives(mode, t + length, &euler, &mut there);
        self.work.rhs_evaluations += 2;
        let mut after = *state;
        for (value, (here, there)) in after.iter_mut().zip(here.iter().zip(&*there)) {
            *value += 0.5 * length * (here + there);
        }
        after
    }

    /// A guard that is positive after a step, and not on its way back: a mode may begin where one
    /// of its guards is zero, which rounding turns into a crossing in either direction.
    fn rising(&mut self, mode: usize, t: f64, state: &Values, length: f64) -> Option<usize> {
        let after = self.step(mode, t, state, length);
        let guards = self.equations.guards(mode, t + length, &after);
        let rates = self.equations.rates(mode, t + length, &after);
        guards.iter().zip(&*rates).position(|(guard, rate)| *guard > 0.0 && *rate > 0.0)
    }

    /// The guard that rises in a step, with the length of the step that ends where it is zero, by
    /// bisection.
    fn first_rise(
        &mut self,
        mode: usize,
        t: f64,
        state: &Values,
        whole: f64,
    ) -> Option<(usize, f64)> {
        let mut found = self.rising(mode, t, state, whole)?;
        let (mut inside, mut outside) = (0.0, whole);
        for _ in 0..52 {
            let middle = 0.5 * (inside + outside);
            match self.rising(mode, t, state, middle) {
                Some(guard) => (found, outside) = (guard, middle),
                None => inside = middle,
            }
        }
        Some((found, outside))
    }
}

/// The whole command line of percuss, with this engine beside its own.
pub fn main() -> ExitCode {
    percuss_validation::cli::run_with(&[&Heun], std::env::args_os())
}
