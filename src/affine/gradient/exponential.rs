//! The exponential of a matrix with its derivative: a Taylor sum of a small part of the matrix,
//! with its remainder, squared again and again.

use super::ball::{Ball, Jet, dot};
use crate::numeric::number::{Bound, Number};

type Matrix<T> = Vec<Vec<Jet<T>>>;

/// The summed part of the matrix has a norm of at most 2 to the power of minus this.
const NORM_BITS: i64 = 4;

/// More squarings than this are not tried: every digit of a result would be gone.
const MAX_SQUARINGS: i64 = 4096;

/// exp(matrix * time), with its derivative; none where the matrix is too large.
pub fn exponential<T: Number>(matrix: &[Vec<Jet<T>>], time: Ball<T>) -> Option<Matrix<T>> {
    let time = Jet::fixed(time);
    let whole: Matrix<T> =
        matrix.iter().map(|row| row.iter().map(|it| it.times(time)).collect()).collect();
    let norm = norm(&whole, |it| &it.value);
    if !norm.is_finite() {
        return None;
    }
    let squarings = (norm.parts().1 + 1 + NORM_BITS).max(0);
    if squarings > MAX_SQUARINGS {
        return None;
    }
    let small: Matrix<T> =
        whole.iter().map(|row| row.iter().map(|it| it.scaled(-squarings)).collect()).collect();
    let mut power = taylor_sum(&small);
    for _ in 0..squarings {
        power = product(&power, &power);
    }
    Some(power)
}

/// The largest sum of the sizes of a row.
fn norm<T: Number>(matrix: &[Vec<Jet<T>>], part: fn(&Jet<T>) -> &Ball<T>) -> T::Bound {
    let sums = matrix.iter().map(|row| row.iter().map(|it| part(it).size()).sum::<T::Bound>());
    sums.fold(T::Bound::ZERO, T::Bound::max) * (1.0 + 1e-14)
}

/// The exponential of a matrix whose norm a is at most 2^-NORM_BITS.
///
/// The terms after the one of order n add up to at most 2 a^(n + 1)/(n + 1)!, and their derivatives
/// to at most 2 b a^n/n!, where b is the norm of the matrix's derivative.
fn taylor_sum<T: Number>(small: &[Vec<Jet<T>>]) -> Matrix<T> {
    let [own, rate] = [norm(small, |it| &it.value), norm(small, |it| &it.rate)];
    let (mut order, mut term) = (0_u32, T::Bound::from_f64(1.0));
    while term > T::unit() && own > T::Bound::ZERO {
        order += 1;
        term = term * own / f64::from(order) * (1.0 + 1e-15);
    }
    // A matrix of norm zero has no terms, but its derivative has that of first order.
    let order = order.max(1);
    let term = if own > T::Bound::ZERO { term } else { T::Bound::ZERO };
    let one = identity::<T>(small.len());
    let mut sum = one.clone();
    for n in (1..=order).rev() {
        let share = Ball::exact(T::one()).over(Ball::exact(T::exact(f64::from(n))));
        let share = Jet::fixed(share.unwrap_or_else(Ball::zero));
        sum = product(small, &sum);
        for (row, unit) in sum.iter_mut().zip(&one) {
            for (entry, unit) in row.iter_mut().zip(unit) {
                *entry = entry.times(share).plus(*unit);
            }
        }
    }
    for entry in sum.iter_mut().flatten() {
        entry.value = entry.value.widened(term * own * 2.0);
        entry.rate = entry.rate.widened(term * rate * 2.0);
    }
    sum
}

fn identity<T: Number>(size: usize) -> Matrix<T> {
    let entry = |n, k| if n == k { Jet::fixed(Ball::exact(T::one())) } else { Jet::zero() };
    (0..size).map(|n| (0..size).map(|k| entry(n, k)).collect()).collect()
}

fn product<T: Number>(a: &[Vec<Jet<T>>], b: &[Vec<Jet<T>>]) -> Matrix<T> {
    let columns: Matrix<T> = (0..b.len()).map(|k| b.iter().map(|row| row[k]).collect()).collect();
    a.iter().map(|row| columns.iter().map(|column| dot(row, column)).collect()).collect()
}
