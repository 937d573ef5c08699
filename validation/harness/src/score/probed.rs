//! The results of the tests of an engine beyond the run of a case itself.

use super::attractor::Comparison;
use super::horizons::Horizons;
use super::restart_figures::Restart;

/// The results of the probes of one engine.
#[derive(Clone, Debug, Default)]
pub struct ProbeResults {
    /// The restart test.
    pub restart: Option<Restart>,
    /// The result of the test of how long, in forcing periods, errors in chaos stay below 1e-3.
    pub horizons: Option<Horizons>,
    /// The result of the same-attractor test; without a comparison where the engine failed, with
    /// its reason.
    pub attractor: Option<Result<Comparison, String>>,
}

impl ProbeResults {
    /// Whether there are restarts to speak of.
    #[must_use]
    pub fn restarted(&self) -> bool {
        self.restart.as_ref().is_some_and(|it| it.with_impact > 0)
    }

    /// The largest ratio of a distance between sections to its limit: above 1 the test has failed.
    /// NaN where no section was compared.
    #[must_use]
    pub fn share(&self) -> f64 {
        match &self.attractor {
            Some(Ok(comparison)) => comparison.share(),
            _ => f64::NAN,
        }
    }
}
