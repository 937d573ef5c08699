//! Event location by this harness, on any dense output of a step.
//!
//! The guards are looked at at [`INTERIOR`] instants inside a step. Between two of them a guard has
//! risen to zero if it is there at the second, or if it was rising at the first, is falling at the
//! second and its peak, found by bisection of its rate, reaches zero: so a touch shorter than the
//! interval is seen wherever the dense output shows it. Rates come from the equations of motion.
//! The crossing itself is then narrowed down to the last bit.

use super::field::{Equations, GUARDS, NO_GUARD};
use super::joining::Moment;
use super::meter::{Failure, Meter};
use percuss::Phase;

/// Instants inside a step at which the guards are looked at.
const INTERIOR: u32 = 8;
/// Evaluations after which a bracket has shrunk as far as it will.
const MOST_EVALUATIONS: u32 = 200;

/// How far from its surface rounding may put the beginning of a phase, relative to displacements.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;

/// A dense output: the state at an instant.
pub(super) type StateAt<'a> = dyn FnMut(f64) -> Result<[f64; 4], Failure> + 'a;

/// A guard that has risen to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GuardRise {
    pub(super) t: f64,
    pub(super) guard: usize,
}

/// The guards at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct GuardValues {
    t: f64,
    guards: [f64; GUARDS],
    rates: [f64; GUARDS],
}

impl GuardValues {
    /// Outside, and by the equations of motion not on the way back: the interpolant of a loose
    /// tolerance ripples through a threshold that the motion itself is leaving.
    fn leaves(&self, guard: usize) -> bool {
        self.guards[guard] >= 0.0 && self.rates[guard] > 0.0
    }
}

/// The search for the end of one phase.
pub(super) struct GuardSearch<'a, E> {
    equations: E,
    phase: Phase,
    meter: &'a Meter,
    began: f64,
}

impl<'a, E: Equations> GuardSearch<'a, E> {
    pub(super) fn new(equations: E, from: &Moment, meter: &'a Meter) -> Self {
        Self { equations, phase: from.phase, meter, began: from.began }
    }

    /// The first crossing in a step.
    pub(super) fn step(
        &self,
        begin: f64,
        end: f64,
        state_at: &mut StateAt<'_>,
    ) -> Result<Option<GuardRise>, Failure> {
        if let Some(told) = self.meter.told() {
            return Ok(told.up_to(end));
        }
        self.meter.stepped(end);
        if let Some(told) = self.meter.told() {
            return Ok(told.up_to(end));
        }
        let width = (end - begin) / f64::from(INTERIOR);
        let mut left = self.look_at(begin, state_at)?;
        for i in 1..=INTERIOR {
            let t = if i == INTERIOR { end } else { begin + width * f64::from(i) };
            let right = self.look_at(t, state_at)?;
            if let Some(found) = self.within(&left, &right, state_at)? {
                return Ok(Some(found));
            }
            left = right;
        }
        Ok(None)
    }

    /// The first crossing in a step of which only the ends are looked at.
    pub(super) fn between(
        &self,
        left: &GuardValues,
        right: &GuardValues,
        state_at: &mut StateAt<'_>,
    ) -> Result<Option<GuardRise>, Failure> {
        if let Some(told) = self.meter.told() {
            return Ok(told.up_to(right.t));
        }
        self.meter.stepped(right.t);
        if let Some(told) = self.meter.told() {
            return Ok(told.up_to(right.t));
        }
        self.within(left, right, state_at)
    }

    /// The first crossing between two looks.
    fn within(
        &self,
        left: &GuardValues,
        right: &GuardValues,
        state_at: &mut StateAt<'_>,
    ) -> Result<Option<GuardRise>, Failure> {
        let mut first: Option<GuardRise> = None;
        for guard in 0..GUARDS {
            let found = self.of_guard(guard, left, right, state_at)?;
            if let Some(t) = found.filter(|t| first.is_none_or(|first| *t < first.t)) {
                first = Some(GuardRise { t, guard });
            }
        }
        Ok(first)
    }

    /// The guards of a known state.
    pub(super) fn look(&self, t: f64, state: &[f64; 4]) -> GuardValues {
        if self.meter.told().is_some() {
            return GuardValues { t, guards: [NO_GUARD; GUARDS], rates: [0.0; GUARDS] };
        }
        let mut guards = self.equations.guards(self.phase, state);
        self.meter.guards(t, self.phase, &guards);
        if t == self.began {
            // A phase begins on a surface, but for the rounding of its displacements. Separation
            // begins on a double zero, and a gap of some roundings that seems to close is none.
            let rounding = ROUNDINGS * state.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
            for guard in guards.iter_mut().filter(|guard| guard.abs() <= rounding) {
                *guard = 0.0;
            }
        }
        GuardValues { t, guards, rates: self.equations.rates(self.phase, t, state) }
    }

    fn look_at(&self, t: f64, state_at: &mut StateAt<'_>) -> Result<GuardValues, Failure> {
        Ok(self.look(t, &state_at(t)?))
    }

    fn of_guard(
        &self,
        guard: usize,
        left: &GuardValues,
        right: &GuardValues,
        state_at: &mut StateAt<'_>,
    ) -> Result<Option<f64>, Failure> {
        let begins_inside = left.guards[guard] < 0.0;
        if right.guards[guard] < 0.0 {
            if !begins_inside || left.rates[guard] <= 0.0 || right.rates[guard] > 0.0 {
                return Ok(None);
            }
            let turned = |look: &GuardValues| look.rates[guard] <= 0.0;
            let peak = self.bisect(left, right, turned, state_at)?;
            return if peak.guards[guard] >= 0.0 {
                self.root(guard, left, &peak, state_at).map(Some)
            } else {
                Ok(None)
            };
        }
        if !begins_inside {
            // It began on the surface or, by the interpolant's error, past it.
            if !right.leaves(guard) {
                return Ok(None);
            }
            return self
                .bisect(left, right, |look| look.leaves(guard), state_at)
                .map(|at| Some(at.t));
        }
        let t = self.root(guard, left, right, state_at)?;
        let leaves = right.leaves(guard) || self.look_at(t, state_at)?.leaves(guard);
        Ok(leaves.then_some(t))
    }

    /// The first instant, to the last bit, from which `is_past` holds.
    fn bisect(
        &self,
        left: &GuardValues,
        right: &GuardValues,
        is_past: impl Fn(&GuardValues) -> bool,
        state_at: &mut StateAt<'_>,
    ) -> Result<GuardValues, Failure> {
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
        left: &GuardValues,
        right: &GuardValues,
        state_at: &mut StateAt<'_>,
    ) -> Result<f64, Failure> {
        let (mut inside, mut outside) = (left.t, right.t);
        let (mut below, mut above) = (left.guards[guard], right.guards[guard]);
        let mut stayed = 0;
        for count in 0..MOST_EVALUATIONS {
            let middle = inside + 0.5 * (outside - inside);
            if above == 0.0 || middle <= inside || middle >= outside {
                break;
            }
            let chord = inside - below * (outside - inside) / (above - below);
            let use_chord = count % 4 != 3 && inside < chord && chord < outside;
            let t = if use_chord { chord } else { middle };
            let value = self.look_at(t, state_at)?.guards[guard];
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
mod tests {
    use super::*;
    use crate::engine::field::Oscillator;
    use crate::engine::meter::Limits;
    use percuss::Parameters;

    /// Contact with a trial force as given and no velocity, so that q is the force.
    fn first(force: fn(f64) -> f64, rate: fn(f64) -> f64) -> Option<GuardRise> {
        let parameters = Parameters { a: 0.0, b: 0.0, ..Parameters::default() };
        let meter = Meter::new(&Limits::default());
        let equations = Made { oscillator: Oscillator::of(&parameters, 0.0), force, rate };
        let from = Moment { t: 0.0, began: 0.0, phase: Phase::Contact, state: [0.0; 4] };
        let search = GuardSearch::new(equations, &from, &meter);
        search.step(0.0, 1.0, &mut |t| Ok([t, 0.0, 0.0, 0.0])).ok().flatten()
    }

    /// Guards made up as functions of time, which the state carries.
    #[derive(Clone, Copy)]
    struct Made {
        oscillator: Oscillator,
        force: fn(f64) -> f64,
        rate: fn(f64) -> f64,
    }

    impl Equations for Made {
        fn of(parameters: &Parameters, angle: f64) -> Self {
            let oscillator = Oscillator::of(parameters, angle);
            Self { oscillator, force: |_| 0.0, rate: |_| 0.0 }
        }
        fn of_bounded(&self, state: &[f64; 4]) -> [f64; 4] {
            *state
        }
        fn bounded(&self, u: &[f64; 4]) -> [f64; 4] {
            *u
        }
        fn derivatives(&self, phase: Phase, t: f64, u: &[f64], du: &mut [f64]) {
            self.oscillator.derivatives(phase, t, u, du);
        }
        fn jacobian_product(&self, phase: Phase, w: &[f64], dw: &mut [f64]) {
            self.oscillator.jacobian_product(phase, w, dw);
        }
        fn guards(&self, _: Phase, u: &[f64]) -> [f64; GUARDS] {
            [(self.force)(u[0]) - 1.0, -(self.force)(u[0])]
        }
        fn rates(&self, _: Phase, t: f64, _: &[f64]) -> [f64; GUARDS] {
            [(self.rate)(t), -(self.rate)(t)]
        }
        fn switch(&self, phase: Phase, guard: usize, u: &[f64]) -> (Phase, [f64; 4]) {
            self.oscillator.switch(phase, guard, u)
        }
    }

    #[test]
    fn a_crossing_is_found_to_the_last_bit() {
        let found = first(|t| 0.3 + t, |_| 1.0);
        assert!(found.is_some_and(|it| it.guard == 0 && (it.t - 0.7).abs() <= f64::EPSILON));
    }

    #[test]
    fn a_touch_between_two_looks_is_found() {
        let found = first(|t| 1.0 + 1e-12 - (t - 0.7).powi(2), |t| -2.0 * (t - 0.7));
        assert!(found.is_some_and(|it| it.guard == 0 && (it.t - (0.7 - 1e-6)).abs() < 1e-9));
        assert_eq!(first(|t| 1.0 - 1e-12 - (t - 0.7).powi(2), |t| -2.0 * (t - 0.7)), None);
    }

    #[test]
    fn of_two_crossings_between_two_looks_the_first_counts() {
        let force = |t: f64| 0.5 + 1e3 * (t - 0.99) * (0.999 - t) * 60.0 + 0.4;
        let rate = |t: f64| 6e4 * (0.99 + 0.999 - 2.0 * t);
        assert!(first(force, rate).is_some_and(|it| it.guard == 0 && it.t > 0.99));
    }

    #[test]
    fn a_start_on_the_surface_is_no_crossing() {
        assert_eq!(first(|t| 1.0 - 0.5 * t, |_| -0.5), None);
    }
}
