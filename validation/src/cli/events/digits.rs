//! Decimals that hold only digits that are proved.

use dashu::integer::{IBig, UBig};
use percuss::number::{Bound, Number};
use std::cmp::Ordering;

/// The largest power of ten that is looked at.
const LARGEST: i32 = 400;

/// The largest number of f64 whose sum a number is taken for: more than those of 3392 bits.
const MOST_WORDS: usize = 80;

/// Up to this exponent of two numbers are taken as they are; others are divided by a power of two,
/// because f64 has no such exponents.
const ORDINARY: i64 = 800;

/// Beyond this exponent of two no digits are printed, because powers of ten become too long.
const LONGEST: i64 = 4_000_000;

/// A value with a bound of its error, to at most `digits` significant digits: as many as all
/// numbers within the error round to alike. Where that is none it is a zero with an exponent, such
/// as `0e-28`: the value is less than that power of ten in size, which is larger than any number of
/// f64 where nothing is known of it.
pub(super) fn proved<T: Number>(value: T, error: T::Bound, digits: usize) -> String {
    let size = value.bound().abs();
    let exponent = size.max(error).parts().1;
    if exponent.abs() > LONGEST {
        // The logarithm of two, rounded up.
        return format!("0e{}", ((exponent + 1) as f64 * 0.301_029_995_663_981_3).ceil() + 1.0);
    }
    let shift = if exponent.abs() <= ORDINARY { 0 } else { exponent };
    let words = words(value.scaled(-shift));
    let error = error.scaled(-shift).to_f64();
    if !(error.is_finite() && words.iter().all(|it| it.is_finite())) {
        return format!("0e{LARGEST}");
    }
    // What a value has below the exponents of f64 is an error, too.
    let error = if words.len() > 2 { error.abs() + f64::MIN_POSITIVE } else { error.abs() };
    let ends = Ends::of(&words, error, shift as i32);
    if ends.least == IBig::ZERO && ends.most == IBig::ZERO {
        return "0".to_owned();
    }
    let leading = ends.leading_power(&ends.middle, size);
    for count in (1..=digits).rev() {
        let last = leading - i32::try_from(count).unwrap_or(0) + 1;
        if shift == 0 && is_wider(error, last) {
            continue;
        }
        let rounded = ends.rounded(&ends.least, last);
        if rounded != IBig::ZERO && rounded == ends.rounded(&ends.most, last) {
            return cell(&rounded.to_string(), last, digits);
        }
    }
    let bound = [&ends.least, &ends.most].map(|it| it.clone().into_parts().1);
    let size = size + T::Bound::of(error).scaled(shift);
    let bound = IBig::from(bound.into_iter().max().unwrap_or_default());
    format!("0e{}", ends.leading_power(&bound, size) + 1)
}

/// A number that is not below (or not above) a value by more than its error, to some digits.
pub(super) fn outward<T: Number>(value: T, is_upper: bool, digits: i32) -> String {
    let ends = Ends::of(&words(value), 0.0, 0);
    let last = ends.leading_power(&ends.middle, value.bound().abs()) - digits + 1;
    let rounded = ends.rounded(&ends.middle, last);
    // A unit of the last digit is more than the rounding.
    let unit = if is_upper { IBig::ONE } else { -IBig::ONE };
    decimal(&(rounded + unit).to_string(), last)
}

/// Whether a printed number has a digit.
pub(super) fn has_digits(text: &str) -> bool {
    !text.starts_with("0e")
}

/// The number of significant digits of a printed number; none for a zero that is exact.
pub(super) fn significant(text: &str) -> Option<usize> {
    if text == "0" {
        return None;
    }
    let digits = text.split('e').next().unwrap_or_default().bytes().filter(u8::is_ascii_digit);
    Some(digits.skip_while(|it| *it == b'0').count())
}

/// The f64 whose sum a number is, the largest first; the last is not finite where the number is
/// not, or has more of them than are looked at.
fn words<T: Number>(mut value: T) -> Vec<f64> {
    let mut words = Vec::new();
    loop {
        let word = value.to_f64();
        if word == 0.0 {
            return words;
        }
        if words.len() == MOST_WORDS {
            words.push(f64::NAN);
            return words;
        }
        words.push(word);
        if !word.is_finite() {
            return words;
        }
        value = value - T::exact(word);
    }
}

/// The ends of an interval and its middle, as integers in units of a power of two.
struct Ends {
    least: IBig,
    middle: IBig,
    most: IBig,
    exponent: i32,
}

impl Ends {
    /// The sum of words with an error, times a power of two.
    fn of(words: &[f64], error: f64, shift: i32) -> Self {
        let exponents =
            words.iter().chain([&error]).filter(|it| **it != 0.0).map(|it| split(*it).1);
        let exponent = exponents.min().unwrap_or(0);
        let units = |word: f64| {
            let (mantissa, own) = split(word);
            IBig::from(mantissa) << (own - exponent).max(0) as usize
        };
        let middle = words.iter().fold(IBig::ZERO, |sum, word| sum + units(*word));
        let error = units(error);
        let exponent = exponent + shift;
        Self { least: &middle - &error, most: &middle + &error, middle, exponent }
    }

    /// A number of the units in units of a power of ten: a quotient, whose divisor is also to be
    /// multiplied by so many twos.
    fn quotient(&self, number: &IBig, last: i32) -> (IBig, UBig, usize) {
        let ten = UBig::from(10_u8).pow(last.unsigned_abs() as usize);
        let two = self.exponent.unsigned_abs() as usize;
        let number = if last < 0 { number * IBig::from(ten.clone()) } else { number.clone() };
        let divisor = if last > 0 { ten } else { UBig::ONE };
        if self.exponent < 0 { (number, divisor, two) } else { (number << two, divisor, 0) }
    }

    /// A number of the units in units of a power of ten, rounded; halves away from zero.
    fn rounded(&self, number: &IBig, last: i32) -> IBig {
        let (number, divisor, twos) = self.quotient(number, last);
        let (sign, size) = number.into_parts();
        let twice = (size << 1) + (&divisor << twos);
        let halves = twice >> (twos + 1);
        IBig::from_parts(sign, if divisor == UBig::ONE { halves } else { halves / divisor })
    }

    /// The largest power of ten that is not above the size of a number of the units, which is about
    /// `size`.
    fn leading_power<B: Bound>(&self, number: &IBig, size: B) -> i32 {
        /// A logarithm as near to an integer as this does not tell on which side it is.
        const NEAR: f64 = 1e-8;
        let (mantissa, exponent) = size.parts();
        let logarithm = mantissa.log10() + exponent as f64 * std::f64::consts::LOG10_2;
        if !logarithm.is_finite() {
            return -LARGEST;
        }
        let mut power = logarithm.floor() as i32;
        if (logarithm - logarithm.round()).abs() > NEAR {
            return power;
        }
        while self.compare(number, power) == Ordering::Less {
            power -= 1;
        }
        while self.compare(number, power + 1) != Ordering::Less {
            power += 1;
        }
        power
    }

    /// The order of the size of a number of the units and a power of ten.
    fn compare(&self, number: &IBig, power: i32) -> Ordering {
        let (number, divisor, twos) = self.quotient(number, power);
        number.into_parts().1.cmp(&(divisor << twos))
    }
}

/// Whether an interval of this half width is wider than a power of ten, so that its ends never
/// round alike; the power may be too small for an f64.
fn is_wider(error: f64, last: i32) -> bool {
    const SMALLEST: i32 = -300;
    2.0 * error > 10_f64.powi(last.max(SMALLEST)) * (1.0 + 1e-9)
}

/// The integer and the power of two whose product a finite f64 is.
fn split(word: f64) -> (i64, i32) {
    const FRACTION: u32 = f64::MANTISSA_DIGITS - 1;
    let bits = word.to_bits();
    let fraction = (bits & ((1 << FRACTION) - 1)) as i64;
    let exponent = (bits >> FRACTION & 0x7ff) as i32;
    let (mantissa, exponent) =
        if exponent == 0 { (fraction, 1) } else { (fraction | 1 << FRACTION, exponent) };
    (if word < 0.0 { -mantissa } else { mantissa }, exponent - 1075)
}

/// A rounded integer times a power of ten, as a cell of at most so many digits.
fn cell(integer: &str, last: i32, digits: usize) -> String {
    // Rounded up to a power of ten it has a digit more than asked for, a zero.
    match integer.strip_suffix('0') {
        Some(fewer) if fewer.trim_start_matches('-').len() == digits => decimal(fewer, last + 1),
        _ => decimal(integer, last),
    }
}

/// An integer times a power of ten, as a decimal.
fn decimal(integer: &str, power: i32) -> String {
    let (sign, digits) = match integer.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", integer),
    };
    let leading = power + i32::try_from(digits.len()).unwrap_or(0) - 1;
    // A zero before the point would look like a digit that is proved.
    if power > 0 || leading < -6 {
        let (first, rest) = digits.split_at(1);
        let point = if rest.is_empty() { "" } else { "." };
        return format!("{sign}{first}{point}{rest}e{leading}");
    }
    if power == 0 {
        return format!("{sign}{digits}");
    }
    let after = power.unsigned_abs() as usize;
    let padded = format!("{}{digits}", "0".repeat((after + 1).saturating_sub(digits.len())));
    let (whole, fraction) = padded.split_at(padded.len() - after);
    format!("{sign}{whole}.{fraction}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::DoubleDouble;
    use percuss::affine::Rational;

    fn shown(value: f64, error: f64, digits: usize) -> String {
        proved(DoubleDouble::new(value, 0.0), error, digits)
    }

    #[test]
    fn a_cell_holds_the_digits_on_which_both_ends_agree() {
        assert_eq!(shown(0.5, 0.0, 17), "0.50000000000000000");
        assert_eq!(shown(1.25, 1e-4, 17), "1.250");
        assert_eq!(shown(-1.25, 1e-3, 17), "-1.25");
        assert_eq!(shown(123.4, 0.08, 17), "123");
        assert_eq!(shown(123.4, 0.3, 17), "1.2e2");
        assert_eq!(shown(1.5e-9, 1e-12, 17), "1.50e-9");
        assert_eq!(shown(2.5e25, 1e22, 17), "2.50e25");
        assert_eq!(shown(0.0, 0.0, 17), "0");
        assert_eq!(shown(f64::NAN, 0.0, 17), "0e400");
        assert_eq!(shown(1.0, f64::INFINITY, 17), "0e400");
        assert_eq!(shown(1e-30, 1e-28, 17), "0e-27");
        assert_eq!(shown(0.9999, 0.01, 17), "1.0");
        assert_eq!(shown(-0.9999, 0.0, 3), "-1.00");
        assert_eq!(shown(999.96, 0.0, 4), "1000");
        assert_eq!(shown(999.96, 0.0, 3), "1.00e3");
        assert!(!has_digits(&shown(1e-30, 1e-28, 17)) && has_digits("0"));
    }

    #[test]
    fn both_words_count() {
        let third =
            DoubleDouble::new(1.0, 0.0) * DoubleDouble::new(1.0 / 3.0, 1.850_371_707_708_594e-17);
        assert_eq!(proved(third, 1e-30, 25), "0.3333333333333333333333333");
    }

    #[test]
    fn significant_digits_are_counted() {
        let counts = ["0.0123e-5", "-1.50", "0e-28", "12", "0.5"].map(significant);
        assert_eq!(counts, [Some(3), Some(3), Some(0), Some(2), Some(1)]);
        assert_eq!(significant("0"), None);
    }

    /// The cell by its definition, in exact rationals, one count of digits after the other.
    fn by_definition(value: DoubleDouble, error: f64, digits: usize) -> String {
        let exact = |it: f64| Rational::try_from(it).unwrap_or_default();
        let (high, low) = value.words();
        let value = exact(high) + exact(low);
        let (least, most) = (&value - exact(error), &value + exact(error));
        let ten = |power: i32| {
            let size = Rational::from(10).pow(power.unsigned_abs());
            if power < 0 { Rational::ONE / size } else { size }
        };
        let size = |it: &Rational| if *it < Rational::ZERO { -it.clone() } else { it.clone() };
        let leading =
            |it: &Rational| (-340..320).rev().find(|power| ten(*power) <= size(it)).unwrap_or(-400);
        if least == most && least == Rational::ZERO {
            return "0".to_owned();
        }
        for count in (1..=digits).rev() {
            let last = leading(&value) - count as i32 + 1;
            let [a, b] = [&least, &most].map(|it| (it / ten(last)).round().to_string());
            if a == b && a != "0" {
                return cell(&a, last, digits);
            }
        }
        format!("0e{}", leading(&size(&least).max(size(&most))) + 1)
    }

    #[test]
    fn a_cell_is_that_of_exact_rationals() {
        let mut state = 1_u64;
        let mut random = || {
            state =
                state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for n in 0..300 {
            let size = 10_f64.powf(if n % 10 == 0 { 200.0 } else { 12.0 } * (random() - 0.5));
            // Every third is next to a power of ten or to a half of its digits.
            let high = match n % 3 {
                0 => 10_f64.powi((size.log10()) as i32) * (1.0 + 1e-15 * (random() - 0.5)),
                1 => (size * 1e3).round() / 1e3,
                _ => size,
            };
            let high = if random() < 0.5 { -high } else { high };
            let value = DoubleDouble::new(high, high * 1e-17 * (random() - 0.5));
            let error = high.abs() * 10_f64.powf(-34.0 * random() + 1.0);
            let error = if n % 7 == 0 { 0.0 } else { error };
            for digits in [3, 17, 25] {
                let (own, truth) =
                    (proved(value, error, digits), by_definition(value, error, digits));
                assert_eq!(own, truth, "{value:?} {error:e} {digits}");
            }
        }
        for (value, error) in
            [(0.0, 1e-30), (0.0, 1.0), (5e-324, 0.0), (1e-310, 3e-320), (0.5, 0.5)]
        {
            let value = DoubleDouble::new(value, 0.0);
            assert_eq!(proved(value, error, 17), by_definition(value, error, 17), "{value:?}");
        }
    }
}
