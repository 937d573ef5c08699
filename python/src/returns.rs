//! A system's motions from return to return: sections, exponents and orbits.

use crate::arrays::table;
use crate::dynamics::{check_period, stationary};
use crate::failure::value;
use crate::long_work::{Progress, attended};
use crate::oscillator::MAX_PERIODS;
use crate::section::Section;
use crate::system::System;
use numpy::{PyArray1, PyArray2};
use percuss::Solver;
use percuss::affine::{self, Orbit, Return};
use percuss_validation::returns;
use pyo3::IntoPyObject;
use pyo3::prelude::{Bound, Py, PyAny, PyResult, Python, pyfunction};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The solver of a system that has a start.
pub(crate) fn solver(system: &System) -> PyResult<Arc<Solver<f64>>> {
    let shared = &system.shared;
    shared.system.start().map_err(value)?;
    shared.solvers(false).plain(&shared.system, false).map_err(value)
}

/// Refuses a motion that is too long, or that has nothing to tell.
pub(crate) fn check_returns(transient: u64, returns: u64) -> PyResult<()> {
    if returns == 0 || transient.saturating_add(returns) > MAX_PERIODS {
        return Err(value(format!(
            "transient = {transient} and returns = {returns} are not accepted: returns from 1 on, \
             and at most {MAX_PERIODS} together, are"
        )));
    }
    Ok(())
}

/// A number of each drift of a system by its name.
pub(crate) fn drifts(system: &percuss::System, numbers: &[f64]) -> BTreeMap<String, f64> {
    let numbers = numbers.iter().copied().chain(std::iter::repeat(f64::NAN));
    let names = system.drifts().into_iter().map(|it| system.states[it].clone());
    names.zip(numbers).collect()
}

/// Returns to a section, as arrays.
#[derive(IntoPyObject)]
pub(crate) struct Points<'py> {
    time: Bound<'py, PyArray1<f64>>,
    mode: Bound<'py, PyArray1<i64>>,
    state: Bound<'py, PyArray2<f64>>,
}

impl<'py> Points<'py> {
    pub(crate) fn new(
        py: Python<'py>,
        system: &percuss::System,
        points: &[Return<f64>],
    ) -> PyResult<Self> {
        let states = points.iter().flat_map(|it| it.state.iter().copied()).collect();
        Ok(Self {
            time: PyArray1::from_vec(py, points.iter().map(|it| it.time).collect()),
            mode: PyArray1::from_vec(py, points.iter().map(|it| it.mode as i64).collect()),
            state: table(py, states, system.states.len())?,
        })
    }
}

/// The returns of a motion.
#[derive(IntoPyObject)]
pub(crate) struct Returned<'py> {
    points: Points<'py>,
    /// The reason for which there are fewer than were asked for.
    cause: Option<String>,
    undecidable: u64,
}

/// The returns of a system's motion to a section.
#[pyfunction]
pub(crate) fn system_poincare<'py>(
    py: Python<'py>,
    system: &System,
    section: &Section,
    transient: u64,
    returns: u64,
    told: Option<Py<PyAny>>,
) -> PyResult<Returned<'py>> {
    check_returns(transient, returns)?;
    let solver = solver(system)?;
    let (map, start) = (section.map(&solver)?, system.shared.system.start().map_err(value)?);
    let all = transient + returns;
    let found = attended(py, &Progress { told, all }, |stop| {
        let mut motion = map.returns(start)?;
        let (mut points, mut cause) = (Vec::new(), None);
        for (n, point) in (0..all).zip(&mut motion) {
            stop.passed(1);
            match point {
                Ok(point) if n >= transient => points.push(point),
                Ok(_) => {}
                Err(why) => cause = Some(why.to_string()),
            }
        }
        Ok((points, cause, motion.undecidable()))
    })?;
    let (points, cause, undecidable) = found.map_err(|it: affine::SystemError| value(it))?;
    Ok(Returned { points: Points::new(py, &system.shared.system, &points)?, cause, undecidable })
}

/// The exponents and the drifts of a motion.
#[derive(IntoPyObject)]
pub(crate) struct ReturnExponents {
    exponents_per_return: Vec<f64>,
    exponents_per_time: Vec<f64>,
    standard_error: Vec<f64>,
    mean_return_time: f64,
    batches: u64,
    stationary: Option<bool>,
    drift_per_return: BTreeMap<String, f64>,
    drift_standard_error: BTreeMap<String, f64>,
    undecidable: u64,
}

/// The Lyapunov exponents of a system's motion.
#[pyfunction]
pub(crate) fn system_lyapunov(
    py: Python<'_>,
    system: &System,
    section: &Section,
    transient: u64,
    returns: u64,
    told: Option<Py<PyAny>>,
) -> PyResult<ReturnExponents> {
    check_returns(transient, returns)?;
    let solver = solver(system)?;
    let map = section.map(&solver)?;
    let all = transient + returns;
    let found = attended(py, &Progress { told, all }, |stop| {
        returns::exponents(&map, transient, returns, &mut |passed| stop.reached(passed))
    })?;
    let found = found.map_err(value)?.map_err(|(why, passed)| {
        value(format!("no exponents after {passed} returns of {all}: {why}"))
    })?;
    let system = &system.shared.system;
    Ok(ReturnExponents {
        exponents_per_time: found.per_time(),
        mean_return_time: found.mean_return_time,
        batches: found.batches,
        stationary: stationary(found.stationarity),
        drift_per_return: drifts(system, &found.drift_per_return),
        drift_standard_error: drifts(system, &found.drift_standard_error),
        undecidable: found.undecidable,
        exponents_per_return: found.per_return,
        standard_error: found.standard_error,
    })
}

/// A periodic orbit of a section's return map.
#[derive(IntoPyObject)]
pub(crate) struct ReturnOrbit<'py> {
    points: Points<'py>,
    time: f64,
    events: Vec<String>,
    multipliers: Vec<(f64, f64)>,
    stable: bool,
    residual: f64,
    is_decided: bool,
    drift_per_return: BTreeMap<String, f64>,
}

impl<'py> ReturnOrbit<'py> {
    pub(crate) fn new(py: Python<'py>, system: &percuss::System, orbit: &Orbit) -> PyResult<Self> {
        Ok(Self {
            points: Points::new(py, system, &orbit.points)?,
            time: orbit.time,
            events: orbit.event_names(system),
            multipliers: orbit.multipliers.iter().map(|[re, im]| (*re, *im)).collect(),
            stable: orbit.is_stable(),
            residual: orbit.residual,
            is_decided: orbit.is_decided,
            drift_per_return: drifts(system, &orbit.drift_per_return),
        })
    }
}

/// The orbit to which the motion from a system's start leads Newton's method.
#[pyfunction]
pub(crate) fn system_orbit<'py>(
    py: Python<'py>,
    system: &System,
    section: &Section,
    transient: u64,
    period: u32,
) -> PyResult<ReturnOrbit<'py>> {
    check_period(period)?;
    check_returns(transient, 1)?;
    let solver = solver(system)?;
    let map = section.map(&solver)?;
    let found = attended(py, &Progress::default(), |stop| {
        let (guess, _) = returns::guess(&map, transient, || stop.look())?;
        Ok(guess.and_then(|it| map.orbit(&it, period)))
    })?;
    let found = found.map_err(|it: affine::SystemError| value(it))?.map_err(value)?;
    ReturnOrbit::new(py, &system.shared.system, &found)
}
