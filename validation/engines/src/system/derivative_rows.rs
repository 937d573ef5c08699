//! The signs of a row's derivatives along a motion: which of them is the first that is not zero.
//!
//! A derivative is zero where the model says so, or where its value is within rounding of zero. The
//! model's own zeros are told from the event by which the motion has come: the guard of that event
//! is zero there, and so is, after its reset, every row that is a multiple of it before.

use super::MAX_STATES;

/// A row over (x, cos theta, sin theta, 1).
pub(super) type AugmentedRow = [f64; MAX_STATES + 3];

/// The distance from zero to which rounding may take a sum, relative to its terms.
const SUM_TOLERANCE: f64 = 64.0 * f64::EPSILON;
/// The error of an event time by rounding, relative to the time.
const TIME_TOLERANCE: f64 = 4.0 * f64::EPSILON;

/// The matrix M of z' = M z, with z = (x, cos theta, sin theta, 1).
#[derive(Clone, Debug)]
pub(super) struct ModeMatrix {
    /// The number of states.
    pub(super) size: usize,
    pub(super) rows: Vec<AugmentedRow>,
}

impl ModeMatrix {
    /// The row of a row's derivative.
    pub(super) fn derivative(&self, row: &AugmentedRow) -> AugmentedRow {
        multiplied(row, &self.rows, self.size + 3)
    }
}

/// A row times a matrix that is given by its rows.
pub(super) fn multiplied(
    row: &AugmentedRow,
    matrix: &[AugmentedRow],
    width: usize,
) -> AugmentedRow {
    let mut product = [0.0; MAX_STATES + 3];
    for (factor, line) in row.iter().zip(matrix) {
        for (entry, value) in product.iter_mut().zip(line).take(width) {
            *entry += factor * value;
        }
    }
    product
}

/// A row's value and the size of its terms, in a state at (cos theta, sin theta).
pub(super) fn value(row: &AugmentedRow, x: &[f64], [cos, sin]: [f64; 2]) -> (f64, f64) {
    let size = x.len();
    let others = [row[size] * cos, row[size + 1] * sin, row[size + 2]];
    let terms = row.iter().zip(x).map(|(factor, x)| factor * x).chain(others);
    terms.fold((0.0, 0.0), |(sum, all), term| (sum + term, all + term.abs()))
}

/// A row and the rows of its derivatives along the motion in one mode.
#[derive(Clone, Debug)]
pub(super) struct DerivativeRows {
    pub(super) rows: Vec<AugmentedRow>,
}

/// The order and the sign of the first derivative that is not zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Leading {
    /// The derivative's order.
    pub(super) order: usize,
    pub(super) positive: bool,
}

impl DerivativeRows {
    /// A row with as many derivatives as z has entries: if these are zero, all are.
    pub(super) fn new(row: AugmentedRow, motion: &ModeMatrix) -> Self {
        let next = |row: &AugmentedRow| Some(motion.derivative(row));
        Self { rows: std::iter::successors(Some(row), next).take(motion.size + 3).collect() }
    }

    /// The derivatives that are zero after an event because of its guard, a bit each.
    pub(super) fn zeros_after(
        &self,
        guard: &AugmentedRow,
        reset: &[AugmentedRow],
        size: usize,
    ) -> u16 {
        let zero =
            |(k, row): (usize, &AugmentedRow)| u16::from(is_multiple(row, guard, reset, size)) << k;
        self.rows.iter().enumerate().map(zero).sum()
    }

    /// The first derivative that is not zero in a state at a time; `zeros` are known to be.
    pub(super) fn leading(
        &self,
        zeros: u16,
        t: f64,
        x: &[f64],
        forcing: [f64; 2],
    ) -> Option<Leading> {
        let values: Vec<_> = self.rows.iter().map(|row| value(row, x, forcing)).collect();
        let counts = |k: &usize| {
            let (value, terms) = values[*k];
            let rate = values.get(k + 1).map_or(0.0, |next| next.0.abs());
            let rounding = SUM_TOLERANCE * terms + TIME_TOLERANCE * t.abs() * rate;
            zeros & 1 << k == 0 && value.abs() > rounding
        };
        let order = (0..values.len()).find(counts)?;
        Some(Leading { order, positive: values[order].0 > 0.0 })
    }
}

/// Whether a row after a reset is a multiple of an event's guard before it, and so zero there.
fn is_multiple(
    row: &AugmentedRow,
    guard: &AugmentedRow,
    reset: &[AugmentedRow],
    size: usize,
) -> bool {
    let width = size + 3;
    let before = multiplied(row, reset, width);
    let terms = multiplied(&row.map(f64::abs), &absolute(reset), width);
    let squared: f64 = guard.iter().map(|it| it * it).sum();
    let common: f64 = before.iter().zip(guard).map(|(one, other)| one * other).sum();
    let factor = if squared > 0.0 { common / squared } else { 0.0 };
    (0..width).all(|j| {
        let part = factor * guard[j];
        (before[j] - part).abs() <= SUM_TOLERANCE * (terms[j] + part.abs())
    })
}

fn absolute(matrix: &[AugmentedRow]) -> Vec<AugmentedRow> {
    matrix.iter().map(|row| row.map(f64::abs)).collect()
}
