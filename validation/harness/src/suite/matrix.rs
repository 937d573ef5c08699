//! The whole matrix: every engine on every case at every tolerance, in parallel and in order.

use super::prepared::{Measured, PreparedCase};
use super::probes::may_probe;
use super::scope::{Suite, SuiteScope};
use crate::case::{Case, ClassBounds, Defaults, Regime};
use crate::engine::{Accuracy, Declaration, Engine, Failure, Outcome, Role};
use crate::number::brief;
use crate::score::{Measures, RowJudgement, Subject, Verdict};
use rayon::prelude::*;
use std::time::Duration;

/// The ending of a run.
#[derive(Clone, Debug)]
pub enum Status {
    /// The run has a result.
    Ok(Box<Measures>, Box<Outcome>),
    /// The run has no result; the reason.
    Failed(Failure),
    /// The engine is not installed.
    Unavailable,
    /// The run was left out: its cost is beyond the suite's budget.
    NotRun,
}

/// The traits of a case by which its rows are counted in the ranking.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CaseTraits {
    /// Whether some of its rates are much faster than the motion.
    pub is_stiff: bool,
    /// Whether errors grow for ever.
    pub is_chaotic: bool,
    /// The number of states, which is that of a Jacobian's columns.
    pub states: usize,
}

impl CaseTraits {
    /// The traits of a case, by its trouble, or by the regime of one of the oscillator's.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let regime = case.oscillator.as_ref().map(|it| &it.regime);
        let makes = |kind: &str| case.trouble.iter().any(|it| it == kind);
        Self {
            is_stiff: makes("stiffness") || regime == Some(&Regime::StiffnessSeries),
            is_chaotic: makes("chaos") || regime.is_some_and(Regime::is_chaotic),
            states: case.system.states.len(),
        }
    }
}

/// A row of the report with its measures.
#[derive(Clone, Debug)]
pub struct Scored {
    /// The case's name.
    pub case: String,
    /// The engine's name.
    pub engine: &'static str,
    /// The tests beyond ordinary rows in which the engine takes part.
    pub role: Role,
    /// The accuracy that the engine was asked for.
    pub accuracy: Accuracy,
    /// The row's unit of error.
    pub unit: f64,
    /// The truth's events on the case's horizon, with an ending that an engine has to find.
    pub events: usize,
    /// The kinds of trouble that the case makes for integrators.
    pub trouble: Vec<String>,
    /// The traits of the case by which the row is counted in the ranking.
    pub traits: CaseTraits,
    /// The ending of the run.
    pub status: Status,
    /// Wall time.
    pub wall: Duration,
    /// The verdict.
    pub judgement: RowJudgement,
}

/// Runs everything; rows come case by case in the order of `cases` and `engines`.
pub fn run(
    cases: &[PreparedCase],
    engines: &[&'static dyn Engine],
    scope: &SuiteScope,
    defaults: &Defaults,
    done: &(impl Fn() + Sync),
) -> Vec<Scored> {
    let settings = |engine: &&'static dyn Engine| -> Vec<(&'static dyn Engine, Accuracy)> {
        accuracies(*engine, scope).into_iter().map(|it| (*engine, it)).collect()
    };
    let asked: Vec<_> = engines.iter().flat_map(settings).collect();
    let of_case = |case| asked.iter().map(move |(engine, accuracy)| (case, *engine, *accuracy));
    let jobs: Vec<_> = cases.iter().flat_map(of_case).collect();
    let row = |(case, engine, accuracy): (&PreparedCase, &'static dyn Engine, Accuracy)| {
        let row = one(case, engine, accuracy, scope.suite(), defaults);
        done();
        row
    };
    // Heavy rows lie side by side: handed out one by one they do not pile up on one thread.
    jobs.into_par_iter().with_max_len(1).map(row).collect()
}

/// Whether probes are asked of one of these engines.
#[must_use]
pub fn probes_any(engines: &[&'static dyn Engine], scope: &SuiteScope) -> bool {
    engines.iter().any(|engine| {
        let role = engine.declaration().role;
        accuracies(*engine, scope).into_iter().any(|it| may_probe(scope.suite(), role, it))
    })
}

/// The number of rows that [`run`] makes.
#[must_use]
pub fn size(cases: usize, engines: &[&'static dyn Engine], scope: &SuiteScope) -> usize {
    cases * engines.iter().map(|engine| accuracies(*engine, scope).len()).sum::<usize>()
}

fn accuracies(engine: &dyn Engine, scope: &SuiteScope) -> Vec<Accuracy> {
    scope.accuracies(engine.declaration().stepping)
}

/// The reason why an engine does not run on a case, if there is one.
fn not_run(
    case: &PreparedCase,
    engine: &dyn Engine,
    accuracy: Accuracy,
    suite: Suite,
) -> Option<(Status, Verdict, String)> {
    if let Err(reason) = engine.available() {
        return Some((Status::Unavailable, Verdict::Unavailable, reason));
    }
    if let Err(reason) = engine.takes(&case.task) {
        return Some((Status::NotRun, Verdict::NotRun, reason.to_owned()));
    }
    let (least, budget) = (case.least_work(engine, accuracy), suite.budget());
    (least > budget).then(|| {
        let reason =
            format!("at least {} right-hand sides, the budget is {}", brief(least), brief(budget));
        (Status::NotRun, Verdict::NotRun, reason)
    })
}

/// The limits of an engine's class at an accuracy; none to closed forms.
#[must_use]
pub fn class_of<'a>(
    classes: &'a [ClassBounds],
    declaration: &Declaration,
    accuracy: Accuracy,
) -> Option<&'a ClassBounds> {
    ClassBounds::new(classes, declaration.class_and_order(), declaration.stepping, accuracy)
}

/// Runs one engine on one case, and judges its answer.
#[must_use]
pub fn one(
    case: &PreparedCase,
    engine: &dyn Engine,
    accuracy: Accuracy,
    suite: Suite,
    defaults: &Defaults,
) -> Scored {
    let declaration = engine.declaration();
    let unit = declaration.stepping.unit(accuracy);
    let row = |status, wall, judgement| Scored {
        case: case.case.name.clone(),
        engine: declaration.name,
        role: declaration.role,
        accuracy,
        unit,
        events: case.events(),
        trouble: case.case.trouble.clone(),
        traits: CaseTraits::new(&case.case),
        status,
        wall,
        judgement,
    };
    let without = |status, verdict, why: String| {
        row(status, Duration::ZERO, RowJudgement::without_result(verdict, why))
    };
    if let Some((status, verdict, reason)) = not_run(case, engine, accuracy, suite) {
        return without(status, verdict, reason);
    }
    let subject = Subject { case: &case.case.name, engine: declaration.name, accuracy, unit };
    let class = class_of(&defaults.classes, &declaration, accuracy);
    let own = case.case.shortcomings.iter();
    let shortcomings: Vec<_> = own.chain(&defaults.shortcomings).collect();
    match case.attempt(engine, (accuracy, unit), suite) {
        Ok(mut measured) => {
            let judgement = case.judge(&subject, &mut measured, class, defaults, &shortcomings);
            let Measured { measures, outcome, wall } = measured;
            row(Status::Ok(Box::new(measures), Box::new(outcome)), wall, judgement)
        }
        Err(failure) => {
            let judgement = RowJudgement::failed(&subject, &failure.reason, &shortcomings);
            row(Status::Failed(failure), Duration::ZERO, judgement)
        }
    }
}
