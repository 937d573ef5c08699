//! A run that is watched is the run that is scored.

use crate::case::Given;
use crate::engine::{
    Accuracy, Engine, Event, Limits, OscillatorTask, Outcome, SampleGrid, Stepping, Task, Watched,
    answer,
};
use crate::integrators::all;
use percuss::Start;

/// Four forcing periods of the default model from rest.
fn task() -> Option<Task> {
    let given = Given { start: Start::default(), ..Given::default() };
    let problem = given.check().ok()?;
    let horizon = problem.entry.instant.after_periods(4, 1);
    let grid = SampleGrid { per_period: 4, count: 17 };
    Task::of_oscillator(&OscillatorTask::until(given.parameters, problem, horizon, grid)).ok()
}

fn accuracy(engine: &dyn Engine) -> Option<Accuracy> {
    match engine.declaration().stepping {
        Stepping::Exact => None,
        Stepping::Fixed { .. } => Some(Accuracy::Step(0.25)),
        _ => Some(Accuracy::Tolerance(1e-6)),
    }
}

#[test]
fn watching_changes_no_event_and_sees_every_integrator_at_work() {
    let Some(task) = task() else { unreachable!("the default model is accepted") };
    let window = [0.3 * task.span, 0.6 * task.span];
    let instants: Vec<f64> =
        (0..=60).map(|k| window[0] + 0.005 * f64::from(k) * task.span).collect();
    let watched = Watched { window, instants: instants.clone() };
    let again = Task { watched: Some(watched), ..task.clone() };
    let mut seen = 0;
    for engine in all() {
        let name = engine.declaration().name;
        let Some(accuracy) = accuracy(*engine) else { continue };
        let run = |task| answer(*engine, task, accuracy, &Limits::default());
        let (Ok(plain), Ok(watched)) = (run(&task), run(&again)) else { unreachable!("{name}") };
        let before = |outcome: &Outcome| -> Vec<Event> {
            outcome.events.iter().copied().filter(|it| it.elapsed <= window[1]).collect()
        };
        assert_eq!(before(&plain), before(&watched), "{name}");
        assert!(!before(&plain).is_empty() && plain.trace.is_none(), "{name}");
        assert_eq!(watched.samples.len(), instants.len(), "{name}");
        let trace = watched.trace.unwrap_or_default();
        let inside = |t: f64| window[0] <= t && t <= window[1];
        assert!(trace.steps.iter().all(|t| inside(*t)), "{name}");
        assert!(trace.looks.iter().all(|look| inside(look.t) && look.value.is_finite()), "{name}");
        // A search looks at the guards at the end of each step at least, or at the event in it.
        assert!(trace.steps.len() > 2 && trace.looks.len() >= trace.steps.len(), "{name}");
        assert!(trace.steps.is_sorted(), "{name}");
        seen += 1;
    }
    assert!(seen >= 17, "{seen}");
}
