//! The oscillator written down as any other system is run like the oscillator itself.

use super::{AskedRun, Task, accuracy, every_on};
use crate::case::Given;
use crate::engine::{
    Ended, Event, GuardSample, Limits, OscillatorEvent, OscillatorOutcome, OscillatorTask, Outcome,
    SampleGrid, Watched, answer_oscillator, percussive,
};
use crate::equations::Numbers;
use crate::integrators::all;
use crate::system::Values;
use percuss::{Phase, Start};

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

const MODES: [Phase; 3] = [Phase::NoContact, Phase::Contact, Phase::Progression];

fn place(phase: Phase) -> usize {
    MODES.iter().position(|mode| *mode == phase).unwrap_or(MODES.len())
}

/// Both find the same events, at times that are as near to each other as both are to the truth.
#[test]
fn both_ways_of_writing_it_down_are_run_alike() {
    let task = task();
    let Ok(by_hand) = Task::of_oscillator(&task) else { unreachable!("it is a system") };
    let system = Task { oscillator: None, ..by_hand };
    let mut compared = 0;
    for (name, unit, outcome) in every_on(&system) {
        let outcome: Outcome = outcome.unwrap_or_default();
        let Some(engine) = all().iter().find(|it| it.declaration().name == name) else { continue };
        let Some(accuracy) = accuracy(*engine) else { continue };
        let own =
            answer_oscillator(*engine, &task, accuracy, &Limits::default()).unwrap_or_default();
        let word = |it: &OscillatorEvent| (it.event, place(it.mode));
        let words: Vec<_> = own.events.iter().map(word).collect();
        let others: Vec<_> = outcome.events.iter().map(|it| (it.event, it.mode)).collect();
        assert!(words.len() > 4 && words == others, "{name}: {words:?} {others:?}");
        for (one, other) in own.events.iter().zip(&outcome.events) {
            let apart = (one.elapsed - other.elapsed).abs() / (1.0 + one.elapsed);
            assert!(apart <= 20.0 * unit, "{name}: {apart:e} at {}", one.elapsed);
        }
        let (work, end) = (outcome.work, outcome.end);
        let back = OscillatorOutcome::of_system(outcome).unwrap_or_default();
        let phases = |outcome: &OscillatorOutcome| -> Vec<_> {
            outcome.events.iter().map(|it| it.mode).collect()
        };
        assert_eq!((phases(&back), back.samples.len()), (phases(&own), 17), "{name}");
        assert_eq!((back.end.as_slice(), back.work), (&*end, work), "{name}");
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

/// An answer in the oscillator's words says all that it says as a system's, its record too.
#[test]
fn an_answer_is_the_same_in_both_words() {
    let task = task();
    let window = [0.3 * task.span, 0.6 * task.span];
    let instants = vec![0.4 * task.span, 0.5 * task.span];
    let task = OscillatorTask { watched: Some(Watched { window, instants }), ..task };
    let Ok(asked) = Task::of_oscillator(&task) else { unreachable!("it is a system") };
    for engine in all() {
        let Some(accuracy) = accuracy(*engine) else { continue };
        let found = engine.run(&asked, accuracy, &Limits::default()).unwrap_or_default();
        let own = OscillatorOutcome::of_system(found.clone()).unwrap_or_default();
        let name = engine.declaration().name;
        assert!(own.trace.as_ref().is_some_and(|trace| trace.looks.len() > 2), "{name}");
        let again = Outcome::from(own);
        assert_eq!((&again.events, &again.samples), (&found.events, &found.samples), "{name}");
        assert_eq!((&again.trace, again.end), (&found.trace, found.end), "{name}");
    }
}

/// The oscillator has three phases, four states and no end but its horizon.
#[test]
fn what_is_no_run_of_the_oscillator_is_refused() {
    let state = Values::of(&[0.5; 4]);
    let event = Event { event: 0, mode: 1, elapsed: 0.5, state, before: Some(state) };
    let run = Outcome { events: vec![event], end: state, ..Outcome::default() };
    assert!(OscillatorOutcome::of_system(run.clone()).is_ok());
    let early = Outcome { ended: Ended::NoProgress, ..run.clone() };
    let mode = Outcome { events: vec![Event { mode: 3, ..event }], ..run.clone() };
    let size = Outcome { end: Values::of(&[0.5; 3]), ..run };
    for odd in [early, mode, size] {
        let said = format!("{odd:?}");
        assert!(OscillatorOutcome::of_system(odd).is_err(), "{said}");
    }
}
