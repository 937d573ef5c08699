//! The valid horizons of an engine in chaos, from many states on one attractor.

use super::statistics::Spread;

/// The horizons of one run, in forcing periods.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ValidHorizon {
    /// Until the error passes 1e-3; zero for a run that failed.
    pub valid: u32,
    /// Until the unit of error times the growth passes it.
    pub predicted: u32,
    /// Whether the run was still valid where it ended: its horizon is at least `valid`.
    pub outlasts: bool,
}

/// The score of an engine.
#[derive(Clone, Debug)]
pub struct Horizons {
    /// The valid horizons, one run after the other.
    pub runs: Vec<ValidHorizon>,
    /// The number of runs without a result.
    pub failed: usize,
    /// The horizons that were reached.
    pub valid: Spread,
    /// The horizon that 99 % of the runs reach.
    pub valid_q01: f64,
    /// The horizons that the truth's growth predicts.
    pub predicted: Spread,
    /// `valid - predicted`, run by run: zero where an engine's errors are its unit, and what is
    /// left of the growth's unevenness.
    pub gained: Spread,
}
