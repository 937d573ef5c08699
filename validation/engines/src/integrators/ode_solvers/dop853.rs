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

use super::{
    COLOURS, LIBRARY, MAX_LIBRARY_STEPS, NO_STIFFNESS_TEST, TimedField, on_vectors_of, packed,
    plain,
};
use crate::accuracy::{Accuracy, Stepping};
use crate::engine::{Class, Declaration, Engine, Limits, Location, Outcome, Role, Task};
use crate::equations::{Equations, Numbers};
use crate::failure::Failure;
use crate::integration::{
    CubicEnd, GuardSearch, Integration, Meter, Moment, Oscillator, Sampler, StretchEnd, join,
    locate_at_step_ends, longest_of_period, longest_step,
};
use crate::integrators::pins;
use crate::system::Mode;
use ::ode_solvers::OutputType;
use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, U4, U5};
use std::marker::PhantomData;

/// Evaluations of the right-hand side in a step.
const STAGES_PER_STEP: f64 = 12.0;
/// The least multiple in [`Engine::least_work`].
const MIN_ERROR_MULTIPLE: f64 = 8e-4;
/// The most steps of one stretch, which the library keeps in memory.
const MAX_STRETCH_STEPS: f64 = 4096.0;
/// A piece of a step shorter than this share of it is covered by one step of Euler, whose error
/// there is below rounding in the oscillator; the library would call it an underflow. Where impacts
/// accumulate whole flights are as short: other systems have Heun's step.
const MIN_PIECE_SHARE: f64 = 1e-10;

/// ode_solvers' `Dop853`.
pub(in super::super) struct Dop853 {
    pub(super) name: &'static str,
    pub(super) role: Role,
    /// Whether time is integrated as one more state.
    pub(super) clock: bool,
}

impl Engine for Dop853 {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: self.name,
            library: LIBRARY,
            version: pins::version(LIBRARY),
            method: if self.clock {
                "Dormand-Prince 8(5,3), time as a state"
            } else {
                "Dormand-Prince 8(5,3)"
            },
            class: Some(Class::Explicit),
            order: Some(8),
            events: Location::Harness,
            dense_output: false,
            stepping: Stepping::Adaptive,
            role: self.role,
            colours: COLOURS,
        }
    }

    fn longest_step_on(&self, task: &Task) -> Option<f64> {
        Some(longest_of_period(task.system.period()))
    }

    /// At first order the error of a step h is a multiple of r h^2, and is held to the tolerance: r
    /// is the largest rate at which theta changes a state's rate over its scale, a omega on the
    /// oscillator. The multiple is the least that was measured over the oscillator's cases. A mode
    /// in which theta changes nothing costs nothing.
    fn least_work(&self, task: &Task, accuracy: Accuracy) -> f64 {
        let Some(tolerance) = accuracy.tolerance().filter(|_| !self.clock) else { return 0.0 };
        let system = task.system.system();
        let forcing = |mode: &Mode| {
            let sizes = mode.b.iter().zip(&system.scales);
            sizes.map(|([cos, sin], scale)| cos.hypot(*sin) / scale).fold(0.0, f64::max)
        };
        let least = system.modes.iter().map(forcing).fold(f64::INFINITY, f64::min);
        STAGES_PER_STEP
            * task.span
            * (MIN_ERROR_MULTIPLE * least * system.omega.abs() / tolerance).sqrt()
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        if let Some(own) = &task.oscillator {
            let integration = Integration::<Oscillator>::new(task, own);
            return if self.clock {
                run::<_, U5>(&integration, [true, false], accuracy, limits)
            } else {
                run::<_, U4>(&integration, [false; 2], accuracy, limits)
            };
        }
        let integration = Integration::of_system(task);
        let states = task.system.system().states.len() + usize::from(self.clock);
        on_vectors_of!(states, run(&integration, [self.clock, true], accuracy, limits))
    }
}

/// Runs an integration on vectors of dimension `D`.
fn run<E: Equations, D: Dim>(
    integration: &Integration<'_, E>,
    [clock, heun]: [bool; 2],
    accuracy: Accuracy,
    limits: &Limits,
) -> Result<Outcome, Failure>
where
    DefaultAllocator: Allocator<D>,
{
    let tolerance = accuracy.wanted_tolerance()?;
    let meter = Meter::new(limits);
    let longest = longest_step(&integration.times);
    let vectors = PhantomData;
    let run =
        Dop853Run::<E, D> { integration, clock, heun, tolerance, longest, meter: &meter, vectors };
    join(integration, &meter, |from, sampler| run.stretch(from, sampler))
}

/// A state moved on at these rates.
fn moved<S: Numbers>(state: &S, rates: &S, length: f64) -> S {
    let mut there = *state;
    for (value, rate) in there.as_mut().iter_mut().zip(rates.as_ref()) {
        *value += rate * length;
    }
    there
}

struct Dop853Run<'a, E: Equations, D> {
    integration: &'a Integration<'a, E>,
    clock: bool,
    heun: bool,
    tolerance: f64,
    longest: f64,
    meter: &'a Meter,
    vectors: PhantomData<fn() -> D>,
}

impl<E: Equations, D: Dim> Dop853Run<'_, E, D>
where
    DefaultAllocator: Allocator<D>,
{
    fn stretch(
        &self,
        from: &Moment<E>,
        sampler: &mut Sampler<E::State>,
    ) -> Result<StretchEnd<E::State>, Failure> {
        let longest = self.longest;
        let ahead = self.integration.times.period.min(MAX_STRETCH_STEPS * longest);
        let until = (from.t + ahead).min(self.integration.span);
        let mut points = self.integrate(from.mode, (from.t, from.state), until, longest, 0.0)?;
        if let Some(last) =
            points.last_mut().filter(|last| last.0 > until - MIN_PIECE_SHARE * longest)
        {
            // It is the end but for rounding.
            last.0 = until;
        }
        let search = GuardSearch::new(self.integration.equations, from, self.meter);
        locate_at_step_ends(search, from, true, points, sampler, |left, _, t| {
            self.recomputed_state(from.mode, left, t)
        })
    }

    /// The state at `t` by another integration from a point before it, in one step if that will do.
    fn recomputed_state(
        &self,
        mode: usize,
        left: &CubicEnd<E::State>,
        t: f64,
    ) -> Result<E::State, Failure> {
        let (begin, state) = *left;
        let length = t - begin;
        if length <= MIN_PIECE_SHARE * self.longest {
            let rates = self.rates(mode, begin, &state);
            let there = moved(&state, &rates, length);
            if !self.heun {
                return Ok(there);
            }
            let after = self.rates(mode, t, &there);
            return Ok(moved(&moved(&state, &rates, 0.5 * length), &after, 0.5 * length));
        }
        let points = self.integrate(mode, *left, t, length, length)?;
        points.last().map(|last| last.1).ok_or_else(|| Failure::new("took no step"))
    }

    fn rates(&self, mode: usize, t: f64, state: &E::State) -> E::State {
        let mut rates = *state;
        self.integration.equations.derivatives(mode, t, state.as_ref(), rates.as_mut());
        self.meter.rhs(rates.as_ref());
        rates
    }

    /// The ends of steps up to `until`, or to the first that is outside the mode.
    fn integrate(
        &self,
        mode: usize,
        from: CubicEnd<E::State>,
        until: f64,
        longest: f64,
        first: f64,
    ) -> Result<Vec<CubicEnd<E::State>>, Failure> {
        let (begin, state) = from;
        let equations = self.integration.equations;
        let field = TimedField { equations, mode, meter: self.meter, from: state, stale: None };
        let mut solver = ::ode_solvers::Dop853::from_param(
            field,
            begin,
            until,
            longest,
            packed::<D>(begin, state.as_ref(), self.clock),
            self.tolerance,
            self.tolerance,
            0.9,
            0.0,
            0.333,
            6.0,
            longest,
            first,
            MAX_LIBRARY_STEPS,
            NO_STIFFNESS_TEST,
            OutputType::Sparse,
        );
        let stats = solver.integrate().map_err(Failure::new)?;
        self.meter.steps(stats.accepted_steps.into());
        let states = solver.y_out().iter().map(|u| plain(&equations, u));
        Ok(solver.x_out().iter().copied().zip(states).skip(1).collect())
    }
}
