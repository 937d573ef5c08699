//! The entries of z that a name moves nowhere along a run, whatever its value.
//!
//! They are a part of the system that has its own start, matrices, and events: coefficients that
//! do not depend on the name, and no entry of the rest. What touches there touches for every value
//! of the name.

use super::first_order::VariedRow;
use crate::affine::model::system::{Mode, Row, StartPoint, Successor, System, row_times};
use crate::affine::model::tangent::Tangent;

/// The entries of z that do not depend on a name.
#[derive(Clone)]
pub struct Unmoved(Vec<bool>);

impl Unmoved {
    /// The largest part of a system that does not depend on the tangent's name, for a run from the
    /// system's own start: none where the system is not known for another value of the name.
    pub fn new(system: &System, tangent: &Tangent, start: &StartPoint) -> Self {
        let size = system.modes.first().map_or(0, |mode| mode.matrix.len());
        let none = || Self(vec![false; size]);
        let Some(nearby) = &tangent.nearby else { return none() };
        let Some(other) = &nearby.start else { return none() };
        let is_own = system.start.as_ref() == Some(start);
        if !is_own || other.time != start.time || nearby.forcing != system.forcing {
            return none();
        }
        // The angle and 1, which follow the states, begin alike by what is compared above.
        let begins_alike = |n: usize| start.state.get(n) == other.state.get(n);
        let mut unmoved = Self((0..size).map(begins_alike).collect());
        let is_moved = |unmoved: &Self, entry: usize| {
            let mut modes = system.modes.iter().zip(&nearby.modes);
            unmoved.0[entry] && !modes.all(|pair| unmoved.keeps(entry, pair, &system.modes))
        };
        while let Some(entry) = (0..size).find(|entry| is_moved(&unmoved, *entry)) {
            unmoved.0[entry] = false;
        }
        unmoved
    }

    /// Whether a row has the same value for every value of the name.
    pub fn has_row(&self, varied: &VariedRow<'_>) -> bool {
        varied.nearby.is_some_and(|nearby| self.is_alike(varied.row, nearby))
    }

    fn is_alike(&self, own: &Row, nearby: &Row) -> bool {
        own == nearby && own.iter().zip(&self.0).all(|(it, unmoved)| *unmoved || it.is_zero())
    }

    /// Whether an entry depends on unmoved ones alone, in a mode and through its events. Where the
    /// time of an event moves, the entry has to go on as if there were none.
    fn keeps(&self, entry: usize, (own, nearby): (&Mode, &Mode), modes: &[Mode]) -> bool {
        let mut events = own.until.iter().zip(&nearby.until);
        self.is_alike(&own.matrix[entry], &nearby.matrix[entry])
            && events.all(|(event, other)| {
                let row = &event.reset[entry];
                let goes_on = |next: &Successor| {
                    let after = row_times(&modes[next.mode].matrix[entry], &event.reset);
                    row_times(row, &own.matrix) == after
                };
                self.is_alike(row, &other.reset[entry])
                    && (self.is_alike(&event.guard, &other.guard) || event.next.iter().all(goes_on))
            })
    }
}
