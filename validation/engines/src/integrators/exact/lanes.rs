//! The exact solver's ensembles, as far as an outcome goes: events and the end of a run, no
//! samples.

use crate::case::Problem;
use crate::engine::{Event, OscillatorTask, Outcome, Work, place};
use crate::equations::Numbers;
use crate::integration::event_between;
use crate::system::Values;
use percuss::dynamics::ensemble::{Member, Watcher, follow_by};
use percuss::lanes::Instructions;
use percuss::{Endless, Entry, Instant, Phase};
use std::ops::ControlFlow;

/// The events and the end of one run in lanes.
struct LaneRecord {
    outcome: Outcome,
    start: Instant,
    omega: f64,
    phase: Phase,
}

impl Watcher for LaneRecord {
    fn see(&mut self, strobe: &Entry, _: Option<Endless>) -> ControlFlow<()> {
        let [p, y, q] = strobe.point();
        self.outcome.end = Values::from_slice(&[p, y, q, strobe.v()]);
        ControlFlow::Break(())
    }

    fn enter(&mut self, phase: &Entry) {
        let [p, y, q] = phase.point();
        let before = std::mem::replace(&mut self.phase, phase.phase());
        self.outcome.events.push(Event {
            event: event_between(before, self.phase),
            mode: place(self.phase),
            elapsed: phase.instant.since(&self.start, self.omega).value(),
            state: Values::from_slice(&[p, y, q, phase.v()]),
            before: None,
        });
    }
}

/// Runs a task so many times at once, by these instructions.
#[must_use]
pub fn run_in_lanes(by: Instructions, task: &OscillatorTask, times: usize) -> Vec<Outcome> {
    let Problem { model, entry, .. } = &task.problem;
    let (done, _) = follow_by(by, times, |_| {
        let (start, omega) = (entry.instant, task.parameters.omega);
        let watcher = LaneRecord { outcome: Outcome::default(), start, omega, phase: task.phase };
        let (first, horizon) = (task.horizon, Some(task.horizon));
        Member { model, entry: *entry, first, horizon, watcher }
    });
    let counted = |LaneRecord { mut outcome, .. }| {
        outcome.work = Work { steps: outcome.events.len() as u64 + 1, ..Work::default() };
        outcome
    };
    done.into_iter().map(counted).collect()
}
