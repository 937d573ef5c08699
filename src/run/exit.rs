//! How a phase ends.

use crate::model::entry::Entry;
use std::fmt;

/// Why a phase has no end.
///
/// It stands in an [`Exit`] where a switch has other numbers. Behind a byte those would be copied
/// across the words in which they were written, for which a processor has to wait; so it is a whole
/// word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Endless {
    /// The mass never returns to the slider (b too small).
    NeverReturns,
    /// The slider's bottom never stops (b too large).
    NeverStops,
    /// The mass rests on the slider for ever (a small).
    RestsForEver,
}

impl Endless {
    /// The name in words.
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

/// How a phase ends.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Exit {
    /// The phase ends by a switch, and the next phase begins at this entry.
    Switch(Entry),
    /// The phase does not end before the horizon; without a horizon, not before a forcing angle of
    /// 1e30 has passed.
    Horizon,
    /// Never: proved.
    Endless(Endless),
    /// It is not decided how the phase ends: the search has taken more work than its limit because
    /// rounding hides what the phase does. It is proved to last for [`Segment::duration`](crate::Segment::duration); nothing
    /// is known of what follows.
    Undecidable,
}
