//! The length of a piece on which a guard's sign is proved, and the blocks that are only enclosed
//! there.
//!
//! A piece is as long as the eighth derivative allows (`hull.rs`). Of blocks that move much faster
//! than the rest and are small relative to the guard, only bounds are used: a part exp(-r s) c is
//! below its chord if c > 0, and below its right end if c < 0; any other part is below its norm.
//! What is left is slow, and pieces of it are long. Where that leaves only a constant, the piece
//! has no end.

use super::hull::{self, Lengths, SignOnPiece};
use crate::affine::arithmetic::vector::Vector;
use crate::affine::closed_form::bound::BlockGrowth;
use crate::affine::guards::point::{Ends, GuardedPoint, GuardedSegment};
use crate::affine::guards::row::{ModalRow, RowPart};
use crate::affine::guards::track::{Track, outward};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::crossing::certificate::REMAINDER_DIVISOR;
use crate::numeric::number::{Bound, Number};

/// The share of a guard's size that the remainder of a piece may have.
const MAX_REMAINDER: f64 = 3e-2;

/// Fast blocks may be enclosed instead of expanded only if at least this share of the guard's size
/// remains between guard and zero.
const MIN_CLEARANCE: f64 = 0.25;

/// The clearance that suffices where all but a constant is enclosed, as a share of the guard's
/// size: rounding is far below it.
const MIN_CONSTANT_CLEARANCE: f64 = 1e-3;

/// The share of its largest part that a guard near zero is taken to have.
const MIN_RELATIVE_SIZE: f64 = 1e-3;

/// The factor by which a part is raised against its rounding.
const OUTWARD_FACTOR: f64 = 1.0 + 1e-12;

/// The lengths of pieces on which a guard's sign may be proved.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reach {
    /// The number of blocks, the fastest first, that are only enclosed.
    cut: usize,
    /// The length of a piece with these blocks enclosed.
    pub length: f64,
    /// The length of a piece with no block enclosed.
    whole: f64,
}

impl<T: Number> GuardedSegment<'_, T> {
    /// The length of a guard's next piece, from a point on.
    #[inline]
    pub(super) fn reach(
        &self,
        n: usize,
        track: &Track,
        left: &GuardedPoint<T>,
        longest: f64,
    ) -> Reach {
        let row = &self.rows[n];
        let orders = outward(&left.orders[n], track).map(Number::bound);
        let rests = eighths(row, left, longest);
        let whole = match track.zeros {
            0..=2 => length(&orders, rests[0], track.zeros, || row.size(&left.modal.y)),
            zeros => length_after(row.order(zeros, &left.modal).0.bound(), zeros, rests[0]),
        };
        let whole = whole.min(longest);
        let mut reach = Reach { cut: 0, length: whole, whole };
        if track.zeros == 0 && whole < longest {
            enclose(row, track, left, (orders[0], &rests, longest), &mut reach);
        }
        if reach.length == f64::INFINITY {
            let orders =
                outward(&row.first_orders(&left.modal.y, row.first_column(reach.cut)), track);
            let orders = orders.map(Number::bound);
            reach.length = polynomial_reach(&orders, track.zeros, left.slack[n]);
            reach.whole = reach.whole.min(reach.length);
        }
        reach
    }

    /// The sign of a guard on a piece.
    #[inline]
    pub(super) fn sign_on_piece(
        &self,
        n: usize,
        track: &Track,
        reach: &Reach,
        ends: &Ends<T>,
        lengths: &Lengths<T>,
    ) -> SignOnPiece {
        let Ends { left, right, .. } = ends;
        let row = &self.rows[n];
        let length = lengths.length.to_f64();
        let cut = if length <= reach.whole { 0 } else { reach.cut };
        let mut slack = left.slack[n].max(right.slack[n]);
        if !self.is_by_series(n, right.time.to_f64()) {
            slack += self.margin * self.derivatives(row, left, cut, length);
        }
        if cut == 0 {
            let orders = [outward(&left.orders[n], track), outward(&right.orders[n], track)];
            let eighth = eighth(row, track, left, 0, length);
            return hull::sign_on_piece(
                &orders,
                lengths,
                eighth,
                [T::Bound::ZERO; 2],
                slack,
                track.zeros,
            );
        }
        let raise = raise(row, track, ends, cut);
        let from = row.first_column(cut);
        let orders = [left, right].map(|it| outward(&row.first_orders(&it.modal.y, from), track));
        let eighth = eighth(row, track, left, cut, length);
        hull::sign_on_piece(&orders, lengths, eighth, raise, slack, track.zeros)
    }

    /// The sum of the sizes of the derivatives' terms, as far as a coefficient of a hull has them:
    /// the third and fourth have most, 3/7 L, L^2/14 and L^3/210 of the first three.
    #[inline]
    fn derivatives(
        &self,
        row: &ModalRow<T>,
        at: &GuardedPoint<T>,
        cut: usize,
        length: f64,
    ) -> T::Bound {
        let size = |part: &RowPart<T::Bound>| {
            // Zeros contribute nothing, even where their factors overflow.
            let sizes =
                at.modal.sizes[self.flow.subspaces[part.subspace].range.clone()].iter().copied();
            let sizes: T::Bound = sizes.sum();
            if sizes == 0.0 {
                return T::Bound::ZERO;
            }
            let norm = |k: usize| sizes * part.growth.bound(&part.norms, k, length);
            let slope = norm(1) * (3.0 / 7.0);
            (slope + (norm(2) / 14.0 + norm(3) * length / 210.0) * length) * length
        };
        row.parts[cut..].iter().map(size).sum()
    }
}

/// Encloses as many blocks as make the piece longest.
#[inline]
fn enclose<T: Number>(
    row: &ModalRow<T>,
    track: &Track,
    left: &GuardedPoint<T>,
    (begin, rests, longest): (T::Bound, &Vector<T::Bound>, f64),
    reach: &mut Reach,
) {
    /// The largest ratio of a new rest to the best that is worth another reach: a larger one makes
    /// a piece longer by less than a third.
    const MAX_REST_RATIO: f64 = 0.1;
    let (mut value, mut best) = (begin, rests[0]);
    for (k, part) in row.parts.iter().enumerate() {
        let own = part_of(row, part, track, &left.modal.y);
        value += match part.growth {
            BlockGrowth::Decaying => own.max(T::Bound::ZERO) - own,
            BlockGrowth::Bounded => part.norms[0] * left.norms[part.subspace] - own,
            BlockGrowth::Polynomial | BlockGrowth::Growing(_) => break,
        };
        let rest = if k + 1 < row.parts.len() { rests[k + 1] } else { T::Bound::ZERO };
        let is_constant = || row.parts[k + 1..].iter().all(|it| it.norms[1] == 0.0);
        let share =
            if rest == 0.0 && is_constant() { MIN_CONSTANT_CLEARANCE } else { MIN_CLEARANCE };
        if value > begin * share {
            if part.growth == BlockGrowth::Decaying && rest < best * MAX_REST_RATIO {
                let from = row.first_column(k + 1);
                let slope = row.first_orders(&left.modal.y, from)[1].bound() * track.outward;
                let rate = (part.norms[1] / part.norms[0]).to_f64();
                let length = held_back_time(-own, rate, value, slope);
                if length > reach.length {
                    (reach.cut, reach.length) = (k + 1, length.min(longest));
                }
            }
            break;
        }
        if rest < best * MAX_REST_RATIO {
            let root = (-value * (MAX_REMAINDER * REMAINDER_DIVISOR) / rest).approximate_root(8);
            let length = root.to_f64().min(longest);
            if length > reach.length {
                best = rest;
                (reach.cut, reach.length) = (k + 1, length);
            }
        }
    }
}

/// The time for which a decaying term keeps a guard below zero that is `value` and rises without
/// it: until it is twice as large as the rest has become. The next piece is short relative to the
/// decay time.
#[inline]
fn held_back_time<B: Bound>(decay: B, rate: f64, value: B, slope: B) -> f64 {
    let until = |rest: B| libm::log((decay / (rest * 2.0)).to_f64()) / rate;
    let length = until(value.abs());
    if length > 0.0 { until(value.abs() + slope.abs() * length) } else { 0.0 }
}

/// For each block, a bound of the eighth derivative of its part and of all later ones.
#[inline]
fn eighths<T: Number>(row: &ModalRow<T>, left: &GuardedPoint<T>, longest: f64) -> Vector<T::Bound> {
    let mut rests = [T::Bound::ZERO; LARGEST_DIMENSION];
    let mut sum = T::Bound::ZERO;
    for (n, part) in row.parts.iter().enumerate().rev() {
        sum += part.bound(8, longest, &left.norms);
        rests[n] = sum;
    }
    rests
}

/// An upper bound of the eighth derivative of all blocks from `cut` on, not negative.
#[inline]
fn eighth<T: Number>(
    row: &ModalRow<T>,
    track: &Track,
    left: &GuardedPoint<T>,
    cut: usize,
    length: f64,
) -> T::Bound {
    let mut sum = T::Bound::ZERO;
    for part in &row.parts[cut..] {
        // An even derivative of a decay has the sign of the decay.
        let falls =
            part.growth == BlockGrowth::Decaying && part_of(row, part, track, &left.modal.y) <= 0.0;
        if !falls {
            sum += part.bound(8, length, &left.norms);
        }
    }
    sum * OUTWARD_FACTOR
}

/// Upper bounds of the first blocks' part in a guard at both ends of a piece; between them the part
/// is below the straight line.
#[inline]
fn raise<T: Number>(row: &ModalRow<T>, track: &Track, ends: &Ends<T>, cut: usize) -> [T::Bound; 2] {
    let mut raise = [T::Bound::ZERO; 2];
    for part in &row.parts[..cut] {
        let [from, to] = [&ends.left, &ends.right].map(|it| part_of(row, part, track, &it.modal.y));
        let own = match part.growth {
            BlockGrowth::Decaying if from > 0.0 => [from * OUTWARD_FACTOR, to * OUTWARD_FACTOR],
            BlockGrowth::Decaying => [to / OUTWARD_FACTOR; 2],
            _ => [part.norms[0] * ends.left.norms[part.subspace] * OUTWARD_FACTOR; 2],
        };
        raise = [raise[0] + own[0], raise[1] + own[1]];
    }
    raise
}

/// The part of a block in the value of a guard.
#[inline]
pub(super) fn part_of<T: Number>(
    row: &ModalRow<T>,
    part: &RowPart<T::Bound>,
    track: &Track,
    y: &Vector<T>,
) -> T::Bound {
    let columns = &row.columns[part.columns.0..part.columns.1];
    let terms = columns.iter().map(|it| it.orders[0].bound() * y[it.at].bound());
    terms.sum::<T::Bound>() * track.outward
}

/// A length that ends a little beyond the root that the first terms of a polynomial suggest, or
/// where they have grown so much that rounding would hide the beginning.
#[inline]
fn polynomial_reach<B: Bound>(orders: &[B; 4], zeros: usize, slack: B) -> f64 {
    /// The growth of the first terms, beside the value, by which rounding would hide the beginning.
    const MAX_GROWTH: f64 = 1e6;
    let [value, slope, bend, third] = *orders;
    let size = value.abs().max(slack);
    if zeros > 0 || size == 0.0 {
        return f64::INFINITY;
    }
    let rise = if value < -slack { rise([value, slope, bend * 0.5]) } else { B::INFINITY };
    let by_slope = size * MAX_GROWTH / slope.abs();
    let by_bend = (size * MAX_GROWTH / bend.abs()).approximate_root(2);
    let by_third = (size * MAX_GROWTH / third.abs()).approximate_root(3);
    (rise * 1.25).min(by_slope).min(by_bend).min(by_third).to_f64()
}

/// The root at which a parabola that is negative at zero rises through zero; infinite if it does
/// not.
#[inline]
pub(super) fn rise<B: Bound>([value, slope, bend]: [B; 3]) -> B {
    // The form of the root in which nothing cancels.
    let divisor = slope + (slope * slope - value * 4.0 * bend).sqrt();
    if divisor > 0.0 { value * -2.0 / divisor } else { B::INFINITY }
}

/// A length on which the remainder stays small relative to what a guard that begins with more than
/// two zeros becomes by its first derivative that is not one.
fn length_after<B: Bound>(lead: B, zeros: usize, eighth: B) -> f64 {
    if eighth == 0.0 {
        return f64::INFINITY;
    }
    // The interpolant takes at most seven derivatives of the guard.
    let zeros = zeros.min(7);
    let power =
        lead.abs() * (MAX_REMAINDER * f64::inverse_factorial(zeros) * REMAINDER_DIVISOR) / eighth;
    power.approximate_root(8 - zeros).to_f64()
}

/// A length on which the remainder stays small relative to what a guard becomes by one of its first
/// derivatives that are not zero.
#[inline]
fn length<B: Bound>(orders: &[B; 4], eighth: B, zeros: usize, size: impl Fn() -> B) -> f64 {
    if eighth == 0.0 {
        return f64::INFINITY;
    }
    if !eighth.is_finite() {
        return 0.0;
    }
    let room = B::from_f64(MAX_REMAINDER * REMAINDER_DIVISOR) / eighth;
    let [value, slope, bend, _] = orders.map(Bound::abs);
    let smallest = size() * MIN_RELATIVE_SIZE;
    let by_value = if zeros > 0 { smallest } else { value.max(smallest) };
    let by_slope = if zeros > 1 { B::ZERO } else { (room * 0.5 * slope).approximate_root(7) };
    let by_bend = (room * 0.125 * bend).approximate_root(6);
    (room * by_value).approximate_root(8).max(by_slope).max(by_bend).to_f64()
}
