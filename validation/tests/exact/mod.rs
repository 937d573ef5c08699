//! The exact solver as the harness runs it, and the problems that cases pose.
#![allow(dead_code, reason = "each test uses its own part")]

use percuss::dynamics::ensemble::{Motion, Watcher, follow_by};
use percuss::lanes::Instructions;
use percuss::{Endless, Entry, Instant};
use percuss_validation::case::{Case, Given, Problem, embedded};
use percuss_validation::engine::{Accuracy, Engine, Event, Failure, Limits, Outcome, Task, all};
use std::ops::ControlFlow;

fn engine() -> &'static dyn Engine {
    let mut engines = all().iter().copied();
    engines.find(|engine| engine.declaration().name == "exact").expect("it is an engine")
}

/// Runs a task.
pub fn run(task: &Task) -> Result<Outcome, Failure> {
    engine().run(task, Accuracy::Exact, &Limits::default())
}

/// What a task asks for, of a motion in lanes.
struct Record {
    outcome: Outcome,
    start: Instant,
    omega: f64,
}

impl Watcher for Record {
    fn see(&mut self, strobe: &Entry, _: Option<Endless>) -> ControlFlow<()> {
        let [p, y, q] = strobe.point();
        self.outcome.end = [p, y, q, strobe.v()];
        ControlFlow::Break(())
    }

    fn enter(&mut self, phase: &Entry) {
        let [p, y, q] = phase.point();
        self.outcome.events.push(Event {
            phase: phase.phase(),
            elapsed: phase.instant.since(&self.start, self.omega).value(),
            state: [p, y, q, phase.v()],
        });
    }
}

/// Runs a task by these instructions.
pub fn run_in_lanes(by: Instructions, task: &Task) -> Outcome {
    let Problem { model, entry, .. } = &task.problem;
    let (mut done, _) = follow_by(by, 1, |_| {
        let (start, omega) = (entry.instant, task.parameters.omega);
        let watcher = Record { outcome: Outcome::default(), start, omega };
        let (first, horizon) = (task.horizon, Some(task.horizon));
        Motion { model, entry: *entry, first, horizon, watcher }
    });
    done.pop().map(|record| record.outcome).expect("one motion")
}

/// The embedded case of this name.
pub fn case(name: &str) -> Case {
    let cases = embedded().expect("the cases are read");
    cases.into_iter().find(|case| case.name == name).expect("the case is there")
}

/// A case's model at its start.
pub fn problem(case: &Case) -> Problem {
    let given = Given { parameters: case.parameters, start: case.start, ..Given::default() };
    given.check().expect("the case is checked")
}
