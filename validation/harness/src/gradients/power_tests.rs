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

/// An answer of whole rows.
fn answer(reference: &Reference, rows: impl Fn(usize) -> Option<Vec<Vec<f64>>>) -> GradientAnswer {
    let names = 0..reference.case.by.len();
    let by = names.map(|name| rows(name).map(|it| NameAnswer::whole(&it))).collect();
    GradientAnswer { by, ..Default::default() }
}

/// The verdicts on answers that are the same at both tolerances.
fn verdicts(reference: &Reference, rows: impl Fn(usize) -> Option<Vec<Vec<f64>>>) -> Vec<Judged> {
    let answer = answer(reference, rows);
    judge(reference, &TOLERANCES.map(|it| (it, Some(&answer))))
}

/// The verdicts on differences of runs that are the same at both tolerances.
fn verdicts_on_differences(reference: &Reference, step: f64, central: bool) -> Vec<Judged> {
    let rows = |name| reference.differences(name, step, central);
    let answer = GradientAnswer { are_differences: true, ..answer(reference, rows) };
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

/// Where only derivatives that are zero can be told from their error, nothing can be said.
#[test]
fn an_answer_of_zeros_is_never_right() {
    for reference in &references() {
        let zeros = |name| {
            let rows: Vec<Vec<f64>> = reference.derivatives(name);
            Some(rows.iter().map(|it| vec![0.0; it.len()]).collect())
        };
        let found = verdicts(reference, zeros);
        let right = found.iter().find(|it| it.verdict == Verdict::Right);
        assert!(right.is_none(), "{}", place(reference, right.unwrap()));
    }
}

/// Central differences over a step of 1e-5 of the value are off by its square.
#[test]
fn good_differences_are_right() {
    for reference in references().iter().filter(|it| it.case.system.name == "bouncing-ball") {
        let found = verdicts_on_differences(reference, 1e-5, true);
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

/// The cases whose events stay the same over steps of a hundredth.
fn references_for_differences() -> Vec<Reference> {
    let is_chosen =
        |it: &Reference| it.case.system.name == "bouncing-ball" || it.case.name == "amici-3274";
    references().into_iter().filter(is_chosen).collect()
}

/// Differences over a step of a hundredth are named as such with their kind, or too good to tell.
/// In `amici-3274` errors of one-sided and central ones differ by a factor: the reason has both.
#[test]
fn differences_that_are_too_coarse_are_named() {
    let mut named = [0; 2];
    for reference in references_for_differences() {
        for (central, kind) in [(false, "one-sided differences"), (true, "central differences")] {
            let found = verdicts_on_differences(&reference, 0.01, central);
            for it in found.iter().filter(|it| it.verdict.is_wrong()) {
                let is_named = it.missing_term == Some(Mechanism::CoarseDifferences);
                let is_wrong = is_named && it.verdict == Verdict::WrongLimit;
                assert!(is_wrong && it.why.contains(kind), "{}", place(&reference, it));
                named[usize::from(central)] += 1;
            }
        }
    }
    assert!(named.iter().all(|it| *it >= 8), "{named:?}");
}

/// An answer that is not said to be differences never has a step for its cause.
#[test]
fn no_step_is_named_of_an_engine_that_takes_no_differences() {
    let mut wrong = 0;
    for reference in &references_for_differences() {
        for central in [false, true] {
            let found = verdicts(reference, |name| reference.differences(name, 0.01, central));
            for it in found.iter().filter(|it| it.verdict.is_wrong()) {
                let is_named = it.missing_term == Some(Mechanism::CoarseDifferences);
                assert!(!is_named && !it.why.contains("step"), "{}", place(reference, it));
                wrong += 1;
            }
        }
    }
    assert!(wrong >= 16, "{wrong}");
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
        GradientAnswer { by: by.collect(), ..Default::default() }
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

/// The tolerances at which an answer lacks a term, of a series in which what it is off takes every
/// number of units.
fn missing_at(reference: &Reference, answer: &GradientAnswer) -> Vec<f64> {
    let judged = |tolerance| judge(reference, &[(tolerance, Some(answer))]);
    let tolerances = (0..60).map(|it| 1e-3 * 0.75_f64.powi(it));
    let found = tolerances.flat_map(judged).filter(|it| it.verdict == Verdict::MissingTerm);
    found.map(|it| it.tolerance).collect()
}

/// An answer that is off by most of what a wrong rule is off, or by more, has another cause, even
/// where it is within the allowance of that rule.
#[test]
fn an_error_like_that_of_a_wrong_rule_is_no_missing_term() {
    let cases = embedded(|it| it == "ball-dropped").unwrap();
    let reference = Reference::new(cases.into_iter().next().unwrap()).unwrap();
    let off = |share: f64| {
        answer(&reference, |name| {
            let truth = reference.derivatives(name);
            let wrong = &reference.wrong_derivatives(name, Mechanism::NoSaltation)[0];
            let cells = |(a, b): (&Vec<f64>, &Vec<f64>)| {
                a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect()
            };
            Some(truth.iter().zip(wrong).map(cells).collect())
        })
    };
    for share in [0.7, 1.4] {
        let found = missing_at(&reference, &off(share));
        assert!(found.is_empty(), "{share} of the rule's error: {found:?}");
    }
    for share in [0.95, 1.0, 1.05] {
        assert!(!missing_at(&reference, &off(share)).is_empty(), "{share} of the rule's error");
    }
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
        GradientAnswer { by: by.collect(), ..Default::default() }
    });
    let noisy = judge(&reference, &[(1e-6, Some(&answers[0])), (1e-9, Some(&answers[1]))]);
    assert!(noisy.iter().all(|it| it.verdict == Verdict::Noisy), "{noisy:?}");
}
