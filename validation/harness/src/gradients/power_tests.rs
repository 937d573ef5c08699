//! Wrong answers of each kind are caught by their names, and right ones pass, in every case.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a panic is a failed test")]

use super::{GradientAnswer, Judged, Mechanism, NameAnswer, Reference, Verdict, embedded, judge};
use rayon::prelude::*;
use std::collections::BTreeMap;

const TOLERANCES: [f64; 2] = [1e-6, 1e-9];

fn references() -> Vec<Reference> {
    let cases = embedded(|_| true).unwrap();
    cases.into_par_iter().map(|it| Reference::new(it).unwrap()).collect()
}

/// The verdicts on answers that are the same at both tolerances.
fn verdicts(reference: &Reference, rows: impl Fn(usize) -> Option<Vec<Vec<f64>>>) -> Vec<Judged> {
    let names = 0..reference.case.by.len();
    let by = names.map(|name| rows(name).map(|it| NameAnswer::whole(&it))).collect();
    let answer = GradientAnswer { by, event_error: None };
    judge(reference, &TOLERANCES.map(|it| (it, Some(&answer))))
}

fn place(reference: &Reference, it: &Judged) -> String {
    let Judged { wrt, tolerance, verdict, why, .. } = it;
    format!("{} by {wrt} at {tolerance:e}: {verdict}, {why}", reference.case.name)
}

/// What is left of proved digits is the rounding of f64, which the growth of errors carries: a
/// millionth of a unit of 1e-9 is 1e-15.
#[test]
fn derivatives_walked_in_f64_are_right_in_every_case() {
    let references = references();
    assert_eq!(references.len(), 53);
    let told = references.par_iter().map(|reference| {
        let found = verdicts(reference, |name| Some(reference.derivatives(name)));
        let wrong = found
            .iter()
            .find(|it| it.verdict != Verdict::Right && it.verdict != Verdict::NoneAsked);
        assert!(wrong.is_none(), "{}", place(reference, wrong.unwrap()));
        found.iter().filter(|it| it.tolerance == 1e-9 && it.verdict == Verdict::Right).count()
    });
    let names: usize = references.iter().map(|it| it.case.by.len()).sum();
    let told: usize = told.sum();
    assert!(told * 10 >= names * 9, "{told} of {names} names can be told");
}

/// Central differences over a step of 1e-5 of the value are off by its square.
#[test]
fn good_differences_are_right() {
    for reference in references().iter().filter(|it| it.case.system.name == "bouncing-ball") {
        let found = verdicts(reference, |name| reference.differences(name, 1e-5, true));
        for it in found.iter().filter(|it| it.tolerance == 1e-6) {
            assert!(!it.verdict.is_wrong(), "{}", place(reference, it));
        }
    }
}

/// Each wrong rule at events: where it changes a derivative by more than is allowed, its name is
/// the first or among those that say the same.
#[test]
fn every_wrong_rule_is_caught_by_its_name() {
    let references = references();
    let mut caught: BTreeMap<Mechanism, usize> = BTreeMap::new();
    for mechanism in Mechanism::ALL {
        for reference in &references {
            let rules = reference.wrong_derivatives(0, mechanism).len();
            for rule in 0..rules {
                let is_finite = |name| {
                    let rows = &reference.wrong_derivatives(name, mechanism)[rule];
                    rows.iter().flatten().all(|it| it.is_finite())
                };
                // The guard's rate on the other side may be zero: no program has such an answer.
                if !(0..reference.case.by.len()).all(is_finite) {
                    continue;
                }
                let found = verdicts(reference, |name| {
                    Some(reference.wrong_derivatives(name, mechanism)[rule].clone())
                });
                for it in found.iter().filter(|it| it.verdict.is_wrong()) {
                    let is_named = it.verdict == Verdict::Zero
                        || it.missing_term == Some(mechanism)
                        || it.why.contains(mechanism.as_str());
                    assert!(is_named, "{mechanism}, rule {rule}: {}", place(reference, it));
                    *caught.entry(mechanism).or_default() +=
                        usize::from(it.missing_term == Some(mechanism));
                }
            }
        }
    }
    for mechanism in Mechanism::ALL.iter().filter(|it| **it != Mechanism::CoarseDifferences) {
        let count = caught.get(mechanism).copied().unwrap_or_default();
        assert!(count >= 20, "{mechanism} is caught under its own name {count} times");
    }
}

/// Differences over a thirtieth of a value are named as such, or too good to tell, in every case
/// whose events stay the same over the step.
#[test]
fn differences_that_are_too_coarse_are_named() {
    let mut named = [0; 2];
    for reference in references().iter().filter(|it| it.case.system.name == "bouncing-ball") {
        for central in [false, true] {
            let found = verdicts(reference, |name| reference.differences(name, 0.01, central));
            for it in found.iter().filter(|it| it.verdict.is_wrong()) {
                let is_named = it.missing_term == Some(Mechanism::CoarseDifferences);
                assert!(is_named && it.verdict == Verdict::WrongLimit, "{}", place(reference, it));
                named[usize::from(central)] += 1;
            }
        }
    }
    assert!(named.iter().all(|it| *it >= 8), "{named:?}");
}

/// A wrong rule that is no longer there at a tighter tolerance was an error near it by chance, and
/// so is one that leaves most of the error.
#[test]
fn an_error_near_a_wrong_rule_is_no_missing_term() {
    let cases = embedded(|_| true).unwrap();
    let case = cases.into_iter().find(|it| it.name == "ball-dropped").unwrap();
    let reference = Reference::new(case).unwrap();
    let answer = |rows: &dyn Fn(usize) -> Vec<Vec<f64>>| {
        let by = (0..reference.case.by.len()).map(|it| Some(NameAnswer::whole(&rows(it))));
        GradientAnswer { by: by.collect(), event_error: None }
    };
    let wrong =
        answer(&|name| reference.wrong_derivatives(name, Mechanism::NoSaltation)[0].clone());
    let right = answer(&|name| reference.derivatives(name));
    let verdicts = |answers: [&GradientAnswer; 2]| {
        let both = [(1e-6, Some(answers[0])), (1e-9, Some(answers[1]))];
        judge(&reference, &both).into_iter().map(|it| it.verdict).collect::<Vec<_>>()
    };
    let [chance, missing] = [[&wrong, &right], [&wrong, &wrong]].map(verdicts);
    assert!(missing.contains(&Verdict::MissingTerm), "{missing:?}");
    assert!(chance.contains(&Verdict::Noisy), "{chance:?}");
    assert!(!chance.contains(&Verdict::MissingTerm), "{chance:?}");
    // Beyond the rule by as much as it differs from the truth.
    let beyond = answer(&|name| {
        let (truth, wrong) = (
            reference.derivatives(name),
            reference.wrong_derivatives(name, Mechanism::NoSaltation)[0].clone(),
        );
        let rows = truth.iter().zip(wrong);
        rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| b + 1.2 * (b - a)).collect()).collect()
    });
    let beyond = verdicts([&beyond, &beyond]);
    assert!(!beyond.contains(&Verdict::MissingTerm), "{beyond:?}");
}

/// Sign, zero, noise and silence, on one case.
#[test]
fn other_answers_have_their_verdicts() {
    let cases = embedded(|_| true).unwrap();
    let case = cases.into_iter().find(|it| it.name == "ball-dropped").unwrap();
    let reference = Reference::new(case).unwrap();
    let first = |found: Vec<Judged>| found[0].clone();
    let scaled = |factor: f64| {
        let rows = |name| {
            let walked = reference.derivatives(name);
            Some(walked.iter().map(|row| row.iter().map(|it| it * factor).collect()).collect())
        };
        first(verdicts(&reference, rows))
    };
    assert_eq!(scaled(-1.0).missing_term, Some(Mechanism::Sign));
    assert_eq!(scaled(0.0).verdict, Verdict::Zero);
    assert_eq!(scaled(1.3).verdict, Verdict::WrongLimit);
    assert!(scaled(f64::NAN).verdict.is_wrong());
    assert_eq!(first(verdicts(&reference, |_| None)).verdict, Verdict::Refused);
    let none = judge(&reference, &[(1e-6, None)]);
    assert_eq!(none[0].verdict, Verdict::NoneAsked);
    let answers = TOLERANCES.map(|tolerance| {
        let by = (0..reference.case.by.len()).map(|name| {
            let rows = reference.derivatives(name);
            let off = |it: &f64| it + 1e4 * tolerance;
            Some(NameAnswer(
                rows.iter().map(|row| row.iter().map(|it| Some(off(it))).collect()).collect(),
            ))
        });
        GradientAnswer { by: by.collect(), event_error: None }
    });
    let noisy = judge(&reference, &[(1e-6, Some(&answers[0])), (1e-9, Some(&answers[1]))]);
    assert!(noisy.iter().all(|it| it.verdict == Verdict::Noisy), "{noisy:?}");
}
