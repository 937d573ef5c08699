//! The first crossing shortly after a point: its proof and its candidate.
//!
//! Where a guard rises steadily through zero, bounds of its derivatives prove that it does so once,
//! between two times. A Taylor polynomial guesses at the time, which `settle.rs` brings to the last
//! digit.

use crate::affine::guards::point::{GuardedPoint, GuardedSegment, Passed, PerGuard};
use crate::affine::guards::row::ModalRow;
use crate::affine::guards::track::{SearchWork, Track, live_tracks, outward};
use crate::numeric::number::{Bound, Number};

/// The number of Taylor terms that are summed to guess at a crossing, at most.
const TERMS: usize = 8;

/// A crossing that is proved to be the only one shortly after a point.
struct GuardCrossing<T: Number> {
    /// The number of the guard.
    guard: usize,
    /// The time from the point to the crossing, by a Taylor polynomial.
    after: T,
    /// The size of the last step towards the polynomial's root.
    change: T::Bound,
    /// An upper bound of the time from the point to the crossing.
    within: f64,
    /// The guard's rate at the point; half of it is the least that it has before `within`.
    slope: T::Bound,
    /// A bound of the rounding error of the crossing's time.
    error: T::Bound,
}

/// The first crossing of all guards.
pub(super) struct FirstCrossing<T> {
    /// The time of the crossing, by Taylor polynomials.
    pub time: T,
    /// The two times between which the first guard is proved to cross.
    pub between: [T; 2],
    /// The guards that cross within what rounding may do, as bits.
    pub guards: u64,
}

impl<T: Number> GuardedSegment<'_, T> {
    /// The first crossing shortly after a point, if it is proved to be one. Guards that have
    /// passed are not examined before their time.
    #[inline]
    pub(super) fn rising(
        &self,
        tracks: &[Track],
        at: &GuardedPoint<T>,
        passed: &Passed<T>,
        work: &mut SearchWork,
    ) -> Option<FirstCrossing<T>> {
        let mut all: PerGuard<GuardCrossing<T>> = PerGuard::new();
        for (n, track) in live_tracks(tracks).filter(|(n, _)| !passed.has(*n, at.time)) {
            all.extend(self.rises(n, track, at));
        }
        let first = all.iter().reduce(|a, b| if b.after < a.after { b } else { a })?;
        let mut guards = 0;
        for it in &all {
            if self.is_tied(at, first, it)? {
                guards |= 1 << it.guard;
            }
        }
        let end = at.time + T::exact(first.within);
        let is_open = |n: usize| all.iter().all(|it| it.guard != n) && !passed.has(n, end);
        for (n, track) in live_tracks(tracks).filter(|(n, _)| is_open(*n)) {
            let bound = self.upper_bound(n, track, at, first.within);
            let below = bound <= at.slack[n] * 4.0;
            if !below {
                return None;
            }
            if bound >= -at.slack[n] {
                work.doubt(n);
            }
        }
        let lowest = all.iter().find(|it| guards & (1 << it.guard) != 0)?;
        let earliest = at.time - T::of_bound(lowest.error * 4.0);
        let between = [earliest, at.time + T::exact(lowest.within)];
        Some(FirstCrossing { time: at.time + first.after, between, guards })
    }

    /// Whether a guard crosses together with the first, within rounding errors; none where the
    /// polynomials' remainders hide which is first.
    #[inline]
    fn is_tied(
        &self,
        at: &GuardedPoint<T>,
        first: &GuardCrossing<T>,
        other: &GuardCrossing<T>,
    ) -> Option<bool> {
        if first.guard == other.guard {
            return Some(true);
        }
        let gap = (other.after - first.after).bound();
        let error = first.error + other.error;
        let hidden = self.truncation(at, first) + self.truncation(at, other);
        if gap > error + hidden {
            return Some(false);
        }
        (hidden <= error).then_some(gap <= error)
    }

    /// A bound of the error of a crossing's time by the remainder of the guard's Taylor series and
    /// by Newton steps that were not taken.
    #[inline]
    fn truncation(&self, at: &GuardedPoint<T>, it: &GuardCrossing<T>) -> T::Bound {
        let row = &self.rows[it.guard];
        let terms = terms(row);
        let next = row.bound(terms, &at.norms, it.within);
        let rest = (1..=terms).fold(next, |rest, k| rest * it.within / k as f64);
        it.change + rest * 2.0 / it.slope
    }

    /// Whether a guard rises through zero once, shortly after a point, and when.
    #[inline]
    fn rises(&self, n: usize, track: &Track, at: &GuardedPoint<T>) -> Option<GuardCrossing<T>> {
        let orders = outward(&at.orders[n], track);
        let slack = at.slack[n];
        let [value, slope, bend, third] = orders.map(Number::bound);
        let rising = slope > 0.0 && value <= slack * 4.0;
        if track.zeros > 0 || !rising {
            return None;
        }
        // In f64 a time that is not zero stays so: bounds over no time would prove a crossing.
        let exact = (value.abs() * 2.0 + slack * 8.0) / slope;
        let within = exact.to_f64().max(f64::MIN_POSITIVE);
        let fourth = self.rows[n].bound(4, &at.norms, within);
        let [_, slope_rounding, bend_rounding, third_rounding] = self.order_roundings(n, at);
        let (bend, third) = (bend.abs() + bend_rounding, third.abs() + third_rounding);
        let change = slope_rounding + (bend + (third * 0.5 + fourth * exact / 6.0) * exact) * exact;
        let steadily = change < slope * 0.5;
        if !steadily {
            return None;
        }
        let (after, change) = self.root(n, track, at);
        // Where terms of the slope cancel, their rounding is more than that of the value.
        let moved =
            (slope_rounding + (bend_rounding * 0.5 + third_rounding * exact / 6.0) * exact) * exact;
        let is_finite = after.to_f64().is_finite();
        let error = (slack + moved) * 2.0 / slope;
        is_finite.then_some(GuardCrossing { guard: n, after, change, within, slope, error })
    }

    /// The time to a root of a guard's Taylor polynomial that is near a point, and the last step
    /// towards it. Where the polynomial is not the guard's, it may be far from a crossing.
    #[inline]
    pub(super) fn root(&self, n: usize, track: &Track, at: &GuardedPoint<T>) -> (T, T::Bound) {
        let first = outward(&at.orders[n], track);
        let mut all = [T::zero(); TERMS];
        let last = terms(&self.rows[n]);
        let mut orders = [T::zero(); TERMS];
        orders[..4].copy_from_slice(&first);
        if last > 4 {
            orders[4..].copy_from_slice(&outward(&self.rows[n].orders_from(4, &at.modal.y), track));
        }
        for (k, term) in all[..last].iter_mut().enumerate() {
            if !orders[k].to_f64().is_finite() {
                // Fewer terms give a first guess as well.
                break;
            }
            *term = orders[k] * T::inverse_factorial(k);
        }
        let (mut step, mut change) = (T::of_bound(series_reversion(&first)), T::Bound::INFINITY);
        for _ in 0..2 {
            let (mut value, mut slope) = (T::zero(), T::zero());
            for term in all[..last].iter().rev() {
                slope = slope * step + value;
                value = value * step + *term;
            }
            let by = value / slope;
            (step, change) = (step - by, by.bound().abs());
        }
        (step, change)
    }

    /// Bounds of the rounding errors of the value and three derivatives of a guard.
    #[inline]
    fn order_roundings(&self, n: usize, at: &GuardedPoint<T>) -> [T::Bound; 4] {
        self.rows[n].order_sizes::<4>(&at.modal.sizes).map(|size| self.margin * size)
    }

    /// An upper bound of a guard over a short time after a point.
    #[inline]
    pub(super) fn upper_bound(
        &self,
        n: usize,
        track: &Track,
        at: &GuardedPoint<T>,
        within: f64,
    ) -> T::Bound {
        let [value, slope, bend, third] = outward(&at.orders[n], track).map(Number::bound);
        let fourth = self.rows[n].bound(4, &at.norms, within);
        let [_, slope_rounding, bend_rounding, third_rounding] = self.order_roundings(n, at);
        let slope = slope + slope_rounding;
        let rest = bend.abs() * 0.5 + (third.abs() / 6.0 + fourth * within / 24.0) * within;
        let rest = rest + bend_rounding * 0.5 + third_rounding * within / 6.0;
        match track.zeros {
            0 => value + (slope.max(T::Bound::ZERO) + rest * within) * within,
            // The guard has left zero for the inside, and does not return so soon.
            1 if slope + rest * within < 0.0 => -T::Bound::INFINITY,
            _ => T::Bound::INFINITY,
        }
    }
}

/// The number of a guard's Taylor terms that are summed to guess at a crossing.
#[inline]
fn terms<T: Number>(row: &ModalRow<T>) -> usize {
    row.last.clamp(4, TERMS)
}

/// The step to the root of a cubic that is near zero, by the series of its inverse to the third
/// order: what a cubic tells of a guard is no more than that.
#[inline]
fn series_reversion<T: Number>(orders: &[T; 4]) -> T::Bound {
    let [value, slope, bend, third] = orders.map(Number::bound);
    let inverse = T::Bound::from_f64(1.0) / slope;
    let step = -value * inverse;
    let share = step * inverse;
    let (second, third) = (bend * 0.5 * share, third / 6.0 * step * share);
    let square = second * second;
    step + step * (second * 5.0 * (third - square) + (square * 2.0 - third) - second)
}
