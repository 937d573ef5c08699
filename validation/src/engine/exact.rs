//! The exact solver, as an engine among others.

use super::meter::{Failure, Limits};
use super::{Accuracy, Declaration, Engine, Event, Location, Outcome, Stepping, Task, Work, pins};
use percuss::{Entry, Exit, Leg, Sample};

/// The closed forms, joined at proved first crossings.
pub(super) struct Exact;

impl Engine for Exact {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: "exact",
            library: "percuss",
            version: pins::version("percuss"),
            method: "closed forms, certified first crossing",
            events: Location::Proved,
            dense_output: true,
            stepping: Stepping::Exact,
        }
    }

    fn run(&self, task: &Task, _: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let start = task.problem.entry;
        let mut outcome = Outcome::default();
        let mut run = task.problem.model.trajectory(start).until(task.horizon);
        let event = |next: &Entry| {
            let elapsed = next.instant.since(&start.instant, task.parameters.omega).value();
            let state = [next.state.p, next.state.y, next.state.q, next.v()];
            Event { phase: next.phase(), elapsed, state }
        };
        while let Some(begun) = run.upcoming().copied() {
            let more = outcome.samples.len() < task.grid.count;
            let exit = if more {
                let Some(leg) = run.next() else { break };
                sample(task, &leg, &mut outcome.samples);
                *leg.exit()
            } else {
                let Some(exit) = run.pass() else { break };
                exit
            };
            match exit {
                Exit::Switch(next) => outcome.events.push(event(&next)),
                Exit::Horizon | Exit::Endless(_) => {
                    let last = task.problem.model.trajectory(begun).until(task.horizon).next();
                    outcome.end = last.map_or(outcome.end, |leg| state(&leg.at_instant(&task.horizon)));
                }
            }
            if outcome.events.len() > limits.events {
                return Err(Failure::new(format!("gave up after {} switches", limits.events)));
            }
        }
        let counters = run.counters();
        outcome.work = Work {
            rhs_evaluations: counters.evaluations,
            steps: outcome.events.len() as u64 + 1,
            ..Work::default()
        };
        Ok(outcome)
    }
}

/// The grid's instants that lie in this phase.
fn sample(task: &Task, leg: &Leg, samples: &mut Vec<[f64; 4]>) {
    let start = task.problem.entry.instant;
    while samples.len() < task.grid.count {
        let instant = start.after_periods(samples.len() as u64, u64::from(task.grid.per_period));
        if leg.ends_by(&instant) {
            return;
        }
        samples.push(state(&leg.at_instant(&instant)));
    }
}

fn state(sample: &Sample) -> [f64; 4] {
    [sample.state.p, sample.state.y, sample.state.q, sample.v]
}
