//! The valid horizon in chaos: how many forcing periods pass until an engine's error is 1e-3.
//!
//! Errors grow so unevenly that one run says little (55 to 129 periods from eps to 1e-3 between the
//! 1 % quantiles), and the mean exponent says less. So it is measured from many states on the
//! attractor, each beside the period at which the truth's own growth along that very run takes the
//! engine's unit of error to 1e-3. In 106 bits the truth lasts twice as long as f64; it counts
//! while its own unit times growth is below a hundredth of 1e-3.

use super::SCORED_ERROR;
use super::horizons::{Horizons, ValidHorizon};
use super::on_attractor::task;
use super::rule::ErrorRule;
use super::starts::far_apart;
use super::statistics::Spread;
use crate::case::{Case, FileError, Problem};
use crate::engine::{Failure, OscillatorTask, Outcome, SampleGrid, Task, percussive};
use crate::truth::{DoubleDouble, GrowthMatrices, Truth};
use rayon::prelude::*;

/// An engine's run is made until its unit of error times the growth passes this many times 1e-3.
/// One that is still right then is a thousand times better than its unit, as one run in some
/// hundreds is whose errors happen to lie where they shrink; it is made again for as long as the
/// truth lasts.
const ERROR_MARGIN_FACTOR: f64 = 1e3;
/// The truth counts while its own error is below this.
const MAX_TRUTH_ERROR: f64 = SCORED_ERROR / 100.0;

/// A run with its truth, once per forcing period.
struct HorizonRun {
    problem: Problem,
    truth: Truth,
    /// The largest growth of p, y and q so far, at each sample.
    growth: Vec<f64>,
    /// Events of the runs before it: a fault may strike every hundredth.
    events_before: u64,
}

/// Runs from states on one attractor.
pub struct HorizonTest {
    runs: Vec<HorizonRun>,
    /// The number of runs that 106 bits do not decide.
    pub undecided: usize,
    periods: u32,
    rule: ErrorRule,
}

impl HorizonTest {
    /// Follows the truth from `count` states on a case's attractor for this many periods.
    ///
    /// # Errors
    /// A case that is not in the oscillator's own words.
    pub fn new(case: &Case, count: usize, periods: u32) -> Result<Self, FileError> {
        let own = case.of_oscillator()?;
        let rule = ErrorRule::new(case, &percussive(own.parameters(), 0.0));
        let growth = GrowthMatrices::new(case);
        // A run forgets where it began within its horizon, some 90 periods in f64.
        let starts = far_apart(&own.problem, count, u64::from(periods));
        let run = |start| HorizonRun::new(start, periods, (&growth, &rule));
        let made: Vec<_> = starts.into_par_iter().map(run).collect();
        let mut runs: Vec<HorizonRun> = made.into_iter().flatten().collect();
        let mut events = 0;
        for run in &mut runs {
            run.events_before = events;
            events += run.truth.events.len() as u64;
        }
        Ok(Self { undecided: count - runs.len(), runs, periods, rule })
    }

    /// The number of periods for which the truth itself holds in each run, at most those that were
    /// followed.
    #[must_use]
    pub fn trusted_periods(&self) -> Vec<u32> {
        self.runs.iter().map(HorizonRun::trusted_periods).collect()
    }

    /// Whether in every run an error of this unit grows to 1e-3 while the truth lasts.
    #[must_use]
    pub fn decides(&self, unit: f64) -> bool {
        let mut predicted = self.runs.iter().map(|run| run.grows_to(SCORED_ERROR / unit));
        predicted.all(|it| it < self.periods) && self.undecided == 0 && !self.runs.is_empty()
    }

    /// Forcing periods that an engine with this unit of error has to run, all runs together.
    #[must_use]
    pub fn length(&self, unit: f64) -> u64 {
        self.runs.iter().map(|run| u64::from(run.last_period(unit))).sum()
    }

    /// Scores an engine, given how it runs a task; `unit` is its unit of error: its tolerance, or
    /// eps.
    pub fn score(
        &self,
        unit: f64,
        run: impl Fn(&Task) -> Result<Outcome, Failure> + Sync,
    ) -> Horizons {
        self.score_first(usize::MAX, unit, run)
    }

    /// Scores an engine on the first runs, at most this many.
    pub fn score_first(
        &self,
        most: usize,
        unit: f64,
        run: impl Fn(&Task) -> Result<Outcome, Failure> + Sync,
    ) -> Horizons {
        let asked = &self.runs[..most.min(self.runs.len())];
        let results: Vec<_> =
            asked.par_iter().map(|it| it.horizon(&self.rule, unit, &run)).collect();
        let runs: Vec<_> = results.iter().map(|(horizon, _)| *horizon).collect();
        let spread =
            |value: fn(&ValidHorizon) -> f64| Spread::new(runs.iter().map(value).collect());
        let negative = spread(|run| -f64::from(run.valid));
        Horizons {
            failed: results.iter().filter(|(_, failed)| *failed).count(),
            valid: spread(|run| f64::from(run.valid)),
            valid_q01: -negative.q99,
            predicted: spread(|run| f64::from(run.predicted)),
            gained: spread(|run| f64::from(run.valid) - f64::from(run.predicted)),
            runs,
        }
    }
}

impl HorizonRun {
    fn new(
        problem: Problem,
        periods: u32,
        (growth, rule): (&GrowthMatrices, &ErrorRule),
    ) -> Option<Self> {
        let entry = problem.entry;
        let horizon = entry.instant.after_periods(u64::from(periods), 1);
        let grid = (periods as usize + 1, 1);
        let parameters = problem.model.parameters();
        let mut truth = Truth::replayed(parameters, &entry, horizon, grid).ok()?;
        growth.from(problem.start.tau).fill(&mut truth);
        let mut largest = 1.0_f64;
        let rising = truth.samples.iter().map(|row| {
            largest = largest.max(rule.largest_growth(row));
            largest
        });
        let growth = rising.collect();
        Some(Self { problem, truth, growth, events_before: 0 })
    }

    /// The last period before the growth passes a size.
    fn grows_to(&self, size: f64) -> u32 {
        let within = self.growth.iter().take_while(|growth| **growth <= size).count();
        within.saturating_sub(1) as u32
    }

    /// The period at which an engine's run ends.
    fn last_period(&self, unit: f64) -> u32 {
        self.grows_to(ERROR_MARGIN_FACTOR * SCORED_ERROR / unit).min(self.trusted_periods())
    }

    /// The period up to which the truth can score.
    fn trusted_periods(&self) -> u32 {
        self.grows_to(MAX_TRUTH_ERROR / DoubleDouble::UNIT)
    }

    fn horizon(
        &self,
        rule: &ErrorRule,
        unit: f64,
        run: &impl Fn(&Task) -> Result<Outcome, Failure>,
    ) -> (ValidHorizon, bool) {
        let predicted = self.grows_to(SCORED_ERROR / unit);
        let usual = self.last_period(unit);
        let mut found = self.horizon_of_run(rule, usual, run);
        if found.as_ref().is_ok_and(|valid| *valid == usual) && self.trusted_periods() > usual {
            found = self.horizon_of_run(rule, self.trusted_periods(), run);
        }
        let outlasts = found.as_ref().is_ok_and(|valid| *valid == self.trusted_periods());
        let valid = found.as_ref().map_or(0, |valid| *valid);
        (ValidHorizon { valid, predicted, outlasts }, found.is_err())
    }

    /// The valid horizon of a run of the given number of periods.
    fn horizon_of_run(
        &self,
        rule: &ErrorRule,
        periods: u32,
        run: &impl Fn(&Task) -> Result<Outcome, Failure>,
    ) -> Result<u32, Failure> {
        let horizon = self.problem.entry.instant.after_periods(u64::from(periods), 1);
        let grid = SampleGrid { per_period: 1, count: periods as usize + 1 };
        let events_before = self.events_before;
        let own = OscillatorTask { grid, events_before, ..task(self.problem, horizon) };
        let outcome = run(&Task::of_oscillator(&own)?)?;
        Ok(self.valid_periods(rule, &outcome, periods))
    }

    fn valid_periods(&self, rule: &ErrorRule, outcome: &Outcome, last: u32) -> u32 {
        let pairs = self.truth.samples.iter().zip(&outcome.samples).take(last as usize + 1);
        // Written so that a NaN is off.
        let within = pairs.take_while(|(row, found)| rule.state_error(row, found) <= SCORED_ERROR);
        within.count().saturating_sub(1) as u32
    }
}

#[cfg(test)]
#[path = "valid_horizon_tests.rs"]
mod tests;
