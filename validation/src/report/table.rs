//! The table for people.

use super::csv::word;
use super::{Evidence, Order, Report, Row, orders};
use crate::number::brief;
use crate::score::Verdict;
use comfy_table::{CellAlignment, Table, presets};
use std::collections::BTreeMap;

/// The rows as a table, the failing ones with their reasons below, what the rows say together, and the
/// summary.
#[must_use]
pub fn table(report: &Report, evidence: &Evidence) -> String {
    let mut text = rows(&report.results);
    for row in report.results.iter().filter(|row| is_to_be_explained(row)) {
        text.push_str(&format!(
            "{}: {} {} {}: {}\n",
            word(row.verdict),
            row.case,
            row.engine,
            setting(row),
            row.why
        ));
    }
    text.push_str(&not_run(&report.results));
    for order in orders(&report.results).iter().filter(|order| order.falls_short()) {
        let Order { engine, claimed, found, cases } = order;
        text.push_str(&format!(
            "order: {engine} converges at {found:.1}, claims {claimed} (median over {cases} cases)\n"
        ));
    }
    text.push_str(&valid_horizons(&report.results));
    if !evidence.faults.is_empty() {
        let caught = evidence.faults.iter().filter(|it| it.gates.iter().any(|gate| gate.1));
        let (caught, all) = (caught.count(), evidence.faults.len());
        text.push_str(&format!("power: {caught} of {all} wrong engines are caught\n"));
    }
    let summary = &report.summary;
    let expected = report.results.iter().filter(|row| row.expected).count();
    text.push_str(&format!(
        "{} pass ({expected} of them as known shortcomings have it), {} fail, {} error, {} unavailable\n",
        summary.pass, summary.fail, summary.error, summary.unavailable
    ));
    text
}

/// How long the exact solver stays right in chaos; the report has the integrators' horizons too.
fn valid_horizons(rows: &[Row]) -> String {
    let line = |row: &Row| {
        let it = row.valid_horizon.filter(|_| row.engine.starts_with("exact"))?;
        let (median, q01, predicted) = (it.median, it.q01, it.predicted_median);
        Some(format!(
            "valid horizon: {} on {} stays right for {median} periods (median of {} runs, 99 % for {q01}; \
             its growth predicts {predicted})\n",
            row.engine, row.case, it.runs
        ))
    };
    rows.iter().filter_map(line).collect()
}

/// Rows that the budget left out are told together.
fn is_to_be_explained(row: &Row) -> bool {
    !matches!(row.verdict, Verdict::Pass) && !is_not_run(row)
}

fn is_not_run(row: &Row) -> bool {
    row.verdict == Verdict::Unavailable && row.why.starts_with("not run")
}

fn not_run(rows: &[Row]) -> String {
    let mut counts: BTreeMap<(&str, String), usize> = BTreeMap::new();
    for row in rows.iter().filter(|row| is_not_run(row)) {
        *counts.entry((row.engine, setting(row))).or_default() += 1;
    }
    let line = |((engine, setting), count): ((&str, String), usize)| {
        format!(
            "not run: {engine} {setting} on {count} cases, beyond the budget of right-hand sides\n"
        )
    };
    counts.into_iter().map(line).collect()
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

/// The tolerance or step, a dash where there is none.
fn setting(row: &Row) -> String {
    let setting = row.setting();
    if setting.is_empty() { "-".to_owned() } else { setting }
}
