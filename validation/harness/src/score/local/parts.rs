//! The parts of a record beside each other: the guard where the event was located, and the states
//! before and after the reset.

use super::continuation::Named;
use super::walk::Walk;
use crate::engine::Event;
use crate::score::worst;

/// Roundings of an event's time that a guard's value may show, each times the guard's rate.
const ROUNDINGS_OF_TIME: f64 = 128.0 * f64::EPSILON;

/// The part of a guard's size that rounding leaves where a dense output of high order is at a root:
/// three times the largest that was measured, 7e-12 of a method of order 7.
const ROUNDINGS_OF_DENSE_OUTPUT: f64 = 2e-11;

impl Walk<'_> {
    /// |guard| at the state before the reset, in tolerances of the guard's size.
    pub(super) fn location(&self, event: &Event, named: Named) -> Option<f64> {
        let before = event.before.as_ref()?;
        let at = (self.place.mode, named.event);
        let motion = self.motion();
        let value = motion.value((at.0, at.1, 0), event.elapsed, before);
        let rate = motion.value((at.0, at.1, 1), event.elapsed, before).value.abs();
        let clock = self.judge.problem.clock(event.elapsed).abs().max(event.elapsed);
        let rounding = value.rounding + ROUNDINGS_OF_TIME * clock * rate;
        let size = motion.size(motion.guard(at.0, at.1), before);
        // A guard of theta alone has the size of its change in a unit of time.
        let size = if size > 0.0 { size } else { rate * motion.system().time_scale };
        let beyond = value.value.abs() - rounding;
        if value.value.is_nan() {
            return Some(f64::NAN);
        }
        let unit = self.units.tolerance().max(ROUNDINGS_OF_DENSE_OUTPUT) * size;
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
