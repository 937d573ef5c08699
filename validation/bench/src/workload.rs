//! The exact solver's work per event, apart from any engine's: what is recorded, and what two
//! binaries are compared by.
//!
//! Work of another kind is one more [`Workload`], named in [`all`].

use super::rounds::Benchmark;
use super::timed_case::TimedCase;
use crate::engine::Failure;
use percuss::{Counters, Entry, Model, Step};
use std::hint::black_box;

/// Work in units of which any number can be done.
pub trait Workload {
    /// The workload's name, as in the history.
    fn name(&self) -> String;

    /// Does this many units, and returns the number of closed-form evaluations that they took.
    ///
    /// # Errors
    /// Why there is no such work.
    fn run(&self, units: u64) -> Result<u64, Failure>;
}

/// Events of a case's run, followed beyond its horizon; a run that ends is begun again.
pub struct CaseEvents<'a> {
    case: &'a TimedCase,
}

impl Workload for CaseEvents<'_> {
    fn name(&self) -> String {
        format!("switches/{}", self.case.name)
    }

    fn run(&self, units: u64) -> Result<u64, Failure> {
        let problem = &self.case.task.of_the_oscillator()?.problem;
        let (mut done, mut evaluations) = (0, 0);
        while done < units {
            let counters = follow_events(&problem.model, problem.entry, units - done);
            if counters.switches == 0 {
                return Err(Failure::new("its first phase never ends: there is no event to time"));
            }
            done += counters.switches;
            evaluations += counters.evaluations;
        }
        Ok(evaluations)
    }
}

/// Follows a run for this many events, or to its end.
fn follow_events(model: &Model, entry: Entry, most: u64) -> Counters {
    let mut run = model.trajectory(black_box(entry));
    while run.counters().switches < most {
        match run.step() {
            Some(Step::Switch { next, .. }) => black_box(next),
            _ => break,
        };
    }
    run.counters()
}

/// The workloads of these cases.
#[must_use]
pub fn all(timed_cases: &[TimedCase]) -> Vec<Box<dyn Workload + '_>> {
    let own =
        timed_cases.iter().map(|case| Box::new(CaseEvents { case }) as Box<dyn Workload + '_>);
    own.collect()
}

/// A workload to be timed.
pub struct Repeated<'a> {
    /// The work.
    pub workload: &'a dyn Workload,
    /// The number of units that one call does.
    pub units: u64,
}

impl Benchmark for Repeated<'_> {
    fn call(&mut self) -> Result<(), Failure> {
        self.workload.run(self.units).map(|_| ())
    }
}
