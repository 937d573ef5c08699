//! The parts of a report beside its rows: distributions, curves and clouds that a row has no room
//! for.
//!
//! Any part may be empty; the report then says that it was not run.

use super::EventPicture;
use crate::case::Case;
use serde::Serialize;

/// The model of the paper, which is no system of a file.
pub const OSCILLATOR: &str = "oscillator";
/// The flag of [`ReportEvidence::folders`] that says that the cases are a user's own.
pub const CASES_FLAG: &str = "--cases";

/// Everything that is shown beside the rows.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ReportEvidence {
    /// The cases that were run.
    pub cases: Vec<CaseNote>,
    /// The names of the cases without tables, whose truth is the exact solver's run made again in
    /// 106 bits.
    pub replayed: Vec<String>,
    /// Errors along chaotic runs.
    pub growth: Vec<ErrorGrowth>,
    /// Errors of the restart test.
    pub restarts: Vec<RestartHistogram>,
    /// Near misses and light touches; where there are none they are read off the rows of cases with
    /// a margin.
    pub grazes: Vec<GrazeRow>,
    /// Poincare sections of the exact solver and of direct integration.
    pub sections: Vec<SectionPair>,
    /// Deliberately wrong engines, with the gates that caught them.
    pub faults: Vec<FaultRow>,
    /// Rows that got worse than in the baseline, one line per row.
    pub worse: Vec<String>,
    /// Rows that take many more right-hand sides than in the baseline, with how many more.
    pub dearer: Vec<String>,
    /// Flags with their folders, and other words, that a command needs to repeat a row on the same
    /// data.
    pub folders: Vec<(&'static str, String)>,
    /// The first missed or spurious event of rows.
    pub events: Vec<EventPicture>,
}

/// The description of a case in the report.
#[derive(Clone, Debug, Default, Serialize)]
pub struct CaseNote {
    /// The case's name.
    pub name: String,
    /// The file it stands in, as seen from the repository's root for cases inside the binary.
    pub file: String,
    /// The text of the case's file.
    pub toml: String,
    /// The system whose case it is; `oscillator` for the paper's.
    pub system: String,
    /// The names of the states whose errors are measured.
    pub states: Vec<String>,
    /// The regime it stands for, or the kinds of trouble that it makes.
    pub regime: String,
    /// The kinds of trouble that a system's case makes; none of the oscillator's.
    pub trouble: Vec<String>,
    /// The reason for the case.
    pub why: String,
    /// How far the gap's first maximum reaches beyond the surface (negative: stays short of it).
    pub margin: Option<f64>,
}

/// The error of one run over time, beside the truth's own growth.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ErrorGrowth {
    /// The case.
    pub case: String,
    /// The engine.
    pub engine: String,
    /// The engine's tolerance, where it has one.
    pub tolerance: Option<f64>,
    /// Instants, in forcing periods since the start.
    pub periods: Vec<f64>,
    /// max(|dp|, |dy|, |dq|) at those instants.
    pub error: Vec<f64>,
    /// The engine's unit of error times the growth of the truth up to those instants.
    pub truth_growth: Vec<f64>,
    /// The largest Lyapunov exponent per forcing period, where it is known.
    pub lambda_per_period: Option<f64>,
}

/// The distribution of the errors of one engine's restarts.
#[derive(Clone, Debug, Default, Serialize)]
pub struct RestartHistogram {
    /// The case whose attractor the states lie on.
    pub case: String,
    /// The engine.
    pub engine: String,
    /// The engine's tolerance, where it has one.
    pub tolerance: Option<f64>,
    /// Edges of the bins, one more than counts: log10 of the error in `unit`.
    pub edges: Vec<f64>,
    /// Runs in each bin.
    pub counts: Vec<u64>,
    /// The unit of the errors, in words.
    pub unit: String,
}

/// An engine's result on a near miss or a light touch.
#[derive(Clone, Debug, Default, Serialize)]
pub struct GrazeRow {
    /// The case.
    pub case: String,
    /// How far the gap's first maximum reaches beyond the surface (negative: stays short of it).
    pub margin: f64,
    /// The engine.
    pub engine: String,
    /// The engine's tolerance, where it has one.
    pub tolerance: Option<f64>,
    /// The number of missed events.
    pub missed: usize,
    /// The number of spurious events.
    pub spurious: usize,
}

/// An attractor twice, as points (p, y) of its Poincare section.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SectionPair {
    /// Forcing frequency.
    pub omega: f64,
    /// Damping ratio.
    pub xi: f64,
    /// The points of the exact solver.
    pub exact: Vec<[f64; 2]>,
    /// The points of a direct integration.
    pub direct: Vec<[f64; 2]>,
    /// The engine that made the direct run.
    pub direct_engine: String,
    /// Distances between the two: name, value, limit.
    pub distances: Vec<(String, f64, f64)>,
}

/// A deliberately wrong engine.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FaultRow {
    /// The engine.
    pub engine: String,
    /// The fault, in words.
    pub fault: String,
    /// The gates that were applied: name, whether the fault was caught, and the figure that tells.
    pub gates: Vec<(String, bool, String)>,
}

impl CaseNote {
    /// What this case says of itself; `embedded`: it stands inside the binary.
    #[must_use]
    pub fn new(case: &Case, embedded: bool) -> Self {
        let folder = if embedded { "validation/" } else { "" };
        let system = if case.oscillator.is_some() { OSCILLATOR } else { &case.system.name };
        Self {
            name: case.name.clone(),
            file: format!("{folder}{}", case.file),
            toml: case.text.clone(),
            system: system.to_owned(),
            states: case.system.states.clone(),
            regime: case.kind(", "),
            why: case.why.clone(),
            margin: case.oscillator.as_ref().and_then(|it| it.margin),
            trouble: case.trouble.clone(),
        }
    }
}
