//! The library's built-in event location, as an engine of its own beside ours on the same method.
//!
//! - Guards are events of rising direction that end the integration; the library looks at the ends
//!   of steps and narrows a change of sign down by a method of Brent's.
//! - Of two events in one step the library takes the one registered first. Both are located here,
//!   by the library, and the earlier one counts.
//! - Its Brent step returns after a few evaluations with an end of the bracket, whatever the
//!   tolerance: times are good to 1e-4 or 1e-5 only.

use super::method::{LibraryMethod, Rkv655e};
use super::{COLOURS, LIBRARY, LONGEST_STEP, PhaseField, reason};
use crate::engine::field::{Equations, GUARDS, Oscillator};
use crate::engine::joining::{Moment, StretchEnd, join};
use crate::engine::meter::{Failure, Limits, Meter};
use crate::engine::sampler::Sampler;
use crate::engine::trace::GuardSample;
use crate::engine::{Accuracy, Declaration, Engine, Location, Outcome, Role, Stepping, Task, pins};
use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::ode::solve_ode;
use differential_equations::solout::{CrossingDirection, Event, EventConfig, EventSolout, Solout};
use differential_equations::solution::Solution;

/// `rkv655e` with the library's events.
pub(in super::super) struct BuiltIn;

impl Engine for BuiltIn {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: "differential-equations-rkv655e-events",
            library: LIBRARY,
            version: pins::version(LIBRARY),
            method: "Verner 6(5), built-in events",
            order: Rkv655e::ORDER,
            events: Location::Library,
            dense_output: true,
            stepping: Stepping::Adaptive,
            role: Role::Rows,
            colours: COLOURS,
        }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let tolerance = accuracy.wanted_tolerance()?;
        let meter = Meter::new(limits);
        let equations = Oscillator::of(&task.parameters, task.forcing_angle);
        let longest = LONGEST_STEP * task.problem.model.period();
        join(task, &equations, &meter, |from, sampler| {
            let field = PhaseField { equations, phase: from.phase, meter: &meter };
            let guards = [0, 1].map(|guard| Guard { field, guard });
            let mut watch = BuiltinEvents::new(&guards, from, task.span, sampler);
            let mut method = Rkv655e::method(tolerance, longest, 0.0);
            solve_ode(&mut method, &field, from.t, task.span, &from.state, &mut watch)
                .map_err(|error| reason(&error))?;
            watch.ended.unwrap_or(Ok(StretchEnd::Inside { t: task.span, state: watch.last }))
        })
    }
}

/// A guard as an event of the library's.
struct Guard<'a> {
    field: PhaseField<'a, Oscillator>,
    guard: usize,
}

impl Event<f64, [f64; 4]> for Guard<'_> {
    fn config(&self) -> EventConfig {
        EventConfig::new(CrossingDirection::Positive, Some(1))
    }

    fn event(&self, t: f64, u: &[f64; 4]) -> f64 {
        let PhaseField { equations, phase, meter } = self.field;
        let value = equations.guards(phase, u)[self.guard];
        meter.guard(GuardSample { t, phase, guard: self.guard, value });
        value
    }
}

/// The library's events, and samples up to the first of them.
struct BuiltinEvents<'a> {
    events: [EventSolout<'a, f64, [f64; 4], Guard<'a>>; GUARDS],
    sampler: &'a mut Sampler,
    meter: &'a Meter,
    last: [f64; 4],
    ended: Option<Result<StretchEnd, Failure>>,
}

impl<'a> BuiltinEvents<'a> {
    fn new(
        guards: &'a [Guard<'a>; GUARDS],
        from: &Moment,
        span: f64,
        sampler: &'a mut Sampler,
    ) -> Self {
        let events = guards.each_ref().map(|guard| EventSolout::new(guard, from.t, span));
        Self { events, sampler, meter: guards[0].field.meter, last: from.state, ended: None }
    }
}

impl Solout<f64, [f64; 4]> for BuiltinEvents<'_> {
    fn solout<I>(
        &mut self,
        end: f64,
        begin: f64,
        state: &[f64; 4],
        before: &[f64; 4],
        interpolator: &mut I,
        _: &mut Solution<f64, [f64; 4]>,
    ) -> ControlFlag<f64, [f64; 4]>
    where
        I: Interpolation<f64, [f64; 4]> + ?Sized,
    {
        let mut first: Option<(f64, usize, [f64; 4])> = None;
        for (guard, event) in self.events.iter_mut().enumerate() {
            let mut found = Solution::new();
            event.solout(end, begin, state, before, interpolator, &mut found);
            if let (Some(t), Some(state)) = (found.t.last(), found.y.last())
                && first.is_none_or(|(earliest, ..)| *t < earliest)
            {
                first = Some((*t, guard, *state));
            }
        }
        self.last = *state;
        if end <= begin {
            return ControlFlag::Continue;
        }
        self.meter.steps(1);
        self.meter.stepped(end);
        let until = first.map_or(end, |(t, ..)| t);
        let state_at = |t: f64| interpolator.interpolate(t).map_err(|error| reason(&error));
        let taken = self.sampler.take(until, state_at);
        self.ended = match (taken, first) {
            (Err(failure), _) => Some(Err(failure)),
            (Ok(()), Some((t, guard, state))) => Some(Ok(StretchEnd::Switch { t, guard, state })),
            (Ok(()), None) => return ControlFlag::Continue,
        };
        ControlFlag::Terminate
    }
}
