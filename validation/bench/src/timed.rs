//! Timed runs, each with the engine's own part of the run beside the whole.

use super::rounds::Benchmark;
use super::timed_case::Score;
use crate::engine::{Failure, Work};

/// A contestant on a case. What is timed is its `call`.
pub trait TimedRun: Benchmark {
    /// Runs of the case's length that a call makes.
    fn runs(&self) -> f64 {
        1.0
    }

    /// The errors of the last call's answer.
    ///
    /// # Errors
    /// What is wrong with it.
    fn score(&self) -> Result<Score, Failure>;

    /// The counted work of the last call.
    fn work(&self) -> Work;
}

/// A contestant at a setting, and right after it its part alone where that can be timed.
pub struct ContestEntry<'a> {
    /// The whole run.
    pub timed: Box<dyn TimedRun + 'a>,
    /// The engine's own part of the run, without the harness's.
    pub library_part: Option<Box<dyn Benchmark + 'a>>,
}
