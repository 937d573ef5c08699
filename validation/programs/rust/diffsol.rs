//! diffsol with its own root finding as its book's example of a bouncing ball has it, run by
//! percuss: steps until a root is found, the interpolated state there, the event's change of it,
//! written into the same solver, which goes on from there; the tolerances, and nothing else. What
//! an expert adds is percuss's own engine `diffsol-bdf`.
//!
//! - As `solve` does, the stop time is set again after each root.
//! - The example puts the ball above the ground by `f64::EPSILON` at the least. Here the state is
//!   moved inside of each guard that ends the mode that follows, by that much.
//! - Roots have no direction. One that the guard leaves on the wrong side is passed over: the run
//!   goes on from there, as it does from an event that is only counted.
//!
//! Where derivatives are asked for, the reset is an operator of the problem, and diffsol takes the
//! sensitivities through it. `bdf-saltation` and `tsit45-saltation` are what an expert does for
//! derivatives: runs of percuss's own engines, and the sensitivities of each stretch again.

mod diffsol_saltation;
mod diffsol_sensitivities;
mod diffsol_steps;
mod percuss_program;

use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeEquations, OdeSolverMethod};
use diffsol_steps::{Vector, values};
use percuss_program::{Course, Setup, serve};
use std::cell::Cell;
use std::error::Error;
use std::rc::Rc;

/// The state of now, moved to the inside of its mode.
fn inside(course: &Course) -> Vec<f64> {
    let (mode, mut z) = (course.mode(), course.z.clone());
    for (place, event) in mode.events().iter().enumerate().filter(|(_, event)| event.ends()) {
        let slope = &event.guard()[..z.len()];
        let size: f64 = slope.iter().map(|it| it * it).sum();
        let out = mode.guard(place, course.t, &z) + f64::EPSILON;
        if out > 0.0 && size > 0.0 {
            z.iter_mut().zip(slope).for_each(|(z, slope)| *z -= out / size * slope);
        }
    }
    z
}

/// Writes the state at a root, after its event, into the solver, as the example does.
fn go_on<'a, Eqn>(
    course: &Course,
    solver: &mut impl OdeSolverMethod<'a, Eqn>,
) -> Result<(), Box<dyn Error>>
where
    Eqn: OdeEquations<T = f64, V = Vector> + 'a,
{
    let state = solver.state_mut();
    state.y.batch_as_mut_slice(0).copy_from_slice(&course.z);
    state.dy.batch_as_mut_slice(0).copy_from_slice(&course.mode().rates(course.t, &course.z));
    *state.t = course.t;
    if course.goes_on() {
        solver.set_stop_time(course.run.span)?;
    }
    Ok(())
}

/// Takes a root: the event, or a root that is passed over.
fn at_root<'a, Eqn>(
    course: &mut Course,
    now: &Cell<usize>,
    solver: &mut impl OdeSolverMethod<'a, Eqn>,
    (root, place): (f64, usize),
) -> Result<(), Box<dyn Error>>
where
    Eqn: OdeEquations<T = f64, V = Vector> + 'a,
{
    let mode = course.mode();
    let after = mode.guard(place, solver.state().t, &values(solver.state().y));
    let state = values(&solver.interpolate(root)?);
    if mode.events()[place].sign() * after < 0.0 {
        (course.t, course.z) = (root, state);
    } else {
        course.event(root, place, state)?;
        if mode.events()[place].ends() {
            now.set(course.modes().1);
            course.z = inside(course);
        }
    }
    go_on(course, solver)
}

/// Runs to the end.
fn run<'a, Eqn>(
    course: &mut Course,
    now: &Cell<usize>,
    mut solver: impl OdeSolverMethod<'a, Eqn>,
) -> Result<(), Box<dyn Error>>
where
    Eqn: OdeEquations<T = f64, V = Vector> + 'a,
{
    diffsol_steps::run(course, &mut solver, |course, solver, root| {
        at_root(course, now, solver, root)
    })
}

fn make(course: &mut Course) -> Result<(), Box<dyn Error>> {
    if course.run.setup.ends_with("-saltation") {
        return diffsol_saltation::make(course);
    }
    if !course.run.gradients.is_empty() {
        return diffsol_sensitivities::make(course);
    }
    let (modes, first) = course.modes();
    let most = modes.iter().map(|mode| mode.events().len()).max().unwrap_or(0);
    let (modes, now) = (Rc::new(modes), Rc::new(Cell::new(first)));
    let [rates, jacobian, guards] = [0; 3].map(|_| {
        let (modes, now) = (Rc::clone(&modes), Rc::clone(&now));
        move || Rc::clone(&modes[now.get()])
    });
    let (z, size) = (course.z.clone(), course.z.len());
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .t0(course.t)
        .rtol(course.run.tolerance.relative)
        .atol([course.run.tolerance.absolute])
        .rhs_implicit(
            move |z, _, t, out| out.copy_from_slice(&rates().rates(t, z)),
            move |_, _, _, v, out| out.copy_from_slice(&jacobian().jacobian(v)),
        )
        .init(move |_, _, out| out.copy_from_slice(&z), size)
        .root(
            move |z, _, t, out| {
                let mode = guards();
                for (place, out) in out.iter_mut().enumerate() {
                    // Where other modes have more events than this one there is no root.
                    let is_own = place < mode.events().len();
                    *out = if is_own { mode.guard(place, t, z) } else { -1.0 };
                }
            },
            most,
        )
        .build()?;
    if course.run.setup.starts_with("bdf") {
        run(course, &now, problem.bdf::<NalgebraLU<f64>>()?)
    } else {
        run(course, &now, problem.tsit45()?)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let bdf = ("BDF, orders 1 to 5", "multistep", None);
    let tsit45 = ("Tsitouras 5(4)", "explicit", Some(5));
    let names = [
        ("bdf-default", bdf),
        ("tsit45-default", tsit45),
        ("bdf-saltation", bdf),
        ("tsit45-saltation", tsit45),
    ];
    let setups = names.map(|(name, (method, class, order))| {
        let backward = name.ends_with("-default");
        Setup { name, method, class, order, backward, gradients: true }
    });
    serve("diffsol", "0.18.0", &setups, make)
}
