//! The run: phases joined at their switches (the method of Section 3), as an iterator.

use crate::crossing::Counters;
use crate::entry::Entry;
use crate::instant::Instant;
use crate::leg::{Exit, Leg};
use crate::model::Model;
use crate::switch::{Begun, End, Passed, pass};
use crate::two_word::TwoWord;

/// An iterator over the phases of a run; memory does not grow with its length.
///
/// A run taken up at one of its phases goes on as it did to within rounding, not to the last bit: a root is
/// computed from where it was guessed, and what is guessed depends on the phase before.
///
/// It ends after a phase that reaches the horizon or never ends; without a horizon and as long as
/// switches come it goes on for ever.
#[derive(Clone, Debug)]
pub struct Trajectory {
    model: Model,
    next: Option<Begun>,
    horizon: Option<Instant>,
    counters: Counters,
}

/// One phase passed ([`Trajectory::step`]).
#[derive(Clone, Debug)]
pub enum Step<'a> {
    /// It ends by a switch.
    Switch {
        /// How long it lasts.
        duration: TwoWord,
        /// How the next phase begins.
        next: &'a Entry,
    },
    /// It is the run's last: cut by the horizon, or endless.
    Last(Box<Leg>),
}

impl Model {
    /// The run that begins at `entry`.
    #[must_use]
    pub fn trajectory(&self, entry: Entry) -> Trajectory {
        let next = Some(Begun::at(self, entry));
        Trajectory { model: *self, next, horizon: None, counters: Counters::default() }
    }
}

impl Trajectory {
    /// Ends the run at `horizon`: the last phase is cut there.
    #[must_use]
    pub fn until(mut self, horizon: Instant) -> Self {
        self.horizon = Some(horizon);
        self
    }

    /// What the run has cost and met so far.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Passes the next phase; unlike iterating without keeping it, at less cost.
    #[inline]
    pub fn step(&mut self) -> Option<Step<'_>> {
        let begun = self.next.as_mut()?;
        let passed = pass(&self.model, begun, self.horizon.as_ref(), &mut self.counters);
        match passed.end {
            End::Switch => {
                let next = &self.next.as_ref()?.entry;
                Some(Step::Switch { duration: passed.duration, next })
            }
            End::Horizon | End::Endless(_) => {
                self.last(&passed).map(|leg| Step::Last(Box::new(leg)))
            }
        }
    }

    /// The phase that no other follows.
    #[cold]
    fn last(&mut self, passed: &Passed) -> Option<Leg> {
        let begun = self.next.take()?;
        Some(Leg::passed(&self.model, &begun, passed, &begun.entry))
    }

    /// The model that runs.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }
}

impl Iterator for Trajectory {
    type Item = Leg;

    fn next(&mut self) -> Option<Leg> {
        let begun = self.next.as_mut()?;
        let leg = Leg::new(&self.model, begun, self.horizon.as_ref(), &mut self.counters);
        if !matches!(leg.exit(), Exit::Switch(_)) {
            self.next = None;
        }
        Some(leg)
    }
}
