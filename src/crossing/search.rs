//! The first crossing: pieces proposed by guesses, accepted by certificates.

use crate::crossing::certificate::{Ends, Verdict};
use crate::crossing::guarded::{Guarded, SearchHint, slack};
use crate::crossing::limit::Limit;
use crate::crossing::root::{bracketed, evaluate_again, follow, middle};
use crate::crossing::{Counters, Crossing, Root};
use crate::flow::Point;
use crate::flow::steps::Steps;
use crate::two_word::TwoWord;

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
    search((phase, steps), left, (hint, None), horizon, counters)
}

/// How a search has ended whose crossing has been told already.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// The phase ends by a crossing after this time.
    At(TwoWord),
    /// There is no crossing before the horizon.
    Horizon,
    /// There is never a crossing, which is proved.
    Never,
    /// There is no crossing until this time, when the motion is to be taken up again
    /// ([`Guarded::stage`]).
    Stage(f64),
    /// There is no crossing until this time, and no decision after it within the [`Limit`].
    Undecided(f64),
}

/// Finds the first crossing and tells it to `next`.
///
/// Mostly the first guess, which may have been made already, leads to the root, and one certificate
/// says that it is the first. What comes next waits for the root but not for the certificate: it is
/// begun before that, so that the processor works on both. If the certificate fails, `next` is told
/// the right one after; if none counts, what it was told counts for nothing.
#[inline]
pub fn first_crossing_and<G: Guarded>(
    (phase, steps): (&G, &Steps),
    guess: Option<f64>,
    horizon: f64,
    counters: &mut Counters,
    mut next: impl FnMut(&Root),
) -> Found {
    if horizon <= 0.0 {
        return Found::Horizon;
    }
    let left = phase.entry();
    let hint = match guess {
        Some(time) => SearchHint::Root(time),
        None => phase.hint(steps, &left, horizon),
    };
    let mut tried = None;
    if let SearchHint::Root(time) = hint
        && time > 0.0
        && time < horizon
    {
        match follow(phase, 0.0, time, horizon, counters) {
            Ok(root) => {
                next(&root);
                let ends = Ends { right: true, ..phase.imposed() };
                if root.elapsed().high <= horizon
                    && phase.certify(steps, &left, &root.point, ends) == Verdict::Inside
                {
                    return Found::At(root.elapsed());
                }
                tried = Some(Ok(root));
            }
            Err(point) => tried = Some(Err(point)),
        }
    }
    match search((phase, steps), left, (hint, tried), horizon, counters) {
        Crossing::At(root) => {
            next(&root);
            Found::At(root.elapsed())
        }
        Crossing::Horizon => Found::Horizon,
        Crossing::Never => Found::Never,
        Crossing::Stage(elapsed) => Found::Stage(elapsed),
        Crossing::Undecided(elapsed) => Found::Undecided(elapsed),
    }
}

/// A guess that has been followed: to a root, or in vain.
type Followed = Result<Root, Point<f64>>;

/// The walk in pieces, from a hint whose guess may have been followed already.
#[cold]
fn search<G: Guarded>(
    (phase, steps): (&G, &Steps),
    mut left: Point<f64>,
    (mut hint, mut tried): (SearchHint, Option<Followed>),
    horizon: f64,
    counters: &mut Counters,
) -> Crossing {
    let limit = Limit::new(steps, counters);
    let stage = phase.stage();
    let (horizon, over) = match stage < horizon {
        true => (stage, Crossing::Stage(stage)),
        false => (horizon, Crossing::Horizon),
    };
    let mut ends = phase.imposed();
    let mut stride = STRIDE / phase.fastest_rate();
    loop {
        if limit.is_passed(left.elapsed, counters) {
            return Crossing::Undecided(left.elapsed);
        }
        let target = match onwards(hint, left.elapsed, &mut stride) {
            SearchHint::ClearFrom(time) if time <= left.elapsed => {
                counters.undecidable += u64::from(phase.touches_for_ever());
                return Crossing::Never;
            }
            SearchHint::ClearUntil(time) => {
                if time >= horizon {
                    return over;
                }
                let point = evaluate_again(phase, time, counters);
                let target = inside_or_root(phase, &left, Target::Point(point), counters);
                if !target.is_root() {
                    left = point;
                    ends = Ends::FREE;
                    hint = phase.hint(steps, &left, horizon);
                    continue;
                }
                target
            }
            SearchHint::Root(time) if time < horizon => {
                let followed = tried
                    .take()
                    .unwrap_or_else(|| follow(phase, left.elapsed, time, horizon, counters));
                match followed {
                    Ok(root) => Target::Root(root),
                    Err(point) => {
                        // A guess that led nowhere: the next ones must lead further.
                        stride *= 2.0;
                        let least = (left.elapsed + stride).min(horizon);
                        let near = point.elapsed < least;
                        Target::Point(if near {
                            evaluate_again(phase, least, counters)
                        } else {
                            point
                        })
                    }
                }
            }
            SearchHint::Root(time) | SearchHint::Onward(time) | SearchHint::ClearFrom(time) => {
                let time = time.min(horizon);
                if !time.is_finite() {
                    return over;
                }
                Target::Point(evaluate_again(phase, time, counters))
            }
        };
        match settle((phase, steps), left, ends, target, (&limit, counters)) {
            Ok(Target::Root(root)) if root.elapsed().high <= horizon => return Crossing::At(root),
            Ok(Target::Point(point)) if point.elapsed < horizon => left = point,
            Ok(_) => return over,
            Err(elapsed) => return Crossing::Undecided(elapsed),
        }
        ends = Ends::FREE;
        hint = phase.hint(steps, &left, horizon);
    }
}

/// The first step of its own that the search takes, against the inverse of the fastest rate.
const STRIDE: f64 = 0.1;

/// Advice to go on by less than this share of the time so far comes from bounds that rounding keeps
/// from settling: it is followed in steps.
const CREEPING: f64 = 1e-3;

/// An hint that gets on. A guess that falls on `left` is no guess; that, or an advice to go on
/// by less than a stride, is replaced by a stride, longer each time.
fn onwards(hint: SearchHint, left: f64, stride: &mut f64) -> SearchHint {
    let resolution = 8.0 * f64::EPSILON * left;
    let nearest = match hint {
        SearchHint::Onward(_) => left + stride.max(CREEPING * left),
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
            *stride *= 2.0;
            SearchHint::Onward(left + stride.max(2.0 * resolution))
        }
    }
}

/// Certifies everything from `left` to `target`, or to the earlier crossing that turns up; an error
/// says how far it came within the limit.
#[inline]
fn settle<G: Guarded>(
    (phase, steps): (&G, &Steps),
    left: Point<f64>,
    mut ends: Ends,
    target: Target,
    (limit, counters): (&Limit, &mut Counters),
) -> Result<Target, f64> {
    let target = inside_or_root(phase, &left, target, counters);
    ends.right = target.is_root();
    if phase.certify(steps, &left, target.point(), ends) == Verdict::Inside {
        return Ok(target);
    }
    divide((phase, steps), left, ends, target, (limit, counters))
}

/// The piecewise way, where one certificate does not reach from `left` to `target`.
#[cold]
fn divide<G: Guarded>(
    (phase, steps): (&G, &Steps),
    mut left: Point<f64>,
    mut ends: Ends,
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
        if verdict == Verdict::Touches && uneven(&left, right) {
            verdict = Verdict::Open;
        }
        // Below the smallest normal number halving no longer divides.
        let finest = (8.0 * f64::EPSILON * right.elapsed).max(f64::MIN_POSITIVE);
        let resolvable = right.elapsed - left.elapsed > finest;
        if verdict == Verdict::Open && resolvable {
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
        counters.undecidable += u64::from(verdict != Verdict::Inside);
        left = *right;
        ends = Ends::FREE;
        pending.pop();
        if pending.is_empty() {
            return Ok(target);
        }
    }
    Ok(Target::Point(left))
}

/// Whether most of a piece's rounding room comes from one of its ends, from what dies out in it or
/// grows: then a touch may be decided on the part next to the other.
fn uneven(left: &Point<f64>, right: &Point<f64>) -> bool {
    const MUCH: f64 = 16.0;
    let [left, right] = [left, right].map(|end| end.guard.largest_term);
    left > MUCH * right || right > MUCH * left
}

/// A place well inside a piece: what a phase proposes, unless rounding puts it at an end or many
/// divisions have led nowhere.
fn between(left: f64, proposed: f64, right: f64, divisions: usize) -> f64 {
    const MARGIN: f64 = 1e-7;
    const PATIENCE: usize = 16;
    let margin = MARGIN * (right - left);
    let inside = proposed > left + margin && proposed < right - margin;
    if inside && divisions < PATIENCE { proposed } else { middle(left, right, divisions) }
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
