//! The motion of a block's modal co-ordinates: exp(B t) y.

use super::nilpotent::{SparseTriangular, nilpotent};
use crate::affine::arithmetic::real::BigReal;
use crate::affine::arithmetic::vector::{Entry, Vector, is_f64, rounded, turned, vector};
use crate::affine::modal::{self, Kind};
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::{Bound, Number};
use std::ops::Range;
use std::sync::OnceLock;

/// A number in two words of an arithmetic.
#[derive(Clone, Copy, Debug)]
pub(super) struct SplitNumber<T> {
    pub high: T,
    low: T,
}

#[derive(Clone, Debug)]
pub(super) enum BlockMotion<T: Number> {
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
        /// The entries of the matrix that are not zero, where its rows have an order.
        triangular: Option<SparseTriangular<T>>,
    },
    Cluster(Box<PowerTables<T>>),
}

/// Tables of powers, which give exp(B t): t = step (d_0 + 16 d_1 + ...) + rest.
#[derive(Clone, Debug)]
pub(super) struct PowerTables<T> {
    step: f64,
    /// The tables of the first digits, d_0 on.
    tables: Vec<PowerTable<T>>,
    /// The tables of all later digits, made when a run first waits so long.
    later: OnceLock<Vec<PowerTable<T>>>,
    /// The first power of the later tables.
    beyond: Vec<Vec<BigReal>>,
    pub matrix: Vec<Vector<T>>,
    /// A bound of the logarithmic norm of B: negative where every state decays.
    growth: f64,
}

/// exp(B step 16^j d) of the j-th digit, for d from 1 to 15.
type PowerTable<T> = Vec<Vec<Vector<T>>>;

fn words<T: Number>(value: &BigReal) -> SplitNumber<T> {
    if is_f64::<T>() {
        // Not the rounded sum of the two, which may be the next number: a half ulp is a tie.
        let (high, low) = value.words();
        return SplitNumber { high: T::exact(high), low: T::exact(low) };
    }
    // Other arithmetics do not resolve what is left beyond their digits.
    SplitNumber { high: rounded(value), low: T::zero() }
}

fn nonzero<T: Number>(value: &BigReal) -> Option<SplitNumber<T>> {
    (!value.is_zero()).then(|| words(value))
}

impl<T: Number> BlockMotion<T> {
    /// The motion of a block whose co-ordinates begin at a place of the vector.
    pub fn new(block: &modal::Block, at: usize) -> Self {
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
                let (rate, triangular) = (nonzero(rate), SparseTriangular::new(&matrix, at));
                let matrix = matrix.iter().map(|row| vector(row)).collect();
                Self::Nilpotent { rate, matrix, powers: index - 1, triangular }
            }
            Kind::Cluster => Self::Cluster(Box::new(PowerTables::new(&block.matrix))),
        }
    }

    /// An upper bound of the factor by which a row's bound of co-ordinates that decay shrinks in a
    /// time; 1 for other blocks.
    pub fn decay(&self, time: f64) -> T::Bound {
        /// The factor by which an exponential is raised against its rounding and that of its
        /// exponent.
        const OUTWARD_FACTOR: f64 = 1.0 + 1e-9;
        let one = T::Bound::from_f64(1.0);
        let by = |rate: f64, factor: f64| match rate < 0.0 {
            true => {
                (T::Bound::exp(rate * time * (1.0 - 1e-12)) * (OUTWARD_FACTOR * factor)).min(one)
            }
            false => one,
        };
        match self {
            Self::Real { rate } | Self::Pair { rate: Some(rate), .. } => {
                by(rate.high.to_f64(), 1.0)
            }
            // Half of the decay bounds the powers of the time, which are 2^j times as large then.
            Self::Nilpotent { rate: Some(rate), powers, .. } => {
                by(0.5 * rate.high.to_f64(), libm::exp2(*powers as f64))
            }
            Self::Cluster(powers) => by(powers.growth, 1.0),
            _ => one,
        }
    }

    /// The co-ordinates a time later, and the sizes of what each is summed from, in units of which
    /// it rounds by a few: terms may cancel, so the co-ordinate itself can be much smaller. Both
    /// sizes of a pair are at least its norm.
    #[inline]
    pub fn advance(
        &self,
        own: Range<usize>,
        y: &mut Vector<T>,
        sizes: &mut Vector<T::Bound>,
        time: T,
    ) {
        match self {
            Self::Still => {}
            Self::Real { rate } => {
                let at = own.start;
                let factor = exponential(*rate, time);
                y[at] = y[at] * factor;
                sizes[at] *= raised(factor, rate, time);
            }
            Self::Pair { rate, frequency } => {
                let [at, next] = [own.start, own.start + 1];
                let (sin, cos) = circular(*frequency, time);
                let (first, second) = (y[at], y[next]);
                y[at] = cos * first + sin * second;
                y[next] = cos * second - sin * first;
                let phase = raised(T::one(), frequency, time);
                sizes[at] *= phase;
                sizes[next] *= phase;
                if let Some(rate) = rate {
                    let factor = exponential(*rate, time);
                    (y[at], y[next]) = (y[at] * factor, y[next] * factor);
                    let factor = raised(factor, rate, time);
                    sizes[at] *= factor;
                    sizes[next] *= factor;
                }
            }
            Self::Nilpotent { rate, matrix, powers, triangular } => {
                match triangular {
                    Some(triangular) => {
                        triangular.advance(*powers, y, sizes, time);
                        sizes[own.clone()].iter_mut().for_each(|size| *size *= SIZE_FACTOR);
                    }
                    None => {
                        let (y, sizes) = (&mut y[own.clone()], &mut sizes[own.clone()]);
                        taylor(matrix, *powers, y, sizes, time);
                    }
                }
                if rate.is_some() {
                    decay(*rate, time, &mut y[own.clone()], &mut sizes[own]);
                }
            }
            Self::Cluster(powers) => powers.advance(&mut y[own.clone()], &mut sizes[own], time),
        }
    }
}

/// The factor by which the sizes of Horner's sums are raised, because five roundings a power are
/// more than those of a sum.
const SIZE_FACTOR: f64 = 2.0;

/// `y = exp(B time) y` by so many terms of the Taylor series, in Horner's scheme, and the sizes of
/// what that sums, raised.
#[inline]
fn taylor<T: Number>(
    matrix: &[Vector<T>],
    terms: usize,
    y: &mut [T],
    sizes: &mut [T::Bound],
    time: T,
) {
    match y.len() {
        2 => taylor_in::<T, 2>(matrix, terms, y, sizes, time),
        3 => taylor_in::<T, 3>(matrix, terms, y, sizes, time),
        4 => taylor_in::<T, 4>(matrix, terms, y, sizes, time),
        _ => taylor_in::<T, LARGEST_DIMENSION>(matrix, terms, y, sizes, time),
    }
}

/// The sums of [`taylor`] in vectors of a length that the compiler knows, whose entries it keeps in
/// registers.
#[inline(always)]
fn taylor_in<T: Number, const LENGTH: usize>(
    matrix: &[Vector<T>],
    terms: usize,
    y: &mut [T],
    sizes: &mut [T::Bound],
    time: T,
) {
    let count = y.len();
    let (mut start, mut sizes_at_start) = ([T::zero(); LENGTH], [T::Bound::ZERO; LENGTH]);
    start[..count].copy_from_slice(y);
    sizes_at_start[..count].copy_from_slice(sizes);
    let (mut now, mut sizes_now) = (start, sizes_at_start);
    for k in (1..=terms).rev() {
        let (last, sizes_last) = (now, sizes_now);
        let factor = if k == 1 { time } else { time / T::exact(k as f64) };
        let size_of_factor = factor.bound().abs();
        for n in 0..count {
            let row = &matrix[n];
            let (mut sum, mut size) = (row[0] * last[0], row[0].bound().abs() * sizes_last[0]);
            for k in 1..count {
                sum = sum + row[k] * last[k];
                size += row[k].bound().abs() * sizes_last[k];
            }
            now[n] = start[n] + factor * sum;
            sizes_now[n] = sizes_at_start[n] + size_of_factor * size;
        }
    }
    y.copy_from_slice(&now[..count]);
    sizes.iter_mut().zip(sizes_now).for_each(|(size, now)| *size = now * SIZE_FACTOR);
}

#[inline]
fn copied<E: Entry>(y: &[E]) -> Vector<E> {
    let mut copy = [E::default(); LARGEST_DIMENSION];
    copy[..y.len()].copy_from_slice(y);
    copy
}

#[inline(always)]
fn decay<T: Number>(rate: Option<SplitNumber<T>>, time: T, y: &mut [T], sizes: &mut [T::Bound]) {
    let Some(rate) = rate else { return };
    let factor = exponential(rate, time);
    y.iter_mut().for_each(|entry| *entry = *entry * factor);
    let factor = raised(factor, &rate, time);
    sizes.iter_mut().for_each(|size| *size *= factor);
}

/// The product of a rate and a time, with its rounding error.
#[inline]
fn product<T: Number>(rate: SplitNumber<T>, time: T) -> (T, T) {
    let high = rate.high * time;
    (high, rate.high.product_error(time) + rate.low * time)
}

#[inline]
pub(super) fn exponential<T: Number>(rate: SplitNumber<T>, time: T) -> T {
    let (high, low) = product(rate, time);
    let value = high.exp();
    value + value * low
}

#[inline]
pub(super) fn circular<T: Number>(frequency: SplitNumber<T>, time: T) -> (T, T) {
    let (high, low) = product(frequency, time);
    turned(high.sin_cos(), low)
}

/// A sixth, rounded up, of the relative rounding error of a phase in units of the arithmetic: a
/// frequency is rounded to a quarter of a unit, where f64 has two words to 2^-106, and its product
/// with a time by four times that. Sizes are counted in at least six roundings where they are used.
#[inline]
fn phase<T: Number>() -> f64 {
    if is_f64::<T>() { 0.5 * f64::EPSILON } else { 0.25 }
}

/// A factor, raised by the rounding error of its exponent or angle, a rate times a time, in units
/// of the arithmetic.
#[inline]
fn raised<T: Number>(factor: T, rate: &SplitNumber<T>, time: T) -> T::Bound {
    let angle = (rate.high * time).bound().abs();
    factor.bound() * (T::Bound::from_f64(1.0) + angle * phase::<T>())
}

/// The table whose first power this is, which becomes the first of the next table.
fn table<T: Number>(first: &mut Vec<Vec<BigReal>>) -> PowerTable<T> {
    let mut multiples = modal::multiples(first, 16);
    if let Some(last) = multiples.pop() {
        *first = last;
    }
    multiples.iter().map(|it| it.iter().map(|row| vector(row)).collect()).collect()
}

impl<T: Number> PowerTables<T> {
    /// Tables up to 16^13 steps: f64 holds each smaller number of them.
    const LEVELS: usize = 13;
    /// Tables that are made at once: up to 256 steps, each at least a quarter of the time in which
    /// the fastest co-ordinate moves by its size.
    const FIRST_LEVELS: usize = 2;
    /// The number of steps that the tables do not hold any more.
    const MAX_STEPS: f64 = (1_u64 << (4 * Self::LEVELS)) as f64;

    fn new(matrix: &[Vec<BigReal>]) -> Self {
        /// The rounding of a logarithmic norm, relative to the norm.
        const ROUNDING_TOLERANCE: f64 = 1e-12;
        let size = modal::norm(matrix);
        let exponent = if size > 0.0 { -libm::ceil(libm::log2(size)) - 1.0 } else { 0.0 };
        let step = libm::exp2(exponent);
        let mut beyond = modal::exponential(matrix, exponent as isize);
        let tables = (0..Self::FIRST_LEVELS).map(|_| table(&mut beyond)).collect();
        let growth = modal::logarithmic_norm(matrix) + ROUNDING_TOLERANCE * size;
        let matrix = matrix.iter().map(|row| vector(row)).collect();
        Self { step, tables, later: OnceLock::new(), beyond, matrix, growth }
    }

    /// The table of a digit.
    #[inline]
    fn table(&self, level: usize) -> &PowerTable<T> {
        match self.tables.get(level) {
            Some(table) => table,
            None => &self.later.get_or_init(|| self.later_tables())[level - Self::FIRST_LEVELS],
        }
    }

    #[cold]
    fn later_tables(&self) -> Vec<PowerTable<T>> {
        let mut first = self.beyond.clone();
        (Self::FIRST_LEVELS..Self::LEVELS).map(|_| table(&mut first)).collect()
    }

    /// The matrices of the tables whose product is exp(B t), but for the rest of the time.
    #[inline]
    fn factors(&self, steps: f64) -> impl Iterator<Item = &Vec<Vector<T>>> {
        let mut digits = steps as u64;
        let chosen = (0..Self::LEVELS).map_while(move |level| {
            let digit = (digits > 0).then_some((digits & 15) as usize)?;
            digits >>= 4;
            Some((level, digit))
        });
        chosen.filter_map(|(level, digit)| Some(&self.table(level)[digit.checked_sub(1)?]))
    }

    /// The number of the tables' steps in a time.
    #[inline]
    fn steps(&self, time: f64) -> f64 {
        libm::floor(time / self.step).max(0.0)
    }

    /// The co-ordinates a time later, and the sizes of what they are summed from, once for each
    /// product; not inlined, because its vectors would take other motions' places in registers.
    #[inline(never)]
    fn advance(&self, y: &mut [T], sizes: &mut [T::Bound], time: T) {
        let steps = self.steps(time.to_f64());
        if steps >= Self::MAX_STEPS {
            // So long a time is beyond the tables.
            return y.fill(T::exact(f64::NAN));
        }
        let rest = time - T::exact(steps * self.step);
        let mut products = 1.0;
        for matrix in self.factors(steps) {
            products += 1.0;
            let (last, sizes_last): (Vector<T>, Vector<T::Bound>) = (copied(y), copied(sizes));
            for (n, row) in matrix.iter().enumerate() {
                let (mut sum, mut size) = (T::zero(), T::Bound::ZERO);
                for (k, factor) in row[..y.len()].iter().enumerate() {
                    sum = sum + *factor * last[k];
                    size += factor.bound().abs() * sizes_last[k];
                }
                (y[n], sizes[n]) = (sum, size);
            }
        }
        sizes.iter_mut().for_each(|size| *size *= products);
        taylor(&self.matrix, self.terms(rest.to_f64()), y, sizes, rest);
    }

    /// The number of terms of the series exp(B rest) that the last digit needs: a co-ordinate that
    /// is much smaller than the others is moved by each of them after at most as many products as
    /// there are others, and what follows is relative to that.
    #[inline]
    fn terms(&self, rest: f64) -> usize {
        /// The size down to which terms are summed, in units of the last digit: couplings differ in
        /// size.
        const TERM_TOLERANCE_UNITS: f64 = 1.0 / 4096.0;
        // |B rest| is at most 1/2 where the rest is a step. Terms may be less than any f64.
        let size = T::Bound::from_f64(0.5 * (rest / self.step).abs());
        let (mut terms, mut next) = (0, size);
        while T::unit() * TERM_TOLERANCE_UNITS < next && terms < 2 * T::TERMS {
            terms += 1;
            next *= size / (terms + 1) as f64;
        }
        terms + self.matrix.len() - 1
    }
}
