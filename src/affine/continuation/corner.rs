//! From one smooth piece of the map to the next.

use super::super::returns::shooting::{ReturnMap, Shots};
use super::curve::Curve;
use super::family::{OrbitShots, is_near_touch};
use super::point::{CurvePoint, are_on_one_piece};
use crate::dynamics::continuation::corner::last_along;
use crate::dynamics::continuation::steps::{Corner, OrbitPoint};
use crate::dynamics::orbit::newton::polish;
use core::cell::Cell;

/// Distance at which a corner counts as reached: some roundings of the points.
const CORNER_TOLERANCE: f64 = 1e-14;
/// Places beyond a corner lie within this many times the square root of the step: a touch moves an
/// orbit by a root.
pub(super) const MAX_ROOT_MULTIPLE: f64 = 10.0;
/// Distances beyond the corner at which its other side is looked at and entered, nearest first.
const PROBE_DISTANCES: [f64; 7] = [1e-7, 1e-6, 1e-8, 1e-5, 1e-4, 1e-3, 1e-9];
/// Relative error of a corner with which no nearer place beyond is looked for; none is said to be
/// smaller, because a touch within the solver's rounding of its guard counts as none.
const RELATIVE_ERROR_TOLERANCE: f64 = 1e-11;
/// The next piece ends within this share of the step at which it was found: one that ends further
/// away has others between it and the corner.
const MAX_END_SHARE: f64 = 0.1;
/// The distance of the next piece's end from the corner's orbit is at most this share of that at
/// which the piece was found: the piece of another orbit, beyond a discontinuity, does not come
/// nearer. Within a step an orbit is as near as it comes where it does not depend on the parameter.
const MAX_DISTANCE_SHARE: f64 = 0.5;
/// Times once around after which a motion from an orbit next to a corner is looked at.
const SETTLING_TURNS: [u32; 2] = [1, 40];
/// Steps along the curve by which such a motion begins aside of the orbit: on one of the two sides
/// its mode holds there.
const SIDE_STEPS: [f64; 2] = [8.0, -8.0];
/// Times that a direction beyond a corner is taken again from a place nearer to it.
const REFINEMENTS: usize = 4;

/// The distance to where a multiplier would be 1 is part of a corner's error up to this multiple of
/// what rounding leaves uncertain of the orbit: rounding then decides where the piece seems to end.
const MAX_BLURS: f64 = 100.0;
/// The way to such a corner is halved at most so often.
const MAX_HALVINGS_TO_CORNER: usize = 50;
/// The length along the curve over which a multiplier's way to 1 is measured, at least.
const LENGTH_TO_MULTIPLIER: f64 = 1e-2;

/// A piece of a curve followed as far as it goes.
pub(super) struct Approach {
    /// The last orbit of the piece.
    pub last: CurvePoint,
    /// The length of the way to it.
    pub length: f64,
    /// That of the first step of the way; zero where there was none.
    pub first_step: f64,
    /// The distance from it within which the piece ends.
    rest: f64,
    /// Whether no orbit was found further on, rather than one of another piece.
    is_lost: bool,
}

/// Distances in the parameter that rounding leaves uncertain of a corner.
#[derive(Clone, Copy)]
pub(super) struct Blurs {
    /// That of the orbit there, as [`Curve::blur`] has it.
    own: f64,
    /// That to where a multiplier would be 1 if rounding decides where the piece seems to end; zero
    /// elsewhere.
    to_unit: f64,
}

impl Approach {
    /// A bound of the error of the parameter's value at the piece's end, as halved.
    pub fn error(&self) -> f64 {
        self.rest * self.last.tangent.rate.abs()
    }
}

impl Curve<'_> {
    /// The corner between a point and a distance along its tangent at which the piece is another
    /// one or no orbit is found.
    ///
    /// The corner's error is what the halving leaves, and the distance at which the corner is found
    /// from the other side if it is, but at least what is looked for.
    pub fn corner(&self, base: &CurvePoint, distance: f64) -> Corner<CurvePoint> {
        // On the way to a touch steps become short, and lead to other orbits in the end.
        if is_near_touch(&base.shots)
            && let Some(touch) = self.touch_from_beyond(base, base)
        {
            return touch;
        }
        self.corner_at(base, self.approach(base, distance))
    }

    /// The corner at the end of a piece that was followed from a point.
    pub(super) fn corner_at(&self, base: &CurvePoint, end: Approach) -> Corner<CurvePoint> {
        let (own, before) = (end.error(), end.last);
        let blurs = self.blurs(base, &before);
        let least = self.least_error(&before, blurs);
        if let Some(beyond) = self.past_strobe(&before) {
            let (beyond, error) = (Some(beyond), own.max(least));
            return Corner { before, beyond, error, is_of_section: true };
        }
        // Next to a touch a short step may lead to the piece beyond, or nowhere.
        let is_near_touch = is_near_touch(&before.shots);
        if is_near_touch && let Some(touch) = self.touch_from_beyond(base, &before) {
            return touch;
        }
        let error = f64::INFINITY;
        let mut best = Corner { before, beyond: None, error, is_of_section: false };
        for step in PROBE_DISTANCES {
            let before = &best.before;
            let Some(beyond) = self.point_beyond(before, step) else { continue };
            let Some(apart) = self.seen_from(&beyond, step, before) else { continue };
            if apart > MAX_END_SHARE * step {
                continue;
            }
            let error = own + apart;
            if error < best.error || best.beyond.is_none() {
                (best.beyond, best.error) = (Some(beyond), error);
            }
            if best.error <= RELATIVE_ERROR_TOLERANCE * best.before.value.abs() {
                break;
            }
        }
        let error = if best.beyond.is_none() { own } else { best.error };
        if best.beyond.is_none() {
            best.beyond = self.striking(&best.before);
        }
        // Where rounding decides, the end is no touch that an event would tell.
        let is_told = (is_near_touch || best.beyond.is_none()) && blurs.to_unit == 0.0;
        let to_touch = if is_told { self.distance_to_touch(base, &best.before) } else { 0.0 };
        best.error = error.max(least).max(to_touch);
        best
    }

    /// The end of a piece of the curve as a corner beyond which no orbit is looked for.
    pub fn lost_corner(&self, base: &CurvePoint, distance: f64) -> Corner<CurvePoint> {
        let end = self.approach(base, distance);
        let is_near_touch = is_near_touch(&end.last.shots);
        let to_touch = if is_near_touch { self.distance_to_touch(base, &end.last) } else { 0.0 };
        let least = self.least_error(&end.last, self.blurs(base, &end.last));
        let error = end.error().max(least).max(to_touch);
        Corner { before: end.last, beyond: None, error, is_of_section: false }
    }

    /// The least error that is said of a corner.
    pub(super) fn least_error(&self, before: &CurvePoint, blurs: Blurs) -> f64 {
        let Blurs { own, to_unit } = blurs;
        RELATIVE_ERROR_TOLERANCE * before.value.abs() + self.uncertainty(before) + own + to_unit
    }

    /// What rounding leaves uncertain of a corner which was reached from a base.
    pub(super) fn blurs(&self, base: &CurvePoint, before: &CurvePoint) -> Blurs {
        let own = self.blur(before, &base.tangent);
        if distance_to_unit_multiplier(base, before) > MAX_BLURS * own {
            return Blurs { own, to_unit: 0.0 };
        }
        // From next to the end the multiplier's own rounding would decide.
        let far = self.approach_within(&base.turned(), LENGTH_TO_MULTIPLIER, LENGTH_TO_MULTIPLIER);
        let own = self.blur_from_afar(before, &far.last.turned(), own);
        Blurs { own, to_unit: distance_to_unit_multiplier(&far.last, before) }
    }

    /// The blur of a corner at which a multiplier comes to 1, on the way to it from an orbit far
    /// before: at most what the last orbit itself says.
    ///
    /// There the blur b is R/x at a distance x from the corner, with some R. If the corner lies e
    /// beyond where it was found, e is at most R/e, since rounding has ended the way. From an orbit
    /// at the distance L before that place b = R/(L + e), so that e is at most the larger one of L
    /// and 2 b.
    fn blur_from_afar(&self, before: &CurvePoint, far: &CurvePoint, own: f64) -> f64 {
        let (mut least, mut point) = (own, far.clone());
        for _ in 0..MAX_HALVINGS_TO_CORNER {
            let apart = (before.value - point.value).abs();
            let blur = self.blur(&point, &point.tangent);
            least = least.min(apart.max(2.0 * blur));
            let rest = self.distance_along(&point, before.value, &before.shots);
            let Some(rest) = rest.filter(|_| apart > blur) else { break };
            let next = self.approach_within(&point, 0.5 * rest, 0.5 * rest);
            if next.length == 0.0 {
                break;
            }
            point = next.last;
        }
        least
    }

    /// The distance in the parameter between the corner and where it is found from beyond: zero
    /// where a derivative grows without bound, so that the way there is lost before. None
    /// where the way does not lead to the orbit at the corner: it is then another one's.
    fn seen_from(&self, beyond: &CurvePoint, step: f64, before: &CurvePoint) -> Option<f64> {
        let end = self.approach(&beyond.turned(), 2.0 * step);
        let [from, to] = [beyond, &end.last].map(|it| self.distance(it.value, &it.shots, before));
        let apart = (end.last.value - before.value).abs() + end.error();
        let comes_nearer = to? <= (MAX_DISTANCE_SHARE * from?).max(step);
        let has_no_bound = end.is_lost || is_near_touch(&end.last.shots);
        comes_nearer.then_some(if has_no_bound { 0.0 } else { apart })
    }

    /// Follows the curve from a point as far as its piece goes.
    pub(super) fn approach(&self, base: &CurvePoint, distance: f64) -> Approach {
        self.approach_within(base, distance, f64::INFINITY)
    }

    /// Follows the curve from a point as far as its piece goes, or for a length.
    pub(super) fn approach_within(&self, base: &CurvePoint, distance: f64, most: f64) -> Approach {
        self.approach_until(base, distance, &|_, length| length > most)
    }

    /// Follows the curve from a point as far as its piece goes, or until the last orbit and the
    /// length of the way to it are such that it is over.
    pub(super) fn approach_until(
        &self,
        base: &CurvePoint,
        distance: f64,
        is_over: &dyn Fn(&CurvePoint, f64) -> bool,
    ) -> Approach {
        let (is_lost, length, first_step) = (Cell::new(false), Cell::new(0.0), Cell::new(0.0));
        let (last, rest) = last_along(base, distance, CORNER_TOLERANCE, &|from, step| {
            if is_over(from, length.get()) {
                return None;
            }
            let there = self.corrected_freely(from, step).or_else(|| self.at_value(from, step));
            is_lost.set(there.is_none());
            let there = there.filter(|it| it.is_on_piece_of(from))?;
            if length.get() == 0.0 {
                first_step.set(step);
            }
            length.set(length.get() + step);
            Some(there)
        });
        let [length, first_step] = [length, first_step].map(Cell::into_inner);
        Approach { last, length, first_step, rest, is_lost: is_lost.into_inner() }
    }

    /// The orbit at the parameter's value a step along the curve, by Newton's method there.
    ///
    /// The corrector does not close where a multiplier comes to 1 and the orbit's change with the
    /// parameter vanishes with it.
    fn at_value(&self, base: &CurvePoint, step: f64) -> Option<CurvePoint> {
        let value = base.value + step * base.tangent.rate;
        let shots = self.shifted(base, &base.tangent, step)?;
        let shots = self.family.at(value, |map| Some(polish(map, shots)))?;
        let is_forward = self.distance_along(base, value, &shots)? > 0.0;
        if !shots.is_closed() || !is_forward || !self.is_near(value, &shots, base, step) {
            return None;
        }
        // The direction there is known no better than that of the point before.
        let point = self.point(value, shots, &base.tangent)?;
        Some(CurvePoint { tangent: base.tangent.clone(), ..point })
    }

    /// The curve a step beyond the corner at `before`. Its direction there is that of the other
    /// piece's derivative; of the two ways along it one leads to an orbit of that piece.
    fn point_beyond(&self, before: &CurvePoint, step: f64) -> Option<CurvePoint> {
        let value = before.value + step * before.tangent.rate;
        let mut bases = Vec::new();
        for probe in self.probes(before, step) {
            let slopes = self.family.slopes(value, &probe);
            let tangent = self.tangent(&probe, &slopes, &before.tangent);
            let base =
                self.on_piece_of(&probe, CurvePoint { slopes, tangent, ..before.clone() }, step);
            bases.extend([self.refined(base.turned(), step), self.refined(base, step)]);
        }
        // The way forward first, of each probe.
        bases.into_iter().rev().find_map(|base| {
            let point =
                self.corrected_freely(&base, step).filter(|it| !it.is_on_piece_of(before))?;
            if !self.is_near(point.value, &point.shots, before, step) {
                return None;
            }
            let mut point = self.point(point.value, point.shots, &point.tangent)?;
            // Away from the corner, whichever way the bordering row has turned it.
            if self.product(&point.tangent, &base.tangent, &before.shots) < 0.0 {
                point.tangent = point.tangent.turned();
            }
            Some(point)
        })
    }

    /// A base on the corner with the direction that the other piece has next to it. A derivative is
    /// large where a guard is nearly touched, and so is the error of a direction that was taken
    /// further away: its square root is the error of the next.
    fn refined(&self, mut base: CurvePoint, step: f64) -> CurvePoint {
        for _ in 0..REFINEMENTS {
            let Some(shots) = self.shifted(&base, &base.tangent, step) else { break };
            if are_on_one_piece(&shots, &base.shots) {
                break;
            }
            let value = base.value + step * base.tangent.rate;
            base.slopes = self.family.slopes(value, &shots);
            let tangent = self.tangent(&shots, &base.slopes, &base.tangent);
            let is_back = self.product(&tangent, &base.tangent, &base.shots) < 0.0;
            base.tangent = if is_back { tangent.turned() } else { tangent };
        }
        base
    }

    /// A base whose points lie on the pieces of shots that a step along its direction leads to: a
    /// point that has another mode there begins where these do.
    fn on_piece_of(&self, probe: &OrbitShots, mut base: CurvePoint, step: f64) -> CurvePoint {
        let value = base.value + step * base.tangent.rate;
        let points = self.family.at(value, |map| {
            let pairs = probe.points.iter().zip(&base.shots.points).zip(&base.tangent.points);
            let own = pairs.zip(&base.carried).map(|(((probe, from), change), own)| {
                let back = map.moved(probe, &change.map(|it| -step * it), probe);
                if probe.mode == from.mode { own.clone() } else { map.carry(&back) }
            });
            Some(own.collect())
        });
        base.carried = points.unwrap_or(base.carried);
        base
    }

    /// The points of the motion at a value that begins aside of an orbit's first point, after so
    /// many times once around: a motion takes each event where it comes, on whichever side of a
    /// section.
    fn settle_motion(
        &self,
        from: &CurvePoint,
        value: f64,
        aside: f64,
        turns: u32,
    ) -> Option<OrbitShots> {
        let period = u32::try_from(from.carried.len()).ok()?;
        self.family.at(value, |map| {
            let first = map.take_up(&from.carried[0]);
            let change = from.tangent.points[0].map(|it| aside * it);
            let mut place = map.moved(&first, &change, &first);
            for _ in 0..turns {
                let along = Shots::follow(map, &place, period).ok()?;
                place = map.rebased(&along.images.last()?.point);
            }
            Shots::follow(map, &place, period).ok()
        })
    }

    /// Shots a step along the old direction that lie on another piece: as they are, with each point
    /// replaced by the image of the one before, and those of motions that have gone on.
    pub fn probes(&self, from: &CurvePoint, step: f64) -> Vec<OrbitShots> {
        let value = from.value + step * from.tangent.rate;
        let probe = self.shifted(from, &from.tangent, step);
        let second = probe.as_ref().and_then(|probe| {
            let mut images: Vec<_> = probe.images.iter().map(|it| it.point.clone()).collect();
            images.rotate_right(1);
            self.family.at(value, |map| {
                let images = images.iter().map(|it| map.rebased(it)).collect();
                Shots::new(map, images)
            })
        });
        let starts =
            SIDE_STEPS.iter().flat_map(|aside| SETTLING_TURNS.map(|turns| (aside * step, turns)));
        let motions = starts.map(|(aside, turns)| self.settle_motion(from, value, aside, turns));
        let all = [probe, second].into_iter().chain(motions).flatten();
        let others = all.filter(|it| !are_on_one_piece(it, &from.shots));
        others.filter(|it| self.is_near(value, it, from, step)).collect()
    }

    /// Whether shots lie as near to an orbit as a step may lead.
    pub(super) fn is_near(
        &self,
        value: f64,
        shots: &OrbitShots,
        from: &CurvePoint,
        step: f64,
    ) -> bool {
        let distance = self.distance(value, shots, from);
        distance.is_some_and(|it| it <= MAX_ROOT_MULTIPLE * libm::sqrt(step))
    }

    /// The largest distance between points of shots and those of an orbit, relative to their sizes.
    pub(super) fn distance(
        &self,
        value: f64,
        shots: &OrbitShots,
        from: &CurvePoint,
    ) -> Option<f64> {
        self.family.at(value, |map| {
            let pairs = shots.points.iter().zip(&from.carried);
            let sizes =
                pairs.map(|(it, own)| map.size(it, &map.change_between(&map.take_up(own), it)));
            Some(sizes.fold(0.0, f64::max))
        })
    }
}

/// The distance in the parameter from the last orbit of a piece to where a multiplier would be 1;
/// infinite where none comes nearer to that.
fn distance_to_unit_multiplier(base: &CurvePoint, last: &CurvePoint) -> f64 {
    let nearest = |it: &CurvePoint| {
        let apart = it.orbit.multipliers.iter().map(|[re, im]| libm::hypot(re - 1.0, *im));
        apart.fold(f64::INFINITY, f64::min)
    };
    let (from, to) = (nearest(base), nearest(last));
    let comes_nearer = to < from && from.is_finite();
    if comes_nearer { (last.value - base.value).abs() * to / (from - to) } else { f64::INFINITY }
}
