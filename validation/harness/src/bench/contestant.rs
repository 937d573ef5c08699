//! Who is timed: whatever can run a case and show what came of it.
//!
//! An engine is one ([`EnteredEngine`]). Something that is no engine, such as many runs at once
//! ([`super::lanes`]), implements [`Contestant`] in a file of its own and is named in
//! [`super::contestants`].

use super::library_part::library_part;
use super::rounds::Benchmark;
use super::system_run::system_entry;
use super::timed::{ContestEntry, TimedRun};
use super::timed_case::{Score, TimedCase};
use super::timed_system_case::TimedSystemCase;
use crate::engine::{
    Accuracy, Declaration, Engine, Failure, Limits, Outcome, Stepping, Task,
    Work, contain, least_work,
};
use crate::number::brief;

/// Calls (right-hand sides, Jacobians, guards) beyond which a run is given up: a second or less.
const BUDGET: u64 = 5_000_000;

/// Something that can be timed on a case.
pub trait Contestant: Sync {
    /// The contestant's declaration: its name, its library, and how its accuracy is chosen.
    fn declaration(&self) -> Declaration;

    /// Made ready for a case; nothing of this is timed.
    ///
    /// # Errors
    /// Why it does not run there.
    fn enter<'a>(
        &'a self,
        case: &'a TimedCase,
        setting: Accuracy,
    ) -> Result<Box<dyn TimedRun + 'a>, Failure>;

    /// The contestant's own part of a run, without the harness's; nothing where that cannot be told
    /// apart.
    ///
    /// # Errors
    /// Why it does not run there, or is not the same run then.
    fn library_part<'a>(
        &'a self,
        _case: &'a TimedCase,
        _setting: Accuracy,
    ) -> Result<Option<Box<dyn Benchmark + 'a>>, Failure> {
        Ok(None)
    }

    /// Whether it runs the system of a case.
    fn takes(&self, _case: &TimedSystemCase) -> bool {
        false
    }

    /// Made ready for a run of any other system, with its own part alone where that can be told
    /// apart; nothing of this is timed.
    ///
    /// # Errors
    /// Why it does not run there.
    fn enter_system<'a>(
        &'a self,
        _case: &'a TimedSystemCase,
        _setting: Accuracy,
    ) -> Result<ContestEntry<'a>, Failure> {
        Err(Failure::new("it runs the oscillator alone"))
    }
}

/// An engine as a contestant.
pub struct EnteredEngine(pub &'static dyn Engine);

impl Contestant for EnteredEngine {
    fn declaration(&self) -> Declaration {
        self.0.declaration()
    }

    fn enter<'a>(
        &'a self,
        case: &'a TimedCase,
        setting: Accuracy,
    ) -> Result<Box<dyn TimedRun + 'a>, Failure> {
        enter(self.0, case, setting)
    }

    fn library_part<'a>(
        &'a self,
        case: &'a TimedCase,
        setting: Accuracy,
    ) -> Result<Option<Box<dyn Benchmark + 'a>>, Failure> {
        library_part(self.0, case, setting, limits())
    }

    fn takes(&self, case: &TimedSystemCase) -> bool {
        self.0.takes(&case.task).is_ok()
    }

    fn enter_system<'a>(
        &'a self,
        case: &'a TimedSystemCase,
        setting: Accuracy,
    ) -> Result<ContestEntry<'a>, Failure> {
        self.0.available().map_err(Failure::new)?;
        within_budget(least_work(self.0, &case.task, setting))?;
        system_entry(self.0, case, setting, limits())
    }
}

fn limits() -> Limits {
    Limits { calls: BUDGET, ..Limits::default() }
}

/// An engine made ready for a case.
///
/// # Errors
/// Why it does not run there.
pub fn enter<'a>(
    engine: &'a dyn Engine,
    case: &'a TimedCase,
    setting: Accuracy,
) -> Result<Box<dyn TimedRun + 'a>, Failure> {
    engine.available().map_err(Failure::new)?;
    let task = Task::of_oscillator(&case.task)?;
    within_budget(least_work(engine, &task, setting))?;
    Ok(Box::new(EngineBenchmark { engine, case, task, setting, answer: Outcome::default() }))
}

/// Refuses a run that takes more right-hand sides than it may.
fn within_budget(least: f64) -> Result<(), Failure> {
    if least > BUDGET as f64 {
        let budget = brief(BUDGET as f64);
        let reason =
            format!("not run: {} right-hand sides at the least, of {budget}", brief(least));
        return Err(Failure::new(reason));
    }
    Ok(())
}

struct EngineBenchmark<'a> {
    engine: &'a dyn Engine,
    case: &'a TimedCase,
    task: Task,
    setting: Accuracy,
    answer: Outcome,
}

impl Benchmark for EngineBenchmark<'_> {
    fn call(&mut self) -> Result<(), Failure> {
        let Self { engine, task, setting, .. } = self;
        self.answer = contain(|| engine.run(task, *setting, &limits()))?;
        Ok(())
    }

    fn check(&mut self) -> Result<(), Failure> {
        self.score().map(|_| ())
    }
}

impl TimedRun for EngineBenchmark<'_> {
    fn score(&self) -> Result<Score, Failure> {
        self.case.score(&self.answer)
    }

    fn work(&self) -> Work {
        self.answer.work
    }
}

/// What a contestant is asked for: every decade of tolerance from where events are first found
/// right down to the unit of rounding, or halved steps. Methods of high order err as little as the
/// exact solver only at tolerances below 1e-13.
#[must_use]
pub fn settings(stepping: Stepping) -> Vec<Accuracy> {
    const TOLERANCES: [f64; 12] =
        [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15];
    match stepping {
        Stepping::Exact => vec![Accuracy::Exact],
        Stepping::Fixed { .. } => (2..=6).map(|k| Accuracy::Step(0.5_f64.powi(k))).collect(),
        _ => TOLERANCES.map(Accuracy::Tolerance).to_vec(),
    }
}
