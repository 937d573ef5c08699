//! The power of the test: alarms on fresh runs of the exact solver, right ones and changed ones.

use super::comparison::AttractorTest;
use super::distance::{distances, is_sampled};
use super::runs::{RunKind, exact_section};
use crate::case::OscillatorCase;
use crate::engine::Failure;
use percuss::Parameters;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A parameter that is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Changed {
    /// The damping ratio.
    Xi,
    /// The forcing frequency. Strobes stay one forcing period of the run apart, so that it is the
    /// motion which is compared and not the phase of the samples.
    Omega,
    /// The static force.
    B,
}

impl Changed {
    /// All parameters that are changed.
    pub const ALL: [Self; 3] = [Self::Xi, Self::Omega, Self::B];

    /// The parameter's symbol.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Xi => "xi",
            Self::Omega => "omega",
            Self::B => "b",
        }
    }

    /// Parameters with this one larger by so many times itself.
    #[must_use]
    pub fn by(self, relative: f64, parameters: Parameters) -> Parameters {
        let larger = |value: f64| value * (1.0 + relative);
        match self {
            Self::Xi => Parameters { xi: larger(parameters.xi), ..parameters },
            Self::Omega => Parameters { omega: larger(parameters.omega), ..parameters },
            Self::B => Parameters { b: larger(parameters.b), ..parameters },
        }
    }
}

/// Alarms of a number of runs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Alarms {
    /// The number of runs.
    pub runs: u32,
    /// The number of runs with a distance beyond its limit.
    pub raised: u32,
    /// Runs with a distance from the reference section beyond its limit; the errors of single
    /// periods are left out.
    pub sampled: u32,
    /// Runs in which each distance was beyond its limit, by name.
    pub by: BTreeMap<&'static str, u32>,
}

impl Alarms {
    /// The distance that was beyond its limit most often, and how often; among those from the
    /// reference section only, if asked for.
    #[must_use]
    pub fn first(&self, sampled: bool) -> Option<(&'static str, u32)> {
        let asked = self.by.iter().filter(|(name, _)| !sampled || is_sampled(name));
        asked.max_by_key(|(_, count)| **count).map(|(name, count)| (*name, *count))
    }

    fn with(mut self, names: &[&'static str]) -> Self {
        self.runs += 1;
        self.raised += u32::from(!names.is_empty());
        self.sampled += u32::from(names.iter().any(|name| is_sampled(name)));
        for name in names {
            *self.by.entry(name).or_default() += 1;
        }
        self
    }
}

impl AttractorTest {
    /// False alarms on so many runs that no limit was taken from.
    ///
    /// # Errors
    /// The solver's reason where it refuses a run.
    pub fn false_alarms(&self, case: &OscillatorCase, runs: u32) -> Result<Alarms, Failure> {
        self.alarms(case, *case.parameters(), RunKind::Fresh, runs)
    }

    /// Alarms on so many runs with a parameter that is changed.
    ///
    /// # Errors
    /// The solver's reason where it refuses a run.
    pub fn alarms_of_changed(
        &self,
        case: &OscillatorCase,
        changed: Changed,
        relative: f64,
        runs: u32,
    ) -> Result<Alarms, Failure> {
        self.alarms(case, changed.by(relative, *case.parameters()), RunKind::Changed, runs)
    }

    fn alarms(
        &self,
        case: &OscillatorCase,
        parameters: Parameters,
        kind: RunKind,
        runs: u32,
    ) -> Result<Alarms, Failure> {
        let plan = &self.calibrated.plan;
        let one = |number| {
            let section = exact_section(case, parameters, plan, kind, number)?;
            Ok(self.exceeding_limits(&distances(&section, &self.reference)))
        };
        let all: Result<Vec<_>, Failure> = (0..runs).into_par_iter().map(one).collect();
        Ok(all?.iter().fold(Alarms::default(), |alarms, names| alarms.with(names)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One of the three is larger by that share of itself, the others are as they were.
    #[test]
    fn a_changed_parameter_is_larger_by_a_share_of_itself() {
        let Parameters { xi, omega, b, .. } = Parameters::default();
        for (changed, factors) in
            Changed::ALL.into_iter().zip([[1.25, 1.0, 1.0], [1.0, 1.25, 1.0], [1.0, 1.0, 1.25]])
        {
            let found = changed.by(0.25, Parameters::default());
            let expected = [xi * factors[0], omega * factors[1], b * factors[2]];
            assert_eq!([found.xi, found.omega, found.b], expected, "{}", changed.name());
        }
    }
}
