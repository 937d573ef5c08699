//! A graze: a guard that turns just short of its threshold, or just beyond it.
//!
//! An engine whose allowed error at that instant is larger than the margin may find the events of
//! such a graze or not: either answer is right.

use super::occurrence::Occurrence;

/// A guard's extremum close to its threshold.
#[derive(Clone, Debug, PartialEq)]
pub struct Graze {
    /// Time of the extremum since the start.
    pub elapsed: f64,
    /// The guard there: how far it goes beyond its threshold, or (negative) stays short of it.
    pub margin: f64,
    /// Largest error of the guard there that one unit of error may have become.
    pub growth: f64,
    /// The truth's events that this graze makes: none where the guard stays short. Events of other
    /// guards that are only watched may lie between them.
    pub events: Vec<usize>,
    /// The mode in which the guard is looked at.
    pub mode: usize,
    /// The event that a crossing there would be; `None` in the oscillator, where any other phase
    /// that begins is one.
    pub event: Option<usize>,
    /// Whether a crossing at the graze ends the mode.
    pub ends: bool,
    /// The number of events that a touch makes: two where the mode is left and entered again.
    pub makes: usize,
}

impl Graze {
    /// Whether an engine that may err by `allowed` units need not tell on which side it lies.
    #[must_use]
    pub fn is_undecidable(&self, allowed: f64) -> bool {
        self.margin.abs() <= allowed * self.growth
    }

    /// Whether an event may be the first that a crossing there makes.
    pub(super) fn begins_with(&self, found: &Occurrence) -> bool {
        match self.event {
            Some(event) => found.event == event,
            None => found.mode != Some(self.mode),
        }
    }
}
