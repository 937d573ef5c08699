//! How long a start is followed, and how long an orbit may be.

use crate::dynamics::orbit::LARGEST_PERIOD;

/// The longest period that is looked for where no other is asked for.
pub const DEFAULT_MAX_PERIOD: u32 = 1024;

/// The limits of a search for attractors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SearchLimits {
    /// Forcing periods that a start is followed, and 2, 4 and 8 times as many more where it is not
    /// recognised by then.
    pub transient: u64,
    /// The longest period of an orbit, in forcing periods.
    pub max_period: u32,
}

impl From<u64> for SearchLimits {
    /// A transient, with orbits of up to [`DEFAULT_MAX_PERIOD`].
    fn from(transient: u64) -> Self {
        Self { transient, max_period: DEFAULT_MAX_PERIOD }
    }
}

impl SearchLimits {
    /// These limits, at least one period and at most what Newton's method is made for.
    pub(crate) fn clamped(self) -> Self {
        Self {
            transient: self.transient.max(1),
            max_period: self.max_period.clamp(1, LARGEST_PERIOD),
        }
    }

    /// The number of returns in which an orbit of the longest period repeats once.
    pub(crate) const fn returns(self) -> u64 {
        2 * self.max_period as u64
    }
}
