//! What a scoreboard needs of a report.

use anyhow::{Context, Result};
use serde::Deserialize;

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
    pub(crate) events_matched: Option<u64>,
    pub(crate) events_spurious: Option<u64>,
    pub(crate) rhs_evaluations: Option<u64>,
    pub(crate) wall_ns: Option<u64>,
    pub(crate) own_ns: Option<u64>,
    pub(crate) verdict: String,
}

/// Reads a report.
pub(crate) fn report(path: &str) -> Result<ReportJson> {
    let text = std::fs::read_to_string(path).with_context(|| path.to_owned())?;
    serde_json::from_str(&text).with_context(|| format!("{path} is no report.json of this version"))
}
