//! Vectors of the state, and numbers rounded to an arithmetic.

use super::real::BigReal;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::Number;

/// A bound of the error that underflow makes in a few operations; nothing in f64 is smaller than
/// one 64th of it.
pub const UNDERFLOW: f64 = f64::from_bits(64);

/// More than [`UNDERFLOW`] where it need not be sharp: sums and products of it are no subnormal
/// numbers, with which processors are slow.
pub const LOST: f64 = 1e-300;

/// The entries of z, or of the modal co-ordinates; those beyond the dimension are zero.
pub type Vector<T> = [T; LARGEST_DIMENSION];

/// The unit roundoff of an arithmetic.
#[inline]
pub fn unit<T: Number>() -> f64 {
    const HALF: f64 = 0.5 * f64::EPSILON;
    // Double-double arithmetic is good to a few units of 2^-106.
    if T::TERMS <= <f64 as Number>::TERMS { HALF } else { HALF * HALF * 4.0 }
}

/// A bound of the rounding error of a sum of as many products as a mode has co-ordinates, relative
/// to the sum of its terms' sizes: a rounding for each product and sum, one for the factors, five
/// for the closed form of a co-ordinate, and one for the rest of the way to a crossing.
#[inline]
pub fn sum_rounding<T: Number>(dimension: usize) -> f64 {
    (dimension + 7) as f64 * unit::<T>()
}

/// A bound of the rounding error of a sum of co-ordinates at an entry, where they are sums
/// themselves, relative to the sum of its terms' sizes.
#[inline]
pub fn twice_summed_rounding<T: Number>(dimension: usize) -> f64 {
    2.0 * sum_rounding::<T>(dimension)
}

/// Sine and cosine of an angle plus a small `low`, from those of the angle.
#[inline]
pub fn turned<T: Number>((sin, cos): (T, T), low: T) -> (T, T) {
    /// Up to here the square of what is added is below rounding.
    const LITTLE: f64 = 1e-17;
    let size = low.to_f64().abs();
    // In an arithmetic of two words `low` is a rounding, whose square is below every digit.
    if size * size <= LITTLE || unit::<T>() < 1e-20 {
        return (sin + low * cos, cos - low * sin);
    }
    let (sin_low, cos_low) = low.sin_cos();
    (sin * cos_low + cos * sin_low, cos * cos_low - sin * sin_low)
}

/// The sum of products of the first entries.
#[inline]
pub fn dot<T: Number>(a: &[T], b: &[T], dimension: usize) -> T {
    let mut sum = a[0] * b[0];
    for (a, b) in a[..dimension].iter().zip(&b[..dimension]).skip(1) {
        sum = sum + *a * *b;
    }
    sum
}

/// Adds a multiple of a vector. It is indexed because zipped iterators are not always inlined.
#[allow(clippy::needless_range_loop, reason = "an iterator costs a call")]
#[inline(always)]
pub fn add_product<T: Number, const N: usize>(sums: &mut [T; N], vector: &[T], factor: T) {
    let vector = &vector[..N];
    for k in 0..N {
        sums[k] = sums[k] + vector[k] * factor;
    }
}

/// Whether all entries, and their sum, are finite: what has overflowed proves nothing.
#[inline]
pub fn all_finite<T: Number>(entries: &[T]) -> bool {
    let mut sum = 0.0;
    for entry in entries {
        sum += entry.to_f64();
    }
    sum.is_finite()
}

/// Squares whose sum is below this may have lost digits to underflow.
const SMALLEST_SQUARE: f64 = 1e-280;

/// The Euclidean norm of some entries, which overflows or vanishes only where it has to.
#[inline]
pub fn euclidean(entries: impl Iterator<Item = f64> + Clone) -> f64 {
    let square: f64 = entries.clone().map(|it| it * it).sum();
    if square > SMALLEST_SQUARE && square < f64::INFINITY {
        return square.sqrt();
    }
    let largest = entries.clone().fold(0.0, |most: f64, it| most.max(it.abs()));
    if largest == 0.0 || largest == f64::INFINITY {
        return largest;
    }
    let shares = entries.map(|it| it / largest);
    largest * shares.map(|it| it * it).sum::<f64>().sqrt()
}

/// [`euclidean`] of a part of a vector, in fewer instructions: it runs at every point.
#[inline]
pub fn norm<T: Number>(entries: &[T]) -> f64 {
    if let [entry] = entries {
        return entry.to_f64().abs();
    }
    let mut square = 0.0;
    for entry in entries {
        let entry = entry.to_f64();
        square += entry * entry;
    }
    if square > SMALLEST_SQUARE && square < f64::INFINITY {
        return square.sqrt();
    }
    scaled_norm(entries)
}

#[cold]
#[inline(never)]
fn scaled_norm<T: Number>(entries: &[T]) -> f64 {
    euclidean(entries.iter().map(|it| it.to_f64()))
}

/// A root of any degree, good to some per cent: the bits of a number are nearly its logarithm,
/// which is divided.
#[inline]
pub fn approximate_root(value: f64, degree: usize) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    if value == 0.0 || value == f64::INFINITY || value.is_nan() {
        return value;
    }
    let bits = value.to_bits();
    let share = |bits: u64| bits / degree as u64;
    f64::from_bits(if bits >= ONE { ONE + share(bits - ONE) } else { ONE - share(ONE - bits) })
}

/// A wide number, rounded to an arithmetic of one or two words.
pub fn rounded<T: Number>(value: &BigReal) -> T {
    let (high, low) = value.words();
    T::exact(high) + T::exact(low)
}

/// A row in the arithmetic, with zeros beyond its end.
pub fn vector<T: Number>(row: &[BigReal]) -> Vector<T> {
    let mut vector = [T::zero(); LARGEST_DIMENSION];
    for (entry, value) in vector.iter_mut().zip(row) {
        *entry = rounded(value);
    }
    vector
}
