//! The first crossing after a point, proved by the Taylor polynomials of the guards there.
//!
//! Most segments are short relative to the times in which the motion changes. There the polynomial
//! of degree 7 or 15 at the entry and a bound of the next derivative prove which guard crosses
//! first and between which times (`quotient.rs`), and the closed form is evaluated at the crossing
//! alone. What is not proved so is left to `search.rs`.

use super::crossing::FirstCrossing;
use super::quotient::{Quotient, WINDOW};
use super::reach::rise;
use crate::affine::closed_form::bound::ORDERS;
use crate::affine::guards::point::{GuardedPoint, GuardedSegment};
use crate::affine::guards::track::{SearchWork, Track, live_tracks, outward};
use crate::numeric::number::{Bound, Number};

/// The terms of the shorter polynomial: derivatives, the value and the one that is bounded
/// included.
pub(super) const SHORT_TERMS: usize = 9;

/// The terms of the longer polynomial, counted in the same way.
pub(super) const LONG_TERMS: usize = ORDERS;

/// The largest share of a guard's leading term at which the remainder after [`SHORT_TERMS`]
/// derivatives leaves some digits of the root.
pub(super) const MAX_SHORT_REMAINDER: f64 = 1e-3;

/// The share of a guard's leading term beyond which the derivatives after [`SHORT_TERMS`] give so
/// many more digits of the root that one evaluation is enough.
pub(super) const MAX_UNREFINED_REMAINDER: f64 = 1e-7;

/// The share of a guard's leading term beyond which even [`LONG_TERMS`] derivatives prove nothing.
const MAX_LONG_REMAINDER: f64 = 10.0;

/// For each kind of Taylor polynomials, the number of attempts in a mode since they last proved a
/// crossing: of whole guards at the entry and later, and of guards without a decaying term at the
/// entry and later. Success is mostly the same at each entry, and a failed attempt costs as much as
/// an evaluation or two.
#[derive(Clone, Copy, Debug, Default)]
pub struct FailedAttempts([u8; 4]);

/// The Taylor polynomials by which a first crossing is to be proved.
#[derive(Clone, Copy, Debug)]
pub(super) enum Attempt {
    /// The polynomials of whole guards.
    WholeGuards,
    /// The polynomials of guards without their decaying term.
    WithoutDecay,
}

impl FailedAttempts {
    /// Failed attempts in a row after which attempts pause.
    const FAILURES_BEFORE_PAUSE: u8 = 2;
    /// The pauses after so many failures, in attempts: those without a decaying term seldom succeed
    /// where they once failed.
    const PAUSE_ATTEMPTS: [u8; 2] = [16, 64];

    /// Whether an attempt is to be made: at first, and then once after each pause.
    #[inline]
    pub(super) fn is_due(&mut self, attempt: Attempt, is_later: bool) -> bool {
        let count = &mut self.0[Self::at(attempt, is_later)];
        *count += 1;
        if *count > Self::FAILURES_BEFORE_PAUSE + Self::PAUSE_ATTEMPTS[attempt as usize] {
            *count = Self::FAILURES_BEFORE_PAUSE;
        }
        *count <= Self::FAILURES_BEFORE_PAUSE
    }

    /// Sets the count of failures to zero, because a crossing is proved.
    #[inline]
    pub(super) fn reset(&mut self, attempt: Attempt, is_later: bool) {
        self.0[Self::at(attempt, is_later)] = 0;
    }

    #[inline]
    fn at(attempt: Attempt, is_later: bool) -> usize {
        2 * attempt as usize + usize::from(is_later)
    }
}

impl<T: Number> GuardedSegment<'_, T> {
    /// The first crossing after a point, if the polynomials there prove it, which they do in f64.
    /// Runs that follow their errors are left to the search, which counts what errors leave open,
    /// and so are wide arithmetics, whose bounds f64 does not hold.
    #[inline]
    pub(super) fn first_by_taylor(
        &self,
        tracks: &[Track],
        at: &GuardedPoint<T>,
        failed_attempts: &mut FailedAttempts,
        work: &mut SearchWork,
    ) -> Option<FirstCrossing<T>> {
        let is_later = at.time > T::zero();
        if !self.takes_polynomials() || !failed_attempts.is_due(Attempt::WholeGuards, is_later) {
            return None;
        }
        let (n, rough) = nearest(tracks, at)?;
        let zeros = tracks[n].zeros;
        let power = |sum: f64, last: usize| (1..=last).fold(sum, |sum, k| sum * rough / k as f64);
        let lead = power(at.orders[n][zeros].to_f64().abs(), zeros);
        let rest =
            power(self.rows[n].bound(SHORT_TERMS - 1, &at.norms, rough).to_f64(), SHORT_TERMS - 1);
        let crossing = if rest <= MAX_SHORT_REMAINDER * lead {
            let mut crossing = self.proved::<SHORT_TERMS>(n, tracks, at, rough)?;
            if rest > MAX_UNREFINED_REMAINDER * lead {
                self.refine(n, at, &mut crossing);
            }
            crossing
        } else if rest <= MAX_LONG_REMAINDER * lead {
            self.proved::<LONG_TERMS>(n, tracks, at, rough)?
        } else {
            return None;
        };
        failed_attempts.reset(Attempt::WholeGuards, is_later);
        work.pieces += 1;
        Some(crossing)
    }

    /// A guard's crossing near a rough root, if so many derivatives prove that it is the first.
    #[inline]
    fn proved<const N: usize>(
        &self,
        n: usize,
        tracks: &[Track],
        at: &GuardedPoint<T>,
        rough: f64,
    ) -> Option<FirstCrossing<T>> {
        let guard = self.quotient::<N>(n, &tracks[n], at);
        let after = guard.root(rough)?;
        let last = self.rows[n].bound(N - 1, &at.norms, (1.0 + WINDOW) * after).to_f64();
        let room = guard.crosses(after, last)?;
        let end = (1.0 + room) * after;
        let mut guards = 1 << n;
        for (other, track) in live_tracks(tracks).filter(|(other, _)| *other != n) {
            if self.rows[other].twin == self.rows[n].twin && track.outward == tracks[n].outward {
                guards |= 1 << other;
            } else if !self.stays_negative::<N>(other, track, at, end) {
                return None;
            }
        }
        let time = |share: f64| at.time + T::exact(share * after);
        let between = [time(1.0 - room), time(1.0 + room)];
        Some(FirstCrossing { time: time(1.0), between, guards })
    }

    /// Improves the time of a crossing by all derivatives of its guard.
    #[inline]
    fn refine(&self, n: usize, at: &GuardedPoint<T>, crossing: &mut FirstCrossing<T>) {
        let orders = self.rows[n].rounded_orders::<LONG_TERMS>(&at.modal.y, 0);
        let after = crossing.time - at.time;
        let root = after.to_f64();
        let (step, _) = Quotient::new([&orders, &[0.0; LONG_TERMS]], 0, 0.0, [0.0; 2]).step(root);
        let better = crossing.time - T::exact(step * root);
        let [low, high] = crossing.between;
        if low < better && better < high {
            crossing.time = better;
        }
    }

    /// Whether a guard is proved to stay negative from a point on.
    #[inline]
    pub(super) fn stays_negative<const N: usize>(
        &self,
        n: usize,
        track: &Track,
        at: &GuardedPoint<T>,
        length: f64,
    ) -> bool {
        if self.upper_bound(n, track, at, length) < at.slack[n] * -4.0 {
            return true;
        }
        if track.zeros > 2 {
            return false;
        }
        let last = self.rows[n].bound(N - 1, &at.norms, length).to_f64();
        self.quotient::<N>(n, track, at).is_negative(length, last)
    }

    /// The quotient of a guard that begins with at most two zeros.
    #[inline]
    fn quotient<const N: usize>(
        &self,
        n: usize,
        track: &Track,
        at: &GuardedPoint<T>,
    ) -> Quotient<N> {
        let [mut orders, sizes] = self.rows[n].orders_and_sizes::<N>(&at.modal, 0);
        orders[..4].copy_from_slice(&at.orders[n].map(Number::to_f64));
        orders.iter_mut().for_each(|order| *order *= track.outward);
        let errors = self.errors(n, at);
        Quotient::new([&orders, &sizes], track.zeros, self.margin.to_f64(), errors)
    }

    /// The rounding error of a guard's value, and a bound of what underflow takes from its
    /// derivatives.
    #[inline]
    pub(super) fn errors(&self, n: usize, at: &GuardedPoint<T>) -> [f64; 2] {
        let norms = &at.norms[..self.flow.blocks.len()];
        let lost = f64::COARSE_UNDERFLOW * (1.0 + norms.iter().map(|it| it.to_f64()).sum::<f64>());
        [at.slack[n].to_f64(), lost]
    }
}

/// The guard whose first terms suggest the earliest root after a point, and that root.
#[inline]
fn nearest<T: Number>(tracks: &[Track], at: &GuardedPoint<T>) -> Option<(usize, f64)> {
    let mut nearest = (usize::MAX, f64::INFINITY);
    for (n, track) in live_tracks(tracks) {
        let root = rough_root(track, &at.orders[n]);
        if root < nearest.1 {
            nearest = (n, root);
        }
    }
    (nearest.1 < f64::INFINITY).then_some(nearest)
}

/// A root that a guard's first terms suggest; infinite, or no number, where there is none.
#[inline]
pub(super) fn rough_root<T: Number>(track: &Track, orders: &[T; 4]) -> f64 {
    let [value, slope, bend, third] = outward(orders, track).map(Number::to_f64);
    let (bend, third) = (0.5 * bend, third / 6.0);
    match track.zeros {
        0 => positive_root([value, slope, bend, third]),
        1 => positive_root([slope, bend, third, 0.0]),
        2 => positive_root([bend, third, 0.0, 0.0]),
        _ => f64::INFINITY,
    }
}

/// A time at which a cubic that is negative at zero has about become positive: by its quadratic, or
/// where that stays negative, its last root. Infinite, or no number, where there is none.
#[inline]
pub(super) fn positive_root([value, slope, bend, third]: [f64; 4]) -> f64 {
    const MAX_STEPS: usize = 4;
    let is_below = value < 0.0;
    if !is_below {
        return f64::INFINITY;
    }
    let first = rise([value, slope, bend]);
    let comes_back = third > 0.0;
    if first < f64::INFINITY || !comes_back {
        return first;
    }
    // From above all roots Newton's method falls to the last one.
    let share = |of: f64| (-of).max(0.0) / third;
    let mut at =
        1.1 * (share(value).approximate_root(3) + share(slope).approximate_root(2) + share(bend));
    for _ in 0..MAX_STEPS {
        let cubic = value + at * (slope + at * (bend + at * third));
        at -= cubic / (slope + at * (2.0 * bend + 3.0 * at * third));
    }
    if at > 0.0 { at } else { f64::INFINITY }
}
