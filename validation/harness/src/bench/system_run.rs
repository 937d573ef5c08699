//! An engine on a run of any other system than the oscillator: the whole run, and its own part.

use super::library_part::told;
use super::rounds::Benchmark;
use super::timed::{ContestEntry, TimedRun};
use super::timed_case::Score;
use super::timed_system_case::TimedSystemCase;
use crate::engine::{Accuracy, Engine, Failure, Limits, Outcome, Work, contain};
use crate::integrators::{end_of_exact_run, exact};
use crate::system::Values;
use std::hint::black_box;

/// An engine made ready for a run. What of it is the engine's alone is told apart as
/// [`super::library_part`] does it, where the answer is then the same to the last bit.
///
/// # Errors
/// Why the engine does not run there.
pub fn system_entry<'a>(
    engine: &'a dyn Engine,
    case: &'a TimedSystemCase,
    setting: Accuracy,
    limits: Limits,
) -> Result<ContestEntry<'a>, Failure> {
    let run = move || engine.run(&case.task, setting, &limits);
    let answer = contain(run)?;
    let library_part: Option<Box<dyn Benchmark + 'a>> =
        if engine.declaration().name == exact().declaration().name {
            Some(Box::new(ExactEvents { case, end: answer.end, last: answer.end }))
        } else {
            // Events at the entry of a mode are not located, so that not every run can be told.
            told(answer.clone(), run).ok().flatten()
        };
    Ok(ContestEntry { timed: Box::new(SystemBenchmark { run, case, answer }), library_part })
}

struct SystemBenchmark<'a, F> {
    run: F,
    case: &'a TimedSystemCase,
    answer: Outcome,
}

impl<F: Fn() -> Result<Outcome, Failure>> Benchmark for SystemBenchmark<'_, F> {
    fn call(&mut self) -> Result<(), Failure> {
        self.answer = contain(&self.run)?;
        Ok(())
    }

    fn check(&mut self) -> Result<(), Failure> {
        self.score().map(|_| ())
    }
}

impl<F: Fn() -> Result<Outcome, Failure>> TimedRun for SystemBenchmark<'_, F> {
    fn score(&self) -> Result<Score, Failure> {
        self.case.score(&self.answer)
    }

    fn work(&self) -> Work {
        self.answer.work
    }
}

/// The exact solver's events to the horizon, without a table.
struct ExactEvents<'a> {
    case: &'a TimedSystemCase,
    end: Values,
    last: Values,
}

impl Benchmark for ExactEvents<'_> {
    fn call(&mut self) -> Result<(), Failure> {
        let last = end_of_exact_run(&self.case.problem, black_box(self.case.task.span));
        self.last = last.ok_or_else(|| Failure::new("a run without end"))?;
        Ok(())
    }

    fn check(&mut self) -> Result<(), Failure> {
        let same = self.last == self.end;
        if same { Ok(()) } else { Err(Failure::new("not the same run without its table")) }
    }

    fn rounds(&self) -> usize {
        super::library_part::ROUNDS
    }
}
