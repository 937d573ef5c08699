//! Restarts from states on an attractor, through the first impact and the separation after it.
//!
//! A long run in chaos only multiplies what happens in one passage through contact; here that
//! passage is measured itself, from many states. Each run ends at a strobe, the start of a forcing
//! period: the first after its separation, at most the eighth. Half of all single periods hold no
//! event at all, so the figures are of the runs that had an impact.

use super::event_names::EventNames;
use super::restart::{RestartRun, RestartTest};
use super::rule::ErrorRule;
use super::starts::on_attractor;
use crate::case::{Case, FileError, Problem, SAMPLES_PER_PERIOD};
use crate::engine::{OscillatorTask, SampleGrid, Task, percussive, place};
use crate::truth::{GrowthMatrices, Truth, TruthRow};
use percuss::{Instant, Phase};
use rayon::prelude::*;
use std::sync::Arc;

/// The most forcing periods of a run, which ends at the latest at this strobe.
pub const MAX_HORIZON_PERIODS: u64 = 8;

impl RestartTest {
    /// Makes `count` runs from states on the attractor that a case's run reaches.
    ///
    /// # Errors
    /// A case that is not in the oscillator's own words.
    pub fn on_attractor(case: &Case, count: usize) -> Result<Self, FileError> {
        let own = case.of_oscillator()?;
        let system = percussive(own.parameters(), 0.0);
        let growth = GrowthMatrices::new(case);
        let starts = on_attractor(&own.problem, count);
        let run = |start| RestartRun::through_contact(start, &growth);
        let made: Vec<_> = starts.into_par_iter().map(run).collect();
        let mut runs: Vec<RestartRun> = made.into_iter().flatten().collect();
        let mut events = 0;
        for run in &mut runs {
            let own = run.task.oscillator.as_mut();
            own.into_iter().for_each(|it| Arc::make_mut(it).events_before = events);
            events += run.truth.events.len() as u64;
        }
        let (names, rule) = (EventNames::new(case, &system), ErrorRule::new(case, &system));
        Ok(Self { undecided: count - runs.len(), runs, names, rule })
    }
}

impl RestartRun {
    /// The run from a start; `None` if 106 bits do not decide it.
    fn through_contact(problem: Problem, growth: &GrowthMatrices) -> Option<Self> {
        let parameters = *problem.model.parameters();
        let strobe = |periods: u64| Instant::at(parameters.omega, 0.0, 0).after_periods(periods, 1);
        let replayed = |periods: u64| {
            let grid = (0, SAMPLES_PER_PERIOD);
            Truth::replayed(&parameters, &problem.entry, strobe(periods), grid).ok()
        };
        let after = |event: &TruthRow| {
            let instant = problem.entry.instant.after(event.elapsed, parameters.omega);
            u64::try_from(instant.cycle() + 1).unwrap_or(1).min(MAX_HORIZON_PERIODS)
        };
        // The truth is followed to the last strobe, then cut at its own.
        let whole = replayed(MAX_HORIZON_PERIODS)?;
        let (impact, separation) = passage(&whole);
        let periods = separation.as_ref().map_or(MAX_HORIZON_PERIODS, after);
        let mut truth = if periods == MAX_HORIZON_PERIODS { whole } else { replayed(periods)? };
        growth.from(problem.start.tau).fill(&mut truth);
        let task = Task::of_oscillator(&task(problem, strobe(periods))).ok()?;
        Some(Self { task, truth, impact, grazes: Vec::new(), decisions: Vec::new() })
    }
}

/// Whether a run has an impact, and the separation that follows it.
fn passage(truth: &Truth) -> (bool, Option<TruthRow>) {
    const NO_CONTACT_MODE: usize = place(Phase::NoContact);
    let mut before = truth.start.mode;
    let mut impact = false;
    for event in &truth.events {
        if event.mode == NO_CONTACT_MODE {
            if impact {
                return (true, Some(event.clone()));
            }
        } else if before == NO_CONTACT_MODE {
            impact = true;
        }
        before = event.mode;
    }
    (impact, None)
}

/// The run from a start to an instant, without samples on the way.
pub(super) fn task(problem: Problem, horizon: Instant) -> OscillatorTask {
    let grid = SampleGrid { per_period: SAMPLES_PER_PERIOD, count: 0 };
    OscillatorTask::until(*problem.model.parameters(), problem, horizon, grid)
}

#[cfg(test)]
#[path = "restart_tests.rs"]
mod tests;
