//! Step control: follows a branch and notes the bifurcations between its points.

use super::super::returns::newton::polished;
use super::super::returns::shooting::{ReturnMap, Shots};
use super::corner::Corner;
use super::curve::Curve;
use super::locate::Located;
use super::point::CurvePoint;
use super::words::{Meaning, cyclic};
use super::{ReturnBifurcation, ReturnBifurcationKind, ReturnBranch};
use crate::dynamics::continuation::BranchEnding;

const FIRST: f64 = 1e-3;
const LONGEST: f64 = 0.03;
/// A step this short that fails is held to be at a corner.
const SHORTEST: f64 = 1e-6;
/// Steps of a branch before it is given up.
const STEPS: usize = 20_000;
/// Cosine of the largest turn of the tangent in a step.
const TURN: f64 = 0.95;
/// The largest relative change of the multipliers' sums of powers in a step.
const CHANGE: f64 = 0.3;

/// A branch that is being followed, as far as it is computed.
pub(super) struct Follower<'a> {
    curve: Curve<'a>,
    /// The values at which the parameter begins and ends.
    ends: [f64; 2],
    told: &'a mut dyn FnMut(f64),
    points: Vec<(f64, super::Orbit)>,
    bifurcations: Vec<ReturnBifurcation>,
}

/// The next point, and whether the branch ends there.
type Step = Result<(CurvePoint, Option<BranchEnding>), BranchEnding>;

impl<'a> Follower<'a> {
    pub fn new(curve: Curve<'a>, ends: [f64; 2], told: &'a mut dyn FnMut(f64)) -> Self {
        Self { curve, ends, told, points: Vec::new(), bifurcations: Vec::new() }
    }

    /// Follows the curve from a point until it leaves the interval or is lost.
    pub fn branch(mut self, first: CurvePoint) -> ReturnBranch {
        let ending = self.follow(first);
        ReturnBranch { points: self.points, bifurcations: self.bifurcations, ending }
    }

    fn follow(&mut self, first: CurvePoint) -> BranchEnding {
        let start = first.clone();
        let mut point = first;
        self.keep(&point);
        let [from, to] = self.ends;
        if from == to {
            return BranchEnding::Reached;
        }
        let mut step = FIRST;
        for count in 0..STEPS {
            let (next, ending) = match self.step(&point, &mut step) {
                Ok(next) => next,
                Err(ending) => return ending,
            };
            (self.told)(((next.value - from) / (to - from)).clamp(0.0, 1.0));
            self.keep(&next);
            if let Some(ending) = ending {
                return ending;
            }
            if count > 2 && self.is_back(&point, &next, &start) {
                return BranchEnding::Closed;
            }
            point = next;
        }
        BranchEnding::Long { value: point.value }
    }

    /// The next point, what lies between being noted.
    fn step(&mut self, point: &CurvePoint, step: &mut f64) -> Step {
        loop {
            let distance = *step;
            let attempt = self.curve.corrected(point, distance);
            let other_piece = attempt.as_ref().is_some_and(|it| !it.is_on_piece_of(point));
            let smooth = attempt.filter(|it| self.is_smooth(point, it, distance));
            if let Some(next) = smooth {
                let (next, distance, ending) = self.cut(point, next, distance);
                if next.is_on_piece_of(point) {
                    if let Some(flip) = self.curve.halving(point, &next) {
                        let ending = BranchEnding::Halved { value: flip.value };
                        self.bifurcations.push(flip);
                        return Err(ending);
                    }
                    self.note_between(point, &next, distance);
                    *step = (1.5 * distance).min(LONGEST);
                    let CurvePoint { value, shots, tangent, .. } = next.clone();
                    let next = self.curve.point(value, shots, &tangent).unwrap_or(next);
                    return Ok((next, ending));
                }
            }
            if other_piece || distance <= SHORTEST {
                let corner = self.curve.corner(point, distance);
                if corner.beyond.is_some() || distance <= SHORTEST {
                    return self.turn(point, corner, step);
                }
            }
            *step = 0.5 * distance;
        }
    }

    /// Passes a corner, or ends there.
    fn turn(&mut self, point: &CurvePoint, corner: Corner, step: &mut f64) -> Step {
        let Corner { before, beyond, error } = corner;
        if !self.is_inside(before.value) {
            let (end, _, ending) = self.cut(point, before, 0.0);
            return Ok((end, ending));
        }
        let turns = beyond.as_ref().is_none_or(|it| it.tangent.rate * before.tangent.rate < 0.0);
        let is_another = |it: &CurvePoint| cyclic(&it.orbit.events) != cyclic(&before.orbit.events);
        let meaning = match beyond.as_ref().is_none_or(is_another) {
            true => self.curve.meaning(&before, beyond.as_ref()),
            false => None,
        };
        if let Some(Meaning { kind, event }) = meaning {
            let (value, orbit) = (before.value, before.orbit.clone());
            let event = Some(event);
            self.bifurcations.push(ReturnBifurcation { kind, value, error, event, turns, orbit });
        }
        self.keep(&before);
        let Some(beyond) = beyond else { return Err(BranchEnding::Lost { value: before.value }) };
        *step = SHORTEST * 2.0;
        let ending = (!self.is_inside(beyond.value)).then_some(self.left(beyond.value));
        Ok((beyond, ending))
    }

    fn is_smooth(&self, point: &CurvePoint, next: &CurvePoint, distance: f64) -> bool {
        next.is_on_piece_of(point)
            && self.curve.product(&point.tangent, &next.tangent, &point.shots) >= TURN
            && (next.change_of_multipliers(point) <= CHANGE || distance <= SHORTEST)
    }

    /// A step that leaves the interval is cut at its end.
    fn cut(
        &self,
        point: &CurvePoint,
        next: CurvePoint,
        distance: f64,
    ) -> (CurvePoint, f64, Option<BranchEnding>) {
        if self.is_inside(next.value) {
            return (next, distance, None);
        }
        let ending = self.left(next.value);
        let [from, to] = self.ends;
        let bound = if ending == BranchEnding::Reached { to } else { from };
        let share = (bound - point.value) / (next.value - point.value);
        let cut = self.at(point, &next, bound, share);
        (cut.unwrap_or(next), distance * share, Some(ending))
    }

    /// The orbit at a value of the parameter, between two points.
    fn at(
        &self,
        point: &CurvePoint,
        next: &CurvePoint,
        value: f64,
        share: f64,
    ) -> Option<CurvePoint> {
        let shots = self.curve.family.at(value, |map| {
            let pairs = point.carried.iter().zip(&next.carried);
            let between = pairs.map(|(a, b)| {
                let [a, b] = [a, b].map(|it| map.taken_up(it));
                map.moved(&a, &map.apart(&a, &b).map(|it| share * it), &a)
            });
            let shots = polished(map, Shots::of(map, between.collect())?);
            shots.is_closed().then_some(shots)
        })?;
        self.curve.point(value, shots, &next.tangent)
    }

    fn is_inside(&self, value: f64) -> bool {
        (0.0..=1.0).contains(&self.share(value))
    }

    fn left(&self, value: f64) -> BranchEnding {
        if self.share(value) > 0.5 { BranchEnding::Reached } else { BranchEnding::Left }
    }

    fn share(&self, value: f64) -> f64 {
        let [from, to] = self.ends;
        (value - from) / (to - from)
    }

    /// Whether the step passes where the branch began, in the same direction.
    fn is_back(&self, point: &CurvePoint, next: &CurvePoint, start: &CurvePoint) -> bool {
        if (start.value - point.value) * (start.value - next.value) > 0.0 {
            return false;
        }
        let distance = |a: &CurvePoint, b: &CurvePoint| {
            let distance = self.curve.family.at(a.value, |map| {
                let other: Vec<_> = b.carried.iter().map(|it| map.taken_up(it)).collect();
                Some(a.shots.distance(map, &other))
            });
            distance.unwrap_or(f64::INFINITY)
        };
        distance(point, start).min(distance(next, start)) <= distance(point, next)
            && self.curve.product(&next.tangent, &start.tangent, &start.shots) > 0.0
    }

    fn keep(&mut self, point: &CurvePoint) {
        self.points.push((point.value, point.orbit.clone()));
    }

    /// Bifurcations between two points of one piece.
    fn note_between(&mut self, point: &CurvePoint, next: &CurvePoint, distance: f64) {
        let mut found: Vec<(ReturnBifurcationKind, Located)> = Vec::new();
        let mut seek = |kind, test: &dyn Fn(&CurvePoint) -> f64| {
            if test(point) * test(next) < 0.0 {
                found.extend(self.curve.located(point, distance, test).map(|it| (kind, it)));
            }
        };
        seek(ReturnBifurcationKind::Fold, &|it| it.tangent.rate);
        seek(ReturnBifurcationKind::Flip, &CurvePoint::flip);
        if point.torus().1 == next.torus().1 {
            seek(ReturnBifurcationKind::NeimarkSacker, &|it| it.torus().0);
        }
        found.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        for (kind, located) in found {
            let error = self.curve.error(&located);
            let Located { point: CurvePoint { value, orbit, .. }, .. } = located;
            let turns = kind == ReturnBifurcationKind::Fold;
            let event = None;
            self.bifurcations.push(ReturnBifurcation { kind, value, error, event, turns, orbit });
        }
    }
}
