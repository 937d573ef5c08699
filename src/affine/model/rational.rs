//! Exact rational numbers of any size.

use dashu::base::{Abs, BitTest};
use dashu::integer::{IBig, UBig};
use dashu::rational::RBig;
use std::fmt;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use std::str::FromStr;

/// The largest size of a decimal exponent that is read.
const MAX_EXPONENT: u32 = 10_000;

/// An exact rational number: the numerator and the denominator have as many digits as they need.
///
/// Coefficients of a [`System`](crate::affine::System) are such numbers, so that a coefficient is
/// zero where the model's is. An `f64` is taken exactly: 0.1 becomes the number that the `f64` next
/// to it holds. A text is taken as written.
///
/// ```
/// use percuss::Rational;
///
/// let third = Rational::ONE / Rational::from(3);
/// assert_eq!(third.to_string(), "1/3");
/// assert_eq!("0.1".parse::<Rational>()?, Rational::from(1) / Rational::from(10));
/// assert_ne!(Rational::try_from(0.1)?, "0.1".parse()?);
/// # Ok::<(), percuss::system::RationalError>(())
/// ```
#[derive(Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct Rational(RBig);

impl Rational {
    /// The number 0.
    pub const ZERO: Self = Self(RBig::ZERO);

    /// The number 1.
    pub const ONE: Self = Self(RBig::ONE);

    /// Whether the number is 0.
    ///
    /// ```
    /// # use percuss::Rational;
    /// assert!(Rational::ZERO.is_zero() && !Rational::ONE.is_zero());
    /// ```
    #[must_use]
    #[inline]
    pub fn is_zero(&self) -> bool {
        self.0.is_zero()
    }

    /// Whether the number is 1.
    ///
    /// ```
    /// # use percuss::Rational;
    /// assert!((Rational::from(3) / Rational::from(3)).is_one());
    /// ```
    #[must_use]
    #[inline]
    pub fn is_one(&self) -> bool {
        self.0.is_one()
    }

    /// The numerator of the number in lowest terms, with the number's sign; none beyond `i128`. The
    /// number's text has all digits of every number.
    ///
    /// ```
    /// # use percuss::Rational;
    /// let number: Rational = "-4/6".parse()?;
    /// assert_eq!((number.numerator(), number.denominator()), (Some(-2), Some(3)));
    /// # Ok::<(), percuss::system::RationalError>(())
    /// ```
    #[must_use]
    pub fn numerator(&self) -> Option<i128> {
        i128::try_from(self.0.numerator()).ok()
    }

    /// The denominator of the number in lowest terms, which is positive; none beyond `i128`.
    ///
    /// ```
    /// # use percuss::Rational;
    /// assert_eq!(Rational::from(7).denominator(), Some(1));
    /// assert_eq!("1e-50".parse::<Rational>()?.denominator(), None);
    /// # Ok::<(), percuss::system::RationalError>(())
    /// ```
    #[must_use]
    pub fn denominator(&self) -> Option<i128> {
        i128::try_from(self.0.denominator()).ok()
    }

    /// The number, rounded correctly to the nearest `f64`, ties to even: infinite where the number
    /// is beyond all finite ones.
    ///
    /// ```
    /// # use percuss::Rational;
    /// assert_eq!((Rational::from(2) / Rational::from(3)).to_f64(), 2.0 / 3.0);
    /// ```
    #[must_use]
    #[inline]
    pub fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }

    /// The size of the number.
    ///
    /// ```
    /// # use percuss::Rational;
    /// assert_eq!(Rational::from(-3).abs(), Rational::from(3));
    /// ```
    #[must_use]
    pub fn abs(&self) -> Self {
        Self(self.0.clone().abs())
    }

    /// The nearest integer; of two that are as near, the one that is larger in size.
    ///
    /// ```
    /// # use percuss::Rational;
    /// assert_eq!("-2.5".parse::<Rational>()?.round(), Rational::from(-3));
    /// # Ok::<(), percuss::system::RationalError>(())
    /// ```
    #[must_use]
    pub fn round(&self) -> Self {
        Self(self.0.round().into())
    }

    /// A power of the number; the power 0 of any number is 1.
    ///
    /// ```
    /// # use percuss::Rational;
    /// assert_eq!("-2/3".parse::<Rational>()?.pow(3), "-8/27".parse()?);
    /// # Ok::<(), percuss::system::RationalError>(())
    /// ```
    #[must_use]
    pub fn pow(&self, exponent: u32) -> Self {
        let (above, below) = (self.0.numerator(), self.0.denominator());
        // Powers of lowest terms are in lowest terms.
        Self(RBig::from_parts(above.pow(exponent as usize), below.pow(exponent as usize)))
    }

    /// The quotient `self / divisor`; none for a divisor of 0, by which `/` panics.
    ///
    /// ```
    /// # use percuss::Rational;
    /// assert_eq!(Rational::ONE.checked_div(&Rational::ZERO), None);
    /// ```
    #[must_use]
    pub fn checked_div(&self, divisor: &Self) -> Option<Self> {
        (!divisor.is_zero()).then(|| self / divisor)
    }

    /// The number as its library has it.
    #[inline]
    pub(in crate::affine) fn big(&self) -> &RBig {
        &self.0
    }

    /// The number of two whole parts, in any terms.
    pub(in crate::affine) fn from_parts(numerator: IBig, denominator: UBig) -> Self {
        Self(RBig::from_parts(numerator, denominator))
    }

    /// The bits of the numerator and of the denominator.
    pub(in crate::affine) fn bits(&self) -> (usize, usize) {
        (self.0.numerator().bit_len(), self.0.denominator().bit_len())
    }
}

impl fmt::Display for Rational {
    /// In lowest terms, such as `2/3`, `-7` or `0`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.0.to_string())
    }
}

impl fmt::Debug for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

macro_rules! from_integers {
    ($($integer:ty)*) => {$(
        impl From<$integer> for Rational {
            #[inline]
            fn from(integer: $integer) -> Self {
                Self(RBig::from(integer))
            }
        }
    )*};
}

from_integers!(u8 u16 u32 u64 u128 usize i8 i16 i32 i64 i128 isize);

impl TryFrom<f64> for Rational {
    type Error = RationalError;

    /// The exact value of a finite number.
    fn try_from(number: f64) -> Result<Self, RationalError> {
        RBig::try_from(number).map(Self).map_err(|_| RationalError::NotFinite)
    }
}

impl FromStr for Rational {
    type Err = RationalError;

    /// Reads an integer, a decimal or a fraction of integers, exactly.
    ///
    /// ```
    /// # use percuss::Rational;
    /// use percuss::system::RationalError;
    /// let [a, b, c] = ["-0.125", "1.5e-3", "2/3"].map(str::parse::<Rational>);
    /// assert_eq!((a?.to_string(), b?.to_string()), ("-1/8".to_owned(), "3/2000".to_owned()));
    /// assert_eq!(c?.to_f64(), 2.0 / 3.0);
    /// assert_eq!("1/0".parse::<Rational>(), Err(RationalError::DivisionByZero));
    /// # Ok::<(), RationalError>(())
    /// ```
    fn from_str(text: &str) -> Result<Self, RationalError> {
        let no_number = || RationalError::NoNumber(text.to_owned());
        let (negative, size) = match text.strip_prefix('-') {
            Some(size) => (true, size),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let size = match size.split_once('/') {
            Some((above, below)) => {
                let [above, below] = [above, below].map(|it| natural(it).ok_or_else(no_number));
                let (above, below) = (above?, below?);
                if below.is_zero() {
                    return Err(RationalError::DivisionByZero);
                }
                Self::from_parts(above.into(), below)
            }
            None => decimal(size).ok_or_else(no_number)?,
        };
        Ok(if negative { -size } else { size })
    }
}

/// A natural number in digits only.
fn natural(text: &str) -> Option<UBig> {
    let is_plain = !text.is_empty() && text.bytes().all(|it| it.is_ascii_digit());
    if is_plain { UBig::from_str_radix(text, 10).ok() } else { None }
}

/// A decimal without sign, such as `12`, `0.5`, `.5`, `5.` or `1e-3`.
fn decimal(text: &str) -> Option<Rational> {
    let (digits, exponent) = match text.split_once(['e', 'E']) {
        Some((digits, exponent)) => (digits, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    if exponent.unsigned_abs() > MAX_EXPONENT {
        return None;
    }
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let number = natural(&format!("{whole}{fraction}"))?;
    let ten = |power: usize| UBig::from(10_u8).pow(power);
    let power = ten(exponent.unsigned_abs() as usize);
    let (above, below) = if exponent < 0 { (number, power) } else { (number * power, UBig::ONE) };
    Some(Rational::from_parts(above.into(), below * ten(fraction.len())))
}

impl Neg for Rational {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Neg for &Rational {
    type Output = Rational;
    #[inline]
    fn neg(self) -> Rational {
        Rational(-&self.0)
    }
}

macro_rules! operator {
    ($trait:ident, $name:ident, $assign:ident, $assign_name:ident) => {
        operator!($trait, $name, Rational, Rational, |a, b| (a.0, b.0));
        operator!($trait, $name, Rational, &Rational, |a, b| (a.0, &b.0));
        operator!($trait, $name, &Rational, Rational, |a, b| (&a.0, b.0));
        operator!($trait, $name, &Rational, &Rational, |a, b| (&a.0, &b.0));

        impl $assign for Rational {
            #[inline]
            fn $assign_name(&mut self, other: Self) {
                $assign::$assign_name(&mut self.0, other.0);
            }
        }

        impl $assign<&Self> for Rational {
            #[inline]
            fn $assign_name(&mut self, other: &Self) {
                $assign::$assign_name(&mut self.0, &other.0);
            }
        }
    };
    ($trait:ident, $name:ident, $left:ty, $right:ty, |$a:ident, $b:ident| $parts:expr) => {
        impl $trait<$right> for $left {
            type Output = Rational;
            #[inline]
            fn $name(self, other: $right) -> Rational {
                let ($a, $b) = (self, other);
                let ($a, $b) = $parts;
                Rational($trait::$name($a, $b))
            }
        }
    };
}

operator!(Add, add, AddAssign, add_assign);
operator!(Sub, sub, SubAssign, sub_assign);
operator!(Mul, mul, MulAssign, mul_assign);
// A division by zero panics, as that of integers does.
operator!(Div, div, DivAssign, div_assign);

/// What is no rational number.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RationalError {
    /// A number that is infinite or not a number.
    NotFinite,
    /// A text that is no integer, no decimal with an exponent of at most 10000 in size, and no
    /// fraction of integers.
    NoNumber(String),
    /// A fraction with a denominator of 0.
    DivisionByZero,
}

impl fmt::Display for RationalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("a finite number is accepted"),
            Self::NoNumber(text) => write!(
                f,
                "{text:?} is no rational number: accepted are integers, decimals and fractions, \
                 such as -7, 0.125, 1e-3 and 2/3"
            ),
            Self::DivisionByZero => f.write_str("a denominator is not 0"),
        }
    }
}

impl std::error::Error for RationalError {}

#[cfg(test)]
#[path = "rational_tests.rs"]
mod tests;
