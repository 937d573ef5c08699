//! The first crossing after a point, proved by guards' Taylor polynomials plus a decaying term.
//!
//! Where a mode is entered, its fastest motion is often one decay, which no polynomial follows for
//! as long as the segment lasts. The rest of the guard is slow: its polynomial, and the decay
//! itself, prove what `taylor.rs` proves of whole guards (`quotient_with_decay.rs`).

use super::crossing::FirstCrossing;
use super::quotient::{Quotient, WINDOW};
use super::quotient_with_decay::{DecayTerm, QuotientWithDecay};
use super::reach::part_of;
use super::taylor::{
    Attempt, FailedAttempts, LONG_TERMS, MAX_SHORT_REMAINDER, MAX_UNREFINED_REMAINDER, SHORT_TERMS,
    positive_root, rough_root,
};
use crate::affine::guards::point::{GuardedPoint, GuardedSegment};
use crate::affine::guards::track::{SearchWork, Track, live_tracks, outward};
use crate::numeric::number::{Bound, Number};

impl<T: Number> GuardedSegment<'_, T> {
    /// The first crossing after a point, if the polynomials there and a decay prove it. Runs that
    /// follow their errors are left to the search, which counts what errors leave open.
    #[inline]
    pub(super) fn first_by_taylor_with_decay(
        &self,
        tracks: &[Track],
        at: &GuardedPoint<T>,
        failed_attempts: &mut FailedAttempts,
        work: &mut SearchWork,
    ) -> Option<FirstCrossing<T>> {
        if !self.has_decay || !self.takes_polynomials() {
            return None;
        }
        let is_later = at.time > T::zero();
        let begins_below = |(n, track): (usize, &Track)| self.decay_rate(n, track, at).is_some();
        if !live_tracks(tracks).any(begins_below)
            || !failed_attempts.is_due(Attempt::WithoutDecay, is_later)
        {
            return None;
        }
        let crossing = self.nearest_proved_with_decay(tracks, at)?;
        failed_attempts.reset(Attempt::WithoutDecay, is_later);
        work.pieces += 1;
        Some(crossing)
    }

    /// The crossing of [`Self::first_by_taylor_with_decay`]; not inlined, because modes without a
    /// decay would pay for it in registers.
    #[inline(never)]
    fn nearest_proved_with_decay(
        &self,
        tracks: &[Track],
        at: &GuardedPoint<T>,
    ) -> Option<FirstCrossing<T>> {
        let (n, rough, lead) = self.nearest_with_decay(tracks, at)?;
        let power = |sum: f64| (1..SHORT_TERMS).fold(sum, |sum, k| sum * rough / k as f64);
        let rest = power(self.rest_bound(n, SHORT_TERMS - 1, at, rough));
        // More derivatives would make longer chains of sums than the evaluation that they save.
        let is_small = rest <= MAX_SHORT_REMAINDER * lead;
        if !is_small {
            return None;
        }
        let mut crossing = self.proved_with_decay(n, tracks, at, rough)?;
        if rest > MAX_UNREFINED_REMAINDER * lead {
            self.refine_with_decay(n, &tracks[n], at, &mut crossing);
        }
        Some(crossing)
    }

    /// The rate of the decay of a guard that begins with no zero. Near a structural zero at the
    /// entry the co-ordinates do not tell the guard, but its series there does.
    #[inline]
    fn decay_rate(&self, n: usize, track: &Track, at: &GuardedPoint<T>) -> Option<f64> {
        let begins_below = track.zeros == 0 && !self.is_by_series(n, at.time.to_f64());
        self.rows[n].decay_rate.filter(|_| begins_below)
    }

    /// The guard whose first terms, without its decaying term, suggest the earliest root after a
    /// point, that root, and the size of the guard's rest at the point; none if the guard has no
    /// decaying term.
    #[inline]
    fn nearest_with_decay(
        &self,
        tracks: &[Track],
        at: &GuardedPoint<T>,
    ) -> Option<(usize, f64, f64)> {
        let mut nearest = None;
        let mut earliest = f64::INFINITY;
        for (n, track) in live_tracks(tracks) {
            let (root, found) = match self.decay_rate(n, track, at) {
                Some(_) => {
                    let row = &self.rows[n];
                    let orders = row.first_orders(&at.modal.y, row.first_column(1));
                    let [value, slope, bend, third] = outward(&orders, track).map(Number::to_f64);
                    let root = positive_root([value, slope, 0.5 * bend, third / 6.0]);
                    (root, Some((n, root, value.abs())))
                }
                None => (rough_root(track, &at.orders[n]), None),
            };
            if root < earliest {
                (earliest, nearest) = (root, found);
            }
        }
        nearest
    }

    /// A guard's crossing near a rough root, if so many derivatives of its rest prove that it is
    /// the first.
    #[inline]
    fn proved_with_decay(
        &self,
        n: usize,
        tracks: &[Track],
        at: &GuardedPoint<T>,
        rough: f64,
    ) -> Option<FirstCrossing<T>> {
        let guard = self.quotient_with_decay::<SHORT_TERMS>(n, &tracks[n], at)?;
        let after = guard.root(rough)?;
        let room = guard
            .crosses(after, self.rest_bound(n, SHORT_TERMS - 1, at, (1.0 + WINDOW) * after))?;
        let end = (1.0 + room) * after;
        let mut guards = 1 << n;
        for (other, track) in live_tracks(tracks).filter(|(other, _)| *other != n) {
            if self.rows[other].twin == self.rows[n].twin && track.outward == tracks[n].outward {
                guards |= 1 << other;
                continue;
            }
            let stays_negative = self.stays_negative::<SHORT_TERMS>(other, track, at, end)
                || self.quotient_with_decay::<SHORT_TERMS>(other, track, at).is_some_and(|guard| {
                    guard.is_negative(end, self.rest_bound(other, SHORT_TERMS - 1, at, end))
                });
            if !stays_negative {
                return None;
            }
        }
        let time = |share: f64| at.time + T::exact(share * after);
        let between = [time(1.0 - room), time(1.0 + room)];
        Some(FirstCrossing { time: time(1.0), between, guards })
    }

    /// Improves the time of a crossing by all derivatives of its guard's rest.
    #[inline]
    fn refine_with_decay(
        &self,
        n: usize,
        track: &Track,
        at: &GuardedPoint<T>,
        crossing: &mut FirstCrossing<T>,
    ) {
        let Some(guard) = self.quotient_with_decay::<LONG_TERMS>(n, track, at) else { return };
        let root = (crossing.time - at.time).to_f64();
        let better = crossing.time - T::exact(guard.step(root).0 * root);
        let [low, high] = crossing.between;
        if low < better && better < high {
            crossing.time = better;
        }
    }

    /// The quotient of a guard's rest and its decaying term.
    #[inline]
    fn quotient_with_decay<const N: usize>(
        &self,
        n: usize,
        track: &Track,
        at: &GuardedPoint<T>,
    ) -> Option<QuotientWithDecay<N>> {
        let (rate, row) = (self.decay_rate(n, track, at)?, &self.rows[n]);
        let value = part_of(row, &row.parts[0], track, &at.modal.y).to_f64();
        let [mut orders, sizes] = row.orders_and_sizes::<N>(&at.modal, row.first_column(1));
        orders.iter_mut().for_each(|order| *order *= track.outward);
        let rest = Quotient::new([&orders, &sizes], 0, self.margin.to_f64(), self.errors(n, at));
        Some(QuotientWithDecay { rest, decay: DecayTerm { value, rate } })
    }

    /// A bound of a derivative of a guard without its decaying term.
    #[inline]
    fn rest_bound(&self, n: usize, order: usize, at: &GuardedPoint<T>, length: f64) -> f64 {
        /// The factor by which a sum is raised against its rounding.
        const OUTWARD_FACTOR: f64 = 1.0 + 1e-12;
        let rest = &self.rows[n].parts[1..];
        rest.iter().map(|part| part.bound(order, length, &at.norms).to_f64()).sum::<f64>()
            * OUTWARD_FACTOR
    }
}
