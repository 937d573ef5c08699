//! Bounds of a run's errors: rounding errors are carried along the run.
//!
//! Errors of the state and of the time are kept as columns, each with a factor between -1 and 1
//! that is not known. The flow and the derivative of an event (its saltation) act on each column;
//! what an event adds in second order, and each new rounding, is a column of its own. When there
//! are too many, the smallest are replaced by a box ([`reduction`](super::reduction)). So errors
//! that cancel do so here.
//!
//! The phase of the forcing is computed anew from the time of each event, and so is the entry of z
//! that is 1. So the phase has the error of the time, in each column, and no errors of either are
//! carried along.

use crate::affine::arithmetic::vector::{Vector, dot, row_size, sum_rounding};
use crate::affine::closed_form::bound::ORDERS;
use crate::affine::closed_form::flow::ModeFlow;
use crate::affine::closed_form::modal_state::ModalState;
use crate::affine::guards::inherited_error::{InheritedError, OUTWARD_FACTOR};
use crate::affine::guards::row::ModalRow;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::{Bound, Number};

/// A bound of the rounding errors of a column's entry, relative to the sizes of what it is summed
/// from: bounds have the digits of f64, and up to four sums of `LARGEST_DIMENSION` products follow
/// each other. Where terms cancel this is more than [`OUTWARD_FACTOR`] covers.
const COLUMN_ROUNDING: f64 = 4.0 * (LARGEST_DIMENSION + 2) as f64 * f64::EPSILON;

/// An error of z and of the time, up to an unknown factor between -1 and 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct ErrorColumn<B> {
    pub state: Vector<B>,
    pub time: B,
}

/// The errors of a state and its time, as a sum of columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Enclosure<B> {
    pub columns: Vec<ErrorColumn<B>>,
}

/// A crossing, with everything from which the errors at it follow.
pub(super) struct EnclosedCrossing<'a, T: Number> {
    pub flow: &'a ModeFlow<T>,
    pub matrix: &'a [Vector<T>],
    pub guard: &'a ModalRow<T>,
    /// The modal co-ordinates at the crossing, and the time since the entry.
    pub y: Vector<T>,
    pub elapsed: T,
    /// The state at the crossing.
    pub state: Vector<T>,
    /// A bound of the rounding error of the guard.
    pub slack: T::Bound,
    /// Bounds of the rounding errors of the state.
    pub roundings: Vector<T::Bound>,
    /// The place of cos theta in z, which sin theta follows, in a system that is forced.
    pub phase: Option<usize>,
    /// The number of the guard's derivatives at entry that were taken for zero, because they are
    /// structural zeros.
    pub zeros: usize,
}

impl<T: Number> EnclosedCrossing<'_, T> {
    /// The change of the guard by an error at the entry that is `later` at the crossing. What it
    /// changes in first orders that were taken for zeros does not move the crossing; the others are
    /// then summed, because their difference to the whole loses all digits after a short time.
    fn guard_change(&self, entry: &Vector<T::Bound>, later: &Vector<T::Bound>) -> T::Bound {
        let (flow, dimension) = (self.flow, self.flow.dimension);
        let order = |k: usize| self.guard.orders[k].map(Number::bound);
        if self.zeros == 0 {
            return dot(&order(0), &flow.modal_rounded(later), dimension);
        }
        let modal = flow.modal_rounded(entry);
        self.taylor_sum(|k| dot(&order(k), &modal, dimension))
    }

    /// A bound of the error of all such changes as they are computed, from the sizes of errors at
    /// the entry, and of what those at the crossing are summed from.
    fn guard_change_error(&self, entry: &Vector<T::Bound>, later: &Vector<T::Bound>) -> T::Bound {
        if self.zeros == 0 {
            let sizes = self.flow.modal_sizes(later);
            return row_size(&self.guard.orders[0], &sizes) * COLUMN_ROUNDING;
        }
        let modal = self.flow.modal_sizes(entry);
        let elapsed = self.elapsed.to_f64();
        let norms = self.flow.norms_of_bounds(&modal);
        let last = self.guard.bound(ORDERS - 1, &norms, elapsed);
        let rest = (1..ORDERS).fold(last, |term, k| term * elapsed / k as f64);
        self.taylor_sum(|k| row_size(&self.guard.orders[k], &modal)) * COLUMN_ROUNDING + rest
    }

    /// The sum of the Taylor terms at the crossing with orders that were not taken for zeros, but
    /// for the last one that is kept.
    fn taylor_sum(&self, order: impl Fn(usize) -> T::Bound) -> T::Bound {
        let elapsed = self.elapsed.to_f64();
        let own = |k: usize| if k < self.zeros { T::Bound::ZERO } else { order(k) };
        (1..ORDERS - 1).rev().fold(T::Bound::ZERO, |sum, k| (sum + own(k)) * elapsed / k as f64)
    }
}

impl<B: Bound> Enclosure<B> {
    /// Independent errors of the entries of a state.
    pub fn new(errors: &[B]) -> Self {
        let mut enclosure = Self { columns: Vec::new() };
        enclosure.add_box(errors);
        enclosure
    }

    /// Bounds of the errors of z.
    pub fn state(&self) -> Vector<B> {
        std::array::from_fn(|n| self.sum(|column| column.state[n]))
    }

    /// A bound of the error of the time.
    pub fn time(&self) -> B {
        self.sum(|column| column.time)
    }

    /// A bound of the error of a derivative of a row, just after the entry of a segment.
    pub fn of_row<T: Number<Bound = B>>(
        &self,
        flow: &ModeFlow<T>,
        row: &ModalRow<T>,
        order: usize,
    ) -> B {
        let lost = row_size(&row.orders[order], &flow.modal_sizes(&self.state())) * COLUMN_ROUNDING;
        let row = row.orders[order].map(Number::bound);
        self.sum(|column| dot(&row, &flow.modal_rounded(&column.state), flow.dimension)) + lost
    }

    /// A bound of the error of a row in the entries of z.
    pub fn of_plain_row<T: Number<Bound = B>>(&self, row: &Vector<T>) -> B {
        let lost = row_size(row, &self.state()) * COLUMN_ROUNDING;
        let row = row.map(Number::bound);
        self.sum(|column| dot(&row, &column.state, LARGEST_DIMENSION)) + lost
    }

    /// Bounds of the error of a row at any time after the entry.
    pub fn error_along<T: Number<Bound = B>>(
        &self,
        flow: &ModeFlow<T>,
        row: &ModalRow<T>,
    ) -> InheritedError<B> {
        let mut sums = InheritedError::default();
        for column in &self.columns {
            sums.add(flow, row, &flow.modal_rounded(&column.state), |order, error| order * error);
        }
        let lost = flow.modal_sizes(&self.state()).map(|it| it * COLUMN_ROUNDING);
        sums.add(flow, row, &lost, |order, size| order.abs() * size);
        sums
    }

    fn sum(&self, entry: impl Fn(&ErrorColumn<B>) -> B) -> B {
        self.columns.iter().map(|column| entry(column).abs()).sum::<B>() * OUTWARD_FACTOR
    }

    /// The errors at a fixed time after the entry, and the sizes of what their entries are summed
    /// from.
    fn error_after<T: Number<Bound = B>>(
        &self,
        flow: &ModeFlow<T>,
        elapsed: T,
    ) -> (Self, Vector<B>) {
        let transition = flow.transition(elapsed);
        let mut sizes = [B::ZERO; LARGEST_DIMENSION];
        for (error, own) in self.state().into_iter().zip(&transition) {
            sizes.iter_mut().zip(own).for_each(|(sum, entry)| *sum += error * entry.abs());
        }
        let later = |column: &ErrorColumn<B>| {
            let mut state = [B::ZERO; LARGEST_DIMENSION];
            for (factor, own) in column.state.iter().zip(&transition) {
                state.iter_mut().zip(own).for_each(|(sum, entry)| *sum += *factor * *entry);
            }
            ErrorColumn { state, time: column.time }
        };
        (Self { columns: self.columns.iter().map(later).collect() }, sizes)
    }

    /// The errors of a state at a time that is given, not found, `elapsed` after the entry: the
    /// errors of the time before it are made up for along the flow.
    pub fn at_given_time<T: Number<Bound = B>>(
        &self,
        flow: &ModeFlow<T>,
        matrix: &[Vector<T>],
        state: &Vector<T>,
        elapsed: T,
    ) -> Self {
        let (mut later, sizes) = self.error_after(flow, elapsed);
        let rates = rates(flow, matrix, state);
        let rounded = T::unit() * 4.0 * elapsed.bound().abs();
        let shift = self.time();
        for column in &mut later.columns {
            column.delayed(-column.time, &rates);
        }
        let mut own = ErrorColumn::ZERO;
        own.delayed(rounded, &rates);
        later.columns.push(ErrorColumn { time: B::ZERO, ..own });
        later.add_box(&bends(matrix, &rates, shift + rounded));
        later.add_box(&rate_roundings(matrix, state, shift + rounded));
        later.add_box(&column_roundings(&sizes, &rates, shift));
        later
    }

    /// The errors at a crossing, before the reset of the event.
    pub fn at_crossing<T: Number<Bound = B>>(&self, crossing: &EnclosedCrossing<'_, T>) -> Self {
        let EnclosedCrossing { flow, guard, y, .. } = crossing;
        let order = |k: usize| dot(&guard.orders[k], y, flow.dimension).bound();
        let (slope, bend) = (order(1), order(2));
        let slope_row = guard.orders[1].map(Number::bound);
        let (mut later, sizes) = self.error_after(flow, crossing.elapsed);
        let rates = rates(flow, crossing.matrix, &crossing.state);
        let margin = sum_rounding::<T>(flow.dimension);
        let modal_sizes = flow.modal_sizes(&sizes);
        let slope_rounding = row_size(&guard.orders[1], &modal_sizes) * COLUMN_ROUNDING;
        let mut slope_error = margin * product_size(&guard.orders[1], y) + slope_rounding;
        let mut shift = B::ZERO;
        for (column, entry) in later.columns.iter_mut().zip(&self.columns) {
            let own = flow.modal_rounded(&column.state);
            let delay = -crossing.guard_change(&entry.state, &column.state) / slope;
            slope_error += dot(&slope_row, &own, flow.dimension).abs();
            shift += delay.abs();
            column.delayed(delay, &rates);
        }
        let slack = crossing.slack + crossing.guard_change_error(&self.state(), &sizes);
        let rounded = slack / slope.abs() + T::unit() * 4.0 * crossing.elapsed.bound().abs();
        // The second order of the crossing's time, and of the flow over it.
        let whole = shift + rounded;
        let second = whole * 2.0 * (bend.abs() * whole + slope_error) / slope.abs();
        let mut own = ErrorColumn::ZERO;
        own.delayed((rounded + second) * OUTWARD_FACTOR, &rates);
        later.columns.push(own);
        later.anchor(crossing.phase, flow.dimension - 1, &rates);
        let mut rest = crossing.roundings;
        let bends = bends(crossing.matrix, &rates, whole);
        let roundings = rate_roundings(crossing.matrix, &crossing.state, whole);
        let columns = column_roundings(&sizes, &rates, shift);
        for (n, sum) in rest.iter_mut().enumerate().take(flow.dimension) {
            *sum += bends[n] + roundings[n] + columns[n];
        }
        later.add_box(&rest);
        later
    }

    /// Takes away what is computed anew at an event: the errors of cos theta and sin theta become
    /// those that the errors of the time make, and the entry that is 1 has none.
    pub fn anchor(&mut self, phase: Option<usize>, one: usize, rates: &[B]) {
        for column in &mut self.columns {
            column.state[one] = B::ZERO;
            for n in phase.map_or(0..0, |at| at..at + 2) {
                column.state[n] = rates[n] * column.time;
            }
        }
    }

    /// The errors after a reset; `roundings` bounds the rounding of each entry.
    pub fn after_reset<T: Number<Bound = B>>(&self, reset: &[Vector<T>], roundings: &[B]) -> Self {
        let after = |column: &ErrorColumn<B>| {
            let mut state = [B::ZERO; LARGEST_DIMENSION];
            for (entry, row) in state.iter_mut().zip(reset) {
                *entry = row.iter().zip(&column.state).map(|(a, b)| a.bound() * *b).sum();
            }
            ErrorColumn { state, time: column.time }
        };
        let mut errors = Self { columns: self.columns.iter().map(after).collect() };
        let sizes = self.state();
        let lost = |row: &Vector<T>| row_size(row, &sizes) * COLUMN_ROUNDING;
        let all = roundings.iter().zip(reset).map(|(rounding, row)| *rounding + lost(row));
        errors.add_box(&all.collect::<Vec<_>>());
        errors
    }

    /// Adds the rounding errors of a segment's entry.
    pub fn add_entry<T: Number<Bound = B>>(&mut self, flow: &ModeFlow<T>, state: &Vector<T>) {
        let roundings = flow.entry_roundings(state).into_iter();
        let there = roundings.filter(|state| state.iter().any(|it| *it != 0.0));
        self.columns.extend(there.map(|state| ErrorColumn { state, time: B::ZERO }));
    }

    /// Adds independent errors of the entries.
    pub fn add_box(&mut self, errors: &[B]) {
        for (n, error) in errors.iter().enumerate().filter(|(_, error)| **error > 0.0) {
            let mut column = ErrorColumn::ZERO;
            column.state[n] = *error;
            self.columns.push(column);
        }
    }
}

/// The rates M z of a state.
pub(super) fn rates<T: Number>(
    flow: &ModeFlow<T>,
    matrix: &[Vector<T>],
    state: &Vector<T>,
) -> Vec<T::Bound> {
    matrix.iter().map(|row| dot(row, state, flow.dimension).bound()).collect()
}

/// Bounds of the rounding errors of states that move at M z for a time: terms of a rate may cancel.
fn rate_roundings<T: Number>(
    matrix: &[Vector<T>],
    state: &Vector<T>,
    time: T::Bound,
) -> Vec<T::Bound> {
    let margin = sum_rounding::<T>(matrix.len() + 1);
    let moved = |row: &Vector<T>| margin * product_size(row, state) * time;
    matrix.iter().map(moved).collect()
}

/// The sum of the sizes of products.
fn product_size<T: Number>(row: &Vector<T>, state: &Vector<T>) -> T::Bound {
    row.iter().zip(state).map(|(a, b)| (a.bound() * b.bound()).abs()).sum()
}

/// Bounds of the rounding errors of columns' entries that are summed from these sizes and moved at
/// these rates, by times whose sizes sum up to `shift`.
fn column_roundings<B: Bound>(sizes: &Vector<B>, rates: &[B], shift: B) -> Vec<B> {
    let lost = |(size, rate): (&B, &B)| (*size + rate.abs() * shift) * COLUMN_ROUNDING;
    sizes.iter().zip(rates).map(lost).collect()
}

/// Bounds of the change of a state by the flow's second derivative over a time.
fn bends<T: Number>(matrix: &[Vector<T>], rates: &[T::Bound], time: T::Bound) -> Vec<T::Bound> {
    let size = |row: &Vector<T>| {
        let terms = row.iter().zip(rates).map(|(a, b)| (a.bound() * *b).abs());
        terms.sum::<T::Bound>() * time * time
    };
    matrix.iter().map(size).collect()
}

impl<B: Bound> ErrorColumn<B> {
    pub const ZERO: Self = Self { state: [B::ZERO; LARGEST_DIMENSION], time: B::ZERO };

    /// Moves the error to a crossing that is later by `delay`.
    pub fn delayed(&mut self, delay: B, rates: &[B]) {
        for (entry, rate) in self.state.iter_mut().zip(rates) {
            *entry += *rate * delay;
        }
        self.time += delay;
    }
}

/// Bounds of the rounding errors of a state's entries, where it is evaluated a time after its
/// segment's entry.
pub(super) fn roundings<T: Number>(
    flow: &ModeFlow<T>,
    entry: &ModalState<T>,
    elapsed: T,
) -> Vector<T::Bound> {
    let margin = sum_rounding::<T>(flow.dimension);
    let later = flow.at(entry, elapsed).sizes;
    let (now, errors) = (flow.sizes(&later), flow.state_errors(&later));
    let before = flow.sizes(&entry.sizes);
    std::array::from_fn(|n| {
        // Sums of zeros stay zero.
        let is_there = before[n] > 0.0 || now[n] > 0.0;
        let lost = if is_there { T::Bound::LAST_WORD_UNDERFLOW } else { T::Bound::ZERO };
        margin * now[n] + errors[n] + lost + T::Bound::UNDERFLOW * before[n]
    })
}
