//! A run at times that are given, not found: its horizon, from which it may go on, and the errors
//! there.

use super::Run;
use super::enclosure::{Enclosure, roundings};
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::guards::point::Passed;
use crate::affine::solver::SolverMode;
use crate::affine::solver::event::{Ending, Errors};
use crate::numeric::number::{Bound, Number};

/// The number of steps from one horizon to the next by which a run that goes on searches ahead: a
/// caller that stops once stops many times.
const STEPS_AHEAD: f64 = 16.0;

impl<T: Number> Run<'_, T> {
    /// Lets a run that has ended at its horizon go on to one that is not earlier, and says whether
    /// it does. Its state at any time is so known between its events: [`Ending::Horizon`] has it,
    /// with bounds of its errors where they are followed.
    pub fn go_on(&mut self, until: T) -> bool {
        let step = self.solver.directed(until - self.horizon.value());
        // Written so that a NaN is refused.
        let is_later = step >= T::zero() && step.to_f64().is_finite();
        let goes_on = is_later && self.queue.is_empty() && self.ending() == Some(&Ending::Horizon);
        if goes_on {
            if self.ahead.is_none() {
                self.search_ahead(step * T::exact(STEPS_AHEAD));
            }
            (self.horizon, self.ended) = (Time { high: until, low: T::zero() }, false);
            if !self.has_found() {
                (self.ends.left.to_crossing, self.ends.passed) = (T::zero(), Passed::none());
            }
        }
        goes_on
    }

    /// The errors of a state at a given time, which is `elapsed` after the entry of the present
    /// segment.
    pub(super) fn errors_at_given_time(
        &self,
        mode: usize,
        elapsed: T,
        time: &Time<T>,
        state: &Vector<T>,
    ) -> Option<Enclosure<T::Bound>> {
        let SolverMode { flow, matrix, .. } = &self.solver.modes[mode];
        let mut errors = self.enclosure.as_ref()?.at_given_time(flow, matrix, state, elapsed);
        errors.add_box(&roundings(flow, &self.segment.entry, elapsed));
        errors.add_box(&self.solver.phase_roundings(time));
        Some(errors)
    }

    /// Bounds of the errors that an enclosure holds, with the rounding of a time to one number.
    pub(super) fn errors_near(
        &self,
        enclosure: &Enclosure<T::Bound>,
        time: &Time<T>,
    ) -> Errors<T::Bound> {
        let states = self.solver.system.states.len();
        let rounding = T::unit() * 2.0 * time.high.bound().abs();
        Errors { time: enclosure.time() + rounding, state: enclosure.state()[..states].to_vec() }
    }
}
