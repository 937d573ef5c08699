//! The states of any system as the library's: as many as the system has, and none more.
//!
//! The library asks types that do not know their own length for a zero without elements, and
//! `radau5` and `bdf` then stop at "State length mismatch", with its own `Vec` too. So a zero here
//! has the length of the states of the run on its thread, as a zero of an array has.

use crate::equations::Numbers;
use crate::system::Values;
use differential_equations::traits::State;
use std::cell::Cell;

thread_local! {
    static SIZE: Cell<usize> = const { Cell::new(0) };
}

/// Runs something whose states are so many.
pub(super) fn of_size<T>(size: usize, run: impl FnOnce() -> T) -> T {
    SIZE.set(size);
    run()
}

impl State<f64> for Values {
    fn len(&self) -> usize {
        self.as_ref().len()
    }

    fn get_component(&self, index: usize) -> f64 {
        self[index]
    }

    fn set_component(&mut self, index: usize, value: f64) {
        self[index] = value;
    }

    fn map_components_mut<F: FnMut(usize, &mut f64)>(&mut self, mut change: F) {
        self.iter_mut().enumerate().for_each(|(i, value)| change(i, value));
    }

    fn zeros_like(&self) -> Self {
        Self::all(self.as_ref().len(), 0.0)
    }

    fn zeros() -> Self {
        Self::all(SIZE.get(), 0.0)
    }

    fn copy_from_state(&mut self, other: &Self) {
        *self = *other;
    }

    fn mul_add_assign(&mut self, alpha: f64, other: &Self) {
        self.iter_mut().zip(other.iter()).for_each(|(value, other)| *value += alpha * other);
    }

    fn scale_mut(&mut self, alpha: f64) {
        self.iter_mut().for_each(|value| *value *= alpha);
    }
}
