//! Numbers with bounds of their errors, and such numbers with derivatives.

use crate::affine::arithmetic::real::{BigReal, bits_for};
use crate::affine::arithmetic::vector::rounded;
use crate::affine::model::rational::Rational;
use crate::numeric::number::{Bound, Number};

/// The factor by which a bound is raised against its own roundings, a few of which are made in each
/// operation.
const OUTWARD_FACTOR: f64 = 1.0 + 16.0 * f64::EPSILON;

/// All numbers within a radius of a middle.
#[derive(Clone, Copy, Debug)]
pub struct Ball<T: Number> {
    pub middle: T,
    pub radius: T::Bound,
}

impl<T: Number> Ball<T> {
    pub fn exact(middle: T) -> Self {
        Self { middle, radius: T::Bound::ZERO }
    }

    pub fn zero() -> Self {
        Self::exact(T::zero())
    }

    /// A number that is known within this error.
    pub fn within(middle: T, radius: T::Bound) -> Self {
        Self { middle, radius }
    }

    /// A rational number.
    pub fn new(number: &Rational) -> Self {
        if number.is_zero() {
            return Self::zero();
        }
        Self::computed(rounded(&BigReal::new(number, bits_for::<T>())), T::Bound::ZERO)
    }

    /// The result of an operation on middles, with the rounding that this made.
    fn computed(middle: T, radius: T::Bound) -> Self {
        let rounding = T::unit() * 2.0 * middle.bound().abs() + T::Bound::LAST_WORD_UNDERFLOW;
        Self { middle, radius: (radius + rounding) * OUTWARD_FACTOR }
    }

    fn is_zero(&self) -> bool {
        self.middle == T::zero() && self.radius == T::Bound::ZERO
    }

    /// A bound of the size of every number of the ball.
    pub fn size(&self) -> T::Bound {
        (self.middle.bound().abs() + self.radius) * OUTWARD_FACTOR
    }

    /// Whether all numbers of the ball have one sign: then whether they are positive.
    pub fn sign(&self) -> Option<bool> {
        let size = self.middle.bound().abs();
        (size > self.radius * OUTWARD_FACTOR && size.is_finite()).then(|| self.middle > T::zero())
    }

    pub fn plus(self, other: Self) -> Self {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        Self::computed(self.middle + other.middle, self.radius + other.radius)
    }

    pub fn negative(self) -> Self {
        Self { middle: -self.middle, ..self }
    }

    pub fn times(self, other: Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::zero();
        }
        let [own, others] = [&self, &other].map(|it| it.middle.bound().abs());
        let radius = own * other.radius + self.radius * (others + other.radius);
        Self::computed(self.middle * other.middle, radius)
    }

    /// The quotient, unless the divisor may be zero.
    pub fn over(self, divisor: Self) -> Option<Self> {
        divisor.sign()?;
        if self.is_zero() {
            return Some(Self::zero());
        }
        let quotient = self.middle / divisor.middle;
        let least = divisor.middle.bound().abs() - divisor.radius * OUTWARD_FACTOR;
        let size = quotient.bound().abs();
        let radius = (self.radius + size * divisor.radius) / least * OUTWARD_FACTOR;
        Some(Self::computed(quotient, radius * OUTWARD_FACTOR))
    }

    /// The number times a power of two.
    pub fn scaled(self, exponent: i64) -> Self {
        let radius =
            (self.radius.scaled(exponent) + T::Bound::LAST_WORD_UNDERFLOW) * OUTWARD_FACTOR;
        let radius = if self.is_zero() { T::Bound::ZERO } else { radius };
        Self { middle: self.middle.scaled(exponent), radius }
    }

    pub fn widened(self, radius: T::Bound) -> Self {
        Self { radius: (self.radius + radius) * OUTWARD_FACTOR, ..self }
    }
}

/// A number with its derivative by a name.
#[derive(Clone, Copy, Debug)]
pub struct Jet<T: Number> {
    pub value: Ball<T>,
    pub rate: Ball<T>,
}

impl<T: Number> Jet<T> {
    pub fn zero() -> Self {
        Self::fixed(Ball::zero())
    }

    /// A number that does not depend on the name.
    pub fn fixed(value: Ball<T>) -> Self {
        Self { value, rate: Ball::zero() }
    }

    /// A rational number with its derivative.
    pub fn new(value: &Rational, rate: &Rational) -> Self {
        Self { value: Ball::new(value), rate: Ball::new(rate) }
    }

    pub fn plus(self, other: Self) -> Self {
        Self { value: self.value.plus(other.value), rate: self.rate.plus(other.rate) }
    }

    pub fn times(self, other: Self) -> Self {
        let rate = self.rate.times(other.value).plus(self.value.times(other.rate));
        Self { value: self.value.times(other.value), rate }
    }

    pub fn scaled(self, exponent: i64) -> Self {
        Self { value: self.value.scaled(exponent), rate: self.rate.scaled(exponent) }
    }
}

/// The sum of products of two rows.
pub fn dot<T: Number>(a: &[Jet<T>], b: &[Jet<T>]) -> Jet<T> {
    a.iter().zip(b).fold(Jet::zero(), |sum, (a, b)| sum.plus(a.times(*b)))
}

/// The product of a matrix and a vector.
pub fn applied<T: Number>(matrix: &[Vec<Jet<T>>], vector: &[Jet<T>]) -> Vec<Jet<T>> {
    matrix.iter().map(|row| dot(row, vector)).collect()
}
