//! The restart test: from states along a case's true run through the next two events, or from
//! states on its attractor ([`super::on_attractor`]).
//!
//! Each sample of the truth, rounded, is a start of its own. Its run ends half way between the
//! second and the third of the instants at which the case has events from there on, so that what is
//! measured is one passage through events and not what a long run makes of it.

use super::decisions::{Decision, decisions};
use super::event_names::EventNames;
use super::graze::Graze;
use super::grazes::grazes;
use super::restart_figures::{Restart, RestartError, RestartResult};
use super::rule::{Beside, ErrorRule, deviation};
use super::scored_horizon::{MAX_ERROR_UNITS, ScoredBy};
use super::statistics::worst;
use crate::case::Case;
use crate::engine::{Accuracy, Failure, Outcome, Task};
use crate::system::SystemProblem;
use crate::truth::{DoubleDouble, Truth, TruthRow, solver};
use percuss::Ending;
use percuss::TwoWord;
use percuss::affine::{Rational, Solver, StartPoint};
use rayon::prelude::*;
use std::sync::Arc;

/// Instants with events through which a run goes.
const EVENT_INSTANTS: usize = 2;
/// A guard that is zero by the model is below this share of its terms in 106 bits.
const ZERO_TOLERANCE: f64 = 1e-24;
/// Events that are closer together than this, over the system's unit of time, are passed as one.
const SEPARATION_TOLERANCE: f64 = 1e-5;

/// A run with its truth.
pub struct RestartRun {
    /// The task that an engine is given.
    pub task: Task,
    /// The true run, with how errors grow along it.
    pub truth: Truth,
    /// Whether the run has an impact; where systems differ from the oscillator, an event.
    pub impact: bool,
    pub(super) grazes: Vec<Graze>,
    pub(super) decisions: Vec<Decision>,
}

/// The runs of one case.
pub struct RestartTest {
    /// The runs with a truth, in the order of their starts.
    pub runs: Vec<RestartRun>,
    /// Runs that 106 bits do not decide, which are left out.
    pub undecided: usize,
    pub(super) names: EventNames,
    pub(super) rule: ErrorRule,
}

/// The source of restarts: a case with its truth, and the data that its runs share.
struct Restarts<'a> {
    case: &'a Case,
    problem: &'a SystemProblem,
    truth: &'a Truth,
    names: &'a EventNames,
    rule: &'a ErrorRule,
    solver: Solver<DoubleDouble>,
}

impl RestartTest {
    /// Makes runs from at most `count` of the samples of a case's truth, spread evenly over those
    /// that events follow. None are made of a case that has fewer events than a run passes.
    ///
    /// # Errors
    /// A system that the solver does not take.
    pub fn along(
        case: &Case,
        problem: &SystemProblem,
        truth: &Truth,
        count: usize,
    ) -> Result<Self, String> {
        let system = problem.checked.system();
        let (names, rule) = (EventNames::new(case, system), ErrorRule::new(case, system));
        let solver = solver(case)?;
        let restarts = Restarts { case, problem, truth, names: &names, rule: &rule, solver };
        let spans = truth.samples.iter().skip(1).filter_map(|row| Some((row, restarts.span(row)?)));
        let starts: Vec<_> = spans.collect();
        let count = count.min(starts.len());
        let spread = |k: usize| starts[k * starts.len() / count];
        let made: Vec<_> = (0..count).into_par_iter().map(|k| restarts.run(spread(k))).collect();
        let runs: Vec<_> = made.into_iter().flatten().collect();
        Ok(Self { undecided: count - runs.len(), runs, names, rule })
    }

    /// Scores an engine on all runs, as [`RestartTest::score_first`] does.
    pub fn score(
        &self,
        asked: (Accuracy, f64),
        run: impl Fn(&Task) -> Result<Outcome, Failure> + Sync,
    ) -> Restart {
        self.score_first(usize::MAX, asked, run)
    }

    /// Scores an engine, given how it runs a task, on the first runs, at most this many. Runs in
    /// which an error of `unit` may decide what follows are not made.
    pub fn score_first(
        &self,
        most: usize,
        (accuracy, unit): (Accuracy, f64),
        run: impl Fn(&Task) -> Result<Outcome, Failure> + Sync,
    ) -> Restart {
        let runs = &self.runs[..most.min(self.runs.len())];
        let results: Vec<_> = runs
            .par_iter()
            .filter(|it| it.is_decided(&self.rule, (accuracy, unit)))
            .map(|it| RestartResult {
                impact: it.impact,
                events: it.truth.events.len(),
                error: run(&it.task).map(|outcome| self.error(it, &outcome, unit)).ok(),
            })
            .collect();
        Restart::new(&results, self.undecided)
    }

    /// The time that all runs take together.
    #[must_use]
    pub fn span(&self) -> f64 {
        self.runs.iter().map(|it| it.task.span).sum()
    }
}

impl Restarts<'_> {
    /// The length of the run from a sample; none if too few events follow.
    fn span(&self, row: &TruthRow) -> Option<f64> {
        let close = SEPARATION_TOLERANCE * self.case.system.time_scale;
        let begin = row.elapsed.value();
        let mut instants = vec![begin];
        for event in &self.truth.events {
            let ahead = event.elapsed.value();
            if ahead <= begin {
                continue;
            }
            let last = instants[instants.len() - 1];
            if instants.len() > EVENT_INSTANTS && ahead - last > 2.0 * close {
                return Some(0.5 * (last + ahead) - begin);
            }
            if ahead - last > close {
                instants.push(ahead);
            } else {
                // The run ends behind all events of one instant.
                let place = instants.len() - 1;
                instants[place] = ahead;
            }
        }
        None
    }

    fn run(&self, (row, span): (&TruthRow, f64)) -> Option<RestartRun> {
        let begin = self.problem.clock(row.elapsed.value());
        let zero = Rational::ZERO;
        let exact = |value: f64| Rational::try_from(value).ok();
        let state =
            row.state.iter().map(|it| Some([zero.clone(), zero.clone(), exact(it.value())?]));
        let state = state.collect::<Option<Vec<_>>>()?;
        let start = StartPoint { mode: row.mode, time: exact(begin)?, state };
        let until = if self.case.backward { begin - span } else { begin + span };
        let mut case = Case { until, samples: 1, ..self.case.clone() };
        case.system.start = Some(start.clone());
        let truth = Truth::solve(&case, &self.solver).ok()?;
        if truth.ended != Ending::Horizon {
            return None;
        }
        let problem = Arc::new(self.problem.from_start(start).ok()?);
        let task = Task::from_problem(&problem, truth.span, truth.sample_times()).ok()?;
        let grazes = grazes(&problem, &truth, (self.names, self.rule));
        let decisions = decisions(&problem.checked, &truth, self.rule);
        let impact = !truth.events.is_empty();
        Some(RestartRun { task, truth, impact, grazes, decisions })
    }
}

/// The size of a guard's value in a state, and of the terms that it is summed from; no value where
/// the guard depends on theta, which is known in f64 alone.
fn at_entry(guard: &[Rational], state: &[TwoWord]) -> [f64; 2] {
    let (factors, [cos, sin, one]) = guard.split_at(state.len()) else { return [0.0; 2] };
    let terms = state.iter().zip(factors).map(|(x, factor)| x.times_two_word(two_words(factor)));
    let terms: Vec<TwoWord> = terms.chain([two_words(one)]).collect();
    let size = terms.iter().map(|term| term.value().abs()).sum();
    let value = terms.into_iter().fold(TwoWord::ZERO, TwoWord::plus).value();
    let is_told = [cos, sin].iter().all(|factor| **factor == Rational::ZERO);
    if is_told { [value.abs(), size] } else { [0.0, size] }
}

/// A rational number, rounded to two words.
fn two_words(exact: &Rational) -> TwoWord {
    let high = exact.to_f64();
    let low = Rational::try_from(high).map_or(0.0, |high| (exact - high).to_f64());
    TwoWord::sum(high, low)
}

impl RestartRun {
    /// Whether errors of this unit leave open nothing that follows; beside its own value no error
    /// is asked for more than the run itself.
    fn is_decided(&self, rule: &ErrorRule, asked: (Accuracy, f64)) -> bool {
        let by = ScoredBy::new(asked, &self.grazes, &self.decisions);
        let clear = || self.has_an_order(asked.1) && self.has_clear_entries(rule, asked.1);
        rule.beside == Beside::Value || (clear() && rule.decides(&self.truth, by))
    }

    /// Whether the errors that a method is allowed leave no guard open where a mode is entered: one
    /// that is zero there in the case's run may be off by the rounding of this run's start.
    fn has_clear_entries(&self, rule: &ErrorRule, unit: f64) -> bool {
        let Some(problem) = &self.task.exact else { return true };
        let system = self.task.system.system();
        self.truth.events.iter().all(|row| {
            let rounded = system.modes[row.mode].until.iter();
            problem.exact.modes[row.mode].until.iter().zip(rounded).all(|(exact, rounded)| {
                let [value, size] = at_entry(&exact.guard, &row.state);
                let growth = rule.guard_growth(&rounded.guard, row, &row.rounded());
                let allowed = MAX_ERROR_UNITS * unit * growth;
                value <= ZERO_TOLERANCE * size || value > allowed
            })
        })
    }

    /// Whether the errors that a method is allowed leave the order of events that are not of one
    /// instant. Rounding the start of a run towards such an instant leaves it to its last digits.
    fn has_an_order(&self, unit: f64) -> bool {
        let scale = self.task.system.system().time_scale;
        self.truth.events.windows(2).all(|pair| {
            let apart = pair[1].elapsed.minus(pair[0].elapsed).value();
            let size = pair[1].size_of_time(scale);
            apart == 0.0 || apart > MAX_ERROR_UNITS * unit * scale * size * pair[1].growth_time
        })
    }
}

impl RestartTest {
    /// The error of a run; a constant is by the number of events, the error of a restart is not.
    pub(super) fn error(&self, it: &RestartRun, outcome: &Outcome, unit: f64) -> RestartError {
        let Self { names, rule, .. } = self;
        let RestartRun { task, truth, .. } = it;
        let (all, own) = (names.of_truth(truth), names.of_outcome(task, truth, outcome));
        let pairs = || all.iter().zip(&own);
        let same_modes = all.len() == own.len() && pairs().all(|(truth, own)| truth.is_like(own));
        let late = pairs().enumerate().map(|(n, (known, own))| {
            let time = truth.events.get(n).map_or(TwoWord::new(known.elapsed), |row| row.elapsed);
            rule.time_units(truth, n, (time, own.elapsed)) / unit
        });
        let states = truth.end.state.iter().zip(outcome.end.iter()).zip(&rule.scales);
        let absolute = states.map(|((truth, own), scale)| deviation(*truth, *own) / scale);
        let drift = |k: usize| rule.units(&truth.end, k, outcome.end[k]) / unit;
        RestartError {
            units: rule.state_units(&truth.end, &outcome.end) / unit,
            drift_units: rule.of_drifts(drift),
            time_units: if same_modes { worst(late) } else { f64::NAN },
            absolute: worst(absolute),
            same_modes,
        }
    }
}
