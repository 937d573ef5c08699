//! The last step to a crossing, so short that one or two derivatives of a block's co-ordinates
//! replace the exponential.

use super::motion::BlockMotion;
use crate::affine::arithmetic::vector::{Vector, dot};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::Number;

impl<T: Number> BlockMotion<T> {
    /// The co-ordinates a short time later, by so many of their derivatives.
    #[inline]
    pub fn taylor_step(&self, y: &mut [T], derivatives: usize, time: T) {
        match self {
            Self::Still => {}
            Self::Real { rate } => {
                let turn = rate.high * time;
                y[0] = y[0] + y[0] * (turn + T::exact(0.5) * turn * turn);
            }
            Self::Pair { rate, frequency } => {
                let frequency = frequency.high;
                let rate = rate.map_or(T::zero(), |it| it.high);
                add_taylor_terms([y[0], y[1]], y, derivatives, time, |[a, b]| {
                    [rate * a + frequency * b, rate * b - frequency * a]
                });
            }
            Self::Nilpotent { rate, matrix, .. } => {
                let rate = rate.map_or(T::zero(), |it| it.high);
                taylor_step_by(matrix, rate, y, derivatives, time);
            }
            Self::Cluster(powers) => {
                taylor_step_by(&powers.matrix, T::zero(), y, derivatives, time)
            }
        }
    }
}

/// A [`BlockMotion::taylor_step`] of a block that is the sum of a matrix and a rate.
#[inline]
fn taylor_step_by<T: Number>(
    matrix: &[Vector<T>],
    rate: T,
    y: &mut [T],
    derivatives: usize,
    time: T,
) {
    match y.len() {
        2 => taylor_step_in::<T, 2>(matrix, rate, y, derivatives, time),
        3 => taylor_step_in::<T, 3>(matrix, rate, y, derivatives, time),
        4 => taylor_step_in::<T, 4>(matrix, rate, y, derivatives, time),
        _ => taylor_step_in::<T, LARGEST_DIMENSION>(matrix, rate, y, derivatives, time),
    }
}

#[inline(always)]
fn taylor_step_in<T: Number, const LENGTH: usize>(
    matrix: &[Vector<T>],
    rate: T,
    y: &mut [T],
    derivatives: usize,
    time: T,
) {
    let count = y.len();
    let mut start = [T::zero(); LENGTH];
    start[..count].copy_from_slice(y);
    add_taylor_terms(start, y, derivatives, time, |last| {
        let mut next = [T::zero(); LENGTH];
        for n in 0..count {
            next[n] = dot(&matrix[n], &last, count) + rate * last[n];
        }
        next
    });
}

/// Adds the first terms of a Taylor series, each derivative from the one before it.
#[inline(always)]
fn add_taylor_terms<T: Number, const LENGTH: usize>(
    start: [T; LENGTH],
    y: &mut [T],
    derivatives: usize,
    time: T,
    derived: impl Fn([T; LENGTH]) -> [T; LENGTH],
) {
    let (mut last, mut factor) = (start, T::one());
    for k in 1..=derivatives {
        last = derived(last);
        factor = factor * time * T::exact(1.0 / k as f64);
        y.iter_mut().zip(last).for_each(|(entry, slope)| *entry = *entry + factor * slope);
    }
}
