//! The attractors that are known so far, and the recognition of a motion that approaches one.

use super::Attractor;
use super::cells::{Cells, RECURRENCES};
use super::settle::Settled;
use super::trap::Trap;
use crate::dynamics::parallel;
use crate::dynamics::section::Section;
use crate::dynamics::strobe::{Point, StrobeMap};
use crate::entry::Entry;
use crate::leg::Endless;

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
/// So many turns in a row have to bring a motion in a trap closer.
const TURNS: u32 = 3;
/// A motion is at rest on an orbit when the square of its distance is so small a share of the
/// trap's radius: it need not come closer still.
const AT_REST: f64 = 1e-12;

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
        let first = |start: &Point| {
            let Ok(entry) = self.map.entry(*start) else { return Ok(Label::Unresolved) };
            let first = self.recognised_if_any(entry);
            seen(u64::from(first.is_ok()));
            first
        };
        let mut labels = Vec::with_capacity(starts.len());
        let mut open = Vec::new();
        for block in starts.chunks(BLOCK) {
            for outcome in parallel::map(block, first) {
                open.extend(outcome.err().map(|entry| (labels.len(), entry)));
                labels.push(outcome.unwrap_or(Label::Unresolved));
            }
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
                let again = parallel::map(&open, |(_, entry)| self.recognised_if_any(*entry));
                let mut still = Vec::new();
                for ((index, _), outcome) in open.into_iter().zip(again) {
                    match outcome {
                        Ok(label) => {
                            labels[index] = label;
                            seen(1);
                        }
                        Err(entry) => still.push((index, entry)),
                    }
                }
                open = still;
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

    fn recognised_if_any(&self, from: Entry) -> Result<Label, Entry> {
        if self.known.is_empty() { Err(from) } else { self.recognised(from, self.transient) }
    }

    /// Follows a motion until it is recognised, for at most so many strobes; where it is then if it
    /// is not.
    pub(super) fn recognised(&self, from: Entry, strobes: u64) -> Result<Label, Entry> {
        let mut section = Section::along(self.map.model().trajectory(from), from.instant);
        let mut watch = Watch::new(&self.known);
        let mut last = from;
        for n in 0..=strobes {
            let Some(strobe) = section.next() else { break };
            if escapes(&section) {
                return Ok(Label::Escaping);
            }
            if let Some(known) = watch.see(n, &strobe.point()) {
                return Ok(Label::Attractor(known));
            }
            last = strobe;
        }
        Err(last)
    }
}

/// Whether a motion is in a phase that never ends, other than rest on the slider, which is an orbit.
pub(super) fn escapes(section: &Section) -> bool {
    matches!(section.endless(), Some(Endless::NeverReturns | Endless::NeverStops))
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

/// What one motion has met of the known attractors.
pub(super) struct Watch<'a> {
    known: &'a [Known],
    /// Strobes in a row in the cells of each.
    streaks: Vec<u32>,
    entered: Option<Entered<'a>>,
}

/// A trap was entered; each turn of the orbit from there on has to bring the motion closer.
struct Entered<'a> {
    known: usize,
    trap: &'a Trap,
    due: u64,
    size: f64,
    turns: u32,
}

impl<'a> Watch<'a> {
    pub fn new(known: &'a [Known]) -> Self {
        Self { known, streaks: vec![0; known.len()], entered: None }
    }

    /// Takes the n-th strobe; which attractor it is known to lead to.
    pub fn see(&mut self, n: u64, point: &Point) -> Option<usize> {
        if let Some(entered) = &mut self.entered
            && entered.due == n
        {
            let size = entered.trap.size(point);
            let closer = size < entered.size || size < AT_REST;
            entered.turns += 1;
            if closer && entered.turns >= TURNS {
                return Some(entered.known);
            }
            (entered.size, entered.due) = (size, n + self.known[entered.known].period());
            if !closer {
                self.entered = None;
            }
        }
        if self.entered.is_none() {
            self.entered = self.enter(n, point);
        }
        for (known, streak) in self.streaks.iter_mut().enumerate() {
            if let Evidence::Cells(cells) = &self.known[known].evidence {
                *streak = if cells.hold(point) { *streak + 1 } else { 0 };
                if *streak >= RECURRENCES {
                    return Some(known);
                }
            }
        }
        None
    }

    fn enter(&self, n: u64, point: &Point) -> Option<Entered<'a>> {
        self.known.iter().enumerate().find_map(|(known, it)| {
            let Evidence::Traps(traps) = &it.evidence else { return None };
            let inside = |trap: &'a Trap| {
                let size = trap.size(point);
                (size <= 1.0).then(|| Entered { known, trap, due: n + it.period(), size, turns: 0 })
            };
            traps.iter().find_map(inside)
        })
    }
}
