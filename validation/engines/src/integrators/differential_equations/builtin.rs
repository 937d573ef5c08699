//! The library's built-in event location, as an engine of its own beside ours on the same method.
//!
//! - Guards are events of rising direction that end the integration; the library looks at the ends
//!   of steps and narrows a change of sign down by a method of Brent's.
//! - Of two events in one step the library takes the one registered first. Both are located here,
//!   by the library, and the earlier one counts.
//! - Its Brent step returns after a few evaluations with an end of the bracket, whatever the
//!   tolerance: times are good to 1e-4 or 1e-5 only.

use super::method::{LibraryMethod, Rkv655e};
use super::state::of_size;
use super::{COLOURS, LIBRARY, ModeField, reason};
use crate::accuracy::{Accuracy, Stepping};
use crate::engine::{
    Class, Declaration, Engine, GuardSample, Limits, Location, Outcome, Role, Task,
};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{
    CountedCrossing, Integration, Meter, Moment, Oscillator, Sampler, StretchEnd, join,
    longest_of_period,
};
use crate::integrators::pins;
use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::ode::solve_ode;
use differential_equations::solout::{CrossingDirection, Event, EventConfig, EventSolout, Solout};
use differential_equations::solution::Solution;
use differential_equations::traits::State;

/// `rkv655e` with the library's events.
pub(in super::super) struct BuiltIn;

impl Engine for BuiltIn {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: "differential-equations-rkv655e-events",
            library: LIBRARY,
            version: pins::version(LIBRARY),
            method: "Verner 6(5), built-in events",
            class: Some(Class::Explicit),
            order: Rkv655e::ORDER,
            events: Location::Library,
            dense_output: true,
            stepping: Stepping::Adaptive,
            role: Role::Rows,
            colours: COLOURS,
        }
    }

    fn longest_step_on(&self, task: &Task) -> Option<f64> {
        Some(longest_of_period(task.system.period()))
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        if let Some(own) = &task.oscillator {
            let integration = Integration::<Oscillator>::new(task, own);
            return run(&integration, accuracy, limits);
        }
        let integration = Integration::of_system(task);
        of_size(integration.state.as_ref().len(), || run(&integration, accuracy, limits))
    }
}

/// Runs an integration with the library's events.
fn run<E: Equations<State: State<f64>>>(
    integration: &Integration<'_, E>,
    accuracy: Accuracy,
    limits: &Limits,
) -> Result<Outcome, Failure> {
    let tolerance = accuracy.wanted_tolerance()?;
    let meter = Meter::new(limits);
    let Integration { equations, span, times, .. } = *integration;
    let longest = longest_of_period(times.period);
    join(integration, &meter, |from, sampler| {
        let field = ModeField { equations, mode: from.mode, meter: &meter };
        let guard = |guard| GuardEvent { field, guard };
        let guards: Vec<_> = (0..equations.most_guards()).map(guard).collect();
        let mut watch = BuiltinEvents::new(field, &guards, from, span, sampler);
        let mut method = Rkv655e::method(equations.dimension(), tolerance, longest, 0.0);
        solve_ode(&mut method, &field, from.t, span, &from.state, &mut watch)
            .map_err(|error| reason(&error))?;
        watch.ended.unwrap_or(Ok(StretchEnd::Inside { t: span, state: watch.last }))
    })
}

/// A guard as an event of the library's.
struct GuardEvent<'a, E: Equations> {
    field: ModeField<'a, E>,
    guard: usize,
}

impl<E: Equations<State: State<f64>>> Event<f64, E::State> for GuardEvent<'_, E> {
    fn config(&self) -> EventConfig {
        let ends = self.field.equations.ends(self.field.mode, self.guard);
        EventConfig::new(CrossingDirection::Positive, ends.then_some(1))
    }

    fn event(&self, t: f64, u: &E::State) -> f64 {
        let ModeField { equations, mode, meter } = self.field;
        let value = equations.guards(mode, t, u.as_ref()).as_ref()[self.guard];
        if self.guard < equations.count(mode) {
            meter.guard(GuardSample { t, mode, guard: self.guard, value });
        } else {
            meter.call();
        }
        value
    }
}

/// The library's events, and samples up to the first of them that ends the mode.
struct BuiltinEvents<'a, E: Equations<State: State<f64>>> {
    field: ModeField<'a, E>,
    from: Moment<E>,
    events: Vec<EventSolout<'a, f64, E::State, GuardEvent<'a, E>>>,
    sampler: &'a mut Sampler<E::State>,
    last: E::State,
    ended: Option<Result<StretchEnd<E::State>, Failure>>,
}

impl<'a, E: Equations<State: State<f64>>> BuiltinEvents<'a, E> {
    fn new(
        field: ModeField<'a, E>,
        guards: &'a [GuardEvent<'a, E>],
        from: &Moment<E>,
        span: f64,
        sampler: &'a mut Sampler<E::State>,
    ) -> Self {
        let events = guards.iter().map(|guard| EventSolout::new(guard, from.t, span)).collect();
        Self { field, from: *from, events, sampler, last: from.state, ended: None }
    }

    /// Keeps those crossings of a step that end nothing and come before the mode ends.
    fn count(&mut self, mut crossings: Vec<CountedCrossing<E::State>>, until: f64) {
        crossings.retain(|crossing| crossing.t <= until);
        crossings.sort_by(|one, other| one.t.total_cmp(&other.t));
        self.sampler.counted.append(&mut crossings);
    }
}

impl<E: Equations<State: State<f64>>> Solout<f64, E::State> for BuiltinEvents<'_, E> {
    fn solout<I>(
        &mut self,
        end: f64,
        begin: f64,
        state: &E::State,
        before: &E::State,
        interpolator: &mut I,
        _: &mut Solution<f64, E::State>,
    ) -> ControlFlag<f64, E::State>
    where
        I: Interpolation<f64, E::State> + ?Sized,
    {
        let mut first: Option<CountedCrossing<E::State>> = None;
        let mut counted = Vec::new();
        for (guard, event) in self.events.iter_mut().enumerate() {
            let mut found = Solution::new();
            event.solout(end, begin, state, before, interpolator, &mut found);
            let (Some(t), Some(state)) = (found.t.last(), found.y.last()) else { continue };
            let crossing = CountedCrossing { t: *t, guard, state: *state };
            if !self.field.equations.ends(self.field.mode, guard) {
                // A guard that is zero at its mode's entry has no sign there.
                let no_sign = begin <= self.from.began && self.from.entered.is_zero(guard);
                counted.extend((!no_sign).then_some(crossing));
            } else if first.is_none_or(|earliest| *t < earliest.t) {
                first = Some(crossing);
            }
        }
        self.last = *state;
        if end <= begin {
            return ControlFlag::Continue;
        }
        self.field.meter.steps(1);
        self.field.meter.record_step(end);
        let until = first.map_or(end, |first| first.t);
        self.count(counted, until);
        let state_at = |t: f64| interpolator.interpolate(t).map_err(|error| reason(&error));
        let taken = self.sampler.take(until, state_at);
        self.ended = match (taken, first) {
            (Err(failure), _) => Some(Err(failure)),
            (Ok(()), Some(CountedCrossing { t, guard, state })) => {
                Some(Ok(StretchEnd::Event { t, guard, state }))
            }
            (Ok(()), None) => return ControlFlag::Continue,
        };
        ControlFlag::Terminate
    }
}
