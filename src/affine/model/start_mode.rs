//! The mode of a start by conditions.
//!
//! A start's condition is decided as that of an event's successor: by the first of the row's value
//! and derivatives in the mode that would begin which is not zero. At a start these are sums of
//! cos theta, sin theta and 1 with rational factors. Where theta is rational and not 0 the three
//! are linearly independent over the rationals (Lindemann), so that a sum is zero only if all of
//! its factors are; where theta is 0 the sum is rational. Every other sign shows in enough bits.

use super::error::SystemError;
use super::rational::Rational;
use super::system::{Row, StartPoint, Successor, System, row_times};
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::number::{Bound, Number};
use crate::numeric::wide::{Bits212, Bits424, Bits848, Bits1696, Bits3392};
use std::cmp::Ordering;

/// Roundings of a sum at a start, in units of its terms and of theta: two products of a rounded
/// factor and of a sine or cosine that is good to two units, and their sum.
const ROUNDINGS: f64 = 64.0;

impl System {
    /// The start at a time with the value of each state, in the mode that the conditions of the
    /// system's start choose.
    ///
    /// ```
    /// use percuss::System;
    ///
    /// let system = System::from_toml(r#"
    ///     schema = 1
    ///     name = "spring-with-clearance"
    ///     states = ["x", "v"]
    ///     [[mode]]
    ///     name = "free"
    ///     equations = ["x' = v", "v' = 1"]
    ///     until = [{ name = "lands", guard = "x > 0", next = [{ mode = "contact" }] }]
    ///     [[mode]]
    ///     name = "contact"
    ///     equations = ["x' = v", "v' = 1 - 9*x"]
    ///     until = [{ name = "leaves", guard = "x < 0", next = [{ mode = "free" }] }]
    ///     [start]
    ///     mode = [{ when = "x > 0", mode = "contact" }, { mode = "free" }]
    ///     x = -1
    ///     v = 0
    /// "#)?;
    /// assert_eq!(system.start()?.mode, 0);
    /// assert_eq!(system.start_by_conditions(0.0, &[0.5, 0.0])?.mode, 1);
    /// // On the surface the velocity decides.
    /// assert_eq!(system.start_by_conditions(0.0, &[0.0, -1.0])?.mode, 0);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// A system whose start names one mode or none, a number that is not finite, another number of
    /// states, and a condition that no arithmetic here decides.
    pub fn start_by_conditions(
        &self,
        time: f64,
        states: &[f64],
    ) -> Result<StartPoint, SystemError> {
        let Some(first) = self.start_modes.first() else {
            let what = "the start of the system chooses no mode by conditions: it has no list of \
                        { when, mode }";
            return Err(SystemError::Name { item: "start".to_owned(), what: what.to_owned() });
        };
        let mut start = self.start_in(first.mode, time, states)?;
        start.mode = self.mode_by_conditions(&start)?;
        Ok(start)
    }

    /// The mode that the conditions of the start choose for its time and state.
    pub(in crate::affine) fn mode_by_conditions(
        &self,
        start: &StartPoint,
    ) -> Result<usize, SystemError> {
        for choice in &self.start_modes {
            let holds =
                choice.when.as_ref().map_or(Some(true), |it| self.holds_at(it, choice, start));
            match holds {
                Some(true) => return Ok(choice.mode),
                Some(false) => {}
                None => break,
            }
        }
        let what = "a condition of the start is nearer to zero than 3392 bits decide";
        Err(SystemError::Number { item: "start, mode".to_owned(), what: what.to_owned() })
    }

    /// Whether the first of a row's value and derivatives that is not zero is positive, in the mode
    /// that would begin; none where no arithmetic here decides.
    fn holds_at(&self, row: &Row, choice: &Successor, start: &StartPoint) -> Option<bool> {
        let matrix = &self.modes.get(choice.mode)?.matrix;
        let mut row = row.clone();
        // By the theorem of Cayley and Hamilton further derivatives are zero where these are.
        for _ in 0..matrix.len() {
            match self.sign_at(&row, start)? {
                Ordering::Equal => row = row_times(&row, matrix),
                sign => return Some(sign == Ordering::Greater),
            }
        }
        Some(false)
    }

    /// The sign of a row's value at a start; none where no arithmetic here decides.
    fn sign_at(&self, row: &Row, start: &StartPoint) -> Option<Ordering> {
        let states = start.state.len();
        let mut sum = [Rational::ZERO, Rational::ZERO, Rational::ZERO];
        for (factor, terms) in row.iter().zip(&start.state) {
            for (total, term) in sum.iter_mut().zip(terms) {
                *total += factor * term;
            }
        }
        // The last entries of z are cos, sin and 1, or 1 alone.
        for (total, factor) in sum.iter_mut().rev().zip(row[states..].iter().rev()) {
            *total += factor;
        }
        if self.is_at_zero_angle(start) {
            let [cos, _, one] = &sum;
            return Some((cos + one).cmp(&Rational::ZERO));
        }
        if sum.iter().all(Rational::is_zero) {
            return Some(Ordering::Equal);
        }
        let forcing = self.forcing.as_ref()?;
        let theta = &forcing.omega * &start.time + &forcing.phi;
        sign_in::<DoubleDouble>(&sum, &theta)
            .or_else(|| sign_in::<Bits212>(&sum, &theta))
            .or_else(|| sign_in::<Bits424>(&sum, &theta))
            .or_else(|| sign_in::<Bits848>(&sum, &theta))
            .or_else(|| sign_in::<Bits1696>(&sum, &theta))
            .or_else(|| sign_in::<Bits3392>(&sum, &theta))
    }
}

/// The sign of a cos theta + b sin theta + c, if it shows in this arithmetic.
fn sign_in<T: Number>(factors: &[Rational; 3], theta: &Rational) -> Option<Ordering> {
    let [a, b, c] = factors.each_ref().map(rounded::<T>);
    let theta = rounded::<T>(theta);
    let (sin, cos) = theta.sin_cos();
    let value = (a * cos + b * sin + c).bound();
    let terms = a.bound().abs() + b.bound().abs() + c.bound().abs();
    let room = T::unit() * ROUNDINGS * terms * (T::Bound::from_f64(1.0) + theta.bound().abs());
    if value > room {
        return Some(Ordering::Greater);
    }
    (value < -room).then_some(Ordering::Less)
}

/// A rational number in an arithmetic, as the sum of the f64 nearest to what is left each time.
fn rounded<T: Number>(number: &Rational) -> T {
    let (mut sum, mut rest) = (T::zero(), number.clone());
    for _ in 0..=T::WORDS {
        let word = rest.to_f64();
        let Ok(exact) = Rational::try_from(word) else { break };
        sum = sum + T::exact(word);
        rest = &rest - &exact;
    }
    sum
}
