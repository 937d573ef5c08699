//! The rows of a report as a table, and the reasons of those that are out of bounds.

use super::{JudgedRecords, ReportRow};
use crate::number::brief;
use crate::score::Verdict;
use comfy_table::{CellAlignment, Table, presets};

/// The widest line, in columns.
pub const WIDTH: usize = 100;
/// Lines of the header of the rows.
const HEADER_LINES: usize = 3;

/// Every row, one line each, below the name of its case.
pub(super) fn row_table(rows: &[ReportRow]) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    table.set_header([
        "\n\nengine",
        "\ntol,\nstep",
        "\nright/\njudged",
        "\nmis-\nsed",
        "spu-\nri-\nous",
        "\nbad\nmode",
        "\ntime\nerror",
        "\nstate\nerror",
        "\n\nrhs",
        "\n\nverdict",
    ]);
    for row in rows {
        table.add_row(cells(row));
    }
    for column in table.column_iter_mut().skip(1).take(8) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 1));
    }
    let text = text(&table);
    let mut lines = text.lines();
    let mut shown: Vec<&str> = lines.by_ref().take(HEADER_LINES).collect();
    let mut before = "";
    for (line, row) in lines.zip(rows) {
        if row.case != before {
            before = &row.case;
            shown.push(before);
        }
        shown.push(line);
    }
    shown.join("\n") + "\n"
}

/// The reasons of rows whose run gave no result and of rows whose failure nothing excuses.
pub(super) fn reasons(rows: &[ReportRow]) -> String {
    let bad = |row: &&ReportRow| matches!(row.verdict, Verdict::Fail | Verdict::Error);
    let line = |row: &ReportRow| {
        let (verdict, case, engine) = (row.verdict.as_str(), &row.case, row.engine);
        wrap(&format!("{verdict}: {case} {engine} {}: {}", setting(row), row.why))
    };
    rows.iter().filter(bad).map(line).collect()
}

fn cells(row: &ReportRow) -> [String; 10] {
    let count = |count: Option<usize>| count.map_or("-".to_owned(), |count| count.to_string());
    let figure = |value: f64| if value.is_nan() { "-".to_owned() } else { brief(value) };
    let JudgedRecords {
        events_judged,
        events_right,
        events_missed,
        events_spurious,
        events_wrong_mode,
        ..
    } = row.records;
    let right = events_right.zip(events_judged);
    [
        format!(" {}", row.engine),
        short_setting(row),
        right.map_or("-".to_owned(), |(right, judged)| format!("{right}/{judged}")),
        count(events_missed),
        count(events_spurious),
        count(events_wrong_mode),
        figure(row.event_time_error.max),
        figure(row.state_error.max),
        row.rhs_evaluations.map_or("-".to_owned(), |count| count.to_string()),
        row.verdict.as_str().to_owned(),
    ]
}

/// The tolerance or step, a dash where there is none.
pub(super) fn setting(row: &ReportRow) -> String {
    let setting = row.setting();
    if setting.is_empty() { "-".to_owned() } else { setting }
}

/// The tolerance, or the step as a fraction where it is one of few digits.
fn short_setting(row: &ReportRow) -> String {
    let inverse = row.step.map_or(f64::NAN, f64::recip);
    if inverse.fract() == 0.0 { format!("1/{inverse}") } else { setting(row) }
}

/// Breaks a text into lines of at most [`WIDTH`] columns, the later ones indented.
pub(super) fn wrap(text: &str) -> String {
    let options = textwrap::Options::new(WIDTH)
        .subsequent_indent("    ")
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    textwrap::fill(text, options) + "\n"
}

/// A text in one line of at most [`WIDTH`] columns, cut where it is longer.
pub(super) fn one_line(text: &str) -> String {
    let text = text.replace(char::is_control, " ");
    if text.chars().count() <= WIDTH {
        return text;
    }
    let kept: String = text.chars().take(WIDTH - 1).collect();
    format!("{}\u{2026}", kept.trim_end())
}

/// A table's lines without the blanks at their ends.
pub(super) fn text(table: &Table) -> String {
    let lines: Vec<_> = table.to_string().lines().map(|line| line.trim_end().to_owned()).collect();
    lines.join("\n") + "\n"
}
