//! Stroboscopic sections: the motion at successive instants with one forcing angle.

use super::ensemble::{self, Member, Watcher};
use crate::model::Model;
use crate::model::entry::Entry;
use crate::model::instant::Instant;
use crate::run::exit::{Endless, Exit};
use crate::run::trajectory::{Segment, Trajectory};
use std::ops::ControlFlow;

/// The strobes of one motion from some instant on: one pass over its phases, in constant memory.
///
/// The iterator ends only at an undecidable phase ([`Exit::Undecidable`]); a motion in a phase that
/// never ends has strobes for ever. The segments come from a trajectory, or from an adaptor of one.
#[derive(Clone, Debug)]
pub struct Section<I = Trajectory> {
    trajectory: I,
    segment: Option<Segment>,
    next: Instant,
}

impl<I: Iterator<Item = Segment>> Section<I> {
    /// The strobes of a run from `first` on, which is not before its start.
    ///
    /// Phases that a horizon cuts are continued beyond it.
    #[must_use]
    pub fn along(mut trajectory: I, first: Instant) -> Self {
        let segment = trajectory.next();
        Self { trajectory, segment, next: first }
    }

    /// Why the phase that the motion is in has no end, where that is proved.
    #[must_use]
    pub fn endless(&self) -> Option<Endless> {
        match self.segment.as_ref()?.exit() {
            Exit::Endless(endless) => Some(*endless),
            Exit::Switch(_) | Exit::Horizon | Exit::Undecidable => None,
        }
    }
}

impl Section {
    /// Why the phase that begins, or goes on, at `entry` has no end, where that is proved.
    #[must_use]
    pub fn endless_at(model: &Model, entry: &Entry) -> Option<Endless> {
        Self::along(model.trajectory(*entry), entry.instant).endless()
    }
}

impl<I: Iterator<Item = Segment>> Iterator for Section<I> {
    type Item = Entry;

    fn next(&mut self) -> Option<Entry> {
        while self.segment.as_ref()?.ends_by(&self.next) {
            self.segment = self.trajectory.next();
        }
        let segment = self.segment.as_ref()?;
        if segment.is_undecided_at(&self.next) {
            return None;
        }
        let strobe = segment.entry_at(&self.next);
        self.next = self.next.after_periods(1, 1);
        Some(strobe)
    }
}

/// The stroboscopic section at the forcing angle `angle` (omega tau mod 2 pi, radians, phi not
/// included): `count` strobes, the first at least `transient` forcing periods after `from`.
pub fn section(
    model: &Model,
    from: Entry,
    angle: f64,
    transient: u64,
    count: u64,
) -> impl Iterator<Item = Entry> {
    let first = from.instant.after_periods(transient, 1).first_at_angle(angle);
    let last = first.after_periods(count, 1);
    let strobes = Section::along(model.trajectory(from).until(last), first);
    (0..count).zip(strobes).map(|(_, strobe)| strobe)
}

/// The sections of many motions of one model, followed all at once: their strobes in the order of
/// the starts.
#[must_use]
pub fn sections(
    model: &Model,
    starts: &[Entry],
    angle: f64,
    transient: u64,
    count: usize,
) -> Vec<Vec<Entry>> {
    if count == 0 {
        return vec![Vec::new(); starts.len()];
    }
    let kept = ensemble::follow(starts.len(), |number| {
        let entry = starts[number];
        let first = entry.instant.after_periods(transient, 1).first_at_angle(angle);
        let horizon = Some(first.after_periods(count as u64, 1));
        Member { model, entry, first, horizon, watcher: KeptStrobes::new(count, &|_| ()) }
    });
    kept.into_iter().map(|it| it.strobes).collect()
}

/// The phases of a motion after which its work is told of: a fraction of a millisecond.
const PHASES_TO_TELL: u32 = 4096;

/// A watcher that keeps the first strobes of a motion.
pub(super) struct KeptStrobes<'a> {
    wanted: usize,
    pub strobes: Vec<Entry>,
    /// The phases since it was told of the last ones.
    phases: u32,
    /// Told of one more motion when all wanted strobes are kept, and now and then before of none.
    done: &'a (dyn Fn(u64) + Sync),
}

impl<'a> KeptStrobes<'a> {
    pub fn new(wanted: usize, done: &'a (dyn Fn(u64) + Sync)) -> Self {
        Self { wanted, strobes: Vec::new(), phases: 0, done }
    }
}

impl Watcher for KeptStrobes<'_> {
    fn see(&mut self, strobe: &Entry, _: Option<Endless>) -> ControlFlow<()> {
        self.strobes.push(*strobe);
        if self.strobes.len() < self.wanted {
            return ControlFlow::Continue(());
        }
        (self.done)(1);
        ControlFlow::Break(())
    }

    fn enter(&mut self, _: &Entry) {
        self.phases += 1;
        if self.phases == PHASES_TO_TELL {
            self.phases = 0;
            (self.done)(0);
        }
    }
}
