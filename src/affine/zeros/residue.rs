//! Rows of rational numbers modulo two primes.
//!
//! Whether a row depends linearly on others is decided modulo two primes of 61 bits. What
//! is dependent over the rationals is so modulo every prime; the converse fails for at most those
//! primes that divide a minor, which for two primes at once has a probability of about 2^-122.

use crate::affine::model::rational::Rational;
use dashu::base::UnsignedAbs;
use dashu::integer::{IBig, UBig};

/// The number of bits of a residue, at most.
const BITS: u32 = 61;

/// The two largest primes below 2^61, which is 1 modulo the first and 31 modulo the second.
const PRIMES: [u64; 2] = [(1 << BITS) - 1, (1 << BITS) - 31];

/// A rational number modulo both primes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Residue([u64; 2]);

/// A row of rational numbers modulo both primes.
pub type Residues = Vec<Residue>;

impl Residue {
    pub const ZERO: Self = Self([0; 2]);
    pub const ONE: Self = Self([1; 2]);

    /// The residues of a number; none if its denominator, or its numerator but for 0, is a multiple
    /// of a prime.
    pub fn new(number: &Rational) -> Option<Self> {
        let (above, below) = (number.big().numerator(), number.big().denominator());
        let mut residues = [0; 2];
        for (residue, prime) in residues.iter_mut().zip(PRIMES) {
            let above = signed_remainder(above, prime);
            let below = remainder(below, prime);
            if below == 0 || above == 0 && !number.is_zero() {
                return None;
            }
            // Most numbers are integers.
            *residue = if below == 1 { above } else { times(above, inverse(below, prime), prime) };
        }
        Some(Self(residues))
    }

    /// Whether the number is zero modulo both primes.
    pub fn is_zero(self) -> bool {
        self.0 == [0; 2]
    }

    /// Whether the number is zero modulo one prime and not modulo the other, which does not happen
    /// unless a prime is unlucky.
    pub fn is_unlucky(self) -> bool {
        (self.0[0] == 0) != (self.0[1] == 0)
    }

    pub fn times(self, other: Self) -> Self {
        self.with(other, times)
    }

    pub fn plus(self, other: Self) -> Self {
        self.with(other, |a, b, prime| once_less(a + b, prime))
    }

    pub fn minus(self, other: Self) -> Self {
        self.with(other, |a, b, prime| once_less(a + prime - b, prime))
    }

    /// The inverse, where the number is not zero modulo either prime.
    pub fn inverse(self) -> Self {
        self.with(self, |a, _, prime| inverse(a, prime))
    }

    fn with(self, other: Self, operation: impl Fn(u64, u64, u64) -> u64) -> Self {
        Self(std::array::from_fn(|n| operation(self.0[n], other.0[n], PRIMES[n])))
    }
}

/// The residues of a row; none if a number has none.
pub fn residues(row: &[Rational]) -> Option<Residues> {
    row.iter().map(Residue::new).collect()
}

/// `row * matrix`.
pub(super) fn row_times(row: &[Residue], matrix: &[Residues]) -> Residues {
    let mut product = vec![Residue::ZERO; row.len()];
    for (factor, matrix_row) in row.iter().zip(matrix).filter(|(factor, _)| !factor.is_zero()) {
        for (sum, entry) in product.iter_mut().zip(matrix_row) {
            *sum = sum.plus(factor.times(*entry));
        }
    }
    product
}

fn signed_remainder(number: &IBig, prime: u64) -> u64 {
    let size = remainder(&number.unsigned_abs(), prime);
    if *number < IBig::ZERO && size > 0 { prime - size } else { size }
}

fn remainder(number: &UBig, prime: u64) -> u64 {
    number % prime
}

fn times(a: u64, b: u64, prime: u64) -> u64 {
    let short = (1 << BITS) - prime;
    // Below 2^66 after the first, and below 2^61 + 2^10 after the second.
    once_less(folded(folded(u128::from(a) * u128::from(b), short), short) as u64, prime)
}

/// A number that is congruent and has about 61 bits less, where 2^61 is `short` modulo the prime.
fn folded(number: u128, short: u64) -> u128 {
    (number >> BITS) * u128::from(short) + (number & ((1 << BITS) - 1))
}

/// The remainder of a number below twice the prime.
fn once_less(number: u64, prime: u64) -> u64 {
    if number >= prime { number - prime } else { number }
}

/// a^(p - 2), by Fermat.
fn inverse(a: u64, prime: u64) -> u64 {
    let (mut power, mut square, mut exponent) = (1, a, prime - 2);
    while exponent > 0 {
        if exponent & 1 == 1 {
            power = times(power, square, prime);
        }
        square = times(square, square, prime);
        exponent >>= 1;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the remainder of the whole product.
    #[test]
    fn products_are_remainders_of_products() {
        for prime in PRIMES {
            let ends =
                [0, 1, 2, 30, 31, 32, prime / 2, prime - 32, prime - 31, prime - 2, prime - 1];
            let spread = (1..200_u64).map(|n| n.wrapping_mul(0x9e37_79b9_7f4a_7c15) % prime);
            let numbers: Vec<u64> = ends.into_iter().chain(spread).collect();
            for a in &numbers {
                for b in &numbers {
                    let whole = u128::from(*a) * u128::from(*b) % u128::from(prime);
                    assert_eq!(u128::from(times(*a, *b, prime)), whole);
                    assert_eq!(once_less(a + b, prime), (a + b) % prime);
                }
                assert_eq!(if *a == 0 { 1 } else { times(*a, inverse(*a, prime), prime) }, 1);
            }
        }
    }
}
