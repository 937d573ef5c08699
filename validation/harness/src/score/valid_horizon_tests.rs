use super::*;
use crate::case::{Given, Horizon};
use crate::engine::Numbers;
use crate::system::Values;
use percuss::Start;

const PERIODS: u32 = 12;

fn case() -> Case {
    let given = Given { start: Start::default(), ..Given::default() };
    let case = given.check().ok().and_then(|it| Case::of_run(it, Horizon::Periods(1)).ok());
    case.unwrap_or_else(|| unreachable!("the defaults are in range"))
}

fn test(count: usize) -> HorizonTest {
    let test = HorizonTest::new(&case(), count, PERIODS);
    test.unwrap_or_else(|error| unreachable!("{error}"))
}

/// A run, with how its errors are counted.
fn run() -> (HorizonRun, ErrorRule) {
    let mut test = test(1);
    let run = test.runs.pop();
    (run.unwrap_or_else(|| unreachable!("106 bits decide it")), test.rule)
}

/// An answer that is right up to a period and off by `error` in one co-ordinate from there on.
fn answer(run: &HorizonRun, wrong_from: usize, k: usize, error: f64) -> Outcome {
    let rows = run.truth.samples.iter();
    let mut samples: Vec<_> = rows.map(|row| Values::from_slice(&row.rounded())).collect();
    samples.iter_mut().skip(wrong_from).for_each(|state| state[k] += error);
    Outcome { samples, ..Outcome::default() }
}

#[test]
fn growth_only_rises_and_begins_at_one() {
    let (run, _) = run();
    assert_eq!(run.growth.len(), PERIODS as usize + 1);
    assert!(run.growth[0] >= 1.0 && run.growth.windows(2).all(|pair| pair[0] <= pair[1]));
}

#[test]
fn a_size_is_reached_after_the_last_period_within_it() {
    let (mut run, _) = run();
    run.growth = vec![1.0, 2.0, 4.0, 8.0, 16.0];
    assert_eq!([0.5, 1.0, 3.9, 4.0, 16.0, 1e9].map(|size| run.grows_to(size)), [0, 0, 1, 2, 4, 4]);
}

#[test]
fn a_run_is_valid_until_the_period_before_the_first_that_is_off() {
    let (run, rule) = run();
    for k in 0..3 {
        assert_eq!(run.valid_periods(&rule, &answer(&run, 5, k, 1.01e-3), PERIODS), 4);
        assert_eq!(run.valid_periods(&rule, &answer(&run, 5, k, 0.99e-3), PERIODS), PERIODS);
    }
    assert_eq!(run.valid_periods(&rule, &answer(&run, 5, 0, f64::NAN), PERIODS), 4);
    // The drift is no part of the state, and nothing after the last period counts.
    assert_eq!(run.valid_periods(&rule, &answer(&run, 5, 3, 1.0), PERIODS), PERIODS);
    assert_eq!(run.valid_periods(&rule, &answer(&run, 9, 0, 1.0), 7), 7);
}

#[test]
fn a_run_that_is_still_right_is_made_again_for_as_long_as_the_truth_lasts() {
    let (mut run, rule) = run();
    run.growth = (0..=PERIODS).map(|k| 0.9 * 1e3_f64.powi(k as i32)).collect();
    // A unit of 1e-9 grows to 1e-3 in two periods, to a thousand times that in three; the truth's
    // own error, of 1e-32 or so, to 1e-5 in eight.
    let (unit, trusted) = (1e-9, run.trusted_periods());
    assert_eq!((run.grows_to(SCORED_ERROR / unit), run.last_period(unit)), (2, 3));
    assert_eq!(trusted, 8);
    let asked = std::sync::Mutex::new(Vec::new());
    let make = |wrong_from: usize| {
        let (run, asked) = (&run, &asked);
        move |task: &Task| {
            if let Ok(mut asked) = asked.lock() {
                asked.push(task.samples.len() - 1);
            }
            Ok(answer(run, wrong_from, 0, 1.0))
        }
    };
    let taken = || asked.lock().map(|mut it| std::mem::take(&mut *it)).unwrap_or_default();
    let (short, failed) = run.horizon(&rule, unit, &make(3));
    assert_eq!((short, failed), (ValidHorizon { valid: 2, predicted: 2, outlasts: false }, false));
    assert_eq!(taken(), [3]);
    let (longer, _) = run.horizon(&rule, unit, &make(6));
    assert_eq!(longer, ValidHorizon { valid: 5, predicted: 2, outlasts: false });
    assert_eq!(taken(), [3, trusted as usize]);
    let (whole, _) = run.horizon(&rule, unit, &make(100));
    assert_eq!(whole, ValidHorizon { valid: trusted, predicted: 2, outlasts: true });
    let none = |_: &Task| Err(Failure::new("on purpose"));
    let (gone, failed) = run.horizon(&rule, unit, &none);
    assert_eq!((gone.valid, gone.outlasts, failed), (0, false, true));
}

#[test]
fn a_score_counts_what_failed_and_what_was_gained() {
    let test = test(3);
    assert_eq!((test.runs.len(), test.undecided, test.trusted_periods().len()), (3, 0, 3));
    // In so few periods no unit of rounding grows to 1e-3, and a unit of 1e-3 is there at once.
    assert!(!test.decides(1e-15) && test.decides(1e-3));
    assert_eq!(test.length(1e-15), 3 * u64::from(PERIODS));
    let second = test.runs[0].truth.events.len() as u64;
    assert_eq!((test.runs[0].events_before, test.runs[1].events_before), (0, second));
    let found = test.score(1e-15, |task| {
        let run = test.runs.iter().find(|it| {
            Some(it.events_before) == task.oscillator.as_ref().map(|own| own.events_before)
        });
        match run {
            Some(run) if run.events_before > 0 => Ok(answer(run, 7, 1, 1.0)),
            _ => Err(Failure::new("on purpose")),
        }
    });
    assert_eq!((found.failed, found.runs.len()), (1, 3));
    assert_eq!((found.valid.median, found.valid.max, found.valid_q01), (6.0, 6.0, 0.0));
    assert_eq!(found.predicted.max, f64::from(PERIODS));
    assert_eq!(found.gained.max, 6.0 - f64::from(PERIODS));
    assert_eq!(test.score_first(1, 1e-15, |_| Err(Failure::new("on purpose"))).runs.len(), 1);
}
