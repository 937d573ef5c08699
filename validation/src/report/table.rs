//! The table for people.

use super::csv::word;
use super::{Report, Row};
use crate::number::brief;
use crate::score::Verdict;
use comfy_table::{CellAlignment, Table, presets};

/// The rows as a table, the failing ones with their reasons below, and the summary.
#[must_use]
pub fn table(report: &Report) -> String {
    let mut text = rows(&report.results);
    for row in report.results.iter().filter(|row| !matches!(row.verdict, Verdict::Pass)) {
        text.push_str(&format!(
            "{}: {} {} {}: {}\n",
            word(row.verdict),
            row.case,
            row.engine,
            setting(row),
            row.why
        ));
    }
    let summary = &report.summary;
    let expected = report.results.iter().filter(|row| row.expected).count();
    text.push_str(&format!(
        "{} pass ({expected} of them as known shortcomings have it), {} fail, {} error, {} unavailable\n",
        summary.pass, summary.fail, summary.error, summary.unavailable
    ));
    text
}

fn rows(rows: &[Row]) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    table.set_header([
        "case",
        "engine",
        "tol",
        "scored",
        "switches",
        "missed",
        "invented",
        "time err",
        "state err",
        "drift err",
        "rhs",
        "verdict",
    ]);
    let mut before = "";
    for row in rows {
        let case = if row.case == before { "" } else { &row.case };
        before = &row.case;
        table.add_row(cells(case, row));
    }
    for column in table.column_iter_mut().skip(2).take(9) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 2));
    }
    let lines: Vec<_> = table.to_string().lines().map(|line| line.trim_end().to_owned()).collect();
    lines.join("\n") + "\n"
}

fn cells(case: &str, row: &Row) -> [String; 12] {
    let count = |count: Option<usize>| count.map_or("-".to_owned(), |count| count.to_string());
    let figure = |value: f64| if value.is_nan() { "-".to_owned() } else { brief(value) };
    let verdict = if row.expected { "known" } else { word(row.verdict) };
    [
        case.to_owned(),
        row.engine.to_owned(),
        setting(row),
        if row.horizon_periods.is_nan() {
            "-".to_owned()
        } else {
            format!("{:.1}", row.horizon_periods)
        },
        count(row.events_expected),
        count(row.events_missed),
        count(row.events_spurious),
        figure(row.event_time_error.max),
        figure(row.state_error.max),
        figure(row.drift_error),
        row.rhs_evaluations.map_or("-".to_owned(), |count| count.to_string()),
        verdict.to_owned(),
    ]
}

fn setting(row: &Row) -> String {
    match (row.tolerance, row.step) {
        (Some(tolerance), _) => format!("{tolerance:e}"),
        (_, Some(step)) => format!("h {step}"),
        _ => "-".to_owned(),
    }
}
