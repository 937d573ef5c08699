//! Sine and cosine of an f64 by a table of the turn's 64th parts.
//!
//! An event needs three or four of them in one dependent chain. Between two entries of the table a
//! series of four terms does, in little more than half the instructions of the library; the entries
//! are held in two words. Errors are below half a unit in the last place of the value and a tenth
//! of one of 1: three fifths of a unit where the value is large, more units where it is small. Only
//! additions and multiplications, hence the same bits on every platform.

use crate::numeric::two_word::{ROUNDER, TWO_PI, TwoWord, cut};

/// Parts of a turn.
const PARTS: usize = 64;

/// The size up to which the part's number times the part's first word is exact.
const MAX_TABLE_ANGLE: f64 = 6e4;

/// 2 pi/64 in three words, of which the first has 33 bits.
const PART_HIGH: f64 = cut(TWO_PI.high / PARTS as f64);
const PART_LOW: f64 = (TWO_PI.high / PARTS as f64 - PART_HIGH) + TWO_PI.low / PARTS as f64;

/// Sine and cosine of a part's end.
#[derive(Clone, Copy)]
struct PartEnd {
    sin: TwoWord,
    cos: TwoWord,
}

static PART_ENDS: [PartEnd; PARTS] = ends();

/// Sine and cosine of `x`, radians.
#[inline]
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    // Written so that a NaN goes to the library.
    if x.abs() < MAX_TABLE_ANGLE { by_table(x) } else { libm::sincos(x) }
}

#[inline]
fn by_table(x: f64) -> (f64, f64) {
    let rounded = x * (PARTS as f64 / TWO_PI.high) + ROUNDER;
    let PartEnd { sin, cos } = PART_ENDS[rounded.to_bits() as usize % PARTS];
    let parts = rounded - ROUNDER;
    let near = x - parts * PART_HIGH;
    let second = parts * PART_LOW;
    let r = near - second;
    let low = (near - r) - second;
    let square = r * r;
    // sin r - r and cos r - 1 for |r| <= 0.0491: the next terms are 5e-18 and 3e-20.
    let s = r * square * (-1.0 / 6.0 + square * (1.0 / 120.0 - square * (1.0 / 5040.0)));
    let c = square
        * (-0.5 + square * (1.0 / 24.0 + square * (-1.0 / 720.0 + square * (1.0 / 40320.0))));
    let s = r + (s + low);
    (
        sin.high + (sin.low + (cos.high * s + sin.high * c)),
        cos.high + (cos.low + (cos.high * c - sin.high * s)),
    )
}

/// The table, from the series at the first eighth of the turn.
const fn ends() -> [PartEnd; PARTS] {
    const QUARTER_PARTS: usize = PARTS / 4;
    let mut table = [PartEnd { sin: TwoWord::ZERO, cos: TwoWord::ZERO }; PARTS];
    let mut k = 0;
    while k < PARTS {
        let within = k % QUARTER_PARTS;
        let mirrored = 2 * within > QUARTER_PARTS;
        let steps = if mirrored { QUARTER_PARTS - within } else { within };
        let (mut sin, mut cos) = taylor(TWO_PI.times(steps as f64 / PARTS as f64));
        if mirrored {
            (sin, cos) = (cos, sin);
        }
        let mut quarter = 0;
        while quarter < k / QUARTER_PARTS {
            (sin, cos) = (cos, TwoWord { high: -sin.high, low: -sin.low });
            quarter += 1;
        }
        table[k] = PartEnd { sin, cos };
        k += 1;
    }
    table
}

/// Sine and cosine in two words for angles up to an eighth of the turn.
const fn taylor(x: TwoWord) -> (TwoWord, TwoWord) {
    const TERMS: usize = 28;
    let square = x.times_two_word(x);
    let (mut sin, mut cos) = (TwoWord::new(1.0), TwoWord::new(1.0));
    let mut k = TERMS;
    while k > 0 {
        // 1 - x^2/(k (k + 1)) (1 - ...)
        k -= 2;
        if k == 0 {
            break;
        }
        let n = k as f64;
        sin = TwoWord::new(1.0).minus(square.times_two_word(sin).over(n * (n + 1.0)));
        cos = TwoWord::new(1.0).minus(square.times_two_word(cos).over((n - 1.0) * n));
    }
    (x.times_two_word(sin), cos)
}

/// Sine and cosine to about 1e-7, for angles up to 1e9 or so.
#[must_use]
pub fn rough_sin_cos(x: f64) -> (f64, f64) {
    let turns = (x * std::f64::consts::FRAC_2_PI + ROUNDER) - ROUNDER;
    let r = x - turns * std::f64::consts::FRAC_PI_2;
    let s = r * r;
    let sin = r * (1.0 - s * (1.0 / 6.0 - s * (1.0 / 120.0 - s * (1.0 / 5040.0))));
    let cos = 1.0 - s * (0.5 - s * (1.0 / 24.0 - s * (1.0 / 720.0 - s * (1.0 / 40320.0))));
    // Quarters of the turn: which of the two, and with which sign, without a jump that cannot be
    // foretold.
    let quarters = turns as i64 as u64;
    let sign = |quarters: u64| (quarters & 2) << 62;
    let (s, c) = if quarters & 1 == 0 { (sin, cos) } else { (cos, sin) };
    (
        f64::from_bits(s.to_bits() ^ sign(quarters)),
        f64::from_bits(c.to_bits() ^ sign(quarters.wrapping_add(1))),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The rounding of what is added to the table's entry, which is below 0.051 and rounded four
    /// times.
    const CORRECTION: f64 = 4.0 * 0.051 * 0.5 * f64::EPSILON;

    /// The library's error is below 0.8 units in the last place, ours below half a unit and that.
    const ROUNDING_TOLERANCE: f64 = 1.3 * f64::EPSILON;

    fn agrees(x: f64) -> Result<(), TestCaseError> {
        let ((sin, cos), (s, c)) = (sin_cos(x), libm::sincos(x));
        // Next to a zero the reduction leaves 2^-90 of the angle.
        let room = |value: f64| ROUNDING_TOLERANCE * value.abs() + CORRECTION + 1e-22 * x.abs();
        prop_assert!((sin - s).abs() <= room(s), "sin {x}: {sin} {s}");
        prop_assert!((cos - c).abs() <= room(c), "cos {x}: {cos} {c}");
        Ok(())
    }

    proptest! {
        #[test]
        fn agrees_with_the_library(x in -20.0..20.0_f64, far in -7e4..7e4_f64) {
            agrees(x)?;
            agrees(far)?;
        }

        #[test]
        fn agrees_next_to_the_ends(k in -200_i32..200, off in -1e-8..1e-8_f64, half in 0..2) {
            let end = (f64::from(k) + 0.5 * f64::from(half)) * (TWO_PI.high / PARTS as f64);
            agrees(end + off)?;
            agrees(end)?;
        }
    }

    /// Sine and cosine in two words: whole quarters of the turn taken off, then the series.
    fn exact(x: f64) -> (TwoWord, TwoWord) {
        let quarters = (x / (0.25 * TWO_PI.high)).round();
        let rest = TwoWord::new(x).minus(TWO_PI.times(0.25 * quarters));
        let backwards = rest.high < 0.0;
        let turned = |it: TwoWord| TwoWord { high: -it.high, low: -it.low };
        let (mut sin, mut cos) = taylor(if backwards { turned(rest) } else { rest });
        if backwards {
            sin = turned(sin);
        }
        for _ in 0..quarters.rem_euclid(4.0) as u32 {
            (sin, cos) = (cos, turned(sin));
        }
        (sin, cos)
    }

    #[test]
    fn errs_by_the_last_rounding_and_those_of_a_small_correction() {
        let share = |found: f64, exact: TwoWord| {
            let unit = f64::from_bits(exact.high.abs().to_bits() + 1) - exact.high.abs();
            TwoWord::new(found).minus(exact).value().abs() / (0.5 * unit + CORRECTION)
        };
        let mut worst = 0.0_f64;
        for k in 0..400_000 {
            let x = f64::from(k) * 1.000_244_140_625e-4 - 20.0;
            let ((sin, cos), (s, c)) = (sin_cos(x), exact(x));
            worst = worst.max(share(sin, s)).max(share(cos, c));
        }
        println!("worst: {worst} of the room");
        assert!(worst <= 1.0, "{worst}");
    }

    #[test]
    fn what_is_not_finite_is_no_number() {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let (sin, cos) = sin_cos(x);
            assert!(sin.is_nan() && cos.is_nan());
        }
    }
}
