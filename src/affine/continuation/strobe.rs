//! A branch at a strobe at which none of its grazes lies.
//!
//! At a graze that lies at the strobe, an event passes the strobe where it begins to be one: the
//! map has two or three corners next to each other. No orbit, multiplier or bifurcation hangs on
//! its angle. So a branch on which an event that is touched, gained or lost comes near to the
//! strobe is followed at another angle, and its orbits are shown at the one that was asked for.

use super::super::returns::crossings::Crossing;
use super::super::returns::orbit::Orbit;
use super::super::returns::section::Guard;
use super::super::returns::shooting::{ReturnMap, Shots};
use super::curve::Curve;
use super::point::{CurvePoint, Direction};
use crate::dynamics::continuation::steps::Corner;
use crate::dynamics::linear::apply;
use core::f64::consts::TAU;

/// The shares of the forcing period between an event and the strobe of which it is near.
const NEAR: f64 = 0.02;
/// The number of angles that are looked at, half a step from the first.
const ANGLES: usize = 32;

/// The angle beside a strobe which is farthest from the phases of all these events, radians, if one
/// of them is near the strobe itself.
pub(super) fn angle_beside(phases: &[f64]) -> Option<f64> {
    let distance = |at: f64| {
        let apart = phases.iter().map(|it| (it - at).rem_euclid(1.0));
        apart.map(|it| it.min(1.0 - it)).fold(f64::INFINITY, f64::min)
    };
    let angles = (0..ANGLES).map(|n| (n as f64 + 0.5) / ANGLES as f64);
    let farthest = angles.max_by(|a, b| distance(*a).total_cmp(&distance(*b)))?;
    (distance(0.0) < NEAR && distance(farthest) > NEAR).then_some(farthest * TAU)
}

impl Curve<'_> {
    /// The time of a corner's event since the strobe before it, in forcing periods from 0 to 1.
    pub(super) fn phase(
        &self,
        base: &CurvePoint,
        corner: &Corner<CurvePoint>,
        event: Guard,
    ) -> Option<f64> {
        let sides = [corner.beyond.as_ref(), Some(&corner.before), Some(base)];
        sides.into_iter().flatten().find_map(|side| {
            let crossings = self.crossings_with_phases(side)?;
            let own = crossings.iter().filter(|(_, it)| it.guard == event);
            let slowest = own.min_by(|(_, a), (_, b)| a.rate.abs().total_cmp(&b.rate.abs()))?;
            Some(slowest.0)
        })
    }

    /// The events of an orbit, each with its time since the strobe before it, in forcing periods
    /// from 0 to 1.
    pub(super) fn crossings_with_phases(&self, orbit: &CurvePoint) -> Option<Vec<(f64, Crossing)>> {
        let period = self.family.at(orbit.value, |map| map.forcing_period())?;
        let phase = |it: &Crossing| (it.time / period).rem_euclid(1.0);
        let crossings = self.crossings(orbit.value, &orbit.shots)?;
        Some(crossings.into_iter().map(|it| (phase(&it), it)).collect())
    }

    /// A point of this curve as one of that by which it is shown; itself where there is none.
    pub(super) fn shown_point(&self, point: &CurvePoint) -> CurvePoint {
        self.shown.and_then(|it| self.seen_on(it, point)).unwrap_or_else(|| point.clone())
    }

    /// A point of this curve as one of another, at the strobes that come after its points. Its
    /// orbit keeps its events and multipliers: next to a touch rounding on the way to those strobes
    /// decides whether the event is there.
    pub(super) fn seen_on(&self, shown: &Curve<'_>, point: &CurvePoint) -> Option<CurvePoint> {
        let strobe = shown.family.section().clone().every(1);
        let pairs = point.shots.points.iter().zip(&point.tangent.points);
        let mut passed = None;
        let (places, points) = self.family.at_section(point.value, &strobe, |map| {
            pairs
                .map(|(place, change)| {
                    let image = map.image(place).ok()?;
                    passed.get_or_insert(image.way.events.len());
                    Some((map.rebased(&image.point), apply(&image.derivative, change)))
                })
                .collect::<Option<(Vec<_>, Vec<_>)>>()
        })?;
        let shots = shown.family.at(point.value, |map| Shots::new(map, places))?;
        let along = Direction { points, rate: point.tangent.rate };
        let mut seen = shown.point(point.value, shots, &along)?;
        let points = std::mem::take(&mut seen.orbit.points);
        seen.orbit = Orbit { points, ..point.orbit.clone() };
        let passed = passed.unwrap_or(0).min(seen.orbit.events.len());
        seen.orbit.events.rotate_left(passed);
        Some(seen)
    }
}
