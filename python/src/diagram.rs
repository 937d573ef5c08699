//! The oscillator's bifurcation diagrams.

use crate::arrays::table;
use crate::dynamics::check_periods;
use crate::failure::value;
use crate::long_work::{Progress, interruptible};
use crate::oscillator::Oscillator;
use numpy::{PyArray1, PyArray2};
use percuss::Parameter;
use percuss::dynamics::diagram::{Diagram, Follow};
use pyo3::IntoPyObject;
use pyo3::prelude::{Bound, Py, PyAny, PyResult, Python, pyfunction};

/// The most points of a diagram.
const MAX_POINTS: u64 = 10_000_000;

/// Refuses a diagram that has nothing to show, or more points than are kept.
pub(crate) fn check_points(steps: u32, each: u32) -> PyResult<()> {
    if steps == 0 || u64::from(steps) * u64::from(each) > MAX_POINTS {
        return Err(value(format!(
            "steps = {steps} is not accepted: 1 or more are, and at most {MAX_POINTS} points"
        )));
    }
    Ok(())
}

/// The strobes at each value of a parameter.
#[derive(IntoPyObject)]
pub(crate) struct Diagrammed<'py> {
    /// The values, each once.
    values: Bound<'py, PyArray1<f64>>,
    /// The index of its value for each strobe.
    steps: Bound<'py, PyArray1<i64>>,
    /// The strobes (p, y, q).
    points: Bound<'py, PyArray2<f64>>,
    drift_per_period: Bound<'py, PyArray1<f64>>,
    drift_standard_error: Bound<'py, PyArray1<f64>>,
    escapes: Bound<'py, PyArray1<bool>>,
    undecidable: Bound<'py, PyArray1<bool>>,
}

/// The strobes of the motion at each of some values of a parameter.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the face in Python gives them names")]
pub(crate) fn bifurcation<'py>(
    py: Python<'py>,
    oscillator: &Oscillator,
    parameter: &str,
    from: f64,
    to: f64,
    steps: u32,
    transient: u64,
    periods: u32,
    reset: bool,
    told: Option<Py<PyAny>>,
) -> PyResult<Diagrammed<'py>> {
    check_periods(transient, u64::from(periods))?;
    let parameter: Parameter = parameter.parse().map_err(value)?;
    check_points(steps, periods)?;
    let parameters = *oscillator.model.parameters();
    for end in [from, to] {
        parameter.set(parameters, end).check().map_err(value)?;
    }
    let follow = if reset { Follow::Reset } else { Follow::Carry };
    let start = oscillator.start;
    let diagram =
        Diagram { parameters, start, parameter, from, to, steps, transient, periods, follow };
    let found = interruptible(py, &Progress { told, all: u64::from(steps) }, |stop| {
        diagram.steps(|more| stop.passed(more))
    })?
    .map_err(value)?;
    let each = |value: &dyn Fn(usize) -> f64| (0..found.len()).map(value).collect::<Vec<f64>>();
    let places = found.iter().enumerate();
    let places = places.flat_map(|(n, it)| it.points.iter().map(move |_| n as i64));
    let points = found.iter().flat_map(|it| it.points.concat()).collect();
    let is = |flags: Vec<bool>| PyArray1::from_vec(py, flags);
    Ok(Diagrammed {
        values: PyArray1::from_vec(py, each(&|n| found[n].value)),
        steps: PyArray1::from_vec(py, places.collect()),
        points: table(py, points, 3)?,
        drift_per_period: PyArray1::from_vec(py, each(&|n| found[n].drift_per_period)),
        drift_standard_error: PyArray1::from_vec(py, each(&|n| found[n].drift_standard_error)),
        escapes: is(found.iter().map(|it| it.escapes).collect()),
        undecidable: is(found.iter().map(|it| it.undecidable).collect()),
    })
}
