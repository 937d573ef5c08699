//! Bounds of what a block adds to a guard's derivatives, at all later times.
//!
//! With B the block and w the guard's part in it, the k-th derivative is w B^k exp(B s) y. Where B
//! has one eigenvalue, or one pair that does not grow, |w B^k| |y| bounds it for ever. Where B =
//! rate + N with N nilpotent, exp(N s) is a polynomial: with a negative rate each of its terms has
//! a maximum, s^j exp(rate s)/j! <= (j/(e |rate|))^j/j!, and with a rate of zero its sum is finite.
//! All other blocks grow at most by their logarithmic norm.

use super::nilpotent::nilpotent;
use crate::affine::arithmetic::real::BigReal;
use crate::affine::arithmetic::vector::euclidean;
use crate::affine::modal::{self, Kind};
use crate::numeric::number::Bound;

/// The number of derivatives of a row that are kept, its value included.
pub const ORDERS: usize = 17;

/// The factor by which a norm is raised against its rounding.
const OUTWARD_FACTOR: f64 = 1.0 + 1e-12;

/// How a block's part in a row's derivatives may grow at later times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlockGrowth {
    /// A block with one negative eigenvalue: its part keeps its sign and decays.
    Decaying,
    /// A part that never exceeds the norms.
    Bounded,
    /// A part that is a polynomial of the time, as its derivatives are.
    Polynomial,
    /// A part that grows at most at this exponential rate.
    Growing(f64),
}

impl BlockGrowth {
    pub fn new(block: &modal::Block) -> Self {
        let never_grows = |rate: &BigReal| *rate <= BigReal::zero();
        match &block.kind {
            Kind::Real(rate) if rate.is_zero() => Self::Polynomial,
            // A polynomial of higher degree has no bound of its eighth derivative for all times.
            Kind::Nilpotent(rate) if rate.is_zero() && nilpotent(block, rate).1 <= 8 => {
                Self::Polynomial
            }
            Kind::Real(rate) if never_grows(rate) => Self::Decaying,
            Kind::Pair(rate, _) if never_grows(rate) => Self::Bounded,
            // A long chain without a decay grows as all other blocks do.
            Kind::Nilpotent(rate) if *rate < BigReal::zero() => Self::Bounded,
            _ => match positive_logarithmic_norm(block) {
                rate if rate > 0.0 => Self::Growing(rate),
                _ => Self::Bounded,
            },
        }
    }

    /// A bound of a derivative over `length`, for co-ordinates of norm 1.
    #[inline]
    pub fn bound<B: Bound>(self, norms: &[B; ORDERS], order: usize, length: f64) -> B {
        match self {
            Self::Decaying | Self::Bounded => norms[order],
            Self::Growing(rate) => norms[order] * growth_by::<B>(rate * length),
            Self::Polynomial => polynomial(&norms[order..], length),
        }
    }
}

/// An upper bound of exp(x): up to x = 1, where it is most often asked for, a parabola.
#[inline]
fn growth_by<B: Bound>(x: f64) -> B {
    /// The largest value of (exp(x) - 1 - x)/x^2 for x up to 1: the quotient increases, and at 1
    /// it is e - 2.
    const MAX_QUOTIENT: f64 = 0.718_281_828_459_046;
    if x <= 1.0 {
        B::from_f64((1.0 + x * (1.0 + x * MAX_QUOTIENT)) * OUTWARD_FACTOR)
    } else {
        B::exp(x) * OUTWARD_FACTOR
    }
}

/// The sum of `norms[j] length^j/j!`, where norms that are zero end it.
#[inline]
fn polynomial<B: Bound>(norms: &[B], length: f64) -> B {
    let (mut sum, mut factor) = (B::ZERO, B::from_f64(1.0));
    for (j, norm) in norms.iter().enumerate() {
        if *norm == 0.0 {
            break;
        }
        sum += *norm * factor;
        factor *= length / (j + 1) as f64;
    }
    sum
}

/// A bound of a block's logarithmic norm, not negative.
fn positive_logarithmic_norm(block: &modal::Block) -> f64 {
    if let Kind::Real(rate) | Kind::Pair(rate, _) = &block.kind {
        return rate.to_f64().max(0.0);
    }
    modal::logarithmic_norm(&block.matrix).max(0.0) * OUTWARD_FACTOR
}

/// A row's derivatives in a block, those that are zero exactly so.
pub fn derivatives(row: &[BigReal], block: &modal::Block) -> Vec<Vec<BigReal>> {
    let mut parts = modal::derivatives(row, block, ORDERS);
    if let Kind::Real(rate) | Kind::Nilpotent(rate) = &block.kind
        && rate.is_zero()
    {
        let (_, index) = nilpotent(block, rate);
        parts.iter_mut().skip(index).flatten().for_each(|it| *it = BigReal::zero());
    }
    parts
}

/// The norms of a row's derivatives in a block, raised to what they are at most later where a
/// nilpotent block decays.
pub fn norms<B: Bound>(block: &modal::Block, parts: &[Vec<BigReal>]) -> [B; ORDERS] {
    let decay = match &block.kind {
        Kind::Nilpotent(rate) if *rate < BigReal::zero() => {
            let (matrix, index) = nilpotent(block, rate);
            Some((matrix, index, -rate.to_f64()))
        }
        _ => None,
    };
    let bound = |part: &Vec<BigReal>| {
        let Some((matrix, index, rate)) = &decay else { return norm::<B>(part) };
        let next = |last: &Vec<BigReal>| Some(modal::row_times(last, matrix));
        let powers = std::iter::successors(Some(part.clone()), next).take(*index);
        powers.enumerate().map(|(j, row)| norm::<B>(&row) * largest_term(j, *rate)).sum::<B>()
    };
    std::array::from_fn(|k| {
        let is_zero = parts[k].iter().all(BigReal::is_zero);
        if is_zero { B::ZERO } else { (bound(&parts[k]) * OUTWARD_FACTOR).max(B::UNDERFLOW) }
    })
}

/// The maximum of s^j exp(-rate s)/j!.
fn largest_term(j: usize, rate: f64) -> f64 {
    (1..=j).map(|n| j as f64 / (std::f64::consts::E * rate * n as f64)).product::<f64>()
        * OUTWARD_FACTOR
}

fn norm<B: Bound>(part: &[BigReal]) -> B {
    euclidean(part.iter().map(BigReal::bound::<B>))
}

/// Sorts blocks by their speed, the fastest first and those without a bound for all times last.
pub fn ordered(mut blocks: Vec<modal::Block>) -> Vec<modal::Block> {
    let speed = |block: &modal::Block| match BlockGrowth::new(block) {
        BlockGrowth::Decaying | BlockGrowth::Bounded => modal::norm(&block.matrix),
        BlockGrowth::Polynomial | BlockGrowth::Growing(_) => -1.0,
    };
    blocks.sort_by(|a, b| speed(b).total_cmp(&speed(a)));
    blocks
}
