//! The rows of a report as a table, and the reasons of those that are out of bounds.

use super::ReportRow;
use crate::number::brief;
use crate::score::Verdict;
use comfy_table::{CellAlignment, Table, presets};

/// The widest line, in columns.
pub const WIDTH: usize = 100;

/// Every row, one line each.
pub(super) fn row_table(rows: &[ReportRow]) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    table.set_header([
        "case",
        "engine",
        "tol",
        "scored",
        "events",
        "missed",
        "spurious",
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
    text(&table)
}

/// The reasons of rows without a result and of rows whose failure nothing excuses.
pub(super) fn reasons(rows: &[ReportRow]) -> String {
    let bad = |row: &&ReportRow| {
        matches!(row.verdict, Verdict::Fail | Verdict::Error | Verdict::Unavailable)
    };
    let line = |row: &ReportRow| {
        let (verdict, case, engine) = (row.verdict.as_str(), &row.case, row.engine);
        wrapped(&format!("{verdict}: {case} {engine} {}: {}", setting(row), row.why))
    };
    rows.iter().filter(bad).map(line).collect()
}

fn cells(case: &str, row: &ReportRow) -> [String; 12] {
    let count = |count: Option<usize>| count.map_or("-".to_owned(), |count| count.to_string());
    let figure = |value: f64| if value.is_nan() { "-".to_owned() } else { brief(value) };
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
        row.verdict.as_str().to_owned(),
    ]
}

/// The tolerance or step, a dash where there is none.
fn setting(row: &ReportRow) -> String {
    let setting = row.setting();
    if setting.is_empty() { "-".to_owned() } else { setting }
}

/// Breaks a text into lines of at most [`WIDTH`] columns, the later ones indented.
pub(super) fn wrapped(text: &str) -> String {
    let options = textwrap::Options::new(WIDTH)
        .subsequent_indent("    ")
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    textwrap::fill(text, options) + "\n"
}

/// A table's lines without the blanks at their ends.
pub(super) fn text(table: &Table) -> String {
    let lines: Vec<_> = table.to_string().lines().map(|line| line.trim_end().to_owned()).collect();
    lines.join("\n") + "\n"
}
