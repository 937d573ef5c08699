//! The engines in order: which one gets the most cases wholly right.
//!
//! An engine without an unexpected failure is better than one with. Of equals in that, one is
//! better than another where a paired bootstrap over the cases tells their shares of right cases
//! apart; an engine's rank is one more than the number of engines that are better. Cost decides
//! nothing and is shown beside. Exact engines stand above, as the reference.

mod bootstrap;
mod cost;
mod counts;
mod formats;
mod groups;
mod place;

pub(super) use bootstrap::{Bootstrap, is_ahead};
pub(super) use cost::Common;
pub use cost::Cost;
pub use counts::SettingCounts;
pub(super) use counts::settings;
pub use formats::{RankingFormat, ranking_text};
pub(super) use groups::{EngineRows, by_engine, case_names, scores};

use super::ReportRow;
use super::records::finite;
use crate::score::{Spread, Verdict};
use counts::{defect_units, of_settings, sum};
use place::{Entry, place};
use serde::Serialize;

/// An engine's place in the ranking.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Ranked {
    /// The engine.
    pub engine: &'static str,
    /// One more than the number of better integrators; 0 for the exact reference, and none for an
    /// engine that is not installed.
    pub rank: Option<usize>,
    /// Whether no row fails or errs unexpectedly.
    pub clean: bool,
    /// The cases that are wholly right, for each setting.
    pub cases_right: SettingCounts,
    /// The cases that were asked, run or not, for each setting.
    pub cases_total: SettingCounts,
    /// The rows of stiff cases, over all settings.
    pub stiff: RightRows,
    /// The engine's own events and those that it missed.
    pub events_judged: usize,
    /// Events that are those of the exact continuation.
    pub events_right: usize,
    /// Events of the exact continuations that the engine does not have.
    pub events_missed: usize,
    /// Events of the engine that the exact continuations do not have.
    pub events_spurious: usize,
    /// Events that are followed by another mode.
    pub events_wrong_mode: usize,
    /// Cases with a row that fails or errs, expected failures included.
    pub fails_on: Vec<String>,
    /// The largest defect of each row, in units of the local judgement.
    pub defect_units: DefectUnits,
    /// The cost beside that of the other engines.
    pub cost: Cost,
}

/// How many rows of some cases are wholly right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RightRows {
    /// The rows that are wholly right.
    pub cases_right: usize,
    /// The rows that were asked, run or not.
    pub cases_total: usize,
}

/// The largest defects of rows: one long row counts no more than a short one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct DefectUnits {
    /// The median over the rows.
    pub median: Option<f64>,
    /// The 99th percentile over the rows.
    pub q99: Option<f64>,
}

impl Ranked {
    /// Right rows as a share of all.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.cases_right.total() as f64 / self.cases_total.total().max(1) as f64
    }

    /// Whether it is the exact reference, which stands above the ranks.
    #[must_use]
    pub fn is_reference(&self) -> bool {
        self.rank == Some(0)
    }

    /// The rank as tables show it: nothing for those that have none.
    #[must_use]
    pub fn shown_rank(&self) -> Option<usize> {
        self.rank.filter(|rank| *rank > 0)
    }

    /// Missed and spurious events, and those in a wrong mode.
    #[must_use]
    pub const fn wrong_events(&self) -> usize {
        self.events_missed + self.events_spurious + self.events_wrong_mode
    }
}

/// Ranks the engines of a report's rows.
#[must_use]
pub fn ranking(rows: &[ReportRow]) -> Vec<Ranked> {
    let engines = by_engine(rows);
    let cases = case_names(rows);
    let bootstrap = Bootstrap::new(cases.len());
    let common = Common::new(&engines);
    let costs = common.profiles(&engines);
    let entry = |(it, cost): (&EngineRows<'_>, Cost)| Entry {
        ranked: Ranked { cost, ..figures(it) },
        means: bootstrap.means(&scores(&cases, it.rows.iter().copied())),
        is_exact: it.is_exact(),
        is_absent: it.is_absent(),
    };
    place(engines.iter().zip(costs).map(entry).collect())
}

/// An engine's own figures, without its place and its cost.
fn figures(it: &EngineRows<'_>) -> Ranked {
    let rows = &it.rows;
    // What is not installed was asked nothing.
    let asked: &[&ReportRow] = if it.is_absent() { &[] } else { rows };
    Ranked {
        engine: it.engine,
        rank: None,
        clean: !rows.iter().any(|row| row.is_unexpected()),
        cases_right: of_settings(asked, ReportRow::is_right),
        cases_total: of_settings(asked, |_| true),
        stiff: stiff(asked),
        events_judged: sum(rows, |it| it.events_judged),
        events_right: sum(rows, |it| it.events_right),
        events_missed: sum(rows, |it| it.events_missed),
        events_spurious: sum(rows, |it| it.events_spurious),
        events_wrong_mode: sum(rows, |it| it.events_wrong_mode),
        fails_on: fails_on(rows),
        defect_units: defect_units(rows),
        cost: Cost::default(),
    }
}

/// How many of the rows of stiff cases are right.
fn stiff(asked: &[&ReportRow]) -> RightRows {
    let stiff = asked.iter().filter(|row| row.traits.is_stiff);
    RightRows {
        cases_right: stiff.clone().filter(|row| row.is_right()).count(),
        cases_total: stiff.count(),
    }
}

/// The cases with a row that fails or errs, expected failures included.
fn fails_on(rows: &[&ReportRow]) -> Vec<String> {
    let fails = |row: &&&ReportRow| row.is_unexpected() || row.verdict == Verdict::Known;
    let mut cases: Vec<String> = rows.iter().filter(fails).map(|row| row.case.clone()).collect();
    cases.dedup();
    cases
}

/// The median of some figures; none where there are none, or where it is infinite.
fn median(figures: Vec<f64>) -> Option<f64> {
    finite(Spread::new(figures).median)
}

#[cfg(test)]
mod tests;
