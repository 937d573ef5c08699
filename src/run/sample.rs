//! The motion inside a segment: samples of it, and entries at which another run may begin.

use crate::crossing::allowances::FOUR_ULPS;
use crate::flow::contact::Contact;
use crate::flow::progression::Progression;
use crate::flow::{Flow, Point};
use crate::model::entry::{Entry, ModeEntry, Motion};
use crate::model::instant::Instant;
use crate::numeric::two_word::TwoWord;
use crate::run::trajectory::Segment;
use crate::state::State;

/// The motion at some instant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sample {
    /// Bounded co-ordinates.
    pub state: State,
    /// Drift v.
    pub v: f64,
}

impl Segment {
    /// The motion a time `elapsed` after the phase began, at most [`Self::duration`].
    #[must_use]
    pub fn at(&self, elapsed: f64) -> Sample {
        self.at_two_word(TwoWord::new(elapsed))
    }

    /// The state as [`Self::at`] gives it; late in a long phase the second word of the time
    /// matters.
    fn at_two_word(&self, elapsed: TwoWord) -> Sample {
        let (_, state, drift) = self.shifted_to(elapsed);
        Sample { state, v: drift.value() }
    }

    /// The nearest evaluation, and state and drift shifted by the second word of the time.
    fn shifted_to(&self, elapsed: TwoWord) -> (Point<f64>, State, TwoWord) {
        let point = self.point(elapsed.high);
        let rest = elapsed.low;
        let [p_rate, y_rate, q_rate, v_rate] = self.field(&point);
        let State { p, y, q } = point.state;
        let state = State { p: p + rest * p_rate, y: y + rest * y_rate, q: q + rest * q_rate };
        let drift = self.entry().drift.plus(TwoWord::sum(point.drift, rest * v_rate));
        (point, state, drift)
    }

    /// The right-hand sides of Eqs. (11) to (13): rates of p, y, q and v.
    pub(crate) fn field(&self, point: &Point<f64>) -> [f64; 4] {
        let force = self.constants().b + point.force[0];
        let [guard, ..] = point.guard.orders;
        let slider = point.slider_velocity;
        match self.motion() {
            Motion::NoContact(_) => [point.state.y, force, slider, 0.0],
            Motion::Contact(contact) => [slider, force - (contact.reference + guard), slider, 0.0],
            Motion::Progression(_) => [slider, force - 1.0, slider, guard],
        }
    }

    pub(crate) fn point(&self, elapsed: f64) -> Point<f64> {
        match self.motion() {
            Motion::NoContact(flight) => flight.at(elapsed),
            Motion::Contact(contact) => contact.at(elapsed),
            Motion::Progression(progression) => progression.at(elapsed),
        }
    }

    /// The motion at an instant inside the phase.
    #[must_use]
    pub fn at_instant(&self, instant: &Instant) -> Sample {
        self.at_two_word(instant.since(&self.entry().instant, self.constants().omega))
    }

    /// The entry at an instant inside the segment: a run that begins there goes on as this one
    /// does, to within rounding.
    #[must_use]
    pub fn entry_at(&self, instant: &Instant) -> Entry {
        let elapsed = instant.since(&self.entry().instant, self.constants().omega);
        if elapsed.value() <= 0.0 {
            return *self.entry();
        }
        let (point, state, drift) = self.shifted_to(elapsed);
        let guard = point.guard.orders[0] + elapsed.low * point.guard.orders[1];
        let (state, mode) = match self.motion() {
            Motion::NoContact(flight) => {
                let constants = &flight.constants;
                if state.p < state.q + constants.g {
                    (state, ModeEntry::Apart)
                } else {
                    ModeEntry::on_surface(constants, state, None, point.force)
                }
            }
            Motion::Contact(Contact { constants, reference, .. }) => {
                let f = reference + guard;
                if f.min(1.0 - f) > FOUR_ULPS {
                    (state, ModeEntry::Contact { offset: guard, reference })
                } else {
                    ModeEntry::on_surface(constants, state, Some(f), point.force)
                }
            }
            Motion::Progression(Progression { constants, .. }) => {
                if guard > FOUR_ULPS * point.guard.largest_term {
                    let closing = point.slider_velocity;
                    (state, ModeEntry::Progression { drift_rate: guard, closing })
                } else {
                    ModeEntry::on_surface(constants, state, None, point.force)
                }
            }
        };
        Entry { instant: *instant, state, drift, mode }
    }
}
