//! The attractors that are known so far, and where starts lead.

use super::Attractor;
use super::cells::Cells;
use super::recognition::Recognition;
use super::settle::Settled;
use super::trap::Trap;
use crate::dynamics::ensemble::{self, Motion};
use crate::dynamics::parallel;
use crate::dynamics::strobe::{Point, StrobeMap};
use crate::entry::Entry;

/// Where a start leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Label {
    /// To an attractor, by its place in the atlas.
    Attractor(usize),
    /// To a phase that never ends: the mass never returns or the slider never stops.
    Escaping,
    /// Not known.
    Unresolved,
}

/// An attractor and what a motion near it is recognised by.
#[derive(Clone, Debug)]
pub(super) struct Known {
    pub attractor: Attractor,
    pub evidence: Evidence,
}

/// What a motion is recognised by.
#[derive(Clone, Debug)]
pub(super) enum Evidence {
    Traps(Vec<Trap>),
    Cells(Cells),
}

/// The attractors of a strobe map that have been met.
#[derive(Clone, Debug)]
pub struct Atlas {
    pub(super) map: StrobeMap,
    pub(super) transient: u64,
    pub(super) known: Vec<Known>,
}

/// Starts looked at in one go: what is kept of each until then is ten times its label.
const BLOCK: usize = 1 << 14;
/// Most starts that are settled between two looks at what has been found.
const LARGEST_BATCH: usize = 64;
/// Two runs are on one attractor when this share of one lies in the cells of the other.
const SAME: f64 = 0.5;
/// A motion is at rest on an orbit when the square of its distance is so small a share of the
/// trap's radius: it need not come closer still.
pub(super) const AT_REST: f64 = 1e-12;

impl Atlas {
    /// Of no attractor yet. A start is followed for `transient` forcing periods (at least one), and
    /// for 2, 4 and 8 times that more where it is not recognised by then.
    #[must_use]
    pub fn new(map: StrobeMap, transient: u64) -> Self {
        Self { map, transient: transient.max(1), known: Vec::new() }
    }

    /// The map whose attractors they are.
    #[must_use]
    pub const fn map(&self) -> &StrobeMap {
        &self.map
    }

    /// The attractors, in the order in which they were met.
    pub fn attractors(&self) -> impl Iterator<Item = &Attractor> {
        self.known.iter().map(|it| &it.attractor)
    }

    /// Where a start leads, as far as the attractors met so far tell.
    #[must_use]
    pub fn label(&self, start: Point) -> Label {
        let Ok(entry) = self.map.entry(start) else { return Label::Unresolved };
        let mut from = entry;
        for extension in 0..=super::settle::EXTENSIONS {
            match self.recognised(from, self.transient << extension) {
                Ok(label) => return label,
                Err(last) => from = last,
            }
        }
        Label::Unresolved
    }

    /// Where many starts lead; attractors not met before are added. `seen` is told how many starts more
    /// are done.
    pub fn label_all(&mut self, starts: &[Point], seen: &(dyn Fn(u64) + Sync)) -> Vec<Label> {
        let mut labels = vec![Label::Unresolved; starts.len()];
        let mut open = Vec::new();
        for (block, from) in starts.chunks(BLOCK).zip((0..).step_by(BLOCK)) {
            let entry =
                |(start, place): (&Point, usize)| Some((place, self.map.entry(*start).ok()?));
            let entries: Vec<_> = block.iter().zip(from..).filter_map(entry).collect();
            seen((block.len() - entries.len()) as u64);
            open.extend(self.still_open(entries, &mut labels, seen));
        }
        self.settle_all(open, &mut labels, seen);
        labels
    }

    /// Settles what is not recognised, a few at a time: each attractor found may explain the rest.
    fn settle_all(
        &mut self,
        mut open: Vec<(usize, Entry)>,
        labels: &mut [Label],
        seen: &(dyn Fn(u64) + Sync),
    ) {
        let mut batch = 1;
        while !open.is_empty() {
            let rest = open.split_off(batch.min(open.len()));
            let settled = parallel::map(&open, |(_, entry)| self.settled(*entry));
            let before = self.known.len();
            for ((index, _), outcome) in open.iter().zip(settled) {
                labels[*index] = self.adopted(outcome);
            }
            seen(open.len() as u64);
            batch = (2 * batch).min(LARGEST_BATCH);
            open = rest;
            if self.known.len() > before {
                batch = 1;
                open = self.still_open(open, labels, seen);
            }
        }
    }

    /// The label of what was settled; an attractor not known before is added.
    fn adopted(&mut self, settled: Settled) -> Label {
        let new = match settled {
            Settled::Label(label) => return label,
            Settled::New(new) => *new,
        };
        // Another start of the same batch may have found it.
        let same = self.known.iter().position(|known| known.is(&new));
        Label::Attractor(same.unwrap_or_else(|| {
            self.known.push(new);
            self.known.len() - 1
        }))
    }

    /// Labels the motions that are recognised, if anything is known; the others, where they are then.
    fn still_open(
        &self,
        motions: Vec<(usize, Entry)>,
        labels: &mut [Label],
        seen: &(dyn Fn(u64) + Sync),
    ) -> Vec<(usize, Entry)> {
        if self.known.is_empty() {
            return motions;
        }
        let recognitions = ensemble::follow(motions.len(), |number| {
            let from = motions[number].1;
            let watcher = Recognition::new(&self.known, from, self.transient, seen);
            self.motion(from, watcher)
        });
        let mut open = Vec::new();
        for ((place, _), recognition) in motions.into_iter().zip(recognitions) {
            match recognition.outcome() {
                Ok(label) => labels[place] = label,
                Err(last) => open.push((place, last)),
            }
        }
        open
    }

    /// Follows a motion until it is recognised, for at most so many strobes; where it is then if it
    /// is not.
    pub(super) fn recognised(&self, from: Entry, strobes: u64) -> Result<Label, Entry> {
        let watcher = Recognition::new(&self.known, from, strobes, &|_| {});
        ensemble::follow_alone(self.motion(from, watcher)).outcome()
    }

    fn motion<W>(&self, from: Entry, watcher: W) -> Motion<'_, W> {
        let model = self.map.model();
        Motion { model, entry: from, first: from.instant, horizon: None, watcher }
    }
}

impl Known {
    /// Whether both are the same attractor.
    fn is(&self, other: &Self) -> bool {
        match (&self.evidence, &other.evidence) {
            (Evidence::Traps(traps), Evidence::Traps(_)) => {
                self.attractor.period() == other.attractor.period()
                    && traps.iter().any(|trap| {
                        other.attractor.points.iter().any(|point| trap.size(point) < AT_REST)
                    })
            }
            (Evidence::Cells(cells), Evidence::Cells(others)) => {
                cells.share(&other.attractor.points) > SAME
                    || others.share(&self.attractor.points) > SAME
            }
            _ => false,
        }
    }

    pub(super) fn period(&self) -> u64 {
        u64::from(self.attractor.period().unwrap_or(1))
    }
}
