//! The run: phases joined at their switches (the method of Section 3), as an iterator.

use crate::crossing::Counters;
use crate::entry::Entry;
use crate::flow::forcing::EntryAngle;
use crate::instant::Instant;
use crate::leg::{Exit, Leg, Passed, pass};
use crate::model::Model;
use crate::two_word::TwoWord;

/// An iterator over the phases of a run; memory does not grow with its length.
///
/// It ends after a phase that reaches the horizon or never ends; without a horizon and as long as
/// switches come it goes on for ever.
#[derive(Clone, Debug)]
pub struct Trajectory {
    model: Model,
    next: Option<(Entry, EntryAngle<f64>)>,
    horizon: Option<Instant>,
    counters: Counters,
}

/// One phase passed ([`Trajectory::step`]).
#[derive(Clone, Debug)]
pub enum Step {
    /// It ends by a switch.
    Switch {
        /// How long it lasts.
        duration: TwoWord,
        /// How the next phase begins.
        next: Entry,
    },
    /// It is the run's last: cut by the horizon, or endless.
    Last(Box<Leg>),
}

impl Model {
    /// The run that begins at `entry`.
    #[must_use]
    pub fn trajectory(&self, entry: Entry) -> Trajectory {
        let angle = self.forcing_angle(&entry.instant);
        let next = Some((entry, angle));
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
    pub fn step(&mut self) -> Option<Step> {
        let (entry, angle) = self.next?;
        let Passed { exit, duration, .. } = self.go_on(&entry, angle);
        Some(match exit {
            Exit::Switch(next) => Step::Switch { duration, next },
            _ => Step::Last(Box::new(Leg::passed(&self.model, entry, angle, exit, duration))),
        })
    }

    #[inline]
    fn go_on(&mut self, entry: &Entry, angle: EntryAngle<f64>) -> Passed {
        let passed = pass(&self.model, entry, angle, self.horizon.as_ref(), &mut self.counters);
        self.next = match (&passed.exit, passed.angle) {
            (Exit::Switch(next), Some(angle)) => Some((*next, angle)),
            _ => None,
        };
        passed
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
        let (entry, angle) = self.next?;
        let Passed { exit, duration, .. } = self.go_on(&entry, angle);
        Some(Leg::passed(&self.model, entry, angle, exit, duration))
    }
}
