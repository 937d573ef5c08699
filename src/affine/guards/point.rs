//! A segment's guards at an instant, evaluated from the entry's modal co-ordinates.

use super::entry_series::{EntrySeries, SegmentEntry, has_series, series_limit};
use super::inherited_error::InheritedError;
use super::row::ModalRow;
use super::track::{SearchWork, Track};
use crate::affine::arithmetic::vector::{Vector, sum_rounding, twice_summed_rounding};
use crate::affine::closed_form::bound::ORDERS;
use crate::affine::closed_form::flow::ModeFlow;
use crate::affine::closed_form::modal_state::ModalState;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::{Bound, Number};
use smallvec::SmallVec;
use std::cell::OnceCell;
use std::ops::Range;

/// The number of guards up to which no heap memory is needed.
const INLINE_GUARDS: usize = 4;

/// A list with one entry for each guard of a mode.
pub type PerGuard<T> = SmallVec<[T; INLINE_GUARDS]>;

/// A segment with its guards, and with everything about them that is fixed at its entry.
pub struct GuardedSegment<'a, T: Number> {
    pub flow: &'a ModeFlow<T>,
    pub rows: &'a [ModalRow<T>],
    pub entry: ModalState<T>,
    /// The rounding error of a guard, relative to the sum of its terms' sizes.
    pub margin: T::Bound,
    /// The guards' errors along the segment, where errors are followed.
    followed: Option<Box<FollowedErrors<T::Bound>>>,
    /// Up to this time guards that begin with a structural zero are evaluated by their Taylor
    /// series at entry; negative where none does.
    pub early: f64,
    /// The guards' Taylor series at entry, once they are asked for.
    series: OnceCell<Vec<EntrySeries<T>>>,
    /// The number of each guard's derivatives that are structural zeros at entry, the value
    /// included.
    zeros: PerGuard<usize>,
    /// The blocks that have a part in a guard which can cross, as bits.
    blocks: u16,
    /// Whether the fastest block of a guard which can cross is one decay.
    pub has_decay: bool,
    /// The norms of the entry, in each of the flow's subspaces.
    norms: Vector<T::Bound>,
}

/// The guards' errors along a segment; boxed, because most runs do not follow errors.
struct FollowedErrors<B> {
    /// For each guard, the errors that were made before the segment.
    inherited: Vec<InheritedError<B>>,
    /// Bounds of the errors that underflow makes in each block.
    lost: Vector<B>,
}

/// The guards at an instant.
#[derive(Clone, Debug)]
pub struct GuardedPoint<T: Number> {
    pub time: T,
    /// The time from here to the zero of a guard, by its value and slope here: rounding of `time`
    /// would lose it.
    pub to_crossing: T,
    /// The modal co-ordinates; those of blocks without a part in any guard are the entry's.
    pub modal: ModalState<T>,
    /// The norms in each of the flow's subspaces, after [`GuardedSegment::measure_norms`].
    pub norms: Vector<T::Bound>,
    is_measured: bool,
    /// The value and three derivatives of each guard.
    pub orders: PerGuard<[T; 4]>,
    /// Bounds of the rounding errors of the guards' values.
    pub slack: PerGuard<T::Bound>,
}

impl<'a, T: Number> GuardedSegment<'a, T> {
    /// A segment of a mode that is not entered yet.
    pub fn before_entry(flow: &'a ModeFlow<T>, rows: &'a [ModalRow<T>]) -> Self {
        Self {
            flow,
            rows,
            entry: ModalState::default(),
            margin: T::Bound::ZERO,
            followed: None,
            early: -1.0,
            series: OnceCell::new(),
            zeros: PerGuard::new(),
            blocks: 0,
            has_decay: false,
            norms: [T::Bound::ZERO; LARGEST_DIMENSION],
        }
    }

    /// Enters a mode with the co-ordinates of `entry`, whose rounding errors are counted in their
    /// sizes or among the errors that are followed.
    #[inline]
    pub fn enter(
        &mut self,
        flow: &'a ModeFlow<T>,
        rows: &'a [ModalRow<T>],
        tracks: &[Track],
        inherited: Option<Vec<InheritedError<T::Bound>>>,
    ) {
        (self.flow, self.rows, self.blocks) = (flow, rows, 0);
        let margin =
            if inherited.is_some() { sum_rounding::<T> } else { twice_summed_rounding::<T> };
        self.margin = margin(flow.dimension);
        self.followed = inherited.map(|it| {
            let lost = flow.underflow(&self.entry.y);
            Box::new(FollowedErrors { inherited: it, lost })
        });
        self.series = OnceCell::new();
        self.zeros.clear();
        self.has_decay = false;
        let mut early = false;
        for (n, track) in tracks.iter().enumerate() {
            self.zeros.push(if track.live { track.zeros } else { ORDERS });
            if track.live {
                self.blocks |= rows[n].blocks;
                self.has_decay |= rows[n].decay_rate.is_some();
                early |= track.zeros > 0;
            }
        }
        flow.set_norms(&mut self.norms, &self.entry.y);
        self.early = if early { self.series_limit() } else { -1.0 };
    }

    /// The time up to which the series of all guards are good without their last order.
    #[inline]
    fn series_limit(&self) -> f64 {
        let longest = self.flow.longest;
        let mut limit = longest;
        for (row, zeros) in self.rows.iter().zip(&self.zeros).filter(|it| has_series(*it.1)) {
            let last = row.bound(ORDERS - 1, &self.norms, longest.min(1e300));
            let lead = row.order(*zeros, &self.entry).0.bound().abs();
            limit = limit.min(series_limit::<T>(lead, *zeros, last));
        }
        limit
    }

    /// The guards' Taylor series at entry.
    #[inline]
    fn series(&self) -> &[EntrySeries<T>] {
        self.series.get_or_init(|| {
            let entry = SegmentEntry {
                modal: self.flow.polynomial_sizes(&self.entry),
                norms: self.flow.norms_of_bounds(&self.entry.sizes),
                until: self.early,
            };
            let guards = self.rows.iter().zip(&self.zeros);
            guards.map(|(row, zeros)| EntrySeries::new(row, *zeros, &entry)).collect()
        })
    }

    /// The guards at entry, with their structural zeros.
    #[inline]
    pub fn begin(&self, point: &mut GuardedPoint<T>) {
        point.start(self);
        // One by one: wide registers would wait for norms just written.
        let norms = point.norms.iter_mut().zip(&self.norms).take(self.flow.subspaces.len());
        norms.for_each(|(norm, own)| *norm = *own);
        point.is_measured = true;
        point.make_room(self.rows.len());
        for (n, zeros) in self.zeros.iter().enumerate() {
            let evaluated = self.guard(n, point, None);
            let GuardedPoint { orders, slack, .. } = &mut *point;
            (orders[n], slack[n]) = evaluated;
            if *zeros > 0 {
                orders[n].iter_mut().take(*zeros).for_each(|order| *order = T::zero());
                slack[n] = T::Bound::ZERO;
            }
        }
        self.add_error_bounds(0..self.rows.len(), point);
    }

    /// Evaluates the closed form, as far as guards need it.
    #[inline]
    pub fn evaluate(&self, point: &mut GuardedPoint<T>, time: T, work: &mut SearchWork) {
        self.advance_to(point, time, work);
        self.fill_all(point);
    }

    /// Evaluates the closed form and one guard; the point's values of other guards are not of its
    /// time.
    #[inline]
    pub fn evaluate_guard(
        &self,
        n: usize,
        point: &mut GuardedPoint<T>,
        time: T,
        work: &mut SearchWork,
    ) {
        self.advance_to(point, time, work);
        let by_series = self.is_by_series(n, time.to_f64());
        let series_at = by_series.then_some(time);
        (point.orders[n], point.slack[n]) = self.guard(n, point, series_at);
        self.add_error_bounds(n..n + 1, point);
    }

    /// Evaluates all guards of a point at the crossing of one of them.
    #[inline]
    pub fn at_crossing(&self, point: &mut GuardedPoint<T>, work: &mut SearchWork) {
        let time = point.time + point.to_crossing;
        if time == point.time {
            self.fill_all(point);
        } else {
            self.evaluate(point, time, work);
        }
    }

    #[inline]
    fn advance_to(&self, point: &mut GuardedPoint<T>, time: T, work: &mut SearchWork) {
        work.evaluations += 1;
        point.start(self);
        point.time = time;
        self.flow.advance(&mut point.modal, time, self.blocks);
    }

    /// Evaluates all guards of a point whose co-ordinates are evaluated already.
    #[inline]
    fn fill_all(&self, point: &mut GuardedPoint<T>) {
        let time = point.time;
        let is_by_series = |n: usize| self.is_by_series(n, time.to_f64());
        point.make_room(self.rows.len());
        for n in 0..self.rows.len() {
            let evaluated = self.guard(n, point, is_by_series(n).then_some(time));
            (point.orders[n], point.slack[n]) = evaluated;
        }
        self.add_error_bounds(0..self.rows.len(), point);
    }

    /// Whether a guard is summed from its series at a time: where it begins with a structural zero,
    /// until the closed form has as many digits.
    #[inline]
    pub fn is_by_series(&self, n: usize, time: f64) -> bool {
        self.zeros[n] > 0 && time <= self.early
    }

    /// The number of a guard's Taylor terms at entry that are left out of its value at a time,
    /// because they are structural zeros.
    pub fn zeros_by_series(&self, n: usize, time: f64) -> usize {
        if self.is_by_series(n, time) { self.zeros[n] } else { 0 }
    }

    /// Works out a point's norms in each of the flow's subspaces.
    #[inline]
    pub fn measure_norms(&self, point: &mut GuardedPoint<T>) {
        if !point.is_measured {
            self.flow.set_norms(&mut point.norms, &point.modal.y);
            point.is_measured = true;
        }
    }

    /// Evaluates the blocks of a point that have no part in any guard.
    #[inline]
    pub fn complete(&self, point: &mut GuardedPoint<T>) {
        self.flow.advance(&mut point.modal, point.time, !self.blocks);
    }

    /// Value and three derivatives of a guard, and a bound of the value's rounding error: from the
    /// co-ordinates, or from its Taylor series at a time.
    #[inline]
    fn guard(&self, n: usize, at: &GuardedPoint<T>, series_at: Option<T>) -> ([T; 4], T::Bound) {
        if self.zeros[n] == ORDERS {
            return ([T::zero(); 4], T::Bound::ZERO);
        }
        if let Some(time) = series_at {
            let (orders, size) = self.series()[n].at(time);
            return (orders, self.margin * size);
        }
        let (orders, size) = self.rows[n].sized_orders(&at.modal);
        (orders, self.margin * size)
    }

    /// Adds the bounds of inherited and own errors to the guards, in a run that follows its errors.
    #[inline(always)]
    fn add_error_bounds(&self, guards: Range<usize>, point: &mut GuardedPoint<T>) {
        if let Some(followed) = &self.followed {
            self.add_followed_errors(followed, guards, point);
        }
    }

    fn add_followed_errors(
        &self,
        followed: &FollowedErrors<T::Bound>,
        guards: Range<usize>,
        point: &mut GuardedPoint<T>,
    ) {
        for n in guards {
            let lost = self.rows[n].bound(0, &followed.lost, point.time.to_f64());
            let rest = T::Bound::UNDERFLOW * LARGEST_DIMENSION as f64;
            let error = self.rows[n].value_error(&point.modal.sizes);
            point.slack[n] += self.inherited_by(n, point.time) + lost + rest + error;
        }
    }

    /// Whether the run follows its errors.
    #[inline]
    pub fn follows_errors(&self) -> bool {
        self.followed.is_some()
    }

    /// Whether crossings may be proved by Taylor polynomials in f64: they do not follow errors, and
    /// f64 does not hold the bounds of wide arithmetics.
    #[inline]
    pub fn takes_polynomials(&self) -> bool {
        self.followed.is_none() && T::Bound::UNDERFLOW > 0.0
    }

    /// A bound of the error of a guard at a time by errors that were made before the segment;
    /// between two times it is at most the larger of theirs.
    #[inline]
    pub fn inherited_by(&self, n: usize, time: T) -> T::Bound {
        let Some(followed) = &self.followed else { return T::Bound::ZERO };
        let (row, own, time) = (&self.rows[n], &followed.inherited[n], time.to_f64());
        let zeros = self.zeros[n];
        if !has_series(zeros) {
            return own.bound(self.flow, row, time);
        }
        if self.is_by_series(n, time) {
            return own.bound_without_zeros(zeros, row, time);
        }
        // Between a time of the series and this one the closed form's bound is at most the larger
        // of those at entry and here.
        own.bound(self.flow, row, time).max(own.bound(self.flow, row, 0.0))
    }
}

impl<T: Number> GuardedPoint<T> {
    /// Sets the point to a segment's entry.
    #[inline]
    fn start(&mut self, segment: &GuardedSegment<'_, T>) {
        (self.time, self.to_crossing, self.is_measured) = (T::zero(), T::zero(), false);
        self.modal.copy(&segment.entry, segment.flow.dimension);
    }

    /// Resizes orders and slacks to this number of guards.
    #[inline]
    fn make_room(&mut self, count: usize) {
        if self.orders.len() != count {
            self.orders.resize(count, [T::zero(); 4]);
            self.slack.resize(count, T::Bound::ZERO);
        }
    }
}

impl<T: Number> Default for GuardedPoint<T> {
    #[inline]
    fn default() -> Self {
        Self {
            time: T::zero(),
            to_crossing: T::zero(),
            modal: ModalState::default(),
            norms: [T::Bound::ZERO; LARGEST_DIMENSION],
            is_measured: false,
            orders: SmallVec::new(),
            slack: SmallVec::new(),
        }
    }
}

/// The two ends of a piece.
#[derive(Clone, Debug)]
pub struct Ends<T: Number> {
    pub left: GuardedPoint<T>,
    pub right: GuardedPoint<T>,
    /// The guards that are proved to stay negative from the left end on.
    pub passed: Passed<T>,
}

/// Guards, as bits, that stay negative up to a time: the right end of the last piece that was
/// evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Passed<T> {
    pub guards: u64,
    pub until: T,
}

impl<T: Number> Passed<T> {
    #[inline]
    pub fn none() -> Self {
        Self { guards: 0, until: T::zero() }
    }

    /// Whether a guard stays negative up to a time.
    #[inline]
    pub fn has(&self, guard: usize, until: T) -> bool {
        self.guards >> guard & 1 == 1 && until <= self.until
    }
}

impl<T: Number> Ends<T> {
    /// Makes the right end the left one of the next piece.
    #[inline]
    pub fn step(&mut self) {
        std::mem::swap(&mut self.left, &mut self.right);
        self.passed = Passed::none();
    }
}

impl<T: Number> Default for Ends<T> {
    #[inline]
    fn default() -> Self {
        let (left, right) = (GuardedPoint::default(), GuardedPoint::default());
        Self { left, right, passed: Passed::none() }
    }
}

const _: () = assert!(LARGEST_DIMENSION < ORDERS);
