//! The first crossing of a guard: guessed, evaluated, certified.
//!
//! Most switches take one evaluation, near the guess; from there the guard's Taylor
//! [`series`](crate::numeric::series) leads to the root and the state there ([`candidate`]).
//!
//! # Why no crossing is ever passed
//!
//! Where a candidate is not confirmed at once, [`search`] walks from the start of the phase in
//! pieces. A piece is passed if a [`certificate`]
//! proves that the guard stays inside its corridor there, if a bound on the whole future proves the
//! same ([`slow_envelope`]), or, counted as undecidable, if rounding hides whether it does. A root
//! is accepted only as the right end of such a piece. Guesses propose where pieces end; a bad guess
//! costs evaluations, never a crossing. A whole flight is mostly certified by [`tangents`], a whole
//! progression by an inequality. A long piece is certified in fixed steps from its ends
//! ([`piecewise`], [`contact_parts`]), which need no evaluation; where a certificate fails the
//! piece is divided; if the guard is outside at the division, an earlier crossing is bracketed and
//! takes the place of the right end. What the guards can prove about whole futures (the mass never
//! returns, never stops, rests for ever) comes from bounds on the slow part of the motion
//! ([`slow_envelope`], and the energy of the free oscillation in contact).
//!
//! Rounding enters through one number a piece, `slack`: a few eps times the largest term that went
//! into the guard. A guard that comes closer to its threshold than that, without passing it by
//! more, is undecidable in f64; it is counted and taken as a touch, which is no switch. What the
//! slack covers is listed in docs/ROUNDING.md, and checked there in interval arithmetic.
//!
//! The work of a search has a [`limit`] that grows with the time that is proved to be clear; a
//! search that passes it leaves the phase undecided.

pub mod allowances;
#[cfg(test)]
mod bounds_tests;
mod bracket;
pub mod candidate;
pub mod certificate;
pub mod contact;
mod contact_ahead;
pub mod contact_parts;
mod crest;
pub mod limit;
pub mod no_contact;
pub mod piecewise;
pub mod progression;
pub mod search;
#[cfg(test)]
mod series_tests;
pub mod slow_envelope;
pub mod tangents;

use crate::flow::steps::Steps;
use crate::flow::{Flow, Point};
use crate::numeric::real::Real;
use crate::numeric::series::{REACH, SHORT_REACH, Series};
use crate::numeric::two_word::TwoWord;
use allowances::SLACK;

/// Between which values a guard stays as long as its phase lasts.
#[derive(Clone, Copy, Debug)]
pub struct Corridor {
    /// The lower threshold: the phase ends when the guard falls to it.
    pub low: f64,
    /// The upper threshold: the phase ends when the guard rises to it.
    pub high: f64,
}

impl Corridor {
    /// How far `value` is outside: negative inside, zero on a threshold.
    #[inline]
    pub fn excess(&self, value: f64) -> f64 {
        (value - self.high).larger(self.low - value)
    }

    /// The corridor that is narrower by `margin` on both sides.
    #[inline]
    pub fn narrowed(&self, margin: f64) -> Self {
        Self { low: self.low + margin, high: self.high - margin }
    }
}

/// The answer of a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Proof {
    /// Proved: inside.
    Inside,
    /// Inside but for a touch that is smaller than the rounding error.
    Touches,
    /// Nothing is proved about the guard between the two ends.
    Open,
}

/// The ends of a piece that are known to lie on a threshold.
#[derive(Clone, Copy, Debug)]
pub struct ThresholdEnds {
    /// The left value is a threshold, exactly, by the switch that began the phase.
    pub left: bool,
    /// Whether the left slope is exactly zero as well.
    pub left_double: bool,
    /// The right end is a root.
    pub right: bool,
}

impl ThresholdEnds {
    /// No end is known to lie on a threshold: for pieces that bound the guard from outside.
    pub const FREE: Self = Self { left: false, left_double: false, right: false };
}

/// A hint about where the search should look next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SearchHint {
    /// The next crossing may be near this elapsed time (a guess).
    Root(f64),
    /// Go on to this elapsed time; nothing is guessed before it.
    Onward(f64),
    /// It is proved that there is no crossing before this elapsed time.
    ClearUntil(f64),
    /// It is proved that there is no crossing from this elapsed time on.
    ClearFrom(f64),
}

/// A phase with its guard.
pub trait Guarded: Flow<f64> {
    /// The corridor in which the guard stays while the phase lasts.
    fn corridor(&self) -> Corridor;

    /// The evaluation at the start, with what is known there imposed.
    fn entry(&self) -> Point<f64>;

    /// The zeros of the guard that are imposed at the start.
    fn imposed(&self) -> ThresholdEnds;

    /// A guess, or a proof, about what comes after `left`; nothing after `limit` matters.
    fn hint(&self, steps: &Steps, left: &Point<f64>, limit: f64) -> SearchHint;

    /// Whether a guard that is clear for ever may still come to its threshold within rounding.
    fn touches_for_ever(&self) -> bool {
        false
    }

    /// Tries to prove that the guard stays inside between two evaluations.
    fn certify(
        &self,
        steps: &Steps,
        left: &Point<f64>,
        right: &Point<f64>,
        ends: ThresholdEnds,
    ) -> Proof;

    /// The time at which a piece that could not be certified is divided.
    fn divide(&self, left: &Point<f64>, right: &Point<f64>) -> f64;

    /// Until when the closed form of this phase serves to find its end. A later search has to take
    /// the motion up again, because the guard then lies closer to its threshold than its terms
    /// round.
    fn stage(&self) -> f64 {
        f64::INFINITY
    }

    /// Rounding slack for products that underflow
    /// ([`underflow`](crate::flow::constants::Constants::underflow)).
    fn underflow(&self) -> f64;

    /// The guard's Taylor series at an evaluation.
    fn series<const N: usize>(&self, at: &Point<f64>) -> Series<f64, N>;

    /// How far that series reaches with few terms, against the fastest rate: not at all where
    /// [`Self::continued`] takes the higher derivatives from it.
    fn short_reach(&self) -> f64 {
        SHORT_REACH
    }

    /// How far the series reaches with few terms, and with all.
    fn reaches(&self) -> [f64; 2] {
        let rate = self.fastest_rate();
        [self.short_reach() / rate, REACH / rate]
    }

    /// The motion a short `step` after an evaluation, where the guard has this value and slope.
    fn continued<const N: usize>(
        &self,
        at: &Point<f64>,
        step: f64,
        series: &Series<f64, N>,
        guard: (f64, f64),
    ) -> Point<f64>;

    /// The fastest rate at which the motion changes: Taylor steps must be short against its
    /// inverse.
    fn fastest_rate(&self) -> f64;
}

/// Rounding room of a piece: the guard's terms and those of its coefficients, and what underflows.
#[inline]
pub fn slack<G: Guarded>(phase: &G, left: &Point<f64>, right: &Point<f64>) -> f64 {
    SLACK * left.guard.largest_term.max(right.guard.largest_term) + phase.underflow()
}

/// What the search of a guard's first crossing has found.
#[derive(Clone, Copy, Debug)]
pub enum Crossing {
    /// The guard reaches a threshold.
    At(Root),
    /// The guard reaches no threshold before the horizon.
    Horizon,
    /// The guard never reaches a threshold.
    Never,
    /// The guard reaches none until this elapsed time, after which rounding no longer knows it
    /// well: the motion is to be taken up again there ([`Guarded::stage`]).
    Stage(f64),
    /// The guard reaches none until this elapsed time, and the search has exceeded its [`limit`] of
    /// work.
    Undecided(f64),
}

/// A root of a guard, where it leaves its corridor. A search returns it as the first crossing only
/// after a certificate; until then it is a candidate.
#[derive(Clone, Copy, Debug)]
pub struct Root {
    /// The motion at the crossing.
    pub point: Point<f64>,
    /// What rounding took from the point's elapsed time.
    pub low: f64,
    /// The threshold that the guard passes.
    pub side: Side,
}

/// One of a guard's thresholds. It takes a whole word, because a root is copied in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Side {
    /// The lower threshold, through which the guard falls.
    Low,
    /// The upper threshold, through which the guard rises.
    High,
}

impl Side {
    /// The upper threshold or the lower one.
    #[must_use]
    pub fn high(is: bool) -> Self {
        if is { Self::High } else { Self::Low }
    }
}

impl Root {
    /// Whether the guard rises through the upper threshold (else it falls through the lower one).
    #[must_use]
    pub fn rises(&self) -> bool {
        self.side == Side::High
    }

    /// Time from the start of the phase to the crossing.
    #[must_use]
    pub fn elapsed(&self) -> TwoWord {
        TwoWord { high: self.point.elapsed, low: self.low }
    }
}

/// Counts of the events, evaluations, undecidable touches and divided pieces so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Counters {
    /// Switches found.
    pub switches: u64,
    /// Closed-form evaluations spent on finding them: each takes a sine-cosine pair and an
    /// exponential (in contact one more of either), or their series where the arguments are small.
    /// Not counted are the sine and cosine of the forcing angle at which a phase begins, one pair a
    /// phase, and the exponential of a bound that is asked about whole futures because nothing is
    /// guessed. Guesses, series and certificates call none.
    pub evaluations: u64,
    /// Touches and near misses that were passed: rounding hides whether the guard crosses there. A
    /// search that is given up is not among them; it ends the run.
    pub undecidable: u64,
    /// Pieces that had to be divided.
    pub divisions: u64,
}
