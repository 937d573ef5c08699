//! The attractors of a grid of a system's starts with their basins, and the orbits.

use crate::dynamics::check_period;
use crate::failure::value;
use crate::long_work::{Progress, interruptible};
use crate::returns::{Points, ReturnOrbit, drifts, solver};
use crate::section::Section;
use crate::survey::check_grid;
use crate::system::System;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use percuss::InputError;
use percuss::affine::{Plane, ReturnAttractor, ReturnBasins, SectionMap, StartPoint, SystemError};
use percuss::dynamics::attractor::{Label, SearchLimits, Window};
use pyo3::IntoPyObject;
use pyo3::prelude::{Bound, Py, PyAny, PyResult, Python, pyfunction};
use std::collections::BTreeMap;

/// The attractor that each start of a grid reaches.
#[derive(IntoPyObject)]
pub(crate) struct ReturnsSurveyed<'py> {
    across: Bound<'py, PyArray1<f64>>,
    up: Bound<'py, PyArray1<f64>>,
    labels: Bound<'py, PyArray2<i32>>,
    attractors: Vec<Reached<'py>>,
    escaping: f64,
    unresolved: f64,
    inadmissible: f64,
    ended: f64,
}

/// An attractor.
#[derive(IntoPyObject)]
struct Reached<'py> {
    kind: &'static str,
    period: Option<usize>,
    fraction: f64,
    fraction_error: f64,
    points: Points<'py>,
    multipliers: Vec<(f64, f64)>,
    lyapunov_per_return: f64,
    lyapunov_error: f64,
    drift_per_return: BTreeMap<String, f64>,
    drift_standard_error: BTreeMap<String, f64>,
}

impl<'py> Reached<'py> {
    fn new(
        py: Python<'py>,
        system: &percuss::System,
        basins: &ReturnBasins,
        (id, attractor): (usize, &ReturnAttractor),
    ) -> PyResult<Self> {
        let label = Label::Attractor(id);
        let multipliers = attractor.orbit.iter().flat_map(|it| &it.multipliers);
        Ok(Self {
            kind: attractor.kind.as_str(),
            period: attractor.period(),
            fraction: basins.fraction(label),
            fraction_error: basins.fraction_error(label),
            points: Points::new(py, system, &attractor.points)?,
            multipliers: multipliers.map(|[re, im]| (*re, *im)).collect(),
            lyapunov_per_return: attractor.lyapunov_per_return,
            lyapunov_error: attractor.lyapunov_error,
            drift_per_return: drifts(system, &attractor.drift_per_return),
            drift_standard_error: drifts(system, &attractor.drift_standard_error),
        })
    }
}

/// Refuses a range of starts that is empty or not bounded.
fn check_range(name: &str, [low, high]: [f64; 2]) -> PyResult<()> {
    let window = Window { p: [low, high], y: [low, high] };
    window.check().map_err(|error| match error {
        InputError::OutOfRange { accepted, .. } => {
            value(format!("{name} = ({low}, {high}) is not accepted: {accepted}"))
        }
        error => value(error),
    })
}

fn plane(
    axes: [usize; 2],
    (across, up): ([f64; 2], [f64; 2]),
    [columns, rows]: [u32; 2],
) -> PyResult<Plane> {
    check_range("across", across)?;
    check_range("up", up)?;
    Ok(Plane { axes, window: [across, up], columns, rows })
}

/// Does work on the starts of a plane, which tells of how many more are done.
fn on_starts<T: Send>(
    py: Python<'_>,
    (system, section): (&System, &Section),
    plane: &Plane,
    told: Option<Py<PyAny>>,
    work: impl FnOnce(&SectionMap<'_, f64>, &StartPoint, &Seen<'_>) -> Result<T, SystemError> + Send,
) -> PyResult<T> {
    let solver = solver(system)?;
    let map = section.map(&solver)?;
    let start = system.shared.system.start().map_err(value)?;
    let all = plane.count() as u64;
    let done = interruptible(py, &Progress { told, all }, |stop| {
        work(&map, start, &|count| stop.passed(count))
    })?;
    done.map_err(value)
}

/// Hears of how many starts more are done.
type Seen<'s> = dyn Fn(u64) + Sync + 's;

/// The orbits that Newton's method reaches from a grid of a system's starts in two states.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the face in Python gives them names")]
pub(crate) fn system_orbits<'py>(
    py: Python<'py>,
    system: &System,
    section: &Section,
    axes: [usize; 2],
    window: ([f64; 2], [f64; 2]),
    grid: [u32; 2],
    period: u32,
    told: Option<Py<PyAny>>,
) -> PyResult<Vec<ReturnOrbit<'py>>> {
    check_period(period)?;
    check_grid(grid, 1, 1)?;
    let plane = plane(axes, window, grid)?;
    let found = on_starts(py, (system, section), &plane, told, |map, start, seen| {
        map.orbits(start, &plane, period, seen)
    })?;
    found.iter().map(|it| ReturnOrbit::new(py, &system.shared.system, it)).collect()
}

/// The attractors of a grid of a system's starts in two states, and the label of each start.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the face in Python gives them names")]
pub(crate) fn system_basins<'py>(
    py: Python<'py>,
    system: &System,
    section: &Section,
    axes: [usize; 2],
    window: ([f64; 2], [f64; 2]),
    grid: [u32; 2],
    transient: u64,
    max_period: u32,
    told: Option<Py<PyAny>>,
) -> PyResult<ReturnsSurveyed<'py>> {
    check_grid(grid, transient, max_period)?;
    let plane = plane(axes, window, grid)?;
    let limits = SearchLimits { transient, max_period };
    let found = on_starts(py, (system, section), &plane, told, |map, start, seen| {
        map.basins(start, &plane, limits, seen)
    })?;
    let system = &system.shared.system;
    let labels = found.labels.iter().map(|it| it.number()).collect();
    let [columns, rows] = grid.map(|it| it as usize);
    let listed = found.attractors.iter().enumerate();
    Ok(ReturnsSurveyed {
        across: PyArray1::from_vec(py, plane.centres(0)),
        up: PyArray1::from_vec(py, plane.centres(1)),
        labels: PyArray1::from_vec(py, labels).reshape([rows, columns])?,
        attractors: listed
            .map(|it| Reached::new(py, system, &found, it))
            .collect::<PyResult<_>>()?,
        escaping: found.fraction(Label::Escaping),
        unresolved: found.fraction(Label::Unresolved),
        inadmissible: found.fraction(Label::Inadmissible),
        ended: found.fraction(Label::Ended),
    })
}
