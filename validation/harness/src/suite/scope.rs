//! The extent of a suite, and the limits of its runs.

use crate::case::Case;
use crate::engine::{Accuracy, Limits, Stepping};

/// The extent of the run: quick or full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Suite {
    /// Three tolerances, a minute on two cores.
    Quick,
    /// Every decade of tolerance down to where rounding begins to show.
    Full,
}

/// A suite with the tolerances that are chosen of it.
#[derive(Clone, Debug, PartialEq)]
pub struct SuiteScope {
    suite: Suite,
    tolerances: Vec<f64>,
}

impl From<Suite> for SuiteScope {
    fn from(suite: Suite) -> Self {
        let adaptive = suite.accuracies(Stepping::Adaptive);
        Self { suite, tolerances: adaptive.into_iter().filter_map(Accuracy::tolerance).collect() }
    }
}

impl SuiteScope {
    /// Narrows the suite to these tolerances; an empty list leaves all of the suite's. Engines
    /// without a tolerance are not concerned.
    #[must_use]
    pub fn at(self, tolerances: Vec<f64>) -> Self {
        if tolerances.is_empty() { self } else { Self { tolerances, ..self } }
    }

    /// The suite.
    #[must_use]
    pub const fn suite(&self) -> Suite {
        self.suite
    }

    /// The tolerances at which rows are made.
    #[must_use]
    pub fn tolerances(&self) -> &[f64] {
        &self.tolerances
    }

    /// The accuracies that the suite asks for, given the way in which an engine's accuracy is
    /// chosen.
    #[must_use]
    pub fn accuracies(&self, stepping: Stepping) -> Vec<Accuracy> {
        let chosen = |it: &Accuracy| it.tolerance().is_none_or(|it| self.tolerances.contains(&it));
        self.suite.accuracies(stepping).into_iter().filter(chosen).collect()
    }

    /// Whether a row with this tolerance or step is one that is made.
    #[must_use]
    pub fn makes(&self, tolerance: Option<f64>, step: Option<f64>) -> bool {
        let chosen = tolerance.is_none_or(|it| self.tolerances.contains(&it));
        chosen && self.suite.makes(tolerance, step)
    }
}

impl Suite {
    /// The accuracies that the suite asks for, given the way in which an engine's accuracy is
    /// chosen.
    #[must_use]
    pub fn accuracies(self, stepping: Stepping) -> Vec<Accuracy> {
        let decades = |exponents: &[i32]| {
            exponents
                .iter()
                .map(|k| Accuracy::Tolerance(format!("1e-{k}").parse().unwrap_or(f64::NAN)))
                .collect()
        };
        let halvings = |exponents: &[i32]| {
            exponents.iter().map(|k| Accuracy::Step(0.5_f64.powi(*k))).collect()
        };
        match (stepping, self) {
            (Stepping::Exact, _) => vec![Accuracy::Exact],
            (Stepping::Fixed { .. }, Self::Quick) => halvings(&[2, 4, 6]),
            (Stepping::Fixed { .. }, Self::Full) => halvings(&[1, 2, 3, 4, 5, 6, 7]),
            (_, Self::Quick) => decades(&[6, 9, 12]),
            (_, Self::Full) => decades(&[4, 5, 6, 7, 8, 9, 10, 11, 12]),
        }
    }

    /// Whether a row with this tolerance or step is one that the suite makes.
    #[must_use]
    pub fn makes(self, tolerance: Option<f64>, step: Option<f64>) -> bool {
        let asked = match (tolerance, step) {
            (Some(tolerance), _) => Accuracy::Tolerance(tolerance),
            (None, Some(step)) => Accuracy::Step(step),
            (None, None) => Accuracy::Exact,
        };
        let kinds = [Stepping::Exact, Stepping::Adaptive, Stepping::Fixed { order: 1 }];
        kinds.into_iter().any(|it| self.accuracies(it).contains(&asked))
    }

    /// Right-hand sides beyond which a row is not run, where that is known beforehand.
    #[must_use]
    pub fn budget(self) -> f64 {
        match self {
            Self::Quick => 3e6,
            Self::Full => 3e7,
        }
    }

    /// The limits beyond which a row's run is given up as a failure. The slowest method takes a
    /// microsecond a call. On other systems than the oscillator it is seldom known beforehand what
    /// a run costs: a right-hand side comes with a guard, and with hardly more.
    #[must_use]
    pub fn limits(case: &Case) -> Limits {
        let (calls, more) = if case.oscillator.is_some() { (4, 8_000_000) } else { (2, 0) };
        // Both suites have the same limits: no row is an error in one and passes in the other.
        Limits { calls: calls * Self::Full.budget() as u64 + more, ..Limits::default() }
    }
}
