//! An orbit whose event is lost in a touch, where its map has no bounded derivative.
//!
//! The orbit that touches is that of two pieces: of the one that has the event, whose impact is the
//! slower the nearer the touch is, and whose derivative grows as one over its speed; and of the one
//! that has not, whose derivative is bounded. The first is a smooth curve in the speed of the
//! impact, so that two of its points tell roughly where the touch is. The orbit without the event
//! is looked for there, and followed back to where it touches.

use super::super::returns::map::SectionMap;
use super::super::returns::section::Guard;
use super::super::returns::shooting::{MAX_COORDINATES, ReturnMap, Shots};
use super::super::run::place::Place;
use super::curve::Curve;
use super::family::{OrbitShots, is_near_touch};
use super::point::{CurvePoint, Direction};
use super::words::{LENGTH_FROM_TOUCH, same_events};
use crate::dynamics::continuation::steps::Corner;
use crate::dynamics::orbit::newton::solve;

/// Distances from where a touch is held to be at which the orbit without the event is looked for,
/// as multiples of the distance to the last orbit with it: it may be on either side.
const DISTANCES: [f64; 8] = [1.0, -1.0, 4.0, -4.0, 16.0, -16.0, 64.0, -64.0];
/// Distances aside of where a touch is held to be from which the orbit without the event is looked
/// for too, as multiples of that to the last orbit: next to it motions may have the event still.
const SIDES: [f64; 4] = [1.0, -1.0, 4.0, -4.0];
/// Steps of the curve beyond a touch at which the event has to be there.
const STEPS_TO_TOUCH: [f64; 3] = [1e-10, 1e-8, 1e-6];

/// The lengths of the way back to an orbit whose event is so much faster that the touch is known.
const LENGTHS_FROM_TOUCH: [f64; 4] = [
    LENGTH_FROM_TOUCH,
    4.0 * LENGTH_FROM_TOUCH,
    16.0 * LENGTH_FROM_TOUCH,
    64.0 * LENGTH_FROM_TOUCH,
];
/// A touch is expected within so many times the distance in which an event has become slower.
const MAX_SHARE_TO_TOUCH: f64 = 4.0;

/// The largest derivative of an orbit through which a touch is extrapolated: rounding of the map
/// is magnified by so much in the event's rate, which falls as the derivative grows.
const MAX_DERIVATIVE_OF_EXTRAPOLATED: f64 = 4000.0;
/// The first length of the way back to such an orbit.
const FIRST_LENGTH_BACK: f64 = 1e-6;

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
        let (far, expected) = self.near_touch(base, last)?;
        DISTANCES.iter().find_map(|distance| {
            let value = expected.value + distance * expected.rest.abs();
            let shots = self.without_event(&far, last, &expected, value)?;
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
        let clear = self.clear_of_touch(last, &leaves_digits);
        let (base, last) = clear.as_ref().map_or((base, last), |it| (it, it));
        let (far, expected) = self.near_touch(base, last)?;
        let apart = expected.share * self.distance_along(last, far.value, &far.shots)?.abs();
        let further = |orbit: &CurvePoint| Some(self.approach_within(orbit, apart, apart).last);
        let before = std::iter::successors(further(&base.turned()), further);
        let orbits = [last.clone()].into_iter().chain(before).take(ORBITS_TO_TOUCH);
        let (rates, values) = self.rates_and_values(orbits, &expected)?;
        let value = value_at_zero(&rates, &values);
        // The parabola is off by more than the polynomial: by what it leaves out, and by rounding,
        // which is large where the rate is small.
        let near = 0..ORBITS_OF_PARABOLA;
        let unknown = (value - value_at_zero(&rates[near.clone()], &values[near])).abs();
        let ahead = (value - last.value) * last.tangent.rate.signum();
        let error = unknown + self.least_error(last, self.blurs(base, last));
        (unknown <= MAX_ERROR_SHARE * ahead).then_some(TouchAhead {
            value,
            error,
            event: expected.event,
        })
    }

    /// An orbit before the last one that was found that is clear of the touch, if that one is not.
    pub(super) fn clear_of_touch(
        &self,
        last: &CurvePoint,
        is_clear: &dyn Fn(&CurvePoint) -> bool,
    ) -> Option<CurvePoint> {
        let (mut point, mut length) = (None::<CurvePoint>, FIRST_LENGTH_BACK);
        loop {
            let here = point.as_ref().unwrap_or(last);
            if is_clear(here) {
                return point;
            }
            let back = self.approach_within(&here.turned(), length, length);
            if back.length == 0.0 {
                return point;
            }
            (point, length) = (Some(back.last.turned()), 2.0 * length);
        }
    }

    /// Whether an orbit has shrunk to a state of rest.
    pub(super) fn is_rest(&self, point: &CurvePoint) -> bool {
        let first = &point.shots.points[0];
        let is_rest =
            |map: &SectionMap<'_, f64>| map.is_rest(first.mode, &first.state, point.orbit.time);
        self.family.at(point.value, |map| Some(is_rest(map))).unwrap_or(false)
    }

    /// An orbit before the last one that was found, and the touch that both expect near to it.
    fn near_touch(&self, base: &CurvePoint, last: &CurvePoint) -> Option<(CurvePoint, Expected)> {
        LENGTHS_FROM_TOUCH.iter().find_map(|length| {
            let far = self.approach_within(&base.turned(), *length, *length).last;
            let expected = self.expected_touch(&far, last)?;
            (expected.share <= MAX_SHARE_TO_TOUCH).then_some((far, expected))
        })
    }

    /// The rates at which orbits have an event, and their values of the parameter.
    fn rates_and_values(
        &self,
        orbits: impl Iterator<Item = CurvePoint>,
        expected: &Expected,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let all = orbits.map(|orbit| {
            let crossings = self.crossings(orbit.value, &orbit.shots)?;
            let crossing = crossings.into_iter().nth(expected.place)?;
            (crossing.guard == expected.event).then_some((crossing.rate, orbit.value))
        });
        all.collect()
    }

    /// A bound of the distance in the parameter from the last orbit that was found to a touch, if
    /// an event becomes so slow towards it; zero otherwise. The distance falls as a power of the
    /// event's rate, as the square mostly: as which one two orbits before tell. Twice what follows
    /// leaves room for higher orders.
    pub(super) fn distance_to_touch(&self, base: &CurvePoint, last: &CurvePoint) -> f64 {
        let Some((far, expected)) = self.near_touch(base, last) else { return 0.0 };
        // A straight line leads too far rather than too near.
        let power = self.power_of_rate(last, &far, &expected).unwrap_or(1.0);
        let slowed = libm::pow(1.0 + 1.0 / expected.share, power);
        2.0 * (last.value - far.value).abs() / (slowed - 1.0)
    }

    /// The power of an event's rate as which the distance to a touch grows, from the last orbit
    /// over one before to another as far behind that.
    fn power_of_rate(
        &self,
        last: &CurvePoint,
        far: &CurvePoint,
        expected: &Expected,
    ) -> Option<f64> {
        let apart = self.distance_along(last, far.value, &far.shots)?.abs();
        let further = self.approach_within(far, apart, apart).last;
        let orbits = [far.clone(), further].into_iter();
        let (rates, values) = self.rates_and_values(orbits, expected)?;
        let [from, to] = [0, 1].map(|n| (values[n] - last.value).abs());
        let power = libm::log(to / from) / libm::log(rates[1] / rates[0]);
        (power > 0.0).then_some(power)
    }

    /// The orbit at a value next to a touch that has not the event.
    fn without_event(
        &self,
        base: &CurvePoint,
        last: &CurvePoint,
        expected: &Expected,
        value: f64,
    ) -> Option<OrbitShots> {
        let is_without = |shots: &OrbitShots| {
            count_events(shots, expected.event) < count_events(&last.shots, expected.event)
        };
        let length = (value - last.value).abs().max(expected.rest.abs()) / self.unit;
        self.family.at(value, |map| {
            let pairs = base.carried.iter().zip(&last.carried);
            let moved = pairs.map(|(base, last)| {
                let [base, last] = [base, last].map(|it| map.take_up(it));
                let change = map.change_between(&base, &last);
                map.moved(&last, &change.map(|it| expected.share * it), &last)
            });
            let guess: Vec<Place<f64>> = moved.collect();
            let reach = self.distance(value, &Shots::new(map, guess.clone())?, last)?;
            let aside =
                SIDES.iter().flat_map(|side| (0..guess[0].state.len()).map(move |n| (side, n)));
            let aside = aside.filter_map(|(side, n)| {
                let mut change = [0.0; MAX_COORDINATES];
                change[n] = side * reach * self.scales()[n];
                let moved = guess.iter().map(|it| map.moved(it, &change, it));
                Shots::new(map, moved.collect()).filter(is_without)
            });
            let all = Shots::new(map, guess.clone()).into_iter().chain(aside);
            let found = all.filter_map(|it| solve(map, it).ok());
            let mut found =
                found.filter(|it| is_without(it) && self.is_near(value, it, last, length));
            found.next()
        })
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

/// Whether a touch leaves an orbit enough digits to be extrapolated through it.
pub(super) fn leaves_digits(orbit: &CurvePoint) -> bool {
    orbit.shots.largest_derivative() <= MAX_DERIVATIVE_OF_EXTRAPOLATED
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
