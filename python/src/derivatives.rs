//! The derivatives of a run's rows by names, as arrays and as digits.

use crate::arrays::{Nearest, cube, table};
use crate::collect::Kept;
use crate::gradient::ByName;
use numpy::{PyArray2, PyArray3};
use percuss::{NoGradient, Proved};
use pyo3::IntoPyObject;
use pyo3::prelude::{Bound, PyResult, Python};

/// The derivatives of all rows by all names.
#[derive(IntoPyObject)]
pub(crate) struct Derivatives<'py> {
    /// Those of the times, NaN where there is none.
    time: Bound<'py, PyArray2<f64>>,
    state: Bound<'py, PyArray3<f64>>,
    /// The reasons why there are none, empty where there are.
    reason: Vec<Vec<String>>,
    /// Whether those of the two sides differ.
    differs: Vec<Vec<bool>>,
}

/// The proved digits of the derivatives, empty where there are none.
#[derive(IntoPyObject)]
pub(crate) struct DerivativeDigits {
    time: Vec<Vec<String>>,
    state: Vec<Vec<Vec<String>>>,
}

/// The number of names and of states.
pub(crate) type Shape = [usize; 2];

/// The derivatives of rows on a side, as arrays.
pub(crate) fn derivatives<'py, V: Nearest>(
    py: Python<'py>,
    rows: &[Kept<V>],
    side: Option<usize>,
    shape: Shape,
) -> PyResult<Derivatives<'py>> {
    let [names, states] = shape;
    let cells = || rows.iter().flat_map(|row| &row.gradients).map(|it| it.on(side));
    let time = cells().map(|it| it.as_ref().map_or(f64::NAN, |it| it.time().nearest()));
    let state = cells().flat_map(|it| match it {
        Ok(it) => it.state().iter().map(Nearest::nearest).collect(),
        Err(_) => vec![f64::NAN; states],
    });
    let reason = |it: &ByName<V>| it.on(side).as_ref().err().map_or_else(String::new, said);
    Ok(Derivatives {
        time: table(py, time.collect(), names)?,
        state: cube(py, state.collect(), [rows.len(), names, states])?,
        reason: rows.iter().map(|row| row.gradients.iter().map(reason).collect()).collect(),
        differs: rows
            .iter()
            .map(|row| row.gradients.iter().map(|it| it.sides.is_some()).collect())
            .collect(),
    })
}

fn said(reason: &NoGradient) -> String {
    reason.to_string()
}

/// The proved digits of the derivatives, at most so many.
pub(crate) fn digits(
    rows: &[Kept<Proved>],
    side: Option<usize>,
    states: usize,
    most: usize,
) -> DerivativeDigits {
    let time = |it: &ByName<Proved>| match it.on(side) {
        Ok(it) => it.time().to_digits(most),
        Err(_) => String::new(),
    };
    let state = |it: &ByName<Proved>| match it.on(side) {
        Ok(it) => it.state().iter().map(|it| it.to_digits(most)).collect(),
        Err(_) => vec![String::new(); states],
    };
    DerivativeDigits {
        time: rows.iter().map(|row| row.gradients.iter().map(time).collect()).collect(),
        state: rows.iter().map(|row| row.gradients.iter().map(state).collect()).collect(),
    }
}
