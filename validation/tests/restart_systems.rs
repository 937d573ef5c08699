//! The restart test on other systems than the oscillator.
//!
//! `cargo test --release --test harness restart_systems:: -- --nocapture` prints the figures of
//! every case.

use crate::exact::{self, probed_systems};
use percuss_validation::engine::{
    Accuracy, Engine, Failure, Limits, Outcome, REFERENCE, Task, answer,
};
use percuss_validation::integrators::all;
use percuss_validation::score::{Restart, RestartRun, RestartTest};
use percuss_validation::suite::{PreparedCase, Suite};

/// The bound of the oscillator's restarts, in eps (1 + |value|) x growth; 1.4 is the largest median
/// of any case.
const MAX_MEDIAN: f64 = 2.0;
/// The promise of ten roundings; 8.0 is the largest of all.
const MAX_UNITS: f64 = 10.0;

fn one(name: &str) -> PreparedCase {
    probed_systems(|it| it == name).pop().expect("the case")
}

fn test(case: &PreparedCase) -> &RestartTest {
    case.probes.restart.as_ref().expect("the case is probed")
}

fn scored(
    case: &PreparedCase,
    (accuracy, unit): (Accuracy, f64),
    run: impl Fn(&Task) -> Result<Outcome, Failure> + Sync,
) -> Restart {
    test(case).score_first(usize::MAX, (accuracy, unit), run)
}

fn exactly(task: &Task) -> Result<Outcome, Failure> {
    answer(named(REFERENCE), task, Accuracy::Exact, &Limits::default())
}

/// The accuracy of the exact solver, and its unit of error.
const EXACT_ACCURACY: (Accuracy, f64) = (Accuracy::Exact, f64::EPSILON);

#[test]
fn the_exact_solver_keeps_its_digits_on_every_case() {
    let mut with_events = 0;
    for case in probed_systems(|_| true) {
        let name = &case.case.name;
        let restart = scored(&case, EXACT_ACCURACY, exactly);
        let Restart { units, time_units, runs, undecided, .. } = &restart;
        println!(
            "{name:28} {runs:3} {undecided} median {:.3} max {:.2} time {:.3} {:.2}",
            units.median, units.max, time_units.median, time_units.max
        );
        assert_eq!((restart.failed, restart.wrong_sequences), (0, 0), "{name}");
        if restart.with_impact == 0 {
            continue;
        }
        with_events += 1;
        assert!(units.median <= MAX_MEDIAN, "{name}: median {}", units.median);
        assert!(units.max <= MAX_UNITS, "{name}: {}", units.max);
        assert!(time_units.max <= MAX_UNITS, "{name}: time {}", time_units.max);
    }
    assert!(with_events > 60, "{with_events}");
}

/// An engine that begins a run with a state that is off shows it in each restart.
#[test]
fn a_start_that_is_off_is_seen() {
    let case = one("relay-1e-4");
    let off = |task: &Task| {
        let mut task = task.clone();
        task.exact = None;
        task.state[0] += 1e-7;
        let engine = named("ode_solvers-dopri5");
        answer(engine, &task, Accuracy::Tolerance(1e-9), &Limits::default())
    };
    let at = (Accuracy::Tolerance(1e-9), 1e-9);
    let right = |task: &Task| answer(named("ode_solvers-dopri5"), task, at.0, &Limits::default());
    let (honest, faulty) = (scored(&case, at, right), scored(&case, at, off));
    assert!(honest.units.max < 2.0, "{}", honest.units.max);
    assert!(faulty.units.median > 5.0, "{}", faulty.units.median);
}

/// Runs that give no result count as failed, and wrong modes as a wrong sequence.
#[test]
fn failures_and_missed_events_are_counted() {
    let case = one("buck-periodic");
    let failing = scored(&case, EXACT_ACCURACY, |_| Err(Failure::new("tired")));
    assert_eq!((failing.failed, failing.with_impact), (20, 20));
    assert!(failing.units.max.is_nan());
    let missing = scored(&case, EXACT_ACCURACY, |task| {
        let mut outcome = exactly(task)?;
        outcome.events.pop();
        Ok(outcome)
    });
    assert_eq!((missing.failed, missing.wrong_sequences), (0, 20));
}

/// Restarts pass at least two instants with events, and their truth has all of these.
#[test]
fn a_restart_passes_two_instants_with_events() {
    for case in probed_systems(|name| name.starts_with("ball-") || name.starts_with("cradle")) {
        for run in &test(&case).runs {
            assert!(run.truth.events.len() >= 2, "{}", case.case.name);
            let last = run.truth.events.last().expect("an event").elapsed.value();
            assert!(last < run.task.span, "{}", case.case.name);
        }
    }
}

fn named(name: &str) -> &'static dyn Engine {
    let mut engines = all().iter().copied();
    let found = engines.find(|it| it.declaration().name == name);
    found.expect("the engine")
}

/// A contact whose rounded start is 7e-18 off its surface is left into a flight that begins as far
/// from its impact: no engine can tell at once whether it impacts, so that none is asked.
#[test]
fn starts_that_rounding_puts_beside_a_guard_are_not_asked_for() {
    let prepared = exact::prepared(|name| name == "percussive-chaos", Some(Suite::Full));
    let test = test(&prepared[0]);
    let failing = |run: &&RestartRun| exactly(&run.task).is_err();
    assert_eq!(test.runs.iter().filter(failing).count(), 1);
    let restart = test.score_first(usize::MAX, EXACT_ACCURACY, exactly);
    assert_eq!((restart.failed, restart.wrong_sequences), (0, 0));
    assert!(restart.runs > 60, "{}", restart.runs);
}
