//! One mode by a fresh solver, up to the first root at which a guard rises that ends it.

use super::Vect;
use super::method::{DiffsolMethod, DiffsolProblem};
use crate::equations::{Equations, Numbers};
use crate::failure::Failure;
use crate::integration::{CountedCrossing, Meter, Moment, Sampler, StretchEnd};
use diffsol::ode_solver::OdeSolverStatistics;
use diffsol::{OdeSolverMethod, OdeSolverProblem, OdeSolverStopReason, StateRefMut};

pub(super) struct DiffsolRun<'a, E: Equations> {
    pub(super) span: f64,
    pub(super) longest: f64,
    pub(super) meter: &'a Meter,
    pub(super) equations: E,
}

/// A root of a guard that does not end the mode.
struct PassedRoot<E: Equations> {
    mode: usize,
    guard: usize,
    t: f64,
    state: E::State,
}

impl<E: Equations> DiffsolRun<'_, E> {
    pub(super) fn one_mode<M: DiffsolMethod, P: DiffsolProblem>(
        &self,
        problem: &OdeSolverProblem<P>,
        from: &Moment<E>,
        sampler: &mut Sampler<E::State>,
    ) -> Result<StretchEnd<E::State>, Failure> {
        if self.span - from.t <= ROOT_TOLERANCE * self.span {
            // The library refuses a stop that is as near as that.
            return Ok(StretchEnd::Inside { t: self.span, state: from.state });
        }
        let mut solver = M::solver(problem, |state| self.begin::<M, P>(problem, from, state))
            .map_err(Failure::new)?;
        solver.set_stop_time(self.span).map_err(Failure::new)?;
        let ended = self.follow::<M, P>(&mut solver, from, sampler)?;
        self.meter.solves(solves::<M>(solver.get_statistics()));
        Ok(ended)
    }

    /// Steps to the end of the mode, or of the run.
    fn follow<'a, M: DiffsolMethod, P: DiffsolProblem + 'a>(
        &self,
        solver: &mut impl OdeSolverMethod<'a, P>,
        from: &Moment<E>,
        sampler: &mut Sampler<E::State>,
    ) -> Result<StretchEnd<E::State>, Failure> {
        loop {
            let reason = solver.step().map_err(Failure::new)?;
            self.meter.steps(1);
            self.meter.record_step(solver.state().t);
            let state_at = |t: f64| solver.interpolate(t).map(|u| plain(&u)).map_err(Failure::new);
            match reason {
                OdeSolverStopReason::InternalTimestep => {
                    sampler.take(solver.state().t, state_at)?;
                    if M::IS_ONE_STEP && solver.state().h > self.longest {
                        *solver.state_mut().h = self.longest;
                    }
                }
                OdeSolverStopReason::TstopReached => {
                    let state = plain(solver.state().y);
                    sampler.take(solver.state().t, state_at)?;
                    return Ok(StretchEnd::Inside { t: self.span, state });
                }
                OdeSolverStopReason::RootFound(root, guard) => {
                    if let Some(ended) = self.at_root(solver, from, sampler, (root, guard))? {
                        return Ok(ended);
                    }
                }
            }
        }
    }

    /// Ends the stretch at a root, or makes the solver ready to go on after it.
    fn at_root<'a, P: DiffsolProblem + 'a>(
        &self,
        solver: &mut impl OdeSolverMethod<'a, P>,
        from: &Moment<E>,
        sampler: &mut Sampler<E::State>,
        (root, guard): (f64, usize),
    ) -> Result<Option<StretchEnd<E::State>>, Failure> {
        let state_at = |t: f64| solver.interpolate(t).map(|u| plain(&u)).map_err(Failure::new);
        let state = state_at(root)?;
        let rising = self.rising(from.mode, root, &state, guard);
        if let Some(guard) = rising.iter().copied().find(|it| self.ends(from, *it)) {
            sampler.take(root, state_at)?;
            return Ok(Some(StretchEnd::Event { t: root, guard, state }));
        }
        for guard in rising {
            if !is_known(from, root, guard, sampler) {
                sampler.counted.push(CountedCrossing { t: root, guard, state });
            }
        }
        let (t, end): (f64, E::State) = (solver.state().t, plain(solver.state().y));
        let left = PassedRoot { mode: from.mode, guard, t: root, state };
        if self.has_more(&left, t, &end) && root < t {
            sampler.take(root, state_at)?;
            solver.state_mut_back(root).map_err(Failure::new)?;
            return Ok(None);
        }
        sampler.take(t, state_at)?;
        if self.span - t <= ROOT_TOLERANCE * self.span {
            // The step with the root ends at the stop, from where no step goes on.
            return Ok(Some(StretchEnd::Inside { t: self.span, state: end }));
        }
        // The state is touched, so that the root finder takes a new bracket.
        let _ = solver.state_mut();
        Ok(None)
    }

    fn ends(&self, from: &Moment<E>, guard: usize) -> bool {
        self.equations.ends(from.mode, guard)
    }

    /// The guards that rise at a root: the library names one, and others may have the same root.
    fn rising(&self, mode: usize, t: f64, state: &E::State, guard: usize) -> Vec<usize> {
        let values = self.equations.guards(mode, t, state.as_ref());
        let rates = self.equations.rates(mode, t, state.as_ref());
        let rises = |other: &usize| {
            let (value, rate) = (values.as_ref()[*other], rates.as_ref()[*other]);
            rate > 0.0 && (*other == guard || value.abs() <= ROOT_TOLERANCE * t * rate)
        };
        (0..self.equations.count(mode)).filter(rises).collect()
    }

    /// Whether the rest of a step after a root that ends nothing hides another: a guard that ends
    /// the mode has risen by the step's end, or one that is counted has.
    fn has_more(&self, root: &PassedRoot<E>, end: f64, there: &E::State) -> bool {
        let PassedRoot { mode, guard, t, state } = root;
        let after = self.equations.guards(*mode, end, there.as_ref());
        let event = self.equations.event(*mode, *guard);
        let risen = |other: usize| {
            let before = self.equations.guards(*mode, *t, state.as_ref());
            self.equations.event(*mode, other) != event && before.as_ref()[other] < 0.0
        };
        let mut outside = (0..).zip(after.as_ref()).filter(|(_, value)| **value > 0.0);
        outside.any(|(other, _)| self.equations.ends(*mode, other) || risen(other))
    }

    /// Writes a state with derivative and step of its own.
    fn begin<M: DiffsolMethod, P: DiffsolProblem>(
        &self,
        problem: &OdeSolverProblem<P>,
        from: &Moment<E>,
        state: &mut StateRefMut<'_, Vect>,
    ) {
        state.y.batch_as_mut_slice(0).copy_from_slice(from.state.as_ref());
        let mut derivatives = from.state;
        let derivatives = derivatives.as_mut();
        self.equations.derivatives(from.mode, from.t, from.state.as_ref(), derivatives);
        self.meter.rhs(derivatives);
        state.dy.batch_as_mut_slice(0).copy_from_slice(derivatives);
        *state.t = from.t;
        first_step::<M, P>(problem, state);
    }
}

/// The first step by the library's rule, a power of an error whose exponent is a half for methods
/// that begin at order 1. LLVM makes that a square root where it sees no other exponent. The
/// reference to the equations is a type of its own, which gives it such a place: digits then do not
/// depend on how often the rest is compiled.
#[inline(never)]
fn first_step<M: DiffsolMethod, P: DiffsolProblem>(
    problem: &OdeSolverProblem<P>,
    state: &mut StateRefMut<'_, Vect>,
) {
    let OdeSolverProblem { h0, atol, rtol, eqn, .. } = problem;
    match M::ORDER {
        None => state.set_step_size(*h0, atol, *rtol, &eqn, 1),
        Some(order) => state.set_step_size(*h0, atol, *rtol, eqn, order as usize),
    }
}

/// The distance, relative to its time, within which one root may be found twice: ten times the
/// resolution of the library's root finder.
const ROOT_TOLERANCE: f64 = 1e3 * f64::EPSILON;

/// Whether a crossing is one that was counted already, before the step was taken back to its root,
/// or that of a guard which is zero at its mode's entry.
fn is_known<E: Equations>(
    from: &Moment<E>,
    root: f64,
    guard: usize,
    sampler: &Sampler<E::State>,
) -> bool {
    let near = |t: f64| root - t <= ROOT_TOLERANCE * root;
    let counted = sampler.counted.iter().rev().find(|it| it.guard == guard);
    counted.is_some_and(|it| near(it.t)) || (from.entered.is_zero(guard) && near(from.began))
}

/// Each of Newton's iterations solves one system. In diagonally implicit methods so does each
/// estimate of a step's error, of which the library counts those that pass and those that fail.
fn solves<M: DiffsolMethod>(statistics: &OdeSolverStatistics) -> usize {
    let estimates = statistics.number_of_steps + statistics.number_of_error_test_failures;
    statistics.number_of_nonlinear_solver_iterations + M::SOLVES_PER_ESTIMATE * estimates
}

fn plain<S: Numbers>(u: &Vect) -> S {
    S::from_slice(u.batch_as_slice(0))
}
