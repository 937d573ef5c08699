//! Affine forms with exact coefficients: rational combinations of the states, cos theta, sin theta
//! and 1.

use super::dual::Dual;
use crate::affine::model::rational::Rational;

/// The largest number of bits of a coefficient's numerator or denominator.
const MAX_BITS: usize = 16_384;

/// Coefficients lie between about 2^-1000 and 2^1000: f64 holds few others.
const MAX_POWER_OF_TWO: usize = 1000;

/// The coefficients of the states, then of cos theta, sin theta and 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Form(pub Vec<Dual>);

impl Form {
    /// The form that is zero.
    pub fn zero(states: usize) -> Self {
        Self(vec![Dual::ZERO; states + 3])
    }

    /// The constant form of a number.
    pub fn number(states: usize, value: Dual) -> Self {
        let mut form = Self::zero(states);
        form.0[states + 2] = value;
        form
    }

    /// A single one of the states, cos theta, sin theta or 1, by its index.
    pub fn unit(states: usize, index: usize) -> Self {
        let mut form = Self::zero(states);
        form.0[index] = Dual::ONE;
        form
    }

    /// The number that the form is, if it has neither states nor cos theta or sin theta.
    pub fn constant(&self) -> Option<&Dual> {
        let (last, others) = self.0.split_last()?;
        others.iter().all(Dual::is_zero).then_some(last)
    }

    /// Whether the form depends on a state.
    pub fn has_states(&self) -> bool {
        let states = self.0.len() - 3;
        self.0[..states].iter().any(|it| !it.is_zero())
    }

    /// `self + other`.
    pub fn plus(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| a + b).collect())
    }

    /// `self - other`.
    pub fn minus(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| a - b).collect())
    }

    /// `self * factor`.
    pub fn times_number(&self, factor: &Dual) -> Self {
        Self(self.0.iter().map(|it| it * factor).collect())
    }

    /// The product `self * other`, one factor of which is a number.
    pub fn times(&self, other: &Self) -> Result<Self, String> {
        match (self.constant(), other.constant()) {
            (_, Some(factor)) => Ok(self.times_number(factor)),
            (Some(factor), _) => Ok(other.times_number(factor)),
            _ => Err("a product with a state, cos or sin in both factors is not accepted: \
                      expressions are affine"
                .to_owned()),
        }
    }

    /// The quotient `self / divisor` by a number.
    pub fn over(&self, divisor: &Self) -> Result<Self, String> {
        match divisor.constant() {
            Some(divisor) => match divisor.inverse() {
                Some(inverse) => Ok(self.times_number(&inverse)),
                None => Err("a division by zero".to_owned()),
            },
            None => Err("a divisor with a state, cos or sin in it is not accepted: expressions \
                         are affine"
                .to_owned()),
        }
    }

    /// A power of a number; the first power of anything.
    pub fn to_the(&self, exponent: usize) -> Result<Self, String> {
        let Some(base) = self.constant() else {
            return if exponent == 1 {
                Ok(self.clone())
            } else {
                Err("a power of a state, of cos or of sin is not accepted: expressions are affine"
                    .to_owned())
            };
        };
        let mut power = Dual::ONE;
        for _ in 0..exponent {
            power = &power * base;
            check_sizes(&power)?;
        }
        Ok(Self::number(self.0.len() - 3, power))
    }

    /// Refuses coefficients of too many bits.
    pub fn check_size(&self) -> Result<(), String> {
        self.0.iter().try_for_each(check_sizes)
    }

    /// Refuses coefficients beyond the range of f64.
    pub fn check_range(&self) -> Result<(), String> {
        check_range(self.0.iter().map(|it| &it.value))
    }
}

/// Refuses coefficients beyond the range of f64.
pub(super) fn check_range<'a>(
    mut coefficients: impl Iterator<Item = &'a Rational>,
) -> Result<(), String> {
    let far =
        |(above, below): &(usize, usize)| *above > 0 && above.abs_diff(*below) > MAX_POWER_OF_TWO;
    let Some((above, below)) = coefficients.by_ref().map(Rational::bits).find(far) else {
        return Ok(());
    };
    let (sign, power) = (if above < below { "-" } else { "" }, above.abs_diff(below));
    Err(format!(
        "a coefficient of about 2^{sign}{power} is not accepted: 0 is, and sizes from \
             2^-{MAX_POWER_OF_TWO} to 2^{MAX_POWER_OF_TWO}"
    ))
}

/// Refuses a number, or a derivative of one, of too many bits.
fn check_sizes(number: &Dual) -> Result<(), String> {
    check_size(&number.value).and_then(|()| check_size(&number.rate))
}

/// Refuses a number of too many bits.
pub(super) fn check_size(number: &Rational) -> Result<(), String> {
    let (above, below) = number.bits();
    let bits = above.max(below);
    if bits > MAX_BITS {
        return Err(format!(
            "a coefficient of {bits} bits is too long: up to {MAX_BITS} are accepted"
        ));
    }
    Ok(())
}
