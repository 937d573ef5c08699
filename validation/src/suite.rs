//! The whole matrix: every engine on every case at every tolerance, in parallel and in order.

use crate::case::{Bound, Case, FileError};
use crate::engine::{Engine, Failure, Grid, Limits, Outcome, Stepping, Task, contain};
use crate::score::{Growth, Judgement, Measures, Verdict, judge, measure};
use crate::truth::{Library, Truth};
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// How much is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Suite {
    /// Two tolerances, under a minute.
    Quick,
    /// Three tolerances.
    Full,
}

impl Suite {
    /// The tolerances of adaptive engines.
    #[must_use]
    pub fn tolerances(self) -> &'static [f64] {
        match self {
            Self::Quick => &[1e-6, 1e-9],
            Self::Full => &[1e-6, 1e-9, 1e-12],
        }
    }
}

/// A case made ready: checked, with its truth and the growth along it.
pub struct Prepared {
    /// The case.
    pub case: Case,
    /// Its truth.
    pub truth: Truth,
    growth: Growth,
    task: Task,
}

/// How a run ended.
#[derive(Clone, Debug)]
pub enum Status {
    /// With a result.
    Ok(Box<Measures>, Outcome),
    /// Without one.
    Failed(Failure),
    /// The engine is not installed.
    Unavailable(String),
}

/// One row of the report.
#[derive(Clone, Debug)]
pub struct Scored {
    /// The case's name.
    pub case: String,
    /// The engine's name.
    pub engine: &'static str,
    /// Its tolerance, where it has one.
    pub tolerance: Option<f64>,
    /// How it ended.
    pub status: Status,
    /// Wall time.
    pub wall: Duration,
    /// The verdict.
    pub judgement: Judgement,
}

/// Reads truth and growth of every case.
///
/// # Errors
/// [`FileError`] for reference data that are missing, altered or of another case.
pub fn prepare(cases: Vec<Case>, library: &Library) -> Result<Vec<Prepared>, FileError> {
    cases.into_iter().map(|case| prepare_one(case, library)).collect()
}

fn prepare_one(case: Case, library: &Library) -> Result<Prepared, FileError> {
    let truth = library.truth(&case)?;
    let given =
        crate::case::Given { parameters: case.parameters, start: case.start, ..Default::default() };
    let problem = given.check().map_err(FileError)?;
    let grid = Grid { per_period: Truth::SAMPLES_PER_PERIOD, count: truth.samples.len() };
    let task = Task::of(&case, problem, grid);
    let growth = Growth::along(&truth, &case.parameters, task.forcing_angle);
    Ok(Prepared { case, truth, growth, task })
}

/// Runs everything; rows come case by case in the order of `cases` and `engines`.
pub fn run(
    cases: &[Prepared],
    engines: &[&'static dyn Engine],
    suite: Suite,
    bounds: &[Bound],
    done: &(impl Fn() + Sync),
) -> Vec<Scored> {
    let jobs: Vec<_> =
        cases.iter().flat_map(|case| engines.iter().map(move |engine| (case, *engine))).collect();
    let jobs: Vec<_> = jobs
        .into_iter()
        .flat_map(|(case, engine)| {
            tolerances(engine, suite).into_iter().map(move |t| (case, engine, t))
        })
        .collect();
    let row = |(case, engine, tolerance): (&Prepared, &'static dyn Engine, Option<f64>)| {
        let row = one(case, engine, tolerance, bounds);
        done();
        row
    };
    // Heavy rows lie side by side: handed out one by one they do not pile up on one thread.
    jobs.into_par_iter().with_max_len(1).map(row).collect()
}

/// How many rows [`run`] makes.
#[must_use]
pub fn size(cases: usize, engines: &[&'static dyn Engine], suite: Suite) -> usize {
    cases * engines.iter().map(|engine| tolerances(*engine, suite).len()).sum::<usize>()
}

fn tolerances(engine: &dyn Engine, suite: Suite) -> Vec<Option<f64>> {
    match engine.declaration().stepping {
        Stepping::Exact => vec![None],
        Stepping::Adaptive => suite.tolerances().iter().copied().map(Some).collect(),
    }
}

fn one(
    prepared: &Prepared,
    engine: &'static dyn Engine,
    tolerance: Option<f64>,
    defaults: &[Bound],
) -> Scored {
    let Prepared { case, truth, growth, task } = prepared;
    let name = engine.declaration().name;
    let row = |status, wall, judgement| Scored {
        case: case.name.clone(),
        engine: name,
        tolerance,
        status,
        wall,
        judgement,
    };
    if let Err(reason) = engine.available() {
        let verdict = Verdict::Unavailable;
        let judgement =
            Judgement { bounds: Vec::new(), verdict, expected: false, why: reason.clone() };
        return row(Status::Unavailable(reason), Duration::ZERO, judgement);
    }
    let began = Instant::now();
    let result = contain(|| engine.run(task, tolerance, &Limits::default()));
    let wall = began.elapsed();
    let bounds: Vec<_> = case.bounds.iter().chain(defaults).collect();
    match result {
        Ok(outcome) => {
            let unit = tolerance.unwrap_or(f64::EPSILON);
            let measures = measure(task, truth, growth, &outcome, unit);
            let whole = growth.scored_samples(unit) == truth.samples.len();
            let judgement =
                judge(name, tolerance, Ok((&measures, whole)), &bounds, &case.shortcomings);
            row(Status::Ok(Box::new(measures), outcome), wall, judgement)
        }
        Err(failure) => {
            let judgement = judge(name, tolerance, Err(&failure.0), &bounds, &case.shortcomings);
            row(Status::Failed(failure), wall, judgement)
        }
    }
}
