//! The bifurcation diagrams of a system.

use crate::diagram::check_points;
use crate::failure::value;
use crate::long_work::{Progress, interruptible};
use crate::returns::{Points, check_returns, solver};
use crate::section::Section;
use crate::system::System;
use numpy::PyArray1;
use percuss::affine::{Return, ReturnDiagram};
use percuss::dynamics::diagram::{Follow, values};
use pyo3::IntoPyObject;
use pyo3::prelude::{Bound, Py, PyAny, PyResult, Python, pyfunction};

/// The returns at each value of a parameter.
#[derive(IntoPyObject)]
pub(crate) struct ReturnsDiagrammed<'py> {
    /// The values, each once.
    values: Bound<'py, PyArray1<f64>>,
    /// The index of its value for each return.
    steps: Bound<'py, PyArray1<i64>>,
    points: Points<'py>,
    /// The reasons for which values are left out, empty where they are not.
    left_out: Vec<String>,
    undecidable: Bound<'py, PyArray1<i64>>,
}

/// The returns of a system's motion to a section at each of some values of a parameter.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the face in Python gives them names")]
pub(crate) fn system_bifurcation<'py>(
    py: Python<'py>,
    system: &System,
    section: &Section,
    parameter: &str,
    ends: [f64; 2],
    steps: u32,
    transient: u64,
    returns: u32,
    reset: bool,
    told: Option<Py<PyAny>>,
) -> PyResult<ReturnsDiagrammed<'py>> {
    check_returns(transient, u64::from(returns))?;
    check_points(steps, returns)?;
    // What does not fit the system is told as such, before any value is.
    system.file.clone().set(parameter, ends[0], "parameter").map_err(value)?;
    let solver = solver(system)?;
    section.map(&solver)?;
    let follow = if reset { Follow::Reset } else { Follow::Carry };
    let (section, longest) = (section.section(), section.longest);
    let diagram = ReturnDiagram { section, longest, transient, returns, follow };
    let values = values(ends[0], ends[1], steps);
    let at = |value: f64| {
        let mut file = system.file.clone();
        file.set(parameter, value, "parameter")?;
        file.system()
    };
    let found = interruptible(py, &Progress { told, all: u64::from(steps) }, |stop| {
        diagram.steps(&values, at, |count| stop.passed(count))
    })?;
    let found = found.map_err(value)?;
    let places = found.iter().enumerate();
    let places = places.flat_map(|(n, it)| it.points.iter().map(move |_| n as i64));
    let points: Vec<Return<f64>> = found.iter().flat_map(|it| it.points.iter().cloned()).collect();
    let left_out = found.iter().map(|it| it.left_out.map(|it| it.to_string()).unwrap_or_default());
    let undecidable = found.iter().map(|it| it.undecidable as i64).collect();
    Ok(ReturnsDiagrammed {
        steps: PyArray1::from_vec(py, places.collect()),
        points: Points::new(py, &system.shared.system, &points)?,
        left_out: left_out.collect(),
        undecidable: PyArray1::from_vec(py, undecidable),
        values: PyArray1::from_vec(py, values),
    })
}
