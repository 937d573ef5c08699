//! The attractors as a table for people: a line each.

use super::Survey;
use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Table};
use percuss::dynamics::attractor::{Attractor, Basins, Label, SearchLimits, UnresolvedStart};

const COLUMNS: [&str; 9] =
    ["id", "kind", "period", "% of starts", "drift/period", "exponent/period", "p", "y", "q"];

/// A table of at most 100 columns; p, y and q are the attractor's first point.
pub(super) fn text(survey: &Survey) -> String {
    let basins = &survey.basins;
    let mut table = Table::new();
    table.load_preset(NOTHING).set_header(COLUMNS);
    for (id, attractor) in basins.attractors.iter().enumerate() {
        table.add_row(row(basins, id, attractor));
    }
    let escaping = share(basins, Label::Escaping);
    if basins.fraction(Label::Escaping) > 0.0 {
        table.add_row(["-2", "escaping", "", &escaping, "", "", "", "", ""]);
    }
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if i > 1 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines: Vec<_> = table.lines().map(|line| line.trim_end().to_owned()).collect();
    let unresolved = share(basins, Label::Unresolved);
    let grid = &basins.grid;
    let starts = format!("{} x {} starts", grid.columns, grid.rows);
    let described: String = survey.unresolved.iter().map(|it| line(it, survey.limits)).collect();
    format!("{}\n{starts}, {unresolved} % unresolved\n{described}", lines.join("\n"))
}

/// The line that describes a start that was not recognised.
fn line(start: &UnresolvedStart, limits: SearchLimits) -> String {
    let [p, y, q] = start.point;
    let recurrence = match start.recurrence {
        Some(periods) => format!("repeats after {periods} periods, and is not seen to attract"),
        None => format!("does not repeat within {} periods", limits.max_period),
    };
    let exponent = start.lyapunov_per_period;
    format!("unresolved: p = {p}, y = {y}, q = {q}: exponent/period {exponent:.6}, {recurrence}\n")
}

fn row(basins: &Basins, id: usize, attractor: &Attractor) -> Vec<String> {
    let number = |value: f64| format!("{value:.6}");
    let known = |value: f64, error: f64| format!("{value:.*}", digits(error));
    let mut row = vec![
        id.to_string(),
        attractor.kind.as_str().to_owned(),
        attractor.period().map(|it| it.to_string()).unwrap_or_default(),
        share(basins, Label::Attractor(id)),
        if attractor.drift_per_period.is_finite() {
            known(attractor.drift_per_period, attractor.drift_standard_error)
        } else {
            "-".to_owned()
        },
        known(attractor.lyapunov_per_period, attractor.lyapunov_error),
    ];
    match attractor.points.first() {
        Some(point) => row.extend(point.map(number)),
        None => row.extend(["", "", ""].map(str::to_owned)),
    }
    row
}

/// The digits after the point of a number with this standard error: down to the error's first, six
/// at most.
pub(super) fn digits(error: f64) -> usize {
    if error > 0.0 { (-error.log10().floor()).clamp(0.0, 6.0) as usize } else { 6 }
}

fn share(basins: &Basins, label: Label) -> String {
    format!("{:.2}", 100.0 * basins.fraction(label))
}
