//! Records judged from the records before them: right answers are right, and each kind of wrong
//! answer is told for what it is.

use crate::exact;
use percuss::Ending;
use percuss_validation::case::defaults;
use percuss_validation::engine::{Accuracy, Engine, Outcome, answer};
use percuss_validation::integrators::all;
use percuss_validation::power::Variant;
use percuss_validation::score::local::{Allowance, LocalJudgement, WrongKind};
use percuss_validation::suite::{PreparedCase, Suite, class_of};

/// Cases of every kind of trouble: impacts, drift, friction, a clock, watched levels, a multiple
/// zero, accumulation, simultaneous events, a run back in time.
const CASES: [&str; 12] = [
    "fig7a-period-4",
    "table1-first-row",
    "friction-two-stops",
    "buck-periodic",
    "watched-every-direction",
    "plastic-sticks-and-flies",
    "ball-geometric",
    "ball-backward",
    "cradle-two",
    "relay-1e-2",
    "height-crossed-twice",
    "belt-two-masses",
];

const ACCURACY: Accuracy = Accuracy::Tolerance(1e-6);

fn cases() -> Vec<PreparedCase> {
    exact::prepared(|name| CASES.contains(&name), None)
}

pub(super) fn engine(name: &str) -> &'static dyn Engine {
    let mut engines = all().iter().copied();
    engines.find(|it| it.declaration().name == name).expect("it is an engine")
}

/// The answer of an engine, and what its class of methods is allowed.
fn answer_of(engine: &dyn Engine, case: &PreparedCase) -> (Outcome, Allowance) {
    answered_to(engine, case, ACCURACY)
}

/// The answer at an accuracy.
pub(super) fn answered_to(
    engine: &dyn Engine,
    case: &PreparedCase,
    accuracy: Accuracy,
) -> (Outcome, Allowance) {
    let declaration = engine.declaration();
    let limits = Suite::limits(&case.case);
    let right = answer(engine, &case.task, accuracy, &limits).expect("an answer");
    let classes = defaults().expect("the limits are read").classes;
    let class = class_of(&classes, &declaration, accuracy).expect("a class");
    (right, Allowance::new(class, declaration.stepping.unit(accuracy)))
}

pub(super) fn judged(
    case: &PreparedCase,
    answer: &Outcome,
    allowance: Allowance,
) -> LocalJudgement {
    case.local.judge(&case.task, answer, allowance).expect("a start that the solver takes")
}

#[test]
fn right_answers_are_right_whatever_the_method() {
    let engines = [
        "ode_solvers-dopri5",
        "differential-equations-rkv767e",
        "differential-equations-radau5",
        "diffsol-tr_bdf2",
        "differential-equations-bdf",
    ];
    let mut records = 0;
    for case in cases() {
        for engine in engines.map(engine) {
            let name = engine.declaration().name;
            let (right, allowance) = answer_of(engine, &case);
            let found = judged(&case, &right, allowance);
            assert_eq!(found.first_wrong, None, "{name} on {}", case.case.name);
            assert!(!found.is_wrong(&allowance), "{name} on {}", case.case.name);
            assert!(found.right + found.undecidable > 0, "{name} on {}", case.case.name);
            records += found.right;
        }
    }
    assert!(records > 800, "{records}");
}

/// On how many cases a variant is caught, and spoils anything; and what is said of it first.
fn count_caught(variant: Variant) -> (usize, usize, Vec<WrongKind>) {
    let engine = engine("ode_solvers-dopri5");
    let (mut caught, mut spoiled, mut kinds) = (0, 0, Vec::new());
    for case in cases() {
        let (right, allowance) = answer_of(engine, &case);
        let Some(wrong) = variant.wrong_answer(
            &case.task,
            (&right, case.local.judged(&right)),
            allowance.tolerance,
        ) else {
            continue;
        };
        let found = judged(&case, &wrong, allowance);
        spoiled += 1;
        caught += usize::from(found.is_wrong(&allowance));
        kinds.extend(found.first_wrong.map(|it| it.kind));
    }
    (caught, spoiled, kinds)
}

#[test]
fn late_events_are_seen_where_they_are_located() {
    for by in [30.0, 100.0] {
        let (caught, spoiled, kinds) = count_caught(Variant::Late(by));
        assert_eq!((caught, spoiled), (CASES.len(), CASES.len()), "{by}");
        let located = kinds.iter().filter(|it| **it == WrongKind::Location).count();
        assert!(located + 1 >= CASES.len(), "{by}: {kinds:?}");
    }
}

#[test]
fn wrong_answers_are_caught_wherever_they_are_wrong() {
    let variants = [
        Variant::TimesLate(100.0),
        Variant::OldState,
        Variant::LinearSamples,
        Variant::Noise(100.0),
        Variant::StatesOff,
        Variant::ColumnsSwapped,
        Variant::SamplesBehind,
        Variant::HalfHorizon,
        Variant::OneNaN,
        Variant::GarbageAfterAThird,
        Variant::WrongMode,
    ];
    for variant in variants {
        let (caught, spoiled, kinds) = count_caught(variant);
        assert!(spoiled > 0 && caught == spoiled, "{variant:?}: {caught} of {spoiled} {kinds:?}");
    }
}

/// An event that is left out is missed, one that is told twice is spurious, and what comes after it
/// is judged as if nothing had happened.
#[test]
fn one_wrong_record_costs_one() {
    let engine = engine("ode_solvers-dopri5");
    for case in cases().iter().filter(|it| it.case.name.starts_with("fig7a")) {
        let (right, allowance) = answer_of(engine, case);
        let all = right.events.len();
        let mut twice = right.clone();
        twice.events.insert(all / 2, right.events[all / 2]);
        let found = judged(case, &twice, allowance);
        assert_eq!((found.right, found.spurious, found.missed), (all, 1, 0), "{found:?}");
        let first = found.first_wrong.expect("something is wrong");
        assert_eq!((first.kind, first.n), (WrongKind::Spurious, all / 2 + 2));
        let mut dropped = right.clone();
        dropped.events.remove(all / 2);
        let found = judged(case, &dropped, allowance);
        assert!(found.missed >= 1, "{found:?}");
        let first = found.first_wrong.expect("something is wrong");
        assert_eq!((first.kind, first.n), (WrongKind::Missed, all / 2 + 1));
    }
}

/// The ending of a run is judged too: that it comes, that it comes in time, and that none comes
/// where the model has none.
#[test]
fn an_ending_is_held_against_the_exact_one() {
    let engine = engine("ode_solvers-dopri5");
    let cases = cases();
    let named = |name: &str| cases.iter().find(|it| it.case.name == name).expect("a case");
    let first = |case: &PreparedCase, spoil: fn(&mut Outcome)| {
        let (mut answer, allowance) = answer_of(engine, case);
        spoil(&mut answer);
        judged(case, &answer, allowance).first_wrong
    };
    let backward = named("ball-backward");
    assert_eq!(answer_of(engine, backward).0.ended, Ending::LeavesDomain);
    let goes_on = first(backward, |it| {
        (it.ended, it.ended_at) = (Ending::Horizon, 1e9);
    });
    let goes_on = goes_on.expect("the ending is missed");
    let exact = goes_on.exact.map(|it| it.0);
    assert_eq!((goes_on.kind, exact.as_deref()), (WrongKind::Missed, Some("leaves-domain")));
    let late = first(backward, |it| it.ended_at += 1e-3).expect("the ending is late");
    assert_eq!((late.kind, late.event.as_deref()), (WrongKind::Missed, Some("leaves-domain")));
    let spurious = first(named("friction-two-stops"), |it| {
        (it.ended, it.ended_at) = (Ending::LeavesDomain, 0.99 * it.ended_at);
    });
    assert_eq!(spurious.map(|it| it.kind), Some(WrongKind::Spurious));
}
