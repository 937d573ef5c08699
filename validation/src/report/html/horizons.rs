//! Valid horizons as the page shows them: a line a row that has them.

use super::super::{Report, ReportRow};

pub(super) struct HorizonLine {
    pub case: String,
    pub who: String,
    pub runs: usize,
    pub figures: [f64; 3],
}

pub(super) fn horizons(report: &Report) -> Vec<HorizonLine> {
    let line = |row: &ReportRow| {
        let it = row.valid_horizon?;
        Some(HorizonLine {
            case: row.case.clone(),
            who: row.who(),
            runs: it.runs,
            figures: [it.q01, it.median, it.predicted_median],
        })
    };
    report.results.iter().filter_map(line).collect()
}
