//! What the search asks of a phase.

use crate::crossing::allowances::SLACK;
use crate::crossing::certificate::{Corridor, Proof, ThresholdEnds};
use crate::crossing::series::{REACH, SHORT_REACH, Series};
use crate::flow::steps::Steps;
use crate::flow::{Flow, Point};

/// A hint about where the search should look next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SearchHint {
    /// The next crossing may be near this elapsed time (a guess).
    Root(f64),
    /// Go on to this elapsed time; nothing is guessed before it.
    Onward(f64),
    /// No crossing before this elapsed time (proved).
    ClearUntil(f64),
    /// No crossing from this elapsed time on (proved).
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
