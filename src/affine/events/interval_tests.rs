//! Decimals beside exact rationals.

#![allow(clippy::unwrap_used, reason = "a panic is a failed test")]

use super::super::proved::Proved;
use super::cell;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::number::Number;
use dashu::rational::RBig as Rational;

fn proved(value: DoubleDouble, error: f64, digits: usize) -> String {
    Proved::new(value, error).to_digits(digits)
}

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
}

#[test]
fn both_words_count() {
    let third =
        DoubleDouble::new(1.0, 0.0) * DoubleDouble::new(1.0 / 3.0, 1.850_371_707_708_594e-17);
    assert_eq!(proved(third, 1e-30, 25), "0.3333333333333333333333333");
}

#[test]
fn significant_digits_are_counted() {
    let digits =
        |value: f64, error: f64| Proved::new(DoubleDouble::new(value, 0.0), error).digits(17);
    let counts = [(1.25, 1e-4), (-1.25, 1e-3), (1e-30, 1e-28), (0.9999, 0.01), (1.5, 0.0)];
    let counts = counts.map(|(value, error)| digits(value, error));
    assert_eq!(counts, [Some(4), Some(3), Some(0), Some(2), Some(17)]);
    assert_eq!(digits(0.0, 0.0), None);
    assert_eq!(digits(f64::NAN, 0.0), Some(0));
}

#[test]
fn midpoint_and_error_enclose() {
    let third = DoubleDouble::exact(1.0) / DoubleDouble::exact(3.0);
    let proved = Proved::new(third, 1e-30);
    assert_eq!(proved.midpoint(), 1.0 / 3.0);
    assert!(proved.error() >= 1e-30 && proved.error() < 1.001e-30);
    let words = proved.to_two_words();
    assert_eq!((words.high, words.low), third.words());
    let near = Proved::new(DoubleDouble::exact(0.5), 1e-3);
    assert!(near.may_be(0.5009) && near.may_be(0.4991) && !near.may_be(0.5011));
    assert_eq!(near.lower(3), Some("0.498".to_owned()));
    assert_eq!(near.upper(3), Some("0.502".to_owned()));
    let unknown = Proved::new(DoubleDouble::exact(f64::NAN), 0.0);
    assert!(unknown.midpoint().is_nan() && unknown.error().is_infinite() && unknown.may_be(7.0));
}

#[test]
fn proved_numbers_are_printed_as_wide_as_asked_for() {
    let half = Proved::new(DoubleDouble::exact(0.5), 0.0);
    assert_eq!(format!("{half:.3}|{half:>8.3}|{half:<8.3}|"), "0.500|   0.500|0.500   |");
    assert_eq!(format!("{half:8.3}|{half:^8.3}|{half:4.3}|"), "   0.500| 0.500  |0.500|");
    assert_eq!(format!("{half:*^9.3}|{half:_<8.3}|{half:->8.3}|"), "**0.500**|0.500___|---0.500|");
}

/// All flags at once, beside those of an f64 that has the same digits.
#[test]
fn proved_numbers_are_padded_as_f64_are() {
    for value in [0.5, -0.5, 12.25, -12.25] {
        let proved = Proved::new(DoubleDouble::exact(value), 0.0);
        // As many significant digits as three after the point.
        let digits = if value.abs() < 1.0 { 3 } else { 5 };
        assert_eq!(format!("{proved:+.digits$}"), format!("{value:+.3}"));
        assert_eq!(format!("{proved:+12.digits$}"), format!("{value:+12.3}"));
        assert_eq!(format!("{proved:#<+12.digits$}"), format!("{value:#<+12.3}"));
        assert_eq!(format!("{proved:#^+12.digits$}"), format!("{value:#^+12.3}"));
        assert_eq!(format!("{proved:012.digits$}"), format!("{value:012.3}"));
        assert_eq!(format!("{proved:+012.digits$}"), format!("{value:+012.3}"));
        assert_eq!(format!("{proved:*<012.digits$}"), format!("{value:*<012.3}"));
    }
}

#[test]
fn numbers_without_a_proved_digit_are_padded_too() {
    let zero = Proved::new(DoubleDouble::exact(0.0), 0.0);
    assert_eq!(format!("{zero:+}|{zero:^5}|{zero:03}|"), "+0|  0  |000|");
    let unknown = Proved::new(DoubleDouble::exact(1e-30), 1e-28);
    assert_eq!(format!("{unknown:>8}|{unknown:^8}|{unknown:08}|"), "   0e-27| 0e-27  |0000e-27|");
    let small = Proved::new(DoubleDouble::exact(-1.5e-9), 1e-12);
    assert_eq!(format!("{small:011}|{small:<11}|"), "-0001.50e-9|-1.50e-9   |");
    let third = DoubleDouble::exact(1.0) / DoubleDouble::exact(3.0);
    assert_eq!(
        format!("{third:+9.3}|{third:_^9.3}|{third:09.3}|"),
        "   +0.333|__0.333__|00000.333|"
    );
}

/// The cell by its definition, in exact rationals, one count of digits after the other.
fn by_definition(value: DoubleDouble, error: f64, digits: usize) -> String {
    let exact = |it: f64| Rational::try_from(it).unwrap_or_default();
    let (high, low) = value.words();
    let value = exact(high) + exact(low);
    let (least, most) = (&value - exact(error), &value + exact(error));
    let ten = |power: i32| {
        let size = Rational::from(10).pow(power.unsigned_abs() as isize);
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
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
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
            let (own, truth) = (proved(value, error, digits), by_definition(value, error, digits));
            assert_eq!(own, truth, "{value:?} {error:e} {digits}");
        }
    }
    for (value, error) in [(0.0, 1e-30), (0.0, 1.0), (5e-324, 0.0), (1e-310, 3e-320), (0.5, 0.5)] {
        let value = DoubleDouble::new(value, 0.0);
        assert_eq!(proved(value, error, 17), by_definition(value, error, 17), "{value:?}");
    }
}
