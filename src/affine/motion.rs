//! How the modal co-ordinates of a block move: exp(B t) y.

use super::modal::{self, BigReal, Kind};
use super::system::LARGEST_DIMENSION;
use super::vector::{Vector, dot, rounded, turned, unit, vector};
use crate::number::Number;

/// What is left of a zero after the products of a nilpotent matrix, relative to its norm: 2^-300.
const NOTHING: f64 = 4.909093465297727e-91;

/// A number in two words of an arithmetic.
#[derive(Clone, Copy, Debug)]
pub(super) struct SplitNumber<T> {
    high: T,
    low: T,
}

#[derive(Clone, Debug)]
pub(super) enum BlockMotion<T> {
    /// The block stands still: exp(B t) = 1.
    Still,
    Real {
        rate: SplitNumber<T>,
    },
    Pair {
        rate: Option<SplitNumber<T>>,
        frequency: SplitNumber<T>,
    },
    /// The matrix is that of the block less its rate, and has so many powers that are not zero.
    Nilpotent {
        rate: Option<SplitNumber<T>>,
        matrix: Vec<Vector<T>>,
        powers: usize,
    },
    Cluster(Box<Powers<T>>),
}

/// exp(B t) by tables: t = step (d_0 + 16 d_1 + ...) + rest.
#[derive(Clone, Debug)]
pub(super) struct Powers<T> {
    step: f64,
    /// exp(B step 16^j d) for d from 1 to 15.
    tables: Vec<Vec<Vec<Vector<T>>>>,
    matrix: Vec<Vector<T>>,
}

fn words<T: Number>(value: &BigReal) -> SplitNumber<T> {
    let high: T = rounded(value);
    // What is left beyond an arithmetic of two words is not resolved by it either.
    let rest = if unit::<T>() > 1e-20 { value.words().1 } else { 0.0 };
    SplitNumber { high, low: T::exact(rest) }
}

fn nonzero<T: Number>(value: &BigReal) -> Option<SplitNumber<T>> {
    (!value.is_zero()).then(|| words(value))
}

/// The matrix of a block less its rate, and the least power of it that is zero.
pub(super) fn nilpotent(block: &modal::Block, rate: &BigReal) -> (Vec<Vec<BigReal>>, usize) {
    let mut matrix = block.matrix.clone();
    for (n, row) in matrix.iter_mut().enumerate() {
        row[n] = &row[n] - rate;
    }
    let beside = modal::norm(&block.matrix).max(modal::norm(&matrix));
    let nothing = |power: &Vec<Vec<BigReal>>, k: usize| {
        modal::norm(power) <= NOTHING * libm::pow(beside, k as f64)
    };
    let powers = modal::multiples(&matrix, matrix.len());
    let index = powers.iter().enumerate().position(|(k, power)| nothing(power, k + 1));
    let index = index.map_or(matrix.len(), |it| it + 1);
    (matrix, index)
}

impl<T: Number> BlockMotion<T> {
    pub fn of(block: &modal::Block) -> Self {
        match &block.kind {
            Kind::Real(rate) if rate.is_zero() => Self::Still,
            Kind::Real(rate) => Self::Real { rate: words(rate) },
            Kind::Pair(rate, frequency) => {
                Self::Pair { rate: nonzero(rate), frequency: words(frequency) }
            }
            Kind::Nilpotent(rate) => {
                let (matrix, index) = nilpotent(block, rate);
                if index <= 1 && rate.is_zero() {
                    return Self::Still;
                }
                let matrix = matrix.iter().map(|row| vector(row)).collect();
                Self::Nilpotent { rate: nonzero(rate), matrix, powers: index - 1 }
            }
            Kind::Cluster => Self::Cluster(Box::new(Powers::of(&block.matrix))),
        }
    }

    /// The co-ordinates a time later.
    #[inline]
    pub fn advance(&self, y: &mut [T], time: T) {
        match self {
            Self::Still => {}
            Self::Real { rate } => y[0] = y[0] * exponential(*rate, time),
            Self::Pair { rate, frequency } => {
                let (sin, cos) = circular(*frequency, time);
                let (first, second) = (y[0], y[1]);
                y[0] = cos * first + sin * second;
                y[1] = cos * second - sin * first;
                decay(*rate, time, y);
            }
            Self::Nilpotent { rate, matrix, powers } => {
                taylor(matrix, *powers, y, time);
                decay(*rate, time, y);
            }
            Self::Cluster(powers) => powers.advance(y, time),
        }
    }

    /// The sizes of what [`Self::advance`] sums each co-ordinate from, in units of which it rounds
    /// by a few: terms may cancel, so the co-ordinate itself can be much smaller.
    pub fn sizes(&self, y: &mut [f64], time: f64) {
        let decay = |rate: &SplitNumber<T>| {
            let factor = libm::exp(rate.high.to_f64() * time);
            factor * (1.0 + exponent_roundings(rate, time))
        };
        y.iter_mut().for_each(|entry| *entry = entry.abs());
        match self {
            Self::Still => {}
            Self::Real { rate } => y[0] *= decay(rate),
            Self::Pair { rate, frequency } => {
                let phase = 1.0 + exponent_roundings(frequency, time);
                let norm = libm::hypot(y[0], y[1]) * rate.as_ref().map_or(1.0, decay);
                y.fill(norm * phase);
            }
            Self::Nilpotent { rate, matrix, powers } => {
                let sizes = matrix.iter().map(|row| row.map(|it| it.to_f64().abs()));
                taylor(&sizes.collect::<Vec<_>>(), *powers, y, time);
                // Five roundings a power are more than those of a sum.
                let factor = 2.0 * rate.as_ref().map_or(1.0, decay);
                y.iter_mut().for_each(|entry| *entry *= factor);
            }
            Self::Cluster(powers) => powers.sizes(y, time),
        }
    }
}

/// `y = exp(B time) y` by so many terms of the Taylor series, in Horner's scheme.
#[inline]
fn taylor<T: Number>(matrix: &[Vector<T>], terms: usize, y: &mut [T], time: T) {
    match y.len() {
        2 => taylor_in::<T, 2>(matrix, terms, y, 2, time),
        3 => taylor_in::<T, 3>(matrix, terms, y, 3, time),
        4 => taylor_in::<T, 4>(matrix, terms, y, 4, time),
        size => taylor_in::<T, LARGEST_DIMENSION>(matrix, terms, y, size, time),
    }
}

/// The sum of [`taylor`] in vectors of a length that the compiler knows, whose entries it keeps in
/// registers.
#[inline(always)]
fn taylor_in<T: Number, const LENGTH: usize>(
    matrix: &[Vector<T>],
    terms: usize,
    y: &mut [T],
    size: usize,
    time: T,
) {
    let mut start = [T::zero(); LENGTH];
    start[..size].copy_from_slice(y);
    let mut now = start;
    for k in (1..=terms).rev() {
        let (last, factor) = (now, if k == 1 { time } else { time / T::exact(k as f64) });
        for n in 0..size {
            now[n] = start[n] + factor * dot(&matrix[n], &last, size);
        }
    }
    y.copy_from_slice(&now[..size]);
}

#[inline]
fn copied<T: Number>(y: &[T]) -> Vector<T> {
    let mut copy = [T::zero(); LARGEST_DIMENSION];
    copy[..y.len()].copy_from_slice(y);
    copy
}

#[inline]
fn decay<T: Number>(rate: Option<SplitNumber<T>>, time: T, y: &mut [T]) {
    let Some(rate) = rate else { return };
    let factor = exponential(rate, time);
    y.iter_mut().for_each(|entry| *entry = *entry * factor);
}

/// A product with a rate, and what rounding took from it.
#[inline]
fn product<T: Number>(rate: SplitNumber<T>, time: T) -> (T, T) {
    let high = rate.high * time;
    (high, rate.high.product_error(time) + rate.low * time)
}

#[inline]
fn exponential<T: Number>(rate: SplitNumber<T>, time: T) -> T {
    let (high, low) = product(rate, time);
    let value = high.exp();
    value + value * low
}

#[inline]
fn circular<T: Number>(frequency: SplitNumber<T>, time: T) -> (T, T) {
    let (high, low) = product(frequency, time);
    turned(high.sin_cos(), low)
}

/// A sixth, rounded up, of how far rounding may have a phase off in units of it: a frequency is
/// rounded to 2^-106, its product with a time by four times that. Sizes are counted in at least six
/// roundings where they are used.
const PHASE: f64 = 0.25 * f64::EPSILON * f64::EPSILON;

/// By how many times the unit of an arithmetic the rounding of an exponent changes its exponential.
fn exponent_roundings<T: Number>(rate: &SplitNumber<T>, time: f64) -> f64 {
    PHASE / unit::<T>() * (rate.high.to_f64() * time).abs()
}

impl<T: Number> Powers<T> {
    /// Tables up to 16^13 steps: f64 holds each smaller number of them.
    const LEVELS: usize = 13;
    const MOST_STEPS: f64 = (1_u64 << (4 * Self::LEVELS)) as f64;

    fn of(matrix: &[Vec<BigReal>]) -> Self {
        let size = modal::norm(matrix);
        let exponent = if size > 0.0 { -libm::ceil(libm::log2(size)) - 1.0 } else { 0.0 };
        let step = libm::exp2(exponent);
        let mut tables = Vec::new();
        let mut first = modal::exponential(matrix, exponent as isize);
        for _ in 0..Self::LEVELS {
            let multiples = modal::multiples(&first, 16);
            let (last, table) = match multiples.split_last() {
                Some(split) => split,
                None => break,
            };
            let rounded = |it: &Vec<Vec<BigReal>>| it.iter().map(|row| vector(row)).collect();
            tables.push(table.iter().map(rounded).collect());
            first = last.clone();
        }
        Self { step, tables, matrix: matrix.iter().map(|row| vector(row)).collect() }
    }

    /// The matrices of the tables whose product is exp(B t), but for the rest of the time.
    #[inline]
    fn factors(&self, steps: f64) -> impl Iterator<Item = &Vec<Vector<T>>> {
        let mut digits = steps as u64;
        let chosen = self.tables.iter().map_while(move |table| {
            let digit = (digits > 0).then_some((digits & 15) as usize)?;
            digits >>= 4;
            Some((table, digit))
        });
        chosen.filter_map(|(table, digit)| Some(&table[digit.checked_sub(1)?]))
    }

    /// How many steps of the tables a time has.
    #[inline]
    fn steps(&self, time: f64) -> f64 {
        libm::floor(time / self.step).max(0.0)
    }

    /// The co-ordinates a time later; not inlined, because its vectors would take other motions'
    /// places in registers.
    #[inline(never)]
    fn advance(&self, y: &mut [T], time: T) {
        let size = y.len();
        let steps = self.steps(time.to_f64());
        if steps >= Self::MOST_STEPS {
            // Nothing is told of so long a time.
            return y.fill(T::exact(f64::NAN));
        }
        let rest = time - T::exact(steps * self.step);
        for matrix in self.factors(steps) {
            let last: Vector<T> = copied(y);
            for (entry, row) in y.iter_mut().zip(matrix) {
                *entry = dot(row, &last, size);
            }
        }
        taylor(&self.matrix, self.terms(rest.to_f64()), y, rest);
    }

    /// How many terms of the series exp(B rest) the last digit needs.
    #[inline]
    fn terms(&self, rest: f64) -> usize {
        /// Co-ordinates that are much smaller than the largest have digits of their own.
        const BELOW: f64 = 1.0 / 4096.0;
        // |B rest| is at most 1/2 where the rest is a step.
        let size = 0.5 * (rest / self.step).abs();
        let (mut terms, mut next) = (0, size);
        while next > BELOW * unit::<T>() && terms < 2 * T::TERMS {
            terms += 1;
            next *= size / (terms + 1) as f64;
        }
        terms
    }

    /// The sizes of what the products are summed from, once for each of them.
    fn sizes(&self, y: &mut [f64], time: f64) {
        let size = y.len();
        let mut products = 1.0;
        for matrix in self.factors(self.steps(time)) {
            products += 1.0;
            let last = copied(y);
            for (entry, row) in y.iter_mut().zip(matrix) {
                let terms = row[..size].iter().zip(&last);
                *entry = terms.map(|(factor, it)| factor.to_f64().abs() * it).sum();
            }
        }
        // The last product is exp(B rest) with |B rest| below 1/2.
        let most = y.iter().fold(0.0, |most: f64, it| most.max(*it));
        y.iter_mut().for_each(|entry| *entry = products * (*entry + most));
    }
}
