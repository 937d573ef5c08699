//! The entries of z at a start, with their derivatives.

use super::ball::Ball;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::model::tangent::Tangent;
use crate::numeric::number::Number;

/// The entries of z at a start and their derivatives, as factors of cos theta, sin theta and 1.
pub(super) struct StartRows {
    pub values: Vec<[Rational; 3]>,
    pub slopes: Vec<[Rational; 3]>,
}

impl StartRows {
    /// The rows of a start, and of the derivatives that stand in the places of another.
    pub fn new(system: &System, tangent: &Tangent, [point, rates]: [&StartPoint; 2]) -> Self {
        let turn = turn(system, tangent, [point, rates]);
        let values = values(system, point);
        let slopes = slopes(&values, rates, &turn);
        Self { values, slopes }
    }
}

/// The entries of z at the start of a system, as combinations of independent numbers.
pub(super) fn nearby_values(system: &System) -> Option<Vec<Vec<Rational>>> {
    let point = system.start.as_ref()?;
    Some(independent(&values(system, point), system.is_at_zero_angle(point)))
}

/// A row of factors at an angle, whose cosine and sine stand before 1.
pub(super) fn at_angle<T: Number>(row: &[Rational; 3], angle: &[Ball<T>; 3]) -> Ball<T> {
    let terms = row.iter().zip(angle).map(|(a, b)| Ball::new(a).times(*b));
    terms.fold(Ball::zero(), Ball::plus)
}

/// The derivative of the forcing angle at the start.
fn turn(system: &System, tangent: &Tangent, [point, rates]: [&StartPoint; 2]) -> Rational {
    match (&system.forcing, &tangent.forcing) {
        (Some(own), Some(rate)) => &rate.omega * &point.time + &own.omega * &rates.time + &rate.phi,
        _ => Rational::ZERO,
    }
}

/// The entries of z at a start, as factors of cos theta, sin theta and 1.
fn values(system: &System, point: &StartPoint) -> Vec<[Rational; 3]> {
    let unit = |n: usize| [0, 1, 2].map(|k| if k == n { Rational::ONE } else { Rational::ZERO });
    let mut rows = point.state.clone();
    if system.forcing.is_some() {
        rows.extend([unit(0), unit(1)]);
    }
    rows.push(unit(2));
    rows
}

/// The derivatives of the entries of z at a start, in the same way: cos theta has that of -sin
/// theta, times the angle's.
fn slopes(rows: &[[Rational; 3]], rates: &StartPoint, turn: &Rational) -> Vec<[Rational; 3]> {
    let turned = |[cos, sin, _]: &[Rational; 3]| [sin * turn, -(cos * turn), Rational::ZERO];
    let mut slopes: Vec<_> = rows.iter().map(turned).collect();
    for (slope, rate) in slopes.iter_mut().zip(&rates.state) {
        slope.iter_mut().zip(rate).for_each(|(sum, term)| *sum += term);
    }
    slopes
}

/// The factors of numbers that are linearly independent: at theta = 0 the cosine is 1 and the sine
/// 0.
pub(super) fn independent(rows: &[[Rational; 3]], is_at_zero: bool) -> Vec<Vec<Rational>> {
    let row = |[cos, sin, one]: &[Rational; 3]| match is_at_zero {
        true => vec![cos + one],
        false => vec![cos.clone(), sin.clone(), one.clone()],
    };
    rows.iter().map(row).collect()
}
