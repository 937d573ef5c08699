//! A number carried in two f64 words: their exact sum, about 106 bits.
//!
//! Used where one word would lose what the run needs: the forcing angle and the drift. The full
//! double-double arithmetic of the truth lives outside this crate; these are only the
//! error-free transformations (Dekker 1971, Knuth 1969) that a clock and a sum need.

/// An unevaluated sum `high + low` with `|low| <= ulp(high)/2`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TwoWord {
    /// The sum rounded to one word.
    pub high: f64,
    /// The remainder of that rounding: the number is `high + low`.
    pub low: f64,
}

/// 2 pi in two words (relative error 2e-33).
pub const TWO_PI: TwoWord =
    TwoWord { high: std::f64::consts::TAU, low: 2.449_293_598_294_706_4e-16 };

impl TwoWord {
    /// The number zero.
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };

    /// The two-word number that equals this one word.
    #[must_use]
    pub const fn new(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    /// The exact sum of two words.
    #[must_use]
    pub const fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let b_seen = high - a;
        let low = (a - (high - b_seen)) + (b - b_seen);
        Self { high, low }
    }

    /// The exact product of two words, unless it over- or underflows.
    #[must_use]
    pub const fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        let (a_high, a_low) = halves(a);
        let (b_high, b_low) = halves(b);
        let low = ((a_high * b_high - high) + a_high * b_low + a_low * b_high) + a_low * b_low;
        Self { high, low }
    }

    /// Rounded to one word.
    #[must_use]
    pub const fn value(self) -> f64 {
        self.high + self.low
    }

    /// `self + other`.
    #[must_use]
    pub const fn plus(self, other: Self) -> Self {
        let high = Self::sum(self.high, other.high);
        let low = Self::sum(self.low, other.low);
        let carried = quick_sum(high.high, high.low + low.high);
        quick_sum(carried.high, carried.low + low.low)
    }

    /// `self - other`.
    #[must_use]
    pub const fn minus(self, other: Self) -> Self {
        self.plus(Self { high: -other.high, low: -other.low })
    }

    /// `self + other` where neither is negative: nothing cancels, and fewer steps do.
    #[must_use]
    pub const fn plus_positive(self, other: Self) -> Self {
        let high = Self::sum(self.high, other.high);
        quick_sum(high.high, high.low + (self.low + other.low))
    }

    /// `self + time * rate` where none of them is negative.
    #[must_use]
    pub const fn plus_product(self, time: Self, rate: f64) -> Self {
        let product = Self::product(time.high, rate);
        self.plus_positive(Self { low: product.low + time.low * rate, ..product })
    }

    /// `self * factor`.
    #[must_use]
    pub const fn times(self, factor: f64) -> Self {
        let high = Self::product(self.high, factor);
        quick_sum(high.high, high.low + self.low * factor)
    }

    /// `self * other`.
    #[must_use]
    pub const fn times_two_word(self, other: Self) -> Self {
        let high = Self::product(self.high, other.high);
        quick_sum(high.high, high.low + (self.high * other.low + self.low * other.high))
    }

    /// `self / divisor`.
    #[must_use]
    pub const fn over(self, divisor: f64) -> Self {
        let first = self.high / divisor;
        let seen = Self::product(first, divisor);
        // The first difference is exact: both round the same product.
        let rest = ((self.high - seen.high) - seen.low) + self.low;
        quick_sum(first, rest / divisor)
    }
}

/// 1.5 * 2^52: a sum with it is rounded to a whole number, which its last bits hold, negative ones
/// as well.
pub(crate) const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// The first 33 bits of a word: whole numbers below 2^20 times that are exact.
pub(crate) const fn cut(word: f64) -> f64 {
    f64::from_bits(word.to_bits() & !((1 << 20) - 1))
}

/// The exact sum where `|a| >= |b|`.
const fn quick_sum(a: f64, b: f64) -> TwoWord {
    let high = a + b;
    TwoWord { high, low: b - (high - a) }
}

/// Veltkamp's splitting of a word into two of 26 bits.
const fn halves(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = SPLITTER * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_product_is_added_as_it_would_be_by_itself(
            a in 0.0..7.0_f64, time in 0.0..1e3_f64, rate in 0.01..100.0_f64, low in (-1.0..1.0_f64, -1.0..1.0_f64),
        ) {
            let word = |high: f64, low: f64| TwoWord::sum(high, 0.5 * f64::EPSILON * high * low);
            let (a, time) = (word(a, low.0), word(time, low.1));
            let rest = a.plus_product(time, rate).minus(a.plus(time.times(rate))).value();
            // Three roundings of words below eps of the sum.
            let size = a.high + time.high * rate;
            prop_assert!(rest.abs() <= 3.0 * f64::EPSILON * f64::EPSILON * size);
        }

        #[test]
        fn product_agrees_with_integers(a in -1_i64 << 50..1_i64 << 50, b in -1_i64 << 50..1_i64 << 50) {
            let product = TwoWord::product(a as f64, b as f64);
            prop_assert_eq!(product.high as i128 + product.low as i128, i128::from(a) * i128::from(b));
        }

        #[test]
        fn sum_agrees_with_integers(a in any::<i64>(), b in -1_i64 << 40..1_i64 << 40) {
            let a = a as f64;
            let sum = TwoWord::sum(a, b as f64);
            prop_assert_eq!(sum.high as i128 + sum.low as i128, a as i128 + i128::from(b));
        }

        #[test]
        fn a_sum_of_positive_numbers_agrees_with_any(
            a in 0.0..1e3_f64, b in 0.0..1e3_f64, low in (-1.0..1.0_f64, -1.0..1.0_f64),
        ) {
            let word = |high: f64, low: f64| TwoWord::sum(high, 0.5 * f64::EPSILON * high * low);
            let (a, b) = (word(a, low.0), word(b, low.1));
            let rest = a.plus_positive(b).minus(a.plus(b)).value();
            // Two roundings of words below eps of the sum.
            prop_assert!(rest.abs() <= 2.0 * f64::EPSILON * f64::EPSILON * (a.high + b.high));
        }

        #[test]
        fn division_undoes_multiplication(a in 0.1..10.0_f64, b in 0.1..10.0_f64) {
            let quotient = TwoWord::new(a).times(b).over(b);
            prop_assert_eq!(quotient.high, a);
            // Three roundings of 2^-106 relative.
            prop_assert!(quotient.low.abs() <= 4.0 * f64::EPSILON * f64::EPSILON * a);
        }
    }
}
