//! Branches of periodic orbits, followed in a parameter.

use crate::arrays::table;
use crate::dynamics::check_period;
use crate::failure::value;
use crate::long_work::{Progress, WORK_PARTS, interruptible};
use crate::oscillator::Oscillator;
use crate::returns::check_returns;
use crate::section::Section;
use crate::system::System;
use numpy::{PyArray1, PyArray2};
use percuss::affine::{Orbit, ReturnBranch, ReturnFamily, SystemError};
use percuss::dynamics::continuation::{Branch, Family};
use percuss::dynamics::orbit::scan;
use percuss::{Parameter, System as Model};
use percuss_validation::returns;
use pyo3::IntoPyObject;
use pyo3::prelude::{Bound, Py, PyAny, PyResult, Python, pyfunction};

/// A branch of periodic orbits.
#[derive(IntoPyObject)]
pub(crate) struct Followed<'py> {
    /// The parameter's value at each orbit.
    values: Bound<'py, PyArray1<f64>>,
    /// The first point of each orbit.
    points: Bound<'py, PyArray2<f64>>,
    multipliers: Vec<Vec<(f64, f64)>>,
    stable: Vec<bool>,
    /// The mode of each first point, and the time and the events of each orbit; of a system alone.
    modes: Vec<String>,
    times: Vec<f64>,
    events: Vec<Vec<String>>,
    /// The mean drift per forcing period; of the oscillator alone.
    drift: Vec<f64>,
    bifurcations: Vec<Found>,
    period: usize,
    complete: bool,
    ending: String,
}

/// A bifurcation of a branch.
#[derive(IntoPyObject)]
pub(crate) struct Found {
    kind: &'static str,
    value: f64,
    error: f64,
    event: Option<String>,
    period: usize,
    turns: bool,
}

fn pairs(multipliers: &[[f64; 2]]) -> Vec<(f64, f64)> {
    multipliers.iter().map(|[re, im]| (*re, *im)).collect()
}

/// The ends of a range over which a parameter varies.
fn check_ends(ends: [f64; 2]) -> PyResult<()> {
    match ends.iter().find(|it| !it.is_finite()) {
        Some(end) => Err(value(format!("{end} is not accepted: a finite number is"))),
        None => Ok(()),
    }
}

/// A branch of orbits of the oscillator, from that of the start or, without one, of a scan.
#[pyfunction]
pub(crate) fn follow<'py>(
    py: Python<'py>,
    oscillator: &Oscillator,
    parameter: &str,
    ends: [f64; 2],
    period: u32,
    from_start: bool,
    told: Option<Py<PyAny>>,
) -> PyResult<Followed<'py>> {
    check_period(period)?;
    check_ends(ends)?;
    let parameter: Parameter = parameter.parse().map_err(value)?;
    let [from, to] = ends;
    let instant = oscillator.entry.instant;
    let family = Family::new(*oscillator.model.parameters(), parameter, instant);
    let map = family.map(from).map_err(value)?;
    family.map(to).map_err(value)?;
    let branch = interruptible(py, &Progress { told, all: WORK_PARTS }, |stop| {
        let guess = match from_start {
            true => oscillator.entry.point(),
            false => {
                let found = scan(&map, period, &mut |_| stop.look()).into_iter().next();
                let none = || format!("no orbit of period {period} was found by a scan of starts");
                found.ok_or_else(none)?.points[0]
            }
        };
        let branch =
            Branch::follow(&family, guess, period, from, to, &mut |share| stop.share(share));
        branch.map_err(|it| it.to_string())
    })?;
    let branch = branch.map_err(value)?;
    let points = branch.points.iter().flat_map(|it| it.orbit.points[0]).collect();
    let each = |it: fn(&percuss::dynamics::continuation::BranchPoint) -> f64| {
        branch.points.iter().map(it).collect::<Vec<f64>>()
    };
    Ok(Followed {
        values: PyArray1::from_vec(py, each(|it| it.value)),
        points: table(py, points, 3)?,
        multipliers: branch.points.iter().map(|it| pairs(&it.orbit.multipliers)).collect(),
        stable: branch.points.iter().map(|it| it.orbit.is_stable()).collect(),
        modes: Vec::new(),
        times: Vec::new(),
        events: Vec::new(),
        drift: each(|it| it.orbit.drift_per_period),
        bifurcations: branch
            .bifurcations
            .iter()
            .map(|it| Found {
                kind: it.kind.as_str(),
                value: it.value,
                error: it.error,
                event: None,
                period: it.orbit.period() as usize,
                turns: it.turns,
            })
            .collect(),
        period: branch.points.first().map_or(0, |it| it.orbit.period() as usize),
        complete: branch.is_complete(),
        ending: branch.ending.to_string(),
    })
}

/// A branch of orbits of a section's return map, from that to which a system's start leads.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the face in Python gives them names")]
pub(crate) fn system_follow<'py>(
    py: Python<'py>,
    system: &System,
    section: &Section,
    parameter: &str,
    ends: [f64; 2],
    transient: u64,
    period: u32,
    told: Option<Py<PyAny>>,
) -> PyResult<Followed<'py>> {
    check_period(period)?;
    check_returns(transient, 1)?;
    check_ends(ends)?;
    let at = |value: f64| -> Result<Model, SystemError> {
        let mut file = system.file.clone();
        file.set(parameter, value, "parameter")?;
        file.system()
    };
    let first = at(ends[0]).map_err(value)?;
    at(ends[1]).map_err(value)?;
    let solver = first.solver::<f64>().map_err(value)?;
    let map = section.map(&solver)?;
    let branch = interruptible(py, &Progress { told, all: WORK_PARTS }, |stop| {
        let (guess, _) = returns::guess(&map, transient, || stop.look())?;
        let family = ReturnFamily::new(section.section(), section.longest, &at);
        let told = &mut |share| stop.share(share);
        Ok(guess.and_then(|it| ReturnBranch::follow(&family, &it, period, ends, told)))
    })?;
    let branch = branch.map_err(|it: SystemError| value(it))?.map_err(value)?;
    of_system(py, &first, &branch)
}

fn of_system<'py>(
    py: Python<'py>,
    system: &Model,
    branch: &ReturnBranch,
) -> PyResult<Followed<'py>> {
    let orbits = || branch.points.iter().map(|(_, orbit)| orbit);
    let first = |orbit: &Orbit| orbit.points.first().cloned();
    let firsts: Vec<_> = orbits().filter_map(first).collect();
    let states = firsts.iter().flat_map(|it| it.state.iter().copied()).collect();
    Ok(Followed {
        values: PyArray1::from_vec(py, branch.points.iter().map(|it| it.0).collect()),
        points: table(py, states, system.states.len())?,
        multipliers: orbits().map(|it| pairs(&it.multipliers)).collect(),
        stable: orbits().map(Orbit::is_stable).collect(),
        modes: firsts.iter().map(|it| system.modes[it.mode].name.clone()).collect(),
        times: orbits().map(|it| it.time).collect(),
        events: orbits().map(|it| it.event_names(system)).collect(),
        drift: Vec::new(),
        bifurcations: branch
            .bifurcations
            .iter()
            .map(|it| Found {
                kind: it.kind.as_str(),
                value: it.value,
                error: it.error,
                event: it.event.map(|it| it.name(system)),
                period: it.orbit.period(),
                turns: it.turns,
            })
            .collect(),
        period: orbits().next().map_or(0, Orbit::period),
        complete: branch.is_complete(),
        ending: branch.ending.to_string(),
    })
}
