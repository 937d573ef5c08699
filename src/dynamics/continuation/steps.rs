//! Step control: follows a curve of orbits and notes the bifurcations between its points, whatever
//! map the orbits are of.

use super::locate::{LocatedPoint, zero_along};
use super::{BifurcationKind, BranchEnding};
use crate::dynamics::linear::{ReIm, modulus};

/// The first step along a branch, in units of arc length.
const FIRST_STEP: f64 = 1e-3;
/// The longest step along a branch, in units of arc length.
const MAX_STEP: f64 = 0.03;
/// A step this short that fails is held to be at a corner.
const MIN_STEP: f64 = 1e-6;
/// A step that fails by the turn of the tangent alone is held to be at a corner if it is as short:
/// a fold next to a touch may be as sharp.
const MIN_STEP_OF_TURN: f64 = 1e-9;
/// Steps of a branch before it is given up.
const MAX_STEPS: usize = 20_000;
/// Cosine of the largest turn of the tangent in a step.
const MIN_TURN_COSINE: f64 = 0.95;
/// The largest relative change of what the multipliers are measured by in a step.
const MAX_MULTIPLIER_CHANGE: f64 = 0.3;
/// Distances about the end of a doubled branch in which the flip of the half is looked for.
const FLIP_DISTANCES: [f64; 8] = [1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2];

/// An orbit on a curve, and the curve's direction there.
pub(crate) trait OrbitPoint: Clone {
    /// The parameter's value.
    fn value(&self) -> f64;

    /// The rate of the parameter with the arc length.
    fn rate(&self) -> f64;

    fn multipliers(&self) -> &[ReIm];

    /// Whether both orbits lie on one smooth piece of the map.
    fn is_on_piece_of(&self, other: &Self) -> bool;

    /// The relative change of the multipliers from another point.
    fn change_of_multipliers(&self, other: &Self) -> f64;

    /// The product of all 1 + mu: zero at a flip.
    fn flip_test(&self) -> f64 {
        // The imaginary part of a pair's product vanishes.
        let [re, _] = self.multipliers().iter().fold([1.0, 0.0], |[re, im], [a, b]| {
            [re * (1.0 + a) - im * b, re * b + im * (1.0 + a)]
        });
        re
    }

    /// The product over all pairs of the product of two multipliers less one: zero where two are
    /// conjugate on the unit circle, and where two real ones are reciprocal.
    fn pair_test(&self) -> f64 {
        // The imaginary parts of conjugate factors vanish.
        let all = self.multipliers();
        let pairs = all.iter().enumerate().flat_map(|(n, a)| all[..n].iter().map(move |b| (a, b)));
        let [re, _] = pairs.fold([1.0, 0.0], |[re, im], (a, b)| {
            let [x, y] = [a[0] * b[0] - a[1] * b[1] - 1.0, a[0] * b[1] + a[1] * b[0]];
            [re * x - im * y, re * y + im * x]
        });
        re
    }

    /// Whether a complex pair is nearer to the unit circle than two real multipliers are to being
    /// reciprocal.
    fn has_pair_on_circle(&self) -> bool {
        let least = |it: &mut dyn Iterator<Item = f64>| it.fold(f64::INFINITY, f64::min);
        let squares = self.multipliers().iter().filter(|it| it[1] > 0.0);
        let complex = least(&mut squares.map(|it| (modulus(*it).powi(2) - 1.0).abs()));
        let real: Vec<f64> =
            self.multipliers().iter().filter(|it| it[1] == 0.0).map(|it| it[0]).collect();
        let pairs = (0..real.len()).flat_map(|n| (0..n).map(move |k| (n, k)));
        complex < least(&mut pairs.map(|(n, k)| (real[n] * real[k] - 1.0).abs()))
    }

    /// The product over complex pairs of their modulus less one, zero at a Neimark-Sacker point,
    /// and the number of pairs.
    fn neimark_sacker_test(&self) -> (f64, usize) {
        let pairs = self.multipliers().iter().filter(|it| it[1] > 0.0);
        pairs.fold((1.0, 0), |(all, count), it| (all * (modulus(*it) - 1.0), count + 1))
    }
}

/// A corner of a curve, where it leaves a smooth piece.
pub(crate) struct Corner<P> {
    /// The last orbit of the piece that is left.
    pub(crate) before: P,
    /// The first orbit of the piece beyond, if one was found.
    pub(crate) beyond: Option<P>,
    /// Bound on the error of the parameter's value at the corner.
    pub(crate) error: f64,
    /// Whether the section alone makes the corner: an event of the same orbits passes it there.
    #[cfg_attr(
        not(feature = "affine"),
        expect(dead_code, reason = "the oscillator's sections are strobes")
    )]
    pub(crate) is_of_section: bool,
}

impl<P: OrbitPoint> Corner<P> {
    /// Whether the curve turns back in the parameter, or ends.
    pub(crate) fn turns(&self) -> bool {
        let turns = |beyond: &P| self.before.rate() * beyond.rate() < 0.0;
        self.beyond.as_ref().is_none_or(turns)
    }
}

/// A point at which a curve has a bifurcation.
pub(crate) struct Noted<P> {
    pub(crate) kind: BifurcationKind,
    pub(crate) point: P,
    /// Bound on the error of the parameter's value.
    pub(crate) error: f64,
    /// Whether the branch turns back there.
    pub(crate) turns: bool,
}

/// Whether the way to the last orbit of a piece is known, so that the corner there may be passed.
pub(crate) type Accepts<'a, P> = &'a dyn Fn(&P) -> bool;

/// A curve of orbits in (points, parameter), parametrised by its arc length.
pub(crate) trait OrbitCurve {
    type Point: OrbitPoint;
    type Bifurcation;
    /// An orbit as a branch keeps it.
    type Kept;

    /// The orbit at a distance along the tangent of `base`.
    fn corrected_point(&self, base: &Self::Point, distance: f64) -> Option<Self::Point>;

    /// The cosine between the directions of two points, measured at the first.
    fn cosine(&self, point: &Self::Point, next: &Self::Point) -> f64;

    /// The orbit at a value that lies a share of the way from one point to the next.
    fn between(&self, ends: [&Self::Point; 2], value: f64, share: f64) -> Option<Self::Point>;

    /// The part of an error of the parameter's value that rounding of the map leaves.
    fn uncertainty(&self, point: &Self::Point) -> f64;

    /// An orbit of half the period midway between the halves of a point's, where these change
    /// places from one point to the next: the curve has run into a flip.
    fn half(&self, point: &Self::Point, next: &Self::Point) -> Option<Self::Point>;

    /// The corner between a point and a distance along its tangent at which the piece is another
    /// one or no orbit is found. None sends the follower to a shorter step: where a step may be
    /// shorter, `accepts` says of the last orbit of the piece whether the way to it is known.
    fn corner(
        &self,
        base: &Self::Point,
        distance: f64,
        accepts: Option<Accepts<'_, Self::Point>>,
    ) -> Option<Corner<Self::Point>>;

    /// The distance along the tangent of `base` at which another point lies.
    fn distance_along(&self, base: &Self::Point, other: &Self::Point) -> f64;

    /// The bifurcation that a corner is, if it is one; the curve comes to it from `base`.
    fn of_corner(
        &self,
        base: &Self::Point,
        corner: &Corner<Self::Point>,
    ) -> Option<Self::Bifurcation>;

    fn bifurcation(&self, noted: Noted<Self::Point>) -> Self::Bifurcation;

    fn kept_point(&self, point: &Self::Point) -> Self::Kept;

    /// Whether a step passes where the branch began, in the same direction.
    fn is_back(&self, step: [&Self::Point; 2], start: &Self::Point) -> bool;

    /// The zero of `test` on the curve between `base` and a distance along its tangent.
    fn located(
        &self,
        base: &Self::Point,
        distance: f64,
        test: &dyn Fn(&Self::Point) -> f64,
    ) -> Option<LocatedPoint<Self::Point>> {
        zero_along(base, distance, &|at| self.corrected_point(base, at), test)
    }

    /// Bound on the error of the parameter's value at a located point.
    fn error(&self, located: &LocatedPoint<Self::Point>) -> f64 {
        located.bracket * located.point.rate().abs() + self.uncertainty(&located.point)
    }

    /// The flip of an orbit of half the period that the curve runs into between two points. It goes
    /// on beyond: as the same orbits, half a period later.
    fn halving(&self, point: &Self::Point, next: &Self::Point) -> Option<Noted<Self::Point>> {
        let single = self.half(point, next)?;
        let located = FLIP_DISTANCES.iter().find_map(|distance| {
            let start = self.corrected_point(&single, -distance)?;
            self.located(&start, 2.0 * distance, &OrbitPoint::flip_test)
        })?;
        let error = self.error(&located);
        Some(Noted { kind: BifurcationKind::Flip, point: located.point, error, turns: true })
    }
}

/// A branch as far as it is computed.
pub(crate) struct FollowedCurve<C: OrbitCurve> {
    pub(crate) points: Vec<C::Kept>,
    pub(crate) bifurcations: Vec<C::Bifurcation>,
    /// The number of points that come before each bifurcation.
    pub(crate) before: Vec<usize>,
    pub(crate) ending: BranchEnding,
}

/// Follows a curve from a point until it leaves the interval between two values of the parameter,
/// or is lost. `progress` is told where the parameter is in the interval, 0 to 1.
pub(crate) fn follow<C: OrbitCurve>(
    curve: &C,
    ends: [f64; 2],
    first: C::Point,
    progress: &mut dyn FnMut(f64),
) -> FollowedCurve<C> {
    let (points, bifurcations, before) = (Vec::new(), Vec::new(), Vec::new());
    let mut follower = Follower { curve, ends, points, bifurcations, before };
    let ending = follower.follow(first, progress);
    let Follower { points, bifurcations, before, .. } = follower;
    FollowedCurve { points, bifurcations, before, ending }
}

struct Follower<'a, C: OrbitCurve> {
    curve: &'a C,
    /// The values at which the parameter begins and ends.
    ends: [f64; 2],
    points: Vec<C::Kept>,
    bifurcations: Vec<C::Bifurcation>,
    before: Vec<usize>,
}

/// The next point, and whether the branch ends there.
type Step<P> = Result<(P, Option<BranchEnding>), BranchEnding>;

impl<C: OrbitCurve> Follower<'_, C> {
    fn follow(&mut self, first: C::Point, progress: &mut dyn FnMut(f64)) -> BranchEnding {
        let start = first.clone();
        let mut point = first;
        self.keep(&point);
        let [from, to] = self.ends;
        if from == to {
            return BranchEnding::Reached;
        }
        let mut step = FIRST_STEP;
        for count in 0..MAX_STEPS {
            let (next, ending) = match self.step(&point, &mut step) {
                Ok(next) => next,
                Err(ending) => return ending,
            };
            progress(self.share(next.value()).clamp(0.0, 1.0));
            self.keep(&next);
            if let Some(ending) = ending {
                return ending;
            }
            if count > 2 && self.curve.is_back([&point, &next], &start) {
                return BranchEnding::Closed;
            }
            point = next;
        }
        BranchEnding::Long { value: point.value() }
    }

    /// The next point, what lies between being noted, and whether the branch ends there.
    fn step(&mut self, point: &C::Point, step: &mut f64) -> Step<C::Point> {
        loop {
            let distance = *step;
            let attempt = self.curve.corrected_point(point, distance);
            let other_piece = attempt.as_ref().is_some_and(|it| !it.is_on_piece_of(point));
            let is_on_piece = attempt.is_some() && !other_piece;
            let smooth = attempt.filter(|it| self.is_smooth(point, it, distance));
            if let Some(next) = smooth {
                let (next, distance, ending) = self.cut(point, next, distance);
                if next.is_on_piece_of(point) {
                    if let Some(flip) = self.curve.halving(point, &next) {
                        let ending = BranchEnding::Halved { value: flip.point.value() };
                        self.add(self.curve.bifurcation(flip));
                        return Err(ending);
                    }
                    self.note_between(point, &next, distance);
                    *step = (1.5 * distance).min(MAX_STEP);
                    return Ok((next, ending));
                }
            }
            let last = distance <= if is_on_piece { MIN_STEP_OF_TURN } else { MIN_STEP };
            if other_piece || last {
                let accepts = |end: &C::Point| self.is_plain(point, end);
                let accepts: Option<Accepts<'_, C::Point>> =
                    if last { None } else { Some(&accepts) };
                if let Some(corner) = self.curve.corner(point, distance, accepts) {
                    return self.turn(point, corner, step);
                }
                if last {
                    return Err(BranchEnding::Lost { value: point.value() });
                }
            }
            *step = 0.5 * distance;
        }
    }

    /// Passes a corner, or ends there.
    fn turn(
        &mut self,
        point: &C::Point,
        corner: Corner<C::Point>,
        step: &mut f64,
    ) -> Step<C::Point> {
        if !self.is_inside(corner.before.value()) {
            let (end, _, ending) = self.cut(point, corner.before, 0.0);
            return Ok((end, ending));
        }
        self.note_between(point, &corner.before, self.curve.distance_along(point, &corner.before));
        if let Some(found) = self.curve.of_corner(point, &corner) {
            self.add(found);
        }
        self.keep(&corner.before);
        let Some(beyond) = corner.beyond else {
            return Err(BranchEnding::Lost { value: corner.before.value() });
        };
        *step = MIN_STEP * 2.0;
        let (beyond, _, ending) = self.cut(&corner.before, beyond, 0.0);
        Ok((beyond, ending))
    }

    fn is_smooth(&self, point: &C::Point, next: &C::Point, distance: f64) -> bool {
        next.is_on_piece_of(point)
            && self.curve.cosine(point, next) >= MIN_TURN_COSINE
            && (next.change_of_multipliers(point) <= MAX_MULTIPLIER_CHANGE || distance <= MIN_STEP)
    }

    /// Whether the way from a point to the end of its piece has no bifurcation: multipliers may
    /// grow without bound there, but a curve that turns, or a test that changes its sign, is
    /// followed by shorter steps.
    fn is_plain(&self, point: &C::Point, end: &C::Point) -> bool {
        let (from, to) = (point.neimark_sacker_test(), end.neimark_sacker_test());
        let keeps_sign = |test: &dyn Fn(&C::Point) -> f64| test(point) * test(end) > 0.0;
        self.curve.cosine(point, end) >= MIN_TURN_COSINE
            && keeps_sign(&OrbitPoint::rate)
            && keeps_sign(&OrbitPoint::flip_test)
            && (from.1 != to.1 || from.0 * to.0 > 0.0)
    }

    /// A step that leaves the interval is cut at its end.
    fn cut(
        &self,
        point: &C::Point,
        next: C::Point,
        distance: f64,
    ) -> (C::Point, f64, Option<BranchEnding>) {
        if self.is_inside(next.value()) {
            return (next, distance, None);
        }
        let ending = self.left(next.value());
        let [from, to] = self.ends;
        let bound = if ending == BranchEnding::Reached { to } else { from };
        let share = (bound - point.value()) / (next.value() - point.value());
        let cut = self.curve.between([point, &next], bound, share);
        (cut.unwrap_or(next), distance * share, Some(ending))
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

    fn keep(&mut self, point: &C::Point) {
        self.points.push(self.curve.kept_point(point));
    }

    fn add(&mut self, found: C::Bifurcation) {
        self.bifurcations.push(found);
        self.before.push(self.points.len());
    }

    /// Bifurcations between two points of one piece.
    fn note_between(&mut self, point: &C::Point, next: &C::Point, distance: f64) {
        let mut found: Vec<(BifurcationKind, LocatedPoint<C::Point>)> = Vec::new();
        let mut seek = |kind: BifurcationKind, test: &dyn Fn(&C::Point) -> f64| {
            if test(point) * test(next) < 0.0 {
                found.extend(self.curve.located(point, distance, test).map(|it| (kind, it)));
            }
        };
        seek(BifurcationKind::Fold, &OrbitPoint::rate);
        seek(BifurcationKind::Flip, &OrbitPoint::flip_test);
        seek(BifurcationKind::NeimarkSacker, &OrbitPoint::pair_test);
        let is_other = |it: &(BifurcationKind, LocatedPoint<C::Point>)| {
            it.0 == BifurcationKind::NeimarkSacker && !it.1.point.has_pair_on_circle()
        };
        found.retain(|it| !is_other(it));
        found.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        for (kind, located) in found {
            let error = self.curve.error(&located);
            let turns = kind == BifurcationKind::Fold;
            // Where a multiplier grows without bound, the sign of a test may be that of rounding.
            if !turns && error > (next.value() - point.value()).abs() {
                continue;
            }
            let noted = Noted { kind, point: located.point, error, turns };
            self.add(self.curve.bifurcation(noted));
        }
    }
}
