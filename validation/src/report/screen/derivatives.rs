//! The table of derivatives: how many of each engine's have which verdict.

use super::names::fit;
use crate::gradients::Verdict;
use crate::report::gradients::{GradientCounts, GradientEntry};
use crate::report::table::{one_line, text};
use comfy_table::{CellAlignment, Table, presets};

/// The most engines of the table; the others stand in report.json.
const MAX_ENGINES: usize = 8;

/// The longest name of an engine, in columns.
const MAX_NAME_COLUMNS: usize = 28;

/// The table of the first screen; no line where no engine answers derivatives.
pub(super) fn gradient_lines(rows: &[GradientEntry]) -> Vec<String> {
    let all = GradientCounts::all(rows);
    if all.is_empty() {
        return Vec::new();
    }
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).set_header([
        "derivatives",
        "right",
        "noisy",
        "limit",
        "zero",
        "term",
        "refused",
        "none",
        "first term",
    ]);
    for column in table.column_iter_mut().skip(1).take(Verdict::ALL.len()) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for it in all.iter().take(MAX_ENGINES) {
        let counts = it.counts.iter().map(ToString::to_string);
        let name = fit(it.engine, MAX_NAME_COLUMNS);
        table.add_row([name].into_iter().chain(counts).chain([it.missing.clone()]));
    }
    let more = all.len().saturating_sub(MAX_ENGINES);
    let more = (more > 0).then(|| format!("and {more} engines more: --out"));
    text(&table).lines().map(one_line).chain(more).collect()
}
