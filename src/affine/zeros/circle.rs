//! Guards of the forcing angle: a cos theta + b sin theta + c.
//!
//! Such a guard changes its sign where a^2 + b^2 > c^2, at two points of the circle. Where the root
//! of a^2 + b^2 - c^2 is rational, so are these points, and every other guard of the angle that
//! passes through one is zero there by the model.

use crate::affine::model::rational::Rational;
use crate::affine::model::system::Row;
use dashu::base::{SquareRoot, UnsignedAbs};
use dashu::integer::UBig;

/// A guard of the forcing angle and a constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Circle {
    /// Whether the constant is negative: a guard that never changes its sign is so inside.
    pub is_below: bool,
    /// Whether the guard never changes its sign: it may touch zero.
    pub keeps_sign: bool,
    /// The angle at which the guard touches zero, if it does and never changes its sign.
    pub touch: Option<f64>,
    /// The two points (cos, sin) at which the guard is zero, if they are rational.
    pub points: Option<[[Rational; 2]; 2]>,
}

impl Circle {
    /// A guard of a system with so many states, if it depends on the forcing angle alone.
    pub fn new(guard: &Row, states: usize) -> Option<Self> {
        let (own, angle) = guard.split_at(states);
        let [a, b, c] = angle else { return None };
        own.iter().all(Rational::is_zero).then(|| Self::with([a, b], c))?
    }

    /// The guard of these factors of cos theta and sin theta and this constant; none where both
    /// factors are zero.
    pub fn with([a, b]: [&Rational; 2], c: &Rational) -> Option<Self> {
        if a.is_zero() && b.is_zero() {
            return None;
        }
        let square = a * a + b * b;
        let rest = &square - c * c;
        let points = root(&rest).filter(|it| !it.is_zero()).map(|root| {
            let point =
                |root: &Rational| [(-a * c - b * root) / &square, (-b * c + a * root) / &square];
            [point(&root), point(&-&root)]
        });
        let (is_below, keeps_sign) = (*c < Rational::ZERO, rest <= Rational::ZERO);
        let sign = if is_below { 1.0 } else { -1.0 };
        let angle = || libm::atan2(sign * b.to_f64(), sign * a.to_f64());
        let touch = rest.is_zero().then(angle);
        Some(Self { is_below, keeps_sign, touch, points })
    }

    /// The number of the rational point that is nearest to an angle, if the two are well apart.
    pub fn nearest(&self, cos: f64, sin: f64) -> Option<usize> {
        /// The least difference of the two points' distances, and the largest distance of the
        /// nearer one: far above the rounding of f64.
        const DISTANCE_TOLERANCE: f64 = 1e-6;
        let distance = |[x, y]: &[Rational; 2]| {
            let (x, y) = (x.to_f64() - cos, y.to_f64() - sin);
            (x * x + y * y).sqrt()
        };
        let [first, second] = self.points.as_ref()?.each_ref().map(distance);
        let is_apart =
            (first - second).abs() > DISTANCE_TOLERANCE && first.min(second) < DISTANCE_TOLERANCE;
        is_apart.then_some(usize::from(second < first))
    }
}

/// The root of a rational number that is not negative, if it is rational.
pub fn root(number: &Rational) -> Option<Rational> {
    let whole = |it: UBig| -> Option<UBig> {
        let root = it.sqrt();
        (&root * &root == it).then_some(root)
    };
    if *number < Rational::ZERO {
        return None;
    }
    let above = whole(number.big().numerator().unsigned_abs())?;
    let below = whole(number.big().denominator().clone())?;
    Some(Rational::from_parts(above.into(), below))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    fn guard(entries: [i32; 4]) -> Row {
        entries.into_iter().map(Rational::from).collect()
    }

    #[test]
    fn a_guard_of_the_angle_has_its_points() {
        let circle = Circle::new(&guard([0, 0, 10, -6]), 1).unwrap();
        assert!(!circle.keeps_sign);
        let fifth = |n: i32| Rational::from(n) / Rational::from(5);
        assert_eq!(circle.points, Some([[fifth(-4), fifth(3)], [fifth(4), fifth(3)]]));
        assert_eq!(circle.nearest(-0.8, 0.6), Some(0));
        assert_eq!(circle.nearest(0.8, 0.6), Some(1));
        assert_eq!(circle.nearest(0.0, 1.0), None);
    }

    #[test]
    fn touches_and_guards_of_states_have_none() {
        let touch = Circle::new(&guard([0, 3, 4, -5]), 1).unwrap();
        assert!(touch.keeps_sign && touch.points.is_none());
        assert_eq!(touch.touch, Some(4.0_f64.atan2(3.0)));
        let from_above = Circle::new(&guard([0, 3, 4, 5]), 1).unwrap().touch;
        assert_eq!(from_above, Some((-4.0_f64).atan2(-3.0)));
        assert!(!Circle::new(&guard([0, 3, 4, -4]), 1).unwrap().keeps_sign);
        assert!(Circle::new(&guard([0, 3, 4, -4]), 1).unwrap().points.is_some());
        assert!(Circle::new(&guard([0, 1, 1, -1]), 1).unwrap().points.is_some());
        assert!(Circle::new(&guard([0, 2, 1, -1]), 1).unwrap().points.is_some());
        assert!(Circle::new(&guard([0, 2, 2, -1]), 1).unwrap().points.is_none());
        assert_eq!(Circle::new(&guard([1, 3, 4, -5]), 1), None);
        assert_eq!(Circle::new(&guard([0, 0, 0, -5]), 1), None);
    }
}
