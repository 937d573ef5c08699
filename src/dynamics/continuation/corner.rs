//! From one smooth piece of the map to the next.

use super::point::{ContinuationPoint, FamilyCurve, shifted};
use super::steps::{Accepts, Corner, OrbitPoint};
use crate::dynamics::orbit::ShootingIterate;
use crate::dynamics::strobe::StrobePoint;

/// Halvings of the distance to the corner.
const HALVINGS: usize = 300;
/// Distance at which a corner counts as reached: a few roundings of the strobes.
const CORNER_TOLERANCE: f64 = 1e-15;
/// Distances beyond the corner at which its other side is looked at and entered, nearest first.
const PROBE_DISTANCES: [f64; 7] = [1e-7, 1e-6, 1e-8, 1e-5, 1e-4, 1e-3, 1e-9];
/// Relative error of a corner with which no nearer place beyond is looked for: a piece of the curve
/// between two corners may be shorter than the step.
const RELATIVE_ERROR_TOLERANCE: f64 = 1e-12;

impl FamilyCurve {
    /// The corner between a point and a distance along its tangent at which the piece is another
    /// one or no orbit is found.
    ///
    /// The corner's error is what the halving leaves, rounding, and how far off the corner is found
    /// from the other side: a contact that is too short to be told from a touch counts as none.
    pub(super) fn corner(
        &self,
        base: &ContinuationPoint,
        distance: f64,
        accepts: Option<Accepts<'_, ContinuationPoint>>,
    ) -> Option<Corner<ContinuationPoint>> {
        let (before, rest) = self.approach(base, distance);
        if accepts.is_some_and(|accepts| !accepts(&before)) {
            return None;
        }
        let mut best: Option<Corner<_>> = None;
        for step in PROBE_DISTANCES {
            let Some(beyond) = self.point_beyond(&before, step) else { continue };
            let error = rest * before.tangent.rate.abs() + self.seen_from(&beyond, step, &before);
            if best.as_ref().is_none_or(|it| error < it.error) {
                let before = before.clone();
                best = Some(Corner { before, beyond: Some(beyond), error, is_of_section: false });
            }
            if error <= RELATIVE_ERROR_TOLERANCE * before.value.abs() {
                break;
            }
        }
        best
    }

    /// How far off the corner is found from beyond, and rounding.
    fn seen_from(&self, beyond: &ContinuationPoint, step: f64, before: &ContinuationPoint) -> f64 {
        let back = ContinuationPoint { tangent: beyond.tangent.turned(), ..beyond.clone() };
        let (after, rest) = self.approach(&back, 2.0 * step);
        let apart = (after.value - before.value).abs() + rest * after.tangent.rate.abs();
        apart + self.uncertainty(before)
    }

    /// The last orbit of a point's piece along the curve, and how much further the corner may be.
    fn approach(&self, base: &ContinuationPoint, distance: f64) -> (ContinuationPoint, f64) {
        last_along(base, distance, CORNER_TOLERANCE, &|before, step| {
            self.corrected_point(before, step).filter(|it| it.is_on_piece_of(before))
        })
    }

    /// The curve a step beyond the corner at `before`. Its direction there is that of the other
    /// piece's derivative; of the two ways along it one leads to an orbit of that piece.
    fn point_beyond(&self, before: &ContinuationPoint, step: f64) -> Option<ContinuationPoint> {
        let value = before.value + step * before.tangent.rate;
        let tangents = self.probes(before, step).into_iter().flat_map(|probe| {
            let forward = self.tangent(&probe, value, &before.tangent);
            [forward.turned(), forward]
        });
        // The way forward first, of each probe.
        let mut tangents: Vec<_> = tangents.collect();
        tangents.reverse();
        tangents.into_iter().find_map(|tangent| {
            let base = ContinuationPoint { tangent, ..before.clone() };
            let mut point = self.corrected_point(&base, step)?;
            if point.is_on_piece_of(before) {
                return None;
            }
            // Away from the corner, whichever way the bordering row has turned it.
            if self.product(&point.tangent, &base.tangent, &before.iterate) < 0.0 {
                point.tangent = point.tangent.turned();
            }
            Some(point)
        })
    }

    /// Iterates a step along the old direction that lie on another piece: as it is, and with each
    /// strobe replaced by the image of the one before. A strobe that is still on the slider where
    /// the orbit no longer is is so put right.
    fn probes(&self, from: &ContinuationPoint, step: f64) -> Vec<ShootingIterate> {
        let along = &from.tangent;
        let probed = self.family.map(from.value + step * along.rate).ok().and_then(|map| {
            let points = shifted(&from.iterate.points, &along.points, step);
            let iterate = ShootingIterate::new(&map, &points)?;
            let mut images: Vec<StrobePoint> =
                iterate.passages.iter().map(|it| it.point()).collect();
            images.rotate_right(1);
            Some([Some(iterate), ShootingIterate::new(&map, &images)])
        });
        let other = |probe: &ShootingIterate| !probe.is_on_piece_of(&from.iterate);
        probed.into_iter().flatten().flatten().filter(other).collect()
    }
}

/// The last point that steps along a curve reach from a base, and how much further the next may be
/// that they do not: less than `reached`, unless the halvings run out. `step` has the point at a
/// distance along another's tangent, if there is one.
pub(crate) fn last_along<P: Clone>(
    base: &P,
    distance: f64,
    reached: f64,
    step: &dyn Fn(&P, f64) -> Option<P>,
) -> (P, f64) {
    let mut before = base.clone();
    let mut rest = distance;
    let mut advances = 0;
    for _ in 0..HALVINGS {
        if rest <= reached {
            break;
        }
        match step(&before, 0.5 * rest) {
            // The length left is measured anew from each point: it may be more than was thought.
            Some(next) => {
                before = next;
                advances += 1;
                rest *= if advances > 2 { 1.5 } else { 0.5 };
            }
            None => {
                advances = 0;
                rest *= 0.5;
            }
        }
    }
    (before, rest)
}
