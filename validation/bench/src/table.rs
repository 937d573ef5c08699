//! The tables that `bench` prints.

use super::competitor::times;
use super::report::{Bench, BenchRow};
use super::summary::{figure, plain, share, shown, summary};
use crate::number::brief;

/// Each engine at its most accurate setting, cost against length, what an event costs, and how far
/// the exact solver is ahead.
#[must_use]
pub fn table(bench: &Bench) -> String {
    [engines(bench), lengths(bench), summary(bench)].concat()
}

fn engines(bench: &Bench) -> String {
    let mut table = plain([
        "case",
        "engine",
        "tol",
        "ns/period",
        "state err",
        "time err",
        "rhs/period",
        "times exact, net",
        "at 1e-9",
        "at 1e-6",
        "gross",
        "at 1e-9",
        "at 1e-6",
        "harness",
    ]);
    let mut before = "";
    for entry in &bench.cases {
        for row in best(bench, &entry.case) {
            let case = if row.case == before { "" } else { &row.case };
            before = &row.case;
            table.add_row(cells(case, row));
        }
    }
    shown(table, 2) + &reasons(bench) + "\n"
}

/// Why engines that are right at no setting are not, at the last of them.
fn reasons(bench: &Bench) -> String {
    let last = bench.cases.iter().flat_map(|entry| best(bench, &entry.case));
    let reason = |row: &BenchRow| {
        let why = row.why.as_ref()?;
        Some(format!("no time: {} {} {}: {why}\n", row.case, row.engine, row.setting()))
    };
    last.filter_map(reason).collect()
}

/// One row per engine: at its most accurate setting, or, where no answer was right, the last.
fn best<'a>(bench: &'a Bench, case: &str) -> Vec<&'a BenchRow> {
    let rows: Vec<&BenchRow> = bench.results.iter().filter(|row| row.case == case).collect();
    let one = |engine: &[&'a BenchRow]| {
        engine.iter().find(|row| row.most_accurate).or(engine.last()).copied()
    };
    rows.chunk_by(|a, b| a.engine == b.engine).filter_map(one).collect()
}

fn cells(case: &str, row: &BenchRow) -> [String; 14] {
    [
        case.to_owned(),
        row.engine.clone(),
        row.setting(),
        figure(row.ns_per_period, |it| format!("{it:.0}")),
        figure(row.state_error_max, brief),
        figure(row.event_time_error_max, brief),
        figure(row.rhs_per_period, |it| format!("{it:.1}")),
        figure(row.net_ratio_to_exact, ratio),
        figure(row.net_ratio_at_1e_9, ratio),
        figure(row.net_ratio_at_1e_6, ratio),
        figure(row.ratio_to_exact, ratio),
        figure(row.ratio_at_1e_9, ratio),
        figure(row.ratio_at_1e_6, ratio),
        share(row),
    ]
}

fn ratio(value: f64) -> String {
    if value < 10.0 { format!("{value:.2}") } else { times(value) }
}

/// Cost against length, where that was measured.
fn lengths(bench: &Bench) -> String {
    if bench.length.is_empty() {
        return String::new();
    }
    let mut table = plain(["periods", "ns/period", "state err", "MB held at most"]);
    for it in &bench.length {
        let held = it.peak_bytes.map(|bytes| format!("{:.1}", bytes as f64 / 1e6));
        table.add_row([
            it.periods.to_string(),
            format!("{:.0}", it.ns_per_period),
            brief(it.state_error_max),
            held.unwrap_or_else(|| "-".to_owned()),
        ]);
    }
    shown(table, 0) + "\n"
}
