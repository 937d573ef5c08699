//! diffsol with its own root finding as its book's bouncing ball has it, run by percuss: steps
//! until a root is found, the interpolated state there, the event's own change of it, and a start
//! from there; the tolerances, and nothing else. What an expert adds is percuss's own engine
//! `diffsol-bdf`.
//!
//! Roots have no direction. One that the guard leaves on the wrong side is passed over.

mod percuss_program;

use diffsol::{
    NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations, OdeSolverMethod,
    OdeSolverStopReason,
};
use percuss_program::{Course, serve};
use std::error::Error;

type Vector = NalgebraVec<f64>;

fn values(z: &Vector) -> Vec<f64> {
    z.batch_as_slice(0).to_vec()
}

/// Steps to the first root.
fn stretch<'a, Eqn>(
    course: &mut Course,
    mut solver: impl OdeSolverMethod<'a, Eqn>,
) -> Result<(), Box<dyn Error>>
where
    Eqn: OdeEquations<T = f64, V = Vector> + 'a,
{
    let span = course.run.span;
    solver.set_stop_time(span)?;
    loop {
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
                return Ok(());
            }
            OdeSolverStopReason::RootFound(root, place) => {
                let mode = course.mode();
                let state = values(&solver.interpolate(root)?);
                let after = mode.guard(place, solver.state().t, &values(solver.state().y));
                if mode.events()[place].sign() * after >= 0.0 {
                    return course.event(root, place, state);
                }
                (course.t, course.z) = (root, state);
                return Ok(());
            }
        }
    }
}

fn make(course: &mut Course) -> Result<(), Box<dyn Error>> {
    while course.goes_on() {
        let mode = course.mode();
        let [rates, jacobian, guards] = [0; 3].map(|_| course.mode());
        let (z, size) = (course.z.clone(), course.z.len());
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .t0(course.t)
            .rtol(course.run.tolerance.relative)
            .atol([course.run.tolerance.absolute])
            .rhs_implicit(
                move |z, _, t, out| out.copy_from_slice(&rates.rates(t, z)),
                move |_, _, _, v, out| out.copy_from_slice(&jacobian.jacobian(v)),
            )
            .init(move |_, _, out| out.copy_from_slice(&z), size)
            .root(
                move |z, _, t, out| {
                    for (place, out) in out.iter_mut().enumerate() {
                        *out = guards.guard(place, t, z);
                    }
                },
                mode.events().len(),
            )
            .build()?;
        if course.run.setup.starts_with("bdf") {
            stretch(course, problem.bdf::<NalgebraLU<f64>>()?)?;
        } else {
            stretch(course, problem.tsit45()?)?;
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let setups = [
        ("bdf-default", "BDF, orders 1 to 5", None),
        ("tsit45-default", "Tsitouras 5(4)", Some(5)),
    ];
    serve("diffsol", "0.18.0", &setups, make)
}
