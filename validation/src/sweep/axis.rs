//! The parameters that vary in a sweep.

use percuss::Parameter;
use serde::{Deserialize, Serialize};
use std::fmt;

/// One parameter that takes equally spaced values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepAxis {
    /// The name of the parameter that varies.
    pub parameter: String,
    /// The first value.
    pub from: f64,
    /// The last value, which may be the smaller one.
    pub to: f64,
    /// The number of values, both ends included.
    pub steps: u32,
}

impl SweepAxis {
    /// The value at a step; the last one is `to` exactly.
    #[must_use]
    pub fn value(&self, step: u32) -> f64 {
        if step + 1 >= self.steps && step > 0 {
            return self.to;
        }
        let share = f64::from(step) / f64::from(self.steps.max(2) - 1);
        self.from + share * (self.to - self.from)
    }
}

/// One combination of the values of a sweep's axes.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// The number of the point; the last axis varies fastest.
    pub number: u64,
    /// The names of the parameters that vary, and their values.
    pub values: Vec<(String, f64)>,
}

impl SweepPoint {
    /// The values of the impact oscillator's parameters: all, in a plan without a system.
    pub fn of_oscillator(&self) -> impl Iterator<Item = (Parameter, f64)> {
        self.values.iter().filter_map(|(name, value)| Some((name.parse().ok()?, *value)))
    }
}

impl fmt::Display for SweepPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values = self.values.iter().map(|(name, value)| format!("{name} = {value}"));
        f.write_str(&values.collect::<Vec<_>>().join(", "))
    }
}
