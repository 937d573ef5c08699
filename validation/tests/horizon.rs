//! The valid horizon of the exact solver in chaos, and of the truth itself.
//!
//! `cargo test --release --test harness horizon:: -- --nocapture` prints the figures.

use crate::exact;
use percuss::number::Number;
use percuss_validation::case::{Case, Problem};
use percuss_validation::engine::{OscillatorTask, Task};
use percuss_validation::score::{HorizonTest, far_apart};
use percuss_validation::truth::{DoubleDouble, Replay};

/// Starts, as many as a median needs to be good to a period or two.
const STARTS: usize = 200;
/// The longest predicted valid horizon is 128 periods and the largest gain over a prediction 27, so
/// that every run ends before.
const PERIODS: u32 = 200;

/// A run may fall short of what its growth predicts by ln(20)/0.37 periods, if its error is twenty
/// units of eps x growth; four periods are measured.
const MAX_LOSS_PERIODS: f64 = 8.0;
/// Errors are seldom along the direction that grows most: the median run gains two periods.
const MEDIAN_GAIN_PERIODS: std::ops::RangeInclusive<f64> = 0.0..=4.0;

fn chaos() -> Case {
    exact::case("chaos-from-rest")
}

#[test]
fn the_exact_solver_lasts_as_long_as_the_truths_growth_lets_it() {
    let test = HorizonTest::new(&chaos(), STARTS, PERIODS).expect("it is made");
    let found = test.score(f64::EPSILON, exact::run);
    println!("valid from {} periods: {:?}", found.valid_q01, found.valid);
    println!("predicted: {:?}, gained: {:?}", found.predicted, found.gained);
    let gain = |run: &percuss_validation::score::ValidHorizon| {
        f64::from(run.valid) - f64::from(run.predicted)
    };
    let least = found.runs.iter().map(gain).fold(f64::INFINITY, f64::min);
    println!("least gain: {least}");
    assert_eq!((test.undecided, found.failed, found.runs.len()), (0, 0, STARTS));
    assert!(found.runs.iter().all(|run| !run.outlasts), "{:?}", found.runs);
    assert!(least >= -MAX_LOSS_PERIODS, "{least}");
    assert!(MEDIAN_GAIN_PERIODS.contains(&found.gained.median), "{:?}", found.gained);
    // The truth is the better one by far wherever the solver is judged.
    for (run, trusted) in found.runs.iter().zip(test.trusted_periods()) {
        assert!(trusted > run.valid, "{run:?}: {trusted}");
    }
}

/// The truth's own horizon, from its growth, is where two runs in 106 bits that begin one unit
/// apart are apart: they are less than a hundredth of 1e-3 apart up to there, but for a few units
/// of rounding.
#[test]
fn the_truth_lasts_as_long_as_it_says() {
    const STATE_TOLERANCE: f64 = 20.0 * 1e-5;
    let test = HorizonTest::new(&chaos(), 20, 250).expect("it is made");
    let (problem, trusted) = (exact::problem(&chaos()), test.trusted_periods());
    let mut sorted = trusted.clone();
    sorted.sort_unstable();
    println!("the truth lasts {sorted:?} periods");
    for (start, periods) in far_apart(&problem, 20, 250).iter().zip(&trusted) {
        let apart = apart_after(start, u64::from(*periods));
        assert!(apart <= STATE_TOLERANCE, "{apart:e} after {periods} periods");
    }
    assert!(sorted[0] > 100 && sorted[10] > 150, "{sorted:?}");
}

/// The largest difference in p, y and q after so many periods, of runs whose starts differ by a
/// unit.
fn apart_after(start: &Problem, periods: u64) -> f64 {
    let (parameters, entry) = (start.model.parameters(), start.entry);
    let horizon = entry.instant.after_periods(periods, 1);
    let [p, y, q] = [entry.state.p, entry.state.y, entry.state.q].map(DoubleDouble::exact);
    let end = |y: DoubleDouble| {
        let last = Replay::from_two_words(parameters, &entry, [p, y, q], horizon).last();
        last.expect("there is a phase").expect("it is decided").at(&horizon)
    };
    let (one, other) =
        (end(y), end(y + DoubleDouble::exact(DoubleDouble::UNIT * y.to_f64().abs().max(1.0))));
    (0..3).map(|k| (one[k] - other[k]).to_f64().abs()).fold(0.0, f64::max)
}

#[test]
fn a_coarser_solver_lasts_as_long_as_its_own_unit_lets_it() {
    const UNIT: f64 = 1e-9;
    let test = HorizonTest::new(&chaos(), 40, 60).expect("it is made");
    let coarse = test.score(UNIT, |task| {
        let task = exact::own(task);
        let mut start = task.problem.start;
        start.y += UNIT;
        let entry = task.problem.model.start(&start).expect("a start is off by little");
        let problem = Problem { entry, start, ..task.problem };
        exact::run(&Task::of_oscillator(&OscillatorTask { problem, ..task.clone() })?)
    });
    println!("{:?} {:?} {:?}", coarse.valid, coarse.predicted, coarse.gained);
    assert!(coarse.valid.median < 60.0 && coarse.gained.median.abs() <= 4.0);
    assert!(coarse.runs.iter().all(|run| run.valid + 8 >= run.predicted));
}
