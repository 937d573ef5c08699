//! The first wrong event of each row, with the run of the engine and the true run around it.
//!
//! An engine of this process is run once more and watched around the event: its states, the ends of
//! its steps, and what its root finder saw. Of every other answer, of a program or of files, and of
//! a run that took too long to be made again, the states are the exact continuations of its own
//! records. The true run is the exact solver's in 106 bits.

mod choice;
mod mismatch;
mod scales;

pub use choice::first_wrong_events;
pub use mismatch::{EventMismatch, MismatchKind};
pub use scales::view_instants;

use super::{PreparedCase, Scored, Status, Suite};
use crate::engine::{Engine, GuardSample, Outcome, Task, Watched, contain};
use crate::truth::Truth;
use scales::Scales;

/// A first wrong event, with what is known of truth and engine around it.
pub struct FirstWrongEvent<'a> {
    /// The row.
    pub row: &'a Scored,
    /// The row's case.
    pub prepared: &'a PreparedCase,
    /// The event.
    pub mismatch: EventMismatch,
    /// The ranges of the views, times since the start, from the widest to the closest.
    pub spans: Vec<[f64; 2]>,
    /// The instants of all views, times since the start, ascending.
    pub instants: Vec<f64>,
    /// The true states at the instants.
    pub truth: Vec<Vec<f64>>,
    /// The engine's run.
    pub engine: EngineMotion,
}

/// The run of an engine around its first wrong event.
pub struct EngineMotion {
    /// The engine's answer.
    pub outcome: Outcome,
    /// The engine's states at the instants; none where an engine does not record them.
    pub states: Vec<Vec<f64>>,
    /// The ends of the engine's accepted steps, where they are known.
    pub steps: Vec<f64>,
    /// The looks of the engine's root finder at guards, where they are known.
    pub looks: Vec<GuardSample>,
}

impl<'a> FirstWrongEvent<'a> {
    /// Observes truth and engine around an event: the engine's run `again`, or else by the exact
    /// continuation of its records; none where either cannot be had.
    fn observed(
        (prepared, row): (&'a PreparedCase, &'a Scored),
        mismatch: EventMismatch,
        again: Option<&dyn Engine>,
    ) -> Option<Self> {
        let PreparedCase { task, case, .. } = prepared;
        let Status::Ok(_, outcome) = &row.status else { return None };
        let mean_step = task.span / outcome.work.steps.max(1) as f64;
        let around = (mismatch.at, mismatch.reach);
        let scales = Scales::around(around, mean_step, prepared.period(), task.span);
        let instants = scales.all_instants();
        let truth = Truth::states(case, &instants)?;
        let engine = match again {
            Some(engine) => watched_again((prepared, row), engine, scales.window(), &instants)?,
            None => EngineMotion {
                outcome: outcome.as_ref().clone(),
                states: prepared.local.continued_states(task, outcome, &instants),
                steps: Vec::new(),
                looks: Vec::new(),
            },
        };
        Some(Self { row, prepared, mismatch, spans: scales.spans, instants, truth, engine })
    }
}

/// Runs an engine again and watches it.
fn watched_again(
    (prepared, row): (&PreparedCase, &Scored),
    engine: &dyn Engine,
    window: [f64; 2],
    instants: &[f64],
) -> Option<EngineMotion> {
    let watched = Watched { window, instants: instants.to_vec() };
    let again = Task { watched: Some(watched), ..prepared.task.clone() };
    let limits = Suite::limits(&prepared.case);
    let mut outcome = contain(|| engine.run(&again, row.accuracy, &limits)).ok()?;
    let samples = std::mem::take(&mut outcome.samples);
    let Some(trace) = outcome.trace.take() else {
        let motion =
            EngineMotion { outcome, states: Vec::new(), steps: Vec::new(), looks: Vec::new() };
        return Some(motion);
    };
    let states = samples.iter().map(|state| state.to_vec()).collect();
    Some(EngineMotion { outcome, states, steps: trace.steps, looks: trace.looks })
}
