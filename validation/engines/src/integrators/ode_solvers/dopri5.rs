//! `Dopri5` on its continuous output.
//!
//! It is run with `integrate_with_continuous_output_model`: in continuous mode `solout` gets the
//! right state; in dense mode it does not.

use super::{
    COLOURS, LIBRARY, MAX_LIBRARY_STEPS, NO_STIFFNESS_TEST, TimedField, on_vectors_of, packed,
    plain,
};
use crate::accuracy::{Accuracy, Stepping};
use crate::engine::{Class, Declaration, Engine, Limits, Location, Outcome, Role, Task};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{
    Coordinates, GuardRise, GuardSearch, Integration, Meter, Moment, Sampler, StretchEnd, join,
    longest_of_period,
};
use crate::integrators::pins;
use ::ode_solvers::continuous_output_model::ContinuousOutputModel;
use ::ode_solvers::{OVector, OutputType};
use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, U4};
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

impl<E: Coordinates> Engine for Dopri5<E> {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: self.name,
            library: LIBRARY,
            version: pins::version(LIBRARY),
            method: "Dormand-Prince 5(4)",
            class: Some(Class::Explicit),
            order: Some(5),
            events: Location::Harness,
            dense_output: true,
            stepping: Stepping::Adaptive,
            role: self.role,
            colours: COLOURS,
        }
    }

    fn longest_step_on(&self, task: &Task) -> Option<f64> {
        Some(longest_of_period(task.system.period()))
    }

    fn takes(&self, task: &Task) -> Result<(), &'static str> {
        E::describe(task)
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        E::describe(task).map_err(Failure::new)?;
        if let Some(own) = &task.oscillator {
            let integration = Integration::<E>::new(task, own);
            return run::<_, U4>(&integration, accuracy, limits);
        }
        let integration = Integration::of_system(task);
        let states = task.system.system().states.len();
        on_vectors_of!(states, run(&integration, accuracy, limits))
    }
}

/// Runs an integration on vectors of dimension `D`.
fn run<E: Equations, D: Dim>(
    integration: &Integration<'_, E>,
    accuracy: Accuracy,
    limits: &Limits,
) -> Result<Outcome, Failure>
where
    DefaultAllocator: Allocator<D>,
{
    let tolerance = accuracy.wanted_tolerance()?;
    let meter = Meter::new(limits);
    let mut run = Dopri5Run::<E, D>::new(integration, tolerance, &meter);
    join(integration, &meter, |from, sampler| {
        let stretch = run.integrate(from)?;
        let crossing = run.first_crossing(from, &stretch, sampler)?;
        let state_at = |t: f64| stretch.at(t);
        let Some(GuardRise { t, guard }) = crossing else {
            sampler.take(stretch.last(), state_at)?;
            return Ok(StretchEnd::Inside { t: stretch.last(), state: stretch.end });
        };
        sampler.take(t, state_at)?;
        run.step = 0.0;
        Ok(StretchEnd::Event { t, guard, state: state_at(t)? })
    })
}

/// The library's method on one integration.
pub(in crate::integrators) struct Dopri5Run<'a, E: Equations, D> {
    integration: &'a Integration<'a, E>,
    tolerance: f64,
    meter: &'a Meter,
    /// The step to begin the next stretch with; zero: the library chooses.
    pub(in crate::integrators) step: f64,
    /// A mode whose derivative is taken at a stretch's begin instead of its own; a fault.
    pub(in crate::integrators) stale: Option<usize>,
    vectors: PhantomData<fn() -> D>,
}

/// A stretch of one mode, with the ends of its steps.
pub(in crate::integrators) struct DenseStretch<E: Equations, D: Dim>
where
    DefaultAllocator: Allocator<D>,
{
    equations: E,
    output: ContinuousOutputModel<f64, OVector<f64, D>>,
    pub(in crate::integrators) begin: f64,
    pub(in crate::integrators) ends: Vec<f64>,
    /// The states at the ends.
    states: Vec<OVector<f64, D>>,
    pub(in crate::integrators) end: E::State,
}

impl<E: Equations, D: Dim> DenseStretch<E, D>
where
    DefaultAllocator: Allocator<D>,
{
    pub(in crate::integrators) fn last(&self) -> f64 {
        self.ends.last().copied().unwrap_or(self.begin)
    }

    /// The state at a time, by the library's interpolant.
    pub(in crate::integrators) fn at(&self, t: f64) -> Result<E::State, Failure> {
        let state = self.output.evaluate(t).map(|u| plain(&self.equations, &u));
        state.ok_or_else(|| Failure::new("its continuous output has a hole"))
    }
}

impl<'a, E: Equations, D: Dim> Dopri5Run<'a, E, D>
where
    DefaultAllocator: Allocator<D>,
{
    pub(in crate::integrators) fn new(
        integration: &'a Integration<'a, E>,
        tolerance: f64,
        meter: &'a Meter,
    ) -> Self {
        Self { integration, tolerance, meter, step: 0.0, stale: None, vectors: PhantomData }
    }

    /// Integrates one mode for at most a forcing period, or to the first step's end outside it.
    pub(in crate::integrators) fn integrate(
        &mut self,
        from: &Moment<E>,
    ) -> Result<DenseStretch<E, D>, Failure> {
        let Integration { equations, span, times, .. } = self.integration;
        let field = TimedField {
            equations: *equations,
            mode: from.mode,
            meter: self.meter,
            from: from.state,
            stale: self.stale.map(|mode| (from.t, mode)),
        };
        let until = (from.t + times.period).min(*span);
        let longest = longest_of_period(times.period);
        let mut solver = ::ode_solvers::Dopri5::from_param(
            field,
            from.t,
            until,
            longest,
            packed::<D>(from.t, from.state.as_ref(), false),
            self.tolerance,
            self.tolerance,
            0.9,
            0.04,
            0.2,
            10.0,
            longest,
            self.step.min(until - from.t),
            MAX_LIBRARY_STEPS,
            NO_STIFFNESS_TEST,
            OutputType::Continuous,
        );
        let mut output = ContinuousOutputModel::new();
        let stats =
            solver.integrate_with_continuous_output_model(&mut output).map_err(Failure::new)?;
        self.meter.steps(stats.accepted_steps.into());
        let (ends, states) = (solver.x_out().clone(), solver.y_out().clone());
        let end = states.last().ok_or_else(|| Failure::new("took no step"))?;
        self.step = ends.windows(2).last().map_or(0.0, |pair| pair[1] - pair[0]);
        let end = plain(equations, end);
        Ok(DenseStretch { equations: *equations, output, begin: from.t, ends, states, end })
    }

    /// The first instant of a stretch at which a guard has risen to zero.
    pub(in crate::integrators) fn first_crossing(
        &self,
        from: &Moment<E>,
        stretch: &DenseStretch<E, D>,
        sampler: &mut Sampler<E::State>,
    ) -> Result<Option<GuardRise>, Failure> {
        let search = GuardSearch::new(self.integration.equations, from, self.meter);
        let counted = &mut sampler.counted;
        let mut state_at = |t: f64| stretch.at(t);
        let mut left = search.guards_at(from.t, &from.state);
        let ends = stretch.ends.iter().zip(&stretch.states);
        for (end, state) in ends.filter(|(end, _)| **end > stretch.begin) {
            let right = search.guards_at(*end, &plain(&stretch.equations, state));
            let found = search.between(&left, &right, &mut state_at, counted)?;
            if found.is_some() {
                return Ok(found);
            }
            left = right;
        }
        Ok(None)
    }
}
