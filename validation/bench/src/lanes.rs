//! The exact solver in the lanes of the processor: a run many times at once, on one thread.
//!
//! All runs are the same one, so that each can be held to the truth. That is no help to the lanes:
//! they take phases of one kind from whatever motions are under way, and different motions fill
//! them as well.

use super::contestant::Contestant;
use super::rounds::Benchmark;
use super::timed::{ContestEntry, TimedRun};
use super::timed_case::{Score, TimedCase};
use crate::engine::contain;
use crate::engine::{Accuracy, Declaration, Failure, Outcome, Work};
use crate::integrators::{exact, run_in_lanes};
use percuss::lanes::Instructions;

/// Runs a call: several times as many as are under way at once in the widest vectors.
const RUNS: usize = 256;

/// Exact, by the widest instructions that the processor has.
pub struct ExactLanes;

impl Contestant for ExactLanes {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: "exact-lanes",
            method: "closed forms of many runs at once, certified first crossings",
            dense_output: false,
            ..exact().declaration()
        }
    }

    fn takes(&self, case: &TimedCase) -> bool {
        case.task.oscillator.is_some()
    }

    fn enter<'a>(&'a self, case: &'a TimedCase, _: Accuracy) -> Result<ContestEntry<'a>, Failure> {
        let mut timed = Box::new(Many { case, answers: Vec::new() });
        timed.call()?;
        timed.score()?;
        Ok(ContestEntry { timed, library_part: None })
    }
}

struct Many<'a> {
    case: &'a TimedCase,
    answers: Vec<Outcome>,
}

impl Benchmark for Many<'_> {
    fn call(&mut self) -> Result<(), Failure> {
        let task = self.case.task.of_the_oscillator()?;
        self.answers = contain(|| Ok(run_in_lanes(Instructions::widest(), task, RUNS)))?;
        Ok(())
    }

    fn check(&mut self) -> Result<(), Failure> {
        self.score().map(|_| ())
    }
}

impl TimedRun for Many<'_> {
    fn runs(&self) -> f64 {
        RUNS as f64
    }

    /// The worst of all.
    fn score(&self) -> Result<Score, Failure> {
        let none = Failure::new("no run has ended");
        let mut scores = self.answers.iter().map(|answer| self.case.score(answer));
        let first = scores.next().ok_or(none)??;
        scores.try_fold(first, |worst, score| Ok(worst.or_worse(&score?)))
    }

    fn work(&self) -> Work {
        self.answers.first().map(|answer| answer.work).unwrap_or_default()
    }
}
