//! Whether a guard stays negative on a piece, by the Bernstein coefficients of a polynomial that
//! lies above it: the same theorem as in `crossing/certificate.rs`, in any arithmetic.

use super::flow::unit;
use crate::crossing::certificate::MIDDLE;
use crate::number::Number;

/// Bernstein coefficients of degree eight.
type Hull<T> = [T; 9];

/// The narrowest part of a piece that is looked at without an evaluation.
const NARROWEST: f64 = 1.0 / 65_536.0;

/// What is known of a guard on a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Judged {
    /// It stays negative.
    Clear,
    /// It comes as near to zero as rounding goes, all over the piece, and no further.
    Touch,
    /// It stays negative on this share of the piece; nothing is proved about the rest.
    Open(f64),
}

/// Judges a guard from its orders at both ends, a bound of its eighth derivative, what rounding may
/// do to its values, and the number of its orders that are exactly zero at the left end.
pub(super) fn judge<T: Number>(
    ends: &[[T; 4]; 2],
    length: T,
    eighth: f64,
    slack: f64,
    zeros: usize,
) -> Judged {
    let mut hull = interpolant(ends, length);
    let square = length * length;
    let power = square * square * (square * square);
    hull[4] = hull[4] + power * T::exact(eighth / MIDDLE);
    let size = hull.iter().map(|it| it.to_f64().abs()).fold(0.0, f64::max);
    let slack = slack + 16.0 * unit::<T>() * size;
    if !size.is_finite() {
        return Judged::Open(0.0);
    }
    // A single bit of the sign of each tells most pieces apart.
    if is_clear(&hull, slack, zeros) {
        return Judged::Clear;
    }
    if size <= 64.0 * slack && hull.iter().all(|it| it.to_f64() <= slack) {
        return Judged::Touch;
    }
    Judged::Open(clear_share(&hull, slack, zeros))
}

/// The coefficients of the polynomial of degree seven that shares value and three derivatives at
/// both ends, raised to degree eight. The constants are quotients in the arithmetic itself, whose
/// digits they have to have.
fn interpolant<T: Number>(ends: &[[T; 4]; 2], length: T) -> Hull<T> {
    let [left, right] = ends;
    let [a, b, c, d] = next_to_an_end(left, length);
    let [h, g, f, e] = next_to_an_end(right, -length);
    let seventh = [a, b, c, d, e, f, g, h];
    let mut hull = [a; 9];
    hull[8] = h;
    for n in 1..8 {
        let share = T::exact(n as f64 * 0.125);
        hull[n] = seventh[n] + share * (seventh[n - 1] - seventh[n]);
    }
    hull
}

/// The four coefficients of degree seven that belong to an end.
fn next_to_an_end<T: Number>(orders: &[T; 4], length: T) -> [T; 4] {
    let [value, slope, bend, third] = *orders;
    let first = slope * length / T::exact(7.0);
    let second = bend * length * length / T::exact(42.0);
    let third = third * length * length * length / T::exact(210.0);
    let (two, three) = (T::exact(2.0), T::exact(3.0));
    [value, value + first, value + two * first + second, value + three * (first + second) + third]
}

/// With zeros at the left end the coefficients that belong to it are exact but for their own
/// roundings, however small they are beside the others' slack.
fn is_clear<T: Number>(hull: &Hull<T>, slack: f64, zeros: usize) -> bool {
    if zeros == 0 {
        return hull.iter().all(|it| it.to_f64() < -slack);
    }
    let size = hull.iter().map(|it| it.to_f64().abs()).fold(0.0, f64::max);
    let relative = 64.0 * unit::<T>() * size;
    let room = |n: usize| if n < 4 { relative } else { slack.max(relative) };
    hull.iter().enumerate().skip(zeros.min(8)).all(|(n, it)| it.to_f64() < -room(n))
}

/// The share of the piece up to which the hull is negative.
fn clear_share<T: Number>(hull: &Hull<T>, slack: f64, zeros: usize) -> f64 {
    let mut parts = vec![(*hull, 0.0, 1.0, zeros)];
    while let Some((hull, from, width, zeros)) = parts.pop() {
        if is_clear(&hull, slack, zeros) {
            continue;
        }
        if width <= NARROWEST {
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

/// Where a hull whose coefficients change their sign once, upward, is still negative: by Descartes'
/// rule there is one root, and it is beyond.
fn simple_root<T: Number>(hull: &Hull<T>, slack: f64, zeros: usize) -> Option<f64> {
    const STEPS: usize = 12;
    let hull = hull.map(|it| it + T::exact(slack));
    let signs = hull.iter().skip(zeros.min(8)).map(|it| it.to_f64());
    let first = signs.clone().position(|it| it >= 0.0)?;
    if first == 0 || !signs.skip(first).all(|it| it >= 0.0) || hull[8] <= T::zero() {
        return None;
    }
    let (mut low, mut high) = (0.0, 1.0);
    let (mut below, mut above) = (f64::NAN, hull[8].to_f64());
    for step in 0..STEPS {
        // The secant, kept off the ends; every third step halves.
        let secant = low + (high - low) * (below / (below - above)).clamp(0.02, 0.98);
        let middle = if step % 3 == 2 || secant.is_nan() { 0.5 * (low + high) } else { secant };
        let value = value(&hull, T::exact(middle)).to_f64();
        if value < 0.0 {
            (low, below) = (middle, value);
        } else {
            (high, above) = (middle, value);
        }
        if high - low < 1e-4 * high {
            break;
        }
    }
    Some(low)
}

/// De Casteljau's value.
fn value<T: Number>(hull: &Hull<T>, at: T) -> T {
    let mut row = *hull;
    for last in (0..8).rev() {
        for n in 0..=last {
            row[n] = row[n] + at * (row[n + 1] - row[n]);
        }
    }
    row[0]
}

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
