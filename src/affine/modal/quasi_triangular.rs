//! Co-ordinates for eigenvalues that stay together, in which their matrix has a small logarithmic
//! norm: bounds of the motion, and of its errors, then grow little faster than the motion does.
//!
//! One eigenvalue after the other is split off, so that the matrix is triangular but for the
//! rotations of pairs. Then the later co-ordinates are measured in larger units, which makes as
//! small as is wanted what couples the earlier ones to them.

use super::matrix::{
    BigMatrix, identity, inverse, largest, null_space, product, row_times, shifted, transposed,
};
use super::polynomial::Eigenvalue;
use super::{Block, MIN_GAP, MIN_RELATIVE_GAP, factor, logarithmic_norm, norm, rotation};
use crate::affine::arithmetic::real::{BigComplex, BigReal};

/// Couplings below this part of the distances of eigenvalues let bounds grow no faster than the
/// beats of these.
const COUPLING_PER_SPREAD: f64 = 1.0 / 16.0;

/// Couplings below this part of the fastest rate are small enough.
const COUPLING_PER_RATE: f64 = 1.0 / 1024.0;

/// The exponent of two of the rounding that is left of a zero of the triangular matrix, relative to
/// its largest entry: it is far below half of the bits.
fn zero_exponent(matrix: &BigMatrix) -> isize {
    /// The bits that the invariant spaces of close eigenvalues lose.
    const SEPARATION_LOSS_BITS: isize = 20;
    SEPARATION_LOSS_BITS - matrix.first().map_or(0, |row| row[0].bits() as isize) / 2
}

/// A coupling that is smaller than this part of the largest would be among the roundings of others
/// in another basis, while an eigenvalue's direction may hang on it.
const MIN_COUPLING: f64 = 1e-14;

/// The largest condition number of a basis: beyond it too many digits are lost.
const MAX_CONDITION: f64 = 100.0;

/// The place of one eigenvalue's co-ordinates in the triangular matrix.
#[derive(Clone, Copy)]
struct Place {
    at: usize,
    size: usize,
    /// Whether the eigenvalue's diagonal block is a rate and a rotation.
    rotates: bool,
}

/// The block in quasi-triangular co-ordinates; none if its logarithmic norm is small already, or if
/// the precision does not separate the invariant spaces.
pub(super) fn triangular(block: &Block, cluster: &[Eigenvalue], time_scale: f64) -> Option<Block> {
    let wanted = wanted_couplings(cluster, time_scale);
    // Bounds of what decays are to decay nearly as fast.
    let decay = slowest_decay(cluster);
    let largest = if decay > 0.0 { -(1.0 - COUPLING_PER_SPREAD) * decay } else { wanted };
    let is_small = logarithmic_norm(&block.matrix) <= largest;
    if is_small || smallest_entry(&block.matrix) < MIN_COUPLING * norm(&block.matrix) {
        return None;
    }
    let (mut basis, places) = split_off(&block.matrix, cluster)?;
    let mut turned = in_basis(block, &basis)?;
    clear_below(&mut turned.matrix, &places)?;
    let roots = cluster.iter().flat_map(|it| std::iter::repeat_n(it, it.multiplicity));
    for (place, root) in places.iter().zip(roots).filter(|(place, _)| place.rotates) {
        let own = [0, 1].map(|i| [0, 1].map(|j| &turned.matrix[place.at + i][place.at + j]));
        let rotating = embedded(block.matrix.len(), place.at, &of_size_one(rotation(own, root)));
        basis = product(&basis, &rotating);
        turned = in_basis(&turned, &rotating)?;
        clear_below(&mut turned.matrix, &places)?;
    }
    if condition(&basis)? > MAX_CONDITION {
        return None;
    }
    let units = units(&turned.matrix, &places, wanted / block.matrix.len() as f64)?;
    Some(measured_in(turned, &units))
}

/// A basis, as columns, in which a matrix is triangular, eigenvalue by eigenvalue.
fn split_off(matrix: &BigMatrix, cluster: &[Eigenvalue]) -> Option<(BigMatrix, Vec<Place>)> {
    let size = matrix.len();
    let (mut basis, mut now) = (identity(size), matrix.clone());
    let mut places: Vec<Place> = Vec::new();
    for root in cluster.iter().flat_map(|it| std::iter::repeat_n(it, it.multiplicity)) {
        let at = places.last().map_or(0, |last| last.at + last.size);
        let rest: BigMatrix = now[at..].iter().map(|row| row[at..].to_vec()).collect();
        let invariant = invariant(&rest, root, norm(matrix))?;
        let turn = embedded(size, at, &complete_basis(&invariant)?);
        basis = product(&basis, &turn);
        now = product(&product(&inverse(&turn)?, &now), &turn);
        places.push(Place { at, size: invariant.len(), rotates: !root.is_real() && steep(root) });
    }
    Some((basis, places))
}

/// Whether a pair turns fast enough beside its size that its rotation is worth its own axes.
fn steep(root: &Eigenvalue) -> bool {
    root.value.im.to_f64() >= MIN_RELATIVE_GAP * root.value.norm().to_f64()
}

/// Vectors that span a space of an eigenvalue which the matrix, a part of one of this size, takes
/// into itself: one, or two of a pair.
fn invariant(matrix: &BigMatrix, root: &Eigenvalue, size: f64) -> Option<Vec<Vec<BigReal>>> {
    let mut annihilator = factor(matrix, root);
    let step = if root.is_real() { 1 } else { 2 };
    let own = BigReal::exact(size);
    let power = if step == 2 { &own * &own } else { own };
    let nothing = power.scaled(zero_exponent(matrix));
    let noise = annihilator.iter_mut().flatten().filter(|it| it.abs() <= nothing);
    noise.for_each(|it| *it = BigReal::zero());
    let nullities = (step..=matrix.len()).step_by(step);
    let space =
        nullities.map(|it| null_space(&annihilator, it, &BigReal::zero())).find_map(|it| it)?;
    let first: Vec<BigReal> = space.iter().map(|row| row[0].clone()).collect();
    if root.is_real() {
        return Some(vec![first]);
    }
    // Less its rate, a pair's matrix takes the one into the other, and that back into the one by
    // the square of its frequency.
    let turning = shifted(matrix, &-&root.value.re);
    let second = row_times(&first, &transposed(&turning));
    Some(vec![second, first])
}

/// A square matrix whose first columns are these, and whose others are unit vectors.
fn complete_basis(first: &[Vec<BigReal>]) -> Option<BigMatrix> {
    let size = first.first()?.len();
    let mut reduced: Vec<Vec<BigReal>> = first.to_vec();
    let mut taken = vec![false; size];
    for n in 0..reduced.len() {
        let largest = (0..size).filter(|i| !taken[*i]).max_by(|a, b| {
            let (a, b) = (reduced[n][*a].abs(), reduced[n][*b].abs());
            a.partial_cmp(&b).unwrap_or(std::cmp::Ordering::Equal)
        })?;
        taken[largest] = true;
        let (done, later) = reduced.split_at_mut(n + 1);
        let pivot = &done[n];
        for row in later {
            let share = &row[largest] / &pivot[largest];
            let entries = row.iter_mut().zip(pivot);
            entries.for_each(|(entry, other)| *entry = &*entry - &(&share * other));
        }
    }
    let mut columns = first.to_vec();
    let unit = identity(size);
    columns.extend((0..size).filter(|n| !taken[*n]).map(|n| unit[n].clone()));
    Some(transposed(&columns))
}

/// The smallest size of an entry that is not zero.
fn smallest_entry(matrix: &BigMatrix) -> f64 {
    let sizes = matrix.iter().flatten().map(|it| it.to_f64().abs());
    sizes.filter(|it| *it > 0.0).fold(f64::INFINITY, f64::min)
}

/// A condition number of a basis, whatever the units of its vectors and of their entries: the
/// largest sum of what a vector's entries become one by one.
fn condition(basis: &BigMatrix) -> Option<f64> {
    let back = inverse(basis)?;
    let costs = transposed(basis).into_iter().zip(&back).map(|(column, row)| {
        column.iter().zip(row).map(|(a, b)| (a * b).to_f64().abs()).sum::<f64>()
    });
    Some(costs.fold(0.0, f64::max))
}

/// A matrix times the power of two that makes its largest entry about one.
fn of_size_one(mut matrix: BigMatrix) -> BigMatrix {
    let power = libm::frexp(largest(&matrix).to_f64()).1 as isize;
    matrix.iter_mut().flatten().for_each(|it| *it = it.scaled(-power));
    matrix
}

/// The identity with a matrix in it from a place on.
fn embedded(size: usize, at: usize, matrix: &BigMatrix) -> BigMatrix {
    let mut whole = identity(size);
    for (row, own) in whole[at..].iter_mut().zip(matrix) {
        row[at..at + own.len()].clone_from_slice(own);
    }
    whole
}

/// The block on other columns: those of the basis, in the block's co-ordinates.
fn in_basis(block: &Block, basis: &BigMatrix) -> Option<Block> {
    let back = inverse(basis)?;
    Some(Block {
        columns: product(&block.columns, basis),
        rows: product(&back, &block.rows),
        matrix: product(&product(&back, &block.matrix), basis),
        ..block.clone()
    })
}

/// Sets the rounding below the diagonal blocks of a triangular matrix to zero; none if larger
/// entries stand there.
fn clear_below(matrix: &mut BigMatrix, places: &[Place]) -> Option<()> {
    // The entries may be beyond the exponents of f64.
    let nothing = largest(matrix).scaled(zero_exponent(matrix));
    for place in places {
        for row in &mut matrix[place.at + place.size..] {
            for entry in &mut row[place.at..place.at + place.size] {
                if entry.abs() > nothing {
                    return None;
                }
                *entry = BigReal::zero();
            }
        }
    }
    Some(())
}

/// The couplings at which bounds grow little faster than the motion. Where everything decays they
/// are far below the slowest rate, unless that is tiny, so that bounds decay nearly as fast.
fn wanted_couplings(cluster: &[Eigenvalue], time_scale: f64) -> f64 {
    let values = || cluster.iter().map(|it| &it.value);
    /// A share of the fastest rate below which a decay counts for none.
    const MIN_DECAY_SHARE: f64 = COUPLING_PER_RATE * COUPLING_PER_RATE;
    let decay = slowest_decay(cluster);
    let apart =
        |a: &BigComplex| -> Vec<f64> { values().map(|b| (a - b).norm().to_f64()).collect() };
    let spread = values().flat_map(apart).fold(0.0, f64::max);
    let fastest = values().map(|it| it.norm().to_f64()).fold(0.0, f64::max);
    let slow = COUPLING_PER_SPREAD * MIN_GAP / time_scale;
    if decay > MIN_DECAY_SHARE * fastest {
        return COUPLING_PER_RATE * decay;
    }
    decay.max(COUPLING_PER_SPREAD * spread).max(COUPLING_PER_RATE * fastest).max(slow)
}

/// The slowest rate at which a cluster decays; not positive where a part of it does not.
fn slowest_decay(cluster: &[Eigenvalue]) -> f64 {
    cluster.iter().map(|it| -it.value.re.to_f64()).fold(f64::INFINITY, f64::min)
}

/// Powers of two in which the co-ordinates are measured, so that the couplings of each to all
/// earlier ones are together below `small`.
fn units(matrix: &BigMatrix, places: &[Place], small: f64) -> Option<Vec<isize>> {
    let size = |i: usize, j: usize| matrix[i][j].to_f64().abs();
    let smaller = |coupling: f64, wanted: f64| -> Option<isize> {
        let power = if coupling > wanted { libm::log2(wanted / coupling).floor() } else { 0.0 };
        (power.is_finite() && power > -1000.0).then_some(power as isize)
    };
    let mut powers: Vec<isize> = Vec::new();
    for Place { at, size: width, rotates } in places.iter().copied() {
        let coupling = |j: usize, powers: &[isize]| {
            let parts = (0..at).map(|i| libm::scalbn(size(i, j), -powers[i] as i32));
            parts.sum::<f64>()
        };
        let whole: f64 = (at..at + width).map(|j| coupling(j, &powers)).sum();
        let power = smaller(whole, small)?;
        powers.push(power);
        if width == 2 {
            // The two axes of a pair that hardly rotates have different units, by their couplings.
            let [forth, back] = [size(at, at + 1), size(at + 1, at)];
            let own = if rotates { 0 } else { smaller(forth, small.max((forth * back).sqrt()))? };
            powers.push(power + own);
        }
    }
    Some(powers)
}

/// The block with each co-ordinate in a unit of its own, a power of two.
fn measured_in(mut block: Block, units: &[isize]) -> Block {
    for row in &mut block.columns {
        row.iter_mut().zip(units).for_each(|(it, unit)| *it = it.scaled(*unit));
    }
    for (row, unit) in block.rows.iter_mut().zip(units) {
        row.iter_mut().for_each(|it| *it = it.scaled(-unit));
    }
    for (row, own) in block.matrix.iter_mut().zip(units) {
        row.iter_mut().zip(units).for_each(|(it, unit)| *it = it.scaled(unit - own));
    }
    block
}
