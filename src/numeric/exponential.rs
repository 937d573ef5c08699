//! The exponential of an f64 by a table of 64 parts of a doubling, as [`crate::numeric::circle`]
//! has sine and cosine.
//!
//! The library divides, and its operations form one dependent chain; here a short series multiplies
//! an entry of the table, which is held in two words. The error is half a unit in the last place
//! and two hundredths. Only additions and multiplications, hence the same bits on every platform.

use crate::numeric::two_word::{ROUNDER, TwoWord, cut};

/// Parts of a doubling.
const PARTS: usize = 64;

/// The size up to which the result and all its parts are normal numbers.
const MAX_TABLE_ARGUMENT: f64 = 700.0;

/// ln 2 (relative error 1e-33).
pub(crate) const LN_2: TwoWord =
    TwoWord { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };

/// ln 2/64 in two words, of which the first has 33 bits.
const PART_HIGH: f64 = cut(LN_2.high / PARTS as f64);
const PART_LOW: f64 = (LN_2.high / PARTS as f64 - PART_HIGH) + LN_2.low / PARTS as f64;

static POWERS: [TwoWord; PARTS] = powers();

/// exp(x)
#[inline]
#[must_use]
pub fn exp(x: f64) -> f64 {
    // Written so that a NaN goes to the library.
    if x.abs() < MAX_TABLE_ARGUMENT { by_table(x) } else { libm::exp(x) }
}

#[inline]
fn by_table(x: f64) -> f64 {
    let rounded = x * (PARTS as f64 / LN_2.high) + ROUNDER;
    let parts = rounded - ROUNDER;
    let number = rounded.to_bits() as i32;
    let power = POWERS[number as usize % PARTS];
    let doublings = number.div_euclid(PARTS as i32);
    let scale = f64::from_bits(((1023 + doublings) as u64) << 52);
    let r = (x - parts * PART_HIGH) - parts * PART_LOW;
    let square = r * r;
    // exp(r) - 1 for |r| <= 0.0055: the next term is 3e-20.
    let high = 1.0 / 24.0 + r * (1.0 / 120.0) + square * (1.0 / 720.0);
    let grown = r + square * ((0.5 + r * (1.0 / 6.0)) + square * high);
    scale * (power.high + (power.low + power.high * grown))
}

/// The table, from the series.
const fn powers() -> [TwoWord; PARTS] {
    let mut table = [TwoWord::ZERO; PARTS];
    let mut k = 0;
    while k < PARTS {
        table[k] = taylor(LN_2.times(k as f64 / PARTS as f64));
        k += 1;
    }
    table
}

/// exp(x) in two words for 0 <= x <= ln 2.
const fn taylor(x: TwoWord) -> TwoWord {
    const TERMS: usize = 30;
    let mut sum = TwoWord::new(1.0);
    let mut k = TERMS;
    while k > 0 {
        // 1 + x/k (1 + ...)
        sum = TwoWord::new(1.0).plus(x.times_two_word(sum).over(k as f64));
        k -= 1;
    }
    sum
}

/// exp(-z) to a per cent or so for z < 1, and never less than it.
#[must_use]
pub fn rough_decay(z: f64) -> f64 {
    let base = 1.0 + z * (1.0 / 16.0 + z * (1.0 / 512.0));
    let fourth = base * base * (base * base);
    let eighth = fourth * fourth;
    1.0 / (eighth * eighth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// exp(|x|) in two words, for |x| up to 20.
    fn exact(x: f64) -> TwoWord {
        let halvings = 6;
        let mut power = taylor(TwoWord::new(x.abs()).times(0.5_f64.powi(halvings)));
        for _ in 0..halvings {
            power = power.times_two_word(power);
        }
        power
    }

    #[test]
    fn errs_by_the_last_rounding_and_those_of_a_small_correction() {
        let mut worst = 0.0_f64;
        for k in 0..200_000 {
            let x = f64::from(k) * 1.000_244_140_625e-4;
            let (value, exact) = (exp(x), exact(x));
            let unit = f64::from_bits(value.to_bits() + 1) - value;
            let of_one = exact.times(exp(-x)).minus(TwoWord::new(1.0)).value();
            worst = worst.max(TwoWord::new(value).minus(exact).value().abs() / unit);
            // A relative error of half a unit is up to eps/2.
            worst = worst.max(of_one.abs() / f64::EPSILON);
        }
        println!("worst: {worst} units");
        // What is multiplied to the table's entry changes it by less than 0.0055, with four
        // roundings.
        assert!(worst <= 0.5 + 4.0 * 0.0055, "{worst}");
    }

    proptest! {
        #[test]
        fn agrees_with_the_library(x in -760.0..720.0_f64, small in -1e-3..1e-3_f64) {
            for x in [x, small, small * 1e-9] {
                let (own, library) = (exp(x), libm::exp(x));
                // The library's error is below one unit.
                let near = (own - library).abs() <= 1.6 * f64::EPSILON * library;
                prop_assert!(near || own == library, "{x}: {own} {library}");
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_as_in_the_library() {
        assert!(exp(f64::NAN).is_nan());
        assert_eq!(exp(f64::INFINITY), f64::INFINITY);
        assert_eq!(exp(f64::NEG_INFINITY), 0.0);
        assert_eq!(exp(0.0), 1.0);
    }
}
