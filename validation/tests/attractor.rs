//! The same-attractor test catches a model that is slightly different, and lets the right one pass.

use percuss_validation::case::{OscillatorCase, embedded};
use percuss_validation::score::attractor::{
    Alarms, AttractorTest, Calibrated, Changed, STATISTICS, calibrated,
};

/// Runs of each kind: their starts are fixed, so that the outcome is.
const RUNS: u32 = 4;

fn ready(calibrated: Calibrated) -> (OscillatorCase, AttractorTest) {
    let mut cases = embedded().expect("the cases are read").into_iter();
    let case = cases.find(|case| case.name == calibrated.case).expect("the case is there");
    let case = case.oscillator.expect("it is of the oscillator");
    let test = AttractorTest::new(&case, calibrated).expect("the exact solver runs");
    (case, test)
}

fn tests() -> impl Iterator<Item = (OscillatorCase, AttractorTest)> {
    calibrated().expect("the limits are read").into_iter().map(ready)
}

#[test]
fn every_distance_has_a_limit() {
    for own in calibrated().expect("the limits are read") {
        let mut names = STATISTICS.to_vec();
        names.sort_unstable();
        assert!(own.limits.keys().eq(names.iter()), "{}: {:?}", own.case, own.limits);
        assert!(own.limits.values().all(|limit| limit.is_finite() && *limit > 0.0));
    }
}

#[test]
fn fresh_runs_of_the_exact_solver_pass() {
    for (case, test) in tests() {
        let found = test.false_alarms(&case, RUNS).expect("the exact solver runs");
        assert_eq!(found, Alarms { runs: RUNS, ..Alarms::default() }, "{}", test.calibrated.case);
    }
}

/// The errors of single periods notice one per cent in every parameter, in every run: on this case
/// the detection threshold lies between 1e-4 and 1e-2 for each of them.
#[test]
fn one_per_cent_is_caught() {
    for (case, test) in tests().filter(|(_, test)| test.calibrated.case == "fig7a-chaos") {
        for changed in Changed::ALL {
            for relative in [0.01, -0.01] {
                let found = test.alarms_of_changed(&case, changed, relative, RUNS);
                let found = found.expect("the exact solver runs");
                let what = format!("{}: {} by {relative}", test.calibrated.case, changed.name());
                assert_eq!(found.raised, RUNS, "{what}: {found:?}");
            }
        }
    }
}
