//! Events as matching sees them, of the oscillator and of any other system alike.

/// The time and the identity of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence {
    /// Time since the start.
    pub elapsed: f64,
    /// The number of the event's name; zero throughout in the oscillator, whose events are told
    /// apart by the phases that begin.
    pub event: usize,
    /// The mode that begins; `None` where it does not count, and at the end of a run.
    pub mode: Option<usize>,
}

impl Occurrence {
    /// Whether two events may be the same but for their time.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        let free = self.mode.is_none() || other.mode.is_none();
        self.event == other.event && (free || self.mode == other.mode)
    }
}
