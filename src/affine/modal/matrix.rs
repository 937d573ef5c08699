//! Matrices of wide numbers, as rows.

use crate::affine::arithmetic::real::BigReal;

pub type BigMatrix = Vec<Vec<BigReal>>;

pub fn identity(size: usize) -> BigMatrix {
    let entry = |same| if same { BigReal::one() } else { BigReal::zero() };
    (0..size).map(|i| (0..size).map(|j| entry(i == j)).collect()).collect()
}

pub fn product(a: &BigMatrix, b: &BigMatrix) -> BigMatrix {
    a.iter().map(|row| row_times(row, b)).collect()
}

pub fn row_times(row: &[BigReal], matrix: &BigMatrix) -> Vec<BigReal> {
    let columns = matrix.first().map_or(0, Vec::len);
    let mut sums = vec![BigReal::zero(); columns];
    for (factor, matrix_row) in row.iter().zip(matrix).filter(|(factor, _)| !factor.is_zero()) {
        for (sum, entry) in sums.iter_mut().zip(matrix_row) {
            *sum = &*sum + &(factor * entry);
        }
    }
    sums
}

/// `matrix + factor * identity`.
pub fn shifted(matrix: &BigMatrix, factor: &BigReal) -> BigMatrix {
    let mut shifted = matrix.clone();
    for (n, row) in shifted.iter_mut().enumerate() {
        row[n] = &row[n] + factor;
    }
    shifted
}

pub fn transposed(matrix: &BigMatrix) -> BigMatrix {
    let columns = matrix.first().map_or(0, Vec::len);
    (0..columns).map(|j| matrix.iter().map(|row| row[j].clone()).collect()).collect()
}

/// The largest size of an entry.
pub fn largest(matrix: &BigMatrix) -> BigReal {
    let larger = |a: BigReal, b: BigReal| if a < b { b } else { a };
    matrix.iter().flatten().map(BigReal::abs).fold(BigReal::zero(), larger)
}

/// Eliminates with complete pivoting, and gives the right null space as columns, each with a 1 in a
/// row of its own; none if the rank is another one than said. Entries below `noise` are rounding.
pub fn null_space(matrix: &BigMatrix, nullity: usize, noise: &BigReal) -> Option<BigMatrix> {
    let mut rows = matrix.clone();
    let size = rows.len();
    let rank = size.checked_sub(nullity)?;
    let mut order: Vec<usize> = (0..size).collect();
    // The rounding that elimination leaves of a zero is far below half of the bits.
    let largest = largest(&rows);
    let nothing = &largest.scaled(-(largest.bits() as isize) / 2) + noise;
    for step in 0..size {
        let (size_of_pivot, at, column) = pivot(&rows, step)?;
        let is_nothing = size_of_pivot < nothing || size_of_pivot.is_zero();
        if is_nothing != (step >= rank) {
            return None;
        }
        if is_nothing {
            break;
        }
        rows.swap(step, at);
        rows.iter_mut().for_each(|row| row.swap(step, column));
        order.swap(step, column);
        eliminate(&mut rows, step);
    }
    let mut columns = vec![vec![BigReal::zero(); nullity]; size];
    for free in 0..nullity {
        columns[order[rank + free]][free] = BigReal::one();
        for (step, row) in rows.iter().enumerate().take(rank) {
            columns[order[step]][free] = -&row[rank + free];
        }
    }
    Some(columns)
}

/// The largest entry that is not eliminated yet, with its row and column.
fn pivot(rows: &BigMatrix, step: usize) -> Option<(BigReal, usize, usize)> {
    let mut best: Option<(BigReal, usize, usize)> = None;
    for (at, row) in rows.iter().enumerate().skip(step) {
        for (column, entry) in row.iter().enumerate().skip(step) {
            let size = entry.abs();
            if best.as_ref().is_none_or(|(most, ..)| *most < size) {
                best = Some((size, at, column));
            }
        }
    }
    best
}

/// Makes the pivot 1, and the rest of its column 0.
fn eliminate(rows: &mut BigMatrix, step: usize) {
    let pivot = rows[step][step].clone();
    rows[step].iter_mut().for_each(|entry| *entry = &*entry / &pivot);
    let pivot_row = rows[step].clone();
    for (n, row) in rows.iter_mut().enumerate() {
        let factor = row[step].clone();
        if n == step || factor.is_zero() {
            continue;
        }
        for (entry, other) in row.iter_mut().zip(&pivot_row) {
            *entry = &*entry - &(&factor * other);
        }
    }
}

/// The inverse of a small matrix, by the same elimination with rows' pivots; none if it has none.
pub fn inverse(matrix: &BigMatrix) -> Option<BigMatrix> {
    let size = matrix.len();
    let mut rows: BigMatrix = matrix.clone();
    for (row, unit) in rows.iter_mut().zip(identity(size)) {
        row.extend(unit);
    }
    for step in 0..size {
        let best = (step..size).max_by(|a, b| {
            let (a, b) = (rows[*a][step].abs(), rows[*b][step].abs());
            a.partial_cmp(&b).unwrap_or(std::cmp::Ordering::Equal)
        })?;
        rows.swap(step, best);
        if rows[step][step].is_zero() {
            return None;
        }
        eliminate(&mut rows, step);
    }
    Some(rows.into_iter().map(|row| row[size..].to_vec()).collect())
}

/// exp(B 2^exponent), where |B 2^exponent| is at most 1/2, to all bits but some more than their
/// number's root: a Taylor series of a small part of it, squared again and again.
pub fn exponential(matrix: &[Vec<BigReal>], exponent: isize) -> BigMatrix {
    let bits = matrix.first().map_or(0, |row| row[0].bits());
    // Squarings and terms are about as many.
    let squarings = bits.isqrt();
    let small = exponent - squarings as isize;
    let scaled: BigMatrix =
        matrix.iter().map(|row| row.iter().map(|it| it.scaled(small)).collect()).collect();
    let mut power = identity(matrix.len());
    // Each term is below 2^-(squarings + 1) of the one before it.
    for k in (1..=bits / (squarings + 1) + 1).rev() {
        let factor = BigReal::exact(k as f64);
        power = product(&scaled, &power);
        power.iter_mut().flatten().for_each(|it| *it = &*it / &factor);
        power = shifted(&power, &BigReal::one());
    }
    (0..squarings).fold(power, |power, _| product(&power, &power))
}

/// The first, second, ... power of a matrix.
pub fn multiples(matrix: &BigMatrix, count: usize) -> Vec<BigMatrix> {
    let next = |last: &BigMatrix| Some(product(last, matrix));
    std::iter::successors(Some(matrix.clone()), next).take(count).collect()
}
