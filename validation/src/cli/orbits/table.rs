//! Orbits as a table for people: a line each.

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Table};
use percuss::dynamics::orbit::Orbit;

const COLUMNS: [&str; 8] =
    ["period", "stable", "|multiplier|", "drift/period", "residual", "p", "y", "q"];

/// A table of at most 100 columns: the largest multiplier's modulus, and the orbit's first point.
pub(super) fn text(orbits: &[Orbit]) -> String {
    let mut table = Table::new();
    table.load_preset(NOTHING).set_header(COLUMNS);
    for orbit in orbits {
        table.add_row(row(orbit));
    }
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if i != 1 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

fn row(orbit: &Orbit) -> Vec<String> {
    let number = |value: f64| format!("{value:.6}");
    let [re, im] = orbit.multipliers[0];
    let mut row = vec![
        orbit.period().to_string(),
        if orbit.is_stable() { "yes" } else { "no" }.to_owned(),
        number(re.hypot(im)),
        number(orbit.drift_per_period),
        format!("{:.1e}", orbit.residual),
    ];
    row.extend(orbit.points[0].map(number));
    row
}
