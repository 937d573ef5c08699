//! That a guard does not leave its corridor before the reported end of its phase, and does so
//! there.
//!
//! From the entry on the guard is expanded in Taylor's series, with a bound of the remainder over
//! all that follows. In Bernstein's form a piece of it is proved to lie inside; the remainder sits
//! in the last coefficient alone, so that zeros known at the entry need no special case. Pieces
//! follow each other until on the rest up to the reported end the guard is proved to move in one
//! direction, outwards. Then it has one zero there, the first of all, and its value at the reported
//! end says how far that is.

use crate::ball::Ball;
use crate::guard::{Expansion, Guard};
use crate::hull::{Between, Piecewise, holds};
use percuss::TwoWord;
use percuss::insides::crossing::Corridor;

/// The solver's claim about a phase.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// The duration of the phase.
    pub duration: TwoWord,
    /// The corridor in which the guard stays.
    pub corridor: Corridor,
    /// Whether the guard leaves through the upper threshold.
    pub rises: bool,
    /// The slack that the solver grants to its rounding at the end.
    pub slack: f64,
}

/// The verdict of interval arithmetic on a claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Proved.
    Confirmed {
        /// The guard's distance from its threshold at the reported end, in units of the slack.
        residual: f64,
    },
    /// Not proved, and not refuted.
    Open {
        /// The time up to which there is no crossing.
        until: f64,
    },
    /// Refuted: the guard is certainly outside earlier than the slack explains.
    Earlier {
        /// The time at which the guard is outside.
        at: f64,
        /// The least distance from the threshold, in units of the slack.
        excess: f64,
    },
    /// Refuted: at the reported end the guard is certainly further from its threshold than it may
    /// be.
    Elsewhere {
        /// The least distance from the threshold, in units of the slack.
        residual: f64,
    },
    /// Refuted: around the reported end the guard certainly stays inside.
    Absent {
        /// The least distance from the threshold, in units of the slack.
        crest: f64,
    },
}

/// The largest distance of a guard from its threshold, in slacks, where the solver says that it is
/// on it: the solver accepts one slack in what it computes, and that errs by less than another.
pub const MAX_SLACKS: f64 = 2.0;

/// The number of pieces after which a phase is left undecided.
const MAX_PIECES: usize = 4000;

/// The longest piece, in units of the inverse of the guard's pace.
const MAX_PIECE_LENGTH: f64 = 4.0;

/// The verdict on a claim.
#[must_use]
pub fn examine(guard: &Guard, claim: &Claim) -> Verdict {
    let end = Ball::words(claim.duration);
    let at_end = guard.at(end);
    let threshold = if claim.rises { claim.corridor.high } else { claim.corridor.low };
    let residual = at_end.whole[0] - Ball::exact(threshold);
    let origin = guard.at(Ball::ZERO);
    let proof = CorridorProof { guard, claim, end, origin: &origin };
    match proof.run() {
        Ok(()) => {
            // A phase may be so short that its series knows more about its end.
            let from_start = origin.value_after(end) - Ball::exact(threshold);
            let narrow = from_start.width() < residual.width();
            proof.crossing(if narrow { from_start } else { residual }, &at_end)
        }
        Err(until) => proof
            .excursion(until, &at_end)
            .map_or(Verdict::Open { until }, |(at, excess)| Verdict::Earlier { at, excess }),
    }
}

/// A proof that a guard stays in its corridor up to the reported end.
pub(crate) struct CorridorProof<'a> {
    guard: &'a Guard,
    pub claim: &'a Claim,
    end: Ball,
    origin: &'a Expansion,
}

impl CorridorProof<'_> {
    /// Proves that the guard stays inside up to the end, or returns how far the proof came.
    fn run(&self) -> Result<(), f64> {
        let mut from = 0.0;
        let mut length = f64::INFINITY;
        if self.end.is_exactly_zero() {
            return Ok(());
        }
        for _ in 0..MAX_PIECES {
            let here = self.at(from);
            let rest = self.end - Ball::exact(from);
            if let Some(clear) = self.clear_by_bounds(&here, from, rest) {
                from = clear;
                continue;
            }
            let start = if from == 0.0 { Some(self.zeros_at_start(&here)) } else { None };
            length = match self.proved_piece(&here, rest, length, start) {
                Piece::Arrives => return Ok(()),
                Piece::Inside(length) => length,
                Piece::None => return Err(from),
            };
            let next = below(from, length);
            if !(next > from) {
                return Err(from);
            }
            from = next;
            length *= 4.0;
        }
        Err(from)
    }

    /// The guard around a place; soon after the entry its series there knows value and slope
    /// better.
    pub fn at(&self, from: f64) -> Expansion {
        /// The largest time since the entry, in units of the guard's fastest time, at which its
        /// series there is taken: with twelve orders the remainder is 1e-45 of the highest.
        const MAX_SERIES_TIME: f64 = 1e-3;
        let place = Ball::exact(from);
        let mut here = self.guard.at(place);
        if from * self.guard.pace.max(here.rate.about()) < MAX_SERIES_TIME && from > 0.0 {
            here.whole[0] = self.origin.value_after(place);
            here.whole[1] = self.origin.slope_after(place);
        }
        here
    }

    /// A place until which parabola and amplitude alone keep the guard inside.
    fn clear_by_bounds(&self, here: &Expansion, from: f64, rest: Ball) -> Option<f64> {
        let period = std::f64::consts::TAU / self.guard.pace;
        if !(rest.about() > 2.0 * period) {
            return None;
        }
        let mut short = period;
        let mut length = rest.about() - short;
        while length > period {
            let next = below(from, length);
            let span = Ball::exact(next) - Ball::exact(from);
            if next > from && self.inside_by_bounds(here, span) {
                return Some(next);
            }
            short *= 2.0;
            length = rest.about() - short;
        }
        None
    }

    fn inside_by_bounds(&self, here: &Expansion, length: Ball) -> bool {
        let [p0, p1, p2] = here.parabola;
        let half = p0 + p1.scaled(0.5) * length;
        let last = p0 + length * (p1 + p2.scaled(0.5) * length);
        let (least, most) = here.quick_range();
        let Corridor { low, high } = self.claim.corridor;
        [p0, half, last].into_iter().all(|it| {
            let up =
                it.widened(here.amplitude) + Ball::exact(most) - Ball::exact(high.min(f64::MAX));
            let down =
                it.widened(here.amplitude) + Ball::exact(least) - Ball::exact(low.max(f64::MIN));
            (high == f64::INFINITY || up.upper() < 0.0)
                && (low == f64::NEG_INFINITY || down.lower() > 0.0)
        })
    }

    /// How many orders of the guard are exactly zero at the entry, on the lower and on the upper
    /// threshold.
    fn zeros_at_start(&self, here: &Expansion) -> [usize; 2] {
        let Corridor { low, high } = self.claim.corridor;
        [low, high].map(|threshold| {
            let on =
                threshold.is_finite() && (here.whole[0] - Ball::exact(threshold)).is_exactly_zero();
            usize::from(on) + usize::from(on && here.whole[1].is_exactly_zero())
        })
    }

    /// A piece that begins here, as long as it can be proved to be inside, or the last.
    fn proved_piece(
        &self,
        here: &Expansion,
        rest: Ball,
        wish: f64,
        start: Option<[usize; 2]>,
    ) -> Piece {
        let quick = here.rate.about() > 0.0;
        let longest = MAX_PIECE_LENGTH / self.guard.pace;
        let reach = Reach {
            longest,
            // In full the quick exponential must not be quick against the piece.
            in_full: if quick {
                longest.min(MAX_PIECE_LENGTH / here.rate.about())
            } else {
                longest
            },
            // At the entry the series with the exponential is known exactly.
            reduced: quick && start.is_none(),
        };
        let may_arrive = start.is_none() || self.begins_before_exit(here);
        if may_arrive && self.arrives_at_end(here, rest, &reach) {
            return Piece::Arrives;
        }
        let wish = wish.min(0.5 * rest.about());
        self.longest_inside(here, wish, &reach, start.unwrap_or([0; 2]))
    }

    fn arrives_at_end(&self, here: &Expansion, rest: Ball, reach: &Reach) -> bool {
        let length = rest.about();
        let full = length <= reach.in_full && self.arrives(&Piecewise::full(here, rest));
        let reduced = reach.reduced && length <= reach.longest;
        full || (reduced && self.arrives(&Piecewise::reduced(here, rest)))
    }

    /// Halves a piece until it is inside.
    fn longest_inside(
        &self,
        here: &Expansion,
        wish: f64,
        reach: &Reach,
        zeros: [usize; 2],
    ) -> Piece {
        /// Share of the first length at which halving ends.
        const MIN_LENGTH_SHARE: f64 = 1e-9;
        let begin = wish.min(if reach.reduced { reach.longest } else { reach.in_full });
        let mut pieces = [
            Some(Piecewise::full(here, Ball::exact(begin))),
            reach.reduced.then(|| Piecewise::reduced(here, Ball::exact(begin))),
        ];
        let mut length = begin;
        while length > MIN_LENGTH_SHARE * begin {
            for piece in pieces.iter_mut().flatten() {
                let suits = piece.reduced || length <= reach.in_full;
                if suits && self.inside(piece, zeros) {
                    return Piece::Inside(length);
                }
                piece.halve();
            }
            length *= 0.5;
        }
        Piece::None
    }

    /// Whether the guard stays inside all through the piece.
    pub fn inside(&self, piece: &Piecewise, zeros: [usize; 2]) -> bool {
        let Corridor { low, high } = self.claim.corridor;
        let (least, most) = piece.range;
        let bounds =
            Between { low: (low - least).next_up(), high: (high - most).next_down(), zeros };
        let bounds = if piece.reduced { bounds } else { Between { low, high, zeros } };
        holds(&piece.terms, piece.remainder, &bounds)
    }

    /// Whether the phase certainly begins on the inner side of the threshold through which it ends.
    fn begins_before_exit(&self, here: &Expansion) -> bool {
        let Corridor { low, high } = self.claim.corridor;
        match self.claim.rises {
            true => (here.whole[0] - Ball::exact(high)).upper() < 0.0,
            false => (here.whole[0] - Ball::exact(low)).lower() > 0.0,
        }
    }

    /// Whether the guard moves outwards all through the piece, hence away from the other threshold.
    fn arrives(&self, piece: &Piecewise) -> bool {
        let (least, most) = piece.slope_range;
        let bounds = match self.claim.rises {
            true => Between { low: -least, high: f64::INFINITY, zeros: [0; 2] },
            false => Between { low: f64::NEG_INFINITY, high: -most, zeros: [0; 2] },
        };
        holds(&piece.terms[1..], piece.remainder, &bounds)
    }
}

/// The largest lengths of a piece.
struct Reach {
    longest: f64,
    /// With the quick exponential in its series.
    in_full: f64,
    /// Whether bounds may stand for the quick exponential.
    reduced: bool,
}

enum Piece {
    Arrives,
    Inside(f64),
    None,
}

/// A number below `from + length`, which is what has been proved.
fn below(from: f64, length: f64) -> f64 {
    if from == 0.0 { length } else { (from + length).next_down() }
}
