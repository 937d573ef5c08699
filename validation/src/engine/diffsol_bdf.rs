//! diffsol's BDF with its own root finding, as an expert user sets it up.
//!
//! - The phase is a `Cell` that the closures read; the problem is built once, the solver anew from
//!   the state at each switch, because its limit of 50 failed Newton iterations is cumulative.
//! - On restart the derivative is written afresh and the step chosen anew: a stale derivative makes
//!   the first steps collapse.
//! - Root functions know no direction. A root at which the guard falls, such as the double zero that
//!   begins every separation, is passed over by touching the state; the root finder otherwise keeps
//!   its old bracket. If another guard has risen by the end of that step, the step is taken back to
//!   just after the root.
//! - At a root the library leaves the state at the end of the step: the switch's state is its
//!   interpolant there.
//! - There is no maximum step. None is forced on it: what a root finder that looks only at the ends
//!   of steps misses is what this harness wants to know.

use super::meter::{Failure, Limits, Meter};
use super::phases::{GUARDS, Oscillator, Sampler};
use super::{Declaration, Engine, Event, Location, Outcome, Stepping, Task, Work, pins};
use diffsol::{
    NalgebraLU, NalgebraMat, OdeBuilder, OdeEquationsImplicit, OdeSolverMethod, OdeSolverProblem,
    OdeSolverState, OdeSolverStopReason, Vector,
};
use percuss::Phase;
use std::cell::Cell;

type Matrix = NalgebraMat<f64>;
type Vect = diffsol::NalgebraVec<f64>;
type Lu = NalgebraLU<f64>;

/// diffsol's `Bdf`.
pub(super) struct DiffsolBdf;

impl Engine for DiffsolBdf {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: "diffsol-bdf",
            library: "diffsol",
            version: pins::version("diffsol"),
            method: "BDF, orders 1 to 5",
            events: Location::Library,
            dense_output: true,
            stepping: Stepping::Adaptive,
        }
    }

    fn run(
        &self,
        task: &Task,
        tolerance: Option<f64>,
        limits: &Limits,
    ) -> Result<Outcome, Failure> {
        let tolerance = tolerance.ok_or_else(|| Failure::new("needs a tolerance"))?;
        let meter = Meter::new(limits);
        let oscillator = Oscillator::new(&task.parameters, task.forcing_angle);
        let phase = Cell::new(task.phase);
        let problem = OdeBuilder::<Matrix>::new()
            .rtol(tolerance)
            .atol([tolerance])
            .h0(task.problem.model.period() * FIRST_STEP)
            .rhs_implicit(
                |u, _, t, du| {
                    oscillator.derivatives(phase.get(), t, u, du);
                    meter.rhs(du);
                },
                |_, _, _, w, dw| {
                    oscillator.jacobian_product(phase.get(), w, dw);
                    meter.jacobian();
                },
            )
            .init(|_, _, u| u.copy_from_slice(&task.state), task.state.len())
            .root(
                |u, _, _, guards| {
                    guards.copy_from_slice(&oscillator.guards(phase.get(), u));
                    meter.call();
                },
                GUARDS,
            )
            .build()
            .map_err(Failure::new)?;
        let mut run = Run {
            task,
            meter: &meter,
            oscillator,
            phase: &phase,
            steps: 0,
            outcome: Outcome::default(),
        };
        run.all_phases(&problem)?;
        let Run { steps, mut outcome, .. } = run;
        outcome.work = Work {
            rhs_evaluations: meter.rhs_count(),
            jacobian_evaluations: meter.jacobian_count(),
            steps,
        };
        Ok(outcome)
    }
}

/// The first step tried, in forcing periods; the library then chooses by its own rule.
const FIRST_STEP: f64 = 1e-3;

struct Run<'a> {
    task: &'a Task,
    meter: &'a Meter,
    oscillator: Oscillator,
    phase: &'a Cell<Phase>,
    steps: u64,
    outcome: Outcome,
}

/// How a phase ended.
enum Ended {
    Switch { t: f64, guard: usize, state: [f64; 4] },
    Horizon([f64; 4]),
}

impl Run<'_> {
    fn all_phases<E>(&mut self, problem: &OdeSolverProblem<E>) -> Result<(), Failure>
    where
        E: OdeEquationsImplicit<T = f64, V = Vect, M = Matrix, C = diffsol::NalgebraContext>,
    {
        let mut sampler = Sampler::new(self.task.sample_times());
        let (mut t, mut state) = (0.0, self.task.state);
        loop {
            match self.one_phase(problem, t, &state, &mut sampler)? {
                Ended::Horizon(end) => {
                    self.outcome.end = end;
                    self.outcome.samples = sampler.taken;
                    return Ok(());
                }
                Ended::Switch { t: at, guard, state: there } => {
                    let (next, projected) = self.oscillator.switch(self.phase.get(), guard, &there);
                    self.meter.events(self.outcome.events.len())?;
                    self.phase.set(next);
                    (t, state) = (at, projected);
                    self.outcome.events.push(Event { phase: next, elapsed: t, state });
                }
            }
        }
    }

    fn one_phase<E>(
        &mut self,
        problem: &OdeSolverProblem<E>,
        t: f64,
        from: &[f64; 4],
        sampler: &mut Sampler,
    ) -> Result<Ended, Failure>
    where
        E: OdeEquationsImplicit<T = f64, V = Vect, M = Matrix, C = diffsol::NalgebraContext>,
    {
        if t >= self.task.span {
            return Ok(Ended::Horizon(*from));
        }
        let mut solver =
            problem.bdf_solver::<Lu>(self.restarted(problem, t, from)?).map_err(Failure::new)?;
        solver.set_stop_time(self.task.span).map_err(Failure::new)?;
        loop {
            let reason = solver.step().map_err(Failure::new)?;
            self.steps += 1;
            let state_at = |t: f64| solver.interpolate(t).map(|u| plain(&u)).map_err(Failure::new);
            match reason {
                OdeSolverStopReason::InternalTimestep => {
                    sampler.take(solver.state().t, state_at)?
                }
                OdeSolverStopReason::TstopReached => {
                    let end = plain(solver.state().y);
                    sampler.take(self.task.span, state_at)?;
                    return Ok(Ended::Horizon(end));
                }
                OdeSolverStopReason::RootFound(root, guard) => {
                    let state = state_at(root)?;
                    if self.oscillator.rises(self.phase.get(), guard, root, &state) {
                        sampler.take(root, state_at)?;
                        return Ok(Ended::Switch { t: root, guard, state });
                    }
                    let outside = self.outside(&plain(solver.state().y));
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

    fn outside(&self, state: &[f64; 4]) -> bool {
        self.oscillator.guards(self.phase.get(), state).iter().any(|guard| *guard > 0.0)
    }

    /// A solver state at `from`, with derivative and step of its own.
    fn restarted<E>(
        &self,
        problem: &OdeSolverProblem<E>,
        t: f64,
        from: &[f64; 4],
    ) -> Result<diffsol::BdfState<Vect>, Failure>
    where
        E: OdeEquationsImplicit<T = f64, V = Vect, M = Matrix, C = diffsol::NalgebraContext>,
    {
        let mut state = problem.bdf_state::<Lu>().map_err(Failure::new)?;
        let mut parts = state.as_mut();
        parts.y.batch_as_mut_slice(0).copy_from_slice(from);
        let mut derivatives = [0.0; 4];
        self.oscillator.derivatives(self.phase.get(), t, from, &mut derivatives);
        self.meter.rhs(&derivatives);
        parts.dy.batch_as_mut_slice(0).copy_from_slice(&derivatives);
        *parts.t = t;
        let first = (problem.h0).min(self.task.span - t);
        parts.set_step_size(first, &problem.atol, problem.rtol, &problem.eqn, 1);
        Ok(state)
    }
}

fn plain(u: &Vect) -> [f64; 4] {
    [u.get_index(0), u.get_index(1), u.get_index(2), u.get_index(3)]
}
