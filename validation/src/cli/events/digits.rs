//! Decimals that hold only digits that are proved.

use crate::truth::DoubleDouble;
use percuss::affine::Rational;

/// The largest power of ten that is looked at.
const LARGEST: i32 = 400;

/// A value with a bound of its error, to at most `digits` significant digits: as many as all
/// numbers within the error round to alike. Where that is none it is a zero with an exponent, such
/// as `0e-28`: the value is less than that power of ten in size, which is larger than any number of
/// f64 where nothing is known of it.
pub(super) fn proved(value: DoubleDouble, error: f64, digits: usize) -> String {
    let (high, low) = value.words();
    if !(high.is_finite() && error.is_finite()) {
        return format!("0e{LARGEST}");
    }
    let exact = |it: f64| Rational::try_from(it).unwrap_or_default();
    let (value, error) = (exact(high) + exact(low), exact(error.abs()));
    let (least, most) = (&value - &error, &value + &error);
    if least.is_zero() && most.is_zero() {
        return "0".to_owned();
    }
    let leading = leading_power(&absolute(&value));
    for count in (1..=digits).rev() {
        let last = leading - i32::try_from(count).unwrap_or(0) + 1;
        let (a, b) = (rounded(&least, last), rounded(&most, last));
        if a == b && a != "0" {
            // Rounded up to a power of ten it has a digit more than asked for, a zero.
            return match a.strip_suffix('0') {
                Some(fewer) if fewer.trim_start_matches('-').len() == digits => {
                    decimal(fewer, last + 1)
                }
                _ => decimal(&a, last),
            };
        }
    }
    let bound = if absolute(&least) > absolute(&most) { absolute(&least) } else { absolute(&most) };
    format!("0e{}", leading_power(&bound) + 1)
}

/// Whether a printed number has a digit.
pub(super) fn has_digits(text: &str) -> bool {
    !text.starts_with("0e")
}

fn absolute(number: &Rational) -> Rational {
    if *number < Rational::ZERO { -number.clone() } else { number.clone() }
}

/// The largest power of ten that is not above a positive number.
fn leading_power(number: &Rational) -> i32 {
    let guess = number.to_f64().value().log10().floor();
    let mut power = if guess.is_finite() { guess as i32 } else { -LARGEST };
    while power > -LARGEST && ten(power) > *number {
        power -= 1;
    }
    while power < LARGEST && ten(power + 1) <= *number {
        power += 1;
    }
    power
}

fn ten(power: i32) -> Rational {
    let size = Rational::from(10).pow(power.unsigned_abs() as isize);
    if power < 0 { Rational::ONE / size } else { size }
}

/// The number in units of a power of ten, rounded.
fn rounded(number: &Rational, last: i32) -> String {
    (number / ten(last)).round().to_string()
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
}
