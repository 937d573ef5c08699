//! Where either answer is right: grazes, successors that hang by little, and the order of events of
//! one instant.

use super::continuation::Named;
use super::motion::{Value, value as value_of};
use super::units::{Stretch, Units};
use super::walk::Walk;
use crate::engine::Event;
use crate::system::Direction;
use nalgebra::RowDVector;

/// The distance to an extremum, in turns, within which it is near.
const NEAR_TURNS: f64 = 0.125;
/// Time scales around a graze within which samples show the error there.
const SAMPLE_REACH_TIME_SCALES: f64 = 2.0;
/// The largest ratio of the error at a graze to the error that samples near it show.
const MAX_ERROR_RATIO: f64 = 3.0;
/// The most steps of Newton's method on the way to an extremum.
const MAX_NEWTON_STEPS: usize = 30;
/// The error with which an extremum is found, as a share of [`NEAR_TURNS`].
const EXTREMUM_TOLERANCE: f64 = 1e-12;

impl Walk<'_> {
    /// Whether the mode after a record hangs by less than the errors that are allowed.
    pub(super) fn successor_is_open(
        &self,
        event: &Event,
        named: Named,
        stretch: &Stretch<'_>,
    ) -> bool {
        let motion = self.motion();
        let mode = &motion.system().modes[self.place.mode];
        let Some(until) = mode.until.get(named.event) else { return false };
        let sizes = self.units.sizes_after(&event.state, stretch, named.event);
        let time = self.units.allowed_time(stretch, named.event);
        until.next.iter().filter_map(|(when, _)| when.as_ref()).any(|when| {
            let z = motion.point(event.elapsed, &event.state);
            let row = RowDVector::from_row_slice(when);
            let value = value_of(&row, &z);
            let size: f64 = sizes.iter().zip(when).map(|(size, it)| size * it.abs()).sum();
            let by_state = self.units.allowance.state * self.units.tolerance() * size;
            let by_time = motion.rate_of_theta(&row, &z).abs() * time;
            value.value.abs() <= by_state + by_time + value.rounding
        })
    }

    /// Whether a record's own guard may fire at its time.
    pub(super) fn is_admissible(&mut self, event: &Event, named: Named) -> bool {
        let guard = named.event;
        let (mode, place) = (self.place.mode, self.place.clone());
        let rests = event.elapsed - place.elapsed <= Units::rounding_of_time(event.elapsed);
        let zeros = self.zeros_of(guard);
        if rests && zeros > 0 {
            let motion = self.motion();
            let signs = self.signs(mode, guard);
            let leading = motion.value((mode, guard, zeros), place.elapsed, &place.state);
            return signs.iter().any(|sign| sign * leading.value > -leading.rounding);
        }
        let state = self.along(event.elapsed);
        let stretch = place.stretch(event.elapsed);
        let motion = self.motion();
        let value = motion.value((mode, guard, 0), event.elapsed, &state);
        let rate = motion.value((mode, guard, 1), event.elapsed, &state);
        let row = motion.guard(mode, guard).clone();
        let by_state = self.units.allowed_value(&row, &stretch);
        let by_time = rate.value.abs() * self.units.allowance.time * self.at_once_within();
        let room = by_state + by_time + value.rounding;
        let signs = self.signs(mode, guard);
        let closes = signs.iter().any(|sign| sign * rate.value > -by_state);
        closes && (value.value.abs() <= room || guard < self.until_count() && value.value > 0.0)
    }

    /// Whether a guard's derivative at the present record is zero within the errors that are
    /// allowed: with the derivatives below it, which are zero by the model, it decides whether the
    /// guard fires at once.
    fn is_nearly_zero(&self, (mode, guard, order): (usize, usize, usize)) -> bool {
        let (place, motion) = (&self.place, self.motion());
        let value = |order| motion.value((mode, guard, order), place.elapsed, &place.state);
        let by_state = self
            .units
            .allowed_value(&motion.derivative(mode, guard, order), &place.stretch(place.elapsed));
        let time = self.units.allowance.time * self.at_once_within();
        let by_time = value(order + 1).value.abs() * time;
        let Value { value, rounding } = value(order);
        value.abs() <= by_state + by_time + rounding
    }

    /// The number of a guard's derivatives, its value included, that are zero by the model at the
    /// present record.
    fn zeros_of(&mut self, guard: usize) -> usize {
        let imposed = self.coarse.imposed(self.place.elapsed, &self.place.state);
        imposed.iter().filter(|it| it.guard == guard).count()
    }

    /// The signs by which a guard counts.
    fn signs(&self, mode: usize, guard: usize) -> &'static [f64] {
        let mode = &self.motion().system().modes[mode];
        let watch = guard.checked_sub(mode.until.len()).and_then(|it| mode.watch.get(it));
        match watch.map(|it| it.direction) {
            None | Some(Direction::Rising) => &[1.0],
            Some(Direction::Falling) => &[-1.0],
            Some(Direction::Both) => &[1.0, -1.0],
        }
    }

    /// Whether a guard of the present flow has an extremum near a time that is zero within the
    /// errors that are allowed: either answer is right there.
    pub(super) fn is_graze(&mut self, elapsed: f64, guard: usize) -> bool {
        let Some(at) = self.extremum_near(elapsed, guard) else { return false };
        let (mode, begin) = (self.place.mode, self.place.elapsed);
        if at <= begin {
            let zeros = self.zeros_of(guard);
            if zeros > 0 {
                return self.is_nearly_zero((mode, guard, zeros));
            }
        }
        let state = self.along(at);
        let stretch = Stretch { length: (at - begin).max(0.0), ..self.place.stretch(at) };
        let motion = self.motion();
        let value = motion.value((mode, guard, 0), at, &state);
        let row = motion.guard(mode, guard).clone();
        let by_class = self.units.allowed_value(&row, &stretch);
        let allowed = self.shown_near(at, &row, &state).map_or(by_class, |it| it.min(by_class));
        value.value.abs() <= allowed + value.rounding
    }

    /// Whether a mode begins on the inside of a guard that is crossed soon after, where no event
    /// put the state on the guard: the answer has both signs before it, and no error of the flow
    /// takes the crossing away. A record amid a mode may be the one of two close crossings.
    pub(super) fn begins_inside(&mut self, guard: usize, elapsed: f64) -> bool {
        let begin = self.place.elapsed;
        let near = begin + self.units.allowance.time * self.at_once_within();
        let is_at_begin = self.extremum_near(elapsed, guard).is_some_and(|at| at <= near);
        if !self.place.begins || !is_at_begin || self.zeros_of(guard) > 0 {
            return false;
        }
        let mode = self.place.mode;
        let value = self.motion().value((mode, guard, 0), begin, &self.place.state);
        self.signs(mode, guard).iter().any(|sign| sign * value.value < -value.rounding)
    }

    /// The error of a guard that the answer's own samples on the present flow show near a time,
    /// with room; none where no sample is near.
    fn shown_near(&mut self, at: f64, row: &RowDVector<f64>, state: &[f64]) -> Option<f64> {
        let system = self.motion().system();
        let (begin, near) = (self.place.elapsed, SAMPLE_REACH_TIME_SCALES * system.time_scale);
        let (from, to) = (begin.max(at - near), self.told_until.min(at + near));
        let answer = self.answer;
        let all = answer.times.iter().zip(answer.states);
        let shown: Vec<_> = all.filter(|(time, _)| **time > from && **time < to).collect();
        if shown.is_empty() {
            return None;
        }
        let errors = shown.into_iter().map(|(time, own)| {
            let flow = self.along(*time);
            let off = own.iter().zip(&flow).zip(row.iter()).map(|((own, it), by)| by * (own - it));
            off.sum::<f64>().abs()
        });
        let error = errors.fold(0.0, f64::max);
        let k = self.units.allowance.time.max(self.units.allowance.state);
        let least = k * self.units.tolerance() * self.motion().size(row, state);
        Some(MAX_ERROR_RATIO * error + least)
    }

    /// The extremum of a guard along the present flow near a time: what Newton's method finds from
    /// there, if it stays near.
    fn extremum_near(&mut self, elapsed: f64, guard: usize) -> Option<f64> {
        let (mode, begin) = (self.place.mode, self.place.elapsed);
        let near = NEAR_TURNS * self.judge.problem.turn();
        let mut at = elapsed;
        for _ in 0..MAX_NEWTON_STEPS {
            let state = self.along(at);
            let value = |order| self.motion().value((mode, guard, order), at, &state);
            let rate = value(1);
            if rate.value.abs() <= rate.rounding {
                return Some(at);
            }
            let step = -rate.value / value(2).value;
            // The begin is an extremum of what is left of a segment.
            let next = (at + step).max(begin);
            if !next.is_finite() || (next - elapsed).abs() > near {
                return None;
            }
            if (next - at).abs() <= EXTREMUM_TOLERANCE * near {
                return Some(next);
            }
            at = next;
        }
        None
    }

    /// The state of the present record's flow at a time, in f64.
    pub(super) fn along(&mut self, elapsed: f64) -> Vec<f64> {
        let place = self.place.clone();
        self.coarse.go_on(place.elapsed, &place.state, place.elapsed, place.late);
        self.coarse.along(elapsed)
    }
}
