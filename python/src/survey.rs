//! The oscillator's attractors and their basins.

use crate::arrays::table;
use crate::dynamics::MAX_ORBIT_PERIODS;
use crate::failure::value;
use crate::long_work::{Progress, interruptible};
use crate::oscillator::{MAX_PERIODS, Oscillator};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use percuss::dynamics::attractor::{Basins, Grid, Label, SearchLimits, Window};
use percuss::dynamics::strobe::StrobeMap;
use pyo3::IntoPyObject;
use pyo3::prelude::{Bound, Py, PyAny, PyResult, Python, pyfunction};

/// The most cells along a side of a grid.
const MAX_CELLS_PER_SIDE: u32 = 65_536;

/// The most cells of a grid.
const MAX_CELLS: u64 = 1 << 28;

/// The attractor that each start of a grid reaches.
#[derive(IntoPyObject)]
pub(crate) struct Surveyed<'py> {
    p: Bound<'py, PyArray1<f64>>,
    y: Bound<'py, PyArray1<f64>>,
    labels: Bound<'py, PyArray2<i32>>,
    attractors: Vec<Found<'py>>,
    escaping: f64,
    unresolved: f64,
}

/// An attractor.
#[derive(IntoPyObject)]
pub(crate) struct Found<'py> {
    kind: &'static str,
    period: Option<u32>,
    fraction: f64,
    fraction_error: f64,
    points: Bound<'py, PyArray2<f64>>,
    drift_per_period: f64,
    drift_standard_error: f64,
    lyapunov_per_period: f64,
    lyapunov_error: f64,
}

/// Refuses a grid that is too large, and limits of the search that are.
pub(crate) fn check_grid(
    [columns, rows]: [u32; 2],
    transient: u64,
    max_period: u32,
) -> PyResult<()> {
    let is_side = |it: u32| (1..=MAX_CELLS_PER_SIDE).contains(&it);
    if !(is_side(columns) && is_side(rows) && u64::from(columns) * u64::from(rows) <= MAX_CELLS) {
        return Err(value(format!(
            "grid = ({columns}, {rows}) is not accepted: 1 to {MAX_CELLS_PER_SIDE} each, and at \
             most {MAX_CELLS} starts, are"
        )));
    }
    if !(1..=MAX_PERIODS).contains(&transient) {
        return Err(value(format!(
            "transient = {transient} is not accepted: 1 to {MAX_PERIODS} are"
        )));
    }
    if !(1..=MAX_ORBIT_PERIODS).contains(&max_period) {
        return Err(value(format!(
            "max_period = {max_period} is not accepted: 1 to {MAX_ORBIT_PERIODS} are"
        )));
    }
    Ok(())
}

/// The attractors of a grid of starts, and the label of each start.
#[pyfunction]
pub(crate) fn basins<'py>(
    py: Python<'py>,
    oscillator: &Oscillator,
    window: ([f64; 2], [f64; 2]),
    grid: [u32; 2],
    transient: u64,
    max_period: u32,
    told: Option<Py<PyAny>>,
) -> PyResult<Surveyed<'py>> {
    let ((p, y), [columns, rows]) = (window, grid);
    let window = Window { p, y };
    window.check().map_err(value)?;
    check_grid(grid, transient, max_period)?;
    let Oscillator { model, start, entry } = oscillator;
    let map = StrobeMap::new(*model, entry.instant);
    let grid = Grid { window, columns, rows, q: start.q.unwrap_or(0.0) };
    let limits = SearchLimits { transient, max_period };
    let all = u64::from(columns) * u64::from(rows);
    let found = interruptible(py, &Progress { told, all }, |stop| {
        Basins::new(&map, &grid, limits, &|count| stop.passed(count))
    })?;
    let labels = found.labels.iter().map(|it| it.number()).collect();
    let labels = PyArray1::from_vec(py, labels).reshape([rows as usize, columns as usize])?;
    let attractors = found.attractors.iter().enumerate().map(|(n, it)| {
        let label = Label::Attractor(n);
        Ok(Found {
            kind: it.kind.as_str(),
            period: it.period(),
            fraction: found.fraction(label),
            fraction_error: found.fraction_error(label),
            points: table(py, it.points.concat(), 3)?,
            drift_per_period: it.drift_per_period,
            drift_standard_error: it.drift_standard_error,
            lyapunov_per_period: it.lyapunov_per_period,
            lyapunov_error: it.lyapunov_error,
        })
    });
    Ok(Surveyed {
        p: PyArray1::from_vec(py, grid.p()),
        y: PyArray1::from_vec(py, grid.y()),
        labels,
        attractors: attractors.collect::<PyResult<_>>()?,
        escaping: found.fraction(Label::Escaping),
        unresolved: found.fraction(Label::Unresolved),
    })
}
