//! Engines in this process are asked for derivatives, and what they answer is judged by name.

#![allow(clippy::unwrap_used, reason = "a panic is a failed test")]

use super::{Judged, Mechanism, Reference, TOLERANCES, Verdict, embedded, one, run};
use crate::engine::{
    Accuracy, Declaration, Engine, Failure, Limits, Outcome, REFERENCE, RunDerivatives, Task,
};
use crate::integrators;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A change of what an engine answers.
type Change = fn(&mut Outcome, &Task);

/// The exact solver, whose answers are changed.
struct Changed(Change);

fn exact() -> &'static dyn Engine {
    *integrators::all().iter().find(|it| it.declaration().name == REFERENCE).unwrap()
}

impl Engine for Changed {
    fn declaration(&self) -> Declaration {
        exact().declaration()
    }

    fn differentiates(&self) -> bool {
        true
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let mut outcome = exact().run(task, accuracy, limits)?;
        self.0(&mut outcome, task);
        Ok(outcome)
    }
}

fn case(name: &str) -> Reference {
    let case = embedded(|it| it == name).unwrap().pop();
    Reference::new(case.unwrap()).unwrap()
}

fn judge_changed(change: Change) -> Vec<Judged> {
    one(&case("ball-first-impacts"), &Changed(change), &TOLERANCES)
}

fn refused(change: Change) -> String {
    let judged = judge_changed(change);
    assert!(judged.iter().all(|it| it.verdict == Verdict::Refused), "{judged:?}");
    judged[0].why.clone()
}

fn change_each(outcome: &mut Outcome, change: impl FnMut(&mut RunDerivatives)) {
    outcome.gradients.iter_mut().flatten().for_each(change);
}

/// Closed forms in f64 are the null: what they answer is right in every case.
#[test]
fn the_exact_solver_is_right_in_every_case() {
    let cases: Vec<Reference> =
        embedded(|_| true).unwrap().into_par_iter().map(|it| Reference::new(it).unwrap()).collect();
    let rows = run(&cases, &[exact()], &TOLERANCES, &|| {});
    let is_other = |it: &Verdict| !matches!(it, Verdict::Right | Verdict::NoneAsked);
    let wrong: Vec<_> = rows.iter().filter(|it| is_other(&it.judged.verdict)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let names: usize = cases.iter().map(|it| it.case.by.len()).sum();
    assert_eq!(rows.len(), names * TOLERANCES.len());
}

/// Negated times beside right states are no rule's: they are wrong, and no term is named.
#[test]
fn what_no_rule_explains_is_wrong_without_a_term() {
    let judged = judge_changed(|outcome, task| {
        let rates = task.gradients.as_deref().unwrap();
        let e = rates.iter().position(|it| it.name == "e").unwrap();
        let all = outcome.gradients[e].as_mut().unwrap();
        for event in &mut all.events {
            event.time = event.time.map(|it| -it);
        }
    });
    for it in &judged {
        let (verdict, term) = (it.verdict, it.missing_term);
        match it.wrt.as_str() {
            "e" => assert_eq!((verdict.is_wrong(), term), (true, None), "{it:?}"),
            _ => assert_eq!(verdict, Verdict::Right, "{it:?}"),
        }
    }
}

#[test]
fn derivatives_with_the_other_sign_are_named() {
    let judged = judge_changed(|outcome, _| {
        change_each(outcome, |it| {
            it.end.iter_mut().for_each(|it| *it = -*it);
            for event in &mut it.events {
                event.time = event.time.map(|it| -it);
                event.state.iter_mut().for_each(|it| it.iter_mut().for_each(|it| *it = -*it));
            }
        });
    });
    for it in judged {
        assert_eq!(it.verdict, Verdict::MissingTerm, "{it:?}");
        assert_eq!(it.missing_term, Some(Mechanism::Sign), "{it:?}");
    }
}

#[test]
fn derivatives_of_the_end_alone_are_judged_and_none_are_refused() {
    let at_end = judge_changed(|outcome, _| change_each(outcome, |it| it.events.clear()));
    assert!(at_end.iter().all(|it| it.verdict == Verdict::Right), "{at_end:?}");
    assert!(at_end.iter().all(|it| it.why.contains("cells answered")), "{at_end:?}");
    assert_eq!(refused(|outcome, _| outcome.gradients.clear()), "there is no answer by this name");
}

#[test]
fn what_no_answer_is_says_whose_it_is() {
    let short = refused(|outcome, _| change_each(outcome, |it| it.events.truncate(1)));
    assert!(short.starts_with("the derivatives by g: they are of 1 events, and"), "{short}");
    let nan = refused(|outcome, _| change_each(outcome, |it| it.end[0] = f64::NAN));
    assert_eq!(nan, "the derivatives by g: the end has NaN for a state");
    let names = refused(|outcome, _| outcome.gradients.truncate(1));
    assert_eq!(names, "gave derivatives by 1 names where 3 were asked for");
    let other = refused(|outcome, _| {
        outcome.events.truncate(1);
        change_each(outcome, |it| it.events.truncate(1));
    });
    assert!(other.starts_with("the run has other events: it has 1, not"), "{other}");
}

/// An engine without a tolerance answers the same at every one.
#[test]
fn an_exact_engine_is_asked_once() {
    static ASKED_RUNS: AtomicUsize = AtomicUsize::new(0);
    let rows = judge_changed(|_, _| {
        ASKED_RUNS.fetch_add(1, Ordering::Relaxed);
    });
    let names = case("ball-first-impacts").case.by.len();
    assert_eq!((ASKED_RUNS.load(Ordering::Relaxed), rows.len()), (1, names * TOLERANCES.len()));
}
