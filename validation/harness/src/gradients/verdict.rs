//! Verdicts on answered derivatives.

use super::mechanism::Mechanism;
use std::fmt;

/// The verdict on the derivatives by a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Every cell is within its allowance.
    Right,
    /// Cells are off by more than the tolerance allows, and it falls with it as far as is known.
    Noisy,
    /// The error does not fall with the tolerance, though that of the events does.
    WrongLimit,
    /// All derivatives are zero, where the true ones are not.
    Zero,
    /// The derivatives are those that one wrong rule at events gives.
    MissingTerm,
    /// There is no answer by this name, or none at the end.
    Refused,
    /// Nothing was asked by this name at this tolerance, or the answers have no derivatives.
    NoneAsked,
}

impl Verdict {
    /// All of them, in the order of tables.
    pub const ALL: [Self; 7] = [
        Self::Right,
        Self::Noisy,
        Self::WrongLimit,
        Self::Zero,
        Self::MissingTerm,
        Self::Refused,
        Self::NoneAsked,
    ];

    /// The name in reports.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Noisy => "noisy",
            Self::WrongLimit => "wrong-limit",
            Self::Zero => "zero",
            Self::MissingTerm => "missing-term",
            Self::Refused => "refused",
            Self::NoneAsked => "none-asked",
        }
    }

    /// Whether derivatives were given that are not right.
    #[must_use]
    pub const fn is_wrong(self) -> bool {
        matches!(self, Self::Noisy | Self::WrongLimit | Self::Zero | Self::MissingTerm)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// The verdict on one name of a case at a tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// The name by which is differentiated.
    pub wrt: String,
    /// The tolerance.
    pub tolerance: f64,
    /// The verdict.
    pub verdict: Verdict,
    /// The wrong rule, where it is recognised.
    pub missing_term: Option<Mechanism>,
    /// The reason.
    pub why: String,
}
