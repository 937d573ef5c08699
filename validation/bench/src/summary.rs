//! The summary of a bench: the cost of an event, and the closest competitor on each case.

use super::competitor::{closest_competitor, errs_least, times};
use super::equal_accuracy::BASES;
use super::report::{Bench, BenchRow};
use crate::engine::REFERENCE;
use crate::number::brief;
use comfy_table::{CellAlignment, Table, presets};

/// The exact solver's cost on each case, and its closest competitors at their most accurate and at
/// equal accuracy. docs/SPEED.md holds it.
#[must_use]
pub fn summary(bench: &Bench) -> String {
    let floor = bench.floor;
    let mut text = format!(
        "floor: {:.1} ns per evaluation (one sine, cosine and exponential), dependent-chain latency; \
         {:.1} ns independent\n",
        floor.chained_ns, floor.independent_ns
    );
    text.push_str(&events(bench));
    text.push('\n');
    text.push_str(&competitors(bench));
    text.push_str(
        "times exact: the engine's time over the exact solver's, net of what the harness adds to the\n\
         engine's, and gross; at an error of at most ten times the exact solver's, 1e-9 and 1e-6\n\
         interpolated on the work-precision curve;\n\
         harness: share of the engine's whole time that is the harness's own\n",
    );
    text.push_str(&least_error(bench));
    text
}

/// The exact solver's time per event on each case.
fn events(bench: &Bench) -> String {
    let mut table = plain([
        "exact",
        "events",
        "ns/event",
        "floors",
        "evaluations/event",
        "ns/period",
        "state err",
        "harness",
    ]);
    for (case, it) in bench.cases.iter().zip(&bench.events) {
        let own = bench.results.iter().find(|row| row.case == it.case && row.engine == REFERENCE);
        let of = |get: fn(&BenchRow) -> Option<f64>| own.and_then(get);
        table.add_row([
            it.case.clone(),
            case.events.to_string(),
            figure(it.ns_per_event, |it| format!("{it:.0}")),
            figure(it.floors_per_event, |it| format!("{it:.1}")),
            figure(it.evaluations_per_event, |it| format!("{it:.2}")),
            figure(of(|row| row.ns_per_period), |it| format!("{it:.0}")),
            figure(of(|row| row.state_error_max), brief),
            own.map_or("-".to_owned(), share),
        ]);
    }
    shown(table, 1)
}

/// The closest competitor on each case, on each basis.
fn competitors(bench: &Bench) -> String {
    let mut table =
        plain(["case", "state err", "closest competitor", "times exact, net", "gross", "harness"]);
    for case in bench.cases.iter().map(|it| it.case.as_str()) {
        for (k, basis) in BASES.into_iter().enumerate() {
            let Some(it) = closest_competitor(bench, case, basis) else { continue };
            table.add_row([
                if k == 0 { case.to_owned() } else { String::new() },
                it.accuracy(),
                it.row.engine.clone(),
                times(it.net),
                figure(it.row.ratio(basis), times),
                share(it.row),
            ]);
        }
    }
    shown(table, 3)
}

/// A line about the cases on which the exact solver errs least.
fn least_error(bench: &Bench) -> String {
    let cases = bench.cases.iter().map(|it| it.case.as_str());
    let beaten: Vec<_> = cases.filter(|case| !errs_least(bench, case)).collect();
    if beaten.is_empty() {
        "exact errs less than every adaptive engine at any tolerance, on every case\n".to_owned()
    } else {
        format!("an adaptive engine errs less than exact on: {}\n", beaten.join(", "))
    }
}

/// A figure, or a dash where there is none.
pub(super) fn figure(value: Option<f64>, show: impl Fn(f64) -> String) -> String {
    value.filter(|it| it.is_finite()).map_or("-".to_owned(), show)
}

/// The share of the harness in whole per cent; where it is no larger than its rounds differ, or
/// than half a per cent, with half of what they differ by.
pub(super) fn share(row: &BenchRow) -> String {
    let Some(share) = row.harness_share.filter(|it| it.is_finite()) else { return "-".to_owned() };
    let spread = row.harness_share_spread.unwrap_or(0.0);
    if share <= spread.max(0.005) {
        let least = (100.0 * spread).ceil().max(1.0);
        return format!("about 0 +-{least}%");
    }
    format!("{:.0}%", 100.0 * share)
}

/// A table without lines under the given header.
pub(super) fn plain<const N: usize>(header: [&str; N]) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    table.set_header(header);
    table
}

/// The table as text; columns from `from` on are aligned to the right.
pub(super) fn shown(mut table: Table, from: usize) -> String {
    for column in table.column_iter_mut().skip(from) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 2));
    }
    let lines: Vec<_> = table.to_string().lines().map(|line| line.trim_end().to_owned()).collect();
    lines.join("\n") + "\n"
}
