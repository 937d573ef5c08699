//! The events of a run, and its endings.

use crate::affine::arithmetic::clock::Time;
use crate::numeric::number::{Bound, Number};

/// The kind of an event of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum What<T> {
    /// The run begins.
    Start,
    /// The mode of this index ends by its `until` of this index.
    Until(usize, usize),
    /// The `watch` of the second index is crossed in the mode of the first.
    Watch(usize, usize),
    /// The event of the mode of this index that its `until` of the second index makes has
    /// accumulated, and the run goes on.
    Limit(usize, usize),
    /// The run ends.
    End(Ending<T>),
}

/// The ending of a run. The first and the third have an instant of their own. A run that follows
/// its errors and is undecided has the latest time and state that are proved to lie before every
/// crossing. Any other ending has those of the last event, watched ones included, or of the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending<T> {
    /// The horizon is reached.
    Horizon,
    /// Impacts accumulate: their limit lies between these two times after the last event.
    Accumulation(T, T),
    /// A backward run reaches the boundary of its mode.
    LeavesDomain,
    /// The run makes no progress: too many events lie in one instant.
    NoProgress,
    /// A mode is entered where one of its guards is positive already.
    BeyondGuard,
    /// The arithmetic has too few digits to decide which event is next, or the search for it takes
    /// too much work.
    Undecided,
}

/// An event of a run.
#[derive(Debug)]
pub struct Event<T: Number> {
    /// The kind of event.
    pub what: What<T>,
    /// The time of the event.
    pub time: Time<T>,
    /// The state just after the event.
    pub state: Vec<T>,
    /// The index of the mode just after the event.
    pub mode: usize,
    /// Bounds of the errors, in a run that follows them.
    pub errors: Option<Errors<T::Bound>>,
}

impl<T: Number> Clone for Event<T> {
    fn clone(&self) -> Self {
        Self {
            what: self.what,
            time: self.time,
            state: self.state.clone(),
            mode: self.mode,
            errors: self.errors.clone(),
        }
    }

    /// Reuses the memory of the state.
    #[inline]
    fn clone_from(&mut self, other: &Self) {
        (self.what, self.time) = (other.what, other.time);
        self.state.clone_from(&other.state);
        self.mode = other.mode;
        self.errors.clone_from(&other.errors);
    }
}

impl<T: Number> Event<T> {
    /// Makes states exactly zero that are so by the model, given as bits.
    pub(in crate::affine) fn set_zeros(&mut self, states: u64) {
        for n in (0..self.state.len()).filter(|n| states >> n & 1 == 1) {
            self.state[n] = T::zero();
            if let Some(errors) = &mut self.errors {
                errors.state[n] = T::Bound::ZERO;
            }
        }
    }
}

/// Bounds of the errors of an event's time and state.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors<B> {
    /// A bound of the error of the time.
    pub time: B,
    /// For each state, a bound of its error.
    pub state: Vec<B>,
}

impl<B: Bound> Errors<B> {
    /// Whether all bounds are finite.
    pub(in crate::affine) fn are_finite(&self) -> bool {
        self.time.is_finite() && self.state.iter().all(|it| it.is_finite())
    }
}
