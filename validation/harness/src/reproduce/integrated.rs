//! The motions of Figs. 7 to 10 by an integrator: a second method, which knows no closed form.

use super::attractors::start;
use super::paper::attractors_model;
use crate::engine::{self, Accuracy, Failure, Limits};
use crate::score::attractor::run_of;
use percuss::dynamics::strobe::StrobePoint;

/// The integrator.
pub(super) const NAME: &str = "ode_solvers-dopri5";

/// (p, y, q, v) at the strobes of the motion from a point, that one included.
pub(super) fn strobes(
    omega: f64,
    point: StrobePoint,
    periods: u32,
    tolerance: f64,
) -> Result<Vec<[f64; 4]>, Failure> {
    let named = engine::all().iter().find(|it| it.declaration().name == NAME);
    let engine = named.ok_or_else(|| Failure::new(format!("no engine is called {NAME}")))?;
    let task = run_of(attractors_model(omega), start(point), periods);
    let task = task.ok_or_else(|| Failure::new("the start is refused"))?;
    let limits = Limits { calls: 1_000_000_000, ..Limits::default() };
    let outcome = engine.run(&task, Accuracy::Tolerance(tolerance), &limits)?;
    if outcome.samples.len() != task.grid.count {
        return Err(Failure::new(format!("{NAME} did not give all strobes")));
    }
    Ok(outcome.samples)
}
