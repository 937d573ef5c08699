//! The restart test of the exact solver on every case, one by one and in lanes.
//!
//! `cargo test --release --test harness restart:: -- --nocapture` prints the figures of every case;
//! with `--ignored` from ten thousand states each.

use crate::exact;
use percuss::lanes::Instructions;
use percuss::{Parameters, Phase};
use percuss_validation::case::{Case, Given, Problem, embedded};
use percuss_validation::engine::{Accuracy, Failure, Outcome, Task, place};
use percuss_validation::score::{Restart, RestartTest};

/// Largest median of the runs with an impact, in eps (1 + |value|) x growth: twice the largest
/// median measured (1.0, fast forcing; 0.35 in chaos). The last addition alone makes a quarter.
const MAX_MEDIAN: f64 = 2.0;
/// The promise of ten roundings; 4.9 is the largest of 430,000 runs (fast forcing), 2.7 in chaos.
const MAX_UNITS: f64 = 10.0;

/// The mass never strikes the slider again on these attractors.
const CASES_WITHOUT_IMPACT: [&str; 3] = ["never-returns", "never-stops", "rests-for-ever"];

/// How a motion is solved.
type Run = dyn Fn(&Task) -> Result<Outcome, Failure> + Sync;

/// The accuracy of the exact solver, and its unit of error.
const EXACT_ACCURACY: (Accuracy, f64) = (Accuracy::Exact, f64::EPSILON);

fn on_attractor(case: &Case, count: usize) -> RestartTest {
    RestartTest::on_attractor(case, count).expect("it is of the oscillator")
}

fn restarts(case: &Case, count: usize) -> (RestartTest, Restart) {
    let test = on_attractor(case, count);
    let restart = test.score(EXACT_ACCURACY, exact::run);
    (test, restart)
}

fn every_case(count: usize) {
    let lanes = |task: &Task| Ok(exact::run_in_lanes(Instructions::widest(), task));
    for case in exact::of_oscillator() {
        let test = on_attractor(&case, count);
        holds_its_digits(&case, &test, "alone", &exact::run);
        holds_its_digits(&case, &test, "in lanes", &lanes);
    }
}

fn holds_its_digits(case: &Case, test: &RestartTest, how: &str, run: &Run) {
    let restart = test.score(EXACT_ACCURACY, run);
    let count = test.runs.len() + test.undecided;
    let Restart { with_impact, units, absolute, .. } = &restart;
    println!(
        "{:24} {how:8} {with_impact:6} median {:.3} q99 {:.2} max {:.2} \
             drift {:.3} {:.2} {:.2} time {:.3} {:.2} {:.2} absolute {:.1e} {:.1e} {:.1e}",
        case.name,
        units.median,
        units.q99,
        units.max,
        restart.drift_units.median,
        restart.drift_units.q99,
        restart.drift_units.max,
        restart.time_units.median,
        restart.time_units.q99,
        restart.time_units.max,
        absolute.median,
        absolute.q99,
        absolute.max
    );
    let unhappy = (restart.undecided, restart.failed, restart.wrong_sequences);
    assert_eq!((restart.runs, unhappy), (count, (0, 0, 0)), "{}", case.name);
    if CASES_WITHOUT_IMPACT.contains(&case.name.as_str()) {
        assert_eq!(*with_impact, 0, "{}", case.name);
        return;
    }
    assert!(*with_impact > 0, "{}", case.name);
    assert!(units.median <= MAX_MEDIAN, "{}: median {}", case.name, units.median);
    for max in [units.max, restart.drift_units.max, restart.time_units.max] {
        assert!(max <= MAX_UNITS, "{}: max {max}", case.name);
    }
}

/// omega, xi: what the cases have not, of every form that contacts take in lanes.
const FORMS: [(f64, f64); 8] = [
    (1.2, 0.01),
    (1.2, 0.1),
    (0.9, 0.01),
    (1.4, 0.8),
    (1.4, 1.0),
    (1.4, 1.2),
    (1.4, 1.5),
    (1.4, 5.0),
];

#[test]
fn lanes_keep_their_digits_in_every_form_of_contact() {
    let lanes = |task: &Task| Ok(exact::run_in_lanes(Instructions::widest(), task));
    for (omega, xi) in FORMS {
        let mut case = exact::case("chaos-from-rest");
        case.name = format!("omega {omega} xi {xi}");
        let own = exact::problem(&case);
        let parameters = Parameters { omega, xi, ..*own.model.parameters() };
        let given = Given { parameters, start: own.start, ..Given::default() };
        case = exact::with_problem(&case, given.check().expect("it is in range"));
        let test = on_attractor(&case, 1000);
        holds_its_digits(&case, &test, "alone", &exact::run);
        holds_its_digits(&case, &test, "in lanes", &lanes);
    }
}

#[test]
fn the_exact_solver_keeps_its_digits_on_every_attractor() {
    every_case(300);
}

#[test]
#[ignore = "half a minute in a release build"]
fn the_exact_solver_keeps_its_digits_from_ten_thousand_states() {
    every_case(10_000);
}

#[test]
fn figures_do_not_depend_on_chance() {
    let figures = || restarts(&exact::case("chaos-from-rest"), 200).1;
    assert_eq!(format!("{:?}", figures()), format!("{:?}", figures()));
}

#[test]
fn starts_lie_in_every_phase_and_runs_end_at_a_strobe() {
    let (test, restart) = restarts(&exact::case("chaos-from-rest"), 1000);
    let starts_in = |phase| test.runs.iter().filter(|run| run.task.mode == place(phase)).count();
    // A progression is under way for less than a hundredth of the time.
    for phase in Phase::ALL {
        assert!(starts_in(phase) > 0, "{phase}: {}", starts_in(phase));
    }
    for run in &test.runs {
        let own = exact::own(&run.task);
        let Problem { entry, .. } = own.problem;
        assert_eq!(entry.instant.cycle(), 0);
        let horizon = own.horizon;
        assert!(horizon.angle() == 0.0 && (1..=8).contains(&horizon.cycle()), "{horizon:?}");
    }
    let counted: usize = restart.by_events.values().map(|(runs, _)| runs).sum();
    assert_eq!(counted, restart.with_impact);
    assert_eq!(restart.histogram.counts.iter().sum::<usize>(), restart.with_impact);
}

/// A fault of the last place in the angle of every run is seen: the test has the power it needs.
#[test]
fn an_error_of_a_few_eps_is_seen() {
    let (test, honest) = restarts(&exact::case("chaos-from-rest"), 200);
    let faulty = test.score(EXACT_ACCURACY, |task| {
        let mut outcome = exact::run(task)?;
        for value in outcome.end.iter_mut() {
            *value += 1e-13;
        }
        Ok(outcome)
    });
    assert!(faulty.units.median > 10.0 * honest.units.median && faulty.units.max > MAX_UNITS);
}

/// Runs that give no result count as failed; where there is no other, no error was measured.
#[test]
fn failures_are_counted() {
    let (test, _) = restarts(&exact::case("chaos-from-rest"), 20);
    let failing = test.score((Accuracy::Tolerance(1e-9), 1e-9), |_| Err(Failure::new("tired")));
    assert_eq!((failing.failed, failing.with_impact), (20, 20));
    assert!(failing.units.max.is_nan() && failing.absolute.median.is_nan());
}

/// A restart that is right but for its drift is off: the drift is scored with p, y and q.
#[test]
fn an_error_of_the_drift_alone_is_seen() {
    const STATE_ERROR: f64 = 1e-11;
    let cases = embedded().expect("the cases are read");
    let case = cases.iter().find(|case| case.name == "table1-from-rest").expect("the case");
    let test = on_attractor(case, 20);
    let drifted = |task: &Task| {
        let mut outcome = exact::run(task)?;
        outcome.end[3] += STATE_ERROR;
        Ok(outcome)
    };
    let restart = test.score(EXACT_ACCURACY, drifted);
    assert!(restart.with_impact > 0);
    assert!(restart.units.median > MAX_UNITS, "{}", restart.units.median);
    assert_eq!((restart.failed, restart.wrong_sequences), (0, 0));
}
