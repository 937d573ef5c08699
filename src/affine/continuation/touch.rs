//! An orbit whose event is lost in a touch, where its map has no bounded derivative.
//!
//! The orbit that touches is that of two pieces: of the one that has the event, whose impact is the
//! slower the nearer the touch is, and whose derivative grows as one over its speed; and of the one
//! that has not, whose derivative is bounded. The first is a smooth curve in the speed of the
//! impact, so that two of its points tell roughly where the touch is. The orbit without the event
//! is looked for there, and followed back to where it touches.

use super::super::returns::section::Guard;
use super::super::returns::shooting::{MAX_COORDINATES, ReturnMap, Shots};
use super::curve::Curve;
use super::family::{OrbitShots, is_near_touch};
use super::point::{CurvePoint, Direction};
use super::words::same_events;
use crate::dynamics::continuation::steps::Corner;
use crate::dynamics::orbit::newton::solve;

/// Distances from where a touch is held to be at which the orbit without the event is looked for,
/// as multiples of the distance to the last orbit with it: it may be on either side.
const DISTANCES: [f64; 8] = [1.0, -1.0, 4.0, -4.0, 16.0, -16.0, 64.0, -64.0];
/// Steps of the curve beyond a touch at which the event has to be there.
const STEPS_TO_TOUCH: [f64; 3] = [1e-10, 1e-8, 1e-6];

/// A touch is expected within so many times the distance in which an event has become slower.
const MAX_SHARE_TO_TOUCH: f64 = 4.0;

/// The orbits through which a touch is extrapolated.
const ORBITS_TO_TOUCH: usize = 5;
/// Those of the parabola that tells how far the extrapolation is to be trusted.
const ORBITS_OF_PARABOLA: usize = 3;
/// The share of its distance from the last orbit up to which the error of such a touch is accepted.
const MAX_ERROR_SHARE: f64 = 0.1;

/// A touch ahead of the last orbit that was found, with a bound of the error of its value.
pub(super) struct TouchAhead {
    pub value: f64,
    pub error: f64,
    pub event: Guard,
}

/// A touch as two orbits with the event tell it.
struct Expected {
    /// The parameter's value.
    value: f64,
    /// The distance in the parameter from the last orbit with the event, signed.
    rest: f64,
    /// The touch lies as many times further along than these orbits are apart.
    share: f64,
    /// The event, and its place among those of the orbit.
    event: Guard,
    place: usize,
}

impl Curve<'_> {
    /// The corner at which the curve from `base` to the last orbit of its piece loses an event in a
    /// touch, as the orbit without the event has it.
    pub(super) fn touch_from_beyond(
        &self,
        base: &CurvePoint,
        last: &CurvePoint,
    ) -> Option<Corner<CurvePoint>> {
        // Elsewhere the orbit is found to its last digits until it touches.
        if !is_near_touch(&last.shots) {
            return None;
        }
        let expected = self.expected_touch(base, last)?;
        DISTANCES.iter().find_map(|distance| {
            let value = expected.value + distance * expected.rest.abs();
            let shots = self.without_event(base, last, &expected, value)?;
            let points = vec![[0.0; MAX_COORDINATES]; shots.points.len()];
            let back = Direction { points, rate: self.unit * (expected.value - value).signum() };
            let point = self.point(value, shots, &back)?;
            let length = (expected.value - value) / point.tangent.rate;
            let end = self.approach(&point, length.abs());
            let (own, touch) = (end.error(), end.last);
            let is_there = (touch.value - expected.value).abs() <= expected.rest.abs()
                && self.has_event_beyond(&touch, expected.event);
            if !is_there {
                return None;
            }
            let error = own.max(self.least_error(&touch, self.blurs(&point, &touch)));
            let is_forward = touch.tangent.rate * last.tangent.rate >= 0.0;
            let before = if is_forward { touch } else { touch.turned() };
            Some(Corner { before, beyond: Some(point.turned()), error, is_of_section: false })
        })
    }

    /// The touch to which the event comes that has become slowest beside what it was.
    fn expected_touch(&self, base: &CurvePoint, last: &CurvePoint) -> Option<Expected> {
        let [from, to] = [base, last].map(|it| self.crossings(it.value, &it.shots));
        let (to, from) = same_events(to?, from?)?;
        let slowed = from.iter().zip(&to).map(|(from, to)| (from.rate, to.rate, to.guard));
        let slowed = slowed.enumerate();
        let slowed = slowed.filter(|(_, (from, to, _))| *to > 0.0 && to < from && from.is_finite());
        let (place, (from, to, event)) =
            slowed.min_by(|(_, a), (_, b)| (a.1 / a.0).total_cmp(&(b.1 / b.0)))?;
        let share = to / (from - to);
        let rest = share * (last.value - base.value);
        Some(Expected { value: last.value + rest, rest, share, event, place })
    }

    /// The touch ahead of the last orbit that was found, to which an event becomes slow, where no
    /// orbit is found beyond.
    ///
    /// The closer the touch, the shorter is the step by which the next orbit is found. But along
    /// the curve the parameter is a smooth function of the event's rate, and is extrapolated to a
    /// rate of zero: through orbits that are as far apart as the touch is from the last one. They
    /// are found from the base on, each from the one before, whose direction is known better.
    pub(super) fn touch_ahead(&self, base: &CurvePoint, last: &CurvePoint) -> Option<TouchAhead> {
        if !is_near_touch(&last.shots) {
            return None;
        }
        let (far, Expected { share, event, place, .. }) = self.near_touch(base, last)?;
        let apart = share * self.distance_along(last, far.value, &far.shots)?.abs();
        let rate_and_value = |orbit: &CurvePoint| {
            let crossing = self.crossings(orbit.value, &orbit.shots)?.into_iter().nth(place)?;
            (crossing.guard == event).then_some((crossing.rate, orbit.value))
        };
        let further = |orbit: &CurvePoint| Some(self.approach_within(orbit, apart, apart).last);
        let before = std::iter::successors(further(&base.turned()), further);
        let before = before.take(ORBITS_TO_TOUCH - 1).map(|it| rate_and_value(&it));
        let known = [rate_and_value(last)].into_iter().chain(before).collect::<Option<Vec<_>>>()?;
        let (rates, values): (Vec<f64>, Vec<f64>) = known.into_iter().unzip();
        let value = value_at_zero(&rates, &values);
        // The parabola is off by more than the polynomial: by what it leaves out, and by rounding,
        // which is large where the rate is small.
        let near = 0..ORBITS_OF_PARABOLA;
        let unknown = (value - value_at_zero(&rates[near.clone()], &values[near])).abs();
        let ahead = (value - last.value) * last.tangent.rate.signum();
        let error = unknown + self.least_error(last, self.blurs(base, last));
        (unknown <= MAX_ERROR_SHARE * ahead).then_some(TouchAhead { value, error, event })
    }

    /// An orbit before the last one that was found, and the touch that both expect near to it.
    fn near_touch(&self, base: &CurvePoint, last: &CurvePoint) -> Option<(CurvePoint, Expected)> {
        let far = self.point_before(base);
        let expected = self.expected_touch(&far, last)?;
        (expected.share <= MAX_SHARE_TO_TOUCH).then_some((far, expected))
    }

    /// A bound of the distance in the parameter from the last orbit that was found to a touch, if
    /// an event becomes so slow towards it; zero otherwise. The square of the event's rate falls in
    /// proportion to that distance; twice what follows leaves room for higher orders.
    pub(super) fn distance_to_touch(&self, base: &CurvePoint, last: &CurvePoint) -> f64 {
        self.near_touch(base, last).map_or(0.0, |(far, it)| {
            let slowed = 1.0 + 1.0 / it.share;
            2.0 * (last.value - far.value).abs() / (slowed * slowed - 1.0)
        })
    }

    /// The orbit at a value next to a touch that has not the event.
    fn without_event(
        &self,
        base: &CurvePoint,
        last: &CurvePoint,
        expected: &Expected,
        value: f64,
    ) -> Option<OrbitShots> {
        let found = self.family.at(value, |map| {
            let pairs = base.carried.iter().zip(&last.carried);
            let places = pairs.map(|(base, last)| {
                let [base, last] = [base, last].map(|it| map.take_up(it));
                let change = map.change_between(&base, &last);
                map.moved(&last, &change.map(|it| expected.share * it), &last)
            });
            solve(map, Shots::new(map, places.collect())?).ok()
        })?;
        let count = |shots: &OrbitShots| count_events(shots, expected.event);
        let is_other = count(&found) < count(&last.shots);
        (is_other && self.is_near(value, &found, last, (value - last.value).abs() / self.unit))
            .then_some(found)
    }

    /// Whether an orbit has an event more a step further along its curve.
    fn has_event_beyond(&self, orbit: &CurvePoint, event: Guard) -> bool {
        let count = |shots: &OrbitShots| count_events(shots, event);
        STEPS_TO_TOUCH.iter().any(|step| {
            let further = self.shifted(orbit, &orbit.tangent, *step);
            further.is_some_and(|it| count(&it) > count(&orbit.shots))
        })
    }
}

/// The value at zero of the polynomial that has these values at these arguments.
fn value_at_zero(arguments: &[f64], values: &[f64]) -> f64 {
    let weight = |own: &f64| -> f64 {
        let others = arguments.iter().filter(|it| *it != own);
        others.map(|it| it / (it - own)).product()
    };
    arguments.iter().zip(values).map(|(it, value)| weight(it) * value).sum()
}

fn count_events(shots: &OrbitShots, event: Guard) -> usize {
    shots.images.iter().flat_map(|it| &it.way.events).filter(|it| **it == event).count()
}
