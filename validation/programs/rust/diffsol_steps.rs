//! The steps of a run by diffsol, from root to root.

use crate::percuss_program::Course;
use diffsol::{NalgebraVec, OdeEquations, OdeSolverMethod, OdeSolverStopReason};
use std::error::Error;

pub type Vector = NalgebraVec<f64>;

pub fn values(z: &Vector) -> Vec<f64> {
    z.batch_as_slice(0).to_vec()
}

/// Runs to the end; `at_root` takes a root by its time and the guard's place.
pub fn run<'a, Eqn, S>(
    course: &mut Course,
    solver: &mut S,
    mut at_root: impl FnMut(&mut Course, &mut S, (f64, usize)) -> Result<(), Box<dyn Error>>,
) -> Result<(), Box<dyn Error>>
where
    Eqn: OdeEquations<T = f64, V = Vector> + 'a,
    S: OdeSolverMethod<'a, Eqn>,
{
    let span = course.run.span;
    solver.set_stop_time(span)?;
    while course.goes_on() {
        let reason = solver.step()?;
        course.step()?;
        let reached = match reason {
            OdeSolverStopReason::RootFound(root, _) => root,
            _ => solver.state().t,
        };
        while let Some(time) = course.due(reached) {
            let state = values(&solver.interpolate(time)?);
            course.sample(state);
        }
        match reason {
            OdeSolverStopReason::InternalTimestep => {}
            OdeSolverStopReason::TstopReached => {
                (course.t, course.z) = (span, values(solver.state().y));
            }
            OdeSolverStopReason::RootFound(root, place) => at_root(course, solver, (root, place))?,
        }
    }
    Ok(())
}
