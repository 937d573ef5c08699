//! The motion between the events of a run, by the closed forms in 106 bits.

use crate::collect::Kept;
use crate::solvers::ClosedForms;
use percuss::affine::{Event, Time, What};
use percuss::{DoubleDouble, Proved};
use std::sync::Arc;

/// The motion of a run: its events, and the closed forms of the modes that they begin.
pub(crate) struct Motion {
    pub(crate) forms: Arc<ClosedForms>,
    pub(crate) events: Vec<Event<DoubleDouble>>,
}

/// A number that a closed form begins with.
pub(crate) trait Beginning {
    fn in_106_bits(&self) -> DoubleDouble;
}

impl Beginning for Proved {
    fn in_106_bits(&self) -> DoubleDouble {
        DoubleDouble::from(self.to_two_words())
    }
}

impl Beginning for f64 {
    fn in_106_bits(&self) -> DoubleDouble {
        DoubleDouble::new(*self, 0.0)
    }
}

/// The beginning of a segment.
pub(crate) fn beginning<V: Beginning>(row: &Kept<V>) -> Event<DoubleDouble> {
    let time = Time { high: row.time.in_106_bits(), low: DoubleDouble::default() };
    let state = row.state.iter().map(Beginning::in_106_bits).collect();
    Event { what: What::Start, time, state, mode: row.mode, errors: None }
}

impl Motion {
    /// The times of the first and of the last event.
    pub(crate) fn range(&self) -> Option<(f64, f64)> {
        let time = |it: &Event<DoubleDouble>| it.time.high.to_f64();
        Some((time(self.events.first()?), time(self.events.last()?)))
    }

    /// The state at a time of the run; after the event at the time of one. None of a time outside.
    pub(crate) fn at(&self, time: f64) -> Option<Vec<f64>> {
        let (first, last) = self.range()?;
        let direction = if self.forms.is_backward() { -1.0 } else { 1.0 };
        // Written so that a NaN is refused.
        let is_within =
            direction * time >= direction * first && direction * time <= direction * last;
        if !is_within {
            return None;
        }
        let has_begun =
            |it: &Event<DoubleDouble>| direction * it.time.high.to_f64() <= direction * time;
        let begun = self.events.partition_point(has_begun);
        let event = &self.events[begun.checked_sub(1)?];
        if event.time.high.to_f64() == time {
            return Some(event.state.iter().map(|it| it.to_f64()).collect());
        }
        let time = Time { high: DoubleDouble::new(time, 0.0), low: DoubleDouble::default() };
        Some(self.forms.state_at(event, &time).into_iter().map(DoubleDouble::to_f64).collect())
    }
}
