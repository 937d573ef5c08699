//! A claim of the paper beside what we find.

use super::paper::Paper;
use crate::engine::Failure;
use serde::{Deserialize, Serialize};

/// How a claim stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClaimVerdict {
    /// Our computation says the same.
    Reproduced,
    /// It says something else.
    Differs,
    /// It cannot tell, for a stated reason.
    NotDetermined,
}

/// How something was found, and what.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClaimEvidence {
    /// The method, with its settings.
    pub method: String,
    /// What it gave.
    pub finding: String,
}

/// A claim of the paper with its verdict.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Claim {
    /// The claim's name.
    pub id: String,
    /// What the paper says.
    pub paper: String,
    /// What we find.
    pub computed: String,
    /// How it stands.
    pub verdict: ClaimVerdict,
    /// Why, and what is assumed.
    pub note: String,
    /// Methods and their findings.
    pub evidence: Vec<ClaimEvidence>,
}

impl Claim {
    /// A claim with what we find.
    ///
    /// # Errors
    /// An id that the paper's side does not have.
    pub fn settle(
        paper: &Paper,
        id: &str,
        verdict: ClaimVerdict,
        computed: impl Into<String>,
    ) -> Result<Self, Failure> {
        let says = paper.claim(id)?.says.clone();
        Ok(Self {
            id: id.to_owned(),
            paper: says,
            computed: computed.into(),
            verdict,
            note: String::new(),
            evidence: Vec::new(),
        })
    }

    /// Adds a note.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Adds one more method and its finding.
    #[must_use]
    pub fn evidence(mut self, method: impl Into<String>, finding: impl Into<String>) -> Self {
        self.evidence.push(ClaimEvidence { method: method.into(), finding: finding.into() });
        self
    }
}

impl ClaimVerdict {
    /// Reproduced if all that was checked holds.
    #[must_use]
    pub const fn of(holds: bool) -> Self {
        if holds { Self::Reproduced } else { Self::Differs }
    }

    /// The verdict's word, as in files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Differs => "differs",
            Self::NotDetermined => "not-determined",
        }
    }
}
