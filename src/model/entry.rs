//! The state at which a phase begins: what a row of Table 1 holds.

use crate::model::instant::Instant;
use crate::numeric::two_word::TwoWord;
use crate::phase::Phase;
use crate::state::State;

/// The state and the instant at which a phase begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The instant of the entry.
    pub instant: Instant,
    /// Bounded co-ordinates.
    pub state: State,
    /// Displacement of the slider's bottom, v, in two words: it grows without bound by small steps.
    pub drift: TwoWord,
    pub(crate) mode: ModeEntry,
}

/// How a phase begins: its kind, and what is known exactly at that instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ModeEntry {
    /// No contact, the mass away from the slider: only ever at a start.
    Apart,
    /// No contact, on the surface with this rate of h; zero at a separation.
    Separation { h_rate: f64 },
    /// Contact with trial force `reference + offset`.
    Contact { offset: f64, reference: f64 },
    /// Progression with this drift velocity and velocity of the slider's top.
    Progression { drift_rate: f64, closing: f64 },
}

impl Entry {
    /// The phase that begins.
    #[must_use]
    pub fn phase(&self) -> Phase {
        match self.mode {
            ModeEntry::Apart | ModeEntry::Separation { .. } => Phase::NoContact,
            ModeEntry::Contact { .. } => Phase::Contact,
            ModeEntry::Progression { .. } => Phase::Progression,
        }
    }

    /// The bounded co-ordinates in the order (p, y, q).
    #[must_use]
    pub const fn point(&self) -> [f64; 3] {
        let State { p, y, q } = self.state;
        [p, y, q]
    }

    /// Drift v, rounded to one word.
    #[must_use]
    pub fn v(&self) -> f64 {
        self.drift.value()
    }
}
