//! A piecewise-affine system's case made ready.

use super::matrix::{CaseRun, Measured};
use super::probes::restarts_on_systems;
use super::scope::Suite;
use crate::case::{Bound, Defaults, FileError, Shortcoming, SystemCase};
use crate::engine::{Accuracy, Engine, Failure, Limits, Task, answer, least_work};
use crate::score::{
    Decision, EventNames, Graze, Measures, Occurrence, ScoredRun, SystemRestartTest, SystemScale,
    WINDOW, decisions, measure_system, system_grazes,
};
use crate::truth::{Library, SystemTruth};
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Instant;

/// A case of a system made ready: checked, with its truth.
pub struct PreparedSystem {
    /// The case.
    pub case: SystemCase,
    /// The case's truth, with the growth along it.
    pub truth: SystemTruth,
    /// The run that is asked of engines.
    pub task: Task,
    /// The places at which guards come close to a threshold.
    pub grazes: Vec<Graze>,
    /// The events whose successors hang by little.
    pub decisions: Vec<Decision>,
    /// Restarts from states along the true run, where the case is probed.
    pub restart: Option<SystemRestartTest>,
    names: EventNames,
    occurrences: Vec<Occurrence>,
}

/// Reads the truth of every case of a system, and makes the restarts of a suite ready if one is
/// given.
///
/// # Errors
/// [`FileError`] for reference data that are missing, altered or of another case, and for a system
/// that engines do not take.
pub fn prepare_systems(
    cases: Vec<SystemCase>,
    library: &Library,
    probes: Option<Suite>,
) -> Result<Vec<PreparedSystem>, FileError> {
    cases.into_par_iter().map(|case| PreparedSystem::new(case, library, probes)).collect()
}

impl PreparedSystem {
    fn new(case: SystemCase, library: &Library, probes: Option<Suite>) -> Result<Self, FileError> {
        let truth = library.system_truth(&case)?;
        let problem = Arc::new(case.problem()?);
        let refused = |failure: Failure| FileError::of(&case.file, failure);
        let task = Task::of(&problem, truth.span, truth.sample_times()).map_err(refused)?;
        let names = EventNames::of(task.system.system());
        let occurrences = names.of_truth(&truth);
        let grazes = system_grazes(&problem, &truth, &names);
        let decisions = decisions(&problem, &truth);
        let restarts = |suite| SystemRestartTest::new(&case, &problem, &truth, restarts(suite));
        let restart = probes.map(restarts).transpose();
        let restart = restart.map_err(|what| FileError::of(&case.file, what))?;
        Ok(Self { case, truth, task, grazes, decisions, restart, names, occurrences })
    }

    /// The measures of an engine's run, without restarts.
    ///
    /// # Errors
    /// The engine's failure.
    pub fn measured(
        &self,
        engine: &dyn Engine,
        (accuracy, unit): (Accuracy, f64),
        limits: &Limits,
    ) -> Result<Measured, Failure> {
        let began = Instant::now();
        let outcome = answer(engine, &self.task, accuracy, limits)?;
        let wall = began.elapsed();
        let scale = SystemScale::of((accuracy, unit), &self.grazes, &self.decisions);
        let measures = measure_system(&self.task, &self.truth, &self.names, &outcome, scale);
        Ok(Measured { measures, outcome, wall })
    }

    /// How many restarts of a test a suite asks of an engine whose run of the case took so many
    /// right-hand sides.
    fn restarts(&self, test: &SystemRestartTest, suite: Suite, work: u64) -> usize {
        let work = work as f64 / self.task.span * test.span();
        let share = suite.budget() / work.max(1.0);
        (test.runs.len() as f64 * share.min(1.0)) as usize
    }

    /// The time that stands for a forcing period.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.task.system.period()
    }
}

impl CaseRun for PreparedSystem {
    fn name(&self) -> &str {
        &self.case.name
    }

    fn events(&self) -> usize {
        self.occurrences.len()
    }

    fn asked(&self) -> &Task {
        &self.task
    }

    fn parameters(&self) -> Vec<(&str, f64)> {
        let parameters = self.case.system.parameters.iter();
        parameters.map(|(name, value)| (name.as_str(), *value)).collect()
    }

    fn trouble(&self) -> &[String] {
        &self.case.trouble
    }

    fn limits(&self, suite: Suite) -> Limits {
        suite.limits_of_systems()
    }

    fn defaults<'a>(&self, defaults: &'a Defaults) -> &'a [Bound] {
        &defaults.of_systems
    }

    fn expectations(&self) -> (&[Bound], &[Shortcoming]) {
        (&self.case.bounds, &self.case.shortcomings)
    }

    fn least_work(&self, engine: &dyn Engine, accuracy: Accuracy) -> f64 {
        let whole = least_work(engine, &self.task, accuracy);
        // A run may end before its horizon.
        whole * (self.truth.end.elapsed.value() / self.task.span).min(1.0)
    }

    fn attempt(
        &self,
        engine: &dyn Engine,
        (accuracy, unit): (Accuracy, f64),
        limits: &Limits,
        suite: Suite,
    ) -> Result<Measured, Failure> {
        let mut measured = self.measured(engine, (accuracy, unit), limits)?;
        let work = measured.outcome.work.rhs_evaluations;
        let asked = restarts_on_systems(suite, engine.declaration().role, accuracy);
        if let Some(test) = self.restart.as_ref().filter(|_| asked) {
            let most = self.restarts(test, suite, work);
            let run = |task: &Task| answer(engine, task, accuracy, limits);
            let restart = (most > 0).then(|| test.score_first(most, (accuracy, unit), run));
            measured.measures.probed.restart = restart;
        }
        Ok(measured)
    }

    fn as_run<'a>(&'a self, measures: &'a Measures) -> ScoredRun<'a> {
        let window = WINDOW * self.period();
        ScoredRun { measures, truth: &self.occurrences, grazes: &self.grazes, window }
    }
}

/// Restarts of a case, spread over its run.
const fn restarts(suite: Suite) -> usize {
    match suite {
        Suite::Quick => 20,
        Suite::Full => 100,
    }
}
