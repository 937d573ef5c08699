//! What a run has passed so far, and how it ended.

use crate::cli::shared::no_progress::LastTurns;
use percuss::Kind;
use serde::Serialize;

/// The events that a run has passed, as far as its end is told by them.
#[derive(Default)]
pub(super) struct Passed {
    /// Their number, which is that of the last row.
    pub(super) count: usize,
    pub(super) last: LastTurns,
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
        self.last.add(kind, next);
    }
}
