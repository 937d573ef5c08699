//! An engine at a setting over all cases of the report: recall, typical errors, typical cost.

use super::{Report, ReportRow};
use crate::score::{Spread, Verdict};
use serde::Serialize;

/// A typical figure stands beside those of other engines if at least nine tenths of its rows were
/// run: the rest hardly moves a median. What is over fewer is over other cases.
const MIN_ROWS_RATIO: (usize, usize) = (9, 10);

/// The figures of one engine over all cases.
#[derive(Clone, Debug, Default)]
pub(super) struct EngineSummary {
    /// How many rows came to each class, in the order of [`Verdict::ALL`].
    counts: [usize; 8],
    /// The settings from coarse to fine.
    pub settings: Vec<SettingSummary>,
}

/// The figures of one engine at one setting over all cases. A typical figure is the median over the
/// cases of the row's largest error; a run without a result counts as infinitely wrong, so that
/// failing on hard cases does not look like accuracy. So does, for the times of events, one of
/// several runs with a missed or a spurious event: what it found are the easier ones.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SettingSummary {
    pub setting: String,
    /// The number of rows, and of those that were run.
    pub rows: usize,
    pub runs: usize,
    /// Whether the figures may stand beside those of other engines: over most of the rows, or, of
    /// one row, over all events of the truth and no others.
    pub is_comparable: bool,
    /// The rows over which the figures are taken, in words.
    pub of: String,
    pub failed: usize,
    pub expected: usize,
    /// Events of the truth, scored or not.
    pub total: usize,
    pub matched: usize,
    pub spurious: usize,
    pub time_error: f64,
    pub state_error: f64,
    pub rhs: f64,
    pub ns: f64,
}

impl EngineSummary {
    /// How many rows came to a class.
    pub fn count(&self, verdict: Verdict) -> usize {
        Verdict::ALL.iter().position(|it| *it == verdict).map_or(0, |place| self.counts[place])
    }
}

impl SettingSummary {
    fn new(rows: &[&ReportRow]) -> Self {
        let ran: Vec<&ReportRow> = rows.iter().copied().filter(|row| row.was_run()).collect();
        // As in the ranking: what is not scored counts as not found.
        let scored = || ran.iter().filter(|row| row.verdict != Verdict::NotScored);
        let sum =
            |count: fn(&ReportRow) -> Option<usize>| scored().filter_map(|row| count(row)).sum();
        let error = |figure: fn(&ReportRow) -> f64, is_lost: fn(&ReportRow) -> bool| {
            let lost = |row: &ReportRow| row.status != "ok" || (rows.len() > 1 && is_lost(row));
            let of = |row: &&ReportRow| if lost(row) { f64::INFINITY } else { figure(row) };
            Spread::new(ran.iter().map(of).filter(|error| !error.is_nan()).collect()).median
        };
        let work = |figure: fn(&ReportRow) -> Option<u64>| {
            Spread::new(ran.iter().filter_map(|row| figure(row)).map(|work| work as f64).collect())
                .median
        };
        Self {
            setting: rows.first().map_or(String::new(), |row| row.setting()),
            rows: rows.len(),
            runs: ran.len(),
            is_comparable: is_comparable(rows, ran.len()),
            of: basis(rows, ran.len()),
            failed: ran.iter().filter(|row| row.status != "ok").count(),
            expected: sum(|row| row.events_expected),
            total: rows.iter().map(|row| row.events_total).sum(),
            matched: sum(|row| row.events_matched),
            spurious: sum(|row| row.records.events_spurious),
            time_error: error(|row| row.event_time_error.max, has_other_events),
            state_error: error(|row| row.state_error.max, |_| false),
            rhs: work(|row| row.rhs_evaluations),
            ns: work(|row| row.wall_ns),
        }
    }

    /// Whether the typical figures are over about the same cases as those of other engines.
    pub fn is_over_most_rows(&self) -> bool {
        are_most(self.runs, self.rows)
    }

    /// The share of the truth's events that the engine has; NaN where there was none to find.
    pub fn recall(&self) -> f64 {
        self.matched as f64 / self.expected as f64
    }
}

fn are_most(ran: usize, rows: usize) -> bool {
    let (most, of) = MIN_ROWS_RATIO;
    ran * of >= rows * most
}

/// Whether a run has other events than the truth where only one answer is right.
fn has_other_events(row: &ReportRow) -> bool {
    let some = |count: Option<usize>| count.is_some_and(|it| it > 0);
    row.verdict != Verdict::Undecidable
        && (some(row.records.events_missed) || some(row.records.events_spurious))
}

fn is_comparable(rows: &[&ReportRow], ran: usize) -> bool {
    match rows {
        [row] => row.is_of_all_events(),
        _ => are_most(ran, rows.len()),
    }
}

/// What figures are over: events of one row, or rows.
fn basis(rows: &[&ReportRow], ran: usize) -> String {
    let [row] = rows else { return format!("{ran} of {} rows", rows.len()) };
    let found = row.events_matched.unwrap_or_default();
    let spurious = match row.records.events_spurious {
        None | Some(0) => String::new(),
        Some(count) => format!(", {count} spurious"),
    };
    format!("{found} of {} events{spurious}", row.events_total)
}

/// The engines of a report, in its order.
pub(super) fn engines(report: &Report) -> Vec<EngineSummary> {
    report.engines.iter().map(|engine| one(report, engine.name)).collect()
}

fn one(report: &Report, engine: &str) -> EngineSummary {
    let mut rows: Vec<&ReportRow> =
        report.results.iter().filter(|row| row.engine == engine).collect();
    let counts = Verdict::ALL.map(|it| rows.iter().filter(|row| row.verdict == it).count());
    let fineness = |row: &ReportRow| row.tolerance.or(row.step).unwrap_or(0.0);
    rows.sort_by(|a, b| fineness(b).total_cmp(&fineness(a)));
    let same = |a: &&ReportRow, b: &&ReportRow| a.setting() == b.setting();
    EngineSummary { counts, settings: rows.chunk_by(same).map(SettingSummary::new).collect() }
}
