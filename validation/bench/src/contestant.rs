//! Who is timed: whatever can run a case and show what came of it.
//!
//! An engine is one ([`EnteredEngine`]). Something that is no engine, such as many runs at once
//! ([`super::lanes`]), implements [`Contestant`] in a file of its own and is named in
//! [`super::contestants`].

use super::library_part::library_part;
use super::rounds::Benchmark;
use super::timed::{ContestEntry, TimedRun};
use super::timed_case::{Score, TimedCase};
use crate::engine::{
    Accuracy, Declaration, Engine, Failure, Limits, Outcome, Stepping, Work, contain, least_work,
};
use crate::number::brief;

/// Calls (right-hand sides, Jacobians, guards) beyond which a run is given up: a second or less.
const MAX_CALLS: u64 = 5_000_000;

/// Something that can be timed on a case.
pub trait Contestant: Sync {
    /// The contestant's declaration: its name, its library, and how its accuracy is chosen.
    fn declaration(&self) -> Declaration;

    /// Whether it runs the system of a case.
    fn takes(&self, case: &TimedCase) -> bool;

    /// Made ready for a case, with its own part of a run alone where that can be told apart from
    /// the harness's; nothing of this is timed.
    ///
    /// # Errors
    /// Why it does not run there.
    fn enter<'a>(
        &'a self,
        case: &'a TimedCase,
        setting: Accuracy,
    ) -> Result<ContestEntry<'a>, Failure>;
}

/// An engine as a contestant.
pub struct EnteredEngine(pub &'static dyn Engine);

impl Contestant for EnteredEngine {
    fn declaration(&self) -> Declaration {
        self.0.declaration()
    }

    fn takes(&self, case: &TimedCase) -> bool {
        self.0.takes(&case.task).is_ok()
    }

    fn enter<'a>(
        &'a self,
        case: &'a TimedCase,
        setting: Accuracy,
    ) -> Result<ContestEntry<'a>, Failure> {
        let mut timed = enter(self.0, case, setting)?;
        // Only one whose answer is right is timed.
        timed.call()?;
        timed.score()?;
        // Events at the entry of a mode are not located, so that not every run can be told.
        let library_part = library_part(self.0, case, setting, limits()).ok().flatten();
        Ok(ContestEntry { timed, library_part })
    }
}

fn limits() -> Limits {
    Limits { calls: MAX_CALLS, ..Limits::default() }
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
    within_budget(least_work(engine, &case.task, setting))?;
    Ok(Box::new(EngineBenchmark { engine, case, setting, answer: Outcome::default() }))
}

/// Refuses a run that takes more right-hand sides than it may.
fn within_budget(least: f64) -> Result<(), Failure> {
    if least > MAX_CALLS as f64 {
        let budget = brief(MAX_CALLS as f64);
        let reason =
            format!("not run: {} right-hand sides at the least, of {budget}", brief(least));
        return Err(Failure::new(reason));
    }
    Ok(())
}

struct EngineBenchmark<'a> {
    engine: &'a dyn Engine,
    case: &'a TimedCase,
    setting: Accuracy,
    answer: Outcome,
}

impl Benchmark for EngineBenchmark<'_> {
    fn call(&mut self) -> Result<(), Failure> {
        let Self { engine, case, setting, .. } = self;
        self.answer = contain(|| engine.run(&case.task, *setting, &limits()))?;
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
