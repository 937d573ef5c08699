//! A case made ready to be run: checked, with its truth and what runs are measured by.

use super::probes::{Extent, Probes};
use super::scope::Suite;
use crate::case::{Case, ClassBounds, Defaults, FileError, SAMPLES_PER_PERIOD, Shortcoming};
use crate::engine::{
    Accuracy, Engine, Failure, Limits, OscillatorTask, Outcome, SampleGrid, Task, answer,
    least_work,
};
use crate::score::attractor::{AttractorTest, Calibrated, calibrated};
use crate::score::local::{Allowance, LocalJudge, LocalJudgement};
use crate::score::{
    Decision, ErrorRule, EventNames, Expected, Graze, MeasuredBy, Measures, Occurrence,
    RowJudgement, ScoredBy, ScoredRun, Subject, WINDOW, decisions, grazes, judge, measure,
};
use crate::system::SystemProblem;
use crate::truth::{Library, Truth, TruthRow};
use percuss::Ending;
use rayon::prelude::*;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A case made ready.
pub struct PreparedCase {
    /// The case.
    pub case: Case,
    /// The case's truth, with the growth along it.
    pub truth: Truth,
    /// The run that is asked of engines.
    pub task: Task,
    /// The system at its start with exact coefficients, and its closed forms.
    pub problem: Arc<SystemProblem>,
    /// How errors are counted.
    pub rule: ErrorRule,
    /// The places at which guards come close to a threshold.
    pub grazes: Vec<Graze>,
    /// The events whose successors hang by little.
    pub decisions: Vec<Decision>,
    /// The tests beyond the run itself.
    pub probes: Probes,
    /// The judge of single records.
    pub local: LocalJudge,
    names: EventNames,
    occurrences: Vec<Occurrence>,
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

/// Reads the truth of every case, and makes the probes of a suite ready if one is given.
///
/// # Errors
/// [`FileError`] for reference data that are missing, altered or of another case, and for a system
/// that engines do not take.
pub fn prepare(
    cases: Vec<Case>,
    library: &Library,
    probes: Option<Suite>,
) -> Result<Vec<PreparedCase>, FileError> {
    let limits = calibrated()?;
    let one = |case| PreparedCase::new(case, library, probes, &limits);
    cases.into_par_iter().map(one).collect()
}

/// The run that a case asks for, with samples where its truth has them.
///
/// # Errors
/// [`FileError`] for a system that engines do not take.
fn task(case: &Case, truth: &Truth, problem: &Arc<SystemProblem>) -> Result<Task, FileError> {
    let task = match &case.oscillator {
        Some(own) => {
            let grid = SampleGrid { per_period: SAMPLES_PER_PERIOD, count: truth.samples.len() };
            Task::of_oscillator(&OscillatorTask::new(own, grid))
        }
        None => Task::from_problem(problem, truth.span, truth.sample_times()),
    };
    let task = task.map_err(|failure| FileError::new(&case.file, failure))?;
    Ok(Task { exact: Some(Arc::clone(problem)), ..task })
}

/// A judge of the runs of a task: where impacts accumulate, down to half of the shortest time
/// between events in the truth.
fn local_judge(problem: &Arc<SystemProblem>, task: &Task, truth: &Truth) -> LocalJudge {
    let judge = LocalJudge::new(problem, task);
    let Some(last) = truth.events.last().filter(|_| truth.ended == Ending::Accumulation) else {
        return judge;
    };
    let gap = |pair: &[TruthRow]| pair[1].elapsed.minus(pair[0].elapsed).value();
    // Events may come together at the start.
    let gaps = truth.events.windows(2).map(gap).filter(|gap| *gap > 0.0);
    let shortest = gaps.fold(f64::INFINITY, f64::min);
    judge.down_to(last.elapsed.value(), 0.5 * shortest)
}

impl PreparedCase {
    fn new(
        case: Case,
        library: &Library,
        probes: Option<Suite>,
        limits: &[Calibrated],
    ) -> Result<Self, FileError> {
        let truth = library.truth(&case)?;
        let problem = Arc::new(case.problem()?);
        let task = task(&case, &truth, &problem)?;
        let system = task.system.system();
        let (names, rule) = (EventNames::new(&case, system), ErrorRule::new(&case, system));
        let occurrences = names.of_truth(&truth);
        let grazes = grazes(&problem, &truth, (&names, &rule));
        let decisions = decisions(&task.system, &truth, &rule);
        let made = |suite| Probes::new(&case, (&problem, &truth), suite, limits);
        let probes = probes.map(made).transpose()?.unwrap_or_default();
        let local = local_judge(&problem, &task, &truth);
        let prepared = Self {
            case,
            truth,
            task,
            problem,
            rule,
            grazes,
            decisions,
            probes,
            local,
            names,
            occurrences,
        };
        Ok(prepared)
    }

    /// What an engine's run measures, with probes as far as `extent` says of the right-hand sides
    /// that the run took.
    ///
    /// # Errors
    /// The engine's failure in the run itself.
    pub fn measured(
        &self,
        engine: &dyn Engine,
        (accuracy, unit): (Accuracy, f64),
        limits: &Limits,
        extent: impl FnOnce(u64) -> Extent,
    ) -> Result<Measured, Failure> {
        let began = Instant::now();
        let outcome = answer(engine, &self.task, accuracy, limits)?;
        let wall = began.elapsed();
        let Self { task, truth, names, rule, .. } = self;
        let scored_by = ScoredBy::new((accuracy, unit), &self.grazes, &self.decisions);
        let mut measures = measure(MeasuredBy { task, truth, names, rule }, &outcome, scored_by);
        let extent = extent(outcome.work.rhs_evaluations);
        measures.probed = self.probes.ask(&self.case, engine, (accuracy, unit), limits, extent);
        Ok(Measured { measures, outcome, wall })
    }

    /// Runs an engine and measures what it answers, in units of its error.
    ///
    /// # Errors
    /// The engine's failure in the run itself.
    pub fn attempt(
        &self,
        engine: &dyn Engine,
        asked: (Accuracy, f64),
        suite: Suite,
    ) -> Result<Measured, Failure> {
        let role = engine.declaration().role;
        let extent = |work| self.probes.extent(suite, (&self.case, &self.task), role, asked, work);
        self.measured(engine, asked, &Suite::limits(&self.case), extent)
    }

    /// What the exact continuations of an answer's records say of it, for an engine of a class.
    #[must_use]
    pub fn judge_records(
        &self,
        outcome: &Outcome,
        class: &ClassBounds,
        unit: f64,
    ) -> Option<LocalJudgement> {
        // Both solvers were made ready for the case's start.
        self.local.judge(&self.task, outcome, Allowance::new(class, unit)).ok()
    }

    /// The measured run in the form in which it is judged.
    #[must_use]
    pub fn as_run<'a>(&'a self, measures: &'a Measures) -> ScoredRun<'a> {
        let window = WINDOW * self.period();
        ScoredRun { measures, truth: &self.occurrences, grazes: &self.grazes, window }
    }

    /// Judges a run by the bounds of the case, of the engine's class and of every case, and the
    /// records of an engine that has a class from where the engine itself was.
    pub fn judge(
        &self,
        subject: &Subject<'_>,
        measured: &mut Measured,
        class: Option<&ClassBounds>,
        defaults: &Defaults,
        shortcomings: &[&Shortcoming],
    ) -> RowJudgement {
        let Measured { measures, outcome, .. } = measured;
        measures.local = class.and_then(|it| self.judge_records(outcome, it, subject.unit));
        let of_class = class.map(ClassBounds::bounds).unwrap_or_default();
        let of_every_case = &defaults.bounds;
        let bounds: Vec<_> =
            self.case.bounds.iter().chain(&of_class).chain(of_every_case).collect();
        judge(
            subject,
            &self.as_run(measures),
            &Expected { bounds: &bounds, of_every_case, shortcomings },
        )
    }

    /// The names of its events.
    #[must_use]
    pub const fn names(&self) -> &EventNames {
        &self.names
    }

    /// The truth's events on the case's horizon, with an ending that an engine has to find.
    #[must_use]
    pub const fn events(&self) -> usize {
        self.occurrences.len()
    }

    /// The parameters of its model.
    #[must_use]
    pub fn parameters(&self) -> Vec<(&str, f64)> {
        if let Some(own) = &self.case.oscillator {
            let percuss::Parameters { a, b, xi, omega, g, phi } = *own.parameters();
            return [("a", a), ("b", b), ("xi", xi), ("omega", omega), ("g", g), ("phi", phi)]
                .to_vec();
        }
        let parameters = self.case.system.parameters.iter();
        parameters.map(|(name, value)| (name.as_str(), *value)).collect()
    }

    /// Right-hand sides that a run takes at the least, as far as that is known beforehand.
    #[must_use]
    pub fn least_work(&self, engine: &dyn Engine, accuracy: Accuracy) -> f64 {
        let whole = least_work(engine, &self.task, accuracy);
        // A run may end before its horizon.
        whole * (self.truth.end.elapsed.value() / self.task.span).min(1.0)
    }

    /// The time that stands for a forcing period.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.task.system.period()
    }

    /// The same-attractor test, where the case has one.
    #[must_use]
    pub fn attractor(&self) -> Option<&AttractorTest> {
        self.probes.attractor.as_ref()
    }
}
