//! What a scoreboard needs of a report.

use super::blocks;
use anyhow::{Context, Result};
use serde::Deserialize;
use std::path::Path;

/// A report.
#[derive(Deserialize)]
pub(crate) struct ReportJson {
    pub(crate) percuss: String,
    pub(crate) commit: Option<String>,
    pub(crate) cpu: String,
    pub(crate) engines: Vec<EngineJson>,
    pub(crate) results: Vec<RowJson>,
}

/// An engine of a report.
#[derive(Clone, Deserialize)]
pub(crate) struct EngineJson {
    pub(crate) name: String,
    pub(crate) library: String,
    pub(crate) version: String,
    pub(crate) language: String,
}

/// A row of a report.
#[derive(Clone, Deserialize)]
pub(crate) struct RowJson {
    pub(crate) case: String,
    pub(crate) trouble: Vec<String>,
    pub(crate) engine: String,
    pub(crate) tolerance: Option<f64>,
    pub(crate) events_total: u64,
    #[serde(default)]
    pub(crate) events_judged: Option<u64>,
    #[serde(default)]
    pub(crate) events_right: Option<u64>,
    #[serde(default)]
    pub(crate) events_undecidable: Option<u64>,
    pub(crate) events_spurious: Option<u64>,
    pub(crate) rhs_evaluations: Option<u64>,
    pub(crate) wall_ns: Option<u64>,
    pub(crate) own_ns: Option<u64>,
    pub(crate) verdict: String,
    #[serde(default)]
    pub(crate) step: Option<f64>,
    #[serde(default)]
    pub(crate) defect: DefectJson,
}

/// The defects of a row's records.
#[derive(Clone, Default, Deserialize)]
pub(crate) struct DefectJson {
    pub(crate) sample: QuantilesJson,
}

/// The quantiles of one kind of defect.
#[derive(Clone, Default, Deserialize)]
pub(crate) struct QuantilesJson {
    pub(crate) max: Option<f64>,
}

impl RowJson {
    /// Whether the row is wholly right, as the ranking has it.
    pub(crate) fn is_right(&self) -> bool {
        let within = ["pass", "undecidable"].contains(&self.verdict.as_str());
        let is_exact = self.tolerance.is_none() && self.step.is_none();
        within && (is_exact || self.defect.sample.max.is_some())
    }

    /// Whether nothing excuses that it is out of bounds, or without a result.
    pub(crate) fn is_unexpected(&self) -> bool {
        ["fail", "error"].contains(&self.verdict.as_str())
    }
}

/// Reads a report.
pub(crate) fn report(path: &Path) -> Result<ReportJson> {
    blocks::read_json(path).context("a report has to be of this version")
}
