//! The progress of a run, for a bar on stderr; the run does not depend on it.

use super::long_work::Bar;
use percuss::Instant;
use std::cell::Cell;

/// The number of phases or rows between two updates of the bar.
const PHASES_PER_UPDATE: u64 = 256;

/// A bar that is moved now and then.
pub(in crate::cli) struct Progress {
    bar: Option<Bar>,
    calls: Cell<u64>,
    omega: f64,
    start: Instant,
    span: f64,
}

impl Progress {
    /// Creates the progress of a run from `start` to `horizon`.
    pub(in crate::cli) fn new(
        bar: Option<Bar>,
        omega: f64,
        start: Instant,
        horizon: &Instant,
    ) -> Self {
        let span = horizon.since(&start, omega).value();
        Self { bar, calls: Cell::new(0), omega, start, span }
    }

    /// The run is at an instant.
    pub(in crate::cli) fn at(&self, instant: &Instant) {
        self.at_least(instant, 0.0);
    }

    /// The run is at an instant, or has done this share of what was wanted where that is more.
    pub(in crate::cli) fn at_least(&self, instant: &Instant, done: f64) {
        let Some(bar) = &self.bar else { return };
        let calls = self.calls.get();
        self.calls.set(calls + 1);
        if calls.is_multiple_of(PHASES_PER_UPDATE) {
            let share = instant.since(&self.start, self.omega).value() / self.span;
            bar.show_share(share.max(done).clamp(0.0, 1.0));
        }
    }
}
