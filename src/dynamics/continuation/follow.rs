//! Step control: follows a branch and notes the bifurcations between its points.

use super::corner::Corner;
use super::locate::Located;
use super::point::{ContinuationPoint, FamilyCurve};
use super::{Bifurcation, BifurcationKind, Branch, BranchEnding, BranchPoint};
use crate::dynamics::orbit::{ShootingIterate, polished};

const FIRST: f64 = 1e-3;
const LONGEST: f64 = 0.03;
/// A step this short that fails is held to be at a corner.
const SHORTEST: f64 = 1e-6;
/// Steps of a branch before it is given up.
const STEPS: usize = 20_000;
/// Cosine of the largest turn of the tangent in a step.
const TURN: f64 = 0.95;
/// The largest relative change of the multipliers' sum and products in a step.
const CHANGE: f64 = 0.3;

/// A branch that is being followed, as far as it is computed.
pub(super) struct BranchFollower<'a> {
    curve: FamilyCurve,
    /// The value at which the parameter begins.
    from: f64,
    /// The parameter value to which the branch is to go.
    to: f64,
    told: &'a mut dyn FnMut(f64),
    points: Vec<BranchPoint>,
    bifurcations: Vec<Bifurcation>,
}

impl<'a> BranchFollower<'a> {
    pub(super) fn new(
        curve: FamilyCurve,
        from: f64,
        to: f64,
        told: &'a mut dyn FnMut(f64),
    ) -> Self {
        Self { curve, from, to, told, points: Vec::new(), bifurcations: Vec::new() }
    }

    /// Follows the curve from a point until it leaves the interval or is lost.
    pub(super) fn branch(mut self, first: ContinuationPoint) -> Branch {
        let ending = self.follow(first);
        Branch { points: self.points, bifurcations: self.bifurcations, ending }
    }

    fn follow(&mut self, first: ContinuationPoint) -> BranchEnding {
        let start = first.clone();
        let mut point = first;
        self.keep(&point);
        if self.from == self.to {
            return BranchEnding::Reached;
        }
        let mut step = FIRST;
        for count in 0..STEPS {
            let (next, reached) = match self.step(&point, &mut step) {
                Ok(next) => next,
                Err(ending) => return ending,
            };
            (self.told)(((next.value - self.from) / (self.to - self.from)).clamp(0.0, 1.0));
            self.keep(&next);
            if let Some(ending) = reached {
                return ending;
            }
            if count > 2 && self.is_back(&point, &next, &start) {
                return BranchEnding::Closed;
            }
            point = next;
        }
        BranchEnding::Long { value: point.value }
    }

    /// The next point, what lies between being noted, and whether the branch ends there.
    fn step(
        &mut self,
        point: &ContinuationPoint,
        step: &mut f64,
    ) -> Result<(ContinuationPoint, Option<BranchEnding>), BranchEnding> {
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
                    return Ok((next, ending));
                }
            }
            if other_piece || distance <= SHORTEST {
                let corner = self.curve.corner(point, distance);
                if let Some(corner) = corner {
                    return self.turn(point, corner, step);
                }
                if distance <= SHORTEST {
                    return Err(BranchEnding::Lost { value: point.value });
                }
            }
            *step = 0.5 * distance;
        }
    }

    /// Passes a corner.
    fn turn(
        &mut self,
        point: &ContinuationPoint,
        corner: Corner,
        step: &mut f64,
    ) -> Result<(ContinuationPoint, Option<BranchEnding>), BranchEnding> {
        let Corner { before, beyond, error } = corner;
        if !self.is_inside(before.value) {
            let (end, _, ending) = self.cut(point, before, 0.0);
            return Ok((end, ending));
        }
        if before.phase_sequence() != beyond.phase_sequence() {
            self.bifurcations.push(Bifurcation {
                kind: BifurcationKind::Grazing,
                value: before.value,
                error,
                turns: before.tangent.rate * beyond.tangent.rate < 0.0,
                orbit: before.orbit.clone(),
                beyond: Some(beyond.orbit.clone()),
            });
        }
        self.keep(&before);
        *step = SHORTEST * 2.0;
        let ending = (!self.is_inside(beyond.value)).then_some(self.left(beyond.value));
        Ok((beyond, ending))
    }

    fn is_smooth(
        &self,
        point: &ContinuationPoint,
        next: &ContinuationPoint,
        distance: f64,
    ) -> bool {
        next.is_on_piece_of(point)
            && self.curve.product(&point.tangent, &next.tangent, &point.iterate) >= TURN
            && (next.change_of_multipliers(point) <= CHANGE || distance <= SHORTEST)
    }

    /// A step that leaves the interval is cut at its end.
    fn cut(
        &self,
        point: &ContinuationPoint,
        next: ContinuationPoint,
        distance: f64,
    ) -> (ContinuationPoint, f64, Option<BranchEnding>) {
        if self.is_inside(next.value) {
            return (next, distance, None);
        }
        let ending = self.left(next.value);
        let bound = if ending == BranchEnding::Reached { self.to } else { self.from };
        let share = (bound - point.value) / (next.value - point.value);
        let cut = self.at(point, &next, bound, share);
        (cut.unwrap_or(next), distance * share, Some(ending))
    }

    /// The orbit at a value of the parameter, between two points.
    fn at(
        &self,
        point: &ContinuationPoint,
        next: &ContinuationPoint,
        value: f64,
        share: f64,
    ) -> Option<ContinuationPoint> {
        let pairs = point.iterate.points.iter().zip(&next.iterate.points);
        let between: Vec<_> =
            pairs.map(|(a, b)| std::array::from_fn(|i| a[i] + share * (b[i] - a[i]))).collect();
        let map = self.curve.family.map(value).ok()?;
        let iterate = polished(&map, ShootingIterate::of(&map, &between)?);
        iterate.is_closed().then(|| self.curve.point(value, iterate, &next.tangent))
    }

    fn is_inside(&self, value: f64) -> bool {
        let share = (value - self.from) / (self.to - self.from);
        (0.0..=1.0).contains(&share)
    }

    fn left(&self, value: f64) -> BranchEnding {
        let share = (value - self.from) / (self.to - self.from);
        if share > 0.5 { BranchEnding::Reached } else { BranchEnding::Left }
    }

    /// Whether the step passes where the branch began, in the same direction.
    fn is_back(
        &self,
        point: &ContinuationPoint,
        next: &ContinuationPoint,
        start: &ContinuationPoint,
    ) -> bool {
        let span = (next.value - point.value).abs().max(1e-12 * self.curve.unit);
        let near = |it: &ContinuationPoint| it.iterate.distance(&start.iterate);
        let length = point.iterate.distance(&next.iterate);
        (point.value - start.value).abs() <= 2.0 * span
            && near(point).min(near(next)) <= length
            && self.curve.product(&next.tangent, &start.tangent, &start.iterate) > 0.0
    }

    fn keep(&mut self, point: &ContinuationPoint) {
        self.points.push(BranchPoint { value: point.value, orbit: point.orbit.clone() });
    }

    /// Bifurcations between two points of one piece.
    fn note_between(&mut self, point: &ContinuationPoint, next: &ContinuationPoint, distance: f64) {
        let mut found: Vec<(BifurcationKind, Located)> = Vec::new();
        let mut seek = |kind: BifurcationKind, test: &dyn Fn(&ContinuationPoint) -> f64| {
            if test(point) * test(next) < 0.0 {
                found.extend(self.curve.located(point, distance, test).map(|it| (kind, it)));
            }
        };
        seek(BifurcationKind::Fold, &|it| it.tangent.rate);
        seek(BifurcationKind::Flip, &ContinuationPoint::flip);
        if point.torus().is_some() && next.torus().is_some() {
            seek(BifurcationKind::NeimarkSacker, &|it| it.torus().unwrap_or(f64::NAN));
        }
        found.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        for (kind, located) in found {
            let error = self.curve.error(&located);
            let Located { point: ContinuationPoint { value, orbit, .. }, .. } = located;
            let turns = kind == BifurcationKind::Fold;
            self.bifurcations.push(Bifurcation { kind, value, error, turns, orbit, beyond: None });
        }
    }
}
