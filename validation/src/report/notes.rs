//! What `validate --details` prints: rows that were not run, engines that are not
//! installed, orders, valid horizons, and the power of the gates.

use super::table::wrap;
use super::{FaultRow, Order, Report, ReportEvidence, ReportRow, orders};
use crate::engine::REFERENCE;
use crate::integration::NOT_THE_OSCILLATOR;
use crate::score::Verdict;
use std::collections::BTreeMap;

/// The notes, and an empty line where there are any.
pub(super) fn notes(report: &Report, evidence: &ReportEvidence) -> String {
    let parts = [
        not_run(&report.results),
        unavailable(&report.results),
        short_orders(report),
        valid_horizons(&report.results),
        not_caught(evidence),
    ];
    let notes = parts.concat();
    if notes.is_empty() { notes } else { notes + "\n" }
}

/// Rows that were not run, a paragraph for each reason with the engines from the most rows down.
fn not_run(rows: &[ReportRow]) -> String {
    let mut reasons: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for row in rows.iter().filter(|row| row.verdict == Verdict::NotRun) {
        let of_the_oscillator = row.why == NOT_THE_OSCILLATOR;
        let why = if of_the_oscillator {
            NOT_THE_OSCILLATOR
        } else {
            "beyond the budget of right-hand sides"
        };
        *reasons.entry(why).or_default().entry(row.engine).or_default() += 1;
    }
    let paragraph = |(why, engines): (&str, BTreeMap<&str, usize>)| {
        let total: usize = engines.values().sum();
        let mut engines: Vec<_> = engines.into_iter().collect();
        engines.sort_by_key(|it| std::cmp::Reverse(it.1));
        let engines: Vec<_> =
            engines.iter().map(|(engine, count)| format!("{engine} {count}")).collect();
        wrap(&format!("not run: {total} rows, {why}: {}", engines.join(", ")))
    };
    reasons.into_iter().map(paragraph).collect()
}

/// The number of rows that were not answered, with their engines, in one line: an engine is not
/// installed, or its files lack a case.
fn unavailable(rows: &[ReportRow]) -> String {
    let mut engines: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for row in rows.iter().filter(|row| row.verdict == Verdict::Unavailable) {
        engines.entry(row.engine).or_default().push(&row.why);
    }
    let total: usize = engines.values().map(Vec::len).sum();
    if total == 0 {
        return String::new();
    }
    let of_engine = |(engine, reasons): (&&str, &Vec<&str>)| {
        let first = reasons.first().copied().unwrap_or_default();
        let others = if reasons.iter().any(|it| *it != first) { ", and so on" } else { "" };
        format!("{engine} {} ({first}{others})", reasons.len())
    };
    let engines: Vec<_> = engines.iter().map(of_engine).collect();
    wrap(&format!("unavailable: {total} rows: {}", engines.join(", ")))
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
    let of_row = |row: &ReportRow| {
        let it = row.valid_horizon.filter(|_| row.engine.starts_with(REFERENCE))?;
        Some(format!(
            "{} on {}: median {} forcing periods over {} runs (1st percentile {}; predicted from \
             error growth: {})",
            row.engine, row.case, it.median, it.runs, it.q01, it.predicted_median
        ))
    };
    let horizons: Vec<_> = rows.iter().filter_map(of_row).collect();
    if horizons.is_empty() {
        return String::new();
    }
    wrap(&format!("valid horizon: {}", horizons.join("; ")))
}

/// How many of the engines that are wrong on purpose are caught; nothing where none was run.
pub(super) fn power(evidence: &ReportEvidence) -> Option<String> {
    let all = evidence.faults.len();
    let count = evidence.faults.iter().filter(|it| is_caught(it)).count();
    let said = format!("power: {count} of {all} engines that are wrong on purpose are caught");
    (all > 0).then_some(said)
}

/// The engines that are wrong on purpose and that no gate catches.
fn not_caught(evidence: &ReportEvidence) -> String {
    let missed = evidence.faults.iter().filter(|it| !is_caught(it));
    missed.map(|it| wrap(&format!("power: no gate catches {}: {}", it.engine, it.fault))).collect()
}

fn is_caught(it: &FaultRow) -> bool {
    it.gates.iter().any(|gate| gate.1)
}
