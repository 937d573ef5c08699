//! How a segment ends.

use crate::model::entry::Entry;
use crate::unknown_name::UnknownName;
use std::fmt;
use std::str::FromStr;

/// Why a phase has no end.
// A whole word: a switch has other numbers at its place in an `Exit`. Behind a byte those would be
// copied across the words in which they were written, for which a processor has to wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(u64)]
pub enum Endless {
    /// The mass never returns to the slider (b too small).
    #[cfg_attr(feature = "serde", serde(rename = "never returns"))]
    NeverReturns,
    /// The slider's bottom never stops (b too large).
    #[cfg_attr(feature = "serde", serde(rename = "never stops"))]
    NeverStops,
    /// The mass rests on the slider for ever (a small).
    #[cfg_attr(feature = "serde", serde(rename = "rests for ever"))]
    RestsForEver,
}

impl Endless {
    /// All reasons for which a phase never ends.
    pub const ALL: [Self; 3] = [Self::NeverReturns, Self::NeverStops, Self::RestsForEver];

    /// The reason in words.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::NeverReturns => "never returns",
            Self::NeverStops => "never stops",
            Self::RestsForEver => "rests for ever",
        }
    }
}

impl fmt::Display for Endless {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Endless {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        UnknownName::find("reason for a phase without end", &Self::ALL, Self::as_str, name)
    }
}

/// How a segment ends.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Exit {
    /// The phase ends by a switch, and the next phase begins at this entry.
    Switch(Entry),
    /// The phase does not end before the horizon; without a horizon, not before a forcing angle of
    /// 1e30 has passed.
    Horizon,
    /// It is proved that the phase never ends.
    Endless(Endless),
    /// The search has exceeded its limit of work, because rounding hides what the guard does. The
    /// phase is proved to last for [`Segment::duration`](crate::Segment::duration); what follows is
    /// not known.
    Undecidable,
}
