//! Bounds of a run's errors: rounding errors are carried along the run.
//!
//! Errors of the state and of the time are kept as columns, each with a factor between -1 and 1
//! that is not known. The flow and the derivative of an event (its saltation) act on each column;
//! what an event adds in second order, and each new rounding, is a column of its own. When there
//! are too many, the smallest are replaced by a box. So errors that cancel do so here.

use crate::affine::arithmetic::vector::{UNDERFLOW, Vector, dot, sum_rounding};
use crate::affine::closed_form::bound::{BlockGrowth, ORDERS};
use crate::affine::closed_form::flow::ModeFlow;
use crate::affine::closed_form::modal_state::ModalState;
use crate::affine::guards::inherited_error::{InheritedError, OUTWARD};
use crate::affine::guards::row::ModalRow;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::Number;

/// The largest number of columns; beyond it the smallest are replaced by a box.
const MOST_COLUMNS: usize = 160;

/// The number of the largest columns that are kept then.
const KEPT: usize = 80;

/// A bound of the error where the last word of a number underflows.
pub(super) const LAST_WORD: f64 = 1e-280;

/// An error of z and of the time, up to an unknown factor between -1 and 1.
#[derive(Clone, Copy, Debug)]
struct ErrorColumn {
    state: [f64; LARGEST_DIMENSION],
    time: f64,
}

/// The errors of a state and its time, as a sum of columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Enclosure {
    columns: Vec<ErrorColumn>,
}

/// A crossing, with everything from which the errors at it follow.
pub(super) struct EnclosedCrossing<'a, T> {
    pub flow: &'a ModeFlow<T>,
    pub matrix: &'a [Vector<T>],
    pub guard: &'a ModalRow<T>,
    /// The modal co-ordinates at the crossing, and the time since the entry.
    pub y: Vector<T>,
    pub elapsed: T,
    /// The state at the crossing.
    pub state: Vector<T>,
    /// A bound of the rounding error of the guard.
    pub slack: f64,
    pub unit: f64,
    /// The number of the guard's derivatives at entry that were taken for zero, because they are
    /// structural zeros.
    pub zeros: usize,
}

impl<T: Number> EnclosedCrossing<'_, T> {
    /// The part of an error at entry in the guard that does not move the crossing, because the
    /// guard's first orders were not summed but taken for zeros.
    fn kept(&self, error: &Vector<f64>) -> f64 {
        let elapsed = self.elapsed.to_f64();
        let modal = self.flow.modal_rounded(error);
        let order =
            |k: usize| dot(&self.guard.orders[k].map(Number::to_f64), &modal, self.flow.dimension);
        (0..self.zeros).rev().fold(0.0, |sum, k| order(k) + sum * elapsed / (k + 1) as f64)
    }
}

impl Enclosure {
    /// Independent errors of the entries of a state.
    pub fn of(errors: &[f64]) -> Self {
        let mut enclosure = Self::default();
        enclosure.add_box(errors);
        enclosure
    }

    /// Bounds of the errors of z.
    pub fn state(&self) -> [f64; LARGEST_DIMENSION] {
        std::array::from_fn(|n| self.sum(|column| column.state[n]))
    }

    /// A bound of the error of the time.
    pub fn time(&self) -> f64 {
        self.sum(|column| column.time)
    }

    /// A bound of the error of a derivative of a row, just after the entry of a segment.
    pub fn of_row<T: Number>(&self, flow: &ModeFlow<T>, row: &ModalRow<T>, order: usize) -> f64 {
        let row = row.orders[order].map(Number::to_f64);
        self.sum(|column| dot(&row, &flow.modal_rounded(&column.state), flow.dimension))
    }

    /// Bounds of the error of a row at any time after the entry.
    pub fn along<T: Number>(&self, flow: &ModeFlow<T>, row: &ModalRow<T>) -> InheritedError {
        let mut sums = InheritedError::default();
        for column in &self.columns {
            let own = flow.modal_rounded(&column.state);
            let (norms, mut orders) = (flow.norms(&own), [0.0; ORDERS]);
            for part in &row.parts {
                if part.growth != BlockGrowth::Polynomial {
                    sums.norms[part.block] += norms[part.block] * OUTWARD;
                    continue;
                }
                for it in &row.columns[part.columns.0..part.columns.1] {
                    let terms = it.orders.iter().map(|order| order.to_f64() * own[it.at]);
                    orders.iter_mut().zip(terms).for_each(|(order, term)| *order += term);
                }
            }
            let all = sums.orders.iter_mut().zip(orders);
            all.for_each(|(sum, order)| *sum += order.abs() * OUTWARD);
        }
        sums
    }

    fn sum(&self, entry: impl Fn(&ErrorColumn) -> f64) -> f64 {
        self.columns.iter().map(|column| entry(column).abs()).sum::<f64>() * OUTWARD
    }

    /// The errors at a fixed time after the entry.
    pub fn later<T: Number>(&self, flow: &ModeFlow<T>, elapsed: T) -> Self {
        let transition = flow.transition(elapsed);
        let later = |column: &ErrorColumn| {
            let mut state = [0.0; LARGEST_DIMENSION];
            for (factor, own) in column.state.iter().zip(&transition) {
                state.iter_mut().zip(own).for_each(|(sum, entry)| *sum += factor * entry);
            }
            ErrorColumn { state, time: column.time }
        };
        Self { columns: self.columns.iter().map(later).collect() }
    }

    /// The errors of a state at a time that is given, not found: the errors of the time before it
    /// are made up for along the flow. The time since the entry is rounded by up to `rounded`.
    pub fn at_given_time<T: Number>(
        mut self,
        flow: &ModeFlow<T>,
        matrix: &[Vector<T>],
        state: &Vector<T>,
        rounded: f64,
    ) -> Self {
        let rates = rates(flow, matrix, state);
        let whole = self.time() + rounded;
        for column in &mut self.columns {
            column.delayed(-column.time, &rates);
        }
        let mut own = ErrorColumn { state: [0.0; LARGEST_DIMENSION], time: 0.0 };
        own.delayed(rounded, &rates);
        self.columns.push(ErrorColumn { time: 0.0, ..own });
        self.add_box(&bends(matrix, &rates, whole));
        self.add_box(&rate_roundings(matrix, state, whole));
        self
    }

    /// The errors at a crossing, before the reset of the event.
    pub fn at_crossing<T: Number>(&self, crossing: &EnclosedCrossing<'_, T>) -> Self {
        let EnclosedCrossing { flow, guard, y, .. } = crossing;
        let order = |k: usize| dot(&guard.orders[k], y, flow.dimension).to_f64();
        let (slope, bend) = (order(1), order(2));
        let [value_row, slope_row] = [0, 1].map(|k| guard.orders[k].map(Number::to_f64));
        let mut later = self.later(flow, crossing.elapsed);
        let rates = rates(flow, crossing.matrix, &crossing.state);
        let margin = sum_rounding::<T>(flow.dimension);
        let (mut shift, mut slope_error) = (0.0, margin * product_size(&guard.orders[1], y));
        for (column, entry) in later.columns.iter_mut().zip(&self.columns) {
            let own = flow.modal_rounded(&column.state);
            let apart = dot(&value_row, &own, flow.dimension) - crossing.kept(&entry.state);
            let delay = -apart / slope;
            slope_error += dot(&slope_row, &own, flow.dimension).abs();
            shift += delay.abs();
            column.delayed(delay, &rates);
        }
        let rounded =
            crossing.slack / slope.abs() + 4.0 * crossing.unit * crossing.elapsed.to_f64().abs();
        // The second order of the crossing's time, and of the flow over it.
        let whole = shift + rounded;
        let second = 2.0 * whole * (bend.abs() * whole + slope_error) / slope.abs();
        let mut own = ErrorColumn { state: [0.0; LARGEST_DIMENSION], time: 0.0 };
        own.delayed((rounded + second) * OUTWARD, &rates);
        later.columns.push(own);
        later.add_box(&bends(crossing.matrix, &rates, whole));
        later.add_box(&rate_roundings(crossing.matrix, &crossing.state, whole));
        later
    }

    /// The errors after a reset; `roundings` bounds the rounding of each entry.
    pub fn after_reset<T: Number>(&self, reset: &[Vector<T>], roundings: &[f64]) -> Self {
        let after = |column: &ErrorColumn| {
            let mut state = [0.0; LARGEST_DIMENSION];
            for (entry, row) in state.iter_mut().zip(reset) {
                *entry = row.iter().zip(&column.state).map(|(a, b)| a.to_f64() * b).sum();
            }
            ErrorColumn { state, time: column.time }
        };
        let mut errors = Self { columns: self.columns.iter().map(after).collect() };
        errors.add_box(roundings);
        errors.reduce();
        errors
    }

    /// Adds the rounding errors of a segment's entry.
    pub fn add_entry<T: Number>(&mut self, flow: &ModeFlow<T>, state: &Vector<T>, unit: f64) {
        let roundings = flow.entry_roundings(state, unit).into_iter();
        let there = roundings.filter(|state| state.iter().any(|it| *it != 0.0));
        self.columns.extend(there.map(|state| ErrorColumn { state, time: 0.0 }));
    }

    /// Adds independent errors of the entries.
    pub fn add_box(&mut self, errors: &[f64]) {
        for (n, error) in errors.iter().enumerate().filter(|(_, error)| **error > 0.0) {
            let mut state = [0.0; LARGEST_DIMENSION];
            state[n] = *error;
            self.columns.push(ErrorColumn { state, time: 0.0 });
        }
    }

    fn reduce(&mut self) {
        if self.columns.len() <= MOST_COLUMNS {
            return;
        }
        let size = |column: &ErrorColumn| {
            column.state.iter().map(|it| it.abs()).sum::<f64>() + column.time.abs()
        };
        self.columns.sort_by(|a, b| size(b).total_cmp(&size(a)));
        let small = Self { columns: self.columns.split_off(KEPT) };
        self.add_box(&small.state());
        let time = ErrorColumn { state: [0.0; LARGEST_DIMENSION], time: small.time() };
        self.columns.push(time);
    }
}

/// The rates M z of a state, in f64.
fn rates<T: Number>(flow: &ModeFlow<T>, matrix: &[Vector<T>], state: &Vector<T>) -> Vec<f64> {
    matrix.iter().map(|row| dot(row, state, flow.dimension).to_f64()).collect()
}

/// Bounds of the rounding errors of states that move at M z for a time: terms of a rate may cancel.
fn rate_roundings<T: Number>(matrix: &[Vector<T>], state: &Vector<T>, time: f64) -> Vec<f64> {
    let margin = sum_rounding::<T>(matrix.len()) + f64::EPSILON * f64::EPSILON;
    let moved = |row: &Vector<T>| margin * product_size(row, state) * time;
    matrix.iter().map(moved).collect()
}

/// The sum of the sizes of products.
fn product_size<T: Number>(row: &Vector<T>, state: &Vector<T>) -> f64 {
    row.iter().zip(state).map(|(a, b)| (a.to_f64() * b.to_f64()).abs()).sum()
}

/// Bounds of the change of a state by the flow's second derivative over a time.
fn bends<T: Number>(matrix: &[Vector<T>], rates: &[f64], time: f64) -> Vec<f64> {
    let size = |row: &Vector<T>| {
        let terms = row.iter().zip(rates).map(|(a, b)| (a.to_f64() * b).abs());
        terms.sum::<f64>() * time * time
    };
    matrix.iter().map(size).collect()
}

impl ErrorColumn {
    /// Moves the error to a crossing that is later by `delay`.
    fn delayed(&mut self, delay: f64, rates: &[f64]) {
        for (entry, rate) in self.state.iter_mut().zip(rates) {
            *entry += rate * delay;
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
) -> [f64; LARGEST_DIMENSION] {
    let margin = sum_rounding::<T>(flow.dimension);
    let later = flow.at(entry, elapsed).sizes;
    let (now, off) = (flow.sizes(&later), flow.state_off(&later));
    let before = flow.sizes(&entry.sizes);
    std::array::from_fn(|n| {
        // Sums of zeros stay zero.
        let lost = if before[n] > 0.0 || now[n] > 0.0 { LAST_WORD } else { 0.0 };
        margin * now[n] + off[n] + lost + UNDERFLOW * before[n]
    })
}
