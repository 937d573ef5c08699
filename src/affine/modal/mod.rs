//! A mode's matrix, taken apart into blocks that do not act on each other.
//!
//! With columns X and rows W of a block, W X = 1 and M X = X B, the motion is the sum over the
//! blocks of X exp(B t) W z. Eigenvalues that are so close to each other that their
//! eigenvectors nearly coincide stay together in one block. This is done once a mode, in numbers of
//! several hundred bits.
//!
//! [`components`] are entries of z that do not depend on others, each with a matrix of their own.
//! [`polynomial`] finds the eigenvalues, which are the [`roots`] of its factors; those of more than
//! two roots are iterated by [`aberth`]. This file makes blocks of them, with the products,
//! inverses and null spaces of [`matrix`]. [`quasi_triangular`] chooses the co-ordinates of
//! eigenvalues that stay together. Read this file first.

mod aberth;
mod components;
mod matrix;
mod polynomial;
mod quasi_triangular;
mod roots;

use self::components::components;
use self::matrix::{
    BigMatrix, identity, inverse, largest, null_space, product, shifted, transposed,
};
pub(super) use self::matrix::{exponential, multiples, row_times};
use self::polynomial::{Eigenvalue, eigenvalues};
use self::quasi_triangular::triangular;
use crate::affine::arithmetic::real::{BigReal, bits_for};
use crate::affine::model::rational::Rational;
use crate::affine::model::system::Row;
use crate::numeric::number::{Bound, ScaledF64};

/// Eigenvalues stay together if their distance is below this share of the larger one: the
/// projectors of others are then at most some tens in size.
const MIN_RELATIVE_GAP: f64 = 0.125;

/// Eigenvalues stay together if their distance times the system's unit of time is below this:
/// over such a time their exponentials are nearly alike.
const MIN_GAP: f64 = 0.05;

/// The bits between the last and the rounding that is left of a zero of a block, relative to the
/// terms of the block's largest entry.
const ZERO_ROUNDING_BITS: isize = 140;

/// A factor for the growth of residuals by the errors of a block's columns and rows: 2^40.
const RESIDUAL_GROWTH_BITS: isize = 40;

/// Entries of a mode whose sizes differ by less than this power of two are left as they are.
const MIN_SPREAD_BITS: isize = 100;

/// The kind of a block, by its eigenvalues.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// One simple real eigenvalue.
    Real(BigReal),
    /// One pair of simple eigenvalues: rate and frequency; B = ((rate, frequency), (-frequency,
    /// rate)).
    Pair(BigReal, BigReal),
    /// One multiple real eigenvalue r, for which B - r is nilpotent.
    Nilpotent(BigReal),
    /// Eigenvalues that are close to each other.
    Cluster,
}

/// A block of a mode's matrix, with its columns X, its rows W and its own matrix B.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub kind: Kind,
    /// The matrix X, as rows.
    pub columns: BigMatrix,
    /// The matrix W.
    pub rows: BigMatrix,
    /// The matrix B.
    pub matrix: BigMatrix,
    /// Bounds of the errors of the entries of X and of W.
    pub errors: [Vec<Vec<ScaledF64>>; 2],
}

impl Block {
    /// The largest rate at which the co-ordinates move, relative to their sizes and to the largest
    /// part of a state that each of them makes: where a basis keeps couplings small, some
    /// co-ordinates are large beside what they add to a state.
    pub fn speed(&self) -> f64 {
        let largest = |n: usize| {
            let entries = self.columns.iter().map(|row| row[n].to_f64().abs());
            entries.fold(0.0, f64::max)
        };
        let parts: Vec<f64> = (0..self.matrix.len()).map(largest).collect();
        let rate = |(row, own): (&Vec<BigReal>, &f64)| {
            let moves = row.iter().zip(&parts).filter(|(entry, _)| !entry.is_zero());
            moves.map(|(entry, part)| entry.to_f64().abs() * (own / part)).sum::<f64>()
        };
        self.matrix.iter().zip(&parts).map(rate).fold(norm(&self.matrix), f64::max)
    }

    /// Whether the co-ordinates from this one on do not depend on those before it.
    pub fn moves_alone_from(&self, first: usize) -> bool {
        self.matrix[first..].iter().all(|row| row[..first].iter().all(BigReal::is_zero))
    }
}

/// The eigenvalues of a matrix, real and imaginary part, each as often as it is one; none if the
/// iteration does not converge.
pub(super) fn spectrum(matrix: &[Row]) -> Option<Vec<[f64; 2]>> {
    let both = |it: Eigenvalue| {
        let [re, im] = [&it.value.re, &it.value.im].map(BigReal::to_f64);
        let values = if it.is_real() { vec![[re, 0.0]] } else { vec![[re, im], [re, -im]] };
        std::iter::repeat_n(values, it.multiplicity).flatten()
    };
    Some(eigenvalues(matrix, bits_for::<f64>())?.into_iter().flat_map(both).collect())
}

/// The blocks of a matrix, in numbers of so many bits. Entries of z that do not depend on each
/// other are taken apart by themselves, so that no closeness of eigenvalues joins them.
pub(super) fn blocks(exact: &[Row], time_scale: f64, bits: usize) -> Vec<Block> {
    let embedded = |part: &Vec<usize>| {
        let row = |i: &usize| part.iter().map(|j| exact[*i][*j].clone()).collect();
        let own: Vec<Row> = part.iter().map(row).collect();
        let blocks = connected_blocks(&own, time_scale, bits).into_iter();
        blocks.map(|it| it.embedded(part, exact.len())).collect::<Vec<_>>()
    };
    components(exact).iter().flat_map(embedded).collect()
}

/// The blocks of a matrix of coupled entries: it stays whole if it cannot be taken apart at this
/// precision.
fn connected_blocks(exact: &[Row], time_scale: f64, bits: usize) -> Vec<Block> {
    let scales = scales(exact);
    let scaled = |(i, row): (usize, &Row)| -> Vec<BigReal> {
        let entries = row.iter().zip(&scales);
        entries.map(|(it, scale)| BigReal::new(it, bits).scaled(scale - scales[i])).collect()
    };
    let matrix: BigMatrix = exact.iter().enumerate().map(scaled).collect();
    let taken_apart = |roots: Vec<Eigenvalue>| -> Option<Vec<_>> {
        let clusters = clusters(roots, time_scale);
        clusters.iter().map(|it| block(&matrix, it, time_scale)).collect()
    };
    let blocks = eigenvalues(exact, bits)
        .and_then(taken_apart)
        .unwrap_or_else(|| vec![whole_block(&matrix)]);
    let spread = error_spread(&blocks);
    let finished = |it| unscaled(measured(it, &matrix, time_scale, &spread), &scales);
    blocks.into_iter().map(finished).collect()
}

/// `row * columns * matrix^k` of a block for k from 0 to `count` - 1: a row's derivatives.
pub(super) fn derivatives(row: &[BigReal], block: &Block, count: usize) -> Vec<Vec<BigReal>> {
    let first = row_times(row, &block.columns);
    let next = |last: &Vec<BigReal>| Some(row_times(last, &block.matrix));
    std::iter::successors(Some(first), next).take(count).collect()
}

/// A block of the scaled matrix as one of the matrix itself.
fn unscaled(mut block: Block, scales: &[isize]) -> Block {
    for (row, scale) in block.columns.iter_mut().zip(scales) {
        row.iter_mut().for_each(|it| *it = it.scaled(*scale));
    }
    for row in &mut block.rows {
        row.iter_mut().zip(scales).for_each(|(it, scale)| *it = it.scaled(-scale));
    }
    let [columns, rows] = &mut block.errors;
    for (row, scale) in columns.iter_mut().zip(scales) {
        row.iter_mut().for_each(|it| *it = it.scaled(*scale as i64));
    }
    for row in rows {
        row.iter_mut().zip(scales).for_each(|(it, scale)| *it = it.scaled(-*scale as i64));
    }
    block
}

/// The sum over all blocks of the sizes of X W, by which an error in one entry spreads to others.
fn error_spread(blocks: &[Block]) -> Vec<Vec<ScaledF64>> {
    let sizes = |it: &BigMatrix| -> Vec<Vec<ScaledF64>> {
        it.iter().map(|row| row.iter().map(|it| it.bound::<ScaledF64>().abs()).collect()).collect()
    };
    let parts: Vec<_> = blocks.iter().map(|it| (sizes(&it.columns), sizes(&it.rows))).collect();
    let width = parts.first().map_or(0, |(columns, _)| columns.len());
    let mut spread = vec![vec![ScaledF64::ZERO; width]; width];
    for (columns, rows) in &parts {
        for (sums, row) in spread.iter_mut().zip(spread_by(columns, rows)) {
            sums.iter_mut().zip(row).for_each(|(sum, term): (&mut ScaledF64, _)| *sum += term);
        }
    }
    spread
}

/// A product of matrices that are not negative, in which zero times infinity is zero.
fn spread_by(a: &[Vec<ScaledF64>], b: &[Vec<ScaledF64>]) -> Vec<Vec<ScaledF64>> {
    let width = b.first().map_or(0, Vec::len);
    let entry = |row: &Vec<ScaledF64>, j: usize| {
        let terms = row.iter().zip(b).map(|(a, b)| (*a, b[j]));
        terms.filter(|(a, b)| *a != 0.0 && *b != 0.0).map(|(a, b)| a * b).sum()
    };
    a.iter().map(|row| (0..width).map(|j| entry(row, j)).collect()).collect()
}

/// A block with bounds of the errors of its columns and rows: the residuals M X - X B and W M - B W
/// come from parts in other blocks, and are divided by the distance of their eigenvalues.
fn measured(
    mut block: Block,
    matrix: &BigMatrix,
    time_scale: f64,
    spread: &[Vec<ScaledF64>],
) -> Block {
    let Block { columns, rows, matrix: inner, .. } = &block;
    let nearest = (MIN_RELATIVE_GAP * norm(inner)).max(MIN_GAP / time_scale);
    let factor = libm::exp2(RESIDUAL_GROWTH_BITS as f64) / nearest;
    let difference = |a: BigMatrix, b: BigMatrix| -> Vec<Vec<ScaledF64>> {
        let size = |(a, b): (&BigReal, &BigReal)| (a - b).bound::<ScaledF64>().abs() * factor;
        a.iter().zip(&b).map(|(a, b)| a.iter().zip(b).map(size).collect()).collect()
    };
    let left = difference(product(matrix, columns), product(columns, inner));
    let right = difference(product(rows, matrix), product(inner, rows));
    block.errors = [spread_by(spread, &left), spread_by(&right, spread)];
    block
}

fn whole_block(matrix: &BigMatrix) -> Block {
    let unit = identity(matrix.len());
    let errors = [Vec::new(), Vec::new()];
    Block { kind: Kind::Cluster, columns: unit.clone(), rows: unit, matrix: matrix.clone(), errors }
}

/// Clusters of eigenvalues, in each of which small distances connect all members.
fn clusters(roots: Vec<Eigenvalue>, time_scale: f64) -> Vec<Vec<Eigenvalue>> {
    let mut clusters: Vec<Vec<Eigenvalue>> = Vec::new();
    for root in roots {
        let near =
            |cluster: &Vec<Eigenvalue>| cluster.iter().any(|it| are_close(it, &root, time_scale));
        let (joined, apart): (Vec<_>, Vec<_>) = clusters.into_iter().partition(near);
        clusters = apart;
        clusters.push(joined.into_iter().flatten().chain([root]).collect());
    }
    clusters
}

/// Whether two eigenvalues, or the one and the other's conjugate, are close.
fn are_close(a: &Eigenvalue, b: &Eigenvalue, time_scale: f64) -> bool {
    let gap = (&a.value - &b.value).norm().to_f64();
    is_close(gap, a, b, time_scale)
}

fn is_close(gap: f64, a: &Eigenvalue, b: &Eigenvalue, time_scale: f64) -> bool {
    let larger = a.value.norm().to_f64().max(b.value.norm().to_f64());
    gap < MIN_RELATIVE_GAP * larger || gap * time_scale < MIN_GAP
}

fn block(matrix: &BigMatrix, cluster: &[Eigenvalue], time_scale: f64) -> Option<Block> {
    let dimensions = cluster.iter().map(Eigenvalue::dimensions).sum();
    let (mut annihilator, mut size) = (identity(matrix.len()), BigReal::one());
    for root in cluster {
        let factor = factor(matrix, root);
        // Terms of the factor may cancel.
        let term = &largest(matrix) + &root.value.norm();
        let own = if root.is_real() { term } else { &term * &term };
        for _ in 0..root.multiplicity {
            (annihilator, size) = (product(&annihilator, &factor), &size * &own);
        }
    }
    // Where the factors annihilate all, only their rounding is left.
    let rounding = size.scaled(ZERO_ROUNDING_BITS - size.bits() as isize);
    let columns = null_space(&annihilator, dimensions, &rounding)?;
    let left = transposed(&null_space(&transposed(&annihilator), dimensions, &rounding)?);
    let rows = product(&inverse(&product(&left, &columns))?, &left);
    let mut inner = product(&product(&rows, matrix), &columns);
    let nothing = noise(matrix, [&columns, &rows], &inner);
    inner
        .iter_mut()
        .flatten()
        .filter(|it| it.abs() <= nothing)
        .for_each(|it| *it = BigReal::zero());
    let errors = [Vec::new(), Vec::new()];
    let block = Block { kind: Kind::Cluster, columns, rows, matrix: inner, errors };
    let block = with_kind(block, cluster);
    let of_several = matches!(block.kind, Kind::Cluster).then_some(&block);
    Some(of_several.and_then(|it| triangular(it, cluster, time_scale)).unwrap_or(block))
}

/// A bound of the rounding that is left of a zero of a block's matrix W M X, from the difference of
/// W M and that matrix times W.
fn noise(matrix: &BigMatrix, [columns, rows]: [&BigMatrix; 2], inner: &BigMatrix) -> BigReal {
    let sizes = |it: &BigMatrix| -> BigMatrix {
        it.iter().map(|row| row.iter().map(BigReal::abs).collect()).collect()
    };
    let (moved, taken) = (product(rows, matrix), product(inner, rows));
    let difference: BigMatrix = moved
        .iter()
        .zip(&taken)
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect())
        .collect();
    let terms = product(&product(&sizes(rows), &sizes(matrix)), &sizes(columns));
    let left = product(&difference, &sizes(columns));
    let largest_term = largest(&terms);
    let last = -(largest_term.bits() as isize);
    &largest_term.scaled(last + ZERO_ROUNDING_BITS) + &largest(&left).scaled(RESIDUAL_GROWTH_BITS)
}

/// Powers of two, one for each entry of z, by which a matrix is scaled so that its entries become
/// more alike: entry i is measured in 2 to the power i. Without them a small coupling would look
/// like the rounding of a large one. Nothing is scaled where all sizes are alike.
fn scales(exact: &[Row]) -> Vec<isize> {
    /// The number of times that all entries are scaled once more.
    const MAX_ROUNDS: usize = 64;
    let power = |number: &Rational| -> Option<isize> {
        let exponent = libm::frexp(number.to_f64()).1;
        (!number.is_zero()).then_some(exponent as isize)
    };
    let powers: Vec<Vec<Option<isize>>> =
        exact.iter().map(|row| row.iter().map(power).collect()).collect();
    let all = || powers.iter().flatten().flatten();
    let mut scales = vec![0; exact.len()];
    let (Some(least), Some(most)) = (all().min(), all().max()) else { return scales };
    if most - least < MIN_SPREAD_BITS {
        return scales;
    }
    for _ in 0..MAX_ROUNDS {
        let before = scales.clone();
        for n in 0..exact.len() {
            let others = || (0..exact.len()).filter(|k| *k != n);
            let row = others().filter_map(|k| Some(powers[n][k]? + scales[k] - scales[n])).max();
            let column = others().filter_map(|k| Some(powers[k][n]? + scales[n] - scales[k])).max();
            // An entry on which no other depends, or that as 1 depends on none, has one side alone.
            scales[n] += match (row, column) {
                (Some(row), Some(column)) => (row - column) / 2,
                (Some(row), None) => row,
                (None, Some(column)) => -column,
                (None, None) => 0,
            };
        }
        if scales == before {
            break;
        }
    }
    scales
}

/// The factor (M - root) of a real root, or (M - root)(M - conjugate) of a pair.
fn factor(matrix: &BigMatrix, root: &Eigenvalue) -> BigMatrix {
    if root.is_real() {
        return shifted(matrix, &-&root.value.re);
    }
    let twice = -&(&root.value.re + &root.value.re);
    shifted(&product(matrix, &shifted(matrix, &twice)), &root.value.norm_square())
}

/// The block in the form of the kind that its eigenvalues have.
fn with_kind(mut block: Block, cluster: &[Eigenvalue]) -> Block {
    let [root] = cluster else { return block };
    if root.is_real() {
        let rate = root.value.re.clone();
        block.kind = if root.multiplicity == 1 { Kind::Real(rate) } else { Kind::Nilpotent(rate) };
        return block;
    }
    let steep =
        (&root.value.im + &root.value.im).to_f64() >= MIN_RELATIVE_GAP * root.value.norm().to_f64();
    if root.multiplicity > 1 || !steep {
        return block;
    }
    rotating(&block, root).unwrap_or(block)
}

/// Columns on which the matrix of a pair is ((rate, frequency), (-frequency, rate)): the real and
/// the imaginary part of an eigenvector.
fn rotation([[p, q], [r, s]]: [[&BigReal; 2]; 2], root: &Eigenvalue) -> BigMatrix {
    let (rate, frequency) = (&root.value.re, &root.value.im);
    let zero = BigReal::zero();
    if q.abs() >= r.abs() {
        vec![vec![q.clone(), zero], vec![rate - p, frequency.clone()]]
    } else {
        vec![vec![rate - s, frequency.clone()], vec![r.clone(), zero]]
    }
}

/// The block of a pair of eigenvalues, in co-ordinates in which it only rotates and decays or
/// grows.
fn rotating(block: &Block, root: &Eigenvalue) -> Option<Block> {
    let (rate, frequency) = (&root.value.re, &root.value.im);
    let turned = rotation([0, 1].map(|i| [0, 1].map(|j| &block.matrix[i][j])), root);
    let columns = product(&block.columns, &turned);
    let rows = product(&inverse(&turned)?, &block.rows);
    let matrix = vec![vec![rate.clone(), frequency.clone()], vec![-frequency, rate.clone()]];
    let kind = Kind::Pair(rate.clone(), frequency.clone());
    let errors = [Vec::new(), Vec::new()];
    Some(Block { kind, columns, rows, matrix, errors })
}

/// The largest row sum of a matrix.
pub(super) fn norm(matrix: &[Vec<BigReal>]) -> f64 {
    let sums = matrix.iter().map(|row| row.iter().map(|it| it.to_f64().abs()).sum());
    sums.fold(0.0, f64::max)
}

/// A bound of a matrix's logarithmic norm, by the rows of its symmetric part.
pub(super) fn logarithmic_norm(matrix: &[Vec<BigReal>]) -> f64 {
    let entry = |i: usize, j: usize| matrix[i][j].to_f64();
    let row = |i: usize| {
        let others = (0..matrix.len()).filter(|j| *j != i);
        entry(i, i) + others.map(|j| 0.5 * (entry(i, j) + entry(j, i)).abs()).sum::<f64>()
    };
    (0..matrix.len()).map(row).fold(f64::NEG_INFINITY, f64::max)
}
