//! Modes, events and rows of systems that are written down in code, as a file would be read.

use super::{Mode, Row, Until};

/// A mode by the rows of its rates over (x, cos, sin, 1).
pub(crate) fn mode(name: &str, rates: &[Row], until: Vec<Until>) -> Mode {
    let size = rates.len();
    Mode {
        name: name.to_owned(),
        a: rates.iter().map(|row| row[..size].to_vec()).collect(),
        b: rates.iter().map(|row| [row[size], row[size + 1]]).collect(),
        c: rates.iter().map(|row| row[size + 2]).collect(),
        until,
        watch: Vec::new(),
    }
}

/// An event that ends its mode.
pub(crate) fn until(
    name: &str,
    guard: Row,
    reset: Option<Vec<Row>>,
    next: Vec<(Option<Row>, usize)>,
) -> Until {
    Until { name: name.to_owned(), guard, reset, next }
}

/// A row of which some entries are given and the others are zero.
pub(crate) fn row(size: usize, entries: &[(usize, f64)]) -> Row {
    let mut row = vec![0.0; size + 3];
    entries.iter().for_each(|(place, value)| row[*place] += value);
    row
}

/// The row that selects one state.
pub(crate) fn state(size: usize, place: usize) -> Row {
    row(size, &[(place, 1.0)])
}
