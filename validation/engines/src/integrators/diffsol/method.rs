//! The library's methods: how a solver of each is started, all else being the same.

use super::{DenseMatrix, Lu, Vect};
use crate::accuracy::Stepping;
use crate::engine::{Class, Role};
use diffsol::error::DiffsolError;
use diffsol::{
    NalgebraContext, OdeEquationsImplicit, OdeSolverMethod, OdeSolverProblem, OdeSolverState,
    StateRefMut, Tableau,
};

/// Equations in the library's vectors over nalgebra.
pub(in super::super) trait DiffsolProblem:
    OdeEquationsImplicit<T = f64, V = Vect, M = DenseMatrix, C = NalgebraContext>
{
}

impl<E> DiffsolProblem for E where
    E: OdeEquationsImplicit<T = f64, V = Vect, M = DenseMatrix, C = NalgebraContext>
{
}

/// A method of the library.
pub(in super::super) trait DiffsolMethod: Sync {
    const NAME: &'static str;
    const DESCRIPTION: &'static str;
    const STEPPING: Stepping;
    /// The order that the method's authors state; none where it varies from 1 on.
    const ORDER: Option<u32>;
    const CLASS: Class;
    /// The tests in which the engine takes part beside the suite's rows of case, engine and
    /// tolerance.
    const ROLE: Role = Role::Rows;
    /// Whether the step may be shortened without loss: a multistep method would begin anew.
    const IS_ONE_STEP: bool;
    /// Linear systems solved for each estimate of a step's error, beside those of Newton's
    /// iterations.
    const SOLVES_PER_ESTIMATE: usize = 0;

    /// A solver from a state of its own that `begin` has written.
    fn solver<'a, E: DiffsolProblem + 'a>(
        problem: &'a OdeSolverProblem<E>,
        begin: impl FnOnce(&mut StateRefMut<'_, Vect>),
    ) -> Result<impl OdeSolverMethod<'a, E>, DiffsolError>;
}

fn begun<S: OdeSolverState<Vect>>(
    mut state: S,
    begin: impl FnOnce(&mut StateRefMut<'_, Vect>),
) -> S {
    begin(&mut state.as_mut());
    state
}

/// Backward differentiation.
pub(in super::super) struct Bdf;
/// Trapezoidal rule, then second-order backward differentiation.
pub(in super::super) struct TrBdf2;
/// Diagonally implicit, with an explicit first stage: "a third order ESDIRK method", as its library
/// says. The 4 of its name is the order of the solution that only estimates the error.
pub(in super::super) struct Esdirk34;
/// Tsitouras's pair.
pub(in super::super) struct Tsit45;

impl DiffsolMethod for Bdf {
    const NAME: &'static str = "diffsol-bdf";
    const DESCRIPTION: &'static str = "BDF, orders 1 to 5";
    const CLASS: Class = Class::Multistep;
    const STEPPING: Stepping = Stepping::PerStep { order: 5 };
    const ORDER: Option<u32> = None;
    const ROLE: Role = Role::Representative;
    const IS_ONE_STEP: bool = false;

    fn solver<'a, E: DiffsolProblem + 'a>(
        problem: &'a OdeSolverProblem<E>,
        begin: impl FnOnce(&mut StateRefMut<'_, Vect>),
    ) -> Result<impl OdeSolverMethod<'a, E>, DiffsolError> {
        problem.bdf_solver::<Lu>(begun(problem.bdf_state::<Lu>()?, begin))
    }
}

impl DiffsolMethod for TrBdf2 {
    const NAME: &'static str = "diffsol-tr_bdf2";
    const DESCRIPTION: &'static str = "TR-BDF2, order 2";
    const CLASS: Class = Class::Implicit;
    const STEPPING: Stepping = Stepping::PerStep { order: 2 };
    const ORDER: Option<u32> = Some(2);
    const IS_ONE_STEP: bool = true;
    const SOLVES_PER_ESTIMATE: usize = 1;

    fn solver<'a, E: DiffsolProblem + 'a>(
        problem: &'a OdeSolverProblem<E>,
        begin: impl FnOnce(&mut StateRefMut<'_, Vect>),
    ) -> Result<impl OdeSolverMethod<'a, E>, DiffsolError> {
        let state = problem.rk_state(&Tableau::tr_bdf2())?;
        problem.tr_bdf2_solver::<Lu>(begun(state, begin))
    }
}

impl DiffsolMethod for Esdirk34 {
    const NAME: &'static str = "diffsol-esdirk34";
    const DESCRIPTION: &'static str = "ESDIRK 3(4), order 3";
    const CLASS: Class = Class::Implicit;
    const STEPPING: Stepping = Stepping::PerStep { order: 3 };
    const ORDER: Option<u32> = Some(3);
    const IS_ONE_STEP: bool = true;
    const SOLVES_PER_ESTIMATE: usize = 1;

    fn solver<'a, E: DiffsolProblem + 'a>(
        problem: &'a OdeSolverProblem<E>,
        begin: impl FnOnce(&mut StateRefMut<'_, Vect>),
    ) -> Result<impl OdeSolverMethod<'a, E>, DiffsolError> {
        let state = problem.rk_state(&Tableau::esdirk34())?;
        problem.esdirk34_solver::<Lu>(begun(state, begin))
    }
}

impl DiffsolMethod for Tsit45 {
    const NAME: &'static str = "diffsol-tsit45";
    const DESCRIPTION: &'static str = "Tsitouras 5(4)";
    const CLASS: Class = Class::Explicit;
    const STEPPING: Stepping = Stepping::Adaptive;
    const ORDER: Option<u32> = Some(5);
    const ROLE: Role = Role::Damping;
    const IS_ONE_STEP: bool = true;

    fn solver<'a, E: DiffsolProblem + 'a>(
        problem: &'a OdeSolverProblem<E>,
        begin: impl FnOnce(&mut StateRefMut<'_, Vect>),
    ) -> Result<impl OdeSolverMethod<'a, E>, DiffsolError> {
        let state = problem.rk_state(&Tableau::tsit45())?;
        problem.tsit45_solver(begun(state, begin))
    }
}
