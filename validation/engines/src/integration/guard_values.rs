//! Guards and their rates at an instant.

use super::guard_cubic::{GuardCubic, GuardPoint};
use crate::equations::Numbers;

/// The guards at an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GuardValues<G> {
    pub(super) t: f64,
    pub(super) guards: G,
    pub(super) rates: G,
}

impl<G: Numbers> GuardValues<G> {
    pub(super) fn value(&self, guard: usize) -> f64 {
        self.guards.as_ref()[guard]
    }

    pub(super) fn rate(&self, guard: usize) -> f64 {
        self.rates.as_ref()[guard]
    }

    fn point(&self, guard: usize) -> GuardPoint {
        GuardPoint { t: self.t, value: self.value(guard), rate: self.rate(guard) }
    }

    pub(super) fn cubic_to(&self, right: &Self, guard: usize) -> GuardCubic {
        GuardCubic::between(self.point(guard), right.point(guard))
    }

    /// Outside, and by the equations of motion not on the way back: the interpolant of a loose
    /// tolerance ripples through a threshold that the motion itself is leaving.
    pub(super) fn leaves(&self, guard: usize) -> bool {
        self.value(guard) >= 0.0 && self.rate(guard) > 0.0
    }
}
