//! The receiver of a run: of its rows, and of what is said of its ending.

use super::plan::PlannedRun;
use crate::cli::shared::run_arrays::Arrays;
use anyhow::Result;

/// An output for rows.
pub(super) trait Sink {
    fn begin(&mut self, plan: &PlannedRun<'_>) -> Result<()>;
    /// Takes a state from which the motion is smooth up to the next, with a row of its own or not.
    fn stop(&mut self, _: &Row<'_>) -> Result<()> {
        Ok(())
    }
    fn row(&mut self, plan: &PlannedRun<'_>, row: &Row<'_>) -> Result<()>;
    fn finish(&mut self, plan: &PlannedRun<'_>, end: &RunEnd) -> Result<()>;
}

/// Several outputs of one run.
pub(super) struct All<'a>(pub(super) Vec<Box<dyn Sink + 'a>>);

impl Sink for All<'_> {
    fn begin(&mut self, plan: &PlannedRun<'_>) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.begin(plan))
    }

    fn stop(&mut self, stop: &Row<'_>) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.stop(stop))
    }

    fn row(&mut self, plan: &PlannedRun<'_>, row: &Row<'_>) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.row(plan, row))
    }

    fn finish(&mut self, plan: &PlannedRun<'_>, end: &RunEnd) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.finish(plan, end))
    }
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

impl Sink for Arrays<'_> {
    fn begin(&mut self, _: &PlannedRun<'_>) -> Result<()> {
        Ok(())
    }

    fn row(&mut self, _: &PlannedRun<'_>, row: &Row<'_>) -> Result<()> {
        Self::row(self, row.time, row.mode, row.event, row.state)
    }

    fn finish(&mut self, _: &PlannedRun<'_>, _: &RunEnd) -> Result<()> {
        Self::finish(self)
    }
}
