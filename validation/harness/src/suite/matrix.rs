//! The whole matrix: every engine on every case at every tolerance, in parallel and in order.

use super::probes::{Extent, Probes};
use super::scope::Suite;
use crate::case::{Case, Defaults, FileError};
use crate::engine::{Accuracy, Engine, Failure, Limits, Outcome, Role, SampleGrid, Task, answer};
use crate::number::brief;
use crate::score::attractor::{AttractorTest, Calibrated, calibrated};
use crate::score::{
    Expected, Graze, Measures, RowJudgement, RunGrowth, ScoredRun, Subject, Verdict, WINDOW,
    grazes, judge, measure,
};
use crate::truth::{Library, Truth};
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// A case made ready: checked, with its truth and the growth along it.
pub struct Prepared {
    /// The case.
    pub case: Case,
    /// The case's truth.
    pub truth: Truth,
    /// How errors grow along it.
    pub growth: RunGrowth,
    /// The places at which the case's guards come close to a threshold.
    pub grazes: Vec<Graze>,
    task: Task,
    probes: Probes,
}

/// How a run ended.
#[derive(Clone, Debug)]
pub enum Status {
    /// The run has a result.
    Ok(Box<Measures>, Outcome),
    /// The run has no result; the reason.
    Failed(Failure),
    /// The engine is not installed.
    Unavailable,
    /// It would have cost more than the suite's budget.
    NotRun,
}

/// A row of the report with what was measured.
#[derive(Clone, Debug)]
pub struct Scored {
    /// The case's name.
    pub case: String,
    /// The engine's name.
    pub engine: &'static str,
    /// What the engine is run for beside its rows.
    pub role: Role,
    /// What it was asked for.
    pub accuracy: Accuracy,
    /// The row's unit of error.
    pub unit: f64,
    /// The truth's events on the case's horizon.
    pub events: usize,
    /// How it ended.
    pub status: Status,
    /// Wall time.
    pub wall: Duration,
    /// The verdict.
    pub judgement: RowJudgement,
}

/// Reads truth and growth of every case.
///
/// # Errors
/// [`FileError`] for reference data that are missing, altered or of another case.
pub fn prepare(
    cases: Vec<Case>,
    library: &Library,
    suite: Suite,
) -> Result<Vec<Prepared>, FileError> {
    let limits = calibrated()?;
    cases.into_par_iter().map(|case| prepare_one(case, library, suite, &limits)).collect()
}

fn prepare_one(
    case: Case,
    library: &Library,
    suite: Suite,
    limits: &[Calibrated],
) -> Result<Prepared, FileError> {
    let truth = library.truth(&case)?;
    let given =
        crate::case::Given { parameters: case.parameters, start: case.start, ..Default::default() };
    let problem = given.check().map_err(FileError)?;
    let grid = SampleGrid { per_period: Truth::SAMPLES_PER_PERIOD, count: truth.samples.len() };
    let task = Task::of(&case, problem, grid);
    let growth = RunGrowth::along(&truth, &case.parameters, task.forcing_angle);
    let grazes = grazes(&task, &truth, &growth);
    let probes = Probes::new(&case, &problem, suite, limits)?;
    Ok(Prepared { case, truth, growth, grazes, task, probes })
}

impl Prepared {
    /// What an engine's run measures, with probes as far as `extent` says of what the run cost a
    /// forcing period, and what the run itself gave.
    ///
    /// # Errors
    /// The engine's failure in the run itself.
    pub fn measured(
        &self,
        engine: &dyn Engine,
        accuracy: Accuracy,
        unit: f64,
        limits: &Limits,
        extent: impl FnOnce(f64) -> Extent,
    ) -> Result<(Measures, Outcome, Duration), Failure> {
        let began = Instant::now();
        let outcome = answer(engine, &self.task, accuracy, limits)?;
        let wall = began.elapsed();
        let mut measures = measure(&self.task, &self.truth, &self.growth, &outcome, unit);
        let periods = self.task.span / self.task.problem.model.period();
        let extent = extent(outcome.work.rhs_evaluations as f64 / periods.max(1.0));
        measures.probed = self.probes.ask(&self.case, engine, accuracy, unit, limits, extent);
        Ok((measures, outcome, wall))
    }

    /// A measured run as it is judged.
    #[must_use]
    pub fn as_run<'a>(&'a self, measures: &'a Measures, outcome: &'a Outcome) -> ScoredRun<'a> {
        let window = WINDOW * self.task.problem.model.period();
        ScoredRun { measures, outcome, truth: &self.truth, grazes: &self.grazes, window }
    }

    /// The same-attractor test, where the case has one.
    #[must_use]
    pub fn attractor(&self) -> Option<&AttractorTest> {
        self.probes.attractor.as_ref()
    }
}

/// Runs everything; rows come case by case in the order of `cases` and `engines`.
pub fn run(
    cases: &[Prepared],
    engines: &[&'static dyn Engine],
    suite: Suite,
    defaults: &Defaults,
    done: &(impl Fn() + Sync),
) -> Vec<Scored> {
    let jobs: Vec<_> =
        cases.iter().flat_map(|case| engines.iter().map(move |engine| (case, *engine))).collect();
    let jobs: Vec<_> = jobs
        .into_iter()
        .flat_map(|(case, engine)| {
            accuracies(engine, suite).into_iter().map(move |it| (case, engine, it))
        })
        .collect();
    let row = |(case, engine, accuracy): (&Prepared, &'static dyn Engine, Accuracy)| {
        let row = one(case, engine, accuracy, suite, defaults);
        done();
        row
    };
    // Heavy rows lie side by side: handed out one by one they do not pile up on one thread.
    jobs.into_par_iter().with_max_len(1).map(row).collect()
}

/// How many rows [`run`] makes.
#[must_use]
pub fn size(cases: usize, engines: &[&'static dyn Engine], suite: Suite) -> usize {
    cases * engines.iter().map(|engine| accuracies(*engine, suite).len()).sum::<usize>()
}

fn accuracies(engine: &dyn Engine, suite: Suite) -> Vec<Accuracy> {
    suite.accuracies(engine.declaration().stepping)
}

fn one(
    prepared: &Prepared,
    engine: &'static dyn Engine,
    accuracy: Accuracy,
    suite: Suite,
    defaults: &Defaults,
) -> Scored {
    let Prepared { case, task, .. } = prepared;
    let declaration = engine.declaration();
    let unit = declaration.stepping.unit(accuracy);
    let row = |status, wall, judgement| Scored {
        case: case.name.clone(),
        engine: declaration.name,
        role: declaration.role,
        accuracy,
        unit,
        events: prepared.truth.events.len(),
        status,
        wall,
        judgement,
    };
    let without = |status, verdict, why: String| {
        row(status, Duration::ZERO, RowJudgement::without_result(verdict, why))
    };
    if let Err(reason) = engine.available() {
        return without(Status::Unavailable, Verdict::Unavailable, reason);
    }
    let (least, budget) = (engine.least_work(task, accuracy), suite.budget());
    if least > budget {
        let reason =
            format!("at least {} right-hand sides, the budget is {}", brief(least), brief(budget));
        return without(Status::NotRun, Verdict::NotRun, reason);
    }
    let subject = Subject { case: &case.name, engine: declaration.name, accuracy, unit };
    let bounds: Vec<_> = case.bounds.iter().chain(&defaults.bounds).collect();
    let shortcomings: Vec<_> = case.shortcomings.iter().chain(&defaults.shortcomings).collect();
    let expected =
        Expected { bounds: &bounds, of_classes: &defaults.bounds, shortcomings: &shortcomings };
    let asked = (accuracy, unit);
    let extent = |work| prepared.probes.extent(suite, case, declaration.role, asked, work);
    match prepared.measured(engine, accuracy, unit, &suite.limits(), extent) {
        Ok((measures, outcome, wall)) => {
            let judgement = judge(&subject, &prepared.as_run(&measures, &outcome), &expected);
            row(Status::Ok(Box::new(measures), outcome), wall, judgement)
        }
        Err(failure) => {
            let reason = failure.0.clone();
            without(Status::Failed(failure), Verdict::Error, reason)
        }
    }
}
