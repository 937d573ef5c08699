//! The runs of contestants: a case from its start to its horizon, with the truth that answers are
//! held to.

use crate::case::{Case, FileError, Given};
use crate::engine::{Event, Failure, OscillatorTask, Outcome, SampleGrid, place};
use crate::number::brief;
use crate::score::{Matching, SCORED_ERROR, WINDOW, occurrences, worst};
use crate::truth::{Library, Truth, TruthRow};
use percuss::{Parameters, Start};
use serde::{Deserialize, Serialize};

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
    /// The regime that the case stands for.
    pub regime: String,
    /// The run. It asks for no samples: events and the end are the answer.
    pub task: OscillatorTask,
    /// The truth.
    pub truth: Truth,
}

/// The errors of a right answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// max(|dp|, |dy|, |dq|) over the events, each at its own time, and the end of the run.
    pub state_error: f64,
    /// The largest error of an event time.
    pub event_time_error: f64,
    /// |dv| at the end.
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

/// A grid without samples: only the events and the end are asked for.
const NO_SAMPLES: SampleGrid = SampleGrid { per_period: 1, count: 0 };

impl TimedCase {
    /// The run of a case.
    ///
    /// # Errors
    /// [`FileError`] for reference data that are missing, altered or of another case.
    pub fn of(case: &Case, library: &Library) -> Result<Self, FileError> {
        let given = Given { parameters: case.parameters, start: case.start, ..Given::default() };
        let problem = given.check().map_err(FileError)?;
        Ok(Self {
            name: case.name.clone(),
            regime: case.regime.to_string(),
            task: OscillatorTask::of(case, problem, NO_SAMPLES),
            truth: library.truth(case)?,
        })
    }

    /// A run from rest of any model; its truth is the run made again in 106 bits.
    ///
    /// # Errors
    /// [`Failure`] for a model that is not accepted, or a run that 106 bits do not decide.
    pub fn from_rest(parameters: Parameters, periods: u64) -> Result<Self, Failure> {
        let given = Given { parameters, start: Start::default(), ..Given::default() };
        let problem = given.check().map_err(Failure::new)?;
        let horizon = problem.entry.instant.after_periods(periods, 1);
        let truth = Truth::replayed(&parameters, &problem.entry, horizon, (0, 1));
        Ok(Self {
            name: format!("omega {}, xi {}", parameters.omega, parameters.xi),
            regime: "from rest".to_owned(),
            task: OscillatorTask::until(parameters, problem, horizon, NO_SAMPLES),
            truth: truth.map_err(Failure::new)?,
        })
    }

    /// The case's entry in `bench.json`.
    #[must_use]
    pub fn entry(&self) -> CaseEntry {
        CaseEntry {
            case: self.name.clone(),
            regime: self.regime.clone(),
            periods: self.periods(),
            events: self.truth.events.len(),
        }
    }

    /// The length of the case in forcing periods.
    #[must_use]
    pub fn periods(&self) -> f64 {
        self.task.span / self.task.problem.model.period()
    }

    /// How good an answer is, if it is right: every event there in its order and none besides, and
    /// no error beyond the 1e-3 at which runs count as lost.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn score(&self, answer: &Outcome) -> Result<Score, Failure> {
        let truth = &self.truth.events;
        let window = WINDOW * self.task.problem.model.period();
        let same = truth.len() == answer.events.len()
            && truth.iter().zip(&answer.events).all(|(row, event)| is_same(row, event, window));
        if !same {
            let matched =
                Matching::of(&occurrences(truth), &occurrences(&answer.events), window).pairs.len();
            let (missed, spurious) = (truth.len() - matched, answer.events.len() - matched);
            return Err(Failure::new(format!(
                "wrong: {missed} events missed, {spurious} spurious"
            )));
        }
        let pairs = || truth.iter().zip(&answer.events);
        let ends = [(&self.truth.end, answer.end)];
        let states = pairs().map(|(row, event)| (row, event.state)).chain(ends);
        let score = Score {
            state_error: worst(states.map(|(row, state)| state_error(row, &state))),
            event_time_error: worst(pairs().map(|(row, event)| off(row.elapsed, event.elapsed))),
            drift_error: off(self.truth.end.state[3], answer.end[3]),
        };
        // Written so that a NaN is wrong.
        let largest = worst([score.state_error, score.drift_error].into_iter());
        if largest <= SCORED_ERROR && score.event_time_error.is_finite() {
            Ok(score)
        } else {
            let error = brief(largest);
            Err(Failure::new(format!("wrong: off by {error}, accepted is {SCORED_ERROR}")))
        }
    }
}

fn is_same(row: &TruthRow, event: &Event, window: f64) -> bool {
    row.phase.map(place) == Some(event.mode) && off(row.elapsed, event.elapsed) <= window
}

fn state_error(row: &TruthRow, state: &[f64]) -> f64 {
    worst((0..3).map(|k| off(row.state[k], state[k])))
}

fn off(truth: percuss::TwoWord, value: f64) -> f64 {
    truth.minus(percuss::TwoWord::new(value)).value().abs()
}
