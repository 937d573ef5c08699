//! The restart test: from states on the attractor through the first impact and the separation after
//! it.
//!
//! A long run in chaos only multiplies what happens in one passage through contact; here that
//! passage is measured itself, from many states. Each run ends at a strobe, the start of a forcing
//! period: the first after its separation, at most the eighth. Half of all single periods hold no
//! event at all, so the figures are of the runs that had an impact.

use super::growth::RunGrowth;
use super::starts::on_attractor;
use crate::case::Problem;
use crate::engine::{Failure, OscillatorTask, Outcome, SampleGrid, Task, place};
use crate::score::restart_figures::{Restart, RestartError, RestartResult};
use crate::score::statistics::worst;
use crate::truth::{Truth, TruthRow};
use percuss::TwoWord;
use percuss::{Instant, Phase};
use rayon::prelude::*;
use std::sync::Arc;

/// A run ends at the latest at this strobe.
pub const MOST_PERIODS: u64 = 8;

/// A run with its truth.
pub struct RestartRun {
    /// The task that an engine is given.
    pub task: Task,
    /// The true run.
    pub truth: Truth,
    /// The growth of errors along the true run.
    pub growth: RunGrowth,
    /// Whether the run has an impact.
    pub impact: bool,
}

/// The runs of one case.
pub struct RestartTest {
    /// The runs with a truth, in the order of their starts.
    pub runs: Vec<RestartRun>,
    /// Runs that 106 bits do not decide, which are left out.
    pub undecided: usize,
}

impl RestartTest {
    /// Makes `count` runs from states on the attractor that a run from `problem` reaches.
    #[must_use]
    pub fn new(problem: &Problem, count: usize) -> Self {
        let starts = on_attractor(problem, count);
        let made: Vec<_> = starts.into_par_iter().map(RestartRun::new).collect();
        let mut runs: Vec<RestartRun> = made.into_iter().flatten().collect();
        let mut events = 0;
        for run in &mut runs {
            run.set_events_before(events);
            events += run.truth.events.len() as u64;
        }
        Self { undecided: count - runs.len(), runs }
    }

    /// Scores an engine, given how it runs a task; `unit` is its unit of error: its tolerance, or
    /// eps.
    pub fn score(
        &self,
        unit: f64,
        run: impl Fn(&Task) -> Result<Outcome, Failure> + Sync,
    ) -> Restart {
        self.score_first(usize::MAX, unit, run)
    }

    /// Scores an engine on the first runs, at most this many.
    pub fn score_first(
        &self,
        most: usize,
        unit: f64,
        run: impl Fn(&Task) -> Result<Outcome, Failure> + Sync,
    ) -> Restart {
        let runs = &self.runs[..most.min(self.runs.len())];
        let measured = |it: &RestartRun| RestartResult {
            impact: it.impact,
            events: it.truth.events.len(),
            error: run(&it.task).map(|outcome| it.error(&outcome, unit)).ok(),
        };
        let results: Vec<_> = runs.par_iter().map(measured).collect();
        Restart::of(&results, self.undecided)
    }
}

impl RestartRun {
    /// The run from a start; `None` if 106 bits do not decide it.
    fn new(problem: Problem) -> Option<Self> {
        let parameters = *problem.model.parameters();
        let strobe = |periods: u64| Instant::at(parameters.omega, 0.0, 0).after_periods(periods, 1);
        let replayed = |periods: u64| {
            let grid = (0, Truth::SAMPLES_PER_PERIOD);
            Truth::replayed(&parameters, &problem.entry, strobe(periods), grid).ok()
        };
        let after = |event: &TruthRow| {
            let instant = problem.entry.instant.after(event.elapsed, parameters.omega);
            u64::try_from(instant.cycle() + 1).unwrap_or(1).min(MOST_PERIODS)
        };
        // The truth is followed to the last strobe, then cut at its own.
        let whole = replayed(MOST_PERIODS)?;
        let (impact, separation) = passage(&whole);
        let periods = separation.as_ref().map_or(MOST_PERIODS, after);
        let truth = if periods == MOST_PERIODS { whole } else { replayed(periods)? };
        let task = task(problem, strobe(periods));
        let growth = RunGrowth::along(&truth, &parameters, task.forcing_angle);
        let task = Task::of_oscillator(&task).ok()?;
        Some(Self { task, truth, growth, impact })
    }

    /// The number of events that the engine had before this run.
    fn set_events_before(&mut self, events: u64) {
        self.task.oscillator.as_mut().into_iter().for_each(|it| Arc::make_mut(it).events_before = events);
    }

    fn error(&self, outcome: &Outcome, unit: f64) -> RestartError {
        let truth = &self.truth.end.state;
        let off = |k: usize| off(truth[k], outcome.end[k]);
        let units = |k: usize| off(k) / scale(unit, truth[k], self.growth.end[k]);
        let same_modes = self.same_phases(outcome);
        let pairs = self.truth.events.iter().zip(&outcome.events).zip(&self.growth.events);
        let late = pairs.map(|((truth, found), growth)| {
            self::off(truth.elapsed, found.elapsed) / scale(unit, truth.elapsed, growth[0])
        });
        RestartError {
            units: worst((0..4).map(units)),
            drift_units: units(3),
            time_units: if same_modes { worst(late) } else { f64::NAN },
            absolute: worst((0..4).map(off)),
            same_modes,
        }
    }

    fn same_phases(&self, outcome: &Outcome) -> bool {
        let truth = self.truth.events.iter().map(|event| event.phase.map(place));
        truth.eq(outcome.events.iter().map(|event| Some(event.mode)))
    }
}

fn off(truth: TwoWord, found: f64) -> f64 {
    truth.minus(TwoWord::new(found)).value().abs()
}

fn scale(unit: f64, truth: TwoWord, growth: f64) -> f64 {
    unit * (1.0 + truth.value().abs()) * growth
}

/// Whether a run has an impact, and the separation that follows it.
fn passage(truth: &Truth) -> (bool, Option<TruthRow>) {
    let mut before = truth.start.phase;
    let mut impact = false;
    for event in &truth.events {
        if event.phase == Some(Phase::NoContact) {
            if impact {
                return (true, Some(*event));
            }
        } else if before == Some(Phase::NoContact) {
            impact = true;
        }
        before = event.phase;
    }
    (impact, None)
}

/// The run from a start to an instant, without samples on the way.
pub(super) fn task(problem: Problem, horizon: Instant) -> OscillatorTask {
    let grid = SampleGrid { per_period: Truth::SAMPLES_PER_PERIOD, count: 0 };
    OscillatorTask::until(*problem.model.parameters(), problem, horizon, grid)
}

#[cfg(test)]
#[path = "restart_tests.rs"]
mod tests;
