//! The long runs that the test compares: an engine's, and the exact solver's from many starts.

use super::limits::ComparisonPlan;
use super::section::{RunSection, run_of};
use crate::case::OscillatorCase;
use crate::engine::{Accuracy, Engine, Failure, Limits, Task, answer};
use crate::integrators;
use percuss::{Parameters, Start};

/// The kinds of runs of the exact solver: no two kinds share a start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunKind {
    /// Runs by which limits are measured.
    Calibration,
    /// Runs by which the rate of false alarms is measured.
    Fresh,
    /// Runs with changed parameters.
    Changed,
}

impl RunKind {
    /// The place of the kind's first start, beyond any number of runs of the kind before it.
    const fn first(self) -> u32 {
        match self {
            Self::Calibration => 1,
            Self::Fresh => 1_000_001,
            Self::Changed => 2_000_001,
        }
    }
}

/// The most runs of one kind.
pub const MAX_RUNS: u32 = 1_000_000;

/// The distance of neighbouring starts in p. Within the transient, two hundred periods at exponents
/// of
/// 0.2 and more, it grows e^40 times and more: each start is another stretch of the same chaos.
const START_SPACING: f64 = 1e-9;

/// Run number `number` of a kind: the exact solver with `parameters` from a start of its own, as a
/// section of the attractor that the case's own parameters have.
pub(super) fn exact_section(
    case: &OscillatorCase,
    parameters: Parameters,
    plan: &ComparisonPlan,
    kind: RunKind,
    number: u32,
) -> Result<RunSection, Failure> {
    nth_section(case, parameters, plan, kind.first() + number % MAX_RUNS)
}

/// The reference section of a case: from its own start.
pub(super) fn reference(
    case: &OscillatorCase,
    plan: &ComparisonPlan,
) -> Result<RunSection, Failure> {
    nth_section(
        case,
        *case.parameters(),
        &ComparisonPlan { periods: plan.reference_periods, ..*plan },
        0,
    )
}

fn nth_section(
    case: &OscillatorCase,
    parameters: Parameters,
    plan: &ComparisonPlan,
    place: u32,
) -> Result<RunSection, Failure> {
    let start =
        Start { p: case.problem.start.p - f64::from(place) * START_SPACING, ..case.problem.start };
    let refused = || Failure::new("the start is refused");
    let periods = plan.transient + plan.periods;
    let task = run_of(parameters, start, periods).ok_or_else(refused)?;
    let truth = run_of(*case.parameters(), start, periods).ok_or_else(refused)?;
    let outcome = answer(
        integrators::exact(),
        &Task::of_oscillator(&task)?,
        Accuracy::Exact,
        &Limits::default(),
    )?;
    RunSection::judged(&task, &outcome, plan.transient, &truth.problem)
}

/// The section of one engine's run.
pub(super) fn section(
    engine: &dyn Engine,
    case: &OscillatorCase,
    plan: &ComparisonPlan,
    accuracy: Accuracy,
    limits: &Limits,
) -> Result<RunSection, Failure> {
    let task = run_of(*case.parameters(), case.problem.start, plan.transient + plan.periods)
        .ok_or_else(|| Failure::new("the start is refused"))?;
    let outcome = answer(engine, &Task::of_oscillator(&task)?, accuracy, limits)?;
    RunSection::new(&task, &outcome, plan.transient)
}
