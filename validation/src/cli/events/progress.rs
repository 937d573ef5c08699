//! What a run has passed so far, and how it ended.

use percuss::Kind;
use serde::Serialize;
use std::collections::VecDeque;

/// The number of `until` events in one instant that ends a run, and that are kept to name them.
pub(super) const AT_ONCE: usize = 64;

/// An `until` of a mode by its index, with the mode that it begins.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Turned {
    pub(super) mode: usize,
    pub(super) until: usize,
    pub(super) next: usize,
}

/// The events that a run has passed, as far as its end is told by them.
#[derive(Default)]
pub(super) struct Passed {
    /// Their number, which is that of the last row.
    pub(super) count: usize,
    /// The last `until` events, the latest first.
    pub(super) recent: VecDeque<Turned>,
    /// Whether it was said that the time has few digits.
    pub(super) few_digits: bool,
}

/// The ending of a run.
#[derive(Default)]
pub(super) struct RunEnd {
    pub(super) accumulation: Option<Accumulation>,
    pub(super) notes: Vec<String>,
    pub(super) undecided: bool,
}

/// The two times between which infinitely many impacts accumulate.
#[derive(Serialize)]
pub(super) struct Accumulation {
    pub(super) earliest: String,
    pub(super) latest: String,
}

impl Passed {
    /// Counts an event, and keeps an `until` with the mode that it begins.
    pub(super) fn add(&mut self, kind: Kind, next: usize) {
        self.count += 1;
        if let Kind::Until(mode, until) = kind {
            self.recent.truncate(AT_ONCE - 1);
            self.recent.push_front(Turned { mode, until, next });
        }
    }
}
