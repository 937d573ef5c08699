//! The oscillator's sections, exponents and orbits.

use crate::arrays::table;
use crate::failure::value;
use crate::long_work::{Progress, WORK_PARTS, attended, interruptible};
use crate::oscillator::{MAX_PERIODS, Oscillator};
use numpy::PyArray2;
use percuss::dynamics::batches::Stationarity;
use percuss::dynamics::lyapunov::Spectrum;
use percuss::dynamics::orbit::{Orbit, scan};
use percuss::dynamics::section::Section;
use percuss::dynamics::strobe::StrobeMap;
use pyo3::IntoPyObject;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::{Bound, Py, PyAny, PyResult, Python, pyfunction};

/// The longest period of an orbit that is looked for.
pub(crate) const MAX_ORBIT_PERIODS: u32 = 10_000;

/// Refuses a run that is too long, or that has nothing to tell.
pub(crate) fn check_periods(transient: u64, periods: u64) -> PyResult<()> {
    let whole = transient.saturating_add(periods);
    if periods == 0 || whole > MAX_PERIODS {
        return Err(value(format!(
            "transient = {transient} and periods = {periods} are not accepted: periods from 1 on, \
             and at most {MAX_PERIODS} together, are"
        )));
    }
    Ok(())
}

/// The states (p, y, q, v) once a forcing period, at a forcing angle.
#[pyfunction]
pub(crate) fn poincare<'py>(
    py: Python<'py>,
    oscillator: &Oscillator,
    transient: u64,
    periods: u64,
    section: f64,
    told: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    check_periods(transient, periods)?;
    // Written so that a NaN is refused.
    let is_angle = section.abs() <= 1e15;
    if !is_angle {
        return Err(value(format!("section = {section} is not accepted: -1e15 to 1e15 is")));
    }
    let Oscillator { model, entry, .. } = oscillator;
    let points = attended(py, &Progress { told, all: periods }, |stop| {
        let first = entry.instant.after_periods(transient, 1).first_at_angle(section);
        let segments = model.trajectory(*entry).until(first.after_periods(periods, 1));
        let strobes = Section::along(segments.inspect(|_| stop.look()), first);
        let mut points = Vec::new();
        for (_, strobe) in (0..periods).zip(strobes) {
            stop.passed(1);
            points.extend(strobe.point());
            points.push(strobe.v());
        }
        points
    })?;
    table(py, points, 4)
}

/// The exponents and the drift of a motion.
#[derive(IntoPyObject)]
pub(crate) struct Exponents {
    exponents_per_period: Vec<f64>,
    standard_error: Vec<f64>,
    stationary: Option<bool>,
    contraction_per_period: f64,
    drift_per_period: f64,
    drift_standard_error: f64,
    undecidable: bool,
}

/// Whether a motion is stationary; none where too few batches tell.
pub(crate) fn stationary(found: Stationarity) -> Option<bool> {
    match found {
        Stationarity::Unknown => None,
        Stationarity::Stationary => Some(true),
        Stationarity::ChangesAfter(_) => Some(false),
    }
}

/// The Lyapunov exponents of the motion, per forcing period.
#[pyfunction]
pub(crate) fn lyapunov(
    py: Python<'_>,
    oscillator: &Oscillator,
    transient: u64,
    periods: u64,
    told: Option<Py<PyAny>>,
) -> PyResult<Exponents> {
    check_periods(transient, periods)?;
    let Oscillator { model, entry, .. } = oscillator;
    let all = transient + periods;
    let (omega, period) = (model.parameters().omega, model.period());
    let found = attended(py, &Progress { told, all }, |stop| {
        Spectrum::observe(model, *entry, transient, periods, &mut |segment| {
            let passed = segment.entry().instant.since(&entry.instant, omega).value() / period;
            stop.reached(passed as u64);
        })
    })?;
    Ok(Exponents {
        exponents_per_period: found.exponents_per_period.to_vec(),
        standard_error: found.standard_error.to_vec(),
        stationary: stationary(found.stationarity),
        contraction_per_period: found.contraction_per_period,
        drift_per_period: found.drift_per_period,
        drift_standard_error: found.drift_standard_error,
        undecidable: found.undecidable,
    })
}

/// Refuses a period of an orbit that is not looked for.
pub(crate) fn check_period(period: u32) -> PyResult<()> {
    if (1..=MAX_ORBIT_PERIODS).contains(&period) {
        return Ok(());
    }
    Err(value(format!("period = {period} is not accepted: 1 to {MAX_ORBIT_PERIODS} are")))
}

/// A periodic orbit.
#[derive(IntoPyObject)]
pub(crate) struct FoundOrbit<'py> {
    points: Bound<'py, PyArray2<f64>>,
    multipliers: Vec<(f64, f64)>,
    phases: Vec<&'static str>,
    stable: bool,
    residual: f64,
    drift_per_period: f64,
}

impl<'py> FoundOrbit<'py> {
    fn new(py: Python<'py>, orbit: &Orbit) -> PyResult<Self> {
        Ok(Self {
            points: table(py, orbit.points.concat(), 3)?,
            multipliers: orbit.multipliers.iter().map(|[re, im]| (*re, *im)).collect(),
            phases: orbit.phases.iter().map(|it| it.as_str()).collect(),
            stable: orbit.is_stable(),
            residual: orbit.residual,
            drift_per_period: orbit.drift_per_period,
        })
    }
}

/// The orbits of a period: that to which the start leads Newton's method, or those of a scan.
#[pyfunction]
pub(crate) fn orbits<'py>(
    py: Python<'py>,
    oscillator: &Oscillator,
    period: u32,
    from_start: bool,
    told: Option<Py<PyAny>>,
) -> PyResult<Vec<FoundOrbit<'py>>> {
    check_period(period)?;
    let map = StrobeMap::new(oscillator.model, oscillator.entry.instant);
    let found = interruptible(py, &Progress { told, all: WORK_PARTS }, |stop| {
        if !from_start {
            return Ok(scan(&map, period, &mut |share| stop.share(share)));
        }
        let orbit = Orbit::find(&map, oscillator.entry.point(), period);
        orbit.map(|it| vec![it]).map_err(|none| none.to_string())
    })?;
    let found = found.map_err(PyValueError::new_err)?;
    found.iter().map(|orbit| FoundOrbit::new(py, orbit)).collect()
}
