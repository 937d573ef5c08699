//! A segment's guards at an instant, evaluated from the entry's modal co-ordinates.

use super::bound::ORDERS;
use super::enclosure::InheritedError;
use super::flow::ModeFlow;
use super::row::ModalRow;
use super::system::LARGEST_DIMENSION;
use super::track::{SearchWork, Track};
use super::vector::{UNDERFLOW, Vector, unit};
use crate::number::Number;
use smallvec::SmallVec;
use std::cell::OnceCell;
use std::ops::Range;

/// Up to this many guards need no heap memory.
const INLINE: usize = 4;

/// One thing for each guard.
pub(super) type PerGuard<T> = SmallVec<[T; INLINE]>;

/// A segment, with all that its guards have at its entry.
pub(super) struct GuardedSegment<'a, T> {
    pub flow: &'a ModeFlow<T>,
    pub rows: &'a [ModalRow<T>],
    pub entry: Vector<T>,
    /// What errors do along the segment, where they are followed.
    followed: Option<Box<FollowedErrors>>,
    /// Up to this time guards that begin with a structural zero are evaluated by their Taylor
    /// series at entry; negative where none does.
    pub early: f64,
    /// The series, once they are asked for.
    series: OnceCell<Vec<[T; ORDERS]>>,
    /// How many orders of each guard are structural zeros at entry.
    zeros: PerGuard<usize>,
    /// The blocks that a guard which can cross is made of.
    blocks: u16,
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
pub(super) struct GuardedPoint<T> {
    pub time: T,
    /// How much later a guard is zero, by its value and slope here: a time that rounding hides in
    /// the values of guards.
    pub later: T,
    /// The modal co-ordinates; those of blocks that no guard is made of are the entry's.
    pub y: Vector<T>,
    /// The norms of each block's co-ordinates, once [`GuardedSegment::measure`] was asked for them.
    pub norms: Vector<f64>,
    /// The value and three derivatives of each guard.
    pub orders: PerGuard<[T; 4]>,
    /// What rounding may have done to each value.
    pub slack: PerGuard<f64>,
}

impl<'a, T: Number> GuardedSegment<'a, T> {
    /// The segment that begins with these co-ordinates.
    #[inline]
    pub fn new(
        flow: &'a ModeFlow<T>,
        rows: &'a [ModalRow<T>],
        entry: Vector<T>,
        tracks: &[Track],
        inherited: Option<Vec<InheritedError>>,
    ) -> Self {
        let (mut blocks, mut zeros, mut early) = (0, PerGuard::new(), false);
        for (n, track) in tracks.iter().enumerate() {
            zeros.push(if track.live { track.zeros } else { ORDERS });
            if track.live {
                blocks |= rows[n].blocks;
                early |= track.zeros > 0;
            }
        }
        let lost = || flow.underflow(&entry);
        let followed = inherited.map(|it| Box::new(FollowedErrors { inherited: it, lost: lost() }));
        let series = OnceCell::new();
        let mut segment = Self { flow, rows, entry, followed, early: -1.0, series, zeros, blocks };
        if early {
            segment.early = segment.series_limit();
        }
        segment
    }

    /// Up to which time the series of these guards are good without their last order.
    #[inline]
    fn series_limit(&self) -> f64 {
        let norms = self.flow.norms(&self.entry);
        let longest = self.flow.longest;
        let mut limit = longest;
        let is_by_series = |zeros: usize| 0 < zeros && zeros < ORDERS;
        for (row, zeros) in self.rows.iter().zip(&self.zeros).filter(|it| is_by_series(*it.1)) {
            let last = row.bound(ORDERS - 1, &norms, longest.min(1e300));
            let lead = row.order(*zeros, &self.entry).0.to_f64().abs();
            limit = limit.min(series_limit::<T>(lead, *zeros, last));
        }
        limit
    }

    /// The guards' Taylor coefficients at entry.
    #[inline]
    fn series(&self) -> &[[T; ORDERS]] {
        self.series.get_or_init(|| {
            let guard = |(row, zeros): (&ModalRow<T>, &usize)| -> [T; ORDERS] {
                if *zeros == 0 {
                    return [T::zero(); ORDERS];
                }
                let mut coefficients = row.orders_from::<ORDERS>(0, &self.entry);
                coefficients[..*zeros].fill(T::zero());
                for (k, coefficient) in coefficients.iter_mut().enumerate().skip(*zeros) {
                    *coefficient = *coefficient * T::inverse_factorial(k);
                }
                coefficients
            };
            self.rows.iter().zip(&self.zeros).map(guard).collect()
        })
    }

    /// The guards at entry, with their structural zeros.
    #[inline]
    pub fn begin(&self, point: &mut GuardedPoint<T>) {
        (point.time, point.later, point.y) = (T::zero(), T::zero(), self.entry);
        point.make_room(self.rows.len());
        let GuardedPoint { orders, slack, .. } = point;
        for (n, zeros) in self.zeros.iter().enumerate() {
            (orders[n], slack[n]) = self.guard(n, &self.entry, None);
            if *zeros > 0 {
                orders[n].iter_mut().take(*zeros).for_each(|order| *order = T::zero());
                slack[n] = 0.0;
            }
        }
        self.inherit(0..self.rows.len(), point, |_| true);
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
        (point.orders[n], point.slack[n]) = self.guard(n, &point.y, series_at);
        self.inherit(n..n + 1, point, |_| by_series);
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
        (point.time, point.later, point.y) = (time, T::zero(), self.entry);
        self.flow.advance(&mut point.y, time, self.blocks);
    }

    /// All guards of a point whose co-ordinates are there.
    #[inline]
    fn fill_all(&self, point: &mut GuardedPoint<T>) {
        let time = point.time;
        let is_by_series = |n: usize| self.is_by_series(n, time.to_f64());
        point.make_room(self.rows.len());
        let GuardedPoint { y, orders, slack, .. } = point;
        for (n, (orders, slack)) in orders.iter_mut().zip(slack).enumerate() {
            (*orders, *slack) = self.guard(n, y, is_by_series(n).then_some(time));
        }
        self.inherit(0..self.rows.len(), point, is_by_series);
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

    /// What rounding does to a row, in sizes of what it is summed from.
    #[inline]
    pub fn margin(&self) -> f64 {
        (self.flow.dimension + 4) as f64 * unit::<T>()
    }

    /// Works out the norms of a point's blocks.
    #[inline]
    pub fn measure(&self, point: &mut GuardedPoint<T>) {
        point.norms = self.flow.norms(&point.y);
    }

    /// Evaluates the blocks of a point that no guard is made of.
    #[inline]
    pub fn complete(&self, point: &mut GuardedPoint<T>) {
        self.flow.advance(&mut point.y, point.time, !self.blocks);
    }

    /// Value and three derivatives of a guard, and what rounding may have done to the value: from
    /// the co-ordinates, or from its Taylor series at a time.
    #[inline]
    fn guard(&self, n: usize, y: &Vector<T>, series_at: Option<T>) -> ([T; 4], f64) {
        if self.zeros[n] == ORDERS {
            return ([T::zero(); 4], 0.0);
        }
        if let Some(time) = series_at {
            let (orders, size) = series(&self.series()[n], time);
            return (orders, 4.0 * unit::<T>() * size);
        }
        let (orders, size) = self.rows[n].sized_orders(y);
        (orders, self.margin() * size)
    }

    /// In a run that follows its errors, adds what they do to guards, and what rounding does where
    /// terms of the closed form have cancelled.
    #[inline]
    fn inherit(
        &self,
        guards: Range<usize>,
        point: &mut GuardedPoint<T>,
        is_by_series: impl Fn(usize) -> bool,
    ) {
        let Some(followed) = &self.followed else { return };
        let sizes = self.flow.sizes_later(&self.entry, point.time);
        for n in guards {
            let slack = &mut point.slack[n];
            if !is_by_series(n) {
                *slack = slack.max(self.margin() * self.rows[n].size(&sizes));
            }
            let lost = self.rows[n].bound(0, &followed.lost, point.time.to_f64());
            let rest = LARGEST_DIMENSION as f64 * UNDERFLOW;
            let off = self.rows[n].off(&sizes);
            *slack += self.inherited_by(n, point.time) + lost + rest + off;
        }
    }

    /// Whether the run follows its errors.
    #[inline]
    pub fn follows_errors(&self) -> bool {
        self.followed.is_some()
    }

    /// What errors made before the segment may do to a guard up to a time.
    #[inline]
    pub fn inherited_by(&self, n: usize, time: T) -> f64 {
        self.followed
            .as_ref()
            .map_or(0.0, |followed| followed.inherited[n].by(&self.rows[n], time.to_f64()))
    }
}

impl<T: Number> GuardedPoint<T> {
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
        let (y, norms) = ([T::zero(); LARGEST_DIMENSION], [0.0; LARGEST_DIMENSION]);
        let (time, later) = (T::zero(), T::zero());
        Self { time, later, y, norms, orders: SmallVec::new(), slack: SmallVec::new() }
    }
}

/// The two ends of a piece.
#[derive(Clone, Debug)]
pub(super) struct Ends<T> {
    pub left: GuardedPoint<T>,
    pub right: GuardedPoint<T>,
    /// What is proved of guards from the left end on.
    pub passed: Passed<T>,
}

/// Guards, as bits, that stay negative up to a time: the right end of the last piece that was
/// looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passed<T> {
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

/// Value and three derivatives of a Taylor series, and the size of what the value is summed from.
#[inline]
fn series<T: Number>(coefficients: &[T; ORDERS], time: T) -> ([T; 4], f64) {
    let [mut value, mut slope, mut bend, mut third] = [T::zero(); 4];
    let (mut size, size_of_time) = (0.0, time.to_f64().abs());
    let is_there = |it: &T| *it != T::zero();
    let last = coefficients[..ORDERS - 1].iter().rposition(is_there).map_or(0, |it| it + 1);
    for coefficient in coefficients[..last].iter().rev() {
        third = third * time + bend;
        bend = bend * time + slope;
        slope = slope * time + value;
        value = value * time + *coefficient;
        size = size * size_of_time + coefficient.to_f64().abs();
    }
    ([value, slope, bend + bend, T::exact(6.0) * third], size)
}

/// Up to which time a Taylor series without its last order is good to the last digit.
#[inline]
fn series_limit<T: Number>(lead: f64, zeros: usize, last: f64) -> f64 {
    if last == 0.0 {
        return f64::INFINITY;
    }
    let order = ORDERS - 1;
    let factorials: f64 = (zeros + 1..=order).map(|k| k as f64).product();
    let power = unit::<T>() * lead * factorials / last;
    0.9 * root(power, order - zeros)
}

/// A root to some per cent: by a division of the logarithm that a number's bits are.
#[inline]
pub(super) fn root(value: f64, degree: usize) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    if value == 0.0 || value == f64::INFINITY || value.is_nan() {
        return value;
    }
    let bits = value.to_bits();
    let share = |bits: u64| bits / degree as u64;
    f64::from_bits(if bits >= ONE { ONE + share(bits - ONE) } else { ONE - share(ONE - bits) })
}

const _: () = assert!(LARGEST_DIMENSION < ORDERS);
