//! The first crossing where a candidate is not confirmed: pieces proposed by guesses, accepted by
//! certificates.

use std::ops::ControlFlow;

use crate::crossing::bracket::{bracketed, middle};
use crate::crossing::candidate::{Candidate, CandidateSearch, evaluate_again, follow};
use crate::crossing::limit::Limit;
use crate::crossing::{Counters, Crossing, Guarded, Proof, Root, SearchHint, ThresholdEnds, slack};
use crate::flow::Point;
use crate::flow::steps::Steps;

/// The right end of a piece.
#[derive(Clone, Copy)]
enum Target {
    Point(Point<f64>),
    Root(Root),
}

impl Target {
    fn point(&self) -> &Point<f64> {
        match self {
            Self::Point(point) => point,
            Self::Root(root) => &root.point,
        }
    }

    fn is_root(&self) -> bool {
        matches!(self, Self::Root(_))
    }
}

/// The first crossing after the start of the phase and not after `horizon` (elapsed, may be
/// infinite).
pub fn first_crossing<G: Guarded>(
    phase: &G,
    steps: &Steps,
    horizon: f64,
    counters: &mut Counters,
) -> Crossing {
    if horizon <= 0.0 {
        return Crossing::Horizon;
    }
    let left = phase.entry();
    let hint = phase.hint(steps, &left, horizon);
    Search::new((phase, steps), (left, hint, None), horizon, counters).run(counters)
}

impl CandidateSearch {
    /// The whole search, which takes the candidate for the end of its first piece.
    #[cold]
    pub fn search<G: Guarded>(
        self,
        solved: (&G, &Steps),
        candidate: Option<Candidate>,
        horizon: f64,
        counters: &mut Counters,
    ) -> Crossing {
        if horizon <= 0.0 {
            return Crossing::Horizon;
        }
        let Self { left, hint } = self;
        Search::new(solved, (left, hint, candidate), horizon, counters).run(counters)
    }
}

/// The search through a phase, piece by piece.
struct Search<'a, G> {
    phase: &'a G,
    steps: &'a Steps,
    /// Everything up to here is proved to be clear.
    left: Point<f64>,
    /// What is known of the ends of the piece that begins there.
    ends: ThresholdEnds,
    /// The hint that says where to go on from `left`.
    hint: SearchHint,
    /// The candidate to which the hint has led, if it has been followed already.
    followed: Option<Candidate>,
    /// The smallest step that counts as progress.
    least_step: f64,
    /// The time at which the search is over, and its answer there.
    horizon: f64,
    over: Crossing,
    limit: Limit,
}

/// The next step of the search.
enum Proposal {
    /// The search is over, with this answer.
    Over(Crossing),
    /// The search goes on from this point, because the hint excludes a crossing before it.
    Clear(Point<f64>),
    /// Everything up to here is to be certified.
    Target(Target),
}

impl<'a, G: Guarded> Search<'a, G> {
    #[cold]
    fn new(
        (phase, steps): (&'a G, &'a Steps),
        (left, hint, followed): (Point<f64>, SearchHint, Option<Candidate>),
        horizon: f64,
        counters: &Counters,
    ) -> Self {
        let stage = phase.stage();
        let (horizon, over) = match stage < horizon {
            true => (stage, Crossing::Stage(stage)),
            false => (horizon, Crossing::Horizon),
        };
        let (ends, least_step) = (phase.imposed(), FIRST_STEP / phase.fastest_rate());
        let limit = Limit::new(steps, counters);
        Self { phase, steps, left, ends, hint, followed, least_step, horizon, over, limit }
    }

    #[cold]
    fn run(mut self, counters: &mut Counters) -> Crossing {
        loop {
            if self.limit.is_passed(self.left.elapsed, counters) {
                return Crossing::Undecided(self.left.elapsed);
            }
            let reached = match self.proposal(counters) {
                Proposal::Over(crossing) => return crossing,
                Proposal::Clear(point) => point,
                Proposal::Target(target) => match self.certify_towards(target, counters) {
                    ControlFlow::Continue(point) => point,
                    ControlFlow::Break(crossing) => return crossing,
                },
            };
            self.left = reached;
            self.ends = ThresholdEnds::FREE;
            self.hint = self.phase.hint(self.steps, &self.left, self.horizon);
        }
    }

    /// Turns the current hint into the next step.
    fn proposal(&mut self, counters: &mut Counters) -> Proposal {
        let (phase, horizon) = (self.phase, self.horizon);
        match advancing_hint(self.hint, self.left.elapsed, &mut self.least_step) {
            SearchHint::ClearFrom(time) if time <= self.left.elapsed => {
                counters.undecidable += u64::from(phase.touches_for_ever());
                Proposal::Over(Crossing::Never)
            }
            SearchHint::ClearUntil(time) if time >= horizon => Proposal::Over(self.over),
            SearchHint::ClearUntil(time) => {
                let point = Target::Point(evaluate_again(phase, time, counters));
                match inside_or_root(phase, &self.left, point, counters) {
                    Target::Point(point) => Proposal::Clear(point),
                    earlier @ Target::Root(_) => Proposal::Target(earlier),
                }
            }
            SearchHint::Root(time) if time < horizon => {
                Proposal::Target(self.follow_guess(time, counters))
            }
            SearchHint::Root(time) | SearchHint::Onward(time) | SearchHint::ClearFrom(time) => {
                let time = time.min(horizon);
                if time.is_finite() {
                    Proposal::Target(Target::Point(evaluate_again(phase, time, counters)))
                } else {
                    Proposal::Over(self.over)
                }
            }
        }
    }

    /// The root that a guess leads to, or a point further on.
    fn follow_guess(&mut self, time: f64, counters: &mut Counters) -> Target {
        let (phase, horizon, left) = (self.phase, self.horizon, self.left.elapsed);
        let followed = self.followed.take();
        match followed.unwrap_or_else(|| follow(phase, left, time, horizon, counters)) {
            Ok(root) => Target::Root(root),
            Err(point) => {
                // A guess that led nowhere: the next ones must lead further.
                self.least_step *= 2.0;
                let least = (left + self.least_step).min(horizon);
                let near = point.elapsed < least;
                Target::Point(if near { evaluate_again(phase, least, counters) } else { point })
            }
        }
    }

    /// The point up to which everything is certified, on the way to a target, where the search
    /// continues; or what it ends with.
    fn certify_towards(
        &self,
        target: Target,
        counters: &mut Counters,
    ) -> ControlFlow<Crossing, Point<f64>> {
        let solved = (self.phase, self.steps);
        match settle(solved, self.left, self.ends, target, (&self.limit, counters)) {
            Ok(Target::Root(root)) if root.elapsed().high <= self.horizon => {
                ControlFlow::Break(Crossing::At(root))
            }
            Ok(Target::Point(point)) if point.elapsed < self.horizon => {
                ControlFlow::Continue(point)
            }
            Ok(_) => ControlFlow::Break(self.over),
            Err(elapsed) => ControlFlow::Break(Crossing::Undecided(elapsed)),
        }
    }
}

/// The first step of its own that the search takes, against the inverse of the fastest rate.
const FIRST_STEP: f64 = 0.1;

/// Advice to go on by less than this share of the time so far comes from bounds that rounding keeps
/// from settling: it is followed in steps.
const MIN_ADVANCE: f64 = 1e-3;

/// A hint that makes progress. A guess that falls on `left` is no guess; that, or a hint to go
/// on by less than the least step, is replaced by that step, which doubles each time.
fn advancing_hint(hint: SearchHint, left: f64, least_step: &mut f64) -> SearchHint {
    let resolution = 8.0 * f64::EPSILON * left;
    let nearest = match hint {
        SearchHint::Onward(_) => left + least_step.max(MIN_ADVANCE * left),
        SearchHint::Root(_) | SearchHint::ClearUntil(_) => left + resolution,
        SearchHint::ClearFrom(_) => return hint,
    };
    match hint {
        SearchHint::Root(time) | SearchHint::ClearUntil(time) | SearchHint::Onward(time)
            if time > nearest =>
        {
            hint
        }
        // A NaN comes here too.
        _ => {
            *least_step *= 2.0;
            SearchHint::Onward(left + least_step.max(2.0 * resolution))
        }
    }
}

/// Certifies everything from `left` to `target`, or to the earlier crossing that turns up; an error
/// says how far it came within the limit.
#[inline]
fn settle<G: Guarded>(
    (phase, steps): (&G, &Steps),
    left: Point<f64>,
    mut ends: ThresholdEnds,
    target: Target,
    (limit, counters): (&Limit, &mut Counters),
) -> Result<Target, f64> {
    let target = inside_or_root(phase, &left, target, counters);
    ends.right = target.is_root();
    if phase.certify(steps, &left, target.point(), ends) == Proof::Inside {
        return Ok(target);
    }
    divide((phase, steps), left, ends, target, (limit, counters))
}

/// The piecewise way, where one certificate does not reach from `left` to `target`.
#[cold]
fn divide<G: Guarded>(
    (phase, steps): (&G, &Steps),
    mut left: Point<f64>,
    mut ends: ThresholdEnds,
    target: Target,
    (limit, counters): (&Limit, &mut Counters),
) -> Result<Target, f64> {
    let mut pending = vec![target];
    while let Some(target) = pending.last().copied() {
        if limit.is_passed(left.elapsed, counters) {
            return Err(left.elapsed);
        }
        let right = target.point();
        ends.right = target.is_root();
        let mut verdict = phase.certify(steps, &left, right, ends);
        if verdict == Proof::Touches && is_uneven(&left, right) {
            verdict = Proof::Open;
        }
        // Below the smallest normal number halving no longer divides.
        let finest = (8.0 * f64::EPSILON * right.elapsed).max(f64::MIN_POSITIVE);
        let resolvable = right.elapsed - left.elapsed > finest;
        if verdict == Proof::Open && resolvable {
            counters.divisions += 1;
            let proposed = phase.divide(&left, right);
            let place = between(left.elapsed, proposed, right.elapsed, pending.len());
            let middle = evaluate_again(phase, place, counters);
            match inside_or_root(phase, &left, Target::Point(middle), counters) {
                earlier @ Target::Root(_) => pending = vec![earlier],
                inside @ Target::Point(_) => pending.push(inside),
            }
            continue;
        }
        counters.undecidable += u64::from(verdict != Proof::Inside);
        left = *right;
        ends = ThresholdEnds::FREE;
        pending.pop();
        if pending.is_empty() {
            return Ok(target);
        }
    }
    Ok(Target::Point(left))
}

/// Whether most of a piece's rounding room comes from one of its ends, from what dies out in it or
/// grows: then a touch may be decided on the part next to the other.
fn is_uneven(left: &Point<f64>, right: &Point<f64>) -> bool {
    /// The ratio of the terms at a piece's ends from which on its rounding room is uneven.
    const UNEVEN_RATIO: f64 = 16.0;
    let [left, right] = [left, right].map(|end| end.guard.largest_term);
    left > UNEVEN_RATIO * right || right > UNEVEN_RATIO * left
}

/// A place well inside a piece: what a phase proposes, unless rounding puts it at an end or many
/// divisions have led nowhere.
fn between(left: f64, proposed: f64, right: f64, divisions: usize) -> f64 {
    /// The least distance of a place from a piece's ends, as a share of its length.
    const END_MARGIN: f64 = 1e-7;
    /// The number of divisions in which a phase's proposal is taken; halving follows.
    const MAX_PROPOSALS: usize = 16;
    let margin = END_MARGIN * (right - left);
    let inside = proposed > left + margin && proposed < right - margin;
    if inside && divisions < MAX_PROPOSALS { proposed } else { middle(left, right, divisions) }
}

/// The crossing before the target, if the guard is outside there by more than rounding.
fn inside_or_root<G: Guarded>(
    phase: &G,
    left: &Point<f64>,
    target: Target,
    counters: &mut Counters,
) -> Target {
    let Target::Point(point) = target else { return target };
    if phase.corridor().excess(point.guard.orders[0]) > slack(phase, left, &point) {
        Target::Root(bracketed(phase, left, &point, counters))
    } else {
        target
    }
}
