//! What fewer bits knew of a run that they left undecided: of its motion, and of what they left
//! open, more bits may know less.

use super::row::EventRow;
use crate::truth::DoubleDouble;
use percuss::affine::Event;
use percuss::number::Number;

/// What is known of a run that needs more bits.
#[derive(Default)]
pub(super) struct LeftOpen {
    /// The number of rows that are decided: they are not given out again.
    pub(super) rows: usize,
    /// The last row of those runs that were left undecided which is the latest.
    pub(super) last: Option<LastRow>,
    /// What rounding left open, in words, where a guard could be named.
    pub(super) open: Option<String>,
}

/// A last row whose event is `undecided`, with that event.
#[derive(Clone)]
pub(super) struct LastRow {
    pub(super) row: EventRow,
    pub(super) event: Event<DoubleDouble>,
}

impl LastRow {
    /// Whether the motion is known farther by this row than by another one, in a run whose times
    /// increase or decrease.
    pub(super) fn is_later(&self, other: &Self, is_backward: bool) -> bool {
        let elapsed = (self.event.time.value() - other.event.time.value()).to_f64();
        let elapsed = if is_backward { -elapsed } else { elapsed };
        (self.row.n, elapsed) > (other.row.n, 0.0)
    }

    /// The later one of two rows, the first where they are of one time.
    pub(super) fn latest(own: Self, other: Option<Self>, is_backward: bool) -> Self {
        other.filter(|it| it.is_later(&own, is_backward)).unwrap_or(own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percuss::affine::{Ending, Time, What};

    fn row(n: usize, time: f64) -> LastRow {
        let time_cell = format!("{time}");
        let (event, mode) = ("undecided".to_owned(), "only".to_owned());
        let zero = DoubleDouble::exact(0.0);
        LastRow {
            row: EventRow { n, time: time_cell, event, mode, state: Vec::new() },
            event: Event {
                what: What::End(Ending::Undecided),
                time: Time { high: DoubleDouble::exact(time), low: zero },
                state: Vec::new(),
                mode: 0,
                errors: None,
            },
        }
    }

    #[test]
    fn the_latest_row_is_kept() {
        let kept = |own: LastRow, other: LastRow, is_backward: bool| {
            LastRow::latest(own, Some(other), is_backward).row.time
        };
        assert_eq!(kept(row(3, 1.5), row(3, 1.75), false), "1.75");
        assert_eq!(kept(row(3, 1.75), row(3, 1.5), false), "1.75");
        assert_eq!(kept(row(3, 1.75), row(3, 1.5), true), "1.5");
        assert_eq!(kept(row(4, 1.5), row(3, 1.75), false), "1.5");
        assert_eq!(kept(row(4, 1.5), row(5, 1.5), false), "1.5");
        assert_eq!(LastRow::latest(row(1, 2.0), None, true).row.time, "2");
    }

    #[test]
    fn more_rows_are_known_farther() {
        assert!(row(5, 1.5).is_later(&row(4, 1.5), false));
        assert!(row(5, 1.5).is_later(&row(4, 1.5), true));
        assert!(!row(4, 1.5).is_later(&row(4, 1.5), false));
    }
}
