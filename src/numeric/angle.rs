//! Reduction of a large angle to whole turns and a rest in two words.
//!
//! `omega tau` may be as large as 1e21, where one unit in the last place is many turns. The product
//! of the two f64 values is known exactly in two words; so is its rest after division by 2 pi, if
//! 1/(2 pi) is taken to enough bits (Payne and Hanek 1983).

use crate::numeric::two_word::{TWO_PI, TwoWord, cut};

/// The bits of 1/(2 pi) behind the binary point, most significant word first.
const TURNS_PER_RADIAN: [u64; 9] = [
    0x28be_60db_9391_054a,
    0x7f09_d5f4_7d4d_3770,
    0x36d8_a566_4f10_e410,
    0x7f94_58ea_f7ae_f158,
    0x6dc9_1b8e_9093_74b8,
    0x0192_4bba_8274_6487,
    0x3f87_7ac7_2c4a_69cf,
    0xba20_8d7d_4bae_d121,
    0x3a67_1c09_ad17_df90,
];

/// `angle = turns * 2 pi + rest` with `0 <= rest < 2 pi`, for `|angle| <= 2^72`.
#[must_use]
pub fn reduce(angle: TwoWord) -> (i128, TwoWord) {
    let (high_turns, high_fraction) = turns(angle.high);
    let (low_turns, low_fraction) = turns(angle.low);
    let (fraction, carry) = high_fraction.overflowing_add(low_fraction);
    let whole = high_turns + low_turns + i128::from(carry);
    wrap(whole, fraction_to_two_word(fraction).times_two_word(TWO_PI))
}

/// Brings a rest that may have left `[0, 2 pi)` by a few turns back into it.
#[inline(always)]
#[must_use]
pub(crate) fn wrap(turns: i128, rest: TwoWord) -> (i128, TwoWord) {
    if rest.high > 0.0 && rest.high < TWO_PI.high {
        return (turns, rest);
    }
    let (mut turns, whole) = add_floor(turns, rest.high * (1.0 / TWO_PI.high));
    let mut rest = less_turns(rest, whole);
    if !(-TWO_PI.high..=2.0 * TWO_PI.high).contains(&rest.high) {
        return wrap_again(turns, rest);
    }
    if rest.high < 0.0 {
        turns -= 1;
        rest = rest.plus(TWO_PI);
    } else if rest.high > TWO_PI.high || (rest.high == TWO_PI.high && rest.low >= TWO_PI.low) {
        turns += 1;
        rest = rest.minus(TWO_PI);
        // Two roundings may leave the last bit on the wrong side of zero.
        if rest.high < 0.0 {
            rest = TwoWord::ZERO;
        }
    }
    (turns, rest)
}

/// `rest` less so many turns.
#[inline]
fn less_turns(rest: TwoWord, whole: f64) -> TwoWord {
    /// The size up to which the products with the parts of 2 pi are exact.
    const MAX_EXACT_TURNS: f64 = (1 << 20) as f64;
    /// 2 pi in parts of 33 bits, and the rest.
    const TWO_PI_HIGH: f64 = cut(TWO_PI.high);
    const TWO_PI_MIDDLE: f64 = cut((TWO_PI.high - TWO_PI_HIGH) + TWO_PI.low);
    const TWO_PI_LOW: f64 = ((TWO_PI.high - TWO_PI_HIGH) - TWO_PI_MIDDLE) + TWO_PI.low;
    if !(1.0..MAX_EXACT_TURNS).contains(&whole) {
        return rest.minus(TWO_PI.times(whole));
    }
    // The first difference is exact: its digits are those of `rest`, whose unit is 2^-50 at least,
    // and no more than a turn is left.
    let sum = TwoWord::sum(rest.high - whole * TWO_PI_HIGH, -(whole * TWO_PI_MIDDLE));
    TwoWord::sum(sum.high, sum.low + (rest.low - whole * TWO_PI_LOW))
}

/// Takes whole turns off again, because a count of more than 2^53 turns is off by some.
#[cold]
#[inline(never)]
fn wrap_again(turns: i128, rest: TwoWord) -> (i128, TwoWord) {
    if rest.high.is_finite() { wrap(turns, rest) } else { (turns, rest) }
}

/// The largest whole number not above `x`, added to `turns` and by itself; without a call of the
/// library for any that a run meets.
#[inline]
fn add_floor(turns: i128, x: f64) -> (i128, f64) {
    /// The size below which a number is cast to an i64 and back.
    const MAX_CAST_SIZE: f64 = (1_u64 << 62) as f64;
    if x.abs() < MAX_CAST_SIZE {
        let towards_zero = x as i64;
        let whole = towards_zero - i64::from(towards_zero as f64 > x);
        (turns + i128::from(whole), whole as f64)
    } else {
        (turns.saturating_add(x.floor() as i128), x.floor())
    }
}

/// `word / (2 pi)` as a whole number and a fraction in units of 2^-128, rounded down.
fn turns(word: f64) -> (i128, u128) {
    let bits = word.abs().to_bits();
    let stored_exponent = (bits >> 52) as i32;
    let fraction_bits = bits & ((1 << 52) - 1);
    let (mantissa, exponent) = match stored_exponent {
        0 => (fraction_bits, -1074),
        _ => (fraction_bits | 1 << 52, stored_exponent - 1075),
    };
    let (whole, fraction) = shifted_product(mantissa, exponent);
    if word < 0.0 && fraction != 0 {
        (-whole - 1, fraction.wrapping_neg())
    } else if word < 0.0 {
        (-whole, 0)
    } else {
        (whole, fraction)
    }
}

/// `mantissa * 2^exponent / (2 pi)`, whole part and 128 bits of fraction; `exponent <= 20`.
fn shifted_product(mantissa: u64, exponent: i32) -> (i128, u128) {
    // Limbs of the 640-bit product, least significant first; its unit is 2^(exponent - 576).
    let mut limbs = [0_u64; 10];
    let mut carry = 0_u128;
    for (limb, word) in limbs.iter_mut().zip(TURNS_PER_RADIAN.iter().rev()) {
        carry += u128::from(mantissa) * u128::from(*word);
        *limb = carry as u64;
        carry >>= 64;
    }
    limbs[9] = carry as u64;
    let shift = 448 - exponent; // from the product's unit to 2^-128
    let window = |from: i32| -> u64 {
        let (limb, bit) = (from.div_euclid(64), from.rem_euclid(64));
        let at = |i: i32| usize::try_from(i).ok().and_then(|i| limbs.get(i)).copied().unwrap_or(0);
        if bit == 0 { at(limb) } else { at(limb) >> bit | at(limb + 1) << (64 - bit) }
    };
    let fraction = u128::from(window(shift)) | u128::from(window(shift + 64)) << 64;
    let whole = u128::from(window(shift + 128)) | u128::from(window(shift + 192)) << 64;
    (whole as i128, fraction)
}

/// A fraction in units of 2^-128 as two words in `[0, 1)`.
fn fraction_to_two_word(fraction: u128) -> TwoWord {
    let high = (fraction >> 75) as f64 * 2.0_f64.powi(-53);
    let low = (fraction & ((1 << 75) - 1)) as f64 * 2.0_f64.powi(-128);
    TwoWord::ZERO.plus(TwoWord::sum(high, low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Sines computed with 60 digits (mpmath) at awkward arguments.
    const KNOWN_SINES: [(f64, f64); 3] = [
        (1e15, 0.858_272_793_170_235_835_52),
        (1e21, -0.667_120_177_071_804_847),
        (-1e15, -0.858_272_793_170_235_835_52),
    ];

    #[test]
    fn sines_of_large_angles() {
        for (angle, sine) in &KNOWN_SINES {
            let (_, rest) = reduce(TwoWord::new(*angle));
            approx::assert_abs_diff_eq!(rest.value().sin(), *sine, epsilon = 4.0 * f64::EPSILON);
        }
    }

    #[test]
    fn more_turns_than_a_word_counts_come_off_too() {
        for rest in [4e17, -4e17, 1e30, -1e36] {
            let (_, wrapped) = wrap(0, TwoWord::new(rest));
            assert!((0.0..=TWO_PI.high).contains(&wrapped.high), "{rest}: {wrapped:?}");
        }
    }

    proptest! {
        #[test]
        fn turns_and_rest_make_the_angle(angle in -1e6_f64..1e6) {
            let (turns, rest) = reduce(TwoWord::new(angle));
            prop_assert!(rest.value() >= 0.0 && rest.value() <= TWO_PI.high);
            let back = TWO_PI.times(turns as f64).plus(rest).minus(TwoWord::new(angle));
            // Four roundings of 2^-105 relative to 1e6.
            prop_assert!(back.value().abs() <= 1e-25);
        }

        #[test]
        fn whole_turns_come_off_as_they_would_by_a_product(
            turns in 1.0..1e6_f64, share in 0.0..1.0_f64, low in -1.0..1.0_f64,
        ) {
            let whole = turns.floor();
            let high = (whole + share) * TWO_PI.high;
            let rest = TwoWord::sum(high, 0.25 * f64::EPSILON * high * low);
            let difference = less_turns(rest, whole).minus(rest.minus(TWO_PI.times(whole))).value();
            // Either rounds by eps^2 of the angle, as its second word did.
            prop_assert!(difference.abs() <= 2.0 * f64::EPSILON * f64::EPSILON * high);
        }

        #[test]
        fn wrapping_keeps_the_angle(turns in -5_i32..6, rest in -20.0_f64..20.0) {
            let (whole, wrapped) = wrap(i128::from(turns), TwoWord::new(rest));
            prop_assert!(wrapped.high >= 0.0 && wrapped.value() <= TWO_PI.high);
            let back = TWO_PI.times((whole - i128::from(turns)) as f64).plus(wrapped);
            prop_assert!((back.value() - rest).abs() <= 1e-30 + 2.0 * f64::EPSILON * rest.abs());
        }
    }
}
