//! Numbers as arrays that Python owns.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use percuss::Proved;
use pyo3::prelude::{Bound, PyResult, Python};

/// The f64 next to a number.
pub(crate) trait Nearest {
    fn nearest(&self) -> f64;
}

impl Nearest for Proved {
    fn nearest(&self) -> f64 {
        self.midpoint()
    }
}

impl Nearest for f64 {
    fn nearest(&self) -> f64 {
        *self
    }
}

/// A table of numbers as an array with so many columns.
pub(crate) fn table<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    columns: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows = numbers.len().checked_div(columns).unwrap_or(0);
    PyArray1::from_vec(py, numbers).reshape([rows, columns])
}

/// Numbers as an array of three dimensions.
pub(crate) fn cube<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    shape: [usize; 3],
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    PyArray1::from_vec(py, numbers).reshape(shape)
}
