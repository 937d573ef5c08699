//! Events as matching sees them, of the oscillator and of any other system alike.

use crate::engine::{Event, place};
use crate::truth::TruthRow;

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

impl From<&TruthRow> for Occurrence {
    fn from(row: &TruthRow) -> Self {
        Self { elapsed: row.elapsed.value(), event: 0, mode: row.phase.map(place) }
    }
}

impl From<&Event> for Occurrence {
    fn from(event: &Event) -> Self {
        Self { elapsed: event.elapsed, event: 0, mode: Some(event.mode) }
    }
}

/// Events as matching sees them.
pub fn occurrences<'a, T: 'a>(events: impl IntoIterator<Item = &'a T>) -> Vec<Occurrence>
where
    Occurrence: From<&'a T>,
{
    events.into_iter().map(Occurrence::from).collect()
}
