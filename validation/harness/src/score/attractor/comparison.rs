//! An engine's section held against the reference and its limits.

use super::distance::{Distances, distances};
use super::limits::Calibrated;
use super::runs::{reference, section};
use super::section::RunSection;
use crate::case::OscillatorCase;
use crate::engine::{Accuracy, Engine, Failure, Limits};

/// The same-attractor test of one case, made ready: its reference is computed once.
pub struct AttractorTest {
    /// Plan and limits.
    pub calibrated: Calibrated,
    /// The reference section.
    pub reference: RunSection,
}

/// The distances of an engine's section from the reference.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Each distance with its limit, by name.
    pub distances: Vec<(&'static str, f64, f64)>,
    /// p and y at the engine's strobes.
    pub points: Vec<[f64; 2]>,
}

impl Comparison {
    /// The largest distance in units of its limit.
    #[must_use]
    pub fn share(&self) -> f64 {
        let shares = self.distances.iter().map(|(_, value, limit)| value / limit);
        // Keeps a NaN.
        shares
            .reduce(|worst, share| if share <= worst || worst.is_nan() { worst } else { share })
            .unwrap_or(f64::NAN)
    }
}

impl AttractorTest {
    /// Computes the reference of a case that has limits.
    ///
    /// # Errors
    /// What the exact solver says.
    pub fn new(case: &OscillatorCase, calibrated: Calibrated) -> Result<Self, Failure> {
        let reference = reference(case, &calibrated.plan)?;
        Ok(Self { calibrated, reference })
    }

    /// Runs an engine and compares its section.
    ///
    /// # Errors
    /// The engine's failure.
    pub fn compare(
        &self,
        case: &OscillatorCase,
        engine: &dyn Engine,
        accuracy: Accuracy,
        limits: &Limits,
    ) -> Result<Comparison, Failure> {
        let plan = &self.calibrated.plan;
        let run = section(engine, case, plan, accuracy, limits)?;
        let found: Distances = distances(&run, &self.reference);
        let distances = found.into_iter().map(|(name, value)| (name, value, self.limit(name)));
        let points = run.points.iter().map(|[p, y, _]| [*p, *y]).collect();
        Ok(Comparison { distances: distances.collect(), points })
    }

    /// The limit of a distance; NaN, which nothing is within, where the file has none.
    fn limit(&self, name: &str) -> f64 {
        self.calibrated.limits.get(name).copied().unwrap_or(f64::NAN)
    }

    /// The distances that are not within their limits.
    pub(super) fn exceeding_limits(&self, found: &Distances) -> Vec<&'static str> {
        let within = |(name, value): &(&&'static str, &f64)| **value <= self.limit(name);
        found.iter().filter(|it| !within(it)).map(|(name, _)| *name).collect()
    }
}
