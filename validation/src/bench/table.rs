//! The tables for people.

use super::lead::{Shortfall, lead};
use super::report::{Bench, Row};
use crate::number::brief;
use comfy_table::{CellAlignment, Table, presets};

/// Each engine at its most accurate setting, what a switch costs, and how far the exact solver is ahead.
#[must_use]
pub fn table(bench: &Bench) -> String {
    let mut text = engines(bench);
    text.push_str(&switches(bench));
    text.push_str(&lengths(bench));
    let cases = || bench.cases.iter().map(|entry| entry.case.as_str());
    text.push('\n');
    text.push_str(&lines(cases().filter_map(|case| lead(bench, case))));
    text.push_str(&lines(cases().filter_map(|case| Shortfall::of(bench, case))));
    text
}

fn lines(of: impl Iterator<Item = impl std::fmt::Display>) -> String {
    of.map(|it| format!("{it}\n")).collect()
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
        "times exact",
    ]);
    let mut before = "";
    for entry in &bench.cases {
        for row in best(bench, &entry.case) {
            let case = if row.case == before { "" } else { &row.case };
            before = &row.case;
            table.add_row(cells(case, row));
        }
    }
    shown(table, 2) + &reasons(bench)
}

/// Why engines that are right at no setting are not, at the last of them.
fn reasons(bench: &Bench) -> String {
    let last = bench.cases.iter().flat_map(|entry| best(bench, &entry.case));
    let reason = |row: &Row| {
        let why = row.why.as_ref()?;
        Some(format!("no time: {} {} {}: {why}\n", row.case, row.engine, row.setting()))
    };
    last.filter_map(reason).collect()
}

/// One row an engine: at its most accurate setting, or, where no answer was right, the last.
fn best<'a>(bench: &'a Bench, case: &str) -> Vec<&'a Row> {
    let rows: Vec<&Row> = bench.results.iter().filter(|row| row.case == case).collect();
    let one =
        |engine: &[&'a Row]| engine.iter().find(|row| row.most_accurate).or(engine.last()).copied();
    rows.chunk_by(|a, b| a.engine == b.engine).filter_map(one).collect()
}

fn cells(case: &str, row: &Row) -> [String; 8] {
    let figure = |value: Option<f64>, show: fn(f64) -> String| {
        value.filter(|it| it.is_finite()).map_or("-".to_owned(), show)
    };
    [
        case.to_owned(),
        row.engine.to_owned(),
        row.setting(),
        figure(row.ns_per_period, |it| format!("{it:.0}")),
        figure(row.state_error_max, brief),
        figure(row.event_time_error_max, brief),
        figure(row.rhs_per_period, |it| format!("{it:.1}")),
        figure(row.ratio_to_exact, ratio),
    ]
}

fn ratio(value: f64) -> String {
    if value < 10.0 { format!("{value:.2}") } else { format!("{value:.0}") }
}

fn switches(bench: &Bench) -> String {
    let mut table = plain(["a switch of", "evaluations", "ns", "floors", "independent floors"]);
    let two = |value: Option<f64>| value.map_or("-".to_owned(), |it| format!("{it:.2}"));
    for it in &bench.switches {
        table.add_row([
            it.case.clone(),
            two(it.evaluations_per_switch),
            two(it.ns_per_switch),
            two(it.floors_per_switch),
            it.why.clone().unwrap_or_else(|| two(it.independent_floors_per_switch)),
        ]);
    }
    let floor = bench.floor;
    format!(
        "\nfloor: {:.1} ns a sine, cosine and exponential that wait for the last, {:.1} ns independent ones\n{}",
        floor.chained_ns,
        floor.independent_ns,
        shown(table, 1)
    )
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
    format!("\n{}", shown(table, 0))
}

fn plain<const N: usize>(header: [&str; N]) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    table.set_header(header);
    table
}

/// Numbers from column `from` on stand to the right.
fn shown(mut table: Table, from: usize) -> String {
    for column in table.column_iter_mut().skip(from) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 2));
    }
    let lines: Vec<_> = table.to_string().lines().map(|line| line.trim_end().to_owned()).collect();
    lines.join("\n") + "\n"
}
