//! Roots, the exponential, sine and cosine of wide numbers.

use super::limbs::{add_into, quotient_by_word, subtract_from, times_word};
use super::{Kind, MAX_WORDS, Wide};
use crate::numeric::number::Number;
use std::sync::OnceLock;

/// The words of a constant: those of a number, and as many below it.
const CONSTANT_WORDS: usize = 2 * MAX_WORDS;

/// The largest exponent of an argument of the exponential: powers of two are counted in 64 bits.
const MAX_EXPONENT: i64 = 61;

/// The least number of bits that one multiple of a constant takes off an argument: it has the
/// digits of f64 alone.
const MULTIPLE_BITS: i64 = 50;

/// The number of bits to which an f64 begins an iteration.
const FIRST_BITS: usize = 48;

/// The sum of 1/((2 k + 1) n^(2 k + 1)) as a fraction, with alternating signs or without: the
/// inverse (hyperbolic) tangent of 1/n.
fn inverse_tangent(n: u64, alternates: bool) -> [u64; CONSTANT_WORDS] {
    let mut power = [0; CONSTANT_WORDS];
    // 2^(64 CONSTANT_WORDS) - 1 for one: the words below are far beyond those that are used.
    power.fill(u64::MAX);
    quotient_by_word(&mut power, n);
    let mut sum = power;
    let mut odd = 1;
    while power.iter().any(|it| *it != 0) {
        odd += 2;
        quotient_by_word(&mut power, n * n);
        let mut term = power;
        quotient_by_word(&mut term, odd);
        if alternates && odd % 4 == 3 {
            subtract_from(&mut sum, &term);
        } else {
            add_into(&mut sum, &term);
        }
    }
    sum
}

/// A quarter of pi as a fraction, by Machin's formula.
fn quarter_pi() -> &'static [u64; CONSTANT_WORDS] {
    static WORDS: OnceLock<[u64; CONSTANT_WORDS]> = OnceLock::new();
    WORDS.get_or_init(|| {
        let mut sum = inverse_tangent(5, true);
        times_word(&mut sum, 4);
        subtract_from(&mut sum, &inverse_tangent(239, true));
        sum
    })
}

/// The natural logarithm of two as a fraction:
/// 18 artanh(1/26) - 2 artanh(1/4801) + 8 artanh(1/8749).
fn logarithm_of_two() -> &'static [u64; CONSTANT_WORDS] {
    static WORDS: OnceLock<[u64; CONSTANT_WORDS]> = OnceLock::new();
    WORDS.get_or_init(|| {
        let [mut sum, mut less, mut more] = [26, 4801, 8749].map(|it| inverse_tangent(it, false));
        times_word(&mut sum, 18);
        times_word(&mut less, 2);
        times_word(&mut more, 8);
        subtract_from(&mut sum, &less);
        add_into(&mut sum, &more);
        sum
    })
}

impl<const WORDS: usize, const BITS: usize> Wide<WORDS, BITS> {
    /// The number of halvings after which a series is short, as it is best for so many bits.
    const HALVINGS: i64 = (BITS.isqrt() / 2) as i64;

    /// The largest exponent of an argument of sine and cosine: its multiples of the second part of
    /// a constant are small, and those of the first are within f64.
    const MAX_ANGLE_EXPONENT: i64 = match 64 * (WORDS as i64 - 2) {
        bits if bits < 1000 => bits,
        _ => 1000,
    };

    /// A constant in two parts, of which multiples of the first are exact.
    fn split(words: &[u64; CONSTANT_WORDS], exponent: i64) -> [Self; 2] {
        let below = CONSTANT_WORDS - (WORDS - 1);
        let high = Self::constant(&words[below..], exponent);
        let low = exponent - 64 * (WORDS as i64 - 1);
        [high, Self::constant(&words[below - WORDS..below], low)]
    }

    /// The number less its nearest multiple of a constant, the multiple modulo four, and the
    /// multiple where 64 bits hold it.
    fn reduced(self, [high, low]: [Self; 2]) -> (Self, i64, i64) {
        let (mut rest, mut below) = (self, Self::ZERO);
        let (mut quarter, mut count) = (0, 0_i64);
        let constant = high.to_f64();
        for _ in 0..2 + self.exponent.max(0) / MULTIPLE_BITS {
            let multiple = (rest.to_f64() / constant).round();
            let factor = Self::exact(multiple);
            // The difference is exact, and what the second part takes off would be rounded with it.
            rest = rest - factor * high;
            below = below + factor * low;
            quarter += (multiple % 4.0) as i64;
            count = count.saturating_add(multiple as i64);
        }
        (rest - below, quarter.rem_euclid(4), count)
    }

    /// 1/x of an ordinary number, by Newton's method.
    pub(super) fn inverse(self) -> Self {
        let fraction = Self { exponent: 0, ..self };
        let mut inverse = Self::exact(1.0 / fraction.to_f64());
        let mut bits = FIRST_BITS;
        while bits < 64 * WORDS {
            inverse = inverse + inverse * (Self::one() - fraction * inverse);
            bits *= 2;
        }
        inverse.scaled(-self.exponent)
    }

    pub(super) fn square_root(self) -> Self {
        if self.kind != Kind::Ordinary {
            return self;
        }
        if self.is_negative {
            return Self::UNKNOWN;
        }
        let half = self.exponent.div_euclid(2);
        let fraction = self.scaled(-2 * half);
        let mut inverse = Self::exact(1.0 / fraction.to_f64().sqrt());
        let mut bits = FIRST_BITS;
        while bits < 64 * WORDS {
            let rest = Self::one() - fraction * inverse * inverse;
            inverse = inverse + (inverse * rest).scaled(-1);
            bits *= 2;
        }
        let root = fraction * inverse;
        let root = root + (inverse * (fraction - root * root)).scaled(-1);
        root.scaled(half)
    }

    pub(super) fn exponential(self) -> Self {
        match self.kind {
            Kind::Zero => return Self::one(),
            Kind::Unknown => return self,
            Kind::Ordinary if self.exponent > MAX_EXPONENT => {
                return if self.is_negative { Self::ZERO } else { Self::UNKNOWN };
            }
            Kind::Ordinary => {}
        }
        let (rest, _, powers) = self.reduced(Self::split(logarithm_of_two(), 0));
        let small = rest.scaled(-Self::HALVINGS);
        // exp(x) - 1, whose digits the doublings keep: (1 + e)^2 - 1 = e (2 + e).
        let (mut sum, mut term, mut n) = (small, small, 1);
        while !term.is_below(&sum) {
            n += 1;
            term = (term * small).over(n);
            sum = sum + term;
        }
        let two = Self::one().scaled(1);
        let grown = (0..Self::HALVINGS).fold(sum, |it, _| it * (two + it));
        (Self::one() + grown).scaled(powers)
    }

    pub(super) fn sine_and_cosine(self) -> (Self, Self) {
        if self.kind == Kind::Unknown || self.exponent > Self::MAX_ANGLE_EXPONENT {
            return (Self::UNKNOWN, Self::UNKNOWN);
        }
        let (rest, quarter, _) = self.reduced(Self::split(quarter_pi(), 1));
        let versine = rest.versine();
        let two = Self::one().scaled(1);
        let size = (versine * (two - versine)).square_root();
        let sin = if rest.is_negative { -size } else { size };
        let cos = Self::one() - versine;
        match quarter {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }

    /// 1 - cos(x) of a small angle, all of whose digits the doublings keep:
    /// 1 - cos(2 x) = 2 v (2 - v).
    fn versine(self) -> Self {
        let small = self.scaled(-Self::HALVINGS);
        let square = small * small;
        let mut term = square.scaled(-1);
        let (mut sum, mut n) = (term, 2);
        while !term.is_below(&sum) {
            term = -(term * square).over((n + 1) * (n + 2));
            sum = sum + term;
            n += 2;
        }
        let two = Self::one().scaled(1);
        (0..Self::HALVINGS).fold(sum, |it, _| (it * (two - it)).scaled(1))
    }

    /// Whether the number is below the last bit of another one.
    fn is_below(&self, other: &Self) -> bool {
        self.kind != Kind::Ordinary || self.exponent < other.exponent - 64 * WORDS as i64
    }
}
