//! Verdicts on answered derivatives, as rows of the report and counted by engine.

use crate::gradients::{GradientJudgement, Verdict};
use serde::Serialize;

/// The verdict on the derivatives by one name of a case, at one tolerance of an engine.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs, reason = "the keys are those of the command line's contract")]
pub struct GradientEntry {
    pub engine: &'static str,
    pub case: String,
    pub wrt: String,
    pub tolerance: f64,
    #[serde(serialize_with = "as_word")]
    pub verdict: Verdict,
    /// The wrong rule at events, where it is recognised.
    pub missing_term: Option<&'static str>,
    pub why: String,
}

fn as_word<S: serde::Serializer>(verdict: &Verdict, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(verdict.as_str())
}

impl From<GradientJudgement> for GradientEntry {
    fn from(row: GradientJudgement) -> Self {
        let GradientJudgement { engine, case, judged } = row;
        Self {
            engine,
            case,
            wrt: judged.wrt,
            tolerance: judged.tolerance,
            verdict: judged.verdict,
            missing_term: judged.missing_term.map(crate::gradients::Mechanism::as_str),
            why: judged.why,
        }
    }
}

/// The verdicts on one engine's derivatives.
#[derive(Clone, Debug)]
pub struct GradientCounts {
    /// The engine's name.
    pub engine: &'static str,
    /// The number of verdicts of each kind, in the order of [`Verdict::ALL`].
    pub counts: [usize; 7],
    /// The first missing term, with its case and name.
    pub missing: String,
}

impl GradientCounts {
    /// The counts of all engines, in the order of their first rows.
    #[must_use]
    pub fn all(rows: &[GradientEntry]) -> Vec<Self> {
        let mut names: Vec<&'static str> = Vec::new();
        for row in rows {
            if !names.contains(&row.engine) {
                names.push(row.engine);
            }
        }
        names.into_iter().map(|engine| Self::new(engine, rows)).collect()
    }

    fn new(engine: &'static str, rows: &[GradientEntry]) -> Self {
        let own: Vec<&GradientEntry> = rows.iter().filter(|it| it.engine == engine).collect();
        let counts = Verdict::ALL.map(|kind| own.iter().filter(|it| it.verdict == kind).count());
        let missing = own.iter().find_map(|it| {
            it.missing_term.map(|term| format!("{term}: {} by {}", it.case, it.wrt))
        });
        Self { engine, counts, missing: missing.unwrap_or_default() }
    }
}
