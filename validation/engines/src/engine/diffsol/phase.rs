//! One phase by a fresh solver, up to the first root at which a guard rises.

use super::Vect;
use super::method::{DiffsolMethod, DiffsolProblem};
use crate::engine::field::{Equations, Oscillator};
use crate::engine::joining::{Moment, StretchEnd};
use crate::engine::meter::{Failure, Meter};
use crate::engine::sampler::Sampler;
use diffsol::ode_solver::OdeSolverStatistics;
use diffsol::{OdeSolverMethod, OdeSolverProblem, OdeSolverStopReason, StateRefMut, Vector};
use percuss::Phase;

pub(super) struct DiffsolRun<'a> {
    pub(super) span: f64,
    pub(super) longest: f64,
    pub(super) meter: &'a Meter,
    pub(super) oscillator: Oscillator,
}

impl DiffsolRun<'_> {
    pub(super) fn one_phase<M: DiffsolMethod, E: DiffsolProblem>(
        &self,
        problem: &OdeSolverProblem<E>,
        from: &Moment,
        sampler: &mut Sampler,
    ) -> Result<StretchEnd, Failure> {
        let mut solver = M::solver(problem, |state| self.begin::<M, E>(problem, from, state))
            .map_err(Failure::new)?;
        solver.set_stop_time(self.span).map_err(Failure::new)?;
        let ended = self.follow::<M, E>(&mut solver, from, sampler)?;
        self.meter.solves(solves::<M>(solver.get_statistics()));
        Ok(ended)
    }

    fn follow<'a, M: DiffsolMethod, E: DiffsolProblem + 'a>(
        &self,
        solver: &mut impl OdeSolverMethod<'a, E>,
        from: &Moment,
        sampler: &mut Sampler,
    ) -> Result<StretchEnd, Failure> {
        loop {
            let reason = solver.step().map_err(Failure::new)?;
            self.meter.steps(1);
            self.meter.stepped(solver.state().t);
            let state_at = |t: f64| solver.interpolate(t).map(|u| plain(&u)).map_err(Failure::new);
            match reason {
                OdeSolverStopReason::InternalTimestep => {
                    sampler.take(solver.state().t, state_at)?;
                    if M::ONE_STEP && solver.state().h > self.longest {
                        *solver.state_mut().h = self.longest;
                    }
                }
                OdeSolverStopReason::TstopReached => {
                    let state = plain(solver.state().y);
                    sampler.take(solver.state().t, state_at)?;
                    return Ok(StretchEnd::Inside { t: self.span, state });
                }
                OdeSolverStopReason::RootFound(root, guard) => {
                    let state = state_at(root)?;
                    if self.oscillator.rates(from.phase, root, &state)[guard] > 0.0 {
                        sampler.take(root, state_at)?;
                        return Ok(StretchEnd::Switch { t: root, guard, state });
                    }
                    let outside = self.is_outside(from.phase, &plain(solver.state().y));
                    if outside && root < solver.state().t {
                        sampler.take(root, state_at)?;
                        solver.state_mut_back(root).map_err(Failure::new)?;
                    } else {
                        sampler.take(solver.state().t, state_at)?;
                        // Touched, so that the root finder takes a new bracket.
                        let _ = solver.state_mut();
                    }
                }
            }
        }
    }

    fn is_outside(&self, phase: Phase, state: &[f64; 4]) -> bool {
        self.oscillator.guards(phase, state).iter().any(|guard| *guard > 0.0)
    }

    /// Writes a state with derivative and step of its own.
    fn begin<M: DiffsolMethod, E: DiffsolProblem>(
        &self,
        problem: &OdeSolverProblem<E>,
        from: &Moment,
        state: &mut StateRefMut<'_, Vect>,
    ) {
        state.y.batch_as_mut_slice(0).copy_from_slice(&from.state);
        let mut derivatives = [0.0; 4];
        self.oscillator.derivatives(from.phase, from.t, &from.state, &mut derivatives);
        self.meter.rhs(&derivatives);
        state.dy.batch_as_mut_slice(0).copy_from_slice(&derivatives);
        *state.t = from.t;
        let order = M::ORDER.unwrap_or(1) as usize;
        state.set_step_size(problem.h0, &problem.atol, problem.rtol, &problem.eqn, order);
    }
}

/// Each of Newton's iterations solves one system. In diagonally implicit methods so does each
/// estimate of a step's error, of which the library counts those that pass and those that fail.
fn solves<M: DiffsolMethod>(statistics: &OdeSolverStatistics) -> usize {
    let estimates = statistics.number_of_steps + statistics.number_of_error_test_failures;
    statistics.number_of_nonlinear_solver_iterations + M::SOLVES_AN_ESTIMATE * estimates
}

fn plain(u: &Vect) -> [f64; 4] {
    [u.get_index(0), u.get_index(1), u.get_index(2), u.get_index(3)]
}
