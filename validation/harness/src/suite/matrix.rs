//! The whole matrix: every engine on every case at every tolerance, in parallel and in order.

use super::probes::{Extent, Probes, may_probe};
use super::scope::{Suite, SuiteScope};
use crate::case::{Bound, Case, Defaults, FileError, Shortcoming, percussive_oscillator};
use crate::engine::{
    Accuracy, Ended, Engine, Failure, Limits, OscillatorTask, Outcome, Role, SampleGrid, Task, answer,
    least_work,
};
use crate::number::brief;
use crate::score::attractor::{AttractorTest, Calibrated, calibrated};
use crate::score::{
    Expected, Graze, Measures, Occurrence, RowJudgement, RunGrowth, ScoredRun, Subject, Verdict,
    WINDOW, grazes, judge, measure, occurrences,
};
use crate::system::SystemProblem;
use crate::truth::{Library, Truth};
use percuss::Parameters;
use rayon::prelude::*;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A case made ready: checked, with its truth and the growth along it.
pub struct Prepared {
    /// The case.
    pub case: Case,
    /// The case's truth.
    pub truth: Truth,
    /// The growth of errors along the true run.
    pub growth: RunGrowth,
    /// The places at which the case's guards come close to a threshold.
    pub grazes: Vec<Graze>,
    occurrences: Vec<Occurrence>,
    /// The same run as one of the system `percussive-oscillator`, with exact coefficients.
    pub exact: Arc<SystemProblem>,
    task: OscillatorTask,
    asked: Task,
    probes: Probes,
}

/// A case that engines are run on.
pub trait CaseRun: Sync {
    /// The case's name.
    fn name(&self) -> &str;

    /// The truth's events on the case's horizon, with an ending that an engine has to find.
    fn events(&self) -> usize;

    /// The run that is asked for.
    fn asked(&self) -> &Task;

    /// The parameters of its model.
    fn parameters(&self) -> Vec<(&str, f64)>;

    /// The kinds of trouble that the case makes for integrators.
    fn trouble(&self) -> &[String] {
        &[]
    }

    /// The bounds that come after the case's own.
    fn defaults<'a>(&self, defaults: &'a Defaults) -> &'a [Bound] {
        &defaults.bounds
    }

    /// The case's own bounds and expected failures.
    fn expectations(&self) -> (&[Bound], &[Shortcoming]);

    /// Right-hand sides that a run takes at the least, as far as that is known beforehand.
    fn least_work(&self, engine: &dyn Engine, accuracy: Accuracy) -> f64 {
        least_work(engine, self.asked(), accuracy)
    }

    /// The limits beyond which a run is given up.
    fn limits(&self, suite: Suite) -> Limits {
        suite.limits()
    }

    /// Runs an engine and measures what it answers, in units of its error.
    ///
    /// # Errors
    /// The engine's failure in the run itself.
    fn attempt(
        &self,
        engine: &dyn Engine,
        asked: (Accuracy, f64),
        limits: &Limits,
        suite: Suite,
    ) -> Result<Measured, Failure>;

    /// The measured run in the form in which it is judged.
    fn as_run<'a>(&'a self, measures: &'a Measures) -> ScoredRun<'a>;
}

/// A run with its measures.
pub struct Measured {
    /// The measures of the run.
    pub measures: Measures,
    /// The engine's answer.
    pub outcome: Outcome,
    /// Wall time.
    pub wall: Duration,
}

/// The ending of a run.
#[derive(Clone, Debug)]
pub enum Status {
    /// The run has a result.
    Ok(Box<Measures>, Box<Outcome>),
    /// The run has no result; the reason.
    Failed(Failure),
    /// The engine is not installed.
    Unavailable,
    /// The run was left out: its cost is beyond the suite's budget.
    NotRun,
}

/// A row of the report with its measures.
#[derive(Clone, Debug)]
pub struct Scored {
    /// The case's name.
    pub case: String,
    /// The engine's name.
    pub engine: &'static str,
    /// The tests beyond ordinary rows in which the engine takes part.
    pub role: Role,
    /// The accuracy that the engine was asked for.
    pub accuracy: Accuracy,
    /// The row's unit of error.
    pub unit: f64,
    /// The truth's events on the case's horizon, with an ending that an engine has to find.
    pub events: usize,
    /// The kinds of trouble that the case makes for integrators.
    pub trouble: Vec<String>,
    /// The ending of the run.
    pub status: Status,
    /// Wall time.
    pub wall: Duration,
    /// The verdict.
    pub judgement: RowJudgement,
}

/// Reads truth and growth of every case, and makes the probes of a suite ready if one is given.
///
/// # Errors
/// [`FileError`] for reference data that are missing, altered or of another case.
pub fn prepare(
    cases: Vec<Case>,
    library: &Library,
    probes: Option<Suite>,
) -> Result<Vec<Prepared>, FileError> {
    let limits = calibrated()?;
    cases.into_par_iter().map(|case| prepare_one(case, library, probes, &limits)).collect()
}

fn prepare_one(
    case: Case,
    library: &Library,
    probes: Option<Suite>,
    limits: &[Calibrated],
) -> Result<Prepared, FileError> {
    let truth = library.truth(&case)?;
    let given =
        crate::case::Given { parameters: case.parameters, start: case.start, ..Default::default() };
    let problem = given.check().map_err(FileError)?;
    let grid = SampleGrid { per_period: Truth::SAMPLES_PER_PERIOD, count: truth.samples.len() };
    let task = OscillatorTask::of(&case, problem, grid);
    let growth = RunGrowth::along(&truth, &case.parameters, task.forcing_angle);
    let grazes = grazes(&task, &truth, &growth);
    let probes = probes.map(|suite| Probes::new(&case, &problem, suite, limits)).transpose()?;
    let probes = probes.unwrap_or_default();
    let occurrences = occurrences(&truth.events);
    let asked = Task::of_oscillator(&task).map_err(|it| FileError::of(&case.file, it))?;
    let system = percussive_oscillator(&problem)?;
    let exact = SystemProblem::new(system, false).map_err(|it| FileError::of(&case.file, it))?;
    let exact = Arc::new(exact);
    Ok(Prepared { case, truth, growth, grazes, occurrences, exact, task, asked, probes })
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
        let outcome = answer(engine, &self.asked, accuracy, limits)?;
        let wall = began.elapsed();
        if outcome.ended != Ended::Horizon {
            return Err(Failure::new(format!("the run ended early: {:?}", outcome.ended)));
        }
        let mut measures = measure(&self.task, &self.truth, &self.growth, &outcome, unit);
        let periods = self.task.span / self.task.problem.model.period();
        let extent = extent(outcome.work.rhs_evaluations as f64 / periods.max(1.0));
        measures.probed = self.probes.ask(&self.case, engine, accuracy, unit, limits, extent);
        Ok((measures, outcome, wall))
    }

    /// The same-attractor test, where the case has one.
    #[must_use]
    pub fn attractor(&self) -> Option<&AttractorTest> {
        self.probes.attractor.as_ref()
    }
}

impl CaseRun for Prepared {
    fn name(&self) -> &str {
        &self.case.name
    }

    fn events(&self) -> usize {
        self.truth.events.len()
    }

    fn asked(&self) -> &Task {
        &self.asked
    }

    fn parameters(&self) -> Vec<(&str, f64)> {
        let Parameters { a, b, xi, omega, g, phi } = self.case.parameters;
        [("a", a), ("b", b), ("xi", xi), ("omega", omega), ("g", g), ("phi", phi)].to_vec()
    }

    fn expectations(&self) -> (&[Bound], &[Shortcoming]) {
        (&self.case.bounds, &self.case.shortcomings)
    }

    fn attempt(
        &self,
        engine: &dyn Engine,
        asked: (Accuracy, f64),
        limits: &Limits,
        suite: Suite,
    ) -> Result<Measured, Failure> {
        let role = engine.declaration().role;
        let extent = |work| self.probes.extent(suite, &self.case, role, asked, work);
        let (measures, outcome, wall) = self.measured(engine, asked.0, asked.1, limits, extent)?;
        Ok(Measured { measures, outcome, wall })
    }

    fn as_run<'a>(&'a self, measures: &'a Measures) -> ScoredRun<'a> {
        let window = WINDOW * self.task.problem.model.period();
        ScoredRun { measures, truth: &self.occurrences, grazes: &self.grazes, window }
    }
}

/// Runs everything; rows come case by case in the order of `cases` and `engines`.
pub fn run<'a>(
    cases: &[&'a dyn CaseRun],
    engines: &[&'static dyn Engine],
    scope: &SuiteScope,
    defaults: &Defaults,
    done: &(impl Fn() + Sync),
) -> Vec<Scored> {
    let settings = |case: &'a dyn CaseRun, engine: &'static dyn Engine| {
        accuracies(engine, scope).into_iter().map(move |it| (case, engine, it))
    };
    let of_case = |case: &&'a dyn CaseRun| -> Vec<_> {
        engines.iter().flat_map(|it| settings(*case, *it)).collect()
    };
    let jobs: Vec<_> = cases.iter().flat_map(of_case).collect();
    let row = |(case, engine, accuracy): (&dyn CaseRun, &'static dyn Engine, Accuracy)| {
        let row = one(case, engine, accuracy, scope.suite(), defaults);
        done();
        row
    };
    // Heavy rows lie side by side: handed out one by one they do not pile up on one thread.
    jobs.into_par_iter().with_max_len(1).map(row).collect()
}

/// Whether probes are asked of one of these engines.
#[must_use]
pub fn probes_any(engines: &[&'static dyn Engine], scope: &SuiteScope) -> bool {
    engines.iter().any(|engine| {
        let role = engine.declaration().role;
        accuracies(*engine, scope).into_iter().any(|it| may_probe(scope.suite(), role, it))
    })
}

/// The number of rows that [`run`] makes.
#[must_use]
pub fn size(cases: usize, engines: &[&'static dyn Engine], scope: &SuiteScope) -> usize {
    cases * engines.iter().map(|engine| accuracies(*engine, scope).len()).sum::<usize>()
}

fn accuracies(engine: &dyn Engine, scope: &SuiteScope) -> Vec<Accuracy> {
    scope.accuracies(engine.declaration().stepping)
}

/// The reason why an engine does not run on a case, if there is one.
fn not_run(
    case: &dyn CaseRun,
    engine: &dyn Engine,
    accuracy: Accuracy,
    suite: Suite,
) -> Option<(Status, Verdict, String)> {
    if let Err(reason) = engine.available() {
        return Some((Status::Unavailable, Verdict::Unavailable, reason));
    }
    if let Err(reason) = engine.takes(case.asked()) {
        return Some((Status::NotRun, Verdict::NotRun, reason.to_owned()));
    }
    let (least, budget) = (case.least_work(engine, accuracy), suite.budget());
    (least > budget).then(|| {
        let reason =
            format!("at least {} right-hand sides, the budget is {}", brief(least), brief(budget));
        (Status::NotRun, Verdict::NotRun, reason)
    })
}

/// Runs one engine on one case, and judges its answer.
#[must_use]
pub fn one(
    case: &dyn CaseRun,
    engine: &dyn Engine,
    accuracy: Accuracy,
    suite: Suite,
    defaults: &Defaults,
) -> Scored {
    let declaration = engine.declaration();
    let unit = declaration.stepping.unit(accuracy);
    let row = |status, wall, judgement| Scored {
        case: case.name().to_owned(),
        engine: declaration.name,
        role: declaration.role,
        accuracy,
        unit,
        events: case.events(),
        trouble: case.trouble().to_vec(),
        status,
        wall,
        judgement,
    };
    let without = |status, verdict, why: String| {
        row(status, Duration::ZERO, RowJudgement::without_result(verdict, why))
    };
    if let Some((status, verdict, reason)) = not_run(case, engine, accuracy, suite) {
        return without(status, verdict, reason);
    }
    let subject = Subject { case: case.name(), engine: declaration.name, accuracy, unit };
    let (own_bounds, own_shortcomings) = case.expectations();
    let of_classes = case.defaults(defaults);
    let bounds: Vec<_> = own_bounds.iter().chain(of_classes).collect();
    let shortcomings: Vec<_> = own_shortcomings.iter().chain(&defaults.shortcomings).collect();
    let expected = Expected { bounds: &bounds, of_classes, shortcomings: &shortcomings };
    match case.attempt(engine, (accuracy, unit), &case.limits(suite), suite) {
        Ok(Measured { measures, outcome, wall }) => {
            let judgement = judge(&subject, &case.as_run(&measures), &expected);
            row(Status::Ok(Box::new(measures), Box::new(outcome)), wall, judgement)
        }
        Err(failure) if failure.is_beyond_limits => {
            without(Status::NotRun, Verdict::NotRun, failure.reason)
        }
        Err(failure) => {
            let judgement = RowJudgement::failed(&subject, &failure.reason, &shortcomings);
            row(Status::Failed(failure), Duration::ZERO, judgement)
        }
    }
}
