//! differential-equations with its built-in events as its documentation's first example has them,
//! run by percuss: `dop853`, an `Event` with a direction that ends the run, the tolerances, and
//! nothing else. What an expert adds is percuss's own engine `differential-equations-rkv655e`.
//! The builder takes its events one by one, each a type of its own: a mode has at most eight here.
//!
//! Where derivatives are asked for, the whole run is made in dual numbers, as the library's example
//! of sensitivities has them, and so is the location of events. Its two ways are two set-ups: step
//! sizes that depend on the names, and, with `-filter`, step sizes without derivatives. What an
//! expert does for derivatives is `rkv655e-saltation`.

mod differential_equations_numbers;
mod differential_equations_saltation;
mod percuss_program;

use differential_equations::prelude::*;
use differential_equations_numbers::{
    Dual, Equations, MAX_NAMES, Number, derivatives, without_derivatives,
};
use percuss_program::{Course, Setup, serve};
use serde_json::json;
use std::error::Error;

/// A guard.
struct Guard<'a, T> {
    equations: &'a Equations<T>,
    place: usize,
}

impl<T: Number> Event<T, Vec<T>> for Guard<'_, T> {
    fn config(&self) -> EventConfig {
        let direction = match self.equations.mode.events()[self.place].sign() {
            sign if sign > 0.0 => CrossingDirection::Positive,
            sign if sign < 0.0 => CrossingDirection::Negative,
            _ => CrossingDirection::Both,
        };
        EventConfig::new(direction, Some(1))
    }

    fn event(&self, t: T, z: &Vec<T>) -> T {
        self.equations.guard(self.place, t, z)
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

/// A run in numbers of a kind.
struct Numeric<T> {
    modes: Vec<Equations<T>>,
    filter: fn(T) -> T,
    t: T,
    z: Vec<T>,
    /// The time of each event and the state after it.
    passed: Vec<(T, Vec<T>)>,
}

impl<T: Number> Numeric<T> {
    fn new(course: &Course, filter: fn(T) -> T) -> Self {
        let by = &course.run.gradients;
        let modes = course.modes().0.into_iter().map(|mode| Equations::new(mode, by)).collect();
        let state = |(n, value): (usize, &f64)| T::of(*value, by.iter().map(|it| it.state[n]));
        let z = course.z.iter().enumerate().map(state).collect();
        Self { modes, filter, t: T::zero(), z, passed: Vec::new() }
    }

    /// The library's run up to the first event that it finds.
    fn solved(&self, course: &Course) -> Result<Solution<T, Vec<T>>, Box<dyn Error>> {
        let (equations, span) = (&self.modes[course.mode().place], course.run.span);
        let guard = |place| Guard { equations, place };
        let guards: Vec<_> = (0..equations.mode.events().len()).map(guard).collect();
        let due = course.pending().iter().copied().filter(|time| *time < span);
        let times: Vec<_> = due.chain([span]).map(T::constant).collect();
        let method = ExplicitRungeKutta::dop853()
            .rtol(T::constant(course.run.tolerance.relative))
            .atol(T::constant(course.run.tolerance.absolute))
            .filter(self.filter);
        let run = IVP::ode(equations, self.t, T::constant(span), self.z.clone()).t_eval(times);
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
        solution.map_err(|why| format!("{why:?}").into())
    }

    /// Runs to the first event that the library finds, and through it.
    fn stretch(&mut self, course: &mut Course) -> Result<(), Box<dyn Error>> {
        let solution = self.solved(course)?;
        course.steps += solution.steps.total() as u64;
        course.step()?;
        let found = matches!(solution.status, Status::Interrupted);
        let (Some(t), Some(z)) = (solution.t.last(), solution.y.last()) else {
            return Err("the solution is empty".into());
        };
        for (time, state) in solution.t.iter().zip(&solution.y) {
            if course.due(time.value()) == Some(time.value()) && (!found || time < t) {
                course.sample(values(state));
            }
        }
        if found {
            return self.event(course, *t, z);
        }
        if t.value() < course.run.span {
            return Err("the solution has no state at the end".into());
        }
        self.z.clone_from(z);
        (course.t, course.z) = (course.run.span, values(z));
        Ok(())
    }

    fn event(&mut self, course: &mut Course, t: T, z: &[T]) -> Result<(), Box<dyn Error>> {
        let equations = &self.modes[course.mode().place];
        let events = equations.mode.events();
        // Which event it is the library does not say: the one whose guard is nearest to zero.
        let size = |place: &usize| equations.guard(*place, t, z).value().abs();
        let nearest = (0..events.len()).min_by(|a, b| size(a).total_cmp(&size(b)));
        let event = nearest.ok_or("an event without guards")?;
        course.event(t.value(), event, values(z))?;
        let after = if events[event].ends() { equations.reset(event, t, z) } else { z.to_vec() };
        self.passed.push((t, after.clone()));
        (self.t, self.z) = (t, after);
        Ok(())
    }

    fn run(mut self, course: &mut Course) -> Result<Self, Box<dyn Error>> {
        while course.goes_on() {
            self.stretch(course)?;
        }
        Ok(self)
    }
}

fn values<T: Number>(z: &[T]) -> Vec<f64> {
    z.iter().map(Number::value).collect()
}

/// A run with the derivatives that dual numbers carry through it.
fn differentiated(course: &mut Course, filter: fn(Dual) -> Dual) -> Result<(), Box<dyn Error>> {
    let run = Numeric::new(course, filter).run(course)?;
    if course.t < course.run.span {
        return Ok(());
    }
    for (n, rates) in course.run.gradients.iter().enumerate() {
        let all = |z: &[Dual]| z.iter().map(|it| derivatives(it)[n]).collect::<Vec<_>>();
        let end = all(&run.z);
        let event =
            |(t, z): &(Dual, Vec<Dual>)| json!({"time": derivatives(t)[n], "state": all(z)});
        let events: Vec<_> = run.passed.iter().map(event).collect();
        course.derivatives.push(json!({"wrt": rates.wrt, "events": events, "end": end}));
    }
    Ok(())
}

fn make(course: &mut Course) -> Result<(), Box<dyn Error>> {
    let names = course.run.gradients.len();
    if names > MAX_NAMES {
        return Err(format!("{names} names; this program takes at most {MAX_NAMES}").into());
    }
    match (course.run.setup.as_str(), course.run.gradients.is_empty()) {
        ("rkv655e-saltation", _) => differential_equations_saltation::make(course),
        (_, true) => Numeric::<f64>::new(course, |h| h).run(course).map(drop),
        ("dop853-filter-default", _) => differentiated(course, without_derivatives),
        _ => differentiated(course, |h| h),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let default = Setup {
        name: "dop853-default",
        method: "Dormand-Prince 8(5,3), built-in events",
        class: "explicit",
        order: Some(8),
        backward: true,
        gradients: true,
    };
    let filter = Setup { name: "dop853-filter-default", ..default };
    let saltation = Setup {
        name: "rkv655e-saltation",
        method: "Verner 6(5)",
        order: Some(6),
        backward: false,
        ..default
    };
    serve("differential-equations", "0.7.0", &[default, filter, saltation], make)
}
