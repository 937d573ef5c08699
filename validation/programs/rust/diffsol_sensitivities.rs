//! diffsol's forward sensitivities through events, as its documentation has them: closures with
//! their derivatives, `bdf_sens` or `tsit45_sens`, and at a root what `solve_dense_sensitivities`
//! does there: `state_mut_back`, `apply_reset_with_sens`, and the stop time again.
//!
//! - Sensitivities are outside of the error control, as they are by default.
//! - The right-hand side is that of the mode that follows before the reset is applied, as in the
//!   book's hybrid models; root functions and the reset are those of the mode that is left.
//! - diffsol has no derivative of an event's time: that of the end alone is answered.
//! - A root that is passed over or only counted needs no reset. The rates of the state and of its
//!   sensitivities there are written by this program.

use crate::diffsol_steps::{self, Vector, values};
use crate::percuss_program::derivatives::{Rates, sum};
use crate::percuss_program::{Course, Mode};
use diffsol::{
    NalgebraLU, NalgebraMat, OdeBuilder, OdeEquationsImplicitSens, SensitivitiesOdeSolverMethod,
};
use serde_json::json;
use std::cell::Cell;
use std::error::Error;
use std::rc::Rc;

/// The modes that the closures are of, and the event that is passed.
struct Now {
    modes: Vec<Rc<Mode>>,
    by: Vec<Rates>,
    /// The mode that is run, that whose guards and resets count, and the event whose reset does.
    run: Cell<usize>,
    left: Cell<usize>,
    event: Cell<usize>,
}

impl Now {
    fn field(&self) -> &Mode {
        &self.modes[self.run.get()]
    }

    fn guards(&self) -> &Mode {
        &self.modes[self.left.get()]
    }

    /// Writes a value for each guard; where other modes have more there is none.
    fn each_guard(&self, out: &mut [f64], none: f64, value: impl Fn(&Mode, usize) -> f64) {
        let mode = self.guards();
        out.fill(none);
        for (place, out) in out.iter_mut().take(mode.events().len()).enumerate() {
            *out = value(mode, place);
        }
    }

    /// The change of the right-hand side that a change of the names adds.
    fn field_by(&self, t: f64, z: &[f64], changes: &[f64]) -> Vec<f64> {
        sum(changes, z.len(), |n| self.by[n].field(self.field(), t, z))
    }
}

/// Writes the rates of the state and of its sensitivities.
fn write_rates<'a, Eqn>(now: &Now, solver: &mut impl SensitivitiesOdeSolverMethod<'a, Eqn>)
where
    Eqn: OdeEquationsImplicitSens<T = f64, V = Vector> + 'a,
{
    let state = solver.state_mut();
    let (t, z) = (*state.t, values(state.y));
    state.dy.batch_as_mut_slice(0).copy_from_slice(&now.field().rates(t, &z));
    for (n, rates) in now.by.iter().enumerate() {
        let carried = now.field().jacobian(state.s.batch_as_slice(n));
        let own = rates.field(now.field(), t, &z);
        let out = state.ds.batch_as_mut_slice(n);
        out.iter_mut().zip(carried.iter().zip(own)).for_each(|(out, (a, b))| *out = a + b);
    }
}

/// Takes a root: the event with its reset, or one that is passed over.
fn at_root<'a, Eqn>(
    course: &mut Course,
    now: &Now,
    solver: &mut impl SensitivitiesOdeSolverMethod<'a, Eqn>,
    (root, place): (f64, usize),
) -> Result<(), Box<dyn Error>>
where
    Eqn: OdeEquationsImplicitSens<T = f64, V = Vector> + 'a,
    Eqn::M: diffsol::DefaultSolver,
{
    let mode = course.mode();
    let after = mode.guard(place, solver.state().t, &values(solver.state().y));
    solver.state_mut_back(root)?;
    let state = values(solver.state().y);
    if mode.events()[place].sign() * after < 0.0 {
        (course.t, course.z) = (root, state);
        write_rates(now, solver);
    } else {
        course.event(root, place, state)?;
        if mode.events()[place].ends() {
            let follows = course.modes().1;
            now.run.set(follows);
            now.event.set(place);
            solver.apply_reset_with_sens(place)?;
            now.left.set(follows);
        } else {
            write_rates(now, solver);
        }
    }
    if course.goes_on() {
        solver.set_stop_time(course.run.span)?;
    }
    Ok(())
}

/// Runs to the end.
fn run<'a, Eqn>(
    course: &mut Course,
    now: &Now,
    mut solver: impl SensitivitiesOdeSolverMethod<'a, Eqn>,
) -> Result<(), Box<dyn Error>>
where
    Eqn: OdeEquationsImplicitSens<T = f64, V = Vector> + 'a,
    Eqn::M: diffsol::DefaultSolver,
{
    diffsol_steps::run(course, &mut solver, |course, solver, root| {
        at_root(course, now, solver, root)
    })?;
    if course.t >= course.run.span {
        let end = |n: usize| solver.state().s.batch_as_slice(n).to_vec();
        let answer = |(n, it): (usize, &Rates)| json!({"wrt": it.wrt, "end": end(n)});
        course.derivatives = now.by.iter().enumerate().map(answer).collect();
    }
    Ok(())
}

/// Makes a run with its derivatives.
pub fn make(course: &mut Course) -> Result<(), Box<dyn Error>> {
    let (modes, first) = course.modes();
    let most = modes.iter().map(|mode| mode.events().len()).max().unwrap_or(0);
    let by = course.run.gradients.clone();
    let [mode, left, event] = [first, first, 0].map(Cell::new);
    let now = &Now { modes, by, run: mode, left, event };
    let (z, size) = (course.z.clone(), course.z.len());
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .t0(course.t)
        .rtol(course.run.tolerance.relative)
        .atol([course.run.tolerance.absolute])
        .p(now.by.iter().map(|it| it.value))
        .rhs_sens_implicit(
            |z, _, t, out| out.copy_from_slice(&now.field().rates(t, z)),
            |_, _, _, v, out| out.copy_from_slice(&now.field().jacobian(v)),
            |z, _, t, v, out| out.copy_from_slice(&now.field_by(t, z, v)),
        )
        .init_sens(
            move |_, _, out| out.copy_from_slice(&z),
            |_, _, v, out| out.copy_from_slice(&sum(v, size, |n| now.by[n].state.clone())),
            size,
        )
        .root_sens_implicit(
            |z, _, t, out| now.each_guard(out, -1.0, |mode, n| mode.guard(n, t, z)),
            |_, _, _, v, out| now.each_guard(out, 0.0, |mode, n| mode.guard_slope(n, v)),
            |z, _, t, v, out| {
                let still = vec![0.0; size];
                let by = |mode: &Mode, n| {
                    let each = v.iter().zip(&now.by);
                    each.map(|(v, it)| v * it.guard(mode, n, t, z, &still)).sum()
                };
                now.each_guard(out, 0.0, by);
            },
            most,
        )
        .reset_sens_implicit(
            |z, _, t, out| out.copy_from_slice(&now.guards().reset(now.event.get(), t, z)),
            |_, _, _, v, out| out.copy_from_slice(&now.guards().reset_slope(now.event.get(), v)),
            |z, _, t, v, out| {
                let (mode, still) = (now.guards(), vec![0.0; size]);
                let by = |n: usize| {
                    now.by[n].reset(mode, now.event.get(), (t, z), (0.0, still.as_slice()))
                };
                out.copy_from_slice(&sum(v, size, by));
            },
        )
        .build()?;
    if course.run.setup.starts_with("bdf") {
        run(course, now, problem.bdf_sens::<NalgebraLU<f64>>()?)
    } else {
        run(course, now, problem.tsit45_sens()?)
    }
}
