//! The first screen of `validate`: which integrator can be trusted with events, and where each
//! fails.
//!
//! Every line fits [`WIDTH`](super::WIDTH) columns.

use super::ranking::{COMPARED_AT, Ranked};
use super::table::{reasons, row_table, text, wrapped};
use super::trouble::{Trouble, TroubleCell};
use super::{Order, Report, ReportEvidence, ReportRow, orders};
use crate::engine::REFERENCE;
use crate::number::brief;
use crate::score::Verdict;
use crate::suite::ELSEWHERE;
use comfy_table::{CellAlignment, Table, presets};
use std::collections::BTreeMap;

/// The screen; `with_rows`: every row stands above it.
#[must_use]
pub fn screen(report: &Report, evidence: &ReportEvidence, with_rows: bool) -> String {
    let rows = if with_rows { row_table(&report.results) + "\n" } else { String::new() };
    let parts = [
        rows,
        ranking_table(&report.ranking),
        trouble_table(report, evidence),
        failing_cases(report),
        reasons(&report.results),
        not_run(&report.results),
        unavailable(&report.results),
        short_orders(report),
        valid_horizons(&report.results),
        power(evidence),
        worse(evidence),
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

fn ranking_table(ranking: &[Ranked]) -> String {
    let header =
        ["#", "engine", "found/checked/all", "missed", "spurious", "median", "worst", "rhs"];
    let mut table = plain(&header, 2);
    for it in ranking {
        let units = it.event_time_error_units;
        table.add_row([
            if it.is_reference() { "-".to_owned() } else { it.rank.to_string() },
            it.engine.to_owned(),
            format!("{}/{}/{}", it.events_found, it.events_checked, it.events_total),
            it.events_missed.to_string(),
            it.events_spurious.to_string(),
            figure(units.median),
            figure(units.max),
            it.rhs_per_event.map_or("-".to_owned(), |cost| format!("{cost:.0}")),
        ]);
    }
    let legend = format!(
        "rank: (found - spurious) of all events, over all cases and settings; what was not run or not \
         scored counts as not found. median, worst: error of event times in units of tolerance x \
         growth x events so far (eps for exact, the step's own error for fixed steps). rhs: right-hand \
         sides per event at an event-time error of {COMPARED_AT:e}, which decides between equals. \
         Missed or spurious events of a graze that a method's own error hides are undecidable, which \
         is no failure. exact is the reference; `percuss engines` says what each engine is."
    );
    text(&table) + &wrapped(&legend) + "\n"
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

/// The cases on which each engine fails, with expected failures told apart.
fn failing_cases(report: &Report) -> String {
    let line = |it: &Ranked| {
        if it.fails_on.is_empty() {
            return None;
        }
        let case = |case: &String| {
            let own = |row: &&ReportRow| row.engine == it.engine && row.case == *case;
            let unexpected =
                |row: &ReportRow| matches!(row.verdict, Verdict::Fail | Verdict::Error);
            let fails = report.results.iter().filter(own).any(unexpected);
            if fails { format!("{case}!") } else { case.clone() }
        };
        let cases: Vec<_> = it.fails_on.iter().map(case).collect();
        let (count, all) = (cases.len(), number_of_cases(report));
        Some(wrapped(&format!("  {}: {count} of {all}: {}", it.engine, cases.join(", "))))
    };
    let lines: String = report.ranking.iter().filter_map(line).collect();
    if lines.is_empty() {
        return "no engine fails on any case\n\n".to_owned();
    }
    format!("fails on (known shortcomings; ! is a failure that nothing excuses):\n{lines}\n")
}

fn number_of_cases(report: &Report) -> usize {
    report.results.chunk_by(|a, b| a.case == b.case).count()
}

fn not_run(rows: &[ReportRow]) -> String {
    let mut counts: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for row in rows.iter().filter(|row| row.verdict == Verdict::NotRun) {
        let of_the_oscillator = row.why == ELSEWHERE;
        let why =
            if of_the_oscillator { ELSEWHERE } else { "beyond the budget of right-hand sides" };
        *counts.entry((row.engine, why)).or_default() += 1;
    }
    let line = |((engine, why), count): ((&str, &str), usize)| {
        format!("not run: {engine}, {count} rows, {why}\n")
    };
    counts.into_iter().map(line).collect()
}

/// The engines that are not installed, in one line.
fn unavailable(rows: &[ReportRow]) -> String {
    let missing = rows.iter().filter(|row| row.verdict == Verdict::Unavailable);
    let missing: BTreeMap<&str, &str> = missing.map(|row| (row.engine, row.why.as_str())).collect();
    if missing.is_empty() {
        return String::new();
    }
    let named: Vec<_> = missing.iter().map(|(engine, why)| format!("{engine} ({why})")).collect();
    wrapped(&format!("unavailable: {}", named.join(", ")))
}

fn short_orders(report: &Report) -> String {
    let line = |order: &Order| {
        let Order { engine, claimed, found, cases } = order;
        format!(
            "order: {engine} converges at {found:.1}, claims {claimed} (median over {cases} cases)\n"
        )
    };
    orders(&report.engines, &report.results)
        .iter()
        .filter(|order| order.falls_short())
        .map(line)
        .collect()
}

/// How long the exact solver stays right in chaos; the report has the integrators' horizons too.
fn valid_horizons(rows: &[ReportRow]) -> String {
    let line = |row: &ReportRow| {
        let it = row.valid_horizon.filter(|_| row.engine.starts_with(REFERENCE))?;
        Some(wrapped(&format!(
            "valid horizon: {} on {}: median {} forcing periods over {} runs (1st percentile {}; \
             predicted from error growth: {})",
            row.engine, row.case, it.median, it.runs, it.q01, it.predicted_median
        )))
    };
    rows.iter().filter_map(line).collect()
}

fn power(evidence: &ReportEvidence) -> String {
    let Some(_) = evidence.faults.first() else { return String::new() };
    let caught = |it: &&super::FaultRow| it.gates.iter().any(|gate| gate.1);
    let missed = evidence.faults.iter().filter(|it| !caught(it));
    let missed: String = missed
        .map(|it| wrapped(&format!("power: no gate catches {}: {}", it.engine, it.fault)))
        .collect();
    let (count, all) = (evidence.faults.iter().filter(caught).count(), evidence.faults.len());
    format!("power: {count} of {all} engines that are wrong on purpose are caught\n{missed}")
}

fn worse(evidence: &ReportEvidence) -> String {
    let lines = evidence.worse.iter();
    lines.map(|it| wrapped(&format!("worse than the baseline: {it}"))).collect()
}

fn counts(report: &Report) -> String {
    let rows = report.results.len();
    let count = |it: Verdict| report.results.iter().filter(|row| row.verdict == it).count();
    let classes = Verdict::ALL.iter().rev();
    let classes: Vec<_> =
        classes.map(|class| format!("{} {}", count(*class), class.as_str())).collect();
    wrapped(&format!("{rows} rows: {}", classes.join(", ")))
}
