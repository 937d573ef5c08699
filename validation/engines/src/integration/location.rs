//! Event location by this harness, on any dense output of a step.
//!
//! The guards are looked at at [`INTERIOR`] instants inside a step. Between two of them a guard has
//! risen to zero if it is there at the second, or if it was rising at the first, is falling at the
//! second and its peak, found by bisection of its rate, reaches zero: so a touch shorter than the
//! interval is seen wherever the dense output shows it. Rates come from the equations of motion.
//! The crossing itself is then narrowed down to the last bit.

use super::joining::Moment;
use super::meter::Meter;
use super::sampler::CountedCrossing;
use super::script::GuardRise;
use crate::equations::{Entered, Equations, NO_GUARD, Numbers};
use crate::failure::Failure;

/// Instants inside a step at which the guards are looked at.
const INTERIOR: u32 = 8;
/// Evaluations after which a bracket has shrunk as far as it will.
const MOST_EVALUATIONS: u32 = 200;

/// Roots of two guards that are no further apart than this, relative to their time, are one
/// instant: the guard that comes first ends the mode.
const ONE_INSTANT: f64 = 8.0 * f64::EPSILON;

/// A dense output: the state at an instant.
pub(crate) type StateAt<'a, S> = dyn FnMut(f64) -> Result<S, Failure> + 'a;

/// The guards at an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GuardValues<G> {
    t: f64,
    guards: G,
    rates: G,
}

impl<G: Numbers> GuardValues<G> {
    fn value(&self, guard: usize) -> f64 {
        self.guards.as_ref()[guard]
    }

    fn rate(&self, guard: usize) -> f64 {
        self.rates.as_ref()[guard]
    }

    /// Outside, and by the equations of motion not on the way back: the interpolant of a loose
    /// tolerance ripples through a threshold that the motion itself is leaving.
    fn leaves(&self, guard: usize) -> bool {
        self.value(guard) >= 0.0 && self.rate(guard) > 0.0
    }
}

/// The search for the end of one mode.
pub(crate) struct GuardSearch<'a, E: Equations> {
    equations: E,
    mode: usize,
    meter: &'a Meter,
    began: f64,
    entered: Entered,
}

impl<'a, E: Equations> GuardSearch<'a, E> {
    pub(crate) fn new(equations: E, from: &Moment<E>, meter: &'a Meter) -> Self {
        let &Moment { mode, began, entered, .. } = from;
        Self { equations, mode, meter, began, entered }
    }

    /// The first crossing in a step at which the mode ends; those before it that are only counted
    /// go to `counted`.
    pub(crate) fn step(
        &self,
        begin: f64,
        end: f64,
        state_at: &mut StateAt<'_, E::State>,
        counted: &mut Vec<CountedCrossing<E::State>>,
    ) -> Result<Option<GuardRise>, Failure> {
        if let Some(told) = self.meter.told() {
            return Ok(told.up_to(end));
        }
        self.meter.stepped(end);
        let width = (end - begin) / f64::from(INTERIOR);
        let mut left = self.look_at(begin, state_at)?;
        for i in 1..=INTERIOR {
            let t = if i == INTERIOR { end } else { begin + width * f64::from(i) };
            let right = self.look_at(t, state_at)?;
            if let Some(found) = self.within(&left, &right, state_at, counted)? {
                return Ok(Some(found));
            }
            left = right;
        }
        Ok(None)
    }

    /// The first crossing in a step of which only the ends are looked at.
    pub(crate) fn between(
        &self,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
        counted: &mut Vec<CountedCrossing<E::State>>,
    ) -> Result<Option<GuardRise>, Failure> {
        if let Some(told) = self.meter.told() {
            return Ok(told.up_to(right.t));
        }
        self.meter.stepped(right.t);
        self.within(left, right, state_at, counted)
    }

    /// The first crossing between two looks.
    fn within(
        &self,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
        counted: &mut Vec<CountedCrossing<E::State>>,
    ) -> Result<Option<GuardRise>, Failure> {
        let mut first: Option<GuardRise> = None;
        let guards = self.equations.count(self.mode);
        for guard in (0..guards).filter(|guard| self.equations.ends(self.mode, *guard)) {
            let found = self.of_guard(guard, left, right, state_at)?;
            let earlier = |t: &f64| first.is_none_or(|first| *t < first.t * (1.0 - ONE_INSTANT));
            if let Some(t) = found.filter(earlier) {
                first = Some(GuardRise { t, guard });
            }
        }
        let known = counted.len();
        for guard in (0..guards).filter(|guard| !self.equations.ends(self.mode, *guard)) {
            let found = self.of_counted(guard, left, right, state_at)?;
            let before = |t: &f64| first.is_none_or(|first| *t <= first.t * (1.0 + ONE_INSTANT));
            if let Some(t) = found.filter(before) {
                let t = first.map_or(t, |first| t.min(first.t));
                counted.push(CountedCrossing { t, guard, state: state_at(t)? });
            }
        }
        counted[known..].sort_by(|one, other| one.t.total_cmp(&other.t));
        Ok(first)
    }

    /// The guards of a known state.
    pub(crate) fn look(&self, t: f64, state: &E::State) -> GuardValues<E::Guards> {
        let count = self.equations.most_guards();
        if self.meter.told().is_some() {
            let [guards, rates] = [NO_GUARD, 0.0].map(|value| E::Guards::all(count, value));
            return GuardValues { t, guards, rates };
        }
        let state = state.as_ref();
        let mut guards = self.equations.guards(self.mode, t, state);
        self.meter.guards(t, self.mode, &guards.as_ref()[..self.equations.count(self.mode)]);
        if t == self.began {
            self.equations.settle(self.entered, state, &mut guards);
        }
        GuardValues { t, guards, rates: self.equations.rates(self.mode, t, state) }
    }

    fn look_at(
        &self,
        t: f64,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<GuardValues<E::Guards>, Failure> {
        Ok(self.look(t, &state_at(t)?))
    }

    fn of_guard(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<Option<f64>, Failure> {
        let begins_inside = left.value(guard) < 0.0;
        if right.value(guard) < 0.0 {
            if !begins_inside || left.rate(guard) <= 0.0 || right.rate(guard) > 0.0 {
                return Ok(None);
            }
            return self.peak(guard, left, right, state_at);
        }
        if !begins_inside {
            // It began on the surface or, by the interpolant's error, past it.
            if !right.leaves(guard) {
                return Ok(None);
            }
            let at = self.bisect(left, right, |look| look.leaves(guard), state_at)?;
            return Ok(Some(at.t));
        }
        self.rise(guard, left, right, state_at)
    }

    /// A crossing of a guard that ends nothing: it becomes positive after it was negative.
    fn of_counted(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<Option<f64>, Failure> {
        match (left.value(guard) < 0.0, right.value(guard) < 0.0) {
            (true, false) => self.rise(guard, left, right, state_at),
            (true, true) if left.rate(guard) > 0.0 && right.rate(guard) <= 0.0 => {
                self.peak(guard, left, right, state_at)
            }
            (false, false) if left.rate(guard) < 0.0 && right.rate(guard) > 0.0 => {
                let turned = |look: &GuardValues<E::Guards>| look.rate(guard) >= 0.0;
                let valley = self.bisect(left, right, turned, state_at)?;
                if valley.value(guard) >= 0.0 {
                    return Ok(None);
                }
                self.rise(guard, &valley, right, state_at)
            }
            _ => Ok(None),
        }
    }

    /// The root of a guard that is negative at the left and not at the right.
    fn rise(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<Option<f64>, Failure> {
        let t = self.root(guard, left, right, state_at)?;
        let leaves = right.leaves(guard) || self.look_at(t, state_at)?.leaves(guard);
        Ok(leaves.then_some(t))
    }

    /// The root before a guard's peak between two looks, if the peak reaches zero.
    fn peak(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<Option<f64>, Failure> {
        let turned = |look: &GuardValues<E::Guards>| look.rate(guard) <= 0.0;
        let peak = self.bisect(left, right, turned, state_at)?;
        let reaches = peak.value(guard) >= 0.0;
        reaches.then(|| self.root(guard, left, &peak, state_at)).transpose()
    }

    /// The first instant, to the last bit, from which `is_past` holds.
    fn bisect(
        &self,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        is_past: impl Fn(&GuardValues<E::Guards>) -> bool,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<GuardValues<E::Guards>, Failure> {
        let (mut before, mut past) = (left.t, *right);
        loop {
            let middle = before + 0.5 * (past.t - before);
            if middle <= before || middle >= past.t {
                return Ok(past);
            }
            let look = self.look_at(middle, state_at)?;
            if is_past(&look) { past = look } else { before = middle }
        }
    }

    /// The time at which a guard that is negative at the left and not at the right becomes zero, by
    /// regula falsi with the weight of an end that stays halved, and every fourth time the middle.
    fn root(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<f64, Failure> {
        let (mut inside, mut outside) = (left.t, right.t);
        let (mut below, mut above) = (left.value(guard), right.value(guard));
        let mut stayed = 0;
        for count in 0..MOST_EVALUATIONS {
            let middle = inside + 0.5 * (outside - inside);
            if above == 0.0 || middle <= inside || middle >= outside {
                break;
            }
            let chord = inside - below * (outside - inside) / (above - below);
            let use_chord = count % 4 != 3 && inside < chord && chord < outside;
            let t = if use_chord { chord } else { middle };
            let value = self.look_at(t, state_at)?.value(guard);
            if value >= 0.0 {
                (outside, above) = (t, value);
                below *= if stayed == -1 { 0.5 } else { 1.0 };
                stayed = -1;
            } else {
                (inside, below) = (t, value);
                above *= if stayed == 1 { 0.5 } else { 1.0 };
                stayed = 1;
            }
        }
        Ok(outside)
    }
}

#[cfg(test)]
#[path = "location_tests.rs"]
mod tests;
