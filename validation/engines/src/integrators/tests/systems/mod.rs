//! Every integrator on systems that are not the oscillator, against closed forms.

mod events;
mod known_events;
mod models;
mod oscillator;
mod truth;

use crate::accuracy::{Accuracy, Stepping};
use crate::engine::{Engine, Limits, Outcome, Task, answer, hush_contained_panics};
use crate::failure::Failure;
use crate::integrators::all;
use crate::system::{CheckedSystem, System};
use std::sync::Arc;

/// The tolerance that every integrator is asked for.
const TOLERANCE: f64 = 1e-8;
/// Fixed steps whose own error is about the tolerance: step^4/120.
const FIXED_STEP: f64 = 1.0 / 32.0;

/// A run that is asked for.
pub(super) struct AskedRun<'a> {
    pub(super) system: &'a System,
    pub(super) mode: usize,
    pub(super) state: &'a [f64],
    pub(super) span: f64,
}

impl AskedRun<'_> {
    fn task(&self) -> Task {
        let system = CheckedSystem::new(self.system.clone());
        let Ok(system) = system else { unreachable!("{:?}", system.err()) };
        let samples = (0..=SAMPLES).map(|k| self.span * f64::from(k) / f64::from(SAMPLES));
        let samples = samples.collect();
        let task = Task::new(Arc::new(system), self.mode, self.state, self.span, samples);
        let Ok(task) = task else { unreachable!("{:?}", task.err()) };
        task
    }

    /// The events by the closed form.
    fn truth(&self, step: f64) -> Vec<truth::TrueEvent> {
        truth::SteppedClosedForm::new(self.system, step).run(self.mode, self.state, self.span).0
    }
}

/// Samples of each run, after the one at its start.
const SAMPLES: u32 = 50;

/// The answer of each integrator to a run, with its unit of error.
fn every(asked: &AskedRun<'_>) -> Vec<EngineAnswer> {
    every_on(&asked.task())
}

/// What is asked of an engine, if it is an integrator and in no co-ordinates of the oscillator's
/// own.
fn accuracy(engine: &dyn Engine) -> Option<Accuracy> {
    let declaration = engine.declaration();
    match declaration.stepping {
        _ if declaration.name.ends_with("-original") => None,
        Stepping::Exact => None,
        Stepping::Fixed { .. } => Some(Accuracy::Step(FIXED_STEP)),
        _ => Some(Accuracy::Tolerance(TOLERANCE)),
    }
}

/// An integrator's name, its unit of error, and its answer.
type EngineAnswer = (&'static str, f64, Result<Outcome, Failure>);

fn every_on(task: &Task) -> Vec<EngineAnswer> {
    hush_contained_panics();
    let one = |engine: &&'static dyn Engine| {
        let declaration = engine.declaration();
        let accuracy = accuracy(*engine)?;
        let limits = Limits { calls: 3_000_000, ..Limits::default() };
        let outcome = answer(*engine, task, accuracy, &limits);
        Some((declaration.name, declaration.stepping.unit(accuracy), outcome))
    };
    all().iter().filter_map(one).collect()
}

/// Where a run differs from the truth: the first event that is another one, or whose time is
/// further off than `most` units of error times the number of events so far.
fn departure(
    outcome: &Outcome,
    truth: &[truth::TrueEvent],
    (unit, time_scale): (f64, f64),
    most: f64,
) -> Option<String> {
    for (n, (event, mode, t)) in truth.iter().enumerate() {
        let Some(found) = outcome.events.get(n) else {
            return Some(format!("event {n} of {} is missed", truth.len()));
        };
        if (found.event, found.mode) != (*event, *mode) {
            let other = (found.event, found.mode, found.elapsed);
            return Some(format!("event {n} is {other:?}, not {:?}", (event, mode, t)));
        }
        let error = (found.elapsed - t).abs() / (unit * (time_scale + t) * (n + 1) as f64);
        if error > most || error.is_nan() {
            return Some(format!("event {n} at {t} is {error:.1} units of error off"));
        }
    }
    let more = outcome.events.get(truth.len())?;
    Some(format!("a spurious event {} at {}", more.event, more.elapsed))
}

/// This engine's library stops its search for roots after a few evaluations: times are off by up
/// to a twentieth.
const LOOSE_ROOTS_ENGINE: &str = "differential-equations-rkv655e-events";
/// This engine is of first order where the system is forced, as its library ships it.
const FIRST_ORDER_ENGINE: &str = "ode_solvers-dop853";

/// Checks every integrator against the truth, but for those that are `excused`: these depart, each
/// for the reason that its name here says.
fn check(asked: &AskedRun<'_>, truth: &[truth::TrueEvent], most: f64, excused: &[&str]) {
    let mut departures = Vec::new();
    for (name, unit, outcome) in every(asked) {
        let departure = match outcome {
            Ok(outcome) => {
                assert_eq!(outcome.samples.len(), SAMPLES as usize + 1, "{name}");
                departure(&outcome, truth, (unit, asked.system.time_scale), most)
            }
            Err(failure) => Some(failure.reason),
        };
        departures.extend(departure.map(|what| (name, what)));
    }
    let names: Vec<&str> = departures.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, excused, "{}: {departures:#?}", asked.system.name);
}
