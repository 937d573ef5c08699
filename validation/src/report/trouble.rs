//! How each engine copes with each kind of difficulty, by the events of systems' cases.

use super::{Ranked, Report, ReportEvidence, ReportRow};
use crate::score::Verdict;

/// An engine's events on the cases of one kind of trouble.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TroubleCell {
    /// The engine's own events and those that it missed.
    pub judged: usize,
    /// The events that are those of the exact continuation, or at which either answer is right.
    pub right: usize,
    /// The engine's events that the exact continuation does not have.
    pub spurious: usize,
    /// Rows without a result, and rows that fail, expected failures included.
    pub failing: usize,
}

impl TroubleCell {
    fn add(&mut self, row: &ReportRow) {
        let records = &row.records;
        self.judged += records.events_judged.unwrap_or_default();
        self.right += records.events_right.unwrap_or_default();
        self.right += records.events_undecidable.unwrap_or_default();
        self.spurious += records.events_spurious.unwrap_or_default();
        let fails = matches!(row.verdict, Verdict::Error | Verdict::Fail | Verdict::Known);
        self.failing += usize::from(fails);
    }

    /// Right events in per cent of those that were judged, rounded down: 100 is all of them and
    /// none besides. Nothing where nothing was judged.
    pub fn percent(&self) -> Option<usize> {
        (self.judged > 0).then(|| 100 * self.right / self.judged)
    }
}

/// Kinds of trouble by engines, in the order of the ranking.
#[derive(Clone, Debug, Default)]
pub(super) struct Trouble {
    /// The engines with their places, which number the columns: ranks may be shared.
    pub engines: Vec<(&'static str, String)>,
    /// A kind of trouble, the number of its cases, and one cell per engine.
    pub lines: Vec<(String, usize, Vec<TroubleCell>)>,
}

impl Trouble {
    /// The matrix of a report; without lines where none of its cases is of a system.
    pub fn new(report: &Report, evidence: &ReportEvidence) -> Self {
        let mut kinds: Vec<&String> = evidence.cases.iter().flat_map(|it| &it.trouble).collect();
        kinds.sort();
        kinds.dedup();
        let engines =
            report.ranking.iter().zip(1..).map(|(it, place)| (it.engine, place.to_string()));
        let line = |kind: &String| {
            let cases = evidence.cases.iter().filter(|case| case.trouble.contains(kind));
            let cases: Vec<&str> = cases.map(|case| case.name.as_str()).collect();
            let cell = |it: &Ranked| {
                let mut cell = TroubleCell::default();
                let rows = report.results.iter().filter(|row| row.engine == it.engine);
                rows.filter(|row| cases.contains(&row.case.as_str())).for_each(|row| cell.add(row));
                cell
            };
            (kind.clone(), cases.len(), report.ranking.iter().map(cell).collect())
        };
        Self { engines: engines.collect(), lines: kinds.into_iter().map(line).collect() }
    }
}
