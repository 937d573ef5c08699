//! What a run has passed so far, and how it ended.

use percuss::affine::What;
use serde::Serialize;
use std::collections::VecDeque;

/// The number of `until` events in one instant that ends a run, and that are kept to name them.
pub(super) const AT_ONCE: usize = 64;

/// The events that a run has passed, as far as its end is told by them.
pub(super) struct Passed<T> {
    /// Their number, which is that of the last row.
    pub(super) count: usize,
    /// The last `until` events, each with the mode that it begins; the latest is the first.
    pub(super) recent: VecDeque<(What<T>, usize)>,
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

impl<T> Default for Passed<T> {
    fn default() -> Self {
        Self { count: 0, recent: VecDeque::new(), few_digits: false }
    }
}

impl<T> Passed<T> {
    /// Counts an event, and keeps an `until` with the mode that it begins.
    pub(super) fn add(&mut self, what: What<T>, mode: usize) {
        self.count += 1;
        if let What::Until(..) = what {
            self.recent.truncate(AT_ONCE - 1);
            self.recent.push_front((what, mode));
        }
    }
}
