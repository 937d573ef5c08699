//! Whether so much was not answered, or not scored, that the rest says little.

use super::{Report, ReportRow};
use crate::score::Verdict;

/// Rows of which most were not answered or not scored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unanswered {
    /// The rows without an answer, or with one that holds nothing to judge.
    pub rows: usize,
    /// The rows that were asked: not those of engines that are not installed, nor what was left
    /// out beforehand.
    pub asked: usize,
}

impl Report {
    /// The rows without an answer or a score, if they are more than half of those that were asked.
    #[must_use]
    pub fn unanswered(&self) -> Option<Unanswered> {
        let asked = self.results.iter().filter(|row| row.was_run());
        let lacks = |row: &&ReportRow| row.status == "failed" || row.verdict == Verdict::NotScored;
        let found = Unanswered { rows: asked.clone().filter(lacks).count(), asked: asked.count() };
        (2 * found.rows > found.asked).then_some(found)
    }
}

impl Unanswered {
    /// What it comes to, in a sentence of one line.
    #[must_use]
    pub fn sentence(&self) -> String {
        let Self { rows, asked } = self;
        format!("{rows} of the {asked} rows that were asked are unanswered or not scored")
    }
}
