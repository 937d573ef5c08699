//! Scores: an engine's run compared with the truth.
//!
//! Each record is judged from the one before it ([`local`]). Errors since the start are measured up
//! to the scored horizon, which is fixed from the truth and the engine's unit of error alone.
//!
//! What an error is counted in, and how far a run is scored, is data ([`ErrorRule`]).

pub mod attractor;
mod decisions;
mod event_names;
mod graze;
mod grazes;
mod histogram;
mod horizons;
pub mod local;
mod matching;
mod measure;
mod measures;
mod mismatch;
mod occurrence;
mod on_attractor;
mod order;
mod probed;
mod restart;
mod restart_figures;
mod rule;
mod scored;
mod scored_horizon;
mod shortcoming;
mod starts;
mod statistics;
mod valid_horizon;
mod verdict;

pub use decisions::{Decision, decisions};
pub use event_names::EventNames;
pub use graze::Graze;
pub use grazes::grazes;
pub use histogram::Histogram;
pub use horizons::{Horizons, ValidHorizon};
pub use matching::{Matching, WINDOW};
pub use measure::{MeasuredBy, measure, sample_errors};
pub use measures::Measures;
pub use mismatch::{Excused, Mismatch};
pub use occurrence::Occurrence;
pub use on_attractor::MAX_HORIZON_PERIODS;
pub use order::order;
pub use probed::ProbeResults;
pub use restart::{RestartRun, RestartTest};
pub use restart_figures::{Restart, RestartError};
pub use rule::{Beside, ErrorRule};
pub use scored::{Checked, ScoredRun, Verdict};
pub use scored_horizon::ScoredBy;
pub use starts::{far_apart, on_attractor};
pub use statistics::{Spread, nearest_rank, worst};
pub use valid_horizon::HorizonTest;
pub use verdict::{Expected, RowJudgement, Subject, judge};

/// Errors above this, in units of displacement, measure the growth and not the engine.
pub const SCORED_ERROR: f64 = 1e-3;
/// The scored horizon is where this times the engine's unit of error times the growth passes
/// [`SCORED_ERROR`]. One: up to there a method that keeps to its tolerance is still close enough
/// for its events to be told apart.
pub const SCORED_FACTOR: f64 = 1.0;
