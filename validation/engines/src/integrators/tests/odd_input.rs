//! Libraries on odd input: every engine returns, with a result or a reason.

use crate::case::Given;
use crate::engine::{
    Accuracy, Engine, Limits, OscillatorTask, SampleGrid, Stepping, Task, contain,
    hush_contained_panics,
};
use crate::integrators::all;
use percuss::{Phase, Start};
use std::sync::Arc;
use std::time::Duration;

const LIMITS: Limits = Limits { calls: 200_000, events: 1_000, wall: Duration::from_secs(60) };

/// Four forcing periods of the default model from rest.
fn task() -> Option<OscillatorTask> {
    let given = Given { start: Start::default(), ..Given::default() };
    let problem = given.check().ok()?;
    let horizon = problem.entry.instant.after_periods(4, 1);
    let grid = SampleGrid { per_period: 4, count: 17 };
    Some(OscillatorTask::until(given.parameters, problem, horizon, grid))
}

/// A usual choice for an engine.
fn usual_accuracy(engine: &dyn Engine) -> Accuracy {
    match engine.declaration().stepping {
        Stepping::Exact => Accuracy::Exact,
        Stepping::Fixed { .. } => Accuracy::Step(0.25),
        _ => Accuracy::Tolerance(1e-6),
    }
}

/// Runs every integrator on a task that was made odd after it had been checked; the exact solver
/// has its own checks of input.
fn run_each(
    mut odd: impl FnMut(&mut OscillatorTask),
    accuracy: Option<Accuracy>,
) -> Vec<(String, bool)> {
    hush_contained_panics();
    let integrators = all().iter().filter(|it| it.declaration().stepping != Stepping::Exact);
    let outcomes = integrators.filter_map(|engine| {
        let mut task = Task::of_oscillator(&task()?).ok()?;
        odd(Arc::make_mut(task.oscillator.as_mut()?));
        let accuracy = accuracy.unwrap_or_else(|| usual_accuracy(*engine));
        let outcome = contain(|| engine.run(&task, accuracy, &LIMITS));
        Some((engine.declaration().name.to_owned(), outcome.is_ok()))
    });
    outcomes.collect()
}

fn none_succeeds(outcomes: &[(String, bool)]) -> bool {
    !outcomes.is_empty() && outcomes.iter().all(|(_, ok)| !ok)
}

#[test]
fn usual_input_succeeds() {
    let outcomes = run_each(|_| {}, None);
    assert!(outcomes.len() >= 17 && outcomes.iter().all(|(_, ok)| *ok), "{outcomes:?}");
}

#[test]
fn a_forcing_that_is_nan_fails() {
    let outcomes = run_each(|task| task.forcing_angle = f64::NAN, None);
    assert!(none_succeeds(&outcomes), "{outcomes:?}");
}

#[test]
fn a_state_that_is_not_finite_fails() {
    for odd in [f64::NAN, f64::INFINITY] {
        let outcomes = run_each(|task| task.state[1] = odd, None);
        assert!(none_succeeds(&outcomes), "{odd} {outcomes:?}");
    }
}

#[test]
fn accuracies_that_cannot_be_met_come_back() {
    for odd in [0.0, f64::NAN, -1.0] {
        assert!(none_succeeds(&run_each(|_| {}, Some(Accuracy::Tolerance(odd)))));
        assert!(none_succeeds(&run_each(|_| {}, Some(Accuracy::Step(odd)))));
    }
    // Below rounding: any answer will do, but one there has to be.
    run_each(|_| {}, Some(Accuracy::Tolerance(1e-300)));
    run_each(|_| {}, Some(Accuracy::Step(1e-300)));
}

#[test]
fn relaxation_too_fast_for_a_method_comes_back() {
    run_each(
        |task| {
            task.parameters.xi = 1e-8;
            task.state = [-1.0, 0.0, 0.5, 0.0];
            task.phase = Phase::NoContact;
        },
        None,
    );
}
