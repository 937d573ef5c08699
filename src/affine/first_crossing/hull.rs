//! Whether a guard stays negative on a piece, by the Bernstein coefficients of a polynomial that
//! lies above it, in any arithmetic: the theorem and the interpolant are those of
//! [`crate::crossing::certificate`].

use crate::crossing::certificate::{REMAINDER_DIVISOR, in_order, interpolant};
use crate::numeric::number::{Bound, Number};
use crate::numeric::real::Real;
use smallvec::SmallVec;

/// Bernstein coefficients of degree eight.
type Hull<T> = [T; 9];

/// The narrowest part of a piece that is examined without an evaluation.
const MIN_WIDTH: f64 = 1.0 / 65_536.0;

/// The distance to a root at which the search of a place before it ends, relative to the root:
/// Newton's method does the rest.
const ROOT_TOLERANCE: f64 = 1e-2;

/// The sign of a guard on a piece, as far as it is proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SignOnPiece {
    /// The guard stays negative on the whole piece.
    Negative,
    /// The guard is zero to rounding all over the piece, and never above that.
    Touch,
    /// The guard stays negative on this share of the piece; nothing is proved about the rest.
    NegativeUntil(f64),
}

/// A piece's length, and the quotients of it that all guards need. They are in the arithmetic
/// itself, whose digits they have to have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengths<T> {
    pub length: T,
    seventh: T,
    /// L/6 and L/5, by which the next derivative counts.
    sixth: T,
    fifth: T,
    /// The middle coefficient of an eighth derivative of 1.
    middle: T,
}

impl<T: Number> Lengths<T> {
    #[inline]
    pub fn new(length: T) -> Self {
        let square = length * length;
        let power = square * square * (square * square);
        Self {
            length,
            seventh: length / T::exact(7.0),
            sixth: length / T::exact(6.0),
            fifth: length / T::exact(5.0),
            middle: power / T::exact(REMAINDER_DIVISOR),
        }
    }
}

/// The sign of a guard on a piece from its orders at both ends, a bound of its eighth derivative, a
/// line above what is not in the orders, a bound of the rounding of its values, and the number of
/// its orders that are exactly zero at the left end.
#[inline]
pub(super) fn sign_on_piece<T: Number>(
    ends: &[[T; 4]; 2],
    lengths: &Lengths<T>,
    eighth: T::Bound,
    [from, to]: [T::Bound; 2],
    slack: T::Bound,
    zeros: usize,
) -> SignOnPiece {
    let Lengths { seventh, sixth, fifth, .. } = *lengths;
    let [left, right] = ends;
    let (pairs, middle) = interpolant(
        scaled(left, [seventh, sixth, fifth]),
        scaled(right, [-seventh, -sixth, -fifth]),
    );
    let mut hull = in_order(pairs, middle);
    if eighth != 0.0 {
        hull[4] = hull[4] + lengths.middle * T::of_bound(eighth);
    }
    if from != 0.0 || to != 0.0 {
        for (n, entry) in hull.iter_mut().enumerate() {
            let share = n as f64 * 0.125;
            *entry = *entry + T::of_bound(from * (1.0 - share) + to * share);
        }
    }
    let [mut sum, mut size] = [T::Bound::ZERO; 2];
    let mut top = -T::Bound::INFINITY;
    for entry in hull.map(Number::bound) {
        // Unlike the maximum, the sum keeps NaN.
        sum += entry.abs();
        size = larger(size, entry.abs());
        top = larger(top, entry);
    }
    if !(sum + slack).is_finite() {
        return SignOnPiece::NegativeUntil(0.0);
    }
    let slack = slack + T::unit() * 16.0 * size;
    let stays_below = top < -slack || zeros > 0 && is_clear(&hull, slack, zeros);
    if stays_below {
        return SignOnPiece::Negative;
    }
    if size <= slack * 64.0 && top <= slack {
        return SignOnPiece::Touch;
    }
    SignOnPiece::NegativeUntil(clear_share(&hull, slack, zeros))
}

/// The value and derivatives at an end of a piece, each times its factor of the length: factor by
/// factor, because powers of a short length may underflow where derivatives are large.
#[inline]
fn scaled<T: Number>(orders: &[T; 4], [seventh, sixth, fifth]: [T; 3]) -> [T; 4] {
    let [value, slope, bend, third] = *orders;
    [value, slope * seventh, bend * seventh * sixth, third * seventh * sixth * fifth]
}

/// Whether all coefficients are negative by more than rounding. With zeros at the left end those
/// that belong to it are exact but for their own roundings, however small they are relative to the
/// others' slack.
#[inline]
fn is_clear<T: Number>(hull: &Hull<T>, slack: T::Bound, zeros: usize) -> bool {
    if zeros == 0 {
        return hull.iter().all(|it| it.bound() < -slack);
    }
    let size = hull.iter().fold(T::Bound::ZERO, |size, it| larger(size, it.bound().abs()));
    let relative = T::unit() * 64.0 * size;
    let room = |n: usize| if n < 4 { relative } else { slack.max(relative) };
    hull.iter().enumerate().skip(zeros.min(8)).all(|(n, it)| it.bound() < -room(n))
}

/// The share of the piece up to which the hull is negative.
#[inline]
fn clear_share<T: Number>(hull: &Hull<T>, slack: T::Bound, zeros: usize) -> f64 {
    if let Some(share) = simple_root(hull, slack, zeros) {
        return share;
    }
    let mut parts: SmallVec<[_; 20]> = SmallVec::new();
    parts.push((*hull, 0.0, 1.0, zeros));
    while let Some((hull, from, width, zeros)) = parts.pop() {
        if is_clear(&hull, slack, zeros) {
            continue;
        }
        if width <= MIN_WIDTH {
            return from;
        }
        if let Some(share) = simple_root(&hull, slack, zeros) {
            return from + width * share;
        }
        let (left, right) = halves(&hull);
        let half = 0.5 * width;
        parts.push((right, from + half, half, 0));
        parts.push((left, from, half, zeros));
    }
    1.0
}

/// A share of a piece on which a hull is negative whose coefficients change their sign once,
/// upward: by Descartes' rule it has one root, which is beyond the share.
#[inline]
fn simple_root<T: Number>(hull: &Hull<T>, slack: T::Bound, zeros: usize) -> Option<f64> {
    let hull = relative(hull.map(|it| (it + T::of_bound(slack)).bound()));
    let zeros = zeros.min(8);
    let first = zeros + hull[zeros..].iter().position(|it| *it >= 0.0)?;
    if first == zeros || !hull[first..].iter().all(|it| *it >= 0.0) || hull[8] <= 0.0 {
        return None;
    }
    // The root of the control polygon is near that of the polynomial.
    let (below, above) = (hull[first - 1], hull[first]);
    let place = 0.125 * ((first - 1) as f64 + below / (below - above));
    Some(negative_until(&hull, place))
}

/// The larger one; of a NaN nothing is promised.
#[inline(always)]
fn larger<B: Bound>(a: B, b: B) -> B {
    if a < b { b } else { a }
}

/// Coefficients in f64: only their quotients matter, so that a common power of two is left out
/// where their exponents are beyond those of f64.
#[inline]
fn relative<B: Bound>(hull: [B; 9]) -> [f64; 9] {
    if B::UNDERFLOW > 0.0 {
        return hull.map(Bound::to_f64);
    }
    let size = hull.iter().fold(B::ZERO, |size, it| larger(size, it.abs()));
    hull.map(|it| it.scaled(-size.parts().1).to_f64())
}

/// A place just before the root of a hull that has one: where it is negative beyond rounding.
/// Newton's method, kept between a place before the root and one behind it, aims at half the
/// distance that is near enough; it begins at `place`, inside.
#[inline]
fn negative_until(hull: &[f64; 9], mut place: f64) -> f64 {
    const MAX_STEPS: usize = 16;
    /// The rounding of the coefficients, relative to the largest: a difference of order k is off by
    /// 2^k roundings of k sums, and has the weight C(8, k): 3^8 in all, and eight times that.
    const ROUNDING_TOLERANCE: f64 = 8.0 * 6561.0 * f64::EPSILON;
    let powers = powers(hull);
    let rounding = ROUNDING_TOLERANCE * hull.iter().fold(0.0_f64, |size, it| size.larger(it.abs()));
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..MAX_STEPS {
        let (value, slope) = value_and_slope(&powers, place);
        let value = value + rounding;
        let ahead = -value / slope;
        if value < 0.0 {
            low = place;
            if ahead >= 0.0 && ahead < ROOT_TOLERANCE * place {
                break;
            }
        } else {
            high = place;
        }
        if high - low < ROOT_TOLERANCE * high {
            break;
        }
        let aim = (1.0 - 0.5 * ROOT_TOLERANCE) * (place + ahead);
        place = if low < aim && aim < high { aim } else { 0.5 * (low + high) };
    }
    low
}

/// A polynomial in powers, and its slope, each as four sums that do not wait for one another.
#[inline]
fn value_and_slope(powers: &[f64; 9], x: f64) -> (f64, f64) {
    let [a, b, c, d, e, f, g, h, i] = *powers;
    let square = x * x;
    let fourth = square * square;
    let value = (a + b * x)
        + (c + d * x) * square
        + ((e + f * x) + (g + h * x) * square + i * fourth) * fourth;
    let slope = (b + 2.0 * c * x)
        + (3.0 * d + 4.0 * e * x) * square
        + ((5.0 * f + 6.0 * g * x) + (7.0 * h + 8.0 * i * x) * square) * fourth;
    (value, slope)
}

/// The coefficients of a polynomial in powers, from its Bernstein coefficients: C(8, k) times their
/// differences.
#[inline]
fn powers(hull: &[f64; 9]) -> [f64; 9] {
    const BINOMIALS: [f64; 9] = [1.0, 8.0, 28.0, 56.0, 70.0, 56.0, 28.0, 8.0, 1.0];
    let mut powers = *hull;
    for order in 1..9 {
        for n in (order..9).rev() {
            powers[n] -= powers[n - 1];
        }
    }
    for n in 0..9 {
        powers[n] *= BINOMIALS[n];
    }
    powers
}

#[inline]
fn halves<T: Number>(hull: &Hull<T>) -> (Hull<T>, Hull<T>) {
    let half = T::exact(0.5);
    let (mut left, mut right) = (*hull, *hull);
    for (level, entry) in left.iter_mut().enumerate().skip(1) {
        for k in 0..9 - level {
            right[k] = (right[k] + right[k + 1]) * half;
        }
        *entry = right[0];
    }
    (left, right)
}
