//! An interval with binary ends as a decimal, of which only digits that are proved are printed.

use dashu::integer::ops::BitTest;
use dashu::integer::{IBig, UBig};
use std::cmp::Ordering;

/// The exponent of ten below which nothing is printed: f64 has no such numbers.
pub(super) const MIN_POWER_OF_TEN: i32 = -400;

/// The ends of an interval and its middle, as integers in units of a power of two.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct Interval {
    pub least: IBig,
    pub middle: IBig,
    pub most: IBig,
    pub exponent: i32,
}

impl Interval {
    /// The middle and the half width as f64 whose sums they are, times a power of two.
    pub fn new(words: &[f64], error: f64, shift: i32) -> Self {
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

    /// Whether the interval is the number zero.
    pub fn is_zero(&self) -> bool {
        self.least == IBig::ZERO && self.most == IBig::ZERO
    }

    /// The number to at most so many significant digits: as many as all numbers of the interval
    /// round to alike. Where that is none it is a zero with an exponent, such as `0e-28`, and all
    /// numbers of the interval are less than that power of ten in size.
    pub fn decimal(&self, digits: usize) -> String {
        if self.is_zero() {
            return "0".to_owned();
        }
        match self.rounded_alike(digits) {
            Some((integer, last)) => cell(&integer.to_string(), last, digits),
            None => format!("0e{}", self.leading_power(&self.largest()) + 1),
        }
    }

    /// The number of significant digits, up to so many, to which all numbers of the interval round
    /// alike.
    pub fn digits_alike(&self, most: usize) -> usize {
        let length = |number: IBig| number.into_parts().1.to_string().len();
        self.rounded_alike(most).map_or(0, |(number, _)| length(number).min(most))
    }

    /// The integer to which all numbers of the interval round alike, in units of a power of ten:
    /// the smallest unit of which there is one, of those that leave at most so many digits.
    fn rounded_alike(&self, digits: usize) -> Option<(IBig, i32)> {
        let leading = self.leading_power(&self.middle);
        let width = &self.most - &self.least;
        for count in (1..=digits).rev() {
            let last = leading - i32::try_from(count).unwrap_or(0) + 1;
            if self.is_wider(&width, last) {
                continue;
            }
            let rounded = self.rounded(&self.least, last);
            if rounded != IBig::ZERO && rounded == self.rounded(&self.most, last) {
                return Some((rounded, last));
            }
        }
        None
    }

    /// A decimal of so many digits that is below the interval, or above it.
    pub fn outward(&self, is_upper: bool, digits: i32) -> String {
        let end = if is_upper { &self.most } else { &self.least };
        let last = self.leading_power(end) - digits + 1;
        // A unit of the last digit is more than the rounding.
        let unit = if is_upper { IBig::ONE } else { -IBig::ONE };
        decimal(&(self.rounded(end, last) + unit).to_string(), last)
    }

    /// The larger size of the two ends.
    fn largest(&self) -> IBig {
        let sizes = [&self.least, &self.most].map(|it| it.clone().into_parts().1);
        IBig::from(sizes.into_iter().max().unwrap_or_default())
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

    /// The largest power of ten that is not above the size of a number of the units.
    fn leading_power(&self, number: &IBig) -> i32 {
        /// A logarithm as near to an integer as this does not tell on which side it is.
        const INTEGER_TOLERANCE: f64 = 1e-6;
        let bits = bits(number);
        if bits == 0 {
            return MIN_POWER_OF_TEN;
        }
        let mantissa = leading_word(number, bits);
        let logarithm =
            mantissa.log10() + f64::from(bits + self.exponent) * std::f64::consts::LOG10_2;
        let mut power = logarithm.floor() as i32;
        if (logarithm - logarithm.round()).abs() > INTEGER_TOLERANCE {
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

    /// Whether a width of the units is at least a power of two that is more than a power of ten:
    /// the ends never round alike then.
    fn is_wider(&self, width: &IBig, last: i32) -> bool {
        let power = bits(width) - 1 + self.exponent;
        *width != IBig::ZERO
            && f64::from(power) * std::f64::consts::LOG10_2 > f64::from(last) + 1e-6
    }

    /// The order of the size of a number of the units and a power of ten.
    fn compare(&self, number: &IBig, power: i32) -> Ordering {
        let (number, divisor, twos) = self.quotient(number, power);
        number.into_parts().1.cmp(&(divisor << twos))
    }
}

/// The number of bits of an integer's size.
fn bits(number: &IBig) -> i32 {
    i32::try_from(number.bit_len()).unwrap_or(i32::MAX)
}

/// The size of an integer of so many bits as a number from 1/2 to 1, cut to the digits of f64.
fn leading_word(number: &IBig, bits: i32) -> f64 {
    const WORD_BITS: usize = 60;
    let size = number.clone().into_parts().1;
    let surplus = (bits as usize).saturating_sub(WORD_BITS);
    let word = u64::try_from(size >> surplus).unwrap_or(u64::MAX);
    word as f64 / 2_f64.powi(bits - surplus as i32)
}

/// The integer and the power of two whose product a finite f64 is.
fn split(word: f64) -> (i64, i32) {
    const FRACTION_BITS: u32 = f64::MANTISSA_DIGITS - 1;
    let bits = word.to_bits();
    let fraction = (bits & ((1 << FRACTION_BITS) - 1)) as i64;
    let exponent = (bits >> FRACTION_BITS & 0x7ff) as i32;
    let (mantissa, exponent) =
        if exponent == 0 { (fraction, 1) } else { (fraction | 1 << FRACTION_BITS, exponent) };
    (if word < 0.0 { -mantissa } else { mantissa }, exponent - 1075)
}

/// A rounded integer times a power of ten, as a decimal of at most so many digits.
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
#[path = "interval_tests.rs"]
mod tests;
