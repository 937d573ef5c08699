//! The first crossing of a mode's guards.
//!
//! A segment is passed in pieces. On each the Bernstein coefficients of a polynomial that lies
//! above the guard show that it stays negative, or up to where it does. There a crossing is
//! searched: Newton's method on the guard's own series finds the candidate, and bounds of its
//! derivatives prove that the guard rises through zero once. What shows neither is looked at in
//! shorter pieces. See the page docs/ROUNDING.md for what rounding may take.
//!
//! What is generic is compiled by the crate that uses it, which may do so in many units without
//! optimising across them; so what runs at every event is marked to be inlined, here and in the
//! modules that this one uses.

use super::flow::ModalRow;
use super::hull::{Judged, Lengths};
use super::point::{Ends, PerGuard, Point, Segment};
use super::reach::Reach;
use super::track::{SearchWork, Track, outward};
use super::vector::unit;
use crate::number::Number;

/// The largest number of pieces from one event to the next, of all guards together: about a
/// second's work in 106 bits. A mode of many guards has [`FEWEST_PIECES`] nevertheless.
const MOST_PIECES: u64 = 1 << 18;
const FEWEST_PIECES: u64 = 1 << 14;

/// As how many pieces more one counts that is not passed whole, because it is divided.
const OPEN: u64 = 8;

/// The number of Taylor terms that are summed to guess at a crossing, at most.
const TERMS: usize = 8;

/// How a search ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// No guard crosses before the limit.
    Nothing,
    /// The first crossing is the left end: all guards that cross there within what rounding may do,
    /// as bits.
    Crossing(u64),
    /// The search takes too much work.
    Lost,
}

/// A crossing that is proved to be the only one shortly after a point.
struct Rising<T> {
    /// The number of the guard.
    guard: usize,
    /// When it is, after the point, by a Taylor polynomial.
    after: T,
    /// By what the last step towards the polynomial's root was.
    change: f64,
    /// How long after the point it is at most.
    within: f64,
    /// The guard's rate at the point; half of it is the least that it has before `within`.
    slope: f64,
    /// What rounding may do to the time.
    error: f64,
}

/// The first crossing of all guards.
struct FirstCrossing<T> {
    /// When it is, by Taylor polynomials.
    time: T,
    /// Between which times its first guard is proved to cross.
    between: [T; 2],
    /// The guards that cross within what rounding may do, as bits.
    guards: u64,
}

impl<T: Number> Segment<'_, T> {
    /// The first crossing after the left end and not after `limit`.
    #[inline]
    pub fn first(
        &self,
        tracks: &mut [Track],
        ends: &mut Ends<T>,
        limit: T,
        work: &mut SearchWork,
    ) -> Found {
        let mut most = f64::INFINITY;
        let guards = live(tracks).count().max(1) as u64;
        let mut work_left = (MOST_PIECES / guards).max(FEWEST_PIECES);
        while work_left > 0 {
            work_left -= 1;
            if ends.left.time >= limit {
                return Found::Nothing;
            }
            if work.undecidable > 0 && !self.inherited.is_empty() {
                return Found::Lost;
            }
            self.measure(&mut ends.left);
            let reaches = self.reaches(tracks, &ends.left);
            if !self.look_ahead(tracks, ends, &reaches, limit, most, work) {
                return Found::Lost;
            }
            let length = (ends.right.time - ends.left.time).to_f64();
            work.pieces += 1;
            let Some(share) = self.clear_share(tracks, &reaches, ends, work) else {
                ends.step();
                most = f64::INFINITY;
                clear_zeros(tracks);
                continue;
            };
            work_left = work_left.saturating_sub(OPEN);
            let left = &ends.left;
            let is_told = |n: usize| (left.orders[n][0].to_f64().abs() + left.slack[n]).is_finite();
            if !live(tracks).all(|(n, _)| is_told(n)) {
                // Where numbers overflow, nothing is told.
                return Found::Lost;
            }
            let from = ends.left.time;
            let to = from + (ends.right.time - from) * T::exact(share);
            if to > from {
                self.evaluate(&mut ends.left, to, work);
                clear_zeros(tracks);
            } else if length <= 8.0 * unit::<T>() * ends.right.time.to_f64() {
                // No shorter piece has two ends: what happens within rounding is a touch.
                work.undecidable += 1;
                ends.step();
                most = 64.0 * length;
                clear_zeros(tracks);
                continue;
            }
            self.measure(&mut ends.left);
            if let Some(crossing) = self.rising(tracks, &ends.left, work) {
                return self.settled(tracks, ends, crossing, limit, work);
            }
            most = 0.25 * length;
        }
        Found::Lost
    }

    /// How far each guard is looked at from a point.
    #[inline]
    fn reaches(&self, tracks: &[Track], left: &Point<T>) -> PerGuard<Reach> {
        let longest = self.flow.longest;
        let mut reaches = PerGuard::new();
        for (n, track) in tracks.iter().enumerate() {
            reaches.push(match track.live {
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
        for (n, track) in live(tracks) {
            if reaches[n].length.is_nan() || reaches[n].length <= 0.0 {
                return false;
            }
            length = length.min(reaches[n].length).min(self.near_root(track, &left.orders[n]));
        }
        let mut end = left.time + T::exact(length);
        if end <= left.time {
            return false;
        }
        // A sum with infinity is no number in two words.
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
        let ratio = -(first.to_f64() / second.to_f64());
        if track.zeros > 0 && ratio > 0.0 {
            1.25 * ratio * (track.zeros + 1) as f64
        } else {
            f64::INFINITY
        }
    }

    /// The share of a piece on which all guards are proved to stay negative; none if it is all of
    /// it.
    #[inline]
    fn clear_share(
        &self,
        tracks: &[Track],
        reaches: &[Reach],
        ends: &Ends<T>,
        work: &mut SearchWork,
    ) -> Option<f64> {
        let lengths = Lengths::of(ends.right.time - ends.left.time);
        let mut share: Option<f64> = None;
        for (n, track) in live(tracks) {
            match self.judge(n, track, &reaches[n], ends, &lengths) {
                Judged::Clear => {}
                Judged::Touch => work.undecidable += 1,
                Judged::Open(open) => share = Some(share.map_or(open, |it| it.min(open))),
            }
        }
        share
    }

    /// The first crossing shortly after a point, if it is proved to be one.
    #[inline]
    fn rising(
        &self,
        tracks: &[Track],
        at: &Point<T>,
        work: &mut SearchWork,
    ) -> Option<FirstCrossing<T>> {
        let mut all: PerGuard<Rising<T>> = PerGuard::new();
        for (n, track) in live(tracks) {
            all.extend(self.rises(n, track, at));
        }
        let first = all.iter().reduce(|a, b| if b.after < a.after { b } else { a })?;
        let mut guards = 0;
        for it in &all {
            if self.is_tied(at, first, it)? {
                guards |= 1 << it.guard;
            }
        }
        for (n, track) in live(tracks).filter(|(n, _)| all.iter().all(|it| it.guard != *n)) {
            let excess = self.excess(n, track, at, first.within);
            let below = excess <= 4.0 * at.slack[n];
            if !below {
                return None;
            }
            work.undecidable += u64::from(excess >= -at.slack[n]);
        }
        let lowest = all.iter().find(|it| guards & (1 << it.guard) != 0)?;
        let earliest = at.time - T::exact(4.0 * lowest.error);
        let between = [earliest, at.time + T::exact(lowest.within)];
        Some(FirstCrossing { time: at.time + first.after, between, guards })
    }

    /// Whether a guard crosses together with the first, within what rounding may do. Where
    /// polynomials hide which is first, nothing is told.
    #[inline]
    fn is_tied(&self, at: &Point<T>, first: &Rising<T>, other: &Rising<T>) -> Option<bool> {
        if first.guard == other.guard {
            return Some(true);
        }
        let gap = (other.after - first.after).to_f64();
        let error = first.error + other.error;
        let hidden = self.truncation(at, first) + self.truncation(at, other);
        if gap > error + hidden {
            return Some(false);
        }
        (hidden <= error).then_some(gap <= error)
    }

    /// What the rest of a guard's Taylor series, and steps that were not taken, may do to the time
    /// of a crossing.
    #[inline]
    fn truncation(&self, at: &Point<T>, it: &Rising<T>) -> f64 {
        let row = &self.rows[it.guard];
        let terms = terms(row);
        let next = self.flow.bound_by(row, terms, &at.norms, it.within);
        let rest = (1..=terms).fold(next, |rest, k| rest * it.within / k as f64);
        it.change + 2.0 * rest / it.slope
    }

    /// Whether a guard rises through zero once, shortly after a point, and when.
    #[inline]
    fn rises(&self, n: usize, track: &Track, at: &Point<T>) -> Option<Rising<T>> {
        let orders = outward(&at.orders[n], track);
        let slack = at.slack[n];
        let [value, slope, bend, third] = orders.map(Number::to_f64);
        let rising = slope > 0.0 && value <= 4.0 * slack;
        if track.zeros > 0 || !rising {
            return None;
        }
        let within = (2.0 * value.abs() + 8.0 * slack) / slope;
        let fourth = self.flow.bound_by(&self.rows[n], 4, &at.norms, within);
        let change = within * (bend.abs() + within * (0.5 * third.abs() + within * fourth / 6.0));
        let steadily = change < 0.5 * slope;
        if !steadily {
            return None;
        }
        let (after, change) = self.root(n, track, at);
        let (is_told, error) = (after.to_f64().is_finite(), 2.0 * slack / slope);
        is_told.then_some(Rising { guard: n, after, change, within, slope, error })
    }

    /// The time to a root of a guard's Taylor polynomial that is near a point, and the last step
    /// towards it. Where the polynomial is not the guard's, it may be far from a crossing.
    #[inline]
    fn root(&self, n: usize, track: &Track, at: &Point<T>) -> (T, f64) {
        let first = outward(&at.orders[n], track);
        let outward = T::exact(track.outward);
        let mut all = [T::zero(); TERMS];
        let last = terms(&self.rows[n]);
        for (k, term) in all[..last].iter_mut().enumerate() {
            let order = if k < 4 { first[k] } else { self.rows[n].order(k, &at.y).0 * outward };
            if !order.to_f64().is_finite() {
                // It is a first guess, which fewer terms give as well.
                break;
            }
            *term = order * T::inverse_factorial(k);
        }
        let (mut step, mut change) = (newton(&first), f64::INFINITY);
        for _ in 0..2 {
            let (mut value, mut slope) = (T::zero(), T::zero());
            for term in all[..last].iter().rev() {
                slope = slope * step + value;
                value = value * step + *term;
            }
            let by = value / slope;
            (step, change) = (step - by, by.to_f64().abs());
        }
        (step, change)
    }

    /// A bound of a guard over a short time after a point.
    #[inline]
    fn excess(&self, n: usize, track: &Track, at: &Point<T>, within: f64) -> f64 {
        let [value, slope, bend, third] = outward(&at.orders[n], track).map(Number::to_f64);
        let fourth = self.flow.bound_by(&self.rows[n], 4, &at.norms, within);
        let rest = 0.5 * bend.abs() + within * (third.abs() / 6.0 + within * fourth / 24.0);
        match track.zeros {
            0 => value + within * (slope.max(0.0) + within * rest),
            // It has left zero for the inside, and does not come back so soon.
            1 if slope + within * rest < 0.0 => f64::NEG_INFINITY,
            _ => f64::INFINITY,
        }
    }

    /// The crossing to the last digit. Of the guards only the first that crosses is evaluated
    /// there. Newton's steps are taken while they shrink and stay where the crossing is proved to
    /// be; elsewhere that is halved.
    #[inline]
    fn settled(
        &self,
        tracks: &[Track],
        ends: &mut Ends<T>,
        crossing: FirstCrossing<T>,
        limit: T,
        work: &mut SearchWork,
    ) -> Found {
        const ROUNDS: usize = 128;
        let n = crossing.guards.trailing_zeros() as usize;
        let point = &mut ends.left;
        let [mut low, mut high] = crossing.between;
        let inside = low <= crossing.time && crossing.time <= high;
        let half = T::exact(0.5);
        let guess = if inside { crossing.time } else { (low + high) * half };
        self.evaluate_guard(n, point, guess, work);
        let mut last = f64::INFINITY;
        for _ in 0..ROUNDS {
            // A value within a few roundings of its terms shows no better time.
            let noise = 4.0 * unit::<T>() * self.rows[n].size(&point.y);
            let orders = outward(&point.orders[n], &tracks[n]);
            let value = orders[0].to_f64();
            if value.abs() <= noise {
                break;
            }
            *(if value < 0.0 { &mut low } else { &mut high }) = point.time;
            let step = newton(&orders);
            let (mut better, mut size) = (point.time + step, step.to_f64().abs());
            if size <= unit::<T>() * point.time.to_f64().abs() {
                break;
            }
            if !(size < 0.25 * last && low < better && better < high) {
                // Steps that do not shrink are rounding, where that can be what the value is.
                better = (low + high) * half;
                let known = low < better && better < high;
                if value.abs() <= 4.0 * point.slack[n] || !known {
                    break;
                }
                size = (better - point.time).to_f64().abs();
            }
            if better <= T::zero() {
                break;
            }
            last = size;
            self.evaluate_guard(n, point, better, work);
        }
        point.later = remaining(&point.orders[n]);
        // A crossing exactly at the limit counts.
        let room = T::exact(4.0 * unit::<T>() * limit.to_f64());
        if point.time > limit + room { Found::Nothing } else { Found::Crossing(crossing.guards) }
    }
}

/// The number of a guard's Taylor terms that are summed to guess at a crossing.
#[inline]
fn terms<T>(row: &ModalRow<T>) -> usize {
    row.last.clamp(4, TERMS)
}

/// The rest of the way to a root, where that is so short that the slope does not change: then a
/// product with it does what another evaluation would do.
#[inline]
fn remaining<T: Number>(orders: &[T; 4]) -> T {
    const SHORT: f64 = 1e-6;
    let step = -orders[0] / orders[1];
    let [slope, bend] = [orders[1].to_f64(), orders[2].to_f64()];
    if (step.to_f64() * bend).abs() <= SHORT * slope.abs() { step } else { T::zero() }
}

/// The step to the root of a cubic that is near zero, by Newton's method.
#[inline]
fn newton<T: Number>(orders: &[T; 4]) -> T {
    let [value, slope, bend, third] = *orders;
    let (half, sixth) = (bend * T::exact(0.5), third / T::exact(6.0));
    let mut step = -value / slope;
    for _ in 0..3 {
        let cubic = value + step * (slope + step * (half + step * sixth));
        let tangent = slope + step * (bend + step * third * T::exact(0.5));
        step = step - cubic / tangent;
    }
    step
}

#[inline]
fn live(tracks: &[Track]) -> impl Iterator<Item = (usize, &Track)> {
    tracks.iter().enumerate().filter(|(_, track)| track.live)
}

#[inline]
fn clear_zeros(tracks: &mut [Track]) {
    tracks.iter_mut().for_each(|track| track.zeros = 0);
}
