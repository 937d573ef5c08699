//! A claim of the paper beside our result.

use super::paper::Paper;
use crate::engine::Failure;
use serde::{Deserialize, Serialize};

/// The verdict on a claim of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClaimVerdict {
    /// Our computation agrees with the paper.
    Reproduced,
    /// Our computation differs from the paper.
    Differs,
    /// Our computation cannot decide the claim, for a stated reason.
    NotDetermined,
}

/// A method and its finding.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClaimEvidence {
    /// The method, with its settings.
    pub method: String,
    /// The finding.
    pub finding: String,
}

/// A claim of the paper with its verdict.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Claim {
    /// The claim's name.
    pub id: String,
    /// The paper's statement.
    pub paper: String,
    /// Our result.
    pub computed: String,
    /// The verdict on the claim.
    pub verdict: ClaimVerdict,
    /// The reason for the verdict, and the assumptions.
    pub note: String,
    /// Methods and their findings.
    pub evidence: Vec<ClaimEvidence>,
}

impl Claim {
    /// A claim of the paper with our result.
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
    /// The verdict `reproduced` if everything that was checked holds.
    #[must_use]
    pub const fn new(holds: bool) -> Self {
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
