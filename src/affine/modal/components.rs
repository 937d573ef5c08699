//! Entries of z that do not depend on each other: each set of them has a matrix of its own.

use super::Block;
use crate::affine::arithmetic::real::BigReal;
use crate::affine::model::system::Row;
use crate::numeric::number::{Bound, ScaledF64};

/// The entries of z by their couplings: none of a set depends on one of another set.
pub(super) fn components(exact: &[Row]) -> Vec<Vec<usize>> {
    let mut parts: Vec<Vec<usize>> = Vec::new();
    for (n, row) in exact.iter().enumerate() {
        let is_coupled =
            |part: &Vec<usize>| part.iter().any(|k| !(row[*k].is_zero() && exact[*k][n].is_zero()));
        let (joined, apart): (Vec<_>, Vec<_>) = parts.into_iter().partition(is_coupled);
        let mut part: Vec<usize> = joined.into_iter().flatten().chain([n]).collect();
        part.sort_unstable();
        parts = apart;
        parts.push(part);
    }
    parts
}

/// The entries of z in sets whose members depend on each other: ordered by them a matrix is block
/// triangular, and its eigenvalues are those of the sets' own matrices.
pub(super) fn irreducible(exact: &[Row]) -> Vec<Vec<usize>> {
    let size = exact.len();
    let mut leads: Vec<Vec<bool>> =
        exact.iter().map(|row| row.iter().map(|it| !it.is_zero()).collect()).collect();
    for over in 0..size {
        for from in 0..size {
            for to in 0..size {
                leads[from][to] |= leads[from][over] && leads[over][to];
            }
        }
    }
    let is_first = |n: &usize| !(0..*n).any(|k| leads[*n][k] && leads[k][*n]);
    let with = |n: usize| (n..size).filter(|k| *k == n || (leads[n][*k] && leads[*k][n])).collect();
    (0..size).filter(is_first).map(with).collect()
}

impl Block {
    /// The block of a part of the entries of z as one of all of them.
    pub(super) fn embedded(self, part: &[usize], size: usize) -> Self {
        let width = self.matrix.len();
        let mut columns = vec![vec![BigReal::zero(); width]; size];
        let mut column_errors = vec![vec![ScaledF64::ZERO; width]; size];
        let [own_column_errors, own_row_errors] = self.errors;
        for ((place, row), errors) in part.iter().zip(self.columns).zip(own_column_errors) {
            (columns[*place], column_errors[*place]) = (row, errors);
        }
        let rows = self.rows.iter().map(|row| spread_over(part, row, &BigReal::zero(), size));
        let row_errors = own_row_errors.iter();
        let row_errors = row_errors.map(|row| spread_over(part, row, &ScaledF64::ZERO, size));
        let errors = [column_errors, row_errors.collect()];
        let rows = rows.collect();
        Self { kind: self.kind, columns, rows, matrix: self.matrix, errors }
    }
}

/// A row whose entries have these places among so many, and zeros elsewhere.
fn spread_over<E: Clone>(part: &[usize], row: &[E], zero: &E, size: usize) -> Vec<E> {
    let mut whole = vec![zero.clone(); size];
    part.iter().zip(row).for_each(|(place, entry)| whole[*place] = entry.clone());
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::affine::model::rational::Rational;

    /// 0 and 2 act on each other, 1 on both, and 3 on itself alone.
    #[test]
    fn entries_that_depend_on_each_other_are_together() {
        let row = |entries: [i32; 4]| entries.map(Rational::from).to_vec();
        let matrix = [row([0, 1, 1, 0]), row([0; 4]), row([-1, 0, 0, 0]), row([0, 0, 0, 5])];
        assert_eq!(irreducible(&matrix), [vec![0, 2], vec![1], vec![3]]);
    }
}
