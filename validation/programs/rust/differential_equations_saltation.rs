//! Dual numbers as an expert takes them through events with differential-equations: each stretch
//! between two of them is run again in dual numbers, by steps without derivatives, and with the
//! derivatives in the error control.
//!
//! Comparisons of dual numbers see the value alone, so the library's own states choose their steps
//! as if no derivative were there. The error of a step is asked of the state: a state of one's own
//! can answer for its derivatives too.

use crate::differential_equations_numbers::{
    Dual, Equations, Number, derivatives, without_derivatives,
};
use crate::percuss_program::derivatives::Stretch;
use crate::percuss_program::{Course, saltation};
use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::{ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, solve_ode};
use differential_equations::solout::Solout;
use differential_equations::solution::Solution;
use differential_equations::tolerance::Tolerance;
use differential_equations::traits::State;
use std::error::Error;
use std::rc::Rc;

/// A state whose derivatives have errors too.
#[derive(Clone, Debug)]
struct Watched(Vec<Dual>);

impl State<Dual> for Watched {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn get_component(&self, index: usize) -> Dual {
        self.0[index]
    }

    fn set_component(&mut self, index: usize, value: Dual) {
        self.0[index] = value;
    }

    fn map_components_mut<F: FnMut(usize, &mut Dual)>(&mut self, mut change: F) {
        self.0.iter_mut().enumerate().for_each(|(n, value)| change(n, value));
    }

    fn zeros_like(&self) -> Self {
        Self(vec![Dual::constant(0.0); self.0.len()])
    }

    fn zeros() -> Self {
        Self(Vec::new())
    }

    fn mul_add_assign(&mut self, alpha: Dual, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(value, other)| *value += alpha * *other);
    }

    fn scale_mut(&mut self, alpha: Dual) {
        self.0.iter_mut().for_each(|value| *value *= alpha);
    }

    fn error_norm_inf(
        &self,
        next: &Self,
        error: &Self,
        absolute: &Tolerance<Dual>,
        relative: &Tolerance<Dual>,
    ) -> Dual {
        let mut largest = 0.0_f64;
        for (n, error) in error.0.iter().enumerate() {
            let (absolute, relative) = (absolute[n].re, relative[n].re);
            let sizes = parts(&self.0[n]).zip(parts(&next.0[n]));
            for (error, (from, to)) in parts(error).zip(sizes) {
                let allowed = absolute + relative * from.abs().max(to.abs());
                largest = largest.max(error.abs() / allowed);
            }
        }
        Dual::constant(largest)
    }
}

/// A number's value and its derivatives.
fn parts(number: &Dual) -> impl Iterator<Item = f64> {
    [number.re].into_iter().chain(derivatives(number))
}

impl ODE<Dual, Watched> for Equations<Dual> {
    fn diff(&self, t: Dual, z: &Watched, out: &mut Watched) {
        out.0 = self.rates(t, &z.0);
    }
}

/// Remembers the last state: where rounding ends a run just before its end, the library's own
/// outputs at given times have none there.
struct Last(Watched);

impl Solout<Dual, Watched> for Last {
    fn solout<I>(
        &mut self,
        _: Dual,
        _: Dual,
        state: &Watched,
        _: &Watched,
        _: &mut I,
        _: &mut Solution<Dual, Watched>,
    ) -> ControlFlag<Dual, Watched>
    where
        I: Interpolation<Dual, Watched> + ?Sized,
    {
        self.0.0.clone_from(&state.0);
        ControlFlag::Continue
    }
}

/// Derivatives at fixed times along a stretch without events.
fn derivatives_along(
    course: &Course,
    stretch: &Stretch<'_>,
    states: Vec<Vec<f64>>,
) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let Stretch { mode, begin, state, end } = *stretch;
    let equations = Equations::<Dual>::new(Rc::clone(mode), &course.run.gradients);
    let number = |(n, value): (usize, &f64)| Dual::of(*value, states.iter().map(|it| it[n]));
    let z = Watched(state.iter().enumerate().map(number).collect());
    let most = usize::try_from(course.run.limits.calls)?;
    let mut method = ExplicitRungeKutta::<Ordinary, _, _, _, _, _, _>::rkv655e()
        .rtol(Dual::constant(course.run.tolerance.relative))
        .atol(Dual::constant(course.run.tolerance.absolute))
        .filter(without_derivatives)
        .max_steps(most)
        .max_rejects(most);
    let ([begin, end], mut last) = ([begin, end].map(Dual::constant), Last(z.clone()));
    solve_ode(&mut method, &equations, begin, end, &z, &mut last)
        .map_err(|why| format!("{why:?}"))?;
    course.within_limits()?;
    let by: Vec<_> = last.0.0.iter().map(derivatives).collect();
    Ok((0..states.len()).map(|n| by.iter().map(|it| it[n]).collect()).collect())
}

/// Makes a run, with its derivatives where they are asked for.
pub fn make(course: &mut Course) -> Result<(), Box<dyn Error>> {
    saltation::make(course, "differential-equations-rkv655e", derivatives_along)
}
