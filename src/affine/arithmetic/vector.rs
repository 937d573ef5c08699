//! Vectors of the state, and numbers rounded to an arithmetic.

use super::real::BigReal;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::{Bound, Number};
use std::ops::{Add, Mul};

/// The entries of z, or of the modal co-ordinates; those beyond the dimension are zero.
pub type Vector<T> = [T; LARGEST_DIMENSION];

/// A number of a vector or a matrix: of the arithmetic, or of its bounds.
pub trait Entry: Copy + Default + Add<Output = Self> + Mul<Output = Self> {}

impl<E: Copy + Default + Add<Output = E> + Mul<Output = E>> Entry for E {}

/// Whether f64 is the arithmetic: only there times and rates have two words, because others do not
/// resolve what is left beyond their digits.
#[inline]
pub fn is_f64<T: Number>() -> bool {
    T::WORDS == 1
}

/// A bound of the rounding error of a sum of as many products as a mode has co-ordinates, relative
/// to the sum of its terms' sizes: a rounding for each product and sum, one for the factors, five
/// for the closed form of a co-ordinate, and one for the rest of the way to a crossing.
#[inline]
pub fn sum_rounding<T: Number>(dimension: usize) -> T::Bound {
    T::unit() * (dimension + 7) as f64
}

/// A bound of the rounding error of a sum of co-ordinates at an entry, where they are sums
/// themselves, relative to the sum of its terms' sizes.
#[inline]
pub fn twice_summed_rounding<T: Number>(dimension: usize) -> T::Bound {
    sum_rounding::<T>(dimension) * 2.0
}

/// Sine and cosine of an angle plus a small `low`, from those of the angle.
#[inline]
pub fn turned<T: Number>((sin, cos): (T, T), low: T) -> (T, T) {
    /// The largest square of a small angle, radians squared, that is below the rounding of f64.
    const NEGLIGIBLE_SQUARE: f64 = 1e-17;
    let size = low.to_f64().abs();
    // In an arithmetic of two words `low` is a rounding, whose square is below every digit.
    if size * size <= NEGLIGIBLE_SQUARE || !is_f64::<T>() {
        return (sin + low * cos, cos - low * sin);
    }
    let (sin_low, cos_low) = low.sin_cos();
    (sin * cos_low + cos * sin_low, cos * cos_low - sin * sin_low)
}

/// The sum of products of the first entries.
#[inline]
pub fn dot<E: Entry>(a: &[E], b: &[E], dimension: usize) -> E {
    let mut sum = a[0] * b[0];
    for (a, b) in a[..dimension].iter().zip(&b[..dimension]).skip(1) {
        sum = sum + *a * *b;
    }
    sum
}

/// An upper bound of the size of a row's product with any vector whose entries have at most these
/// sizes.
pub fn row_size<T: Number>(row: &Vector<T>, sizes: &Vector<T::Bound>) -> T::Bound {
    row.iter().zip(sizes).map(|(a, b)| a.bound().abs() * *b).sum()
}

/// Adds a multiple of a vector. It is indexed because zipped iterators are not always inlined.
#[allow(clippy::needless_range_loop, reason = "an iterator costs a call")]
#[inline(always)]
pub fn add_product<E: Entry, const N: usize>(sums: &mut [E; N], vector: &[E], factor: E) {
    let vector = &vector[..N];
    for k in 0..N {
        sums[k] = sums[k] + vector[k] * factor;
    }
}

/// Whether all entries, and their sum, are finite: what has overflowed proves nothing.
#[inline]
pub fn all_finite<T: Number>(entries: &[T]) -> bool {
    let mut sum = T::Bound::ZERO;
    for entry in entries {
        sum += entry.bound();
    }
    sum.is_finite()
}

/// Squares whose sum is below this may have lost digits to underflow.
const MIN_EXACT_SQUARE: f64 = 1e-280;

/// The Euclidean norm of some entries, which overflows or vanishes only where it has to.
#[inline]
pub fn euclidean<B: Bound>(entries: impl Iterator<Item = B> + Clone) -> B {
    let square: B = entries.clone().map(|it| it * it).sum();
    if square > MIN_EXACT_SQUARE && square < f64::INFINITY {
        return square.sqrt();
    }
    let largest = entries.clone().fold(B::ZERO, |most, it| most.max(it.abs()));
    if largest == 0.0 || largest == f64::INFINITY {
        return largest;
    }
    let shares = entries.map(|it| it / largest);
    largest * shares.map(|it| it * it).sum::<B>().sqrt()
}

/// [`euclidean`] of a part of a vector, in fewer instructions: it runs at every point.
#[inline]
pub fn norm<T: Number>(entries: &[T]) -> T::Bound {
    if let [entry] = entries {
        return entry.bound().abs();
    }
    let mut square = T::Bound::ZERO;
    for entry in entries {
        let entry = entry.bound();
        square += entry * entry;
    }
    if square > MIN_EXACT_SQUARE && square < f64::INFINITY {
        return square.sqrt();
    }
    scaled_norm(entries)
}

#[cold]
#[inline(never)]
fn scaled_norm<T: Number>(entries: &[T]) -> T::Bound {
    euclidean(entries.iter().map(|it| it.bound()))
}

/// A wide number, rounded to an arithmetic.
pub fn rounded<T: Number>(value: &BigReal) -> T {
    if T::WORDS <= 2 {
        let (high, low) = value.words();
        return T::exact(high) + T::exact(low);
    }
    // The words of a number near one, so that the last of them does not underflow.
    let exponent = value.exponent();
    let mut rest = value.scaled(-exponent);
    let mut sum = T::zero();
    for k in 0..T::WORDS as i64 {
        let word = rest.to_f64();
        sum = sum + T::exact(word).scaled(-WORD_BITS * k);
        rest = (&rest - &BigReal::exact(word)).scaled(WORD_BITS as isize);
    }
    sum.scaled(exponent as i64)
}

/// The bits of each of the words to which a wide number is taken apart.
const WORD_BITS: i64 = 50;

/// A row in the arithmetic, with zeros beyond its end.
pub fn vector<T: Number>(row: &[BigReal]) -> Vector<T> {
    let mut vector = [T::zero(); LARGEST_DIMENSION];
    for (entry, value) in vector.iter_mut().zip(row) {
        *entry = rounded(value);
    }
    vector
}
