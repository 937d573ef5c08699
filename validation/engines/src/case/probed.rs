//! The tests that a case asks for beyond its own run.

use super::located::{FileError, FileText};
use serde::Deserialize;
use toml::Spanned;

/// The longest run from which a valid horizon is read, in forcing periods.
const MAX_HORIZON_PERIODS: i64 = 1000;

/// The tests on a case beyond its own run; the exact solver always takes all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ProbedCase {
    /// Whether integrators and wrong engines too restart from states on its attractor and, where
    /// its section has calibrated limits, run for long.
    pub integrators: bool,
    /// The forcing periods of a chaotic case within which every error of eps grows to 1e-3. Valid
    /// horizons are measured in runs as long as that.
    pub valid_within: Option<u32>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [probes]")]
pub(super) struct ProbesTable {
    #[serde(default)]
    integrators: bool,
    valid_within: Option<Spanned<i64>>,
}

impl FileText<'_> {
    pub(super) fn probed(&self, table: &ProbesTable) -> Result<ProbedCase, FileError> {
        let accepted = |it: &Spanned<i64>| {
            let periods = u32::try_from(*it.get_ref()).ok();
            periods
                .filter(|_| (1..=MAX_HORIZON_PERIODS).contains(it.get_ref()))
                .ok_or_else(|| self.refused("valid_within", it))
        };
        let valid_within = table.valid_within.as_ref().map(accepted).transpose()?;
        Ok(ProbedCase { integrators: table.integrators, valid_within })
    }
}
