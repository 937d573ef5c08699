//! A number with a bound of its error, as a value.

use super::interval::{Interval, MIN_POWER_OF_TEN};
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::number::{Bound, Number};
use crate::numeric::two_word::TwoWord;
use crate::numeric::wide::{Bits212, Bits424, Bits848, Bits1696, Bits3392};
use dashu::integer::IBig;
use dashu::integer::ops::BitTest;
use std::fmt;

/// The largest number of f64 whose sum a number is taken for: more than those of 3392 bits.
const MAX_WORDS: usize = 80;

/// The largest exponent of two of a number that is taken as it is; others are divided by a power of
/// two, because f64 has no such exponents.
const MAX_UNSCALED_EXPONENT: i64 = 800;

/// The largest exponent of two of a number whose digits are printed: powers of ten become too long
/// beyond it.
const MAX_PRINTED_EXPONENT: i64 = 4_000_000;

/// The most digits that are looked for: 3392 bits have 1021, and an f64 that is exact has 767.
const MOST_DIGITS: usize = 2000;

/// The digits of a number that is printed without a precision.
const DEFAULT_DIGITS: usize = 17;

/// A number that is known within a bound of its error: its true value lies between
/// [`lower`](Self::lower) and [`upper`](Self::upper).
///
/// It is printed with the digits that are proved: those to which all numbers within the error round
/// alike, 17 at most, or as many as the precision of the format says. `0` is exactly zero; a number
/// of which no digit is known is printed as a zero with an exponent, such as `0e-28`, and is less
/// than that power of ten in size. Width, fill, alignment, `+` and `0` act as they do on an `f64`.
///
/// ```
/// use percuss::{Proved, System, gallery};
///
/// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
/// let solver = ball.solver::<Proved>()?;
/// let impact = solver.run().events(1)?.next().expect("an impact");
/// // The ball falls from 1 to 0 with g = 1: it arrives at the root of two.
/// assert_eq!(impact.time().to_string(), "1.4142135623730950");
/// assert_eq!(format!("{:.25}", impact.time()), "1.414213562373095048801689");
/// assert_eq!(format!("{:+9.4}|{:*^9.4}", impact.time(), impact.time()), "   +1.414|**1.414**");
/// assert!((impact.time().midpoint() - 2_f64.sqrt()).abs() < 1e-15);
/// assert!(impact.time().error() < 1e-28);
/// # Ok::<(), percuss::SystemError>(())
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Proved(Content);

#[derive(Clone, PartialEq, Eq)]
enum Content {
    Within(Interval),
    /// The size is below this power of ten, and nothing else is known.
    Below(i64),
}

impl Proved {
    /// A number of some arithmetic with a bound of its error.
    pub(super) fn new<T: Number>(value: T, error: T::Bound) -> Self {
        let size = value.bound().abs();
        let exponent = size.max(error).parts().1;
        if exponent.abs() > MAX_PRINTED_EXPONENT {
            // The logarithm of two, rounded up.
            let power = ((exponent + 1) as f64 * 0.301_029_995_663_981_3).ceil() as i64 + 1;
            return Self(Content::Below(power));
        }
        let shift = if exponent.abs() <= MAX_UNSCALED_EXPONENT { 0 } else { exponent };
        let words = words(value.scaled(-shift));
        let error = error.scaled(-shift).to_f64();
        if !(error.is_finite() && words.iter().all(|it| it.is_finite())) {
            return Self(Content::Below(-i64::from(MIN_POWER_OF_TEN)));
        }
        // What a value has below the exponents of f64 is an error, too.
        let error = if words.len() > 2 { error.abs() + f64::MIN_POSITIVE } else { error.abs() };
        Self(Content::Within(Interval::new(&words, error, shift as i32)))
    }

    /// The f64 next to the middle of the numbers that are possible; NaN where none is known.
    #[must_use]
    pub fn midpoint(&self) -> f64 {
        match &self.0 {
            Content::Within(it) => to_f64(&it.middle, it.exponent),
            Content::Below(_) => f64::NAN,
        }
    }

    /// A bound of the distance between the middle of the numbers that are possible and the true
    /// value; infinite where nothing is known. [`midpoint`](Self::midpoint) is that middle rounded
    /// to f64, which may be a unit of its last place beside it.
    #[must_use]
    pub fn error(&self) -> f64 {
        match &self.0 {
            Content::Within(it) if it.most == it.middle => 0.0,
            Content::Within(it) => to_f64(&(&it.most - &it.middle), it.exponent).next_up(),
            Content::Below(_) => f64::INFINITY,
        }
    }

    /// Whether the number is zero by the model, exactly.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        matches!(&self.0, Content::Within(it) if it.is_zero())
    }

    /// Whether the number may be this one; of a number of which nothing is known, every one.
    #[must_use]
    pub fn may_be(&self, number: f64) -> bool {
        let Content::Within(own) = &self.0 else { return true };
        if !number.is_finite() {
            return false;
        }
        let other = Interval::new(&[number], 0.0, 0);
        let shift = |it: &IBig, exponent: i32, least: i32| it << (exponent - least) as usize;
        let exponent = own.exponent.min(other.exponent);
        let number = shift(&other.middle, other.exponent, exponent);
        shift(&own.least, own.exponent, exponent) <= number
            && number <= shift(&own.most, own.exponent, exponent)
    }

    /// The number with the digits that are proved, at most so many and at most 2000, as it is
    /// printed.
    #[must_use]
    pub fn to_digits(&self, digits: usize) -> String {
        match &self.0 {
            Content::Within(it) => it.decimal(digits.min(MOST_DIGITS)),
            Content::Below(power) => format!("0e{power}"),
        }
    }

    /// The number of significant digits that are proved, of so many and of 2000 at most; none
    /// (`None`) of a number that is exactly zero, which has no leading digit.
    #[must_use]
    pub fn digits(&self, most: usize) -> Option<usize> {
        match &self.0 {
            Content::Within(it) if it.is_zero() => None,
            Content::Within(it) => Some(it.digits_alike(most.min(MOST_DIGITS))),
            Content::Below(_) => Some(0),
        }
    }

    /// A decimal of so many digits that is less than the true value; nothing where none is known.
    #[must_use]
    pub fn lower(&self, digits: u8) -> Option<String> {
        self.outward(false, digits)
    }

    /// A decimal of so many digits that is more than the true value; nothing where none is known.
    #[must_use]
    pub fn upper(&self, digits: u8) -> Option<String> {
        self.outward(true, digits)
    }

    fn outward(&self, is_upper: bool, digits: u8) -> Option<String> {
        let Content::Within(it) = &self.0 else { return None };
        Some(it.outward(is_upper, i32::from(digits.max(1))))
    }

    /// The middle of the numbers that are possible, rounded to two words.
    #[must_use]
    pub fn to_two_words(&self) -> TwoWord {
        let Content::Within(it) = &self.0 else { return TwoWord { high: f64::NAN, low: f64::NAN } };
        let high = to_f64(&it.middle, it.exponent);
        if !high.is_finite() || high == 0.0 {
            return TwoWord { high, low: 0.0 };
        }
        let first = Interval::new(&[high], 0.0, 0);
        let exponent = it.exponent.min(first.exponent);
        let at = |number: &IBig, own: i32| number << (own - exponent) as usize;
        let rest = at(&it.middle, it.exponent) - at(&first.middle, first.exponent);
        TwoWord { high, low: to_f64(&rest, exponent) }
    }
}

impl fmt::Display for Proved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(DEFAULT_DIGITS).max(1);
        let text = self.to_digits(digits);
        let size = text.strip_prefix('-');
        f.pad_integral(size.is_none(), "", size.unwrap_or(&text))
    }
}

impl fmt::Debug for Proved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} ({:e} +- {:e})",
            self.to_digits(DEFAULT_DIGITS),
            self.midpoint(),
            self.error()
        )
    }
}

/// Prints the numbers of an arithmetic by the digits that it has, 17 at most without a precision.
macro_rules! printed {
    ($($number:ty),*) => {
        $(
            impl fmt::Display for $number {
                fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                    Proved::new(*self, self.bound().abs() * <$number>::unit()).fmt(f)
                }
            }
        )*
    };
}

printed!(DoubleDouble, Bits212, Bits424, Bits848, Bits1696, Bits3392);

/// The f64 whose sum a number is, the largest first; the last is not finite where the number is
/// not, or has more of them than are looked at.
fn words<T: Number>(mut value: T) -> Vec<f64> {
    let mut words = Vec::new();
    loop {
        let word = value.to_f64();
        if word == 0.0 {
            return words;
        }
        if words.len() == MAX_WORDS {
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

/// An integer times a power of two, rounded to f64.
fn to_f64(number: &IBig, exponent: i32) -> f64 {
    /// More bits than f64 has; those beyond them only say on which side of a tie a number is.
    const KEPT_BITS: usize = 100;
    let (sign, size) = number.clone().into_parts();
    let surplus = size.bit_len().saturating_sub(KEPT_BITS);
    let short = &size >> surplus;
    let is_cut = (&short << surplus) != size;
    let number = IBig::from_parts(sign, (short << 1) + u8::from(is_cut));
    let exponent = i64::from(exponent) + surplus as i64 - 1;
    Bound::scaled(number.to_f64().value(), exponent)
}
