//! The part of an engine's run that is not the harness's: the same run, told where its events lie.
//!
//! What is left out is the harness's search for events, with the states inside a step that the
//! search asks the library for, and the counts, checks and limits at every call. What stays is the
//! library's stepping (with its own search for events, if the engine uses that), the right-hand
//! sides, Jacobians and guards that the library calls, and the joining of phases at events. For the
//! exact solver the table of events is left out. The answer has to be the same to the last bit.

use super::rounds::Benchmark;
use super::timed_case::TimedCase;
use crate::engine::{Accuracy, Engine, Failure, Limits, Numbers, Outcome, contain};
use crate::integration::Script;
use crate::integrators::{end_of_exact_run, exact};
use crate::system::Values;
use percuss::Step;
use std::hint::black_box;

/// Rounds in which the run alone is timed.
const ROUNDS: usize = 5;

/// The library's part of an engine's run on a case; nothing for an engine of which nothing is
/// left out.
///
/// # Errors
/// Why the engine does not run there.
pub fn library_part<'a>(
    engine: &'a dyn Engine,
    case: &'a TimedCase,
    setting: Accuracy,
    limits: Limits,
) -> Result<Option<Box<dyn Benchmark + 'a>>, Failure> {
    let run = move || engine.run(&case.task, setting, &limits);
    let (answer, script) = Script::of_run(|| contain(run));
    let answer = answer?;
    if engine.declaration().name == exact().declaration().name {
        let end = answer.end;
        return Ok(Some(Box::new(ExactSteps { case, end, last: end })));
    }
    told(answer, script, run)
}

/// A run that gave this answer, told the crossings that its search found; nothing where nothing is
/// left out then.
///
/// # Errors
/// Why it is not the same run.
fn told<'a>(
    answer: Outcome,
    script: Script,
    run: impl Fn() -> Result<Outcome, Failure> + 'a,
) -> Result<Option<Box<dyn Benchmark + 'a>>, Failure> {
    let last = answer.clone();
    let mut told = ToldRun { run, script, answer, last };
    told.call()?;
    told.check()?;
    Ok(if told.script.was_read() { Some(Box::new(told)) } else { None })
}

/// An integrator's run that is told its events.
struct ToldRun<F> {
    run: F,
    script: Script,
    answer: Outcome,
    last: Outcome,
}

impl<F: Fn() -> Result<Outcome, Failure>> Benchmark for ToldRun<F> {
    fn call(&mut self) -> Result<(), Failure> {
        let run = &self.run;
        self.last = self.script.follow(|| contain(run))?;
        Ok(())
    }

    fn check(&mut self) -> Result<(), Failure> {
        let same = self.last.events == self.answer.events && self.last.end == self.answer.end;
        if same { Ok(()) } else { Err(Failure::new("not the same run when told its events")) }
    }

    fn rounds(&self) -> usize {
        ROUNDS
    }
}

/// The exact solver's steps to the horizon, without a table.
struct ExactSteps<'a> {
    case: &'a TimedCase,
    end: Values,
    last: Values,
}

impl ExactSteps<'_> {
    /// The end of a run by the solver of any system, or by the oscillator's own.
    fn end(&self) -> Option<Values> {
        let Some(task) = &self.case.task.oscillator else {
            return end_of_exact_run(&self.case.problem, black_box(self.case.task.span));
        };
        let entry = black_box(task.problem.entry);
        let mut run = task.problem.model.trajectory(entry).until(task.horizon);
        while let Some(step) = run.step() {
            match step {
                Step::Switch { next, .. } => {
                    black_box(next);
                }
                Step::Last(segment) => {
                    let end = segment.at_instant(&task.horizon);
                    return Some(Values::from_slice(&[
                        end.state.p,
                        end.state.y,
                        end.state.q,
                        end.v,
                    ]));
                }
            }
        }
        None
    }
}

impl Benchmark for ExactSteps<'_> {
    fn call(&mut self) -> Result<(), Failure> {
        self.last = self.end().ok_or_else(|| Failure::new("a run without end"))?;
        Ok(())
    }

    fn check(&mut self) -> Result<(), Failure> {
        let same = self.last == self.end;
        if same { Ok(()) } else { Err(Failure::new("not the same run without its table")) }
    }

    fn rounds(&self) -> usize {
        ROUNDS
    }
}
