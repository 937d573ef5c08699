//! `Dop853`, as shipped and with time carried as one more state.
//!
//! - As shipped its twelfth stage is evaluated at the wrong time (c12 is 0 and should be 1), which
//!   makes it a method of first order wherever the right-hand side depends on time, as here. Both
//!   set-ups are run: what a user gets, and what a user gets who carries time as a fifth state.
//! - Its dense output is not used: it can only be asked for beforehand at equidistant instants, and
//!   where steps are as long as relaxation lets them be, its extra stages multiply what is left of
//!   q by thousands. A state inside a step is had by integrating again from the step's beginning.
//! - Steps are at most an eighth of a turn of the elastic contact too: guards are looked at at
//!   their ends, where their rates show a peak inside.

use super::{COLOURS, LIBRARY, NEVER_STIFF, STEPS, TimedField, packed, plain};
use crate::engine::cubic::CubicEnd;
use crate::engine::field::{Equations, Oscillator};
use crate::engine::joining::{Moment, StretchEnd, join};
use crate::engine::location::GuardSearch;
use crate::engine::meter::{Failure, Limits, Meter};
use crate::engine::sampler::Sampler;
use crate::engine::walk::{longest_step, walk};
use crate::engine::{Accuracy, Declaration, Engine, Location, Outcome, Role, Stepping, Task, pins};
use ::ode_solvers::OutputType;
use percuss::Phase;

const STAGES: f64 = 12.0;
/// The least multiple in [`Engine::least_work`].
const FIRST_ORDER: f64 = 8e-4;
/// The library keeps a stretch's steps in memory.
const MOST_STEPS: f64 = 4096.0;
/// A piece of a step shorter than this share of it is covered by one step of Euler, whose error
/// there is below rounding; the library would call it an underflow.
const TINY: f64 = 1e-10;

/// ode_solvers' `Dop853` on N states: p, y, q, v and, where N is 5, time.
pub(in super::super) struct Dop853<const N: usize> {
    pub(super) name: &'static str,
    pub(super) role: Role,
}

impl<const N: usize> Engine for Dop853<N> {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: self.name,
            library: LIBRARY,
            version: pins::version(LIBRARY),
            method: if N == 4 {
                "Dormand-Prince 8(5,3)"
            } else {
                "Dormand-Prince 8(5,3), time as a state"
            },
            order: Some(8),
            events: Location::Harness,
            dense_output: false,
            stepping: Stepping::Adaptive,
            role: self.role,
            colours: COLOURS,
        }
    }

    /// At first order the error of a step h is a multiple of a omega h^2, and is held to the
    /// tolerance. The multiple is the least that was measured over the cases.
    fn least_work(&self, task: &Task, accuracy: Accuracy) -> f64 {
        let Some(tolerance) = accuracy.tolerance().filter(|_| N == 4) else { return 0.0 };
        let rate = task.parameters.a * task.parameters.omega;
        STAGES * task.span * (FIRST_ORDER * rate / tolerance).sqrt()
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let tolerance = accuracy.wanted_tolerance()?;
        let meter = Meter::new(limits);
        let equations = Oscillator::of(&task.parameters, task.forcing_angle);
        let run = Dop853Run::<N> { task, tolerance, meter: &meter, equations };
        join(task, &equations, &meter, |from, sampler| run.stretch(from, sampler))
    }
}

struct Dop853Run<'a, const N: usize> {
    task: &'a Task,
    tolerance: f64,
    meter: &'a Meter,
    equations: Oscillator,
}

impl<const N: usize> Dop853Run<'_, N> {
    fn stretch(&self, from: &Moment, sampler: &mut Sampler) -> Result<StretchEnd, Failure> {
        let period = self.task.problem.model.period();
        let longest = longest_step(period);
        let until = (from.t + period.min(MOST_STEPS * longest)).min(self.task.span);
        let mut points = self.integrate(from.phase, (from.t, from.state), until, longest, 0.0)?;
        if let Some(last) = points.last_mut().filter(|last| last.0 > until - TINY * longest) {
            // It is the end but for rounding.
            last.0 = until;
        }
        let search = GuardSearch::new(self.equations, from, self.meter);
        let inside = |left: &CubicEnd, t: f64| self.again(from.phase, left, t);
        walk(search, from, points, sampler, |left, _, t| inside(left, t))
    }

    /// The state at `t` by another integration from a point before it, in one step if that will do.
    fn again(&self, phase: Phase, left: &CubicEnd, t: f64) -> Result<[f64; 4], Failure> {
        let (begin, state) = *left;
        let length = t - begin;
        if length <= TINY * longest_step(self.task.problem.model.period()) {
            let mut rates = [0.0; 4];
            self.equations.derivatives(phase, begin, &state, &mut rates);
            self.meter.rhs(&rates);
            return Ok([0, 1, 2, 3].map(|i| state[i] + rates[i] * length));
        }
        let points = self.integrate(phase, *left, t, length, length)?;
        points.last().map(|last| last.1).ok_or_else(|| Failure::new("took no step"))
    }

    /// The ends of steps up to `until`, or to the first that is outside the phase.
    fn integrate(
        &self,
        phase: Phase,
        from: CubicEnd,
        until: f64,
        longest: f64,
        first: f64,
    ) -> Result<Vec<CubicEnd>, Failure> {
        let (begin, state) = from;
        let field = TimedField {
            equations: self.equations,
            phase,
            meter: self.meter,
            from: state,
            stale: None,
        };
        let mut solver = ::ode_solvers::Dop853::from_param(
            field,
            begin,
            until,
            longest,
            packed::<N>(begin, &state),
            self.tolerance,
            self.tolerance,
            0.9,
            0.0,
            0.333,
            6.0,
            longest,
            first,
            STEPS,
            NEVER_STIFF,
            OutputType::Sparse,
        );
        let stats = solver.integrate().map_err(Failure::new)?;
        self.meter.steps(stats.accepted_steps.into());
        let states = solver.y_out().iter().map(plain);
        Ok(solver.x_out().iter().copied().zip(states).skip(1).collect())
    }
}
