//! What is asked of an engine beyond the run of a case itself: restarts, valid horizons and the
//! same attractor. Which cases ask what of integrators is said in their files (`[probes]`).

use super::scope::Suite;
use crate::case::{Case, FileError, OscillatorCase, ProbedCase};
use crate::engine::{Accuracy, Engine, Limits, Role, Task, answer, contain};
use crate::score::attractor::{AttractorTest, Calibrated};
use crate::score::{HorizonTest, ProbeResults, RestartTest};
use crate::system::SystemProblem;
use crate::truth::Truth;

/// The tolerance at which integrators are probed in the quick suite.
const QUICK_TOLERANCE: f64 = 1e-9;
/// The tolerances at which integrators are probed in the full suite.
const FULL_TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-12];

/// Whether a row is shown where all would be too many: one engine a library, as accurate as one
/// that is asked for everything.
#[must_use]
pub fn is_shown(role: Role, accuracy: Accuracy) -> bool {
    let among = |it: f64| FULL_TOLERANCES.contains(&it);
    role == Role::Representative && accuracy.tolerance().is_none_or(among)
}

/// Whether a suite may probe an engine at this accuracy on some case.
#[must_use]
pub fn may_probe(suite: Suite, role: Role, accuracy: Accuracy) -> bool {
    let asked = accuracy.tolerance().is_some_and(|it| suite.probed_tolerances().contains(&it));
    let whoever = suite == Suite::Full || role == Role::Representative;
    accuracy == Accuracy::Exact || (asked && whoever)
}

impl Suite {
    /// The tolerances at which integrators are probed.
    fn probed_tolerances(self) -> &'static [f64] {
        match self {
            Self::Quick => &[QUICK_TOLERANCE],
            Self::Full => &FULL_TOLERANCES,
        }
    }
}

/// The probes of one case, made ready once and shared by all engines.
#[derive(Default)]
pub struct Probes {
    /// Restarts from states on the attractor, or along the run.
    pub restart: Option<RestartTest>,
    /// Runs until they are no longer right.
    pub horizons: Option<HorizonTest>,
    /// A long run's section.
    pub attractor: Option<AttractorTest>,
}

impl Probes {
    /// Makes the probes of a case ready for a suite; `limits` are those of all cases.
    ///
    /// # Errors
    /// The exact solver's own failure, or a case that says too short a time for its valid horizons.
    pub fn new(
        case: &Case,
        (problem, truth): (&SystemProblem, &Truth),
        suite: Suite,
        limits: &[Calibrated],
    ) -> Result<Self, FileError> {
        let Some(oscillator) = &case.oscillator else {
            let restart = RestartTest::along(case, problem, truth, restarts_along(suite));
            let restart = Some(restart.map_err(|what| FileError::new(&case.file, what))?);
            return Ok(Self { restart, ..Self::default() });
        };
        // In the full suite the exact solver restarts on every attractor.
        let restarted = suite == Suite::Full || oscillator.probed.integrators;
        let restart = restarted.then(|| RestartTest::on_attractor(case, restarts(suite)));
        let own = limits.iter().find(|it| it.case == case.name).cloned();
        let attractor = own.map(|it| AttractorTest::new(oscillator, it)).transpose();
        let attractor = attractor.map_err(|failure| FileError(failure.to_string()))?;
        Ok(Self { restart: restart.transpose()?, horizons: horizons(case, oscillator)?, attractor })
    }

    /// Asks an engine as much as `extent` says, in its unit of error.
    #[must_use]
    pub fn ask(
        &self,
        case: &Case,
        engine: &dyn Engine,
        (accuracy, unit): (Accuracy, f64),
        limits: &Limits,
        extent: Extent,
    ) -> ProbeResults {
        let run = |task: &_| answer(engine, task, accuracy, limits);
        let restarts = self.restart.as_ref().filter(|_| extent.restarts > 0);
        let restart = restarts.map(|it| it.score_first(extent.restarts, (accuracy, unit), run));
        let asked = self.horizons.as_ref().filter(|_| extent.horizons > 0);
        let horizons = asked.map(|test| test.score_first(extent.horizons, unit, run));
        let compare = |(test, own): (&AttractorTest, &OscillatorCase)| {
            contain(|| test.compare(own, engine, accuracy, limits)).map_err(|it| it.to_string())
        };
        let attractor = self.attractor.as_ref().filter(|_| extent.attractor);
        let attractor = attractor.zip(case.oscillator.as_ref());
        ProbeResults { restart, horizons, attractor: attractor.map(compare) }
    }

    /// Forcing periods of the long run, where there is one.
    fn long_run(&self) -> f64 {
        let plan = self.attractor.as_ref().map(|it| it.calibrated.plan);
        plan.map_or(0.0, |plan| f64::from(plan.transient + plan.periods))
    }

    /// How much a suite asks of an engine on this case. What the case's own run cost tells what the
    /// probes would: they too stay within the budget of right-hand sides.
    #[must_use]
    pub fn extent(
        &self,
        suite: Suite,
        (case, task): (&Case, &Task),
        role: Role,
        asked: (Accuracy, f64),
        work: u64,
    ) -> Extent {
        if !may_probe(suite, role, asked.0) {
            return Extent::default();
        }
        match &case.oscillator {
            Some(own) => {
                let periods = task.span / own.problem.model.period();
                self.on_attractor(suite, own.probed, role, asked, work as f64 / periods.max(1.0))
            }
            None => {
                let chosen = asked.0 == Accuracy::Exact || role == Role::Representative;
                let restart = self.restart.as_ref().filter(|_| chosen);
                let restarts =
                    restart.map_or(0, |it| affordable(it, suite, work as f64 / task.span));
                Extent { restarts, ..Extent::default() }
            }
        }
    }

    fn on_attractor(
        &self,
        suite: Suite,
        probed: ProbedCase,
        role: Role,
        (accuracy, unit): (Accuracy, f64),
        work_a_period: f64,
    ) -> Extent {
        if accuracy == Accuracy::Exact {
            return Extent { restarts: restarts(suite), horizons: HORIZON_RUNS, attractor: true };
        }
        let budget = suite.budget() / work_a_period.max(1.0);
        let affordable = Extent {
            restarts: restarts(suite)
                .min((budget / PERIODS_PER_RESTART) as usize)
                .max(MIN_RESTARTS),
            horizons: 0,
            attractor: self.long_run() <= budget,
        };
        let asked = if probed.integrators { affordable } else { Extent::default() };
        let lasting = self.horizons.as_ref().is_some_and(|it| it.length(unit) as f64 <= budget);
        let followed = suite == Suite::Full && role == Role::Representative && lasting;
        let horizons = if followed { HORIZON_RUNS } else { 0 };
        Extent { horizons, ..asked }
    }
}

/// How many restarts of a test a suite affords at so many right-hand sides a unit of time.
fn affordable(test: &RestartTest, suite: Suite, work: f64) -> usize {
    let work = work * test.span();
    let share = suite.budget() / work.max(1.0);
    (test.runs.len() as f64 * share.min(1.0)) as usize
}

/// The number of restarts and runs that a probe asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// Restarts, at most.
    pub restarts: usize,
    /// Valid horizons, at most.
    pub horizons: usize,
    /// Whether the long run is made.
    pub attractor: bool,
}

impl Extent {
    /// The tests of an engine that is wrong on purpose.
    #[must_use]
    pub fn of_wrong(case: &Case) -> Self {
        let listed = case.oscillator.as_ref().is_some_and(|it| it.probed.integrators);
        let restarts = if listed { restarts(Suite::Quick) } else { 0 };
        Self { restarts, horizons: WRONG_HORIZON_RUNS, attractor: listed }
    }

    /// The tests of an integrator with a fault: those of a wrong engine, with fewer restarts.
    #[must_use]
    pub fn of_faulty(case: &Case) -> Self {
        let wrong = Self::of_wrong(case);
        Self { restarts: wrong.restarts.min(MIN_RESTARTS), ..wrong }
    }
}

/// Runs from which a valid horizon is taken: as many as a median needs to be good to a period or
/// two.
const HORIZON_RUNS: usize = 200;
/// Runs for the valid horizon of a wrong engine, which is off by far more than a period or two.
const WRONG_HORIZON_RUNS: usize = 40;

/// The test of valid horizons, where a case asks for it.
fn horizons(case: &Case, own: &OscillatorCase) -> Result<Option<HorizonTest>, FileError> {
    let Some(periods) = own.probed.valid_within else { return Ok(None) };
    let test = HorizonTest::new(case, HORIZON_RUNS, periods)?;
    if test.decides(f64::EPSILON) {
        return Ok(Some(test));
    }
    Err(FileError(format!(
        "{}: valid_within = {periods} is not accepted: forcing periods within which errors grow from eps \
         to 1e-3 in each of {HORIZON_RUNS} runs on the case's attractor",
        case.file
    )))
}

/// Restarts of a system's case, spread over its run.
const fn restarts_along(suite: Suite) -> usize {
    match suite {
        Suite::Quick => 20,
        Suite::Full => 100,
    }
}

/// A restart takes about this many forcing periods.
const PERIODS_PER_RESTART: f64 = 4.0;
/// Restarts that are made whatever they cost.
const MIN_RESTARTS: usize = 100;

const fn restarts(suite: Suite) -> usize {
    match suite {
        Suite::Quick => 1_000,
        Suite::Full => 10_000,
    }
}
