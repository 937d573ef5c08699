//! What contestants run of any other system than the oscillator, held to the truth as
//! [`super::timed_case`] holds the oscillator.

use super::timed_case::{CaseEntry, Score};
use crate::case::{FileError, SystemCase};
use crate::engine::{Ended, Failure, Outcome, Task};
use crate::number::brief;
use crate::score::{EventNames, Matching, Occurrence, SCORED_ERROR, WINDOW, worst};
use crate::system::SystemProblem;
use crate::truth::{Library, SystemTruth, SystemTruthRow};
use percuss::TwoWord;
use std::sync::Arc;

/// A run of a system to be made and what is true of it.
#[derive(Clone, Debug)]
pub struct TimedSystemCase {
    /// The name of the case.
    pub name: String,
    /// The trouble that the case makes.
    pub trouble: String,
    /// The run. It asks for no samples: events and the end are the answer.
    pub task: Task,
    /// The system at its start, made ready for the exact solver.
    pub problem: Arc<SystemProblem>,
    /// The truth.
    pub truth: SystemTruth,
    names: EventNames,
    occurrences: Vec<Occurrence>,
}

impl TimedSystemCase {
    /// The run of a case.
    ///
    /// # Errors
    /// [`FileError`] for reference data that are missing, altered or of another case, and for a
    /// system that engines do not take.
    pub fn of(case: &SystemCase, library: &Library) -> Result<Self, FileError> {
        let truth = library.system_truth(case)?;
        let problem = Arc::new(case.problem()?);
        let refused = |failure: Failure| FileError::of(&case.file, failure);
        let task = Task::of(&problem, truth.span, Vec::new()).map_err(refused)?;
        let names = EventNames::of(task.system.system());
        let occurrences = names.of_truth(&truth);
        let (name, trouble) = (case.name.clone(), case.trouble.join(" "));
        Ok(Self { name, trouble, task, problem, truth, names, occurrences })
    }

    /// The length of the case in what stands for forcing periods.
    #[must_use]
    pub fn periods(&self) -> f64 {
        self.task.span / self.task.system.period()
    }

    /// The case's entry in `bench.json`.
    #[must_use]
    pub fn entry(&self) -> CaseEntry {
        CaseEntry {
            case: self.name.clone(),
            regime: self.trouble.clone(),
            periods: self.periods(),
            events: self.truth.events.len(),
        }
    }

    /// How good an answer is, if it is right: every event there in its order and none besides, and
    /// no error beyond the 1e-3 at which runs count as lost. States count in their scales, times in
    /// the system's scale of time; events of one instant whose order is free may come in any.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn score(&self, answer: &Outcome) -> Result<Score, Failure> {
        let found = self.names.of_outcome(&self.task, &self.truth, answer);
        let window = WINDOW * self.task.system.period();
        let pairs = || self.occurrences.iter().zip(&found);
        let same = self.occurrences.len() == found.len()
            && pairs().all(|(truth, own)| is_same(truth, own, window));
        if !same {
            let matched = Matching::of(&self.occurrences, &found, window).pairs.len();
            let (missed, spurious) = (self.occurrences.len() - matched, found.len() - matched);
            return Err(Failure::new(format!(
                "wrong: {missed} events missed, {spurious} spurious"
            )));
        }
        let score = self.errors(answer);
        // Written so that a NaN is wrong.
        let largest = worst([score.state_error, score.event_time_error].into_iter());
        if largest <= SCORED_ERROR {
            Ok(score)
        } else {
            let error = brief(largest);
            Err(Failure::new(format!("wrong: off by {error}, accepted is {SCORED_ERROR}")))
        }
    }

    fn errors(&self, answer: &Outcome) -> Score {
        let rows = || self.truth.events.iter().zip(&answer.events);
        // Between events of one instant the state is a matter of their order.
        let placed = rows().zip(&self.occurrences).filter(|(_, it)| it.mode.is_some());
        let states = placed.map(|((row, event), _)| self.state_error(row, &event.state));
        // Where infinitely many impacts end a run, engines do not come to the same end.
        let reached = self.truth.ended == Ended::Horizon;
        let end = reached.then(|| self.state_error(&self.truth.end, &answer.end));
        let scale = self.task.system.system().time_scale;
        Score {
            state_error: worst(states.chain(end)),
            event_time_error: worst(rows().map(|(row, it)| off(row.elapsed, it.elapsed) / scale)),
            drift_error: 0.0,
        }
    }

    fn state_error(&self, row: &SystemTruthRow, state: &[f64]) -> f64 {
        let scales = &self.task.system.system().scales;
        let states = row.state.iter().zip(state).zip(scales);
        worst(states.map(|((truth, own), scale)| off(*truth, *own) / scale))
    }
}

fn is_same(truth: &Occurrence, own: &Occurrence, window: f64) -> bool {
    let mode = truth.mode.is_none() || truth.mode == own.mode;
    mode && truth.event == own.event && (truth.elapsed - own.elapsed).abs() <= window
}

fn off(truth: TwoWord, value: f64) -> f64 {
    truth.minus(TwoWord::new(value)).value().abs()
}
