//! The exact solver, as an engine among others: on the oscillator here, on any piecewise-affine
//! system in `system.rs`, and many motions at once in `lanes.rs`.

mod lanes;
mod system;

pub use lanes::run_in_lanes;
pub use system::end_of_exact_run;

use crate::accuracy::{Accuracy, Stepping};
use crate::engine::{
    Colours, Declaration, Engine, Event, Limits, Location, OscillatorTask, Outcome, REFERENCE,
    Role, Task, Work, place,
};
use crate::equations::Numbers;
use crate::failure::Failure;
use crate::integration::event_between;
use crate::integrators::pins;
use crate::system::Values;
use percuss::TwoWord;
use percuss::{Entry, Exit, Phase, Sample, Segment, Step, Trajectory};

/// The closed forms, joined at proved first crossings.
pub(super) struct Exact;

impl Engine for Exact {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: REFERENCE,
            library: "percuss",
            version: pins::version("percuss"),
            method: "closed forms, certified first crossing",
            class: None,
            order: None,
            events: Location::Proved,
            dense_output: true,
            stepping: Stepping::Exact,
            role: Role::Representative,
            colours: Colours::Ink,
        }
    }

    fn differentiates(&self) -> bool {
        true
    }

    fn run(&self, task: &Task, _: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        match &task.oscillator {
            Some(own) => run(own, limits),
            None => system::run(task, limits),
        }
    }
}

/// Runs a task of the oscillator by the oscillator's own closed forms.
fn run(task: &OscillatorTask, limits: &Limits) -> Result<Outcome, Failure> {
    let events = Vec::with_capacity(RESERVED_EVENTS);
    let mut outcome = Outcome { events, ended_at: task.span, ..Outcome::default() };
    let mut run = task.problem.model.trajectory(task.problem.entry).until(task.horizon);
    let mut elapsed = TwoWord::ZERO;
    let mut before = task.phase;
    loop {
        let (duration, phase, state) = match sampled_phase(task, &mut run, &mut outcome.samples) {
            Some(PassedPhase::Switch { duration, phase, state }) => (duration, phase, state),
            Some(PassedPhase::Last(segment)) => {
                if segment.is_undecided_at(&task.horizon) {
                    return Err(Failure::new("rounding hides how a phase ends"));
                }
                outcome.end = state_of(&segment.at_instant(&task.horizon));
                break;
            }
            None => break,
        };
        elapsed = elapsed.plus(duration);
        let (event, mode) = (event_between(before, phase), place(phase));
        let (elapsed, state) = (elapsed.value(), Values::from_slice(&state));
        outcome.events.push(Event { event, mode, elapsed, state, before: None });
        before = phase;
        if outcome.events.len() > limits.events {
            return Err(Failure::new(format!("gave up after {} events", limits.events)));
        }
    }
    outcome.work = Work {
        rhs_evaluations: run.counters().evaluations,
        steps: outcome.events.len() as u64 + 1,
        ..Work::default()
    };
    Ok(outcome)
}

/// The number of events for which a run reserves memory at first.
const RESERVED_EVENTS: usize = 128;

/// A phase, passed.
enum PassedPhase {
    /// The phase lasts for `duration`; then another phase begins in the given state.
    Switch { duration: TwoWord, phase: Phase, state: [f64; 4] },
    /// The last phase of the run.
    Last(Box<Segment>),
}

impl PassedPhase {
    fn by_switch(duration: TwoWord, next: &Entry) -> Self {
        let state = [next.state.p, next.state.y, next.state.q, next.v()];
        Self::Switch { duration, phase: next.phase(), state }
    }
}

/// The run's next phase, sampled as long as samples are asked for.
fn sampled_phase(
    task: &OscillatorTask,
    run: &mut Trajectory,
    samples: &mut Vec<Values>,
) -> Option<PassedPhase> {
    if samples.len() == task.grid.count {
        return Some(match run.step()? {
            Step::Switch { duration, next } => PassedPhase::by_switch(duration, next),
            Step::Last(segment) => PassedPhase::Last(segment),
        });
    }
    let segment = run.next()?;
    sample(task, &segment, samples);
    Some(match segment.exit() {
        Exit::Switch(next) => PassedPhase::by_switch(segment.duration_two_word(), next),
        _ => PassedPhase::Last(Box::new(segment)),
    })
}

/// The grid's instants that lie in this phase.
fn sample(task: &OscillatorTask, segment: &Segment, samples: &mut Vec<Values>) {
    let start = task.problem.entry.instant;
    while samples.len() < task.grid.count {
        let instant = start.after_periods(samples.len() as u64, u64::from(task.grid.per_period));
        if segment.ends_by(&instant) {
            return;
        }
        samples.push(state_of(&segment.at_instant(&instant)));
    }
}

fn state_of(sample: &Sample) -> Values {
    Values::from_slice(&[sample.state.p, sample.state.y, sample.state.q, sample.v])
}
