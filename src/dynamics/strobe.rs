//! The strobe map: the bounded motion one forcing period later, with its exact derivative.
//!
//! Its points are (p, y, q) at instants with one forcing angle. The map is continuous and piecewise
//! smooth. Its derivative is the product of the phases' derivatives and of the saltations between
//! them; the field is continuous at f = 0 and f = 1, so only impacts have one. An impact
//! annihilates the direction A = dp - dq: the derivative of a period with any contact is singular.
//!
//! # At a graze
//!
//! Where an impact is tangential its trial force f = 2 xi h' vanishes. The switch time's
//! derivative, -grad h/h', grows without bound, but the slider's velocity jumps by f/(2 xi) = h'
//! only: their product is finite, and so is the map's derivative. Its limits from the two sides
//! differ, however. With a contact, however short, dy changes by -2 xi A and dq becomes dp; without
//! one nothing happens. So the strobe map has a corner at a graze, no square root: multipliers jump
//! there, and a branch of orbits may turn or lose its stability without a multiplier having passed
//! through 1 or -1. Where contact grazes f = 1 or f = 0 the field is continuous and nothing jumps.

use super::linear;
pub use super::linear::{Jacobian, StrobePoint};
use super::section::Section;
use crate::error::InputError;
use crate::model::Model;
use crate::model::entry::Entry;
use crate::model::instant::Instant;
use crate::phase::Phase;
use crate::run::exit::Exit;
use crate::run::variation::{IDENTITY, Matrix, P, Q, V, Y, product};
use crate::state::State;

/// The derivative of a state on the slider, where q moves with p.
const SLIDER_DERIVATIVE: Jacobian = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];

/// The strobe map at one forcing angle.
#[derive(Clone, Copy, Debug)]
pub struct StrobeMap {
    model: Model,
    instant: Instant,
}

/// The image of a point of the section after some forcing periods, with the map's derivative.
#[derive(Clone, Debug, PartialEq)]
pub struct Passage {
    /// The motion after these forcing periods, ready to go on: its drift goes on from where it
    /// began.
    pub image: Entry,
    /// Derivative of the image with respect to (angle, p, y, q, v) where it began.
    pub derivative: Matrix,
    /// The phases met, in order; the first is the one it began in.
    pub phases: Vec<Phase>,
}

impl StrobeMap {
    /// The map of the section through `instant`.
    #[must_use]
    pub const fn new(model: Model, instant: Instant) -> Self {
        Self { model, instant }
    }

    /// The model whose motion is looked at.
    #[must_use]
    pub const fn model(&self) -> &Model {
        &self.model
    }

    /// The section's first instant.
    #[must_use]
    pub const fn instant(&self) -> &Instant {
        &self.instant
    }

    /// The motion that begins at a point of the section. A mass beyond the slider's top takes the
    /// slider along: q = p - g.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for numbers beyond 1e9 or not finite.
    pub fn entry(&self, [p, y, q]: StrobePoint) -> Result<Entry, InputError> {
        let g = self.model.parameters().g;
        let q = if p > q + g { p - g } else { q };
        self.model.entry(self.instant, State { p, y, q })
    }

    /// The map's derivative and phases over `periods` forcing periods from `from`, which need not
    /// be a strobe.
    #[must_use]
    pub fn passage(&self, from: &Entry, periods: u64) -> Passage {
        let end = from.instant.after_periods(periods, 1);
        let mut passage = Passage { image: *from, derivative: IDENTITY, phases: Vec::new() };
        for segment in self.model.trajectory(*from).until(end) {
            passage.phases.push(segment.phase());
            let step = match segment.exit() {
                Exit::Switch(_) => {
                    product(&segment.saltation(), &segment.variation(segment.duration()))
                }
                // Nothing is known of the image: nothing converges on it.
                Exit::Undecidable => [[f64::NAN; 5]; 5],
                _ => {
                    passage.image = segment.entry_at(&end);
                    segment.variation(segment.elapsed_at(&end))
                }
            };
            passage.derivative = product(&step, &passage.derivative);
        }
        passage
    }

    /// The strobes of the motion that begins at `from`: that instant, and `periods` more one
    /// forcing period apart.
    pub fn strobes(&self, from: Entry, periods: u64) -> impl Iterator<Item = Entry> + use<> {
        let end = from.instant.after_periods(periods, 1);
        let strobes = Section::along(self.model.trajectory(from).until(end), from.instant);
        strobes.take_while(move |strobe| strobe.instant <= end)
    }
}

impl Passage {
    /// Derivative of the image with respect to (p, y, q).
    #[must_use]
    pub fn jacobian(&self) -> Jacobian {
        [P, Y, Q].map(|row| [P, Y, Q].map(|column| self.derivative[row][column]))
    }

    /// The derivative with respect to what of (p, y, q) can change: a mass on the surface takes the
    /// slider along, and off the surface the derivative of a contact means nothing.
    #[must_use]
    pub fn free_jacobian(&self) -> Jacobian {
        match self.phases.first() {
            Some(Phase::Contact | Phase::Progression) => {
                linear::product(&self.jacobian(), &SLIDER_DERIVATIVE)
            }
            _ => self.jacobian(),
        }
    }

    /// Gradient of the drift gained with respect to (p, y, q).
    #[must_use]
    pub fn drift_gradient(&self) -> StrobePoint {
        [P, Y, Q].map(|column| self.derivative[V][column])
    }

    /// The image as a point of the section.
    #[must_use]
    pub fn point(&self) -> StrobePoint {
        self.image.point()
    }
}
