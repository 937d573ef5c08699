use super::*;
use crate::case::{Given, Horizon};
use crate::engine::{Accuracy, Event, Failure, Numbers, Outcome};
use crate::score::rule::deviation;
use crate::system::Values;
use percuss::Ending;
use percuss::Phase::{self, Contact, NoContact, Progression};
use percuss::{Start, TwoWord};

const UNIT: f64 = 1e-9;
const ASKED_ACCURACY: (Accuracy, f64) = (Accuracy::Tolerance(UNIT), UNIT);

/// Restarts on the attractor of the default model.
fn test(count: usize) -> RestartTest {
    let given = Given { start: Start::default(), ..Given::default() };
    let case = given.check().ok().and_then(|it| Case::of_run(it, Horizon::Periods(1)).ok());
    let test = case.and_then(|case| RestartTest::on_attractor(&case, count).ok());
    test.unwrap_or_else(|| unreachable!("the defaults are in range"))
}

/// The first of them that has an impact, with the test that it belongs to.
fn with_impact() -> (RestartTest, usize) {
    let test = test(12);
    let found = test.runs.iter().position(|it| it.impact && it.truth.events.len() >= 2);
    (test, found.unwrap_or_else(|| unreachable!("some have an impact")))
}

fn perfect(run: &RestartRun) -> Outcome {
    let event = |row: &TruthRow| Event {
        event: 0,
        mode: row.mode,
        elapsed: row.elapsed.value(),
        state: Values::from_slice(&row.rounded()),
        before: None,
    };
    Outcome {
        events: run.truth.events.iter().map(event).collect(),
        end: Values::from_slice(&run.truth.end.rounded()),
        ..Outcome::default()
    }
}

fn truth(start: Phase, phases: &[Phase]) -> Truth {
    let row = |(k, phase): (usize, &Phase)| TruthRow {
        event: 0,
        mode: place(*phase),
        elapsed: TwoWord::new(k as f64),
        state: vec![TwoWord::ZERO; 4],
        growth_time: 1.0,
        growth: vec![1.0; 4],
        size: 0.0,
    };
    Truth {
        start: row((0, &start)),
        events: phases.iter().enumerate().map(|(k, it)| row((k + 1, it))).collect(),
        end: row((9, &start)),
        ended: Ending::Horizon,
        span: 9.0,
        samples: Vec::new(),
        ordered: true,
    }
}

fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-6 * expected.abs(), "{found:e} {expected:e}");
}

#[test]
fn a_passage_is_an_impact_and_the_separation_after_it() {
    let separation = |start, phases: &[Phase]| {
        let (impact, row) = passage(&truth(start, phases));
        (impact, row.map(|row| row.elapsed.value()))
    };
    assert_eq!(separation(NoContact, &[Contact, NoContact, Contact]), (true, Some(2.0)));
    assert_eq!(separation(NoContact, &[Progression, Contact, NoContact]), (true, Some(3.0)));
    // The separation before the impact ends no passage.
    assert_eq!(separation(Contact, &[NoContact, Contact, NoContact]), (true, Some(3.0)));
    assert_eq!(separation(Contact, &[Progression, Contact, NoContact]), (false, None));
    assert_eq!(separation(NoContact, &[Contact, Progression]), (true, None));
}

#[test]
fn an_error_counts_over_its_size_and_growth() {
    let (test, n) = with_impact();
    let run = &test.runs[n];
    for k in 0..4 {
        let mut outcome = perfect(run);
        outcome.end[k] += 1e-5;
        let off = deviation(run.truth.end.state[k], outcome.end[k]);
        let found = test.error(run, &outcome, UNIT);
        let size = 1.0 + run.truth.end.rounded()[k].abs();
        assert_near(found.units, off / (UNIT * size * run.truth.end.growth[k]));
        assert_near(found.absolute, off);
        assert_near(found.drift_units, if k == 3 { found.units } else { 0.0 });
        assert!(found.same_modes && found.time_units < 1e-3);
    }
}

#[test]
fn a_time_counts_where_the_phases_are_right() {
    let (test, n) = with_impact();
    let run = &test.runs[n];
    let mut outcome = perfect(run);
    outcome.events[1].elapsed += 1e-5;
    let found = test.error(run, &outcome, UNIT);
    let row = &run.truth.events[1];
    let off = deviation(row.elapsed, outcome.events[1].elapsed);
    assert_near(found.time_units, off / (UNIT * (1.0 + row.elapsed.value()) * row.growth_time));
    outcome.events.truncate(1);
    let found = test.error(run, &outcome, UNIT);
    assert!(!found.same_modes && found.time_units.is_nan());
}

#[test]
fn an_end_that_is_no_number_is_the_largest_error() {
    let (test, n) = with_impact();
    let run = &test.runs[n];
    let mut outcome = perfect(run);
    outcome.end[0] = f64::NAN;
    outcome.end[1] += 1.0;
    let found = test.error(run, &outcome, UNIT);
    assert!(found.units.is_nan() && found.absolute.is_nan());
}

#[test]
fn runs_that_fail_or_go_another_way_are_counted() {
    let test = test(12);
    let with_impact = test.runs.iter().filter(|run| run.impact).count();
    assert!(with_impact >= 4 && test.runs.len() == 12 && test.undecided == 0);
    let at = |task: &Task| test.runs.iter().position(|run| run.task.state == task.state);
    let impacts: Vec<usize> = (0..12).filter(|k| test.runs[*k].impact).collect();
    let answer = |task: &Task| {
        let number = at(task).unwrap_or(0);
        let mut outcome = perfect(&test.runs[number]);
        if number == impacts[0] {
            return Err(Failure::new("on purpose"));
        }
        if number == impacts[1] {
            outcome.events.pop();
        }
        Ok(outcome)
    };
    let found = test.score(ASKED_ACCURACY, answer);
    assert_eq!((found.runs, found.with_impact), (12, with_impact));
    assert_eq!((found.failed, found.wrong_sequences, found.undecided), (1, 1, 0));
    // What gave no result is counted as failed and spoils no error of the others.
    assert!(found.units.max < 1e-3 && found.units.median < 1e-3);
    let counted: usize = found.by_events.values().map(|(count, _)| count).sum();
    assert_eq!(counted, with_impact - 1);
    assert_eq!(test.score_first(3, ASKED_ACCURACY, answer).runs, 3);
    // A run counts its events after those of the runs before it.
    let before: u64 = test.runs[..5].iter().map(|run| run.truth.events.len() as u64).sum();
    let own = test.runs[5].task.oscillator.as_ref();
    assert_eq!(own.map(|it| it.events_before), Some(before));
}
