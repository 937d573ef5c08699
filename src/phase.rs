//! The three phases of the motion (Section 2 of the paper).

use crate::unknown_name::UnknownName;
use std::fmt;
use std::str::FromStr;

/// The three ways in which the oscillator moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Phase {
    /// Mass and slider top move separately, p < q + g (Eq. 11).
    NoContact,
    /// They move together, the slider's bottom sticks, 0 < 2 xi y + q < 1 (Eq. 12).
    Contact,
    /// They move together, the slider's bottom slips, 2 xi y + q > 1 (Eq. 13).
    Progression,
}

impl Phase {
    /// All phases, in the order of the paper.
    pub const ALL: [Self; 3] = [Self::NoContact, Self::Contact, Self::Progression];

    /// The name used in files and on the command line.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::NoContact => "no-contact",
            Self::Contact => "contact",
            Self::Progression => "progression",
        }
    }
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Phase {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        UnknownName::find("phase", &Self::ALL, Self::as_str, name)
    }
}
