//! `Rk4`: fixed steps, and between the ends of a step the cubic of Hermite, whose error is of the
//! method's own order.
//!
//! - Steps are h = step x the system's shortest time, shortened so that a whole number of them
//!   fills a stretch: the library itself would step past the end.
//! - Guards are looked at at the ends of steps; those that peak inside are found by their rates.

use super::{COLOURS, LIBRARY, TimedField, on_vectors_of, packed, plain};
use crate::accuracy::{Accuracy, Stepping};
use crate::engine::{Class, Declaration, Engine, Limits, Location, Outcome, Role, Task};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{
    Cubic, GuardSearch, Integration, Meter, Moment, Oscillator, Sampler, StretchEnd, join,
    locate_at_step_ends,
};
use crate::integrators::pins;
use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, U4};
use std::marker::PhantomData;

/// ode_solvers' `Rk4`.
pub(in super::super) struct Rk4;

const ORDER: i32 = 4;
/// Evaluations of the right-hand side in a step.
const STAGES_PER_STEP: f64 = 4.0;
/// The most steps of one stretch, which the library keeps in memory.
const MAX_STRETCH_STEPS: f64 = 16384.0;

impl Engine for Rk4 {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: "ode_solvers-rk4",
            library: LIBRARY,
            version: pins::version(LIBRARY),
            method: "classical Runge-Kutta 4, fixed steps",
            class: Some(Class::Explicit),
            order: Some(ORDER as u32),
            events: Location::Harness,
            dense_output: false,
            stepping: Stepping::Fixed { order: ORDER },
            role: Role::Rows,
            colours: COLOURS,
        }
    }

    fn least_work(&self, task: &Task, accuracy: Accuracy) -> f64 {
        let step = |step: f64| step * task.shortest_time();
        accuracy.step().map_or(0.0, |it| STAGES_PER_STEP * task.span / step(it))
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        if let Some(own) = &task.oscillator {
            let integration = Integration::<Oscillator>::new(task, own);
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
    let step = accuracy.wanted_step()? * integration.times.shortest;
    let meter = Meter::new(limits);
    let run = Rk4Run::<E, D> { integration, step, meter: &meter, vectors: PhantomData };
    join(integration, &meter, |from, sampler| run.stretch(from, sampler))
}

struct Rk4Run<'a, E: Equations, D> {
    integration: &'a Integration<'a, E>,
    step: f64,
    meter: &'a Meter,
    vectors: PhantomData<fn() -> D>,
}

impl<E: Equations, D: Dim> Rk4Run<'_, E, D>
where
    DefaultAllocator: Allocator<D>,
{
    fn stretch(
        &self,
        from: &Moment<E>,
        sampler: &mut Sampler<E::State>,
    ) -> Result<StretchEnd<E::State>, Failure> {
        let Integration { equations, span, times, .. } = self.integration;
        let longest = times.period.min(MAX_STRETCH_STEPS * self.step);
        let length = longest.min(span - from.t);
        let count = (length / self.step).ceil().max(1.0);
        self.meter.affords(STAGES_PER_STEP * count)?;
        let step = length / count;
        let (mode, state) = (from.mode, from.state);
        let field =
            TimedField { equations: *equations, mode, meter: self.meter, from: state, stale: None };
        // The library makes it a whole number of steps, upwards: half a step short of the end is
        // safe.
        let until = from.t + (count - 0.5) * step;
        let begin = packed::<D>(from.t, state.as_ref(), false);
        let mut solver = ::ode_solvers::Rk4::new(field, from.t, begin, until, step);
        let stats = solver.integrate().map_err(Failure::new)?;
        self.meter.steps(stats.accepted_steps.into());
        let search = GuardSearch::new(*equations, from, self.meter);
        // The library's own times are sums of steps.
        let time = |k: usize| from.t + length * (k as f64 / count);
        let points = solver.y_out().iter().enumerate().skip(1);
        let points = points.map(|(k, u)| (time(k), plain(equations, u)));
        let mut cubic: Option<Cubic<E::State>> = None;
        locate_at_step_ends(search, from, false, points, sampler, |left, right, t| {
            let known = cubic.take().filter(|known| known.begins_at(left.0));
            let here = known.unwrap_or_else(|| {
                let ends = [*left, *right];
                Cubic::between(ends, |(t, state), rates| {
                    equations.derivatives(mode, t, state.as_ref(), rates);
                    self.meter.rhs(rates);
                })
            });
            let state = here.at(t);
            cubic = Some(here);
            Ok(state)
        })
    }
}
