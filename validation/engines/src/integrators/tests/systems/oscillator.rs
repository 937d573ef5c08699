//! The oscillator written down as any other system is run like the oscillator itself.

use super::{AskedRun, Task, accuracy, every_on};
use crate::case::Given;
use crate::engine::{
    GuardSample, Limits, OscillatorTask, Outcome, SampleGrid, Watched, answer, percussive, place,
};
use crate::integrators::all;
use percuss::Start;

/// Four forcing periods of the default model from rest.
fn task() -> OscillatorTask {
    let given = Given { start: Start::default(), ..Given::default() };
    let Ok(problem) = given.check() else { unreachable!("the default model is accepted") };
    let horizon = problem.entry.instant.after_periods(4, 1);
    OscillatorTask::until(
        given.parameters,
        problem,
        horizon,
        SampleGrid { per_period: 4, count: 17 },
    )
}

/// Both find the same events, at times that are as near to each other as both are to the truth.
#[test]
fn both_ways_of_writing_it_down_are_run_alike() {
    let task = task();
    let Ok(by_hand) = Task::of_oscillator(&task) else { unreachable!("it is a system") };
    let system = Task { oscillator: None, ..by_hand.clone() };
    let mut compared = 0;
    for (name, unit, outcome) in every_on(&system) {
        let outcome: Outcome = outcome.unwrap_or_default();
        let Some(engine) = all().iter().find(|it| it.declaration().name == name) else { continue };
        let Some(accuracy) = accuracy(*engine) else { continue };
        let own = answer(*engine, &by_hand, accuracy, &Limits::default()).unwrap_or_default();
        let words = |outcome: &Outcome| -> Vec<_> {
            outcome.events.iter().map(|it| (it.event, it.mode)).collect()
        };
        assert!(own.events.len() > 4, "{name}");
        assert_eq!(words(&own), words(&outcome), "{name}");
        for (one, other) in own.events.iter().zip(&outcome.events) {
            let apart = (one.elapsed - other.elapsed).abs() / (1.0 + one.elapsed);
            assert!(apart <= 20.0 * unit, "{name}: {apart:e} at {}", one.elapsed);
        }
        assert_eq!((own.samples.len(), outcome.samples.len()), (17, 17), "{name}");
        compared += 1;
    }
    assert_eq!(compared, 15);
}

#[test]
fn a_run_that_is_watched_is_the_same_run() {
    let task = task();
    let system = percussive(&task.parameters, task.forcing_angle);
    let mode = place(task.phase);
    let asked = AskedRun { system: &system, mode, state: &task.state, span: task.span };
    let plain = asked.task();
    let window = [0.3 * task.span, 0.6 * task.span];
    let instants = vec![0.4 * task.span, 0.5 * task.span];
    let watched = Task { watched: Some(Watched { window, instants }), ..plain.clone() };
    for engine in all() {
        let Some(accuracy) = accuracy(*engine) else { continue };
        let name = engine.declaration().name;
        let run = |task| engine.run(task, accuracy, &Limits::default()).unwrap_or_default();
        let (plain, watched) = (run(&plain), run(&watched));
        let before = |outcome: &Outcome| -> Vec<_> {
            outcome.events.iter().copied().filter(|it| it.elapsed <= window[1]).collect()
        };
        assert!(!before(&plain).is_empty() && before(&plain) == before(&watched), "{name}");
        let trace = watched.trace.unwrap_or_default();
        let has = |look: &GuardSample| {
            look.guard < system.modes[look.mode].until.len() && look.t <= window[1]
        };
        assert!(trace.steps.len() > 2 && trace.looks.len() > 2, "{name}");
        assert!(trace.looks.iter().all(has) && watched.samples.len() == 2, "{name}");
    }
}
