//! A crossing's time to the last digit: Newton's method inside of the proved bracket.

use super::crossing::FirstCrossing;
use crate::affine::guards::point::{GuardedPoint, GuardedSegment};
use crate::affine::guards::track::{SearchWork, Track, outward};
use crate::numeric::number::{Bound, Number};

/// Two times between which a root is, and the size of the last step towards it.
struct Bracket<T: Number> {
    low: T,
    high: T,
    last: T::Bound,
}

/// The next step towards a root.
enum Next<T> {
    /// An evaluation of the guard at a time.
    Evaluate(T),
    /// A last step to the root, without an evaluation.
    Step(T),
    /// No step, because rounding shows no better time.
    Nothing,
}

impl<T: Number> Bracket<T> {
    #[inline]
    fn middle(&self) -> T {
        (self.low + self.high) * T::exact(0.5)
    }

    /// Whether a time is inside the bracket, and not at an end of it.
    #[inline]
    fn holds(&self, time: T) -> bool {
        self.low < time && time < self.high
    }
}

impl<T: Number> GuardedSegment<'_, T> {
    /// Brings a point to the crossing, to the last digit; whether that is not after `limit`. It is
    /// not before `from`. Of the guards only the first that crosses is evaluated there.
    #[inline]
    pub(super) fn settle(
        &self,
        tracks: &[Track],
        point: &mut GuardedPoint<T>,
        crossing: &FirstCrossing<T>,
        [from, limit]: [T; 2],
        work: &mut SearchWork,
    ) -> bool {
        /// The number of evaluations after which the crossing stays where it is.
        const MAX_ROUNDS: usize = 128;
        // A crossing exactly at the limit counts.
        let room = T::of_bound(T::unit() * 4.0 * limit.bound());
        let n = crossing.guards.trailing_zeros() as usize;
        let [mut low, high] = crossing.between;
        if low < from {
            low = from;
        }
        let inside = low <= crossing.time && crossing.time <= high;
        let mut bracket = Bracket { low, high, last: T::Bound::INFINITY };
        let mut next = if inside { crossing.time } else { bracket.middle() };
        for _ in 0..MAX_ROUNDS {
            self.evaluate_guard(n, point, next, work);
            next = match self.next_to_root(n, &tracks[n], point, &mut bracket) {
                Next::Evaluate(time) => time,
                Next::Step(step) => {
                    point.to_crossing = step;
                    return point.time + step <= limit + room;
                }
                Next::Nothing => break,
            };
        }
        point.to_crossing = remaining(&point.orders[n]);
        if point.time + point.to_crossing < from {
            point.to_crossing = from - point.time;
        }
        point.time <= limit + room
    }

    /// The next step from a point towards a guard's root. Newton's steps are taken while they
    /// shrink and stay where the root is proved to be; elsewhere that is halved.
    #[inline]
    fn next_to_root(
        &self,
        n: usize,
        track: &Track,
        point: &GuardedPoint<T>,
        bracket: &mut Bracket<T>,
    ) -> Next<T> {
        /// The share of a point's time beyond which a cubic does not give the step to the last
        /// digit.
        const MAX_STEP_SHARE: f64 = 1e-4;
        // A value within a few roundings of its terms shows no better time.
        let noise = T::unit() * 4.0 * self.rows[n].size(&point.modal.y);
        let orders = outward(&point.orders[n], track);
        let value = orders[0].bound();
        if value.abs() <= noise {
            return Next::Nothing;
        }
        *(if value < 0.0 { &mut bracket.low } else { &mut bracket.high }) = point.time;
        let mut step = newton(&orders);
        let end = point.time + step;
        if bracket.low <= end && end <= bracket.high && self.is_last(&orders, step) {
            return Next::Step(step);
        }
        if step.bound().abs() > point.time.bound() * MAX_STEP_SHARE {
            step = self.root(n, track, point).0;
        }
        let (mut better, mut size) = (point.time + step, step.bound().abs());
        if size <= T::unit() * point.time.bound().abs() {
            return Next::Nothing;
        }
        if !(size < bracket.last * 0.25 && bracket.holds(better)) {
            // Steps that do not shrink come from rounding, where the value may be rounding alone.
            better = bracket.middle();
            if value.abs() <= point.slack[n] * 4.0 || !bracket.holds(better) {
                return Next::Nothing;
            }
            size = (better - point.time).bound().abs();
        }
        if better <= T::zero() {
            return Next::Nothing;
        }
        bracket.last = size;
        Next::Evaluate(better)
    }

    /// Whether a step to a crossing is so short that two derivatives of all co-ordinates do what
    /// another evaluation would do: what the third adds is less than rounding, and so is what the
    /// fourth of a guard that nearly touches adds to the step, turn^2 MAX_SLOPE_CHANGE/24 of it.
    /// Errors are followed from one evaluation to the next.
    #[inline]
    fn is_last(&self, orders: &[T; 4], step: T) -> bool {
        /// The largest relative change of the guard's slope over the step.
        const MAX_SLOPE_CHANGE: f64 = 1e-5;
        // The powers of a short turn may be less than any f64.
        let turn = step.bound().abs() * self.flow.speed;
        let is_small = T::unit() * 0.25 >= turn * turn * turn;
        let rises = orders[1].bound() > 0.0;
        rises && is_small && is_straight(orders, step, MAX_SLOPE_CHANGE) && !self.follows_errors()
    }
}

/// The step from a point to a root, where it is so short that a cubic gives it; zero elsewhere.
#[inline]
fn remaining<T: Number>(orders: &[T; 4]) -> T {
    /// The largest relative change of the slope over the step.
    const MAX_SLOPE_CHANGE: f64 = 1e-2;
    let step = newton(orders);
    if is_straight(orders, step, MAX_SLOPE_CHANGE) { step } else { T::zero() }
}

/// Whether a guard's slope changes by at most a share on a step.
#[inline]
fn is_straight<T: Number>(orders: &[T; 4], step: T, share: f64) -> bool {
    let [slope, bend] = [orders[1].bound(), orders[2].bound()];
    (step.bound() * bend).abs() <= slope.abs() * share
}

/// The step to the root of a cubic that is near zero, by Newton's method.
#[inline]
fn newton<T: Number>(orders: &[T; 4]) -> T {
    let [value, slope, bend, third] = *orders;
    let (half, sixth) = (bend * T::exact(0.5), third / T::exact(6.0));
    let mut step = -value / slope;
    for _ in 0..3 {
        let cubic = value + step * (slope + step * (half + step * sixth));
        let tangent = slope + step * (bend + step * third * T::exact(0.5));
        step = step - cubic / tangent;
    }
    step
}
