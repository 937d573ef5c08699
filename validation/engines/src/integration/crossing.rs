//! The crossings of one guard between two looks.

use super::bracket::Bracket;
use super::guard_values::GuardValues;
use super::location::{GuardSearch, StateAt};
use crate::equations::Equations;
use crate::failure::Failure;

/// Evaluations after which a bracket has shrunk as far as it will.
const MAX_EVALUATIONS: u32 = 200;

/// The peak of a guard, or its valley where `sign` is -1, and which values are beyond zero.
#[derive(Clone, Copy)]
struct Turn {
    guard: usize,
    sign: f64,
    reaches: fn(f64) -> bool,
}

impl<E: Equations> GuardSearch<'_, E> {
    /// A crossing of a guard that ends its mode.
    pub(super) fn of_ending_guard(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<Option<f64>, Failure> {
        let begins_inside = left.value(guard) < 0.0;
        if right.value(guard) < 0.0 {
            if !begins_inside || !left.cubic_to(right, guard).peaks() {
                return Ok(None);
            }
            return self.peak(guard, left, right, state_at);
        }
        if !begins_inside {
            // It began on the surface or, by the interpolant's error, past it.
            return if right.leaves(guard) {
                self.comes_back(guard, left, right, state_at).map(Some)
            } else {
                Ok(None)
            };
        }
        self.rise(guard, left, right, state_at)
    }

    /// A crossing of a guard that ends nothing: it becomes positive after it was negative. One that
    /// touches zero and turns has not; so a touch to rounding is none or two crossings of a value
    /// that is watched in both directions, each of which has its own guard.
    pub(super) fn of_watched_guard(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<Option<f64>, Failure> {
        let cubic = left.cubic_to(right, guard);
        match (left.value(guard) < 0.0, right.value(guard) < 0.0) {
            // Where it rises at the left, its rate at a touch to rounding may have any sign.
            (true, false) if left.rate(guard) > 0.0 => {
                self.root(guard, left, right, state_at).map(|root| Some(root.t))
            }
            (true, false) => self.rise(guard, left, right, state_at),
            (true, true) if cubic.peaks() => {
                let turn = Turn { guard, sign: 1.0, reaches: |value| value > 0.0 };
                let Some(peak) = self.turn(turn, left, right, state_at)? else { return Ok(None) };
                self.root(guard, left, &peak, state_at).map(|root| Some(root.t))
            }
            (false, false) if cubic.mirrored().peaks() => {
                let turn = Turn { guard, sign: -1.0, reaches: |value| value < 0.0 };
                let Some(valley) = self.turn(turn, left, right, state_at)? else {
                    return Ok(None);
                };
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
        let root = self.root(guard, left, right, state_at)?;
        Ok((right.leaves(guard) || root.leaves(guard)).then_some(root.t))
    }

    /// The instant at which a guard leaves that is on its surface, or past it, at the left, and
    /// leaves at the right.
    fn comes_back(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<f64, Failure> {
        let lowest = self.look_at(left.cubic_to(right, guard).division(), state_at)?;
        if lowest.value(guard) < 0.0 {
            return self.root(guard, &lowest, right, state_at).map(|root| root.t);
        }
        let past = if lowest.leaves(guard) { &lowest } else { right };
        Ok(self.bisect(left, past, |look| look.leaves(guard), state_at)?.t)
    }

    /// A look beyond zero at the one turn that a guard has between two looks, if it gets there. The
    /// search goes from one cubic's turn to the next, and ends as soon as the last cubic stays
    /// clear of zero.
    fn turn(
        &self,
        Turn { guard, sign, reaches }: Turn,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<Option<GuardValues<E::Guards>>, Failure> {
        let (mut before, mut past) = (*left, *right);
        for looks in 1..=MAX_EVALUATIONS {
            let cubic = before.cubic_to(&past, guard);
            let cubic = if sign < 0.0 { cubic.mirrored() } else { cubic };
            let middle = before.t + 0.5 * (past.t - before.t);
            let is_narrow = middle <= before.t || middle >= past.t;
            if is_narrow || !cubic.could_reach() {
                break;
            }
            let turn = cubic.division();
            let is_between = turn > before.t && turn < past.t && !looks.is_multiple_of(3);
            let look = self.look_at(if is_between { turn } else { middle }, state_at)?;
            if reaches(look.value(guard)) {
                return Ok(Some(look));
            }
            if sign * look.rate(guard) <= 0.0 { past = look } else { before = look }
        }
        Ok(None)
    }

    /// The root before a guard's peak between two looks, if the peak reaches zero. Where the guard
    /// does not rise at that root by the equations of motion, what is above zero may be a ripple of
    /// the interpolant: the peak is then the place at which the rate vanishes to the last bit.
    fn peak(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<Option<f64>, Failure> {
        let turn = Turn { guard, sign: 1.0, reaches: |value| value >= 0.0 };
        let Some(above) = self.turn(turn, left, right, state_at)? else { return Ok(None) };
        let root = self.root(guard, left, &above, state_at)?;
        if root.leaves(guard) {
            return Ok(Some(root.t));
        }
        let turned = |look: &GuardValues<E::Guards>| look.rate(guard) <= 0.0;
        let peak = self.bisect(left, right, turned, state_at)?;
        let reaches = peak.value(guard) >= 0.0;
        reaches.then(|| self.root(guard, left, &peak, state_at).map(|root| root.t)).transpose()
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

    /// The look at which a guard that is negative at the left and not at the right has become zero,
    /// by the roots of cubics: each is the one through the two looks between which the guard
    /// changes its sign.
    fn root(
        &self,
        guard: usize,
        left: &GuardValues<E::Guards>,
        right: &GuardValues<E::Guards>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<GuardValues<E::Guards>, Failure> {
        let mut bracket = Bracket::new(guard, left, right);
        for _ in 0..MAX_EVALUATIONS {
            let Some(t) = bracket.next() else { break };
            bracket.take(self.look_at(t, state_at)?);
        }
        Ok(bracket.outside)
    }
}
