//! The motion of co-ordinates whose matrix is nilpotent, but for a rate: a polynomial of the time.
//!
//! In the co-ordinates of such a block most entries of the matrix are zero, because each entry of
//! the state follows one other or two. Where the rows have an order in which none follows one
//! before it, only the other entries are kept, and the vector is moved in its place.

use crate::affine::arithmetic::real::BigReal;
use crate::affine::arithmetic::vector::{Vector, rounded};
use crate::affine::modal;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::{Bound, Number};

/// A strictly upper triangular matrix in some order of its rows, of which only the entries that are
/// not zero are kept.
#[derive(Clone, Debug)]
pub(super) struct SparseTriangular<T: Number> {
    rows: Vec<SparseRow<T>>,
}

/// A row of the triangular matrix: its place in the vector, and its entries that are not zero.
#[derive(Clone, Debug)]
struct SparseRow<T: Number> {
    to: usize,
    entries: Vec<SparseEntry<T>>,
}

/// An entry of the triangular matrix, with its column as a place in the vector.
#[derive(Clone, Copy, Debug)]
struct SparseEntry<T: Number> {
    from: usize,
    factor: T,
    size: T::Bound,
}

/// The matrix of a block less its rate, and the least power of it that is zero.
pub(super) fn nilpotent(block: &modal::Block, rate: &BigReal) -> (Vec<Vec<BigReal>>, usize) {
    let mut matrix = block.matrix.clone();
    for (n, row) in matrix.iter_mut().enumerate() {
        row[n] = &row[n] - rate;
    }
    // Half of the bits are far more than what rounding leaves of a zero, entry by entry: entries of
    // one matrix may have any sizes.
    let is_nothing =
        |entry: &BigReal, size: &BigReal| entry.abs() <= size.scaled(-(entry.bits() as isize) / 2);
    let mut clean = matrix.clone();
    for (n, row) in clean.iter_mut().enumerate() {
        let terms = &block.matrix[n][n].abs() + &rate.abs();
        if is_nothing(&row[n], &terms) {
            row[n] = BigReal::zero();
        }
    }
    let sizes = clean.iter().map(|row| row.iter().map(BigReal::abs).collect()).collect();
    let powers = modal::multiples(&clean, matrix.len()).into_iter();
    let mut powers = powers.zip(modal::multiples(&sizes, matrix.len()));
    let is_zero = |(power, sizes): (Vec<Vec<BigReal>>, Vec<Vec<BigReal>>)| {
        let entries = power.iter().flatten().zip(sizes.iter().flatten());
        entries.into_iter().all(|(entry, size)| is_nothing(entry, size))
    };
    let index = powers.position(is_zero).map_or(matrix.len(), |it| it + 1);
    (matrix, index)
}

impl<T: Number> SparseTriangular<T> {
    /// The matrix of a block whose co-ordinates begin at a place of the vector; none if no order of
    /// its rows makes it triangular.
    pub fn new(matrix: &[Vec<BigReal>], at: usize) -> Option<Self> {
        let follows = |row: &usize, other: &usize| !matrix[*row][*other].is_zero();
        let mut left: Vec<usize> = (0..matrix.len()).collect();
        let mut rows = Vec::new();
        while !left.is_empty() {
            // A row on which no other row, nor itself, depends.
            let is_first = |row: &usize| !left.iter().any(|other| follows(other, row));
            let first = left.remove(left.iter().position(is_first)?);
            rows.push(SparseRow::new(&matrix[first], first, at));
        }
        rows.retain(|row| !row.entries.is_empty());
        Some(Self { rows })
    }

    /// The co-ordinates a time later by so many terms of the Taylor series, in Horner's scheme, and
    /// the sizes of what that sums.
    ///
    /// A row is moved before those that it is made of, which still are what they were.
    #[inline]
    pub fn advance(&self, terms: usize, y: &mut Vector<T>, sizes: &mut Vector<T::Bound>, time: T) {
        if terms == 1 {
            for row in &self.rows {
                row.advance((y[row.to], sizes[row.to]), y, sizes, time);
            }
            return;
        }
        // Entry by entry: a copy of all in wide registers would wait for entries just written.
        let mut starts = [(T::zero(), T::Bound::ZERO); LARGEST_DIMENSION];
        for (start, row) in starts.iter_mut().zip(&self.rows) {
            *start = (y[row.to], sizes[row.to]);
        }
        for k in (1..=terms).rev() {
            let factor = if k == 1 { time } else { time / T::exact(k as f64) };
            for (start, row) in starts.iter().zip(&self.rows) {
                row.advance(*start, y, sizes, factor);
            }
        }
    }
}

impl<T: Number> SparseRow<T> {
    fn new(row: &[BigReal], n: usize, at: usize) -> Self {
        let there = row.iter().enumerate().filter(|(_, entry)| !entry.is_zero());
        let entry = |(column, entry): (usize, &BigReal)| {
            let factor = rounded::<T>(entry);
            SparseEntry { from: at + column, factor, size: factor.bound().abs() }
        };
        Self { to: at + n, entries: there.map(entry).collect() }
    }

    /// Sets the row's entry of the vector to its value at the start plus a multiple of the row's
    /// product.
    #[inline(always)]
    fn advance(
        &self,
        (start, size_at_start): (T, T::Bound),
        y: &mut Vector<T>,
        sizes: &mut Vector<T::Bound>,
        factor: T,
    ) {
        let (mut sum, mut size) = (T::zero(), T::Bound::ZERO);
        for entry in &self.entries {
            sum = sum + entry.factor * y[entry.from];
            size += entry.size * sizes[entry.from];
        }
        y[self.to] = start + factor * sum;
        sizes[self.to] = size_at_start + factor.bound().abs() * size;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// exp(N t) y by the powers of N.
    fn summed(matrix: &[[f64; 4]; 4], start: [f64; 4], time: f64) -> [f64; 4] {
        let (mut sum, mut term) = (start, start);
        for k in 1..4 {
            let last = term;
            for n in 0..4 {
                let product: f64 = (0..4).map(|j| matrix[n][j] * last[j]).sum();
                term[n] = product * time / k as f64;
                sum[n] += term[n];
            }
        }
        sum
    }

    /// Matrices that are triangular in some order of their rows, with zeros in many places.
    fn matrix() -> impl Strategy<Value = [[f64; 4]; 4]> {
        let entry = prop_oneof![Just(0.0), -2.0..2.0_f64];
        let order = Just([0_usize, 1, 2, 3]).prop_shuffle();
        (prop::collection::vec(entry, 6), order).prop_map(|(entries, order)| {
            let mut matrix = [[0.0; 4]; 4];
            let pairs = (0..4).flat_map(|i| (i + 1..4).map(move |j| (i, j)));
            for ((i, j), entry) in pairs.zip(entries) {
                matrix[order[i]][order[j]] = entry;
            }
            matrix
        })
    }

    fn big(matrix: &[[f64; 4]; 4]) -> Vec<Vec<BigReal>> {
        matrix.iter().map(|row| row.map(BigReal::exact).to_vec()).collect()
    }

    proptest! {
        /// Whatever the order of the rows, each is moved before those that it is made of.
        #[test]
        fn a_chain_moves_as_its_powers_do(matrix in matrix(), time in 0.0..3.0_f64) {
            let at = 5;
            let Some(triangular) = SparseTriangular::new(&big(&matrix), at) else {
                return Err(TestCaseError::fail("the rows have an order"));
            };
            let (mut y, mut sizes) = ([7.0; LARGEST_DIMENSION], [3.0; LARGEST_DIMENSION]);
            let start = [0.5, -1.5, 2.0, 1.25];
            y[at..at + 4].copy_from_slice(&start);
            sizes[at..at + 4].copy_from_slice(&start.map(f64::abs));
            triangular.advance(3, &mut y, &mut sizes, time);
            let expected = summed(&matrix, start, time);
            let size = summed(&matrix.map(|row| row.map(f64::abs)), start.map(f64::abs), time);
            for n in 0..4 {
                prop_assert!((y[at + n] - expected[n]).abs() <= 1e-14 * size[n]);
                prop_assert!((sizes[at + n] - size[n]).abs() <= 1e-14 * size[n]);
            }
            prop_assert!(y[..at].iter().chain(&y[at + 4..]).all(|it| *it == 7.0));
        }
    }

    /// Rows that are each made of both have no order in which one could be moved first.
    #[test]
    fn a_circle_is_no_chain() {
        let matrix = [[1.0, -1.0], [1.0, -1.0]].map(|row| row.map(BigReal::exact).to_vec());
        assert!(SparseTriangular::<f64>::new(&matrix, 0).is_none());
    }
}
