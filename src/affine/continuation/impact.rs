//! The orbit that strikes next to one that touches, where the map has no bounded derivative.
//!
//! Let an orbit touch a guard at the parameter p, and let the orbits beside it that strike it do so
//! at the rate r. Of the return that touches, the strike changes the image by r g, and r^2 is a
//! smooth function of the place and of p, zero at the touch. So orbits that strike are a curve with
//! the direction (dz, dp), on which r grows at a rate of 1:
//!
//!   dz = A dz + b dp + g,  0 = (r^2)_z dz + (r^2)_p dp
//!
//! where A and b are the derivatives of the map without the strike. Its derivative with it is
//! A + g (r^2)_z/(2 r), from which g and (r^2)_z are read next to the touch. Along that direction
//! r^2 itself is of second order: a point beside it is looked for that strikes at the rate of the
//! first order, and from there Newton's method goes on.

use super::super::returns::map::SectionMap;
use super::super::returns::section::Guard;
use super::super::returns::shooting::{Change, MAX_COORDINATES, ReturnMap, Shots};
use super::super::run::place::Place;
use super::curve::{Curve, Jump};
use super::point::{CurvePoint, Direction};
use crate::dynamics::orbit::newton::solve;

/// Steps along the curve beyond the touch at which the strike is looked at.
const PROBE_DISTANCES: [f64; 3] = [1e-8, 1e-9, 1e-7];
/// Lengths along the curve of orbits that strike at which one is looked for, longest first: the
/// nearer the touch, the shorter are the steps that can be made from there.
const LENGTHS: [f64; 5] = [3e-3, 1e-3, 3e-4, 1e-4, 1e-5];
/// The rate of the strike of an orbit that is found, in that of the first order.
const RATES: [f64; 2] = [0.5, 2.0];
/// The most times that the interval is made four times as wide in which r^2 is looked for, and
/// halved.
const WIDENINGS: usize = 8;
const HALVINGS: usize = 24;

/// A strike that a return has next to an orbit that touches.
struct Strike {
    /// The number of the return.
    number: usize,
    event: Guard,
    /// The rate at which the guard is crossed.
    rate: f64,
    /// The change of the image.
    jump: Change,
    /// The derivatives of the square of the rate by the place and by the parameter.
    by_place: Change,
    by_value: f64,
}

impl Strike {
    /// The least rate at which a motion from a place has the event, if it has.
    fn rate_from(&self, map: &SectionMap<'_, f64>, place: &Place<f64>) -> Option<f64> {
        let all = map.crossings(place).ok()?;
        let rates = all.iter().filter(|it| it.guard == self.event).map(|it| it.rate);
        rates.min_by(f64::total_cmp)
    }
}

impl Curve<'_> {
    /// The orbit that strikes next to the one that touches at a corner.
    pub(super) fn striking(&self, touching: &CurvePoint) -> Option<CurvePoint> {
        PROBE_DISTANCES.iter().find_map(|step| {
            let strike = self.strike(touching, *step)?;
            let jump = Jump {
                number: strike.number,
                change: strike.jump.map(|it| it / strike.rate),
                by_place: strike.by_place,
                by_value: strike.by_value,
            };
            let (along, growth) =
                self.direction_with_jump(&touching.shots, &touching.slopes, &jump)?;
            LENGTHS.iter().find_map(|length| {
                self.striking_at(touching, &strike, &along, *length, growth * length)
            })
        })
    }

    /// The strike of the return that alone has one a step beyond a touch.
    fn strike(&self, touching: &CurvePoint, step: f64) -> Option<Strike> {
        let along = &touching.tangent;
        let probe = self.shifted(touching, along, step)?;
        let pairs = || probe.images.iter().zip(&touching.shots.images);
        let mut others = pairs().enumerate().filter(|(_, (a, b))| a.way.events != b.way.events);
        let (number, (with, without)) = others.next().filter(|_| others.next().is_none())?;
        let value = touching.value + step * along.rate;
        let images = self.family.carry(touching.value, std::slice::from_ref(&without.point))?;
        let (change, crossings) = self.family.at(value, |map| {
            let change = map.change_between(&map.take_up(&images[0]), &with.point);
            Some((change, map.crossings(&probe.points[number]).ok()?))
        })?;
        let slowest = crossings.iter().min_by(|a, b| a.rate.abs().total_cmp(&b.rate.abs()))?;
        let (rate, event) = (slowest.rate, slowest.guard);
        let by_state = |n: usize, k: usize| without.derivative[n][k] * along.points[number][k];
        let jump: Change = std::array::from_fn(|n| {
            let smooth = (0..MAX_COORDINATES).map(|k| by_state(n, k)).sum::<f64>()
                + touching.slopes[number][n] * along.rate;
            change[n] - step * smooth
        });
        let weights = self.scales().map(|it| it.powi(-2));
        let size: f64 = (0..MAX_COORDINATES).map(|n| jump[n] * jump[n] * weights[n]).sum();
        let by_place: Change = std::array::from_fn(|k| {
            let all = (0..MAX_COORDINATES)
                .map(|n| (with.derivative[n][k] - without.derivative[n][k]) * jump[n] * weights[n]);
            2.0 * rate * rate * all.sum::<f64>() / size
        });
        let along_place: f64 = by_place.iter().zip(&along.points[number]).map(|(a, b)| a * b).sum();
        let by_value = (rate * rate / step - along_place) / along.rate;
        let is_known = rate > 0.0 && size > 0.0 && by_value.is_finite();
        is_known.then_some(Strike { number, event, rate, jump, by_place, by_value })
    }

    /// The orbit that strikes at about this rate, at a length along the curve of such orbits.
    fn striking_at(
        &self,
        touching: &CurvePoint,
        strike: &Strike,
        along: &Direction,
        length: f64,
        rate: f64,
    ) -> Option<CurvePoint> {
        let value = touching.value + length * along.rate;
        let shots = self.family.at(value, |map| {
            let moved = touching.carried.iter().zip(&along.points).map(|(point, change)| {
                let place = map.take_up(point);
                map.moved(&place, &change.map(|it| it * length), &place)
            });
            let mut places: Vec<Place<f64>> = moved.collect();
            let squared = |place: &Place<f64>| strike.rate_from(map, place).unwrap_or(0.0).powi(2);
            let beside = |from: &Place<f64>, by: f64| {
                let change = self.change_of_square(strike, by);
                map.moved(from, &change, from)
            };
            let from = places[strike.number].clone();
            let by = bracketed(rate * rate, &|by| squared(&beside(&from, by)))?;
            places[strike.number] = beside(&from, by);
            solve(map, Shots::new(map, places)?).ok()
        })?;
        let found =
            self.family.at(value, |map| strike.rate_from(map, &shots.points[strike.number]))?;
        let is_there = RATES[0] * rate <= found && found <= RATES[1] * rate;
        if !is_there || !self.is_near(value, &shots, touching, length) {
            return None;
        }
        self.point(value, shots, along)
    }

    /// The least change of a place that changes the square of the rate by this.
    fn change_of_square(&self, strike: &Strike, by: f64) -> Change {
        let units = self.scales().map(|it| it * it);
        let size: f64 = (0..MAX_COORDINATES).map(|n| strike.by_place[n].powi(2) * units[n]).sum();
        std::array::from_fn(|n| by * strike.by_place[n] * units[n] / size)
    }
}

/// The argument at which a growing function that is zero below some argument has a value.
fn bracketed(value: f64, of: &dyn Fn(f64) -> f64) -> Option<f64> {
    let mut width = 2.0 * value;
    let holds = |width: f64| of(-width) < value && of(width) >= value;
    let mut widths = 0;
    while !holds(width) {
        widths += 1;
        if widths > WIDENINGS {
            return None;
        }
        width *= 4.0;
    }
    let (mut low, mut high) = (-width, width);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if of(middle) < value { low = middle } else { high = middle }
    }
    Some(high)
}
