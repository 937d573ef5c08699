//! Answers that were made to pass: each was right by the letter of an earlier rule, and is told for
//! what it is.

use crate::exact;
use crate::records::{answered_to, engine, judged};
use percuss::Ending;
use percuss_validation::engine::{Accuracy, Event, Numbers, Outcome};
use percuss_validation::score::local::{LocalJudgement, WrongKind};
use percuss_validation::suite::PreparedCase;
use percuss_validation::system::Values;

/// What is said of a right answer to a case that was changed, at two tolerances.
fn forged_judgements(
    case: &str,
    forge: impl Fn(&PreparedCase, &mut Outcome),
) -> [LocalJudgement; 2] {
    let prepared = exact::prepared(|name| name == case, None).remove(0);
    [1e-6, 1e-9].map(|tolerance| {
        let engine = engine("differential-equations-rkv767e");
        let accuracy = Accuracy::Tolerance(tolerance);
        let (mut answer, allowance) = answered_to(engine, &prepared, accuracy);
        let right = judged(&prepared, &answer, allowance);
        assert!(!right.is_wrong(&allowance), "{case} at {tolerance}: {:?}", right.first_wrong);
        forge(&prepared, &mut answer);
        let found = judged(&prepared, &answer, allowance);
        assert!(found.is_wrong(&allowance), "{case} at {tolerance}: {found:?}");
        found
    })
}

fn first_kind(found: &LocalJudgement) -> Option<WrongKind> {
    found.first_wrong.as_ref().map(|it| it.kind)
}

/// The place of an event of a mode by its name.
fn place(case: &PreparedCase, mode: usize, name: &str) -> usize {
    let system = case.task.system.system();
    let is_it = |event: &usize| system.event_name(mode, *event) == Some(name);
    (0..100).find(is_it).expect("an event of the mode")
}

/// A record of one of an instant's contacts does not have the state that all of them come to.
#[test]
fn one_record_does_not_stand_for_an_instant() {
    let whole = |case: &PreparedCase, answer: &mut Outcome, name: &str, after: Values| {
        let event = place(case, case.task.mode, name);
        answer.events.truncate(1);
        let first = &mut answer.events[0];
        (first.event, first.state) = (event, after);
    };
    let meeting = Values::from_slice(&[1.0, 2.0, 3.0, -9.0, -6.0, -3.0]);
    for found in forged_judgements("spheres-meet-inelastic", |case, it| {
        whole(case, it, "two-three", meeting)
    }) {
        assert_eq!(first_kind(&found), Some(WrongKind::Inconsistent));
    }
    for (case, name) in [("cradle-two", "one-two"), ("cradle-one", "two-three")] {
        let last = |case: &PreparedCase, answer: &mut Outcome| {
            let after = answer.events.last().expect("an event").state;
            whole(case, answer, name, after);
        };
        forged_judgements(case, last);
    }
}

/// The impacts of an accumulation that are left out are missed, wherever the last record is.
#[test]
fn a_tail_of_impacts_cannot_be_left_out() {
    let found = forged_judgements("ball-long-accumulation", |_, answer| {
        let last = answer.events.last().cloned();
        answer.events.truncate(52);
        answer.events.extend(last);
    });
    for found in found {
        assert!(found.missed > 50, "{found:?}");
    }
}

/// A record that is told over and over is spurious each time but the first.
#[test]
fn copies_of_a_record_are_spurious() {
    let copies = |from: usize, count: usize| {
        move |_: &PreparedCase, answer: &mut Outcome| {
            let one = answer.events[from];
            answer.events.splice(from..from, std::iter::repeat_n(one, count));
        }
    };
    for (case, from) in [("ball-moving-in", 98), ("height-touched", 1)] {
        for found in forged_judgements(case, copies(from, 500)) {
            assert!(found.spurious > 400, "{case}: {found:?}");
        }
    }
    // A model that makes no progress has 64 events in an instant, and ends with them.
    for found in forged_judgements("rigid-rests-on-stop", copies(0, 1000)) {
        assert!(found.spurious > 900, "{found:?}");
    }
}

/// At a graze that is left open the reset still has to be the event's.
#[test]
fn an_open_event_has_no_free_state() {
    let found = forged_judgements("stop-graze-miss-1e-9", |case, answer| {
        let event = place(case, case.task.mode, "impact");
        let graze = |it: &&percuss_validation::score::Graze| it.elapsed > 4.0 && it.elapsed < 4.3;
        let elapsed = case.grazes.iter().find(graze).expect("a graze").elapsed;
        let sample = case.task.samples.partition_point(|it| *it < elapsed);
        let mut state = answer.samples[sample];
        state.iter_mut().for_each(|it| *it -= 0.5);
        let first = Event { event, mode: case.task.mode, elapsed, state, before: None };
        answer.events.insert(0, first);
    });
    for found in found {
        assert!(found.judged() > 0, "{found:?}");
    }
}

/// A run that ends before its horizon has to have a reason.
#[test]
fn an_early_ending_needs_a_reason() {
    for (case, ended, kind) in [
        ("stop-graze-miss-1e-6", Ending::Accumulation, WrongKind::Spurious),
        ("percussive-graze", Ending::Undecided, WrongKind::Missed),
        ("slow-forcing", Ending::Accumulation, WrongKind::Spurious),
        ("slow-forcing", Ending::NoProgress, WrongKind::Spurious),
        ("slow-forcing", Ending::Horizon, WrongKind::Missed),
    ] {
        let found = forged_judgements(case, |_, answer| {
            let last = answer.events.last().expect("an event");
            (answer.ended_at, answer.end) = (last.elapsed, last.state);
            answer.ended = ended;
        });
        for found in found {
            assert_eq!(first_kind(&found), Some(kind), "{case} {ended:?}");
        }
    }
}
