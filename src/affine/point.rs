//! A segment's guards at an instant, evaluated from the entry's modal co-ordinates.

use super::bound::ORDERS;
use super::flow::{Flow, ModalRow};
use super::system::LARGEST_DIMENSION;
use super::track::{SearchWork, Track};
use super::vector::{Vector, unit};
use crate::number::Number;
use smallvec::SmallVec;
use std::cell::OnceCell;

/// Guards of this number take no memory of their own.
const INLINE: usize = 4;

/// One thing for each guard.
pub(super) type PerGuard<T> = SmallVec<[T; INLINE]>;

/// A segment, with all that its guards have at its entry.
pub(super) struct Segment<'a, T> {
    pub flow: &'a Flow<T>,
    pub rows: &'a [ModalRow<T>],
    pub entry: Vector<T>,
    /// What errors made before the segment may do to each guard; empty where they are not followed.
    pub inherited: Vec<f64>,
    /// What underflow may do to each guard; empty as well.
    lost: Vec<f64>,
    /// The time up to which the guards' Taylor series at entry are good; negative where no guard
    /// begins with a structural zero, which they keep.
    pub early: f64,
    /// The series, once they are asked for.
    series: OnceCell<Vec<[T; ORDERS]>>,
    /// How many orders of each guard are structural zeros at entry.
    zeros: PerGuard<usize>,
    /// The blocks that a guard which can cross is made of.
    blocks: u16,
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
    /// The norms of each block's co-ordinates, once [`Segment::measure`] was asked for them.
    pub norms: Vector<f64>,
    /// The value and three derivatives of each guard.
    pub orders: PerGuard<[T; 4]>,
    /// What rounding may have done to each value.
    pub slack: PerGuard<f64>,
}

impl<'a, T: Number> Segment<'a, T> {
    /// The segment that begins with these co-ordinates.
    #[inline]
    pub fn new(
        flow: &'a Flow<T>,
        rows: &'a [ModalRow<T>],
        entry: Vector<T>,
        tracks: &[Track],
        inherited: Vec<f64>,
    ) -> Self {
        let (mut blocks, mut zeros, mut early) = (0, PerGuard::new(), false);
        for (n, track) in tracks.iter().enumerate() {
            zeros.push(if track.live { track.zeros } else { ORDERS });
            if track.live {
                blocks |= rows[n].blocks;
                early |= track.zeros > 0;
            }
        }
        let lost = if inherited.is_empty() { &[] } else { rows };
        let lost = lost.iter().map(|row| row.underflow(&entry)).collect();
        let series = OnceCell::new();
        let mut segment =
            Self { flow, rows, entry, inherited, lost, early: -1.0, series, zeros, blocks };
        if early {
            segment.early = segment.series_limit();
        }
        segment
    }

    /// Up to which time the series of all guards are good without their last order.
    #[inline]
    fn series_limit(&self) -> f64 {
        let norms = self.flow.norms(&self.entry);
        let longest = self.flow.longest;
        let mut limit = longest;
        for (row, zeros) in self.rows.iter().zip(&self.zeros).filter(|(_, it)| **it < ORDERS) {
            let last = self.flow.bound_by(row, ORDERS - 1, &norms, longest.min(1e300));
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
                let mut coefficients = [T::zero(); ORDERS];
                let mut factorial = T::one();
                for (k, coefficient) in coefficients[..row.last].iter_mut().enumerate() {
                    if k > 1 {
                        factorial = factorial * T::exact(k as f64);
                    }
                    if k >= *zeros {
                        *coefficient = row.order(k, &self.entry).0 / factorial;
                    }
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
        self.fill(point);
        for (n, zeros) in self.zeros.iter().enumerate().filter(|(_, zeros)| **zeros > 0) {
            point.orders[n].iter_mut().take(*zeros).for_each(|order| *order = T::zero());
            point.slack[n] = 0.0;
        }
        self.inherit(point, false);
    }

    /// Evaluates the closed form, as far as guards need it.
    #[inline]
    pub fn evaluate(&self, point: &mut GuardedPoint<T>, time: T, work: &mut SearchWork) {
        work.evaluations += 1;
        (point.time, point.later, point.y) = (time, T::zero(), self.entry);
        self.flow.advance(&mut point.y, time, self.blocks);
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
        work.evaluations += 1;
        (point.time, point.later, point.y) = (time, T::zero(), self.entry);
        self.flow.advance(&mut point.y, time, self.blocks);
        let early = self.is_early(point);
        if early {
            self.fill_early(point);
        } else {
            let (orders, size) = self.rows[n].sized_orders(&point.y);
            (point.orders[n], point.slack[n]) = (orders, self.margin() * size);
        }
        self.inherit(point, !early);
    }

    /// All guards of a point whose co-ordinates are there.
    #[inline]
    pub fn fill_all(&self, point: &mut GuardedPoint<T>) {
        let early = self.is_early(point);
        if early {
            self.fill_early(point);
        } else {
            self.fill(point);
        }
        self.inherit(point, !early);
    }

    /// Whether the guards at a point are summed from their series.
    #[inline]
    pub fn is_early(&self, point: &GuardedPoint<T>) -> bool {
        point.time.to_f64() <= self.early
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

    /// The guards from the co-ordinates.
    #[inline]
    fn fill(&self, point: &mut GuardedPoint<T>) {
        let margin = self.margin();
        let count = self.rows.len();
        point.orders.resize(count, [T::zero(); 4]);
        point.slack.resize(count, 0.0);
        let (orders, slack) = (&mut point.orders[..count], &mut point.slack[..count]);
        let zeros = &self.zeros[..count];
        for (n, row) in self.rows.iter().enumerate() {
            if zeros[n] == ORDERS {
                (orders[n], slack[n]) = ([T::zero(); 4], 0.0);
                continue;
            }
            let (own, size) = row.sized_orders(&point.y);
            (orders[n], slack[n]) = (own, margin * size);
        }
    }

    /// The guards from their Taylor series.
    #[inline]
    fn fill_early(&self, point: &mut GuardedPoint<T>) {
        point.orders.clear();
        point.slack.clear();
        let margin = self.margin();
        for ((coefficients, row), zeros) in self.series().iter().zip(self.rows).zip(&self.zeros) {
            let (orders, size) = series(coefficients, point.time);
            let value = if *zeros == 0 { margin * row.size(&self.entry) } else { 0.0 };
            point.orders.push(orders);
            point.slack.push(4.0 * unit::<T>() * size + value);
        }
    }

    /// In a run that follows its errors, adds what they do to guards, and what rounding does where
    /// terms of the closed form have cancelled.
    #[inline]
    fn inherit(&self, point: &mut GuardedPoint<T>, is_closed_form: bool) {
        if !self.inherited.is_empty() {
            if is_closed_form {
                let sizes = self.flow.sizes_later(&self.entry, point.time);
                let slack = point.slack.iter_mut().zip(self.rows);
                slack.for_each(|(slack, row)| *slack = slack.max(self.margin() * row.size(&sizes)));
            }
            let growth = libm::exp(self.flow.fastest_growth() * point.time.to_f64().abs());
            let errors = point.slack.iter_mut().zip(self.inherited.iter().zip(&self.lost));
            errors.for_each(|(slack, (inherited, lost))| *slack += (inherited + lost) * growth);
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
    /// Whether the right end is that of the piece in which the left end is a crossing.
    pub is_ahead: bool,
}

/// Guards, as bits, that stay negative up to a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passed<T> {
    pub guards: u64,
    pub until: T,
}

impl<T: Number> Passed<T> {
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
        self.forget();
    }

    /// Forgets what is proved beyond the left end.
    #[inline]
    pub fn forget(&mut self) {
        self.passed = Passed { guards: 0, until: T::zero() };
        self.is_ahead = false;
    }
}

impl<T: Number> Default for Ends<T> {
    #[inline]
    fn default() -> Self {
        let passed = Passed { guards: 0, until: T::zero() };
        let (left, right) = (GuardedPoint::default(), GuardedPoint::default());
        Self { left, right, passed, is_ahead: false }
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
