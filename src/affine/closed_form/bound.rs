//! Bounds of what a block adds to a guard's derivatives, at all later times.
//!
//! With B the block and w the guard's part in it, the k-th derivative is w B^k exp(B s) y. Where B
//! has one eigenvalue, or one pair that does not grow, |w B^k| |y| bounds it for ever. Where B =
//! rate + N with N nilpotent, exp(N s) is a polynomial: with a negative rate each of its terms has
//! a maximum, s^j exp(rate s)/j! <= (j/(e |rate|))^j/j!, and with a rate of zero its sum is finite.
//! All other blocks grow at most by their logarithmic norm.

use super::nilpotent::nilpotent;
use crate::affine::arithmetic::real::BigReal;
use crate::affine::arithmetic::vector::{UNDERFLOW, euclidean};
use crate::affine::modal::{self, Kind};

/// How many derivatives of a row are held, its value included.
pub const ORDERS: usize = 17;

/// Room for the rounding of a norm.
const OUTWARD: f64 = 1.0 + 1e-12;

/// What is known of a block's part in a derivative at later times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Later {
    /// One negative eigenvalue: the part keeps its sign and decays.
    Fading,
    /// It never exceeds the norms.
    Steady,
    /// The part and its derivatives are polynomials of the time.
    Polynomial,
    /// It grows at most at this rate.
    Growing(f64),
}

impl Later {
    pub fn of(block: &modal::Block) -> Self {
        let never_grows = |rate: &BigReal| *rate <= BigReal::zero();
        match &block.kind {
            Kind::Real(rate) if rate.is_zero() => Self::Polynomial,
            // A polynomial of higher degree has no bound of its eighth derivative for all times.
            Kind::Nilpotent(rate) if rate.is_zero() && nilpotent(block, rate).1 <= 8 => {
                Self::Polynomial
            }
            Kind::Real(rate) if never_grows(rate) => Self::Fading,
            Kind::Pair(rate, _) if never_grows(rate) => Self::Steady,
            Kind::Nilpotent(rate) if never_grows(rate) => Self::Steady,
            _ => match growth(block) {
                rate if rate > 0.0 => Self::Growing(rate),
                _ => Self::Steady,
            },
        }
    }

    /// A bound of a derivative over `length`, for co-ordinates of norm 1.
    #[inline]
    pub fn bound(self, norms: &[f64; ORDERS], order: usize, length: f64) -> f64 {
        match self {
            Self::Fading | Self::Steady => norms[order],
            Self::Growing(rate) => norms[order] * growth_by(rate * length),
            Self::Polynomial => polynomial(&norms[order..], length),
        }
    }
}

/// A bound of exp(x): up to 1, where it is most often asked for, a parabola.
#[inline]
fn growth_by(x: f64) -> f64 {
    /// (exp(x) - 1 - x)/x^2 increases, and is e - 2 at 1.
    const MOST: f64 = 0.718_281_828_459_046;
    if x <= 1.0 { (1.0 + x * (1.0 + x * MOST)) * OUTWARD } else { libm::exp(x) * OUTWARD }
}

/// The sum of `norms[j] length^j/j!`, where norms that are zero end it.
#[inline]
fn polynomial(norms: &[f64], length: f64) -> f64 {
    let (mut sum, mut factor) = (0.0, 1.0);
    for (j, norm) in norms.iter().enumerate() {
        if *norm == 0.0 {
            break;
        }
        sum += norm * factor;
        factor *= length / (j + 1) as f64;
    }
    sum
}

/// A bound of a block's logarithmic norm, not negative.
fn growth(block: &modal::Block) -> f64 {
    if let Kind::Real(rate) | Kind::Pair(rate, _) = &block.kind {
        return rate.to_f64().max(0.0);
    }
    modal::logarithmic_norm(&block.matrix).max(0.0) * OUTWARD
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
pub fn norms(block: &modal::Block, parts: &[Vec<BigReal>]) -> [f64; ORDERS] {
    let decay = match &block.kind {
        Kind::Nilpotent(rate) if *rate < BigReal::zero() => {
            let (matrix, index) = nilpotent(block, rate);
            Some((matrix, index, -rate.to_f64()))
        }
        _ => None,
    };
    let bound = |part: &Vec<BigReal>| {
        let Some((matrix, index, rate)) = &decay else { return norm(part) };
        let next = |last: &Vec<BigReal>| Some(modal::row_times(last, matrix));
        let powers = std::iter::successors(Some(part.clone()), next).take(*index);
        powers.enumerate().map(|(j, row)| norm(&row) * summit(j, *rate)).sum::<f64>()
    };
    std::array::from_fn(|k| {
        let is_zero = parts[k].iter().all(BigReal::is_zero);
        if is_zero { 0.0 } else { (bound(&parts[k]) * OUTWARD).max(UNDERFLOW) }
    })
}

/// The maximum of s^j exp(-rate s)/j!.
fn summit(j: usize, rate: f64) -> f64 {
    (1..=j).map(|n| j as f64 / (std::f64::consts::E * rate * n as f64)).product::<f64>() * OUTWARD
}

fn norm(part: &[BigReal]) -> f64 {
    euclidean(part.iter().map(BigReal::to_f64))
}

/// The fastest first; last those that nothing bounds for ever.
pub fn ordered(mut blocks: Vec<modal::Block>) -> Vec<modal::Block> {
    let speed = |block: &modal::Block| match Later::of(block) {
        Later::Fading | Later::Steady => modal::norm(&block.matrix),
        Later::Polynomial | Later::Growing(_) => -1.0,
    };
    blocks.sort_by(|a, b| speed(b).total_cmp(&speed(a)));
    blocks
}
