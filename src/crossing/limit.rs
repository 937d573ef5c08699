//! How much work the search of one phase may take before the phase counts as undecidable.
//!
//! A phase whose end is decided far from its thresholds takes a few evaluations. Bisection to the
//! last digit takes at most 1100 (from 1 to the smallest number), and a near graze divided down to
//! that size as many on either side: four thousand are granted at once. A
//! phase without an event costs up to a few evaluations a period of the forcing and of the free
//! oscillation: so much is granted for the time that is proved to be clear. A search that spends
//! more than that makes no progress, and is ended.

use crate::crossing::Counters;
use crate::flow::steps::Steps;
use std::f64::consts::TAU;

/// Evaluations that the search of one phase may take wherever it stands.
pub const GRANTED_EVALUATIONS: u64 = 4096;

/// Evaluations granted for each radian of the forcing and each unit of time that are proved to be
/// clear. A certificate of degree eight reaches about a radian of the fastest harmonic, and halving
/// finds such pieces with as many evaluations again: 64 leave a factor of thirty.
pub const EVALUATIONS_PER_RADIAN: f64 = 64.0;

/// Evaluations that the search of one phase may take in all, however long the phase: a second or
/// so.
pub const MAX_EVALUATIONS: u64 = 1 << 20;

/// Evaluations by which a search may pass its limit: those of one bracketed root, which are not
/// interrupted.
pub const LAST_ROOT_EVALUATIONS: u64 = 1200;

/// The work that is left to one search.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Evaluations when the search began.
    begun: u64,
    /// Radians of the forcing and units of time that pass in a unit of time.
    pace: f64,
}

impl Limit {
    /// The limit of a search that begins now.
    #[must_use]
    pub fn new(steps: &Steps, counters: &Counters) -> Self {
        Self { begun: counters.evaluations, pace: 1.0 + TAU / steps.turning.period }
    }

    /// Whether the search has taken more than is granted to one that has proved the phase to be
    /// clear for a time `elapsed`.
    #[must_use]
    pub fn is_passed(&self, elapsed: f64, counters: &Counters) -> bool {
        let spent = counters.evaluations - self.begun;
        // Written so that a NaN has passed it.
        let honest = spent as f64
            <= GRANTED_EVALUATIONS as f64 + EVALUATIONS_PER_RADIAN * self.pace * elapsed;
        spent > GRANTED_EVALUATIONS && (!honest || spent > MAX_EVALUATIONS)
    }
}
