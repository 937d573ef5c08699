//! The receiver of a run: of its rows, and of what is said of its ending.

use super::plan::PlannedRun;
use anyhow::Result;

/// An output for rows.
pub(super) trait Sink {
    fn begin(&mut self, plan: &PlannedRun<'_>) -> Result<()>;
    fn row(&mut self, plan: &PlannedRun<'_>, row: &Row<'_>) -> Result<()>;
    fn finish(&mut self, plan: &PlannedRun<'_>, end: &RunEnd) -> Result<()>;
}

/// A row of a run.
pub(super) struct Row<'a> {
    /// Counts the rows of events from 0.
    pub(super) n: u64,
    pub(super) time: f64,
    /// The name of the event, or of the run's ending; none at the start and of samples.
    pub(super) event: Option<&'a str>,
    pub(super) mode: usize,
    pub(super) state: &'a [f64],
}

/// The ending of a run, and what is said of it.
#[derive(Default)]
pub(super) struct RunEnd {
    /// The times between which infinitely many impacts accumulate.
    pub(super) accumulation: Option<[f64; 2]>,
    /// The number of choices that rounding left open.
    pub(super) undecidable: u64,
    pub(super) notes: Vec<String>,
    pub(super) undecided: bool,
}
