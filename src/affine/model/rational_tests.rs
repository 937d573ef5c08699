//! Numbers that are read, written and rounded, and their operations on owned and borrowed ones.

#![allow(clippy::unwrap_used, reason = "a panic is a failed test")]

use super::*;
use proptest::prelude::*;

fn read(text: &str) -> Rational {
    text.parse().unwrap()
}

#[test]
fn what_is_written_is_what_is_read() {
    for (text, written) in [
        ("2/3", "2/3"),
        ("-4/6", "-2/3"),
        ("+7", "7"),
        ("-0", "0"),
        ("0/5", "0"),
        ("-0.125", "-1/8"),
        (".5", "1/2"),
        ("5.", "5"),
        ("1e-3", "1/1000"),
        ("-1.5E+2", "-150"),
        ("340282366920938463463374607431768211456/3", "340282366920938463463374607431768211456/3"),
    ] {
        assert_eq!(read(text).to_string(), written, "{text}");
    }
    assert_eq!(format!("{:>6}|{:?}", read("2/3"), read("1/2")), "   2/3|1/2");
}

#[test]
fn what_is_no_number_is_refused() {
    for text in [
        "",
        "-",
        "x",
        "1/2/3",
        "1/-2",
        "--1",
        "1 /2",
        "1_000",
        ".",
        "e5",
        "1e",
        "1e10001",
        "nan",
        "0.5/2",
        "1e9999999999",
    ] {
        assert_eq!(text.parse::<Rational>(), Err(RationalError::NoNumber(text.to_owned())));
    }
    assert_eq!("3/0".parse::<Rational>(), Err(RationalError::DivisionByZero));
    for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(Rational::try_from(number), Err(RationalError::NotFinite));
    }
    let said = RationalError::NoNumber("x".to_owned()).to_string();
    assert!(said.starts_with("\"x\" is no rational number"), "{said}");
}

#[test]
fn the_order_is_that_of_the_numbers() {
    let mut numbers = ["1/2", "-1/3", "0", "2/3", "-5", "7"].map(read);
    numbers.sort();
    assert_eq!(numbers.map(|it| it.to_string()), ["-5", "-1/3", "0", "1/2", "2/3", "7"]);
    assert!(Rational::default().is_zero() && Rational::ONE.is_one() && !Rational::ZERO.is_one());
}

#[test]
#[should_panic(expected = "zero")]
fn a_division_by_zero_panics() {
    let _ = Rational::ONE / Rational::ZERO;
}

#[test]
fn parts_beyond_their_type_are_none() {
    let long = read("170141183460469231731687303715884105728/5");
    assert_eq!((long.numerator(), long.denominator()), (None, Some(5)));
    let least = -&long;
    assert_eq!(least.numerator(), Some(i128::MIN));
}

/// Numbers of all sizes, some of them zero.
fn fraction() -> impl Strategy<Value = (i64, i64)> {
    (-1_000_000_i64..1_000_000, 1_i64..100_000)
}

fn of((above, below): (i64, i64)) -> Rational {
    Rational::from(above) / Rational::from(below)
}

proptest! {
    /// Each of the four forms of an operation, and its assignment, gives the same number, which is
    /// that of the definition in integers.
    #[test]
    fn operations_are_those_of_fractions(a in fraction(), b in fraction()) {
        let (x, y) = (of(a), of(b));
        let whole = |it: i64| i128::from(it);
        let ((an, ad), (bn, bd)) = ((whole(a.0), whole(a.1)), (whole(b.0), whole(b.1)));
        macro_rules! is {
            ($symbol:tt, $assign:tt, $above:expr, $below:expr) => {
                let expected = Rational::from($above) / Rational::from($below);
                let mut owned = x.clone();
                owned $assign y.clone();
                let mut borrowed = x.clone();
                borrowed $assign &y;
                prop_assert_eq!(&x $symbol &y, expected.clone());
                prop_assert_eq!(x.clone() $symbol &y, expected.clone());
                prop_assert_eq!(&x $symbol y.clone(), expected.clone());
                prop_assert_eq!(x.clone() $symbol y.clone(), expected.clone());
                prop_assert_eq!([owned, borrowed], [expected.clone(), expected]);
            };
        }
        is!(+, +=, an * bd + bn * ad, ad * bd);
        is!(-, -=, an * bd - bn * ad, ad * bd);
        is!(*, *=, an * bn, ad * bd);
        if bn == 0 {
            prop_assert_eq!(x.checked_div(&y), None);
        } else {
            is!(/, /=, an * bd, ad * bn);
            prop_assert_eq!(x.checked_div(&y), Some(&x / &y));
        }
        prop_assert_eq!(-&x, -x.clone());
        prop_assert_eq!(&x + -&x, Rational::ZERO);
        prop_assert_eq!(x.abs(), if an < 0 { -&x } else { x.clone() });
        prop_assert_eq!(x.pow(3), &x * &x * &x);
        prop_assert_eq!(x.pow(0), Rational::ONE);
        prop_assert_eq!(x.to_string().parse::<Rational>(), Ok(x));
    }

    /// An `f64` is taken exactly, and a decimal is rounded as the compiler rounds it: normal,
    /// subnormal and beyond the range.
    #[test]
    fn rounding_is_that_of_the_standard_library(
        bits in any::<u64>(),
        digits in "[0-9]{1,25}",
        fraction in "[0-9]{0,25}",
        exponent in -350_i32..330,
    ) {
        let number = f64::from_bits(bits);
        if number.is_finite() {
            prop_assert_eq!(Rational::try_from(number).unwrap().to_f64(), number);
        }
        let text = format!("-{digits}.{fraction}e{exponent}");
        prop_assert_eq!(read(&text).to_f64(), text.parse::<f64>().unwrap(), "{}", text);
    }

    #[test]
    fn a_rounded_number_is_near_and_whole(a in fraction()) {
        let (number, round) = (of(a), of(a).round());
        prop_assert_eq!(round.denominator(), Some(1));
        let away = (&number - &round).abs();
        let half = Rational::ONE / Rational::from(2);
        prop_assert!(away < half || away == half && round.abs() > number.abs());
    }
}
