//! The paper's motions by an integrator: a second method, which knows no closed form.

use super::attractors::start;
use super::paper::attractors_model;
use crate::engine::{Accuracy, Engine, Failure, Limits, Location, Role, Stepping, Task, answer};
use crate::integrators;
use crate::score::attractor::run_of;
use percuss::dynamics::strobe::StrobePoint;

/// The adaptive integrators that stand for their libraries.
pub(super) fn representatives() -> Vec<&'static dyn Engine> {
    let stands = |engine: &&&dyn Engine| {
        let it = engine.declaration();
        let adaptive = !matches!(it.stepping, Stepping::Exact | Stepping::Fixed { .. });
        it.role == Role::Representative && adaptive
    };
    integrators::all().iter().filter(stands).copied().collect()
}

/// The first of [`representatives`] whose events are located on its own dense output.
pub(super) fn integrator() -> Result<&'static dyn Engine, Failure> {
    let located = |engine: &&dyn Engine| engine.declaration().events == Location::Harness;
    let found = representatives().into_iter().find(located);
    found.ok_or_else(|| Failure::new("no integrator has its events located on dense output"))
}

/// The integrator and its tolerance as evidence names them, and (p, y, q, v) at the strobes of the
/// motion from a point, that one included.
pub(super) fn strobes(
    omega: f64,
    point: StrobePoint,
    periods: u32,
    tolerance: f64,
) -> Result<(String, Vec<[f64; 4]>), Failure> {
    let engine = integrator()?;
    let name = engine.declaration().name;
    let task = run_of(attractors_model(omega), start(point), periods);
    let task = task.ok_or_else(|| Failure::new("the start is refused"))?;
    let limits = Limits { calls: 1_000_000_000, ..Limits::default() };
    let task = Task::of_oscillator(&task)?;
    let outcome = answer(engine, &task, Accuracy::Tolerance(tolerance), &limits)?;
    let strobes = outcome.samples.iter().map(|it| [it[0], it[1], it[2], it[3]]).collect();
    Ok((format!("{name}, tolerance {tolerance:e}"), strobes))
}
