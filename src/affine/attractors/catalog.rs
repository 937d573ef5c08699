//! The attractors that are known so far, and where starts lead.

use super::known::KnownAttractor;
use super::recognition::Recognizer;
use super::search::{AttractorSearch, Settled};
use super::space::{Space, Stop};
use crate::affine::run::place::Place;
use crate::dynamics::attractor::thresholds::{BLOCK, EXTENSIONS, LARGEST_BATCH};
use crate::dynamics::attractor::{Label, SearchLimits};
use crate::dynamics::parallel;

/// The attractors of a return map that have been met.
pub struct AttractorCatalog<'a> {
    pub space: Space<'a>,
    pub limits: SearchLimits,
    pub known: Vec<KnownAttractor>,
}

/// A start by its number, and where its motion is.
type Open = (usize, Place<f64>);

impl AttractorCatalog<'_> {
    /// The labels of many starts; attractors not met before are added. `seen` is told how many
    /// starts more are done.
    pub fn label_all(&mut self, starts: &[Place<f64>], seen: &(dyn Fn(u64) + Sync)) -> Vec<Label> {
        let mut labels = vec![Label::Unresolved; starts.len()];
        let mut open = Vec::new();
        for (block, from) in starts.chunks(BLOCK).zip((0..).step_by(BLOCK)) {
            let outcomes = parallel::map(block, |it| match self.space.map.solver().admits(it) {
                true => self.outcome(it, seen),
                false => {
                    seen(1);
                    Err(Label::Inadmissible)
                }
            });
            open.extend(still_open(from.., outcomes, &mut labels));
        }
        self.settle_all(open, &mut labels, seen);
        labels
    }

    /// Settles what is not recognised, a few at a time: each attractor found may explain the rest.
    fn settle_all(
        &mut self,
        mut open: Vec<Open>,
        labels: &mut [Label],
        seen: &(dyn Fn(u64) + Sync),
    ) {
        let mut batch = 1;
        while !open.is_empty() {
            let rest = open.split_off(batch.min(open.len()));
            let settled = parallel::map(&open, |(_, place)| self.settled(place));
            let before = self.known.len();
            for ((index, _), outcome) in open.iter().zip(settled) {
                labels[*index] = self.adopted(outcome);
            }
            seen(open.len() as u64);
            batch = (2 * batch).min(LARGEST_BATCH);
            open = rest;
            if self.known.len() > before {
                batch = 1;
                let outcomes = parallel::map(&open, |(_, from)| self.outcome(from, seen));
                open = still_open(open.iter().map(|(n, _)| *n), outcomes, labels);
            }
        }
    }

    fn search(&self) -> AttractorSearch<'_> {
        AttractorSearch { space: &self.space, known: &self.known, limits: self.limits }
    }

    /// The attractor on which a motion settles.
    fn settled(&self, from: &Place<f64>) -> Settled {
        let search = self.search();
        let mut from = from.clone();
        for extension in 0..=EXTENSIONS {
            match self.recognised(&from, self.limits.transient << extension) {
                Ok(last) => from = last,
                Err(stop) => return search.stopped(stop),
            }
            if let Some(settled) = search.identified(&from, extension == EXTENSIONS) {
                return settled;
            }
        }
        Settled::Label(Label::Unresolved)
    }

    /// The label of what was settled; an attractor not known before is added.
    fn adopted(&mut self, settled: Settled) -> Label {
        let new = match settled {
            Settled::Label(label) => return label,
            Settled::New(new) => *new,
        };
        // Another start of the same batch may have found it.
        let same = self.known.iter().position(|known| known.is(&self.space, &new));
        Label::Attractor(same.unwrap_or_else(|| {
            self.known.push(new);
            self.known.len() - 1
        }))
    }

    /// The label of a motion that is recognised within its transient, or where it is then. What
    /// rests at a new place is still open, and so is everything where nothing is known.
    fn outcome(&self, from: &Place<f64>, seen: &(dyn Fn(u64) + Sync)) -> Result<Place<f64>, Label> {
        if self.known.is_empty() {
            return Ok(from.clone());
        }
        let outcome = match self.recognised(from, self.limits.transient) {
            Ok(last) => Ok(last),
            Err(stop) => match self.search().stopped(stop) {
                Settled::Label(label) => Err(label),
                Settled::New(_) => Ok(from.clone()),
            },
        };
        seen(u64::from(outcome.is_err()));
        outcome
    }

    /// Follows a motion until it is recognised, for at most so many returns; where it is then if it
    /// is not.
    fn recognised(&self, from: &Place<f64>, returns: u64) -> Result<Place<f64>, Stop> {
        let mut recognizer = Recognizer::new(&self.space, &self.known);
        self.space
            .follow(from, returns, &mut |n, _, spot| recognizer.see(n, spot).map(Label::Attractor))
    }
}

/// Puts down the labels of the motions with these numbers; gives the others.
fn still_open(
    numbers: impl Iterator<Item = usize>,
    outcomes: Vec<Result<Place<f64>, Label>>,
    labels: &mut [Label],
) -> Vec<Open> {
    let mut open = Vec::new();
    for (n, outcome) in numbers.zip(outcomes) {
        match outcome {
            Ok(place) => open.push((n, place)),
            Err(label) => labels[n] = label,
        }
    }
    open
}
