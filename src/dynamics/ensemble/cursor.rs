//! One motion on its way, phase by phase.

use super::{Member, Watcher};
use crate::crossing::Counters;
use crate::model::Model;
use crate::model::entry::Entry;
use crate::model::instant::Instant;
use crate::run::exit::{Endless, Exit};
use crate::run::switch::Begun;
use crate::run::trajectory::Segment;
use std::ops::ControlFlow;

/// A motion of an ensemble and its current phase.
pub struct Cursor<'a, W> {
    /// The model that is followed.
    pub model: &'a Model,
    /// The entry of the motion's present phase.
    pub entry: Entry,
    /// The present phase as the scalar solver has begun it, if it passed the phase before.
    begun: Option<Begun>,
    /// The instant of the next strobe.
    pub due: Instant,
    horizon: Option<Instant>,
    watcher: W,
}

impl<'a, W: Watcher> Cursor<'a, W> {
    pub fn new(motion: Member<'a, W>) -> Self {
        let Member { model, entry, first, horizon, watcher } = motion;
        Self { model, entry, begun: None, due: first, horizon, watcher }
    }

    /// Follows the motion to its end by the scalar solver; gives its watcher, and the number of
    /// phases.
    pub fn watched_alone(mut self) -> (W, u64) {
        let mut phases = 1;
        while self.pass().is_continue() {
            phases += 1;
        }
        (self.watcher, phases)
    }

    /// The watcher of the motion.
    #[cfg(feature = "lanes")]
    pub fn into_watcher(self) -> W {
        self.watcher
    }

    /// Takes one phase by the scalar solver.
    pub fn pass(&mut self) -> ControlFlow<()> {
        let horizon = self.horizon.as_ref();
        let begun = self.begun.take().unwrap_or_else(|| Begun::at(self.model, self.entry));
        let mut next_begun = begun;
        let segment =
            Segment::new(self.model, &begun, &mut next_begun, horizon, &mut Counters::default());
        let endless = match segment.exit() {
            Exit::Endless(endless) => Some(*endless),
            Exit::Switch(_) | Exit::Horizon | Exit::Undecidable => None,
        };
        while !segment.ends_by(&self.due) {
            if segment.is_undecided_at(&self.due) {
                return ControlFlow::Break(());
            }
            self.see(&segment.entry_at(&self.due), endless)?;
        }
        if let Exit::Switch(next) = segment.exit() {
            self.enter(next);
            self.begun = Some(next_begun);
        }
        ControlFlow::Continue(())
    }

    /// Goes on to the next phase.
    pub fn enter(&mut self, next: &Entry) {
        self.watcher.enter(next);
        self.entry = *next;
        self.begun = None;
    }

    /// Shows the watcher the strobe that was due, and sets the next.
    pub fn see(&mut self, strobe: &Entry, endless: Option<Endless>) -> ControlFlow<()> {
        self.due = self.due.next_cycle();
        self.watcher.see(strobe, endless)
    }
}
