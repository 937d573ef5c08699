//! The endings of runs, whose names no event may have.

use crate::unknown_name::UnknownName;
use std::fmt;
use std::str::FromStr;

/// The ending of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Ending {
    /// The time that was asked for is reached.
    #[default]
    Horizon,
    /// Infinitely many impacts accumulate, between the two times of
    /// [`Event::accumulation`](crate::Event::accumulation).
    Accumulation,
    /// A run back in time reaches the boundary of its mode.
    LeavesDomain,
    /// Too many events lie in one instant: the motion slides, chatters or repeats an event.
    NoProgress,
    /// A mode is entered where one of its guards is positive already.
    BeyondGuard,
    /// The arithmetic has too few digits to decide which event is next.
    Undecided,
}

impl Ending {
    /// All endings.
    pub const ALL: [Self; 6] = [
        Self::Horizon,
        Self::Accumulation,
        Self::LeavesDomain,
        Self::NoProgress,
        Self::BeyondGuard,
        Self::Undecided,
    ];

    /// The name, which no event of a system may have.
    ///
    /// ```
    /// use percuss::Ending;
    ///
    /// assert_eq!(Ending::Horizon.as_str(), "end");
    /// assert_eq!("accumulation".parse(), Ok(Ending::Accumulation));
    /// ```
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Horizon => "end",
            Self::Accumulation => "accumulation",
            Self::LeavesDomain => "leaves-domain",
            Self::NoProgress => "no-progress",
            Self::BeyondGuard => "beyond-guard",
            Self::Undecided => "undecided",
        }
    }

    /// Whether the run ends because the model says so or the time is over, and not because the
    /// solver could not go on.
    #[must_use]
    pub const fn is_decided(self) -> bool {
        matches!(self, Self::Horizon | Self::Accumulation | Self::LeavesDomain)
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Ending {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        UnknownName::find("ending", &Self::ALL, Self::as_str, name)
    }
}
