//! differential-equations with its built-in events as its documentation's first example has them,
//! run by percuss: `dop853`, an `Event` with a direction that ends the run, the tolerances, and
//! nothing else. What an expert adds is percuss's own engine `differential-equations-rkv655e`.
//! The builder takes its events one by one, each a type of its own: a mode has at most eight here.

mod percuss_program;

use differential_equations::prelude::*;
use percuss_program::{Course, Mode, Setup, serve};
use std::rc::Rc;

/// A mode in the library's traits.
struct Field(Rc<Mode>);

impl ODE<f64, Vec<f64>> for Field {
    fn diff(&self, t: f64, z: &Vec<f64>, out: &mut Vec<f64>) {
        *out = self.0.rates(t, z);
    }
}

/// A guard.
struct Guard {
    mode: Rc<Mode>,
    place: usize,
}

impl Event<f64, Vec<f64>> for Guard {
    fn config(&self) -> EventConfig {
        let direction = match self.mode.events()[self.place].sign() {
            sign if sign > 0.0 => CrossingDirection::Positive,
            sign if sign < 0.0 => CrossingDirection::Negative,
            _ => CrossingDirection::Both,
        };
        EventConfig::new(direction, Some(1))
    }

    fn event(&self, t: f64, z: &Vec<f64>) -> f64 {
        self.mode.guard(self.place, t, z)
    }
}

/// Solves with the guards of these places, one call of the builder each.
macro_rules! solve {
    ($run:expr, $method:expr, $guards:expr, $($place:literal)*) => {{
        let run = $run;
        $(let run = run.event(&$guards[$place]);)*
        run.method($method).solve()
    }};
}

/// Runs to the first event that the library finds.
fn stretch(course: &mut Course) -> Result<(), Box<dyn std::error::Error>> {
    let (mode, span) = (course.mode(), course.run.span);
    let field = Field(course.mode());
    let guard = |place| Guard { mode: course.mode(), place };
    let guards: Vec<_> = (0..mode.events().len()).map(guard).collect();
    let due: Vec<f64> = course.pending().iter().copied().filter(|time| *time < span).collect();
    let times: Vec<f64> = due.iter().copied().chain([span]).collect();
    let method = ExplicitRungeKutta::dop853()
        .rtol(course.run.tolerance.relative)
        .atol(course.run.tolerance.absolute);
    let run = IVP::ode(&field, course.t, span, course.z.clone()).t_eval(times);
    let solution = match guards.len() {
        0 => solve!(run, method, guards,),
        1 => solve!(run, method, guards, 0),
        2 => solve!(run, method, guards, 0 1),
        3 => solve!(run, method, guards, 0 1 2),
        4 => solve!(run, method, guards, 0 1 2 3),
        5 => solve!(run, method, guards, 0 1 2 3 4),
        6 => solve!(run, method, guards, 0 1 2 3 4 5),
        7 => solve!(run, method, guards, 0 1 2 3 4 5 6),
        8 => solve!(run, method, guards, 0 1 2 3 4 5 6 7),
        more => return Err(format!("{more} events; this program adds at most eight").into()),
    };
    let solution = solution.map_err(|why| format!("{why:?}"))?;
    course.steps += solution.steps.total() as u64;
    course.step()?;
    let found = matches!(solution.status, Status::Interrupted);
    let (Some(t), Some(z)) = (solution.t.last(), solution.y.last()) else {
        return Err("the solution is empty".into());
    };
    for (time, state) in solution.t.iter().zip(&solution.y) {
        if course.due(*time) == Some(*time) && (!found || time < t) {
            course.sample(state.clone());
        }
    }
    if !found {
        (course.t, course.z) = (span, z.clone());
        return Ok(());
    }
    // Which event it is the library does not say: the one whose guard is nearest to zero.
    let size = |place: &usize| mode.guard(*place, *t, z).abs();
    let nearest = (0..guards.len()).min_by(|a, b| size(a).total_cmp(&size(b)));
    course.event(*t, nearest.ok_or("an event without guards")?, z.clone())
}

fn make(course: &mut Course) -> Result<(), Box<dyn std::error::Error>> {
    while course.goes_on() {
        stretch(course)?;
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let setup = Setup {
        name: "dop853-default",
        method: "Dormand-Prince 8(5,3), built-in events",
        class: "explicit",
        order: Some(8),
        backward: true,
        gradients: false,
    };
    serve("differential-equations", "0.7.0", &[setup], make)
}
