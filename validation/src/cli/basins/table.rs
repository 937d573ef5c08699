//! The attractors as a table for people: a line each.

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Table};
use percuss::dynamics::attractor::{Attractor, Basins, Label};

const COLUMNS: [&str; 9] =
    ["id", "kind", "period", "% of starts", "drift/period", "exponent/period", "p", "y", "q"];

/// A table of at most 100 columns; p, y and q are the attractor's first point.
pub(super) fn text(basins: &Basins) -> String {
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
    format!("{}\n{starts}, {unresolved} % unresolved\n", lines.join("\n"))
}

fn row(basins: &Basins, id: usize, attractor: &Attractor) -> Vec<String> {
    let number = |value: f64| format!("{value:.6}");
    let mut row = vec![
        id.to_string(),
        attractor.kind.as_str().to_owned(),
        attractor.period().map(|it| it.to_string()).unwrap_or_default(),
        share(basins, Label::Attractor(id)),
        if attractor.drift_per_period.is_finite() {
            number(attractor.drift_per_period)
        } else {
            "-".to_owned()
        },
        number(attractor.lyapunov_per_period),
    ];
    match attractor.points.first() {
        Some(point) => row.extend(point.map(number)),
        None => row.extend(["", "", ""].map(str::to_owned)),
    }
    row
}

fn share(basins: &Basins, label: Label) -> String {
    format!("{:.2}", 100.0 * basins.fraction(label))
}
