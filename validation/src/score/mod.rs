//! Scores: what an engine's run is worth against the truth.
//!
//! Everything is measured up to the scored horizon, which is fixed from the truth and the engine's
//! unit of error alone ([`Growth`]): a miss before it counts, nothing after it does.

mod growth;
mod matching;
mod measure;
mod statistics;
mod verdict;

pub use growth::{Growth, SCORED_ERROR, SCORED_FACTOR};
pub use matching::{Matching, WINDOW};
pub use measure::{Measures, measure};
pub use statistics::Spread;
pub use verdict::{Checked, Judgement, Subject, Verdict, judge};
