//! What a scoreboard needs of a report.

use anyhow::{Context, Result};
use serde::Deserialize;

/// A report.
#[derive(Deserialize)]
pub struct Report {
    pub percuss: String,
    pub commit: Option<String>,
    pub cpu: String,
    pub engines: Vec<Engine>,
    pub results: Vec<Row>,
}

/// An engine of a report.
#[derive(Clone, Deserialize)]
pub struct Engine {
    pub name: String,
    pub library: String,
    pub version: String,
    pub language: String,
}

/// A row of a report.
#[derive(Clone, Deserialize)]
pub struct Row {
    pub case: String,
    pub trouble: Vec<String>,
    pub engine: String,
    pub tolerance: Option<f64>,
    pub events_total: u64,
    pub events_matched: Option<u64>,
    pub events_spurious: Option<u64>,
    pub rhs_evaluations: Option<u64>,
    pub wall_ns: Option<u64>,
    pub own_ns: Option<u64>,
    pub verdict: String,
}

/// Reads a report.
pub fn report(path: &str) -> Result<Report> {
    let text = std::fs::read_to_string(path).with_context(|| path.to_owned())?;
    serde_json::from_str(&text).with_context(|| format!("{path} is no report.json of this version"))
}
