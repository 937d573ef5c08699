//! A segment's guards at an instant, evaluated from the entry's modal co-ordinates.

use super::entry_series::{GuardSeries, SeriesEntry, has_series, series_limit};
use super::inherited_error::InheritedError;
use super::row::ModalRow;
use super::track::{SearchWork, Track};
use crate::affine::arithmetic::vector::{UNDERFLOW, Vector, sum_rounding, twice_summed};
use crate::affine::closed_form::bound::ORDERS;
use crate::affine::closed_form::flow::ModeFlow;
use crate::affine::closed_form::modal_state::ModalState;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::Number;
use smallvec::SmallVec;
use std::cell::OnceCell;
use std::ops::Range;

/// Up to this many guards need no heap memory.
const INLINE: usize = 4;

/// One thing for each guard.
pub type PerGuard<T> = SmallVec<[T; INLINE]>;

/// A segment, with all that its guards have at its entry.
pub struct GuardedSegment<'a, T> {
    pub flow: &'a ModeFlow<T>,
    pub rows: &'a [ModalRow<T>],
    pub entry: ModalState<T>,
    /// What rounding does to a guard, in sizes of what it is summed from.
    pub margin: f64,
    /// What errors do along the segment, where they are followed.
    followed: Option<Box<FollowedErrors>>,
    /// Up to this time guards that begin with a structural zero are evaluated by their Taylor
    /// series at entry; negative where none does.
    pub early: f64,
    /// The series, once they are asked for.
    series: OnceCell<Vec<GuardSeries<T>>>,
    /// How many orders of each guard are structural zeros at entry.
    zeros: PerGuard<usize>,
    /// The blocks that a guard which can cross is made of.
    blocks: u16,
    /// Whether the fastest block of a guard which can cross is one decay.
    pub has_decay: bool,
    /// The norms of the entry's blocks.
    norms: Vector<f64>,
}

/// What errors do to the guards along a segment; boxed, because most runs do not follow them.
struct FollowedErrors {
    /// What errors made before the segment do to each guard.
    inherited: Vec<InheritedError>,
    /// What underflow may do to each block.
    lost: Vector<f64>,
}

/// The guards at an instant.
#[derive(Clone, Debug)]
pub struct GuardedPoint<T> {
    pub time: T,
    /// How much later a guard is zero, by its value and slope here: a time that rounding hides in
    /// the values of guards.
    pub later: T,
    /// The modal co-ordinates; those of blocks that no guard is made of are the entry's.
    pub modal: ModalState<T>,
    /// The norms of each block's co-ordinates, once [`GuardedSegment::measure`] was asked for them.
    pub norms: Vector<f64>,
    is_measured: bool,
    /// The value and three derivatives of each guard.
    pub orders: PerGuard<[T; 4]>,
    /// What rounding may have done to each value.
    pub slack: PerGuard<f64>,
}

impl<'a, T: Number> GuardedSegment<'a, T> {
    /// A segment of a mode that is not entered yet.
    pub fn before(flow: &'a ModeFlow<T>, rows: &'a [ModalRow<T>]) -> Self {
        Self {
            flow,
            rows,
            entry: ModalState::default(),
            margin: 0.0,
            followed: None,
            early: -1.0,
            series: OnceCell::new(),
            zeros: PerGuard::new(),
            blocks: 0,
            has_decay: false,
            norms: [0.0; LARGEST_DIMENSION],
        }
    }

    /// Enters a mode with the co-ordinates of `entry`. Their own rounding is counted in their
    /// sizes, or among the errors that are followed.
    #[inline]
    pub fn enter(
        &mut self,
        flow: &'a ModeFlow<T>,
        rows: &'a [ModalRow<T>],
        tracks: &[Track],
        inherited: Option<Vec<InheritedError>>,
    ) {
        (self.flow, self.rows, self.blocks) = (flow, rows, 0);
        let margin = if inherited.is_some() { sum_rounding::<T> } else { twice_summed::<T> };
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
                self.has_decay |= rows[n].decay.is_some();
                early |= track.zeros > 0;
            }
        }
        flow.measure(&mut self.norms, &self.entry.y);
        self.early = if early { self.series_limit() } else { -1.0 };
    }

    /// Up to which time the series of these guards are good without their last order.
    #[inline]
    fn series_limit(&self) -> f64 {
        let longest = self.flow.longest;
        let mut limit = longest;
        for (row, zeros) in self.rows.iter().zip(&self.zeros).filter(|it| has_series(*it.1)) {
            let last = row.bound(ORDERS - 1, &self.norms, longest.min(1e300));
            let lead = row.order(*zeros, &self.entry).0.to_f64().abs();
            limit = limit.min(series_limit::<T>(lead, *zeros, last));
        }
        limit
    }

    /// The guards' Taylor series at entry.
    #[inline]
    fn series(&self) -> &[GuardSeries<T>] {
        self.series.get_or_init(|| {
            let entry = SeriesEntry {
                modal: self.flow.polynomial_sizes(&self.entry),
                norms: self.flow.norms(&self.entry.sizes),
                until: self.early,
            };
            let guards = self.rows.iter().zip(&self.zeros);
            guards.map(|(row, zeros)| GuardSeries::of(row, *zeros, &entry)).collect()
        })
    }

    /// The guards at entry, with their structural zeros.
    #[inline]
    pub fn begin(&self, point: &mut GuardedPoint<T>) {
        point.start(self);
        // One by one: wide registers would wait for norms just written.
        let norms = point.norms.iter_mut().zip(&self.norms).take(self.flow.blocks.len());
        norms.for_each(|(norm, own)| *norm = *own);
        point.is_measured = true;
        point.make_room(self.rows.len());
        for (n, zeros) in self.zeros.iter().enumerate() {
            let evaluated = self.guard(n, point, None);
            let GuardedPoint { orders, slack, .. } = &mut *point;
            (orders[n], slack[n]) = evaluated;
            if *zeros > 0 {
                orders[n].iter_mut().take(*zeros).for_each(|order| *order = T::zero());
                slack[n] = 0.0;
            }
        }
        self.inherit(0..self.rows.len(), point);
    }

    /// Evaluates the closed form, as far as guards need it.
    #[inline]
    pub fn evaluate(&self, point: &mut GuardedPoint<T>, time: T, work: &mut SearchWork) {
        self.go_to(point, time, work);
        self.fill_all(point);
    }

    /// Evaluates the closed form and one guard; what others have in the point is not of its time.
    #[inline]
    pub fn evaluate_guard(
        &self,
        n: usize,
        point: &mut GuardedPoint<T>,
        time: T,
        work: &mut SearchWork,
    ) {
        self.go_to(point, time, work);
        let by_series = self.is_by_series(n, time.to_f64());
        let series_at = by_series.then_some(time);
        (point.orders[n], point.slack[n]) = self.guard(n, point, series_at);
        self.inherit(n..n + 1, point);
    }

    /// Evaluates all guards of a point at the crossing of one of them.
    #[inline]
    pub fn at_crossing(&self, point: &mut GuardedPoint<T>, work: &mut SearchWork) {
        let time = point.time + point.later;
        if time == point.time {
            self.fill_all(point);
        } else {
            self.evaluate(point, time, work);
        }
    }

    #[inline]
    fn go_to(&self, point: &mut GuardedPoint<T>, time: T, work: &mut SearchWork) {
        work.evaluations += 1;
        point.start(self);
        point.time = time;
        self.flow.advance(&mut point.modal, time, self.blocks);
    }

    /// All guards of a point whose co-ordinates are there.
    #[inline]
    fn fill_all(&self, point: &mut GuardedPoint<T>) {
        let time = point.time;
        let is_by_series = |n: usize| self.is_by_series(n, time.to_f64());
        point.make_room(self.rows.len());
        for n in 0..self.rows.len() {
            let evaluated = self.guard(n, point, is_by_series(n).then_some(time));
            (point.orders[n], point.slack[n]) = evaluated;
        }
        self.inherit(0..self.rows.len(), point);
    }

    /// Whether a guard is summed from its series at a time: where it begins with a structural zero,
    /// until the closed form has as many digits.
    #[inline]
    pub fn is_by_series(&self, n: usize, time: f64) -> bool {
        self.zeros[n] > 0 && time <= self.early
    }

    /// How many orders of a guard at entry are left out of its value at a time, because they are
    /// zeros by the model.
    pub fn zeros_by_series(&self, n: usize, time: f64) -> usize {
        if self.is_by_series(n, time) { self.zeros[n] } else { 0 }
    }

    /// Works out the norms of a point's blocks.
    #[inline]
    pub fn measure(&self, point: &mut GuardedPoint<T>) {
        if !point.is_measured {
            self.flow.measure(&mut point.norms, &point.modal.y);
            point.is_measured = true;
        }
    }

    /// Evaluates the blocks of a point that no guard is made of.
    #[inline]
    pub fn complete(&self, point: &mut GuardedPoint<T>) {
        self.flow.advance(&mut point.modal, point.time, !self.blocks);
    }

    /// Value and three derivatives of a guard, and what rounding may have done to the value: from
    /// the co-ordinates, or from its Taylor series at a time.
    #[inline]
    fn guard(&self, n: usize, at: &GuardedPoint<T>, series_at: Option<T>) -> ([T; 4], f64) {
        if self.zeros[n] == ORDERS {
            return ([T::zero(); 4], 0.0);
        }
        if let Some(time) = series_at {
            let (orders, size) = self.series()[n].at(time);
            return (orders, self.margin * size);
        }
        let (orders, size) = self.rows[n].sized_orders(&at.modal);
        (orders, self.margin * size)
    }

    /// In a run that follows its errors, adds what they do to guards.
    #[inline(always)]
    fn inherit(&self, guards: Range<usize>, point: &mut GuardedPoint<T>) {
        if let Some(followed) = &self.followed {
            self.add_followed(followed, guards, point);
        }
    }

    fn add_followed(
        &self,
        followed: &FollowedErrors,
        guards: Range<usize>,
        point: &mut GuardedPoint<T>,
    ) {
        for n in guards {
            let lost = self.rows[n].bound(0, &followed.lost, point.time.to_f64());
            let rest = LARGEST_DIMENSION as f64 * UNDERFLOW;
            let off = self.rows[n].off(&point.modal.sizes);
            point.slack[n] += self.inherited_by(n, point.time) + lost + rest + off;
        }
    }

    /// Whether the run follows its errors.
    #[inline]
    pub fn follows_errors(&self) -> bool {
        self.followed.is_some()
    }

    /// What errors made before the segment may do to a guard at a time.
    #[inline]
    pub fn inherited_by(&self, n: usize, time: T) -> f64 {
        self.followed.as_ref().map_or(0.0, |followed| {
            followed.inherited[n].by(self.flow, &self.rows[n], time.to_f64())
        })
    }
}

impl<T: Number> GuardedPoint<T> {
    /// The co-ordinates of a segment's entry.
    #[inline]
    fn start(&mut self, segment: &GuardedSegment<'_, T>) {
        (self.time, self.later, self.is_measured) = (T::zero(), T::zero(), false);
        self.modal.copy(&segment.entry, segment.flow.dimension);
    }

    /// Resizes orders and slacks to this number of guards.
    #[inline]
    fn make_room(&mut self, count: usize) {
        if self.orders.len() != count {
            self.orders.resize(count, [T::zero(); 4]);
            self.slack.resize(count, 0.0);
        }
    }
}

impl<T: Number> Default for GuardedPoint<T> {
    #[inline]
    fn default() -> Self {
        Self {
            time: T::zero(),
            later: T::zero(),
            modal: ModalState::default(),
            norms: [0.0; LARGEST_DIMENSION],
            is_measured: false,
            orders: SmallVec::new(),
            slack: SmallVec::new(),
        }
    }
}

/// The two ends of a piece.
#[derive(Clone, Debug)]
pub struct Ends<T> {
    pub left: GuardedPoint<T>,
    pub right: GuardedPoint<T>,
    /// What is proved of guards from the left end on.
    pub passed: Passed<T>,
}

/// Guards, as bits, that stay negative up to a time: the right end of the last piece that was
/// looked at.
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
    /// Goes on to the right end.
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
