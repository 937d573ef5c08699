//! `Dopri5` on its continuous output.
//!
//! It is run with `integrate_with_continuous_output_model`: in continuous mode `solout` gets the
//! right state; in dense mode it does not.

use super::{COLOURS, LIBRARY, LONGEST_STEP, NEVER_STIFF, STEPS, TimedField, packed, plain};
use crate::engine::field::Equations;
use crate::engine::joining::{Moment, StretchEnd, join};
use crate::engine::location::{GuardRise, GuardSearch};
use crate::engine::meter::{Failure, Limits, Meter};
use crate::engine::{Accuracy, Declaration, Engine, Location, Outcome, Role, Stepping, Task, pins};
use ::ode_solvers::continuous_output_model::ContinuousOutputModel;
use ::ode_solvers::{OutputType, SVector};
use percuss::Phase;
use std::marker::PhantomData;

/// ode_solvers' `Dopri5` on some equations.
pub(in super::super) struct Dopri5<E> {
    name: &'static str,
    role: Role,
    equations: PhantomData<fn() -> E>,
}

impl<E> Dopri5<E> {
    pub(super) const fn new(name: &'static str, role: Role) -> Self {
        Self { name, role, equations: PhantomData }
    }
}

impl<E: Equations> Engine for Dopri5<E> {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: self.name,
            library: LIBRARY,
            version: pins::version(LIBRARY),
            method: "Dormand-Prince 5(4)",
            order: Some(5),
            events: Location::Harness,
            dense_output: true,
            stepping: Stepping::Adaptive,
            role: self.role,
            colours: COLOURS,
        }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let tolerance = accuracy.wanted_tolerance()?;
        let meter = Meter::new(limits);
        let equations = E::of(&task.parameters, task.forcing_angle);
        let mut run = Dopri5Run::new(task, tolerance, &meter, equations);
        join(task, &equations, &meter, |from, sampler| {
            let stretch = run.integrate(from)?;
            let crossing = run.first_crossing(from, &stretch)?;
            let state_at = |t: f64| evaluate(&stretch.output, t);
            let Some(GuardRise { t, guard }) = crossing else {
                sampler.take(stretch.last(), state_at)?;
                return Ok(StretchEnd::Inside { t: stretch.last(), state: stretch.end });
            };
            sampler.take(t, state_at)?;
            run.step = 0.0;
            Ok(StretchEnd::Switch { t, guard, state: state_at(t)? })
        })
    }
}

pub(in crate::engine) type Output = ContinuousOutputModel<f64, SVector<f64, 4>>;

/// The library's method on one task.
pub(in crate::engine) struct Dopri5Run<'a, E> {
    task: &'a Task,
    tolerance: f64,
    meter: &'a Meter,
    equations: E,
    /// The step to begin the next stretch with; zero: the library chooses.
    pub(in crate::engine) step: f64,
    /// A phase whose derivative is taken at a stretch's begin instead of its own; a fault.
    pub(in crate::engine) stale: Option<Phase>,
}

/// A stretch of one phase, with the ends of its steps.
pub(in crate::engine) struct Stretch {
    pub(in crate::engine) output: Output,
    pub(in crate::engine) begin: f64,
    pub(in crate::engine) ends: Vec<f64>,
    pub(in crate::engine) end: [f64; 4],
}

impl Stretch {
    pub(in crate::engine) fn last(&self) -> f64 {
        self.ends.last().copied().unwrap_or(self.begin)
    }
}

impl<'a, E: Equations> Dopri5Run<'a, E> {
    pub(in crate::engine) fn new(
        task: &'a Task,
        tolerance: f64,
        meter: &'a Meter,
        equations: E,
    ) -> Self {
        Self { task, tolerance, meter, equations, step: 0.0, stale: None }
    }

    /// Integrates one phase for at most a forcing period, or to the first step's end outside it.
    pub(in crate::engine) fn integrate(&mut self, from: &Moment) -> Result<Stretch, Failure> {
        let period = self.task.problem.model.period();
        let field = TimedField {
            equations: self.equations,
            phase: from.phase,
            meter: self.meter,
            from: from.state,
            stale: self.stale.map(|phase| (from.t, phase)),
        };
        let until = (from.t + period).min(self.task.span);
        let longest = LONGEST_STEP * period;
        let mut solver = ::ode_solvers::Dopri5::from_param(
            field,
            from.t,
            until,
            longest,
            packed::<4>(from.t, &from.state),
            self.tolerance,
            self.tolerance,
            0.9,
            0.04,
            0.2,
            10.0,
            longest,
            self.step.min(until - from.t),
            STEPS,
            NEVER_STIFF,
            OutputType::Continuous,
        );
        let mut output = Output::new();
        let stats =
            solver.integrate_with_continuous_output_model(&mut output).map_err(Failure::new)?;
        self.meter.steps(stats.accepted_steps.into());
        let end = solver.y_out().last().ok_or_else(|| Failure::new("took no step"))?;
        let ends = solver.x_out().clone();
        self.step = ends.windows(2).last().map_or(0.0, |pair| pair[1] - pair[0]);
        Ok(Stretch { output, begin: from.t, ends, end: plain(end) })
    }

    /// The first instant of a stretch at which a guard has risen to zero.
    pub(in crate::engine) fn first_crossing(
        &self,
        from: &Moment,
        stretch: &Stretch,
    ) -> Result<Option<GuardRise>, Failure> {
        let search = GuardSearch::new(self.equations, from, self.meter);
        let mut begin = stretch.begin;
        for end in stretch.ends.iter().copied().filter(|end| *end > stretch.begin) {
            let found = search.step(begin, end, &mut |t| evaluate(&stretch.output, t))?;
            if found.is_some() {
                return Ok(found);
            }
            begin = end;
        }
        Ok(None)
    }
}

pub(in crate::engine) fn evaluate(output: &Output, t: f64) -> Result<[f64; 4], Failure> {
    let state = output.evaluate(t);
    state.map(|u| plain(&u)).ok_or_else(|| Failure::new("its continuous output has a hole"))
}
