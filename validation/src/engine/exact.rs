//! The exact solver, as an engine among others.

use super::meter::{Failure, Limits};
use super::{Accuracy, Declaration, Engine, Event, Location, Outcome, Stepping, Task, Work, pins};
use percuss::two_word::TwoWord;
use percuss::{Exit, Leg, Sample, Step, Trajectory};

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
        let mut outcome = Outcome { events: Vec::with_capacity(USUAL), ..Outcome::default() };
        let mut run = task.problem.model.trajectory(task.problem.entry).until(task.horizon);
        let mut elapsed = TwoWord::ZERO;
        loop {
            let (duration, next) = match phase(task, &mut run, &mut outcome.samples) {
                Some(Step::Switch { duration, next }) => (duration, next),
                Some(Step::Last(leg)) => {
                    outcome.end = state(&leg.at_instant(&task.horizon));
                    break;
                }
                None => break,
            };
            elapsed = elapsed.plus(duration);
            outcome.events.push(Event {
                phase: next.phase(),
                elapsed: elapsed.value(),
                state: [next.state.p, next.state.y, next.state.q, next.v()],
            });
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

/// How many switches a run has room for at first.
const USUAL: usize = 128;

/// The run's next phase, sampled as long as samples are asked for.
fn phase(task: &Task, run: &mut Trajectory, samples: &mut Vec<[f64; 4]>) -> Option<Step> {
    if samples.len() == task.grid.count {
        return run.step();
    }
    let leg = run.next()?;
    sample(task, &leg, samples);
    Some(match leg.exit() {
        Exit::Switch(next) => Step::Switch { duration: leg.duration_two_word(), next: *next },
        Exit::Horizon | Exit::Endless(_) => Step::Last(Box::new(leg)),
    })
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
