//! Scores: an engine's run compared with the truth.
//!
//! Everything is measured up to the scored horizon, which is fixed from the truth and the engine's
//! unit of error alone ([`RunGrowth`]): a miss before it counts, nothing after it does.
//!
//! Files here are of the oscillator and of any other system alike. What is measured of the
//! oscillator by what only it has is in the room `oscillator`, and of any other system in `system`.

pub mod attractor;
mod graze;
mod histogram;
mod horizons;
mod matching;
mod measures;
mod mismatch;
mod occurrence;
mod order;
mod oscillator;
mod probed;
mod restart_figures;
mod scored;
mod shortcoming;
mod statistics;
mod system;
mod verdict;

pub use graze::Graze;
pub use histogram::Histogram;
pub use horizons::{Horizons, ValidHorizon};
pub use matching::{Matching, WINDOW};
pub use measures::Measures;
pub use mismatch::{Excused, Mismatch};
pub use occurrence::{Occurrence, occurrences};
pub use order::order;
pub use oscillator::{
    HorizonTest, MOST_PERIODS, RestartRun, RestartTest, RunGrowth, far_apart, grazes, measure,
    on_attractor, sample_errors,
};
pub use probed::ProbeResults;
pub use restart_figures::{Restart, RestartError};
pub use scored::{Checked, ScoredRun, Verdict};
pub use statistics::Spread;
pub(crate) use statistics::worst;
pub use system::{
    Decision, EventNames, SystemRestartRun, SystemRestartTest, SystemScale, decisions,
    measure_system, system_grazes,
};
pub use verdict::{Expected, RowJudgement, Subject, judge};

/// Errors above this, in units of displacement, measure the growth and not the engine.
pub const SCORED_ERROR: f64 = 1e-3;
/// The scored horizon is where this times the engine's unit of error times the growth passes
/// [`SCORED_ERROR`]. One: up to there a method that keeps to its tolerance is still close enough
/// for its events to be told apart.
pub const SCORED_FACTOR: f64 = 1.0;
