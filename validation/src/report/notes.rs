//! What `validate` prints above its ranking: rows that were not run, engines that are not
//! installed, orders, valid horizons, and the power of the gates.

use super::table::wrapped;
use super::{Order, Report, ReportEvidence, ReportRow, orders};
use crate::engine::REFERENCE;
use crate::integration::ELSEWHERE;
use crate::score::Verdict;
use std::collections::BTreeMap;

/// The notes, and an empty line where there are any.
pub(super) fn notes(report: &Report, evidence: &ReportEvidence) -> String {
    let parts = [
        not_run(&report.results),
        unavailable(&report.results),
        short_orders(report),
        valid_horizons(&report.results),
        power(evidence),
    ];
    let notes = parts.concat();
    if notes.is_empty() { notes } else { notes + "\n" }
}

/// Rows that were not run, a paragraph for each reason with the engines from the most rows down.
fn not_run(rows: &[ReportRow]) -> String {
    let mut reasons: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for row in rows.iter().filter(|row| row.verdict == Verdict::NotRun) {
        let of_the_oscillator = row.why == ELSEWHERE;
        let why =
            if of_the_oscillator { ELSEWHERE } else { "beyond the budget of right-hand sides" };
        *reasons.entry(why).or_default().entry(row.engine).or_default() += 1;
    }
    let paragraph = |(why, engines): (&str, BTreeMap<&str, usize>)| {
        let total: usize = engines.values().sum();
        let mut engines: Vec<_> = engines.into_iter().collect();
        engines.sort_by_key(|it| std::cmp::Reverse(it.1));
        let engines: Vec<_> =
            engines.iter().map(|(engine, count)| format!("{engine} {count}")).collect();
        wrapped(&format!("not run: {total} rows, {why}: {}", engines.join(", ")))
    };
    reasons.into_iter().map(paragraph).collect()
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
    wrapped(&format!("valid horizon: {}", horizons.join("; ")))
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
