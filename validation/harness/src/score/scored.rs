//! What is judged, and what a judgement consists of: a run with its measures, the class of a row or
//! bound, and a bound with the figure it was held against.

use super::graze::Graze;
use super::measures::Measures;
use super::occurrence::Occurrence;
use crate::case::{Quantity, Statistic};
use crate::number::brief;
use serde::Serialize;

/// A run that has a result, with what tells whether its events are decidable.
#[derive(Clone, Copy)]
pub struct ScoredRun<'a> {
    /// The measures of the run.
    pub measures: &'a Measures,
    /// The truth's events.
    pub truth: &'a [Occurrence],
    /// The truth's grazes.
    pub grazes: &'a [Graze],
    /// Events further apart than this, in units of time, are not the same.
    pub window: f64,
}

/// The class of a row or of a bound, from the first that applies to the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The engine is not installed.
    Unavailable,
    /// The run was beyond the suite's budget.
    NotRun,
    /// The engine gave no result.
    Error,
    /// A bound failed.
    Fail,
    /// A bound failed, and the failure is expected of the engine.
    Known,
    /// Events of a graze differ that the method's bounds leave undecided.
    Undecidable,
    /// Too little could be measured at this setting to say anything.
    NotScored,
    /// Every bound that applies was measured and holds.
    Pass,
}

impl Verdict {
    /// All classes, in the order in which they apply.
    pub const ALL: [Self; 8] = [
        Self::Unavailable,
        Self::NotRun,
        Self::Error,
        Self::Fail,
        Self::Known,
        Self::Undecidable,
        Self::NotScored,
        Self::Pass,
    ];

    /// The class's word in every table, file and page.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Unavailable => "unavailable",
            Self::NotRun => "not-run",
            Self::Error => "error",
            Self::Fail => "fail",
            Self::Known => "known",
            Self::Undecidable => "undecidable",
            Self::NotScored => "not-scored",
            Self::Pass => "pass",
        }
    }
}

/// A bound with the figure it was held against.
#[derive(Clone, Debug, Serialize)]
pub struct Checked {
    /// The quantity that is bounded.
    pub quantity: Quantity,
    /// The statistic of the quantity that is bounded.
    pub statistic: Statistic,
    /// The limit.
    pub limit: f64,
    /// The measured figure, without the events that a graze excuses; NaN if nothing was measured.
    pub value: f64,
    /// The class of the bound: pass, undecidable, not-scored, fail, or known (expected failure).
    pub verdict: Verdict,
    /// The bound's reason.
    pub why: String,
}

impl Checked {
    /// The figure beside its limit, and why that is the limit.
    pub(super) fn reason(&self) -> String {
        let against = if self.quantity.is_to_be_large() { "at least" } else { "at most" };
        let quantity = self.quantity.words_of(self.statistic);
        format!("{quantity} {} ({against} {}: {})", brief(self.value), brief(self.limit), self.why)
    }
}
