//! The summary that `validate` prints: the ranking of integrators on events, and where each fails.
//!
//! A terminal shows the last lines, so the ranking and the failures stand there and the details
//! above them. Every line fits [`WIDTH`](super::WIDTH) columns.

use super::failing::failing_cases;
use super::notes::notes;
use super::ranking::COMPARED_AT;
use super::table::{reasons, row_table, text, wrapped};
use super::trouble::{Trouble, TroubleCell};
use super::{Report, ReportEvidence};
use crate::number::brief;
use crate::score::Verdict;
use comfy_table::{CellAlignment, Table, presets};

/// The screen; `with_rows`: every row stands above it.
#[must_use]
pub fn screen(report: &Report, evidence: &ReportEvidence, with_rows: bool) -> String {
    let rows = if with_rows { row_table(&report.results) + "\n" } else { String::new() };
    let parts = [
        rows,
        trouble_table(report, evidence),
        notes(report, evidence),
        ranking_table(report),
        failing_cases(report, evidence, with_rows),
        reasons(&report.results),
        worse(evidence),
        dearer(evidence),
        counts(report),
    ];
    parts.concat()
}

/// A plain table without borders, its columns from the third on to the right.
fn plain(header: &[&str], right_from: usize) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).set_header(header);
    for column in table.column_iter_mut().skip(right_from) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 1));
    }
    table
}

fn ranking_table(report: &Report) -> String {
    let header = [
        "#",
        "engine",
        "found/checked/all",
        "missed",
        "spurious",
        "median",
        "worst",
        "rhs",
        "fail",
    ];
    let mut table = plain(&header, 2);
    for it in &report.ranking {
        let units = it.event_time_error_units;
        table.add_row([
            if it.is_reference() { "-".to_owned() } else { it.rank.to_string() },
            it.engine.to_owned(),
            format!("{}/{}/{}", it.events_found, it.events_checked, it.events_total),
            it.events_missed.to_string(),
            it.events_spurious.to_string(),
            figure(units.median),
            figure(units.max),
            it.rhs_per_event.map_or("-".to_owned(), right_hand_sides),
            it.fails_on.len().to_string(),
        ]);
    }
    let legend = format!(
        "rank: (found - spurious) of all events, over all cases and settings; what was not run or not \
         scored counts as not found. median, worst: event-time error in units of tolerance x growth x \
         events so far (eps for exact, the step's own error for fixed steps). rhs: right-hand sides \
         per event at an error of {COMPARED_AT:e}, which decides between equals. fail: cases, of {}, \
         expected failures included; an event of a graze that a method's own error hides is \
         undecidable, no failure. exact is the reference.",
        report.number_of_cases()
    );
    text(&table) + &wrapped(&legend) + "\n"
}

/// Right-hand sides per event in at most four columns, which is what the widest line leaves.
fn right_hand_sides(cost: f64) -> String {
    if cost < 9999.5 { format!("{cost:.0}") } else { format!("{cost:.0e}") }
}

/// Kinds of trouble by engines, which stand under their ranks.
fn trouble_table(report: &Report, evidence: &ReportEvidence) -> String {
    let trouble = Trouble::of(report, evidence);
    if trouble.lines.is_empty() {
        return String::new();
    }
    let rank = |(name, rank): &(&str, usize)| match rank {
        0 => (*name).to_owned(),
        rank => rank.to_string(),
    };
    let ranks: Vec<String> = trouble.engines.iter().map(rank).collect();
    let mut header = vec!["trouble", "cases"];
    header.extend(ranks.iter().map(String::as_str));
    let mut table = plain(&header, 1);
    for (kind, cases, cells) in &trouble.lines {
        let cell = |cell: &TroubleCell| cell.percent().map_or("-".to_owned(), |it| it.to_string());
        let cells = cells.iter().map(cell);
        table.add_row([kind.clone(), cases.to_string()].into_iter().chain(cells));
    }
    let legend = "trouble: events found less spurious ones, in per cent of the scored events of the \
                  cases of each kind, rounded down; the columns are the engines by their ranks.";
    text(&table) + &wrapped(legend) + "\n"
}

pub(super) fn figure(value: f64) -> String {
    match value.abs() {
        size if size.is_nan() => "-".to_owned(),
        size if (0.01..1000.0).contains(&size) => format!("{value:.2}"),
        _ => brief(value),
    }
}

fn worse(evidence: &ReportEvidence) -> String {
    let lines = evidence.worse.iter();
    lines.map(|it| wrapped(&format!("worse than the baseline: {it}"))).collect()
}

fn dearer(evidence: &ReportEvidence) -> String {
    match evidence.dearer.as_slice() {
        [] => String::new(),
        rows => wrapped(&format!("right-hand sides beside the baseline: {}", rows.join("; "))),
    }
}

fn counts(report: &Report) -> String {
    let rows = report.results.len();
    let count = |it: Verdict| report.results.iter().filter(|row| row.verdict == it).count();
    let classes = Verdict::ALL.iter().rev();
    let classes: Vec<_> =
        classes.map(|class| format!("{} {}", count(*class), class.as_str())).collect();
    wrapped(&format!("{rows} rows: {}", classes.join(", ")))
}
