//! The multipliers of an orbit: the eigenvalues of the product of its returns' derivatives.
//!
//! A derivative that an event makes singular leaves a space of fewer dimensions, which the returns
//! that follow carry into each other. The product is taken on that space; along every other
//! direction the multiplier is zero. It is computed exactly from the rounded factors, so that what
//! decays is not lost among the roundings of what grows.

use crate::affine::modal::spectrum;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::Row;

/// A matrix by its columns, or a space by orthonormal vectors.
type Columns = Vec<Vec<f64>>;

/// A direction of which a return leaves a smaller share, beside its largest growth, is gone: sums
/// of twelve products have as many roundings, and events make some of them.
const MIN_DIRECTION_SHARE: f64 = 1e-12;

/// Directions of a space that agree with one of it to within this are that one: the errors of a
/// direction that many returns have carried.
const ALIGNMENT_TOLERANCE: f64 = 1e-7;

/// The most exact factors: the digits of their product are as many as those of all together.
const MAX_FACTORS: usize = 16;

/// The multipliers of an orbit, largest modulus first, as many as states: `returns` are the
/// derivatives at fixed times, by columns, in units in which states are of size one. Of an
/// autonomous system `flow` is the direction of the motion at the first point, in these units,
/// which a section removes.
pub fn multipliers(returns: &[Columns], flow: Option<&[f64]>) -> Option<Vec<[f64; 2]>> {
    let states = returns.first()?.len();
    let mut space: Columns = (0..states).map(|n| unit(states, n)).collect();
    // Twice around: what the last returns annihilate is gone from the first point, too.
    for matrix in returns.iter().chain(returns) {
        let carried = space.iter().map(|it| product(matrix, it)).collect();
        let largest = size(matrix);
        space = orthonormal(carried, MIN_DIRECTION_SHARE * largest);
    }
    if let Some(flow) = flow {
        let scale = norm(flow);
        let along: Vec<f64> = flow.iter().map(|it| it / scale).collect();
        let mut all = vec![along];
        all.extend(space);
        space = orthonormal(all, ALIGNMENT_TOLERANCE).split_off(1);
    }
    let mut values = if space.is_empty() {
        Vec::new()
    } else {
        spectrum(&product_of_returns(returns, &space)?)?
    };
    values.resize(states, [0.0; 2]);
    let modulus = |[re, im]: &[f64; 2]| libm::hypot(*re, *im);
    values.sort_by(|a, b| modulus(b).total_cmp(&modulus(a)).then(b[1].total_cmp(&a[1])));
    Some(values)
}

/// The product of all returns on a space, in its own co-ordinates, exactly.
fn product_of_returns(returns: &[Columns], space: &Columns) -> Option<Vec<Row>> {
    let share = returns.len().div_ceil(MAX_FACTORS);
    let factors = returns.chunks(share).map(|chunk| {
        let mut factor = chunk[0].clone();
        for matrix in &chunk[1..] {
            factor = factor.iter().map(|it| product(matrix, it)).collect();
        }
        factor
    });
    let mut images = exact(space)?;
    for factor in factors {
        let factor = exact(&factor)?;
        images = images.iter().map(|it| exact_product(&factor, it)).collect();
    }
    let basis = exact(space)?;
    // A basis is orthonormal but for rounding, which its Gram matrix would take away.
    let row = |own: &Row| images.iter().map(|image| exact_dot(own, image)).collect();
    Some(basis.iter().map(row).collect())
}

fn exact(columns: &Columns) -> Option<Vec<Row>> {
    let column = |it: &Vec<f64>| it.iter().map(|it| Rational::try_from(*it).ok()).collect();
    columns.iter().map(column).collect()
}

fn exact_dot(a: &Row, b: &Row) -> Rational {
    a.iter().zip(b).fold(Rational::ZERO, |sum, (a, b)| sum + a * b)
}

fn exact_product(matrix: &[Row], vector: &Row) -> Row {
    let entry = |n: usize| {
        let terms = matrix.iter().zip(vector);
        terms.fold(Rational::ZERO, |sum, (column, factor)| sum + &column[n] * factor)
    };
    (0..vector.len()).map(entry).collect()
}

/// The product of a matrix, by columns, and a vector.
fn product(matrix: &Columns, vector: &[f64]) -> Vec<f64> {
    let entry = |n: usize| matrix.iter().zip(vector).map(|(column, it)| column[n] * it).sum();
    (0..vector.len()).map(entry).collect()
}

/// Orthonormal vectors of the space of these, without those that others leave no more of than
/// `gone`.
pub(in crate::affine) fn orthonormal(columns: Columns, gone: f64) -> Columns {
    let mut found: Columns = Vec::new();
    for mut column in columns {
        // Once more, because the first time leaves the roundings of what it takes away.
        for _ in 0..2 {
            for other in &found {
                let share: f64 = column.iter().zip(other).map(|(a, b)| a * b).sum();
                column.iter_mut().zip(other).for_each(|(it, other)| *it -= share * other);
            }
        }
        let length = norm(&column);
        if length > gone {
            found.push(column.iter().map(|it| it / length).collect());
        }
    }
    found
}

fn unit(size: usize, place: usize) -> Vec<f64> {
    (0..size).map(|n| if n == place { 1.0 } else { 0.0 }).collect()
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|it| it * it).sum::<f64>().sqrt()
}

/// The largest size of a matrix's columns.
fn size(matrix: &Columns) -> f64 {
    matrix.iter().map(|it| norm(it)).fold(0.0, f64::max)
}
