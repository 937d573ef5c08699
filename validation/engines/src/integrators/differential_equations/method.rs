//! The library's methods, each with its tolerances and limits.

use super::{ModeField, reason};
use crate::accuracy::Stepping;
use crate::engine::Class;
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{CubicEnd, Times, longest_of_period, longest_step};
use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::{
    BackwardDifferentiationFormula, DiagonallyImplicitRungeKutta, ExplicitRungeKutta,
    ImplicitRungeKutta, Ordinary,
};
use differential_equations::ode::{OrdinaryNumericalMethod, solve_ode};
use differential_equations::solout::Solout;
use differential_equations::solution::Solution;
use differential_equations::stats::Evals;
use differential_equations::traits::State;

/// The value in place of the library's limits of steps and of rejections: the meter's is the one
/// that counts.
const NO_LIMIT: usize = usize::MAX;
/// The size to which Newton iterations of a method converge that does not relate it to
/// displacements. The model is linear in each phase: the first iteration is exact, and this has
/// only to be above the rounding of the largest displacements.
const NEWTON_TOLERANCE: f64 = 1e-11;

/// The ratio of two steps that Radau5 may take one after the other.
const STEP_RATIO: f64 = 1.25;

/// The largest power of the step ratio that is at most `h`. Radau5 keeps its factorised matrices
/// where a step could grow by less than a fifth, and does not make them anew when the next step
/// changes: with ratios above 1.2 it never keeps them.
fn power_of_ratio(h: f64) -> f64 {
    STEP_RATIO.powf((h.ln() / STEP_RATIO.ln() + EXPONENT_TOLERANCE).floor())
}

/// The distance from a power of the ratio, in powers, that counts as rounding.
const EXPONENT_TOLERANCE: f64 = 1e-9;

/// The source of states inside a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Inside {
    /// States inside a step come from the library's interpolant.
    Interpolant,
    /// States inside a step come from the method again, from the step's beginning.
    Again,
    /// States inside a step come from Hermite's cubic between its ends: a multistep method cannot
    /// begin there again.
    Cubic,
}

/// A method of the library.
pub(in super::super) trait LibraryMethod {
    const DESCRIPTION: &'static str;
    /// The order that the method's authors state; none where it varies.
    const ORDER: Option<u32>;
    const INSIDE: Inside;
    const CLASS: Class;
    const IS_MULTISTEP: bool = matches!(Self::CLASS, Class::Multistep);
    /// Backward differentiation continues with the solution whose error it estimates.
    const STEPPING: Stepping =
        if Self::IS_MULTISTEP { Stepping::PerStep { order: 5 } } else { Stepping::Adaptive };

    /// A fresh method for so many states; a first step of zero is chosen by the library.
    fn method<S: State<f64>>(
        size: usize,
        tolerance: f64,
        longest: f64,
        first: f64,
    ) -> impl OrdinaryNumericalMethod<f64, S> + Interpolation<f64, S>;

    /// The state at `t` by the method again from a point before it. Only methods that need it have
    /// it, because each is compiled for each system.
    fn recomputed_state<E: Equations<State: State<f64>>>(
        _field: &ModeField<'_, E>,
        _tolerance: f64,
        _from: CubicEnd<E::State>,
        _t: f64,
    ) -> Result<E::State, Failure> {
        Err(Failure::new("does not integrate inside its steps"))
    }

    /// The longest step.
    fn longest_step(times: &Times) -> f64 {
        match Self::INSIDE {
            Inside::Again => longest_step(times),
            Inside::Interpolant | Inside::Cubic => longest_of_period(times.period),
        }
    }

    /// Linear systems solved in a run with a first step of ours.
    fn solves(evals: &Evals) -> usize {
        if Self::IS_MULTISTEP { evals.function.saturating_sub(1) } else { evals.solves }
    }
}

/// The source of states inside a step, for methods with a function of their own.
macro_rules! inside {
    (Again) => {
        fn recomputed_state<E: Equations<State: State<f64>>>(
            field: &ModeField<'_, E>,
            tolerance: f64,
            from: CubicEnd<E::State>,
            t: f64,
        ) -> Result<E::State, Failure> {
            recomputed_state::<Self, E>(field, tolerance, from, t)
        }
    };
    ($other:ident) => {};
}

/// Methods with all that their builders have in common, and then with settings of their own.
macro_rules! methods {
    ($(
        $(#[$doc:meta])*
        $name:ident: $class:ident $text:literal, $order:expr, $inside:ident, |$first:ident| $new:expr $(, $setting:ident($value:expr))*;
    )*) => {$(
        $(#[$doc])*
        pub(in super::super) struct $name;

        impl LibraryMethod for $name {
            const DESCRIPTION: &'static str = $text;
            const ORDER: Option<u32> = $order;
            const INSIDE: Inside = Inside::$inside;
            const CLASS: Class = Class::$class;

            inside! { $inside }

            fn method<S: State<f64>>(
                size: usize,
                tolerance: f64,
                longest: f64,
                $first: f64,
            ) -> impl OrdinaryNumericalMethod<f64, S> + Interpolation<f64, S> {
                let method = $new.rtol(vec![tolerance; size]).atol(vec![tolerance; size]);
                method.h0($first).h_min(0.0).h_max(longest).max_steps(NO_LIMIT)$(.$setting($value))*
            }
        }
    )*};
}

methods! {
    /// Verner's robust pair of order 6.
    Rkv655e: Explicit "Verner 6(5)", Some(6), Interpolant,
        |first| ExplicitRungeKutta::<Ordinary, _, _, _, _, _, _>::rkv655e(),
        max_rejects(NO_LIMIT);
    /// Verner's efficient pair of order 7.
    Rkv767e: Explicit "Verner 7(6)", Some(7), Interpolant,
        |first| ExplicitRungeKutta::<Ordinary, _, _, _, _, _, _>::rkv767e(),
        max_rejects(NO_LIMIT);
    /// Dormand and Prince's method of order 8.
    Dop853: Explicit "Dormand-Prince 8(5,3)", Some(8), Again,
        |first| ExplicitRungeKutta::<Ordinary, _, _, _, _, _, _>::dop853(),
        max_rejects(NO_LIMIT);
    /// Collocation at Radau's points.
    Radau5: Implicit "Radau IIA, order 5", Some(5), Again,
        |first| ImplicitRungeKutta::<Ordinary, _, _, _, _, _, _>::radau5(),
        newton_tol(0.0), max_rejects(NO_LIMIT),
        filter(if first == 0.0 { power_of_ratio } else { std::convert::identity });
    /// Kvaerno's method of order 5.
    Kvaerno745: Implicit "Kvaerno ESDIRK 5(4)", Some(5), Again,
        |first| DiagonallyImplicitRungeKutta::<Ordinary, _, _, _, _, _, _>::kvaerno745(),
        newton_tol(NEWTON_TOLERANCE), max_rejects(NO_LIMIT);
    /// Backward differentiation.
    Bdf: Multistep "BDF, orders 1 to 5", None, Cubic,
        |first| BackwardDifferentiationFormula::<Ordinary, _, _>::adaptive(),
        h_max(f64::INFINITY);
}

/// The state at `t` by the method again from a point before it, in one step if that will do.
fn recomputed_state<M: LibraryMethod, E: Equations<State: State<f64>>>(
    field: &ModeField<'_, E>,
    tolerance: f64,
    from: CubicEnd<E::State>,
    t: f64,
) -> Result<E::State, Failure> {
    let length = t - from.0;
    let mut last = Last(from.1);
    let mut method = M::method(field.equations.dimension(), tolerance, length, length);
    let solved = solve_ode(&mut method, field, from.0, t, &from.1, &mut last)
        .map_err(|error| reason(&error))?;
    field.meter.solves(M::solves(&solved.evals));
    Ok(last.0)
}

/// Remembers the last state.
struct Last<S>(S);

impl<S: State<f64> + Copy> Solout<f64, S> for Last<S> {
    fn solout<I>(
        &mut self,
        _: f64,
        _: f64,
        state: &S,
        _: &S,
        _: &mut I,
        _: &mut Solution<f64, S>,
    ) -> ControlFlag<f64, S>
    where
        I: Interpolation<f64, S> + ?Sized,
    {
        self.0 = *state;
        ControlFlag::Continue
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_on_a_rung_stays_there() {
        for step in [1e-9, 0.3, 0.999, 1.0, 7.0] {
            let allowed = power_of_ratio(step);
            assert!(allowed <= step * (1.0 + 1e-8));
            assert!(step < allowed * STEP_RATIO * (1.0 + 1e-8));
            assert_eq!(power_of_ratio(allowed), allowed);
        }
    }
}
