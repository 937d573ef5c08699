//! The coefficients of modes with their derivatives, as numbers.

use super::ball::Jet;
use crate::affine::model::system::{Mode, Row};
use crate::numeric::number::Number;

/// A mode's coefficients with their derivatives.
#[derive(Clone)]
pub(super) struct ModeJets<T: Number> {
    pub matrix: Vec<Vec<Jet<T>>>,
    pub guards: Vec<Vec<Jet<T>>>,
    pub resets: Vec<Vec<Vec<Jet<T>>>>,
}

impl<T: Number> ModeJets<T> {
    /// The coefficients of a mode, with the derivatives that stand in the places of another.
    pub fn new((mode, rates): (&Mode, &Mode)) -> Self {
        let row = |(row, rate): (&Row, &Row)| -> Vec<Jet<T>> {
            row.iter().zip(rate).map(|(a, b)| Jet::new(a, b)).collect()
        };
        let rows = |a: &[Row], b: &[Row]| a.iter().zip(b).map(row).collect::<Vec<_>>();
        let guards = mode.guards().zip(rates.guards()).map(row);
        let resets = mode.until.iter().zip(&rates.until).map(|(a, b)| rows(&a.reset, &b.reset));
        Self {
            matrix: rows(&mode.matrix, &rates.matrix),
            guards: guards.collect(),
            resets: resets.collect(),
        }
    }
}

/// A guard of a mode: those of `until` come first, then those of `watch`.
pub(super) fn guard_of(mode: &Mode, guard: usize) -> &Row {
    match guard.checked_sub(mode.until.len()) {
        Some(watch) => &mode.watch[watch].guard,
        None => &mode.until[guard].guard,
    }
}
