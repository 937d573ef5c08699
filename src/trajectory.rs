//! The run: phases joined at their switches (the method of Section 3), as an iterator.

use crate::crossing::Counters;
use crate::entry::Entry;
use crate::instant::Instant;
use crate::leg::{Exit, Leg};
use crate::model::Model;

/// An iterator over the phases of a run; memory does not grow with its length.
///
/// It ends after a phase that reaches the horizon or never ends; without a horizon and as long as
/// switches come it goes on for ever.
#[derive(Clone, Debug)]
pub struct Trajectory {
    model: Model,
    next: Option<Entry>,
    horizon: Option<Instant>,
    counters: Counters,
}

impl Model {
    /// The run that begins at `entry`.
    #[must_use]
    pub fn trajectory(&self, entry: Entry) -> Trajectory {
        Trajectory { model: *self, next: Some(entry), horizon: None, counters: Counters::default() }
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

    /// The model that runs.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }
}

impl Iterator for Trajectory {
    type Item = Leg;

    fn next(&mut self) -> Option<Leg> {
        let entry = self.next.take()?;
        let leg = Leg::new(&self.model, entry, self.horizon.as_ref(), &mut self.counters);
        if let Exit::Switch(next) = leg.exit() {
            self.next = Some(*next);
        }
        Some(leg)
    }
}
