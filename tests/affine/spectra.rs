//! Random systems of prescribed spectra: defective, stiff, nearly defective, oscillating, growing.

use super::random::{Met, check};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn runs_agree_with_106_bits_and_crests_decide(seed in any::<u64>()) {
        let checked = check(seed, &mut Met::default());
        prop_assert!(checked.is_ok(), "{seed}: {}", checked.unwrap_err());
    }
}

/// The check compares what it is there for: most runs have events, and guards have crests.
#[test]
fn random_systems_have_events_and_crests() {
    let mut met = Met::default();
    for seed in 0..200 {
        let checked = check(seed, &mut met);
        assert!(checked.is_ok(), "{seed}: {}", checked.unwrap_err());
    }
    assert!(met.events > 400 && met.crests > 20, "{met:?}");
}

/// A guard crosses 40 decay times of its smallest part after the point that its crossing is
/// guessed from: the guess by a Taylor polynomial is before the event that the segment begins with.
#[test]
fn a_crossing_beyond_the_reach_of_a_polynomial() {
    let checked = check(4_083_550_187_308_645_049, &mut Met::default());
    assert!(checked.is_ok(), "{}", checked.unwrap_err());
}

/// A polynomial of degree four is 60 times smaller at an event than the terms that it is summed
/// from: rounding does what it does to them.
#[test]
fn errors_of_terms_that_cancel_are_enclosed() {
    let checked = check(12_308_008_711_722_896_483, &mut Met::default());
    assert!(checked.is_ok(), "{}", checked.unwrap_err());
}

/// Impacts accumulate beside rates of 1e6: a run that does not follow its errors ends as undecided
/// one event before a run that does.
#[test]
fn a_run_without_errors_may_be_undecided_sooner() {
    let checked = check(10_660_592_783_380_215_044, &mut Met::default());
    assert!(checked.is_ok(), "{}", checked.unwrap_err());
}

/// A state of 1e-200, which is what a zero of the modal matrices leaves, is off by 1e-8 of itself.
#[test]
fn what_is_left_of_a_zero_is_none_of_the_errors() {
    let checked = check(16_466_952_084_925_065_061, &mut Met::default());
    assert!(checked.is_ok(), "{}", checked.unwrap_err());
}

/// Rates of 0 and 0.001 are kept together in co-ordinates of which one is a thousand times what it
/// adds to the state: the last step to an event is short beside how that moves the state.
#[test]
fn the_last_step_is_short_for_the_state() {
    for seed in [3_376, 7_345_526_404_384_040_871] {
        let checked = check(seed, &mut Met::default());
        assert!(checked.is_ok(), "{}", checked.unwrap_err());
    }
}

/// The rounding error in f64 of a guard whose factors are 1e6 is larger than the height of its
/// crest above zero: the run reports that it leaves the crossing open.
#[test]
fn a_crest_within_rounding_is_counted() {
    let mut met = Met::default();
    let checked = check(18_212, &mut met);
    assert!(checked.is_ok() && met.undecided > 0 && met.crests == 0, "{met:?} {checked:?}");
}
