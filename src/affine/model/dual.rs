//! Exact numbers with their derivatives by one name, such as a parameter.
//!
//! An expression is read once, and has its value and its derivative from the same operations.

use super::rational::Rational;
use std::ops::{Add, Mul, Neg, Sub};

/// A number and its derivative.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Dual {
    pub value: Rational,
    pub rate: Rational,
}

impl Dual {
    pub const ZERO: Self = Self { value: Rational::ZERO, rate: Rational::ZERO };
    pub const ONE: Self = Self { value: Rational::ONE, rate: Rational::ZERO };

    /// A number that does not depend on the name.
    pub fn fixed(value: Rational) -> Self {
        Self { value, rate: Rational::ZERO }
    }

    /// Whether the number and its derivative are both zero. A number that is zero only at the
    /// current value of the parameter generally has a derivative that is not.
    pub fn is_zero(&self) -> bool {
        self.value.is_zero() && self.rate.is_zero()
    }

    /// 1 divided by the number, unless that is zero.
    pub fn inverse(&self) -> Option<Self> {
        if self.value.is_zero() {
            return None;
        }
        let value = Rational::ONE / &self.value;
        let rate =
            if self.rate.is_zero() { Rational::ZERO } else { -(&self.rate * &value * &value) };
        Some(Self { value, rate })
    }
}

impl Add for &Dual {
    type Output = Dual;
    fn add(self, other: &Dual) -> Dual {
        Dual { value: &self.value + &other.value, rate: &self.rate + &other.rate }
    }
}

impl Sub for &Dual {
    type Output = Dual;
    fn sub(self, other: &Dual) -> Dual {
        Dual { value: &self.value - &other.value, rate: &self.rate - &other.rate }
    }
}

impl Neg for &Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual { value: -&self.value, rate: -&self.rate }
    }
}

impl Mul for &Dual {
    type Output = Dual;
    fn mul(self, other: &Dual) -> Dual {
        let value = &self.value * &other.value;
        if self.rate.is_zero() && other.rate.is_zero() {
            return Dual::fixed(value);
        }
        Dual { value, rate: &self.rate * &other.value + &self.value * &other.rate }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    /// (x^2 - 1)/(x + 2) at 3 is 8/5, and its derivative (x^2 + 4 x + 1)/(x + 2)^2 is 22/25.
    #[test]
    fn a_quotient_has_its_derivative() {
        let number = |it: i32| Dual::fixed(Rational::from(it));
        let x = Dual { value: Rational::from(3), rate: Rational::ONE };
        let above = &(&x * &x) - &Dual::ONE;
        let quotient = &above * &(&x + &number(2)).inverse().unwrap();
        assert_eq!(quotient.value, Rational::from(8) / Rational::from(5));
        assert_eq!(quotient.rate, Rational::from(22) / Rational::from(25));
        assert_eq!((&x - &number(3)).inverse(), None);
    }
}
