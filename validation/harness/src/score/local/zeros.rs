//! What is zero by the model at a record: carried along the engine's own events, imposed on its
//! states, and forgotten where a state denies it.

use super::continuation::{Named, Place};
use super::motion::value as value_of;
use super::run::JudgedRun;
use super::walk::Walk;
use crate::engine::Event;
use nalgebra::{DMatrix, DVector};
use percuss::affine::{Followed, Follower, Imposed};

/// The ratio of a value to what a right method is allowed from which on a zero is denied.
const MAX_ALLOWED_RATIO: f64 = 10.0;
/// Singular values below this part of the largest are none: the rows say the same.
const SINGULAR_VALUE_TOLERANCE: f64 = 1e-12;

impl JudgedRun {
    /// The guards that end the mode of a place and are zero there to rounding, as bits.
    pub(super) fn guards_at_rounding(&self, place: &Place) -> u64 {
        let until = self.motion.system().modes[place.mode].until.len();
        let is_zero = |guard: &usize| {
            let value = self.motion.value((place.mode, *guard, 0), place.elapsed, &place.state);
            value.value.abs() <= value.rounding
        };
        (0..until).filter(is_zero).fold(0, |bits, guard| bits | 1 << guard)
    }

    /// A place's state, moved as little as makes zero what is zero by the model.
    pub(super) fn projected(&self, follower: &mut Follower<'_, f64>, place: &Place) -> Vec<f64> {
        let imposed = follower.imposed(place.elapsed, &place.state);
        if imposed.iter().all(|it| it.value == 0.0) {
            return place.state.clone();
        }
        let states = place.state.len();
        let weights = self.motion.weights(&place.state);
        let rows: Vec<_> = imposed
            .iter()
            .map(|it| self.motion.derivative(place.mode, it.guard, it.order))
            .collect();
        let weighted = DMatrix::from_fn(rows.len(), states, |n, k| rows[n][k] * weights[k]);
        let values = DVector::from_iterator(imposed.len(), imposed.iter().map(|it| it.value));
        // States near the largest f64 have values beyond it, which no decomposition takes.
        if !weighted.iter().chain(&values).all(|it| it.is_finite()) {
            return place.state.clone();
        }
        // Rows of theta alone say nothing of the states, and some rows say the same.
        let moved = weighted.svd(true, true).solve(&values, SINGULAR_VALUE_TOLERANCE);
        let Ok(moved) = moved else { return place.state.clone() };
        let state = place.state.iter().zip(moved.iter()).zip(&weights);
        state.map(|((value, moved), weight)| value - moved * weight).collect()
    }
}

impl Walk<'_> {
    /// Goes on to a record: from here on the exact continuation is that of the record.
    pub(super) fn go_on(&mut self, named: Named, event: &Event, at_entry: bool) {
        let begins = named.event < self.until_count();
        let followed: Followed = named.followed(self.until_count());
        if !self.coarse.pass(followed, at_entry) {
            self.coarse.forget(named.next);
        }
        let state = self.finite_state(event);
        self.place = Place { elapsed: event.elapsed, mode: named.next, state, late: 0, begins };
        self.drop_untrue();
        self.place.state = self.judge.projected(&mut self.coarse, &self.place);
        self.place.late = self.guards_returning();
    }

    /// The record's state; where it is no number, what the state before the reset makes of it.
    fn finite_state(&mut self, event: &Event) -> Vec<f64> {
        if event.state.iter().all(|it| it.is_finite()) {
            return event.state.to_vec();
        }
        let flow = self.along(event.elapsed);
        let own = event.state.iter().zip(flow);
        own.map(|(own, flow)| if own.is_finite() { *own } else { flow }).collect()
    }

    /// Forgets zeros that are none in the record's state by more than is allowed.
    fn drop_untrue(&mut self) {
        let imposed = self.coarse.imposed(self.place.elapsed, &self.place.state);
        let k = self.units.allowance.state.max(self.units.allowance.time);
        let is_true = |it: &Imposed| {
            let motion = self.motion();
            let row = motion.derivative(self.place.mode, it.guard, it.order);
            let point = motion.point(self.place.elapsed, &self.place.state);
            let size = motion.size(&row, point.as_slice());
            let rounding = value_of(&row, &point).rounding;
            it.value.abs()
                <= MAX_ALLOWED_RATIO * k * self.units.tolerance() * size + 16.0 * rounding
        };
        let truths: Vec<bool> = imposed.iter().map(is_true).collect();
        if truths.iter().all(|it| *it) {
            return;
        }
        let kept = imposed.iter().zip(&truths).filter(|(it, is)| it.order == 0 && **is);
        let kept = kept.fold(0, |bits, (it, _)| bits | 1 << it.guard);
        self.coarse.forget(self.place.mode);
        self.coarse.impose(kept);
    }

    /// The guards of the present mode that are outside and on their way back.
    fn guards_returning(&mut self) -> u64 {
        let imposed = self.coarse.imposed(self.place.elapsed, &self.place.state);
        let motion = self.motion();
        let (mode, place) = (self.place.mode, &self.place);
        let until = self.until_count();
        let is_late = |guard: &usize| {
            let known = imposed.iter().any(|it| it.guard == *guard);
            let value = |order| motion.value((mode, *guard, order), place.elapsed, &place.state);
            !known && value(0).value > 0.0 && value(1).value < 0.0
        };
        (0..until).filter(is_late).fold(0, |bits, guard| bits | 1 << guard)
    }
}
