//! The limits of the distances, as `attractors.toml` holds them.

use crate::case::FileError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

const FILE: &str = include_str!("../../../attractors.toml");

/// The plan of the comparison on one case.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ComparisonPlan {
    /// The transient: forcing periods that are left out.
    pub transient: u32,
    /// Forcing periods of an engine's section.
    pub periods: u32,
    /// Forcing periods of the reference section.
    pub reference_periods: u32,
}

/// A case's plan and the limits that belong to it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Calibrated {
    /// The case.
    pub case: String,
    /// The plan of the runs.
    pub plan: ComparisonPlan,
    /// The limit of each distance.
    pub limits: BTreeMap<String, f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LimitsFile {
    attractors: Vec<Calibrated>,
}

/// The limits of every case that has some.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn calibrated() -> Result<Vec<Calibrated>, FileError> {
    let file: LimitsFile = toml::from_str(FILE)
        .map_err(|error| FileError(format!("attractors.toml: {}", error.message())))?;
    Ok(file.attractors)
}
