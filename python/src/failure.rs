//! Errors, as Python's own exceptions.

use pyo3::PyErr;
use pyo3::exceptions::{PyTypeError, PyValueError};
use std::fmt::Display;

/// A value that is not accepted.
pub(crate) fn value(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Arguments that do not go together.
pub(crate) fn arguments(error: &str) -> PyErr {
    PyTypeError::new_err(error.to_owned())
}
