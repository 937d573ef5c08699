//! The attractors that are known so far, and where starts lead.

use super::coordinates::Coordinates;
use super::known::{KnownAttractor, Label};
use super::limits::SearchLimits;
use super::motions::{Motions, StopOf};
use super::search::{AttractorSearch, Settled};
use super::thresholds::{BLOCK_STARTS, EXTENSIONS, MAX_BATCH_STARTS};
use crate::dynamics::parallel;

/// The attractors of a return map that have been met, in the order in which they were.
#[derive(Clone, Debug)]
pub(crate) struct Catalog<M: Motions> {
    pub motions: M,
    pub limits: SearchLimits,
    pub known: Vec<KnownAttractor<M::Coordinates>>,
}

/// A start by its number, and where its motion is.
type Open<M> = (usize, <M as Motions>::Place);

impl<M: Motions> Catalog<M> {
    /// A catalog that has no attractor yet.
    pub fn new(motions: M, limits: SearchLimits) -> Self {
        Self { motions, limits: limits.clamped(), known: Vec::new() }
    }

    /// The label of a start, as far as the attractors met so far tell.
    pub fn label(&self, start: &M::Start) -> Label {
        let mut from = match self.motions.begin(start) {
            Ok(place) => place,
            Err(label) => return label,
        };
        for extension in 0..=EXTENSIONS {
            match self.recognise(&from, extension) {
                Ok(last) => from = last,
                Err(stop) => return self.label_of(stop).unwrap_or(Label::Unresolved),
            }
        }
        Label::Unresolved
    }

    /// The labels of many starts; attractors not met before are added. `seen` is told how many
    /// starts more are done.
    pub fn label_all(&mut self, starts: &[M::Start], seen: &(dyn Fn(u64) + Sync)) -> Vec<Label> {
        let mut labels = vec![Label::Unresolved; starts.len()];
        let mut open = Vec::new();
        for (block, first) in starts.chunks(BLOCK_STARTS).zip((0..).step_by(BLOCK_STARTS)) {
            let mut begun = Vec::new();
            let places = parallel::map(block, |start| self.motions.begin(start));
            for (n, place) in (first..).zip(places) {
                match place {
                    Ok(place) => begun.push((n, place)),
                    Err(label) => labels[n] = label,
                }
            }
            seen((block.len() - begun.len()) as u64);
            open.extend(self.still_open(begun, &mut labels, seen));
        }
        self.settle_all(open, &mut labels, seen);
        labels
    }

    /// Settles what is not recognised, a few at a time: each attractor found may explain the rest.
    fn settle_all(
        &mut self,
        mut open: Vec<Open<M>>,
        labels: &mut [Label],
        seen: &(dyn Fn(u64) + Sync),
    ) {
        let mut batch = 1;
        while !open.is_empty() {
            let rest = open.split_off(batch.min(open.len()));
            let settled = parallel::map(&open, |(_, place)| {
                seen(0);
                self.settle(place)
            });
            let before = self.known.len();
            for ((index, _), outcome) in open.iter().zip(settled) {
                labels[*index] = self.adopt(outcome);
            }
            seen(open.len() as u64);
            batch = (2 * batch).min(MAX_BATCH_STARTS);
            open = rest;
            if self.known.len() > before {
                batch = 1;
                open = self.still_open(open, labels, seen);
            }
        }
    }

    /// The attractor on which a motion settles.
    fn settle(&self, from: &M::Place) -> Settled<M::Coordinates> {
        let Self { motions, known, limits } = self;
        let search = AttractorSearch { motions, known, limits: *limits };
        let mut from = from.clone();
        for extension in 0..=EXTENSIONS {
            match self.recognise(&from, extension) {
                Ok(last) => from = last,
                Err(stop) => return search.outcome_of_stop(stop),
            }
            if let Some(settled) = search.identify(&from, extension == EXTENSIONS) {
                return settled;
            }
        }
        Settled::Label(Label::Unresolved)
    }

    /// The label of what was settled; an attractor not known before is added.
    fn adopt(&mut self, settled: Settled<M::Coordinates>) -> Label {
        let new = match settled {
            Settled::Label(label) => return label,
            Settled::New(new) => *new,
        };
        Label::Attractor(place_of(self.motions.coordinates(), &mut self.known, new))
    }

    /// Labels the motions that are recognised, if anything is known; the others, where they are
    /// then. What rests at a new place is still open, where it was.
    fn still_open(
        &self,
        motions: Vec<Open<M>>,
        labels: &mut [Label],
        seen: &(dyn Fn(u64) + Sync),
    ) -> Vec<Open<M>> {
        if self.known.is_empty() {
            return motions;
        }
        let from: Vec<&M::Place> = motions.iter().map(|(_, place)| place).collect();
        let transient = self.limits.transient;
        let outcomes = self.motions.recognised_all(&self.known, &from, transient, seen);
        let mut open = Vec::new();
        for ((n, from), outcome) in motions.into_iter().zip(outcomes) {
            match outcome.map_err(|stop| self.label_of(stop)) {
                Ok(last) => open.push((n, last)),
                Err(Some(label)) => labels[n] = label,
                Err(None) => open.push((n, from)),
            }
        }
        open
    }

    /// The label of a motion that does not go on; none where it rests at a new place.
    fn label_of(&self, stop: StopOf<M>) -> Option<Label> {
        stop.label(self.motions.coordinates(), &self.known)
    }

    /// Follows a motion until it is recognised, for its transient or an extension of that; where it
    /// is then if it is not.
    fn recognise(&self, from: &M::Place, extension: u32) -> Result<M::Place, StopOf<M>> {
        self.motions.recognise(&self.known, from, self.limits.transient << extension)
    }
}

/// The place of an attractor among those that are known, which it joins if it is new.
pub(crate) fn place_of<C: Coordinates>(
    coordinates: &C,
    known: &mut Vec<KnownAttractor<C>>,
    new: KnownAttractor<C>,
) -> usize {
    // Another start of the same batch, or of another block, may have found it.
    let same = known.iter().position(|it| it.is(coordinates, &new));
    same.unwrap_or_else(|| {
        known.push(new);
        known.len() - 1
    })
}
