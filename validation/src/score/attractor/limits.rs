//! The limits of the distances: measured on reference runs, extrapolated to a family-wise level.
//!
//! `attractors.toml` holds them; `cargo run --release --example calibrate` makes it again. With m and
//! s the mean and standard deviation over [`NULL_RUNS`] runs of the exact solver against the
//! reference, a limit is |m| + z s of the difference itself for exponent and drift, which are means
//! over many periods and so nearly normal. The other distances are positive, and fall off as fast as a
//! normal variable: exp(m + z s) of their logarithms errs on the generous side. z belongs to the level
//! of the whole family of comparisons that a run of the suite makes.

use super::distance::{Distances, STATISTICS, distances};
use super::section::{Section, run_of};
use crate::case::{Case, FileError};
use crate::engine::{self, Accuracy, Engine, Failure, Limits};
use percuss::{Parameters, Start};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Reference runs from which a limit is taken.
pub const NULL_RUNS: u32 = 1000;
/// The normal quantile of 1 - 1e-3/(500 x 17) = 1 - 1.2e-7, rounded up: at most one false alarm in a
/// thousand whole runs of the suite, of which each compares [`STATISTICS`] in at most 500 rows (three
/// cases, fewer than thirty engines, a few tolerances).
const QUANTILE: f64 = 5.2;

const FILE: &str = include_str!("../../../attractors.toml");

/// Where reference runs agree exactly, as where nothing drifts, an integrator need not: a length below
/// a tenth of the error up to which runs are scored, or this many periods, do not count.
const SMALLEST: f64 = 1e-4;
const ODD_PERIODS: f64 = 5.0;

/// How the comparison of a case is made.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Forcing periods that are left out.
    pub transient: u32,
    /// Forcing periods of an engine's section.
    pub periods: u32,
    /// Forcing periods of the reference section.
    pub reference_periods: u32,
}

/// A case's plan and the limits that belong to it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Calibrated {
    /// The case.
    pub case: String,
    /// How the runs are made.
    pub plan: Plan,
    /// The limit of each distance.
    pub limits: BTreeMap<String, f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    attractors: Vec<Calibrated>,
}

/// The limits of every case that has some.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn calibrated() -> Result<Vec<Calibrated>, FileError> {
    let file: File = toml::from_str(FILE)
        .map_err(|error| FileError(format!("attractors.toml: {}", error.message())))?;
    Ok(file.attractors)
}

/// Seeds of the reference and of the null runs: starts on different parts of the attractor.
const REFERENCE: u32 = 0;

/// The section of the exact solver from a start that only `seed` and the case decide.
fn exact_section(case: &Case, plan: &Plan, seed: u32) -> Result<Section, Failure> {
    // A tiny change of the start is another stretch of the same chaos after the transient.
    let p = case.start.p - f64::from(seed) * 1e-9;
    let start = Start { p, ..case.start };
    section(engine::exact(), case.parameters, start, plan, Accuracy::Exact, &Limits::default())
}

/// The reference section of a case.
pub(super) fn reference(case: &Case, plan: &Plan) -> Result<Section, Failure> {
    exact_section(case, &Plan { periods: plan.reference_periods, ..*plan }, REFERENCE)
}

/// The section of one engine's run.
pub(super) fn section(
    engine: &dyn Engine,
    parameters: Parameters,
    start: Start,
    plan: &Plan,
    accuracy: Accuracy,
    limits: &Limits,
) -> Result<Section, Failure> {
    let task = run_of(parameters, start, plan.transient + plan.periods)
        .ok_or_else(|| Failure::new("the start is refused"))?;
    let outcome = engine.run(&task, accuracy, limits)?;
    Section::of(&task, &outcome, plan.transient)
}

/// Measures the limits of a case.
///
/// # Errors
/// What the solver says.
pub fn calibrate(case: &Case, plan: Plan) -> Result<Calibrated, Failure> {
    let reference = reference(case, &plan)?;
    let sections: Result<Vec<Section>, Failure> =
        (1..=NULL_RUNS).into_par_iter().map(|seed| exact_section(case, &plan, seed)).collect();
    let sections = sections?;
    let nulls: Vec<Distances> = sections.iter().map(|it| distances(it, &reference)).collect();
    let signed = |value: fn(&Section) -> f64| {
        let differences = sections.iter().map(|it| value(it) - value(&reference)).collect();
        let (mean, deviation) = moments(differences);
        mean.abs() + QUANTILE * deviation
    };
    let limit = |name: &str| match name {
        "lyapunov" => signed(|section| section.lyapunov),
        "drift" => signed(|section| section.drift),
        _ => {
            let (mean, deviation) = moments(nulls.iter().map(|null| null[name].ln()).collect());
            (mean + QUANTILE * deviation).exp()
        }
    };
    let floor = |name: &str| match name {
        _ if name.starts_with("ks") || name == "phase_words" => {
            ODD_PERIODS / f64::from(plan.periods)
        }
        _ => SMALLEST,
    };
    let limits = STATISTICS.iter().map(|name| ((*name).to_owned(), limit(name).max(floor(name))));
    let limits = limits.collect();
    Ok(Calibrated { case: case.name.clone(), plan, limits })
}

fn moments(values: Vec<f64>) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, variance.sqrt())
}
