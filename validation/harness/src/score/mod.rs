//! Scores: what an engine's run is worth against the truth.
//!
//! Everything is measured up to the scored horizon, which is fixed from the truth and the engine's
//! unit of error alone ([`RunGrowth`]): a miss before it counts, nothing after it does.

pub mod attractor;
mod decisions;
mod event_names;
mod graze;
mod growth;
mod histogram;
mod horizon;
mod matching;
mod measure;
mod measure_system;
mod mismatch;
mod occurrence;
mod order;
mod probed;
mod restart;
mod restart_figures;
mod scored;
mod shortcoming;
mod starts;
mod statistics;
mod system_grazes;
mod system_restart;
mod verdict;

pub use decisions::{Decision, decisions};
pub use event_names::EventNames;
pub use graze::{Graze, grazes};
pub use growth::{RunGrowth, SCORED_ERROR, SCORED_FACTOR};
pub use histogram::Histogram;
pub use horizon::{HorizonTest, Horizons, ValidHorizon};
pub use matching::{Matching, WINDOW};
pub use measure::{Measures, measure, sample_errors};
pub use measure_system::{SystemScale, measure_system};
pub use mismatch::{Excused, Mismatch};
pub use occurrence::{Occurrence, occurrences};
pub use order::order;
pub use probed::ProbeResults;
pub use restart::{MOST_PERIODS, RestartRun, RestartTest};
pub use restart_figures::{Restart, RestartError};
pub use scored::{Checked, ScoredRun, Verdict};
pub use starts::{far_apart, on_attractor};
pub use statistics::Spread;
pub(crate) use statistics::worst;
pub use system_grazes::system_grazes;
pub use system_restart::{SystemRestartRun, SystemRestartTest};
pub use verdict::{Expected, RowJudgement, Subject, judge};
