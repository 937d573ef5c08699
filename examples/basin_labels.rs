//! Labels a grid of starts by the attractor that each of them reaches, and draws the labels.
//!
//! `cargo run --release --example basin_labels`

use percuss::dynamics::attractor::{Basins, Grid, Label, Window};
use percuss::dynamics::strobe::StrobeMap;
use percuss::{Model, Parameters, Start};
use std::error::Error;
use std::io::Write;

/// A letter per start (`>` escapes, `?` is unresolved, `#` is beyond Z), p from -3 to 1.2 to the
/// right, y from 1.5 at the top to -1.5; then a line per attractor.
pub fn write(mut out: impl Write) -> Result<(), Box<dyn Error>> {
    let model = Model::new(Parameters { omega: 1.6, xi: 0.1, ..Parameters::default() })?;
    let map = StrobeMap::new(model, model.start(&Start::default())?.instant);
    let window = Window { p: [-3.0, 1.2], y: [-1.5, 1.5] };
    let grid = Grid { window, columns: 60, rows: 24, q: 0.0 };
    let basins = Basins::new(&map, &grid, 60, &|_| {});
    for row in basins.labels.chunks(grid.columns as usize).rev() {
        let letters: String = row.iter().map(letter).collect();
        writeln!(out, "{letters}")?;
    }
    for (number, attractor) in basins.attractors.iter().enumerate() {
        let label = Label::Attractor(number);
        let share = 100.0 * basins.fraction(label);
        let period = attractor.period().map_or(String::new(), |n| format!(" of period {n}"));
        writeln!(
            out,
            "{}: {}{period}, {share:.1} % of the starts",
            letter(&label),
            attractor.kind
        )?;
    }
    Ok(())
}

fn letter(label: &Label) -> char {
    match label {
        Label::Attractor(number) => (b'A'..=b'Z').map(char::from).nth(*number).unwrap_or('#'),
        Label::Escaping => '>',
        Label::Unresolved => '?',
        // Of other systems alone: every state is a start here, and no run ends.
        Label::Inadmissible | Label::Ended => '!',
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    write(std::io::stdout().lock())
}
