//! The corrector: the orbit a step along the curve's tangent, by Newton's method.

use super::super::returns::shooting::{Change, MAX_COORDINATES, ReturnMap, Shots};
use super::curve::{BORDERED_DIMENSION, Curve, spread_changes, sum};
use super::family::OrbitShots;
use super::point::{CurvePoint, Direction};
use crate::dynamics::linear::solve;

/// Newton's iterations of a corrector: more, and the step was too long.
const ITERATIONS: usize = 10;

/// The rate of the parameter, in units, from which a corrector holds its value: further from a
/// fold, where orbits are far from values.
const MIN_STEEP_RATE: f64 = 0.3;

/// The least distance along the tangent to the next orbit, and the greatest to it, in steps.
const MIN_ALONG_STEP: f64 = 0.5;
const MAX_LENGTH_OF_STEP: f64 = 2.0;

impl Curve<'_> {
    /// The orbit at a distance along the tangent of `base`.
    pub fn corrected_point(&self, base: &CurvePoint, distance: f64) -> Option<CurvePoint> {
        let is_steep = (base.tangent.rate / self.unit).abs() >= MIN_STEEP_RATE;
        let at_value = is_steep.then(|| self.corrected(base, distance, true)).flatten();
        at_value.or_else(|| self.corrected_freely(base, distance))
    }

    /// The orbit at a distance along the tangent of `base`, with the parameter free, as next to
    /// corners.
    pub fn corrected_freely(&self, base: &CurvePoint, distance: f64) -> Option<CurvePoint> {
        self.corrected(base, distance, false)
    }

    /// The orbit at the value of `base`, which need not close.
    pub fn corrected_at_value(&self, base: &CurvePoint) -> Option<CurvePoint> {
        self.corrected(base, 0.0, true)
    }

    /// Whether a step leads along the curve, rather than to another sheet of it or another curve.
    fn is_step(&self, base: &CurvePoint, moved: &Direction, distance: f64) -> bool {
        let along = self.product(&base.tangent, moved, &base.shots) / distance;
        let length = self.product(moved, moved, &base.shots).sqrt() / distance.abs();
        along >= MIN_ALONG_STEP && length <= MAX_LENGTH_OF_STEP
    }

    /// The orbit a step along the tangent of `base`: the parameter is held at the tangent's value,
    /// for which one solver is prepared, or the distance is.
    fn corrected(&self, base: &CurvePoint, distance: f64, holds_value: bool) -> Option<CurvePoint> {
        let mut value = base.value + distance * base.tangent.rate;
        let mut shots = self.shifted(base, &base.tangent, distance)?;
        let mut best: Option<(f64, OrbitShots)> = None;
        for _ in 0..ITERATIONS {
            let left = match holds_value {
                true => 0.0,
                false => self.distance_along(base, value, &shots)? - distance,
            };
            let in_place = left.abs() <= 0.01 * distance.abs() + f64::EPSILON;
            let closed = in_place && shots.is_closed();
            match &best {
                Some((_, before)) if !closed || shots.residual >= before.residual => break,
                None if !closed => {}
                _ => best = Some((value, shots.clone())),
            }
            let slopes = match holds_value {
                true => base.slopes.clone(),
                false => self.family.slopes(value, &shots),
            };
            let mut bordered = self.bordered_system(&shots, &slopes, &base.tangent, &base.shots);
            if holds_value {
                bordered.matrix[MAX_COORDINATES][..MAX_COORDINATES].fill(0.0);
            }
            let mut right = [0.0; BORDERED_DIMENSION];
            (0..MAX_COORDINATES).for_each(|n| right[n] = -bordered.offset[n] / self.scales()[n]);
            right[MAX_COORDINATES] = -left;
            let (first, step) = self.unscaled(&solve(bordered.matrix, right));
            let added: Vec<Change> =
                shots.defects.iter().zip(&slopes).map(|(a, b)| sum(a, b, step)).collect();
            let changes = spread_changes(&shots, first, &added);
            let next = self.moved(value, &shots, &changes, step)?;
            (value, shots) = (value + step, next);
        }
        let (value, shots) = best?;
        let moved = self.moved_from(base, value, &shots)?;
        if distance.abs() > f64::EPSILON && !self.is_step(base, &moved, distance) {
            return None;
        }
        self.point(value, shots, &base.tangent)
    }

    /// The changes of all points and of the parameter from those of an orbit.
    fn moved_from(&self, base: &CurvePoint, value: f64, shots: &OrbitShots) -> Option<Direction> {
        let points = self.family.at(value, |map| {
            let pairs = base.carried.iter().zip(&shots.points);
            Some(pairs.map(|(a, b)| map.change_between(&map.take_up(a), b)).collect())
        })?;
        Some(Direction { points, rate: value - base.value })
    }

    /// The shots at another value of the parameter, with these changes.
    fn moved(
        &self,
        value: f64,
        shots: &OrbitShots,
        changes: &[Change],
        step: f64,
    ) -> Option<OrbitShots> {
        let carried = self.family.carry(value, &shots.points)?;
        let count = carried.len();
        self.family.at(value + step, |map| {
            let moved = carried.iter().zip(changes).enumerate().map(|(k, (point, change))| {
                let piece = &shots.images[(k + count - 1) % count].point;
                map.moved(&map.take_up(point), change, piece)
            });
            Shots::new(map, moved.collect())
        })
    }

    /// The distance along the tangent of `base` at which shots lie.
    pub fn distance_along(&self, base: &CurvePoint, value: f64, shots: &OrbitShots) -> Option<f64> {
        let moved = self.moved_from(base, value, shots)?;
        Some(self.product(&base.tangent, &moved, &base.shots))
    }
}
