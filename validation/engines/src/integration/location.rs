//! Event location by this harness, on any dense output of a step.
//!
//! Guards and their rates by the equations of motion are looked at at the ends of a step. A guard
//! has risen to zero if it is there at the second end. Whether it may have done so between two ends
//! that do not show it is asked of the cubic through both (`guard_cubic.rs`): only where that comes
//! near zero is the guard looked at inside, first at the cubic's own turn. The crossing itself is
//! narrowed down to some roundings of its time (`crossing.rs`).

use super::cubic::CubicEnd;
use super::guard_values::GuardValues;
use super::joining::Moment;
use super::meter::Meter;
use super::sampler::CountedCrossing;
use super::script::{GuardRise, ScriptLine, ToldCrossings};
use crate::equations::{Entered, Equations, NO_GUARD, Numbers};
use crate::failure::Failure;

/// The most times that a step is halved where its evaluations so far may hide something.
const MAX_DIVISIONS: u32 = 3;

/// Roots of two guards that are no further apart than this, relative to their time, are one
/// instant: the guard that comes first ends the mode.
const INSTANT_TOLERANCE: f64 = 8.0 * f64::EPSILON;

/// A dense output: the state at an instant.
pub(super) type StateAt<'a, S> = dyn FnMut(f64) -> Result<S, Failure> + 'a;

/// The search for the end of one mode.
pub(crate) struct GuardSearch<'a, E: Equations> {
    pub(super) equations: E,
    pub(super) mode: usize,
    meter: &'a Meter,
    began: f64,
    entered: Entered,
}

impl<'a, E: Equations> GuardSearch<'a, E> {
    pub(crate) fn new(equations: E, from: &Moment<E>, meter: &'a Meter) -> Self {
        let &Moment { mode, began, entered, .. } = from;
        Self { equations, mode, meter, began, entered }
    }

    /// The first crossing in a step at which the mode ends, from looks at the step's ends; those
    /// before it that are only counted go to `counted`.
    pub(crate) fn between(
        &self,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
        counted: &mut Vec<CountedCrossing<E::State>>,
    ) -> Result<Option<GuardRise>, Failure> {
        if let Some(told) = self.meter.scripted_crossings() {
            return Self::scripted_crossing(told, right.t, state_at, counted);
        }
        self.meter.record_step(right.t);
        let guards = self.equations.count(self.mode);
        if (0..guards).all(|guard| left.cubic_to(right, guard).stays_inside()) {
            return Ok(None);
        }
        self.crossing_in_divisions(left, right, MAX_DIVISIONS, state_at, counted)
    }

    /// What a run that was made before has found in this step.
    fn scripted_crossing(
        told: &ToldCrossings,
        end: f64,
        state_at: &mut StateAt<'_, E::State>,
        counted: &mut Vec<CountedCrossing<E::State>>,
    ) -> Result<Option<GuardRise>, Failure> {
        while let Some(ScriptLine { rise, ends }) = told.up_to(end) {
            if ends {
                return Ok(Some(rise));
            }
            let GuardRise { t, guard } = rise;
            counted.push(CountedCrossing { t, guard, state: state_at(t)? });
        }
        Ok(None)
    }

    /// The first crossing between two looks, with looks between them where they may hide something.
    fn crossing_in_divisions(
        &self,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        divisions: u32,
        state_at: &mut StateAt<'_, E::State>,
        counted: &mut Vec<CountedCrossing<E::State>>,
    ) -> Result<Option<GuardRise>, Failure> {
        let inside = |t: &f64| *t > left.t && *t < right.t;
        let division = self.division(left, right).filter(|t| divisions > 0 && inside(t));
        let Some(t) = division else {
            return self.crossing_between(left, right, state_at, counted);
        };
        let middle = self.look_at(t, state_at)?;
        let found = self.crossing_in_divisions(left, &middle, divisions - 1, state_at, counted)?;
        if found.is_some() {
            return Ok(found);
        }
        self.crossing_in_divisions(&middle, right, divisions - 1, state_at, counted)
    }

    /// Where to look between two looks that may hide a change of sign.
    fn division(
        &self,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
    ) -> Option<f64> {
        let cubics = (0..self.equations.count(self.mode))
            .map(|guard| (left.cubic_to(right, guard), self.equations.ends(self.mode, guard)));
        let mut hiding = cubics.filter(|(cubic, ends)| cubic.hides(*ends));
        hiding.next().map(|(cubic, _)| cubic.division())
    }

    /// The first crossing between two looks.
    fn crossing_between(
        &self,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
        counted: &mut Vec<CountedCrossing<E::State>>,
    ) -> Result<Option<GuardRise>, Failure> {
        let mut first: Option<GuardRise> = None;
        let guards = self.equations.count(self.mode);
        for guard in (0..guards).filter(|guard| self.equations.ends(self.mode, *guard)) {
            let found = self.of_ending_guard(guard, left, right, state_at)?;
            let earlier =
                |t: &f64| first.is_none_or(|first| *t < first.t * (1.0 - INSTANT_TOLERANCE));
            if let Some(t) = found.filter(earlier) {
                first = Some(GuardRise { t, guard });
            }
        }
        let known = counted.len();
        for guard in (0..guards).filter(|guard| !self.equations.ends(self.mode, *guard)) {
            let found = self.of_watched_guard(guard, left, right, state_at)?;
            let before =
                |t: &f64| first.is_none_or(|first| *t <= first.t * (1.0 + INSTANT_TOLERANCE));
            if let Some(t) = found.filter(before) {
                let t = first.map_or(t, |first| t.min(first.t));
                counted.push(CountedCrossing { t, guard, state: state_at(t)? });
            }
        }
        counted[known..].sort_by(|one, other| one.t.total_cmp(&other.t));
        Ok(first)
    }

    /// A state that is known, a little later or earlier, by Heun's step.
    pub(super) fn moved(&self, known: &CubicEnd<E::State>, t: f64) -> E::State {
        let (begin, state) = known;
        let length = t - begin;
        let rates = self.derivatives(*begin, state);
        let after = self.derivatives(t, &moved_by(state, &rates, length));
        moved_by(&moved_by(state, &rates, 0.5 * length), &after, 0.5 * length)
    }

    fn derivatives(&self, t: f64, state: &E::State) -> E::State {
        let mut rates = *state;
        self.equations.derivatives(self.mode, t, state.as_ref(), rates.as_mut());
        self.meter.rhs(rates.as_ref());
        rates
    }

    /// The guards of a known state.
    pub(crate) fn guards_at(&self, t: f64, state: &E::State) -> GuardValues<E::Guards> {
        if self.meter.scripted_crossings().is_some() {
            return self.no_look(t);
        }
        let state = state.as_ref();
        let mut guards = self.equations.guards(self.mode, t, state);
        self.meter.guards(t, self.mode, &guards.as_ref()[..self.equations.count(self.mode)]);
        if t == self.began {
            self.equations.settle(self.entered, state, &mut guards);
        }
        GuardValues { t, guards, rates: self.equations.rates(self.mode, t, state) }
    }

    /// The guards at an instant.
    pub(crate) fn look_at(
        &self,
        t: f64,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<GuardValues<E::Guards>, Failure> {
        if self.meter.scripted_crossings().is_some() {
            return Ok(self.no_look(t));
        }
        Ok(self.guards_at(t, &state_at(t)?))
    }

    /// In place of a look in a run that is told its events.
    fn no_look(&self, t: f64) -> GuardValues<E::Guards> {
        let count = self.equations.most_guards();
        let [guards, rates] = [NO_GUARD, 0.0].map(|value| E::Guards::all(count, value));
        GuardValues { t, guards, rates }
    }
}

/// A state moved on at these rates.
fn moved_by<S: Numbers>(state: &S, rates: &S, length: f64) -> S {
    let mut there = *state;
    for (value, rate) in there.as_mut().iter_mut().zip(rates.as_ref()) {
        *value += rate * length;
    }
    there
}

#[cfg(test)]
#[path = "location_tests.rs"]
mod tests;
