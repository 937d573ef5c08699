//! Fewer columns for the errors of a run: the smallest ones are replaced by a box.
//!
//! The errors lie in a space of fewer dimensions than the state has entries: what is zero by the
//! model has none, and the phase of the forcing has those of the time. A box along the entries
//! would forget that, and grow with every turn of the motion. So it is a box along orthogonal axes
//! of that space, the first of which is the direction of the largest error that is replaced (as
//! Lohner's method has it).

use super::enclosure::{Enclosure, ErrorColumn};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::Bound;

/// The largest number of columns; beyond it the smallest are replaced by a box.
const MAX_COLUMNS: usize = 160;

/// The number of the largest columns that are kept then.
const KEPT_COLUMNS: usize = 80;

/// The share of the errors below which what is left of them is the rounding of f64.
const ROUNDING_SHARE: f64 = 1e-14;

/// The entries of a column: those of the state, and the time.
const COLUMN_ENTRIES: usize = LARGEST_DIMENSION + 1;

/// A column whose entries are measured in their own sizes.
type Scaled = [f64; COLUMN_ENTRIES];

impl<B: Bound> Enclosure<B> {
    /// Replaces the smallest columns by a box, if there are many.
    pub(super) fn reduce(&mut self) {
        if self.columns.len() <= MAX_COLUMNS {
            return;
        }
        let sizes = largest_entries(&self.columns);
        let share =
            |column: &ErrorColumn<B>| scaled(column, &sizes).iter().map(|it| it.abs()).sum::<f64>();
        self.columns.sort_by(|a, b| share(b).total_cmp(&share(a)));
        let small = self.columns.split_off(KEPT_COLUMNS);
        let sizes = largest_entries(&small);
        let boxed = box_columns(small.iter().map(|it| scaled(it, &sizes)).collect());
        self.columns.extend(boxed.iter().map(|axis| unscaled(axis, &sizes)));
    }
}

/// The columns of a box that holds all sums of these.
fn box_columns(mut rest: Vec<Scaled>) -> Vec<Scaled> {
    let mut axes = Vec::new();
    for _ in 0..COLUMN_ENTRIES {
        let largest = rest.iter().copied().max_by(|a, b| square(a).total_cmp(&square(b)));
        let Some(largest) = largest.filter(|it| square(it) > ROUNDING_SHARE * ROUNDING_SHARE)
        else {
            break;
        };
        let length = square(&largest).sqrt();
        let axis = largest.map(|it| it / length);
        let mut reach = 0.0;
        for column in &mut rest {
            let along: f64 = column.iter().zip(&axis).map(|(a, b)| a * b).sum();
            column.iter_mut().zip(&axis).for_each(|(entry, own)| *entry -= along * own);
            reach += along.abs();
        }
        axes.push(axis.map(|it| it * reach));
    }
    // What rounding leaves has no direction.
    for n in 0..COLUMN_ENTRIES {
        let left: f64 = rest.iter().map(|column| column[n].abs()).sum();
        if left > 0.0 {
            let mut column = [0.0; COLUMN_ENTRIES];
            column[n] = left;
            axes.push(column);
        }
    }
    axes
}

fn square(column: &Scaled) -> f64 {
    column.iter().map(|it| it * it).sum()
}

/// The largest size of each entry.
fn largest_entries<B: Bound>(columns: &[ErrorColumn<B>]) -> [B; COLUMN_ENTRIES] {
    std::array::from_fn(|n| {
        columns.iter().map(|column| entry(column, n).abs()).fold(B::ZERO, Bound::max)
    })
}

fn entry<B: Bound>(column: &ErrorColumn<B>, n: usize) -> B {
    column.state.get(n).copied().unwrap_or(column.time)
}

fn scaled<B: Bound>(column: &ErrorColumn<B>, sizes: &[B; COLUMN_ENTRIES]) -> Scaled {
    std::array::from_fn(
        |n| {
            if sizes[n] > 0.0 { (entry(column, n) / sizes[n]).to_f64() } else { 0.0 }
        },
    )
}

fn unscaled<B: Bound>(column: &Scaled, sizes: &[B; COLUMN_ENTRIES]) -> ErrorColumn<B> {
    let entry = |n: usize| sizes[n] * column[n];
    ErrorColumn { state: std::array::from_fn(entry), time: entry(LARGEST_DIMENSION) }
}
