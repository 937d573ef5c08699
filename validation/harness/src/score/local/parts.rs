//! The parts of a record beside each other: the guard where the event was located, the states
//! before and after the reset, and the mode.

use super::continuation::Named;
use super::judgement::{Defects, WrongKind, exceeds};
use super::motion::value as value_of;
use super::walk::{Said, Walk};
use crate::engine::Event;
use crate::score::worst;
use crate::system::Row;
use nalgebra::RowDVector;

/// Roundings of an event's time that a guard's value may show, each times the guard's rate.
const TIME_TOLERANCE: f64 = 128.0 * f64::EPSILON;

/// The part of a guard's size that rounding leaves where a dense output of high order is at a root:
/// three times the largest that was measured, 7e-12 of a method of order 7.
const DENSE_OUTPUT_TOLERANCE: f64 = 2e-11;

/// The largest location error of a right engine, in tolerances of the guard's size.
pub(super) const MAX_LOCATION_ERROR: f64 = 1.0;
/// The largest contradiction between the state before a reset and that after it, in tolerances.
pub(super) const MAX_INCONSISTENCY: f64 = 1.0;

impl Walk<'_> {
    /// Judges a record whose event may fire, by what that event makes of the present flow at the
    /// record's own time.
    pub(super) fn by_its_own_event(&mut self, event: &Event, named: Named) -> Said {
        let (said, defects) = self.own_event_of(event, named);
        self.found.defects.append(defects);
        said
    }

    /// The judgement of [`Self::by_its_own_event`], and the defects that it measures.
    pub(super) fn own_event_of(&mut self, event: &Event, named: Named) -> (Said, Defects) {
        let mut defects = Defects::default();
        let said = self.own_defects(event, named, &mut defects);
        (said, defects)
    }

    fn own_defects(&mut self, event: &Event, named: Named, defects: &mut Defects) -> Said {
        if let Some(said) = self.contradiction(event, named, defects) {
            return said;
        }
        let before = self.off_the_flow(event);
        defects.sample.extend(before);
        if let Some(defect) = before.filter(|it| exceeds(*it, self.units.allowance.sample)) {
            return Said::Wrong(WrongKind::Sample, None, defect);
        }
        let state = self.off_the_reset(event, named);
        // Of an event that is only counted the state is one of the flow, with the flow's bound.
        if exceeds(state, self.units.allowance.state.max(self.units.allowance.sample)) {
            defects.state.push(state);
            return Said::Wrong(WrongKind::State, None, state);
        }
        let stretch = self.place.stretch(event.elapsed);
        if self.successor(event, named) == Some(named.next) {
            Said::Right
        } else if self.successor_is_open(event, named, &stretch) {
            Said::Undecidable
        } else {
            Said::Wrong(WrongKind::WrongMode, None, f64::NAN)
        }
    }

    /// Judges a record of an event at which either answer is right: it has to be one of the two.
    pub(super) fn open(&mut self, event: &Event, named: Named) -> Said {
        match self.by_its_own_event(event, named) {
            Said::Right => Said::Undecidable,
            said => said,
        }
    }

    /// The contradiction between an event and the parts of its record: a guard that is not zero
    /// where it was located, or a state that is not the reset of the state before it.
    pub(super) fn contradiction(
        &self,
        event: &Event,
        named: Named,
        defects: &mut Defects,
    ) -> Option<Said> {
        let location = self.location(event, named);
        defects.location.extend(location);
        if let Some(location) = location.filter(|it| exceeds(*it, MAX_LOCATION_ERROR)) {
            return Some(Said::Wrong(WrongKind::Location, None, location));
        }
        let inconsistency = self.inconsistency(event, named);
        defects.inconsistency.extend(inconsistency);
        let defect = inconsistency.filter(|it| exceeds(*it, MAX_INCONSISTENCY))?;
        Some(Said::Wrong(WrongKind::Inconsistent, None, defect))
    }

    /// The defect of a record's state beside what its event makes of the flow at its time.
    pub(super) fn off_the_reset(&mut self, event: &Event, named: Named) -> f64 {
        let flow = self.along(event.elapsed);
        let stretch = self.place.stretch(event.elapsed);
        if named.event >= self.until_count() {
            return self.units.of_sample((&event.state, &flow), &stretch);
        }
        let after = self.motion().after((self.place.mode, named.event), event.elapsed, &flow);
        let after: Vec<f64> = after.iter().map(|it| it.value).collect();
        self.units.of_reset((&event.state, &after), &stretch, named.event)
    }

    /// The mode after a record's event by the record's own state.
    fn successor(&self, event: &Event, named: Named) -> Option<usize> {
        let motion = self.motion();
        let Some(until) = motion.system().modes[self.place.mode].until.get(named.event) else {
            return Some(self.place.mode);
        };
        let z = motion.point(event.elapsed, &event.state);
        let holds = |when: &Row| value_of(&RowDVector::from_row_slice(when), &z).value > 0.0;
        let next = until.next.iter().find(|(when, _)| when.as_ref().is_none_or(holds));
        next.map(|(_, mode)| *mode)
    }

    /// |guard| at the state before the reset, in tolerances of the guard's size.
    pub(super) fn location(&self, event: &Event, named: Named) -> Option<f64> {
        let before = event.before.as_ref()?;
        let at = (self.place.mode, named.event);
        let motion = self.motion();
        let value = motion.value((at.0, at.1, 0), event.elapsed, before);
        let rate = motion.value((at.0, at.1, 1), event.elapsed, before).value.abs();
        let clock = self.judge.problem.clock(event.elapsed).abs().max(event.elapsed);
        let rounding = value.rounding + TIME_TOLERANCE * clock * rate;
        let size = motion.size(motion.guard(at.0, at.1), before);
        // A guard of theta alone has the size of its change in a unit of time.
        let size = if size > 0.0 { size } else { rate * motion.system().time_scale };
        let beyond = value.value.abs() - rounding;
        if value.value.is_nan() {
            return Some(f64::NAN);
        }
        let unit = self.units.tolerance().max(DENSE_OUTPUT_TOLERANCE) * size;
        Some(if beyond <= 0.0 { 0.0 } else { beyond / unit })
    }

    /// The defect of the state before a record's reset beside the flow of the record before, at the
    /// record's own time.
    pub(super) fn off_the_flow(&mut self, event: &Event) -> Option<f64> {
        let before = event.before?;
        let flow = self.along(event.elapsed);
        Some(self.units.of_sample((&before, &flow), &self.place.stretch(event.elapsed)))
    }

    /// The contradiction between the state before a record's reset and that after it.
    pub(super) fn inconsistency(&self, event: &Event, named: Named) -> Option<f64> {
        let before = event.before.as_ref()?;
        let until = self.until_count();
        let motion = self.motion();
        let weights = motion.weights(&event.state);
        let after: Vec<(f64, f64)> = if named.event < until {
            let after = motion.after((self.place.mode, named.event), event.elapsed, before);
            after.iter().map(|it| (it.value, it.rounding)).collect()
        } else {
            before.iter().map(|it| (*it, 0.0)).collect()
        };
        // A reset may put the state on the guard, which the state before it need not be.
        let guard = motion.guard(self.place.mode, named.event);
        let beside = motion.size(guard, before);
        let off = after.iter().zip(event.state.iter()).zip(&weights);
        let off = off.map(|(((value, rounding), own), weight)| {
            let beyond = (value - own).abs() - rounding;
            let unit = self.units.tolerance() * (weight + beside);
            if beyond.is_nan() { f64::NAN } else { beyond.max(0.0) / unit }
        });
        Some(worst(off))
    }
}
