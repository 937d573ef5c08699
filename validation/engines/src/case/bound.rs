//! The bounds and expected failures of engines on a case.

use crate::accuracy::Accuracy;
use regex::Regex;
use std::fmt;

/// The quantity that a bound limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Events that the engine does not have: of the exact continuations of its records, or of the
    /// truth for an exact engine.
    EventsMissed,
    /// Events of the engine that the exact continuations, or the truth, do not have.
    EventsSpurious,
    /// Events that are followed by another mode than in the exact continuations.
    EventsWrongMode,
    /// Largest |guard| at a state before a reset, in tolerances of the guard's size.
    Location,
    /// Largest contradiction between the states before and after a reset, in tolerances.
    Inconsistency,
    /// Largest defect of an event's time beside the exact continuation of the record before it, in
    /// units of the local judgement.
    TimeDefect,
    /// Largest defect of a state just after an event, in units of the local judgement.
    StateDefect,
    /// Largest defect of a state at an instant of output, in units of the local judgement.
    SampleDefect,
    /// Time by which states at instants of output are ahead of the exact continuations of the
    /// records before them, in tolerances of the time scale.
    SampleDelay,
    /// Number of differences between the engine's sequence of phases and the truth's (0 or 1).
    #[serde(rename = "phase_word")]
    PhaseSequence,
    /// Error of the matched events' times, units of time.
    EventTimeError,
    /// max(|dp|, |dy|, |dq|) on the fixed sample, units of displacement.
    StateError,
    /// |dv| at the scored horizon, units of displacement.
    DriftError,
    /// Largest error of an event's time or state over unit x (1 + size) x growth, where the size is
    /// that of the value, or of the largest state so far in a piecewise-affine system.
    EventConstant,
    /// Largest error of the sample's states over unit x (1 + size) x growth, where the size is that
    /// of the value, or of the largest state so far in a piecewise-affine system.
    StateConstant,
    /// Forcing periods until the state's error passes 1e-3 (a lower limit).
    ValidPeriods,
    /// Forcing periods by which valid horizons in chaos are longer than the truth's growth predicts
    /// (a lower limit).
    ValidGain,
    /// Error after one passage through the next events from states of the run, over
    /// unit x (1 + size) x growth, where the size is that of the value, or of the largest state so
    /// far in a piecewise-affine system.
    RestartError,
    /// The number of restarts without a result.
    RestartsFailed,
    /// Whether the run gave no result (0 or 1).
    RunsFailed,
    /// The largest distance of the section from the reference's, over its calibrated limit.
    AttractorDistance,
}

impl Quantity {
    /// The quantity in words, as reasons name it.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::EventsMissed => "events missed",
            Self::EventsSpurious => "spurious events",
            Self::EventsWrongMode => "wrong modes",
            Self::Location => "location of events",
            Self::Inconsistency => "inconsistency",
            Self::TimeDefect => "defect of event times",
            Self::StateDefect => "defect of states after events",
            Self::SampleDefect => "defect of sampled states",
            Self::SampleDelay => "delay of sampled states",
            Self::PhaseSequence => "phase word",
            Self::EventTimeError => "event time error",
            Self::StateError => "state error",
            Self::DriftError => "drift error",
            Self::EventConstant => "event constant",
            Self::StateConstant => "state constant",
            Self::ValidPeriods => "valid periods",
            Self::ValidGain => "valid gain",
            Self::RestartError => "restart error",
            Self::RestartsFailed => "restarts failed",
            Self::RunsFailed => "runs failed",
            Self::AttractorDistance => "attractor distance",
        }
    }

    /// A statistic of the quantity in words, as reasons name it.
    #[must_use]
    pub fn words_of(self, statistic: Statistic) -> String {
        let words = self.words();
        match statistic {
            Statistic::Median => format!("median {words}"),
            Statistic::Q99 => format!("99 % quantile of the {words}"),
            Statistic::Max if self.has_a_median() => format!("largest {words}"),
            Statistic::Max | Statistic::Value => words.to_owned(),
        }
    }

    /// Whether other statistics than the largest are measured.
    const fn has_a_median(self) -> bool {
        matches!(
            self,
            Self::EventTimeError | Self::StateError | Self::RestartError | Self::SampleDelay
        )
    }

    /// Whether a bound on the quantity is a lower limit.
    #[must_use]
    pub const fn is_to_be_large(self) -> bool {
        matches!(self, Self::ValidPeriods | Self::ValidGain)
    }
}

/// A statistic of a distribution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Statistic {
    /// The median.
    Median,
    /// The 99th percentile.
    Q99,
    /// The largest.
    Max,
    /// The only value of a quantity that has no distribution.
    Value,
}

/// The names of engines or cases that something is said of.
#[derive(Clone, Debug)]
pub enum NamePattern {
    /// Every name.
    Any,
    /// The one name. Thousands of rows say theirs, and a comparison costs less than an expression.
    Exactly(String),
    /// The names that a regular expression matches.
    Matching(Regex),
}

impl NamePattern {
    /// Whether the pattern includes a name.
    #[must_use]
    pub fn includes(&self, name: &str) -> bool {
        match self {
            Self::Any => true,
            Self::Exactly(own) => own == name,
            Self::Matching(pattern) => pattern.is_match(name),
        }
    }
}

impl fmt::Display for NamePattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Any => f.write_str(".*"),
            Self::Exactly(name) => f.write_str(name),
            Self::Matching(pattern) => f.write_str(pattern.as_str()),
        }
    }
}

/// A limit with its reason.
#[derive(Clone, Debug)]
pub struct Bound {
    /// The engines to which this applies.
    pub engine: NamePattern,
    /// The tolerances or steps to which this applies; all where none is given.
    pub at: Vec<Accuracy>,
    /// The quantity that is bounded.
    pub quantity: Quantity,
    /// The statistic of the quantity.
    pub statistic: Statistic,
    /// The limit, in the quantity's unit.
    pub limit: f64,
    /// Whether the engine's unit of error, its tolerance, multiplies the limit.
    pub times_tolerance: bool,
    /// The reason.
    pub why: String,
}

/// An expected failure of an engine: the one quantity of a row that it excuses.
#[derive(Clone, Debug)]
pub struct Shortcoming {
    /// Cases it is for, where it does not stand in one.
    pub case: Option<NamePattern>,
    /// The engines to which this applies.
    pub engine: NamePattern,
    /// The tolerances or steps to which this applies; all where none is given.
    pub at: Vec<Accuracy>,
    /// The quantity that is out of bounds.
    pub quantity: Quantity,
    /// The statistic of the quantity.
    pub statistic: Statistic,
    /// The figure is at least this, or the shortcoming no longer shows.
    pub at_least: f64,
    /// The figure is at most this, or it is worse than what is known.
    pub at_most: f64,
    /// The reason.
    pub why: String,
}

impl Bound {
    /// Whether the bound is for this engine when it is as accurate as this.
    #[must_use]
    pub fn is_for(&self, engine: &str, accuracy: Accuracy) -> bool {
        applies(&self.engine, &self.at, engine, accuracy)
    }
}

impl Shortcoming {
    /// Whether it is said of this engine on this case when it is as accurate as this.
    #[must_use]
    pub fn is_for(&self, case: &str, engine: &str, accuracy: Accuracy) -> bool {
        self.case.as_ref().is_none_or(|pattern| pattern.includes(case))
            && applies(&self.engine, &self.at, engine, accuracy)
    }
}

fn applies(pattern: &NamePattern, at: &[Accuracy], engine: &str, accuracy: Accuracy) -> bool {
    (at.is_empty() || at.contains(&accuracy)) && pattern.includes(engine)
}
