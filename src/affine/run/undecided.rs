//! The cause for which a run was given up: the guard that rounding left open, how well it is known,
//! or a state that is too large.

use super::Run;
use crate::affine::guards::point::GuardedPoint;
use crate::affine::solver::event::{Ending, What};
use crate::numeric::number::{Bound, Number};

impl<T: Number> Run<'_, T> {
    /// The event whose guard rounding left open by itself, in a run that ended so.
    #[must_use]
    pub fn doubtful_event(&self) -> Option<What<T>> {
        let (mode, guard) = self.doubt.filter(|_| self.enclosure.is_some())?;
        Some(self.event_of(mode, guard))
    }

    /// Remembers the mode of the first guard that rounding left open: its number is one of that
    /// mode's, and another mode may have begun by the time it is asked for.
    #[inline]
    pub(super) fn remember_doubt(&mut self, mode: usize) {
        if self.doubt.is_none() {
            self.doubt = self.work.doubtful.map(|guard| (mode, guard));
        }
    }

    /// Whether the run has ended as undecided because its search took too much work.
    #[must_use]
    pub fn is_exhausted(&self) -> bool {
        self.work.exhausted
    }

    /// A bound of the error of the guard that a run has ended for: closer to zero it is not known.
    #[must_use]
    pub fn resolution(&self) -> Option<T::Bound> {
        let guard = self.work.doubtful.filter(|_| self.enclosure.is_some())?;
        let at = |point: &GuardedPoint<T>| point.slack.get(guard).copied();
        let [left, right] = [at(&self.ends.left), at(&self.ends.right)];
        let largest = left.into_iter().chain(right).fold(T::Bound::ZERO, Bound::max);
        (largest > 0.0 && largest.is_finite()).then_some(largest)
    }

    /// Whether the run has ended as undecided where its state, or a bound of it, is too large for
    /// the number type.
    #[must_use]
    pub fn overflows(&self) -> bool {
        /// The largest size of a state's entry, so that bounds of derivatives do not overflow.
        const MAX_SIZE: f64 = 1e280;
        let has_exponents = T::Bound::UNDERFLOW == 0.0;
        let within = |it: &T| match has_exponents {
            true => it.bound().is_finite(),
            false => it.bound().abs() <= MAX_SIZE,
        };
        let is_large = || self.present_state().is_none_or(|(_, state)| !state.iter().all(within));
        self.ending() == Some(&Ending::Undecided) && is_large()
    }

    /// The event of the present mode whose guard was positive at its entry, in a run that ended so.
    #[must_use]
    pub fn event_beyond_guard(&self) -> Option<What<T>> {
        let node = self.graph.node(self.node);
        let is_beyond = |n: &usize| {
            self.at_entry >> n & 1 == 1 && node.multiplicities.get(*n) == Some(&Some(0))
        };
        let is_so = self.ending() == Some(&Ending::BeyondGuard);
        let guard = (0..u64::BITS as usize).find(is_beyond).filter(|_| is_so);
        guard.map(|guard| self.event_of(node.mode, guard))
    }
}
