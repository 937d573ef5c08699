//! The attractors that are known so far, and where starts lead.

use super::known::{KnownAttractor, Label};
use super::limits::SearchLimits;
use super::recognition::Recognition;
use super::settle::{AttractorSearch, Settled};
use super::thresholds::{BLOCK, EXTENSIONS, LARGEST_BATCH};
use super::{Attractor, horizon};
use crate::dynamics::ensemble::{self, Member};
use crate::dynamics::parallel;
use crate::dynamics::strobe::{StrobeMap, StrobePoint};
use crate::model::entry::Entry;

/// The attractors of a strobe map that have been met.
#[derive(Clone, Debug)]
pub struct AttractorCatalog {
    map: StrobeMap,
    limits: SearchLimits,
    known: Vec<KnownAttractor>,
}

impl AttractorCatalog {
    /// A catalog that has no attractor yet.
    #[must_use]
    pub fn new(map: StrobeMap, limits: impl Into<SearchLimits>) -> Self {
        Self { map, limits: limits.into().clamped(), known: Vec::new() }
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

    /// The attractors with what motions near them are recognised by, in the same order.
    pub(super) fn known(&self) -> &[KnownAttractor] {
        &self.known
    }

    /// How many events a start meets until it is recognised or given up.
    pub(super) fn events(&self, start: StrobePoint) -> u64 {
        let Ok(mut entry) = self.map.entry(start) else { return 0 };
        let mut events = 0;
        for extension in 0..=EXTENSIONS {
            let recognition = self.recognition(entry, self.limits.transient << extension);
            events += recognition.events();
            match recognition.outcome() {
                Ok(_) => break,
                Err(last) => entry = last,
            }
        }
        events
    }

    /// The label of a start, as far as the attractors met so far tell.
    #[must_use]
    pub fn label(&self, start: StrobePoint) -> Label {
        let Ok(entry) = self.map.entry(start) else { return Label::Unresolved };
        self.extended(entry, |recognised, _| recognised.ok()).unwrap_or(Label::Unresolved)
    }

    /// The labels of many starts; attractors not met before are added. `seen` is told how many
    /// starts more are done.
    pub fn label_all(&mut self, starts: &[StrobePoint], seen: &(dyn Fn(u64) + Sync)) -> Vec<Label> {
        let mut labels = vec![Label::Unresolved; starts.len()];
        let mut open = Vec::new();
        for (block, from) in starts.chunks(BLOCK).zip((0..).step_by(BLOCK)) {
            let entry =
                |(start, place): (&StrobePoint, usize)| Some((place, self.map.entry(*start).ok()?));
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

    /// The attractor on which a motion settles.
    fn settled(&self, from: Entry) -> Settled {
        let search = AttractorSearch { map: &self.map, known: &self.known, limits: self.limits };
        let settled = self.extended(from, |recognised, extension| match recognised {
            Ok(label) => Some(Settled::Label(label)),
            Err(last) => search.identified(last, extension == EXTENSIONS),
        });
        settled.unwrap_or(Settled::Label(Label::Unresolved))
    }

    /// Follows a motion for its transient, and for the extensions of that as long as nothing is
    /// `made` of the label that it has by then, or of where it is without one, and of the number of
    /// the extension.
    fn extended<T>(
        &self,
        mut from: Entry,
        made: impl Fn(Result<Label, Entry>, u32) -> Option<T>,
    ) -> Option<T> {
        (0..=EXTENSIONS).find_map(|extension| {
            let recognised = self.recognised(from, self.limits.transient << extension);
            if let Err(last) = recognised {
                from = last;
            }
            made(recognised, extension)
        })
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

    /// Labels the motions that are recognised, if anything is known; the others, where they are
    /// then.
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
            let watcher = Recognition::new(&self.known, from, self.limits.transient, seen);
            self.motion(from, self.limits.transient, watcher)
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
    fn recognised(&self, from: Entry, strobes: u64) -> Result<Label, Entry> {
        self.recognition(from, strobes).outcome()
    }

    /// What has been seen of a motion after so many strobes, or when it was recognised.
    fn recognition(&self, from: Entry, strobes: u64) -> Recognition<'_> {
        let watcher = Recognition::new(&self.known, from, strobes, &|_| {});
        ensemble::follow_alone(self.motion(from, strobes, watcher))
    }

    /// The motion from here on, of which so many strobes after the first are looked at.
    fn motion<W>(&self, from: Entry, strobes: u64, watcher: W) -> Member<'_, W> {
        let model = self.map.model();
        let first = from.instant;
        Member { model, entry: from, first, horizon: Some(horizon(&first, strobes)), watcher }
    }
}
