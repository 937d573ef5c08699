//! Engines asked for the derivatives of cases, and their answers judged.

use super::answer::{GradientAnswer, NameAnswer};
use super::judge::judge;
use super::reference::Reference;
use super::verdict::{Judged, Verdict};
use crate::engine::{
    Accuracy, Engine, EventDerivatives, Failure, Limits, Outcome, RunDerivatives, Stepping, Task,
    answer,
};
use rayon::prelude::*;

/// The loosest tolerance and the tightest at which derivatives are asked for where no others are
/// chosen.
pub const TOLERANCES: [f64; 2] = [1e-6, 1e-9];

/// The verdict on one name of a case, at one tolerance of an engine.
#[derive(Clone, Debug, PartialEq)]
pub struct GradientJudgement {
    /// The engine's name.
    pub engine: &'static str,
    /// The case's name.
    pub case: String,
    /// The verdict.
    pub judged: Judged,
}

/// Asks engines for the derivatives of all cases at tolerances, and judges what they answer; rows
/// come case by case in the order of `cases` and `engines`.
#[must_use]
pub fn run(
    cases: &[Reference],
    engines: &[&'static dyn Engine],
    tolerances: &[f64],
    done: &(impl Fn() + Sync),
) -> Vec<GradientJudgement> {
    let jobs: Vec<_> =
        cases.iter().flat_map(|case| engines.iter().map(move |it| (case, *it))).collect();
    let job = |(case, engine): (&Reference, &'static dyn Engine)| {
        let judged = one(case, engine, tolerances);
        done();
        let named = |judged| {
            let (engine, case) = (engine.declaration().name, case.case.name.clone());
            GradientJudgement { engine, case, judged }
        };
        judged.into_iter().map(named).collect::<Vec<_>>()
    };
    jobs.into_par_iter().with_max_len(1).flat_map_iter(job).collect()
}

/// Asks one engine for the derivatives of a case at tolerances, and judges its answers.
#[must_use]
pub fn one(reference: &Reference, engine: &dyn Engine, tolerances: &[f64]) -> Vec<Judged> {
    let answered = answers(reference, engine, tolerances);
    let given: Vec<(f64, Option<&GradientAnswer>)> = tolerances
        .iter()
        .zip(&answered)
        .filter_map(|(tolerance, it)| Some((*tolerance, Some(it.as_ref().ok()?))))
        .collect();
    let mut judged = judge(reference, &given);
    for (tolerance, answer) in tolerances.iter().zip(&answered) {
        let Err(failure) = answer else { continue };
        judged.extend(reference.case.names().into_iter().map(|wrt| Judged {
            wrt,
            tolerance: *tolerance,
            verdict: Verdict::Refused,
            missing_term: None,
            why: failure.reason.clone(),
        }));
    }
    judged
}

/// The answers of an engine at tolerances. One without a tolerance is asked once.
fn answers(
    reference: &Reference,
    engine: &dyn Engine,
    tolerances: &[f64],
) -> Vec<Result<GradientAnswer, Failure>> {
    let is_exact = engine.declaration().stepping == Stepping::Exact;
    let asked_at = if is_exact { tolerances.len().min(1) } else { tolerances.len() };
    let asked = tolerances[..asked_at].iter().map(|it| answer_at(reference, engine, *it));
    asked.collect::<Vec<_>>().into_iter().cycle().take(tolerances.len()).collect()
}

/// The answer of an engine at a tolerance, in the rows of the case's table.
fn answer_at(
    reference: &Reference,
    engine: &dyn Engine,
    tolerance: f64,
) -> Result<GradientAnswer, Failure> {
    engine.available().map_err(Failure::new)?;
    let accuracy = match engine.declaration().stepping {
        Stepping::Exact => Accuracy::Exact,
        Stepping::Fixed { .. } => {
            return Err(Failure::new("fixed steps have no tolerance to be judged by"));
        }
        _ => Accuracy::Tolerance(tolerance),
    };
    let task = reference.case.task()?;
    engine.takes(&task).map_err(Failure::new)?;
    let outcome = answer(engine, &task, accuracy, &Limits::default())?;
    let answer = read(reference, &task, &outcome)?;
    Ok(GradientAnswer { are_differences: engine.takes_differences(), ..answer })
}

/// What a run answers, once its events are known to be those of the table.
fn read(reference: &Reference, task: &Task, outcome: &Outcome) -> Result<GradientAnswer, Failure> {
    same_events(reference, task, outcome)?;
    let times = reference.times();
    let errors = outcome.events.iter().zip(&times).map(|(it, time)| (it.elapsed - time).abs());
    let event_error = errors.reduce(f64::max);
    let by = outcome.gradients.iter().map(|it| it.as_ref().map(|it| rows(it, outcome))).collect();
    Ok(GradientAnswer { by, event_error, are_differences: false })
}

/// Refuses a run with other events than the table: their derivatives are of another motion.
fn same_events(reference: &Reference, task: &Task, outcome: &Outcome) -> Result<(), Failure> {
    let rows = &reference.case.rows;
    let wanted = &rows[1..rows.len() - 1];
    let system = task.system.system();
    let mut mode = task.mode;
    for (n, event) in outcome.events.iter().enumerate() {
        let name = system.event_name(mode, event.event).unwrap_or("no event of its mode");
        mode = event.mode;
        let into = &system.modes[mode].name;
        let row = wanted.get(n).map_or("the end", |it| &it.event);
        let is_same = wanted.get(n).is_some_and(|it| it.event == name && &it.mode == into);
        if !is_same {
            let what = format!("its event {} is {name} into {into}, not {row}", n + 1);
            return Err(Failure::new(format!("the run has other events: {what}")));
        }
    }
    if outcome.events.len() == wanted.len() {
        return Ok(());
    }
    let (given, wanted) = (outcome.events.len(), wanted.len());
    Err(Failure::new(format!("the run has other events: it has {given}, not {wanted}")))
}

/// Derivatives by one name in the rows of a table: the start, the events, the end.
fn rows(derivatives: &RunDerivatives, outcome: &Outcome) -> NameAnswer {
    let states = outcome.end.len();
    let of_event = |event: &EventDerivatives| {
        let state = event.state.as_ref();
        let states = (0..states).map(|k| state.and_then(|it| it.get(k)).copied());
        std::iter::once(event.time).chain(states).collect()
    };
    let none = EventDerivatives::default();
    let events =
        (0..outcome.events.len()).map(|n| of_event(derivatives.events.get(n).unwrap_or(&none)));
    let end = EventDerivatives { time: Some(0.0), state: Some(derivatives.end) };
    let all = std::iter::once(of_event(&none)).chain(events).chain([of_event(&end)]);
    NameAnswer(all.collect())
}
