//! The motion of a mode in f64: how guards and states at the end of a segment depend on the states
//! along it.
//!
//! In a mode z' = M z, with z the states, cos theta, sin theta and 1; a guard is a row w with the
//! value w z, and a reset is z+ = R z.

use crate::system::{CheckedSystem, Mode, Row, System, Until};
use nalgebra::{DMatrix, DVector, RowDVector};
use std::sync::Arc;

/// The number of equal parts of a segment at whose ends a perturbation may begin.
const PARTS: u32 = 8;
/// The size of a sum, relative to its terms' sizes, that rounding may make of zero.
const ZERO_TOLERANCE: f64 = 8.0 * f64::EPSILON;

/// A system's modes as matrices.
pub(super) struct Motion {
    checked: Arc<CheckedSystem>,
    modes: Vec<DMatrix<f64>>,
    guards: Vec<Vec<RowDVector<f64>>>,
    resets: Vec<Vec<DMatrix<f64>>>,
}

/// A part of a run in one mode in f64, with the propagator of one of its [`PARTS`].
pub(super) struct Segment {
    mode: usize,
    /// z at the ends of the parts, the begin first.
    points: Vec<DVector<f64>>,
    part: DMatrix<f64>,
}

/// A value with the rounding error of its sum.
#[derive(Clone, Copy)]
pub(super) struct Value {
    pub(super) value: f64,
    pub(super) rounding: f64,
}

impl Motion {
    pub(super) fn new(checked: &Arc<CheckedSystem>) -> Self {
        let system = checked.system();
        let rows = |mode: &Mode| -> Vec<RowDVector<f64>> {
            let until = mode.until.iter().map(|it| &it.guard);
            until.chain(mode.watch.iter().map(|it| &it.guard)).map(row).collect()
        };
        let resets = |mode: &Mode| mode.until.iter().map(|it| reset(system, it)).collect();
        Self {
            checked: Arc::clone(checked),
            modes: system.modes.iter().map(|mode| matrix(system, mode)).collect(),
            guards: system.modes.iter().map(rows).collect(),
            resets: system.modes.iter().map(resets).collect(),
        }
    }

    pub(super) fn system(&self) -> &System {
        self.checked.system()
    }

    /// The number of states.
    pub(super) fn states(&self) -> usize {
        self.system().states.len()
    }

    /// The states with cos theta, sin theta and 1 appended.
    pub(super) fn point(&self, elapsed: f64, state: &[f64]) -> DVector<f64> {
        let (sin, cos) = (self.system().omega * elapsed + self.system().phi).sin_cos();
        DVector::from_iterator(state.len() + 3, state.iter().copied().chain([cos, sin, 1.0]))
    }

    /// The row of a derivative of a guard; those of `until` come before those of `watch`.
    pub(super) fn derivative(&self, mode: usize, guard: usize, order: usize) -> RowDVector<f64> {
        let mut derived = self.guards[mode][guard].clone();
        for _ in 0..order {
            derived *= &self.modes[mode];
        }
        derived
    }

    pub(super) fn guard(&self, mode: usize, guard: usize) -> &RowDVector<f64> {
        &self.guards[mode][guard]
    }

    /// The value of a guard's derivative.
    pub(super) fn value(
        &self,
        (mode, guard, order): (usize, usize, usize),
        elapsed: f64,
        state: &[f64],
    ) -> Value {
        value(&self.derivative(mode, guard, order), &self.point(elapsed, state))
    }

    /// The state after the reset of an `until`, with the rounding error of each entry.
    pub(super) fn after(
        &self,
        (mode, until): (usize, usize),
        elapsed: f64,
        before: &[f64],
    ) -> Vec<Value> {
        let z = self.point(elapsed, before);
        let reset = &self.resets[mode][until];
        (0..self.states()).map(|n| value(&reset.row(n).into_owned(), &z)).collect()
    }

    /// The rate at which theta alone changes a row's value.
    pub(super) fn rate_of_theta(&self, row: &RowDVector<f64>, point: &DVector<f64>) -> f64 {
        let [cos, sin] = [self.states(), self.states() + 1];
        self.system().omega * (row[sin] * point[cos] - row[cos] * point[sin])
    }

    /// The rates of the states.
    pub(super) fn rates(&self, mode: usize, elapsed: f64, state: &[f64]) -> Vec<f64> {
        let rates = &self.modes[mode] * self.point(elapsed, state);
        rates.iter().take(state.len()).copied().collect()
    }

    /// The weight of each state at a point: its scale and its size.
    pub(super) fn weights(&self, point: &[f64]) -> Vec<f64> {
        self.system().scales.iter().zip(point).map(|(scale, it)| scale + it.abs()).collect()
    }

    /// What a perturbation of the states by their weights changes in a row's value at most.
    pub(super) fn size(&self, row: &RowDVector<f64>, point: &[f64]) -> f64 {
        self.weights(point).iter().zip(row.iter()).map(|(weight, it)| weight * it.abs()).sum()
    }

    /// The states after a duration in a mode.
    pub(super) fn flow(&self, mode: usize, elapsed: f64, state: &[f64], duration: f64) -> Vec<f64> {
        let after = (&self.modes[mode] * duration).exp() * self.point(elapsed, state);
        after.iter().take(state.len()).copied().collect()
    }

    /// A segment that begins in a state.
    pub(super) fn segment(&self, mode: usize, elapsed: f64, state: &[f64], length: f64) -> Segment {
        let part = (&self.modes[mode] * (length / f64::from(PARTS))).exp();
        let mut points = vec![self.point(elapsed, state)];
        for n in 0..PARTS as usize {
            points.push(&part * &points[n]);
        }
        Segment { mode, points, part }
    }

    /// What a perturbation of the states by their weights, anywhere along a segment, changes in a
    /// row's value at its end at most.
    pub(super) fn growth(&self, segment: &Segment, row: &RowDVector<f64>) -> f64 {
        let mut back = row.clone();
        let mut largest: f64 = 0.0;
        for point in segment.points.iter().rev() {
            largest = largest.max(self.size(&back, point.as_slice()));
            back *= &segment.part;
        }
        largest
    }

    /// The rate of a guard at a segment's end.
    fn rate(&self, segment: &Segment, guard: usize) -> f64 {
        let end = &segment.points[PARTS as usize];
        (self.derivative(segment.mode, guard, 1) * end)[0]
    }

    /// The change of the time of a crossing at a segment's end, by the same perturbations.
    pub(super) fn growth_of_time(&self, segment: &Segment, guard: usize) -> f64 {
        self.growth(segment, self.guard(segment.mode, guard)) / self.rate(segment, guard).abs()
    }

    /// The changes of the states just after the crossing of an `until` at a segment's end, as they
    /// stand at the moved time, by the same perturbations.
    pub(super) fn growth_of_states(&self, segment: &Segment, guard: usize) -> Vec<f64> {
        let (mode, states) = (segment.mode, self.states());
        let end = &segment.points[PARTS as usize];
        let velocity = &self.modes[mode] * end;
        let rate = self.rate(segment, guard);
        let row = self.guard(mode, guard);
        let identity = DMatrix::identity(states + 3, states + 3);
        let reset = self.resets[mode].get(guard).unwrap_or(&identity);
        let moved = |n: usize| -> RowDVector<f64> {
            let own = reset.row(n).into_owned();
            let drift = (&own * &velocity)[0];
            if rate == 0.0 { own } else { own - row * (drift / rate) }
        };
        // An event is located to a tolerance: there the reset has the state beside the guard.
        let beside = |n: usize| self.size(&reset.row(n).into_owned(), end.as_slice());
        (0..states).map(|n| self.growth(segment, &moved(n)).max(beside(n))).collect()
    }

    /// The changes of what the reset of an `until` makes of the states at a segment's end.
    pub(super) fn growth_of_reset(&self, segment: &Segment, until: usize) -> Vec<f64> {
        let reset = &self.resets[segment.mode][until];
        (0..self.states()).map(|n| self.growth(segment, &reset.row(n).into_owned())).collect()
    }

    /// The changes of the states at a segment's end, in the same mode.
    pub(super) fn growth_of_flow(&self, segment: &Segment) -> Vec<f64> {
        let states = self.states();
        let unit = |n: usize| RowDVector::from_fn(states + 3, |_, k| f64::from(u8::from(n == k)));
        (0..states).map(|n| self.growth(segment, &unit(n))).collect()
    }
}

/// The value of a row at a point.
pub(super) fn value(row: &RowDVector<f64>, point: &DVector<f64>) -> Value {
    let terms = row.iter().zip(point.iter()).map(|(a, b)| a * b);
    let (value, size) = terms.fold((0.0, 0.0), |(value, size), it| (value + it, size + it.abs()));
    Value { value, rounding: ZERO_TOLERANCE * size }
}

fn row(row: &Row) -> RowDVector<f64> {
    RowDVector::from_row_slice(row)
}

fn matrix(system: &System, mode: &Mode) -> DMatrix<f64> {
    let states = system.states.len();
    let size = states + 3;
    let mut matrix = DMatrix::zeros(size, size);
    for n in 0..states {
        matrix.row_mut(n).copy_from(&row(&mode.rate(n)));
    }
    matrix[(states, states + 1)] = -system.omega;
    matrix[(states + 1, states)] = system.omega;
    matrix
}

fn reset(system: &System, until: &Until) -> DMatrix<f64> {
    let states = system.states.len();
    let mut matrix = DMatrix::identity(states + 3, states + 3);
    for (n, entries) in until.reset.iter().flatten().enumerate() {
        matrix.row_mut(n).copy_from(&row(entries));
    }
    matrix
}
