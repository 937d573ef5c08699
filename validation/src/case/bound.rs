//! What is expected of an engine on a case.

use regex::Regex;

/// What a bound is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Switches of the truth that the engine does not have.
    EventsMissed,
    /// Switches of the engine that the truth does not have.
    EventsSpurious,
    /// Number of differences between the engine's sequence of phases and the truth's (0 or 1).
    PhaseWord,
    /// Error of the matched switches' times, units of time.
    EventTimeError,
    /// max(|dp|, |dy|, |dq|) on the fixed sample, units of displacement.
    StateError,
    /// |dv| at the scored horizon, units of displacement.
    DriftError,
    /// Largest error of a switch's time or state over unit x (1 + |value|) x growth x number of switches.
    EventConstant,
    /// The same of the sample's states.
    StateConstant,
    /// Forcing periods until the state's error passes 1e-3 (a lower limit).
    ValidPeriods,
}

/// Which figure of a distribution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Statistic {
    /// The middle value.
    Median,
    /// 99 % are at most this.
    Q99,
    /// The largest.
    Max,
    /// The one number there is.
    Value,
}

/// A limit, and why it is that.
#[derive(Clone, Debug)]
pub struct Bound {
    /// Engines it is for.
    pub engine: Regex,
    /// The one tolerance it is for; all where none is given.
    pub tolerance: Option<f64>,
    /// What is bounded.
    pub quantity: Quantity,
    /// Which figure of it.
    pub statistic: Statistic,
    /// The limit, in the quantity's unit.
    pub limit: f64,
    /// Whether the engine's tolerance multiplies the limit.
    pub times_tolerance: bool,
    /// The reason.
    pub why: String,
}

/// What is known not to work, so that it is neither a failure nor forgotten.
#[derive(Clone, Debug)]
pub struct Shortcoming {
    /// Engines it is for.
    pub engine: Regex,
    /// The one tolerance it is for; all where none is given.
    pub tolerance: Option<f64>,
    /// What shows it; `None`: the engine fails.
    pub shows: Option<(Quantity, Statistic, f64)>,
    /// The reason.
    pub why: String,
}

impl Bound {
    /// Whether the bound is for this engine at this tolerance.
    #[must_use]
    pub fn is_for(&self, engine: &str, tolerance: Option<f64>) -> bool {
        applies(&self.engine, self.tolerance, engine, tolerance)
    }
}

impl Shortcoming {
    /// Whether it is said of this engine at this tolerance.
    #[must_use]
    pub fn is_for(&self, engine: &str, tolerance: Option<f64>) -> bool {
        applies(&self.engine, self.tolerance, engine, tolerance)
    }
}

fn applies(pattern: &Regex, only: Option<f64>, engine: &str, tolerance: Option<f64>) -> bool {
    pattern.is_match(engine) && (only.is_none() || only == tolerance)
}
