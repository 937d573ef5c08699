//! The runs of contestants: a case from its start to its horizon, with the truth that answers are
//! held to.

use crate::case::{Case, FileError, Given, Horizon};
use crate::engine::{Failure, OscillatorTask, Outcome, SampleGrid, Task};
use crate::number::brief;
use crate::score::{ErrorRule, EventNames, Matching, Occurrence, SCORED_ERROR, WINDOW, worst};
use crate::system::SystemProblem;
use crate::truth::{Library, Truth};
use percuss::Ending;
use percuss::{Parameters, Start};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The description of a timed case.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the keys are explained in the schema")]
pub struct CaseEntry {
    pub case: String,
    pub regime: String,
    pub periods: f64,
    pub events: usize,
}

impl CaseEntry {
    /// A figure of a forcing period as one of an event; nothing for a run without events.
    #[must_use]
    pub fn per_event(&self, per_period: f64) -> Option<f64> {
        (self.events > 0).then(|| per_period * self.periods / self.events as f64)
    }
}

/// A run to be made and what is true of it.
#[derive(Clone, Debug)]
pub struct TimedCase {
    /// The name of the case.
    pub name: String,
    /// The regime that the case stands for, or the trouble that it makes.
    pub kind: String,
    /// The run. It asks for no samples: events and the end are the answer.
    pub task: Task,
    /// The system at its start, made ready for the exact solver.
    pub problem: Arc<SystemProblem>,
    /// The truth.
    pub truth: Truth,
    names: EventNames,
    rule: ErrorRule,
    occurrences: Vec<Occurrence>,
}

/// The errors of a right answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// The largest error of a state over the events, each at its own time, and the end of the run.
    pub state_error: f64,
    /// The largest error of an event time, in the unit in which the case's times count.
    pub event_time_error: f64,
    /// |dv| at the end; zero where nothing drifts.
    pub drift_error: f64,
}

impl Score {
    /// The larger errors of two runs.
    #[must_use]
    pub fn or_worse(&self, other: &Self) -> Self {
        Self {
            state_error: self.state_error.max(other.state_error),
            event_time_error: self.event_time_error.max(other.event_time_error),
            drift_error: self.drift_error.max(other.drift_error),
        }
    }
}

impl TimedCase {
    /// The run of a case.
    ///
    /// # Errors
    /// [`FileError`] for reference data that are missing, altered or of another case, and for a
    /// system that engines do not take.
    pub fn new(case: &Case, library: &Library) -> Result<Self, FileError> {
        Self::with_truth(case, library.truth(case)?)
    }

    /// A run from rest of any model; its truth is the run made again in 106 bits.
    ///
    /// # Errors
    /// [`Failure`] for a model that is not accepted, or a run that 106 bits do not decide.
    pub fn from_rest(parameters: Parameters, periods: u32) -> Result<Self, Failure> {
        let given = Given { parameters, start: Start::default(), ..Given::default() };
        let problem = given.check().map_err(Failure::new)?;
        let case = Case::of_run(problem, Horizon::Periods(periods)).map_err(Failure::new)?;
        let horizon = problem.entry.instant.after_periods(u64::from(periods), 1);
        let truth = Truth::replayed(&parameters, &problem.entry, horizon, (0, 1));
        let timed = Self::with_truth(&case, truth.map_err(Failure::new)?).map_err(Failure::new)?;
        let name = format!("omega {}, xi {}", parameters.omega, parameters.xi);
        Ok(Self { name, kind: "from rest".to_owned(), ..timed })
    }

    fn with_truth(case: &Case, truth: Truth) -> Result<Self, FileError> {
        let problem = Arc::new(case.problem()?);
        let task = match &case.oscillator {
            Some(own) => Task::of_oscillator(&OscillatorTask::new(own, NO_SAMPLES)),
            None => Task::from_problem(&problem, truth.span, Vec::new()),
        };
        let task = task.map_err(|failure| FileError::new(&case.file, failure))?;
        let system = task.system.system();
        let (names, rule) = (EventNames::new(case, system), ErrorRule::new(case, system));
        let occurrences = names.of_truth(&truth);
        let (name, kind) = (case.name.clone(), case.kind(" "));
        Ok(Self { name, kind, task, problem, truth, names, rule, occurrences })
    }

    /// The case's entry in `bench.json`.
    #[must_use]
    pub fn entry(&self) -> CaseEntry {
        CaseEntry {
            case: self.name.clone(),
            regime: self.kind.clone(),
            periods: self.periods(),
            events: self.truth.events.len(),
        }
    }

    /// The length of the case in forcing periods, or in what stands for them.
    #[must_use]
    pub fn periods(&self) -> f64 {
        self.task.span / self.task.system.period()
    }

    /// How good an answer is, if it is right: every event there in its order and none besides, and
    /// no error beyond the 1e-3 at which runs count as lost. States count in their scales; events
    /// of one instant whose order is free may come in any.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn score(&self, answer: &Outcome) -> Result<Score, Failure> {
        let found = self.names.of_outcome(&self.task, &self.truth, answer);
        let window = WINDOW * self.task.system.period();
        let is_same = |(truth, own): (&Occurrence, &Occurrence)| {
            truth.is_like(own) && (truth.elapsed - own.elapsed).abs() <= window
        };
        let same = self.occurrences.len() == found.len()
            && self.occurrences.iter().zip(&found).all(is_same);
        if !same {
            let matched = Matching::new(&self.occurrences, &found, window).pairs.len();
            let (missed, spurious) = (self.occurrences.len() - matched, found.len() - matched);
            return Err(Failure::new(format!(
                "wrong: {missed} events missed, {spurious} spurious"
            )));
        }
        let score = self.errors(answer);
        // Written so that a NaN is wrong.
        let largest =
            worst([score.state_error, score.drift_error, score.event_time_error].into_iter());
        if largest <= SCORED_ERROR {
            Ok(score)
        } else {
            let error = brief(largest);
            Err(Failure::new(format!("wrong: off by {error}, accepted is {SCORED_ERROR}")))
        }
    }

    fn errors(&self, answer: &Outcome) -> Score {
        let Self { truth, rule, .. } = self;
        let rows = || truth.events.iter().zip(&answer.events);
        // Between events of one instant the state is a matter of their order.
        let placed = rows().zip(&self.occurrences).filter(|(_, it)| it.mode.is_some());
        let states = placed.map(|((row, event), _)| rule.state_error(row, &event.state));
        // Where infinitely many impacts end a run, engines do not come to the same end.
        let reached = truth.ended == Ending::Horizon;
        let end = reached.then(|| rule.state_error(&truth.end, &answer.end));
        let times = rows().map(|(row, it)| rule.time_error(row.elapsed, it.elapsed));
        let drift = rule.drift_error(&truth.end, &answer.end);
        Score {
            state_error: worst(states.chain(end)),
            event_time_error: worst(times.map(|error| error / rule.time_scale)),
            drift_error: if rule.drift.is_empty() { 0.0 } else { drift },
        }
    }
}

/// A grid without samples: only the events and the end are asked for.
const NO_SAMPLES: SampleGrid = SampleGrid { per_period: 1, count: 0 };
