//! diffsol's sensitivities as an expert takes them through events: each stretch between two of them
//! is run again by a fresh solver with its sensitivities in the error control.

use crate::percuss_program::derivatives::{Stretch, sum};
use crate::percuss_program::{Course, saltation};
use diffsol::{
    NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquationsImplicitSens,
    OdeSolverStopReason, SensitivitiesOdeSolverMethod,
};
use std::error::Error;

/// Steps to the stop time; the derivatives there, a list for each name.
fn to_the_end<'a, Eqn>(
    course: &Course,
    mut solver: impl SensitivitiesOdeSolverMethod<'a, Eqn>,
    end: f64,
) -> Result<Vec<Vec<f64>>, Box<dyn Error>>
where
    Eqn: OdeEquationsImplicitSens<T = f64, V = NalgebraVec<f64>> + 'a,
{
    solver.set_stop_time(end)?;
    while !matches!(solver.step()?, OdeSolverStopReason::TstopReached) {
        course.within_limits()?;
    }
    let names = course.run.gradients.len();
    Ok((0..names).map(|n| solver.state().s.batch_as_slice(n).to_vec()).collect())
}

/// Derivatives at fixed times along a stretch without events.
fn along(
    course: &Course,
    stretch: &Stretch<'_>,
    states: Vec<Vec<f64>>,
) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let Stretch { mode, begin, state, end } = *stretch;
    let (by, size) = (&course.run.gradients, state.len());
    let (relative, absolute) = (course.run.tolerance.relative, course.run.tolerance.absolute);
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .t0(begin)
        .rtol(relative)
        .atol([absolute])
        .sens_rtol(relative)
        .sens_atol([absolute])
        .p(by.iter().map(|it| it.value))
        .rhs_sens_implicit(
            |z, _, t, out| out.copy_from_slice(&mode.rates(t, z)),
            |_, _, _, v, out| out.copy_from_slice(&mode.jacobian(v)),
            |z, _, t, v, out| out.copy_from_slice(&sum(v, size, |n| by[n].field(mode, t, z))),
        )
        .init_sens(
            |_, _, out| out.copy_from_slice(state),
            |_, _, v, out| out.copy_from_slice(&sum(v, size, |n| states[n].clone())),
            size,
        )
        .build()?;
    if course.run.setup.starts_with("bdf") {
        to_the_end(course, problem.bdf_sens::<NalgebraLU<f64>>()?, end)
    } else {
        to_the_end(course, problem.tsit45_sens()?, end)
    }
}

/// Makes a run, with its derivatives where they are asked for.
pub fn make(course: &mut Course) -> Result<(), Box<dyn Error>> {
    let engine = format!("diffsol-{}", course.run.setup.trim_end_matches("-saltation"));
    saltation::make(course, &engine, along)
}
