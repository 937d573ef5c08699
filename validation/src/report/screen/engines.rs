//! The engines of the first screen, a line each.

use super::details::{figure, plain};
use super::names::{fit, short_names};
use super::remark::remark;
use crate::number::brief;
use crate::report::ranking::{Common, EngineRows, by_engine, case_names, settings};
use crate::report::table::{WIDTH, text};
use crate::report::{Ranked, Report, ReportRow};
use crate::score::nearest_rank;
use comfy_table::{CellAlignment, Table};

/// The tolerance at which errors and costs are shown, where it was run.
const SHOWN_TOLERANCE: &str = "1e-9";
/// The quantile of the errors of all cases that is shown.
const SHOWN_QUANTILE: f64 = 0.9;
const COLUMNS: usize = 8;
const HEADER: [&str; COLUMNS] = [
    "",
    "\nengine",
    "cases\nright",
    "wrong\nevents",
    "cases\nfailed",
    "90 % of\nerrors <",
    "rhs an\nevent",
    "what\ngoes wrong",
];

/// The question, the number of cases, and what the columns are at.
pub(super) fn title(report: &Report) -> String {
    let with_tolerance: Vec<_> =
        report.results.iter().filter(|row| row.tolerance.is_some()).collect();
    let all = settings(&with_tolerance);
    let at = shown_at(&all).map_or(String::new(), |it| format!("; errors, rhs at {it}"));
    let right = if all.is_empty() { String::new() } else { format!(" at {}", all.join("/")) };
    let cases = match case_names(&report.results).len() {
        1 => "1 case".to_owned(),
        cases => format!("{cases} cases"),
    };
    format!("Which integrator, at what tolerance? {cases}; right{right}{at}")
}

/// The setting at which errors and costs are shown: the usual one, or else the middle one.
fn shown_at(settings: &[String]) -> Option<&str> {
    let usual = settings.iter().find(|it| *it == SHOWN_TOLERANCE);
    usual.or_else(|| settings.get(settings.len() / 2)).map(String::as_str)
}

/// The cells of all engines.
pub(super) struct EngineTable {
    lines: Vec<[String; COLUMNS]>,
}

impl EngineTable {
    /// The engines in the order of the ranking.
    pub fn new(report: &Report) -> Self {
        let engines = by_engine(&report.results);
        let common = Common::new(&engines);
        let names = short_names(report);
        let line = |it: &Ranked| {
            let rows = engines.iter().find(|own| own.engine == it.engine)?;
            let name = names.get(it.engine).copied().unwrap_or(it.engine);
            Some(cells((report, it), (name, rows), &common))
        };
        Self { lines: report.ranking.iter().filter_map(line).collect() }
    }

    /// The lines of its header.
    pub const fn header_lines(&self) -> usize {
        if self.lines.is_empty() { 0 } else { 2 }
    }

    /// The header and at most `room` lines: the best engines, and how many more there are.
    pub fn lines(&self, room: usize) -> Vec<String> {
        if self.lines.is_empty() {
            return Vec::new();
        }
        let all = self.lines.len() <= room;
        let shown = if all { self.lines.len() } else { room.saturating_sub(1) };
        let rest = self.lines.len() - shown;
        let more = (!all).then(|| format!("and {rest} engines more: --details"));
        text(&self.table(shown)).lines().map(str::to_owned).chain(more).collect()
    }

    /// The table of the best engines.
    fn table(&self, shown: usize) -> Table {
        let mut table = plain(&HEADER, 2);
        if let Some(last) = table.column_mut(COLUMNS - 1) {
            last.set_cell_alignment(CellAlignment::Left);
        }
        let engine_width = self.engine_width();
        for line in self.lines.iter().take(shown) {
            let mut line = line.clone();
            line[1] = fit(&line[1], engine_width);
            table.add_row(line);
        }
        table
    }

    /// The columns that the others leave for the engine's name.
    fn engine_width(&self) -> usize {
        let width = |column: usize| {
            let cells = self.lines.iter().map(|line| line[column].as_str());
            let cells = cells.chain(HEADER[column].lines());
            cells.map(|it| it.chars().count()).max().unwrap_or(0) + 1
        };
        let others: usize = (0..COLUMNS).filter(|column| *column != 1).map(width).sum();
        WIDTH.saturating_sub(others)
    }
}

fn cells(
    (report, it): (&Report, &Ranked),
    (name, own): (&str, &EngineRows<'_>),
    common: &Common<'_>,
) -> [String; COLUMNS] {
    let all = settings(&own.rows);
    let at = shown_at(&all).unwrap_or_default();
    let right: Vec<_> = it.cases_right.0.iter().map(|(_, count)| count.to_string()).collect();
    // What the reference evaluates is no right-hand side.
    let cost = common.per_event_at(&own.rows, at).filter(|_| !own.is_exact());
    let mark = if it.clean { "" } else { "!" };
    [
        it.shown_rank().map_or("-".to_owned(), |rank| rank.to_string()),
        with_steps(name, own),
        right.join("/"),
        it.wrong_events().to_string(),
        format!("{}{mark}", it.fails_on.len()),
        most_errors(&own.rows, at).map_or("-".to_owned(), brief),
        cost.map_or("-".to_owned(), figure_of_cost),
        remark(report, it, &own.rows).to_owned(),
    ]
}

/// The name, with the steps of an engine whose settings are not those of the title.
fn with_steps(name: &str, own: &EngineRows<'_>) -> String {
    let steps: Vec<_> = own.rows.iter().filter(|row| row.step.is_some()).copied().collect();
    let steps = settings(&steps);
    match (steps.first(), steps.last()) {
        (Some(coarse), Some(fine)) if coarse != fine => {
            format!("{name} {coarse}..{}", fine.trim_start_matches("h="))
        }
        (Some(only), _) => format!("{name} {only}"),
        _ => name.to_owned(),
    }
}

/// The error that nine of ten cases stay below at a setting; none where fewer have a result.
fn most_errors(rows: &[&ReportRow], setting: &str) -> Option<f64> {
    let at = rows.iter().filter(|row| row.setting_key() == setting);
    let error = |row: &&ReportRow| match row.state_error.max {
        error if row.status == "ok" && error.is_finite() => error,
        _ => f64::INFINITY,
    };
    let mut errors: Vec<f64> = at.map(error).collect();
    errors.sort_by(f64::total_cmp);
    Some(nearest_rank(&errors, SHOWN_QUANTILE)).filter(|it| it.is_finite())
}

/// A cost in at most six columns.
fn figure_of_cost(cost: f64) -> String {
    match cost {
        cost if cost < 9.95 => figure(cost),
        cost if cost < 99_999.5 => format!("{cost:.0}"),
        cost => format!("{cost:.0e}"),
    }
}
