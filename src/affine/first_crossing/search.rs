//! The first crossing of a mode's guards.
//!
//! Where Taylor polynomials prove the first crossing from a point on (`taylor.rs` and
//! `taylor_with_decay.rs`), nothing else is evaluated. Otherwise a segment is passed in pieces. On
//! each the Bernstein coefficients of a polynomial that lies above the guard prove that it stays
//! negative, or up to which time it does. From there a crossing is searched (`crossing.rs`). A
//! piece on which neither is proved is divided. See the page docs/ROUNDING.md for what rounding may
//! take.
//!
//! Generic functions are compiled by the crate that uses them, which may do so in many units
//! without optimising across them; so those that run at every event are marked to be inlined, here
//! and in the modules that this one uses.

use super::crossing::FirstCrossing;
use super::hull::{Lengths, SignOnPiece};
use super::reach::Reach;
use super::taylor::FailedAttempts;
use crate::affine::guards::point::{Ends, GuardedPoint, GuardedSegment, Passed, PerGuard};
use crate::affine::guards::track::{SearchWork, Track, live_tracks};
use crate::numeric::number::{Bound, Number};
use std::ops::ControlFlow;

/// The largest number of pieces from one event to the next, of all guards together: about a
/// second's work in 106 bits. A mode of many guards has [`MIN_PIECES`] nevertheless.
const MAX_PIECES: u64 = 1 << 18;
/// The least number of pieces from one event to the next, however many guards a mode has.
const MIN_PIECES: u64 = 1 << 14;

/// The number of pieces that dividing one counts as.
const DIVISION_PIECES: u64 = 8;

/// The outcome of a search for the first crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchOutcome {
    /// No guard crosses before the limit.
    NoCrossing,
    /// The first crossing is the left end: all guards that cross there within what rounding may do,
    /// as bits.
    Crossing(u64),
    /// The search takes too much work.
    GivenUp,
}

impl<T: Number> GuardedSegment<'_, T> {
    /// The first crossing after the left end and not after `limit`.
    #[inline]
    pub fn first(
        &self,
        tracks: &mut [Track],
        ends: &mut Ends<T>,
        limit: T,
        failed_attempts: &mut FailedAttempts,
        work: &mut SearchWork,
    ) -> SearchOutcome {
        let mut most = f64::INFINITY;
        let span = [ends.left.time, limit];
        // After a crossing of a watched guard the piece in which it lies is continued.
        let mut is_ahead = ends.left.time < ends.passed.until;
        let guards = live_tracks(tracks).count().max(1) as u64;
        let mut work_left = (MAX_PIECES / guards).max(MIN_PIECES);
        while work_left > 0 {
            work_left -= 1;
            if ends.left.time >= limit {
                return SearchOutcome::NoCrossing;
            }
            if work.undecidable > 0 && self.follows_errors() {
                return SearchOutcome::GivenUp;
            }
            self.measure_norms(&mut ends.left);
            if let Some(crossing) = self.first_proved(tracks, &ends.left, failed_attempts, work) {
                return self.settle_by(&crossing, tracks, ends, span, work);
            }
            let known = if is_ahead { ends.passed.guards } else { 0 };
            let reaches = self.reaches(tracks, &ends.left, known);
            if !is_ahead && !self.look_ahead(tracks, ends, &reaches, limit, most, work) {
                return SearchOutcome::GivenUp;
            }
            is_ahead = false;
            let length = (ends.right.time - ends.left.time).to_f64();
            work.pieces += 1;
            let Some(share) = self.clear_share(tracks, &reaches, ends, work) else {
                ends.step();
                most = f64::INFINITY;
                clear_zeros(tracks);
                continue;
            };
            work_left = work_left.saturating_sub(DIVISION_PIECES);
            match self.after_open_piece(tracks, ends, share, span, work) {
                ControlFlow::Break(outcome) => return outcome,
                ControlFlow::Continue(factor) => most = factor * length,
            }
        }
        work.exhausted = true;
        SearchOutcome::GivenUp
    }

    /// The first crossing after a point that Taylor polynomials prove, of whole guards or of guards
    /// without a decaying term.
    #[inline]
    fn first_proved(
        &self,
        tracks: &[Track],
        left: &GuardedPoint<T>,
        failed_attempts: &mut FailedAttempts,
        work: &mut SearchWork,
    ) -> Option<FirstCrossing<T>> {
        self.first_by_taylor(tracks, left, failed_attempts, work)
            .or_else(|| self.first_by_taylor_with_decay(tracks, left, failed_attempts, work))
    }

    /// Searches for a crossing after the share of a piece on which all guards are proved negative.
    /// Unless that ends the search, gives the next piece's largest length, relative to this one's.
    #[inline]
    fn after_open_piece(
        &self,
        tracks: &mut [Track],
        ends: &mut Ends<T>,
        share: f64,
        span: [T; 2],
        work: &mut SearchWork,
    ) -> ControlFlow<SearchOutcome, f64> {
        let left = &ends.left;
        let is_finite = |n: usize| (left.orders[n][0].bound().abs() + left.slack[n]).is_finite();
        if !live_tracks(tracks).all(|(n, _)| is_finite(n)) {
            // Values that overflow prove nothing.
            return ControlFlow::Break(SearchOutcome::GivenUp);
        }
        if !self.shortened(tracks, ends, share, work) {
            return ControlFlow::Continue(64.0);
        }
        self.measure_norms(&mut ends.left);
        match self.rising(tracks, &ends.left, &ends.passed, work) {
            Some(crossing) => {
                ControlFlow::Break(self.settle_by(&crossing, tracks, ends, span, work))
            }
            None => ControlFlow::Continue(0.25),
        }
    }

    /// Brings the left end on by the clear share of a piece, if any. A piece of which nothing is
    /// clear and that has no shorter one, because its ends are next to each other, is stepped over:
    /// the answer is then no.
    #[inline]
    fn shortened(
        &self,
        tracks: &mut [Track],
        ends: &mut Ends<T>,
        share: f64,
        work: &mut SearchWork,
    ) -> bool {
        let (from, end) = (ends.left.time, ends.right.time);
        let to = from + (end - from) * T::exact(share);
        if to > from {
            self.evaluate(&mut ends.left, to, work);
            clear_zeros(tracks);
        } else if (end - from).bound() <= T::unit() * 8.0 * end.bound() {
            // A crossing within rounding is a touch.
            work.undecidable += 1;
            ends.step();
            clear_zeros(tracks);
            return false;
        }
        true
    }

    /// Brings the left end to a crossing that is proved, if that is not after the span's end. It is
    /// not before the span's begin, the event before it, whatever rounding says.
    #[inline]
    fn settle_by(
        &self,
        crossing: &FirstCrossing<T>,
        tracks: &[Track],
        ends: &mut Ends<T>,
        span: [T; 2],
        work: &mut SearchWork,
    ) -> SearchOutcome {
        match self.settle(tracks, &mut ends.left, crossing, span, work) {
            true => SearchOutcome::Crossing(crossing.guards),
            false => SearchOutcome::NoCrossing,
        }
    }

    /// The length of the next piece for each guard from a point on, but for the guards in `known`.
    #[inline]
    fn reaches(&self, tracks: &[Track], left: &GuardedPoint<T>, known: u64) -> PerGuard<Reach> {
        let longest = self.flow.longest;
        let mut reaches = PerGuard::new();
        for (n, track) in tracks.iter().enumerate() {
            reaches.push(match track.live && known >> n & 1 == 0 {
                true => self.reach(n, track, left, longest),
                false => Reach::default(),
            });
        }
        reaches
    }

    /// Evaluates the right end of the next piece, unless overflow hides how long a piece may be or
    /// rounding has no instant so near.
    #[inline]
    fn look_ahead(
        &self,
        tracks: &[Track],
        ends: &mut Ends<T>,
        reaches: &[Reach],
        limit: T,
        most: f64,
        work: &mut SearchWork,
    ) -> bool {
        let left = &ends.left;
        let mut length = most;
        for (n, track) in live_tracks(tracks) {
            if reaches[n].length.is_nan() || reaches[n].length <= 0.0 {
                return false;
            }
            length = length.min(reaches[n].length).min(self.near_root(track, &left.orders[n]));
        }
        let mut end = left.time + T::exact(length);
        if end <= left.time {
            return false;
        }
        // In two words a sum with infinity is NaN.
        let inside = end < limit;
        if !inside {
            end = limit;
        }
        self.evaluate(&mut ends.right, end, work);
        true
    }

    /// A length a little beyond the root that the first two terms of a guard suggest, if it begins
    /// at zero and turns back.
    #[inline]
    fn near_root(&self, track: &Track, orders: &[T; 4]) -> f64 {
        let (Some(first), Some(second)) = (orders.get(track.zeros), orders.get(track.zeros + 1))
        else {
            return f64::INFINITY;
        };
        let ratio = -(first.bound() / second.bound()).to_f64();
        if track.zeros > 0 && ratio > 0.0 {
            1.25 * ratio * (track.zeros + 1) as f64
        } else {
            f64::INFINITY
        }
    }

    /// The share of a piece on which all guards are proved to stay negative; none if they do on the
    /// whole piece.
    #[inline]
    fn clear_share(
        &self,
        tracks: &[Track],
        reaches: &[Reach],
        ends: &mut Ends<T>,
        work: &mut SearchWork,
    ) -> Option<f64> {
        let until = ends.right.time;
        let lengths = Lengths::new(until - ends.left.time);
        let (mut share, mut guards): (Option<f64>, u64) = (None, 0);
        for (n, track) in live_tracks(tracks) {
            if ends.passed.has(n, until) {
                guards |= 1 << n;
                continue;
            }
            match self.sign_on_piece(n, track, &reaches[n], ends, &lengths) {
                SignOnPiece::Negative => guards |= 1 << n,
                SignOnPiece::Touch => work.doubt(n),
                SignOnPiece::NegativeUntil(open) => {
                    share = Some(share.map_or(open, |it| it.min(open)))
                }
            }
        }
        ends.passed = Passed { guards, until };
        share
    }
}

#[inline]
fn clear_zeros(tracks: &mut [Track]) {
    tracks.iter_mut().for_each(|track| track.zeros = 0);
}
