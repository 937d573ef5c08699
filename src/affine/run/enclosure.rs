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

use crate::affine::arithmetic::vector::{Vector, dot, sum_rounding};
use crate::affine::closed_form::bound::{BlockGrowth, ORDERS};
use crate::affine::closed_form::flow::ModeFlow;
use crate::affine::closed_form::modal_state::ModalState;
use crate::affine::guards::inherited_error::{InheritedError, OUTWARD};
use crate::affine::guards::row::ModalRow;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::{Bound, Number};

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
    /// The part of an error at entry in the guard that does not move the crossing, because the
    /// guard's first orders were not summed but taken for zeros.
    fn kept(&self, error: &Vector<T::Bound>) -> T::Bound {
        let elapsed = self.elapsed.to_f64();
        let modal = self.flow.modal_rounded(error);
        let order =
            |k: usize| dot(&self.guard.orders[k].map(Number::bound), &modal, self.flow.dimension);
        let sum = |sum, k| order(k) + sum * elapsed / (k + 1) as f64;
        (0..self.zeros).rev().fold(T::Bound::ZERO, sum)
    }
}

impl<B: Bound> Enclosure<B> {
    /// Independent errors of the entries of a state.
    pub fn of(errors: &[B]) -> Self {
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
        let row = row.orders[order].map(Number::bound);
        self.sum(|column| dot(&row, &flow.modal_rounded(&column.state), flow.dimension))
    }

    /// Bounds of the error of a row at any time after the entry.
    pub fn along<T: Number<Bound = B>>(
        &self,
        flow: &ModeFlow<T>,
        row: &ModalRow<T>,
    ) -> InheritedError<B> {
        let mut sums = InheritedError::default();
        for column in &self.columns {
            let own = flow.modal_rounded(&column.state);
            let (norms, mut orders) = (flow.norms_of_bounds(&own), [B::ZERO; ORDERS]);
            for part in &row.parts {
                if part.growth != BlockGrowth::Polynomial {
                    sums.norms[part.subspace] += norms[part.subspace] * OUTWARD;
                    continue;
                }
                for it in &row.columns[part.columns.0..part.columns.1] {
                    let terms = it.orders.iter().map(|order| order.bound() * own[it.at]);
                    orders.iter_mut().zip(terms).for_each(|(order, term)| *order += term);
                }
            }
            let all = sums.orders.iter_mut().zip(orders);
            all.for_each(|(sum, order)| *sum += order.abs() * OUTWARD);
        }
        sums
    }

    fn sum(&self, entry: impl Fn(&ErrorColumn<B>) -> B) -> B {
        self.columns.iter().map(|column| entry(column).abs()).sum::<B>() * OUTWARD
    }

    /// The errors at a fixed time after the entry.
    pub fn later<T: Number<Bound = B>>(&self, flow: &ModeFlow<T>, elapsed: T) -> Self {
        let transition = flow.transition(elapsed);
        let later = |column: &ErrorColumn<B>| {
            let mut state = [B::ZERO; LARGEST_DIMENSION];
            for (factor, own) in column.state.iter().zip(&transition) {
                state.iter_mut().zip(own).for_each(|(sum, entry)| *sum += *factor * *entry);
            }
            ErrorColumn { state, time: column.time }
        };
        Self { columns: self.columns.iter().map(later).collect() }
    }

    /// The errors of a state at a time that is given, not found: the errors of the time before it
    /// are made up for along the flow. The time since the entry is rounded by up to `rounded`.
    pub fn at_given_time<T: Number<Bound = B>>(
        mut self,
        flow: &ModeFlow<T>,
        matrix: &[Vector<T>],
        state: &Vector<T>,
        rounded: B,
    ) -> Self {
        let rates = rates(flow, matrix, state);
        let whole = self.time() + rounded;
        for column in &mut self.columns {
            column.delayed(-column.time, &rates);
        }
        let mut own = ErrorColumn::ZERO;
        own.delayed(rounded, &rates);
        self.columns.push(ErrorColumn { time: B::ZERO, ..own });
        self.add_box(&bends(matrix, &rates, whole));
        self.add_box(&rate_roundings(matrix, state, whole));
        self
    }

    /// The errors at a crossing, before the reset of the event.
    pub fn at_crossing<T: Number<Bound = B>>(&self, crossing: &EnclosedCrossing<'_, T>) -> Self {
        let EnclosedCrossing { flow, guard, y, .. } = crossing;
        let order = |k: usize| dot(&guard.orders[k], y, flow.dimension).bound();
        let (slope, bend) = (order(1), order(2));
        let [value_row, slope_row] = [0, 1].map(|k| guard.orders[k].map(Number::bound));
        let mut later = self.later(flow, crossing.elapsed);
        let rates = rates(flow, crossing.matrix, &crossing.state);
        let margin = sum_rounding::<T>(flow.dimension);
        let (mut shift, mut slope_error) = (B::ZERO, margin * product_size(&guard.orders[1], y));
        for (column, entry) in later.columns.iter_mut().zip(&self.columns) {
            let own = flow.modal_rounded(&column.state);
            let apart = dot(&value_row, &own, flow.dimension) - crossing.kept(&entry.state);
            let delay = -apart / slope;
            slope_error += dot(&slope_row, &own, flow.dimension).abs();
            shift += delay.abs();
            column.delayed(delay, &rates);
        }
        let rounded =
            crossing.slack / slope.abs() + T::unit() * 4.0 * crossing.elapsed.bound().abs();
        // The second order of the crossing's time, and of the flow over it.
        let whole = shift + rounded;
        let second = whole * 2.0 * (bend.abs() * whole + slope_error) / slope.abs();
        let mut own = ErrorColumn::ZERO;
        own.delayed((rounded + second) * OUTWARD, &rates);
        later.columns.push(own);
        later.anchor(crossing.phase, flow.dimension - 1, &rates);
        let mut rest = crossing.roundings;
        let bends = bends(crossing.matrix, &rates, whole);
        let roundings = rate_roundings(crossing.matrix, &crossing.state, whole);
        for (sum, (bend, rounding)) in rest.iter_mut().zip(bends.into_iter().zip(roundings)) {
            *sum += bend + rounding;
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
        errors.add_box(roundings);
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
    let (now, off) = (flow.sizes(&later), flow.state_off(&later));
    let before = flow.sizes(&entry.sizes);
    std::array::from_fn(|n| {
        // Sums of zeros stay zero.
        let is_there = before[n] > 0.0 || now[n] > 0.0;
        let lost = if is_there { T::Bound::LAST_WORD } else { T::Bound::ZERO };
        margin * now[n] + off[n] + lost + T::Bound::UNDERFLOW * before[n]
    })
}
