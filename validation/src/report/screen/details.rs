//! What `--details` prints above the first screen.

use super::names::fit;
use crate::number::brief;
use crate::report::failing::failing_cases;
use crate::report::notes::notes;
use crate::report::table::{text, wrap};
use crate::report::trouble::{Trouble, TroubleCell};
use crate::report::{Ranked, Report, ReportEvidence};
use comfy_table::{CellAlignment, Table, presets};

/// The most engines that stand side by side.
const MAX_ENGINES_PER_ROW: usize = 18;
/// The longest name that leaves room for its figures, in columns.
const MAX_NAME_COLUMNS: usize = 40;

/// The details; `all_names`: failing cases are named however many they are.
pub(super) fn details(report: &Report, evidence: &ReportEvidence, all_names: bool) -> String {
    let parts = [
        trouble_table(report, evidence),
        notes(report, evidence),
        events_table(report),
        failing_cases(report, evidence, all_names),
    ];
    parts.concat()
}

/// A plain table without borders, its columns from one on to the right.
pub(super) fn plain(header: &[&str], right_from: usize) -> Table {
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

pub(in crate::report) fn figure(value: f64) -> String {
    match value.abs() {
        size if size.is_nan() => "-".to_owned(),
        size if (0.01..1000.0).contains(&size) => format!("{value:.2}"),
        _ => brief(value),
    }
}

/// All engines with their events, defects and costs.
fn events_table(report: &Report) -> String {
    let header = [
        "#", "engine", "judged", "miss", "spur", "mode", "stiff", "med", "q99", "area", "2x", "rhs",
    ];
    let mut table = plain(&header, 2);
    for it in &report.ranking {
        table.add_row(cells(it));
    }
    text(&table) + &wrap(LEGEND) + "\n"
}

const LEGEND: &str = "rank (#): one more than the engines that are better by their cases that are \
    wholly right, as a bootstrap over the cases tells at 95 %; what was not run is not right, and \
    engines with unexpected failures stand below those without. judged: own events and missed \
    ones, each from the record before it; miss, spur, mode: missed, spurious, in a wrong mode. \
    stiff: right rows of stiff cases. med, q99: a row's largest defect, in units of what its \
    tolerance leaves. area, 2x, rhs: cost at an error of 1e-6 on the cases that all ran, as area \
    under the profile, share within twice the least, and right-hand sides an event.";

fn cells(it: &Ranked) -> [String; 12] {
    let shown = |value: Option<f64>| value.map_or("-".to_owned(), figure);
    [
        it.shown_rank().map_or("-".to_owned(), |rank| rank.to_string()),
        fit(it.engine, MAX_NAME_COLUMNS),
        it.events_judged.to_string(),
        it.events_missed.to_string(),
        it.events_spurious.to_string(),
        it.events_wrong_mode.to_string(),
        format!("{}/{}", it.stiff.cases_right, it.stiff.cases_total),
        shown(it.defect_units.median),
        shown(it.defect_units.q99),
        shown(it.cost.area),
        shown(it.cost.within_twice),
        it.cost.rhs_per_event.map_or("-".to_owned(), |cost| format!("{cost:.0}")),
    ]
}

/// Kinds of trouble by engines, which stand under their ranks.
fn trouble_table(report: &Report, evidence: &ReportEvidence) -> String {
    let trouble = Trouble::new(report, evidence);
    if trouble.lines.is_empty() {
        return String::new();
    }
    let parts = (0..trouble.engines.len()).step_by(MAX_ENGINES_PER_ROW);
    let tables: String = parts.map(|from| trouble_part(&trouble, from)).collect();
    let engines: Vec<String> =
        trouble.engines.iter().map(|(name, place)| format!("{place} {name}")).collect();
    let legend = format!(
        "trouble: right events, and those where either answer is right, in per cent of the judged \
         events of the cases of each kind, rounded down; the columns are the engines: {}.",
        engines.join(", ")
    );
    tables + &wrap(&legend) + "\n"
}

/// The matrix for as many engines as fit, from one on.
fn trouble_part(trouble: &Trouble, from: usize) -> String {
    let mut header = vec!["trouble", "cases"];
    let engines = trouble.engines.iter().skip(from).take(MAX_ENGINES_PER_ROW);
    header.extend(engines.map(|it| it.1.as_str()));
    let mut table = plain(&header, 1);
    for (kind, cases, cells) in &trouble.lines {
        let cell = |cell: &TroubleCell| cell.percent().map_or("-".to_owned(), |it| it.to_string());
        let cells = cells.iter().skip(from).take(MAX_ENGINES_PER_ROW).map(cell);
        table.add_row([kind.clone(), cases.to_string()].into_iter().chain(cells));
    }
    text(&table)
}
