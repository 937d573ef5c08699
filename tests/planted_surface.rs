//! As `planted.rs`, for the phases on the contact surface: contact and progression.

use crate::support::draw::{
    Setting, Tally, count, first_segment, log, margin, runner, setting, state,
};
use crate::support::original::Equations;
use crate::support::plant::{Finding, Side, contact, examine, is_steep, slip};
use percuss::{Exit, Parameters, Phase};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use std::f64::consts::TAU;

/// b and y0 of a progression whose -w has this value and slope after d.
fn aim_slip(parameters: &Parameters, q: f64, d: f64, value: f64, slope: f64) -> (f64, f64) {
    let still = Parameters { b: 1.0, ..*parameters };
    let b = 1.0 + slip(&still, [0.0, q], d).slope - slope;
    let aimed = Parameters { b, ..*parameters };
    (b, slip(&aimed, [0.0, q], d).excess - value)
}

#[test]
fn stops_of_the_bottom_are_recovered() {
    let tally = Tally::default();
    let strategy = (setting(), log(1e-6, 1.0), log(1e-3, 1e2), any::<bool>());
    let test =
        |((xi, omega, periods, phi, _, q), slope, kick, linked): (Setting, f64, f64, bool)| {
            let d = periods * TAU / omega;
            let a = if linked { kick * slope } else { kick };
            let mut parameters = Parameters { a, b: 1.0, xi, omega, g: 0.02, phi };
            let (b, y) = aim_slip(&parameters, q, d, 0.0, slope);
            parameters.b = b;
            let guard = |t: f64| slip(&parameters, [y, q], t);
            let lag = (1.0 - q) / (4.0 * xi * xi) * (-d / (2.0 * xi)).exp();
            prop_assume!(is_steep(&guard(d), a * omega + lag / (2.0 * xi)));
            let Some((segment, ..)) = first_segment(parameters, state(q + 0.02, y, q)) else {
                return Err(TestCaseError::reject("start not accepted"));
            };
            prop_assume!(segment.phase() == Phase::Progression);
            tally.take(
                examine(&segment, guard, d, 200)?,
                (parameters, [y, q], d, segment.duration()),
            )
        };
    runner(20_000, 21).run(&strategy, test).unwrap();
    println!("recovered {} earlier {}", tally.recovered.get(), tally.earlier.get());
    assert!(tally.recovered.get() > 5000);
}

#[test]
fn progressions_that_nearly_stop_are_decided() {
    let tally = Tally::default();
    let strategy = (setting(), margin(), log(1e-2, 1e2), 0.05..0.95_f64);
    let test = |((xi, omega, periods, tilt, _, q), margin, a, up): (Setting, f64, f64, f64)| {
        let d = periods * TAU / omega;
        // The force rises at the plant: w has its trough there.
        let phi =
            (1.5 * std::f64::consts::PI + 0.3 * (tilt - 3.0) + up - omega * d).rem_euclid(TAU);
        let mut parameters = Parameters { a, b: 1.0, xi, omega, g: 0.02, phi };
        let (b, y) = aim_slip(&parameters, q, d, 0.0, 0.0);
        parameters.b = b;
        let size = slip(&parameters, [y, q], d).size;
        let y = y - margin * size;
        let guard = |t: f64| slip(&parameters, [y, q], t);
        let around = 1e-4 / omega.max(0.5 / xi);
        prop_assume!(around < d && guard(d - around).slope > 0.0 && guard(d + around).slope < 0.0);
        let Some((segment, ..)) = first_segment(parameters, state(q + 0.02, y, q)) else {
            return Err(TestCaseError::reject("start not accepted"));
        };
        prop_assume!(segment.phase() == Phase::Progression);
        let finding = examine(&segment, guard, d, 200)?;
        if margin > 0.0 {
            prop_assert!(
                segment.duration() <= d,
                "passed: {:?}",
                (parameters, [y, q], d, segment.duration())
            );
        }
        count(if finding == Finding::Earlier { &tally.earlier } else { &tally.recovered }, 1);
        Ok(())
    };
    runner(10_000, 22).run(&strategy, test).unwrap();
    println!("missed {} hit {}", tally.recovered.get(), tally.earlier.get());
    assert!(tally.recovered.get() > 500 && tally.earlier.get() > 500);
}

/// y0 and b of a contact from f0 whose excess over a threshold has this value and slope after d.
fn aim_contact(
    parameters: &Parameters,
    f0: f64,
    d: f64,
    side: Side,
    target: [f64; 2],
) -> Option<[f64; 2]> {
    let two_xi = 2.0 * parameters.xi;
    let at = |y: f64, b: f64| {
        let guard = contact(&Parameters { b, ..*parameters }, [y, f0 - two_xi * y], d, Some(side));
        [guard.excess, guard.slope]
    };
    let (base, by_y, by_b) = (at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0));
    let column = |moved: [f64; 2]| [moved[0] - base[0], moved[1] - base[1]];
    let (m, n) = (column(by_y), column(by_b));
    let rest = [target[0] - base[0], target[1] - base[1]];
    let determinant = m[0] * n[1] - m[1] * n[0];
    let (y, b) = (
        (rest[0] * n[1] - rest[1] * n[0]) / determinant,
        (m[0] * rest[1] - m[1] * rest[0]) / determinant,
    );
    (y.abs() < 1e5 && b.abs() < 1e5).then_some([y, b])
}

/// Contacts that the test's integrator covers in a few thousand steps.
fn is_short(xi: f64, omega: f64, d: f64) -> bool {
    let parameters = Parameters { xi, omega, ..Parameters::default() };
    Equations { phase: Phase::Contact, parameters }.steps(d) < 1000.0
}

fn side() -> impl Strategy<Value = Side> {
    prop_oneof![Just(Side::Rises), Just(Side::Falls)]
}

/// Forces at the start of a contact: anywhere, at a threshold, or next to one.
fn force() -> impl Strategy<Value = f64> {
    let near = (log(1e-12, 0.1), any::<bool>()).prop_map(|(e, top)| if top { 1.0 - e } else { e });
    prop_oneof![2 => 0.0..1.0_f64, 1 => near, 1 => Just(0.0), 1 => Just(1.0)]
}

#[test]
fn ends_of_contact_are_recovered() {
    let tally = Tally::default();
    let strategy = (setting(), side(), log(1e-6, 1.0), force(), log(1e-3, 1e2));
    let test =
        |((xi, omega, periods, phi, ..), side, slope, f0, a): (Setting, Side, f64, f64, f64)| {
            let d = periods * TAU / omega;
            prop_assume!(is_short(xi, omega, d));
            let mut parameters = Parameters { a, b: 0.0, xi, omega, g: 0.02, phi };
            let Some([y, b]) = aim_contact(&parameters, f0, d, side, [0.0, slope]) else {
                return Err(TestCaseError::reject("far"));
            };
            parameters.b = b;
            let q = f0 - 2.0 * xi * y;
            let planted = contact(&parameters, [y, q], d, Some(side));
            let rate = omega.max(1.0).max(2.0 * xi);
            prop_assume!(is_steep(
                &planted,
                rate * rate * (a + b.abs() + y.abs() * (1.0 + 2.0 * xi) + 1.0)
            ));
            prop_assume!(planted.excess.abs() <= planted.noise());
            let Some((segment, ..)) = first_segment(parameters, state(q + 0.02, y, q)) else {
                return Err(TestCaseError::reject("start not accepted"));
            };
            prop_assume!(segment.phase() == Phase::Contact);
            // At the planted instant the planted threshold counts, elsewhere the nearer one.
            let guard = |t: f64| contact(&parameters, [y, q], t, (t == d).then_some(side));
            let finding = examine(&segment, guard, d, 24)?;
            if finding == Finding::Recovered {
                let Exit::Switch(next) = segment.exit() else { unreachable!() };
                let expected =
                    if side == Side::Rises { Phase::Progression } else { Phase::NoContact };
                prop_assert_eq!(next.phase(), expected);
            }
            tally.take(finding, (parameters, [y, q], d, segment.duration()))
        };
    runner(3000, 23).run(&strategy, test).unwrap();
    println!("recovered {} earlier {}", tally.recovered.get(), tally.earlier.get());
    assert!(tally.recovered.get() > 1000);
}

/// The force nearly touches one threshold; with large forces the other one is next (a near tie).
#[test]
fn contacts_that_nearly_graze_are_decided() {
    let tally = Tally::default();
    let strategy = (setting(), side(), margin(), force(), log(1e-2, 1e4));
    let test =
        |((xi, omega, periods, phi, ..), side, margin, f0, a): (Setting, Side, f64, f64, f64)| {
            let d = periods * TAU / omega;
            prop_assume!(is_short(xi, omega, d));
            let mut parameters = Parameters { a, b: 0.0, xi, omega, g: 0.02, phi };
            let aim = |value: f64| aim_contact(&parameters, f0, d, side, [value, 0.0]);
            let Some([y, b]) = aim(0.0) else { return Err(TestCaseError::reject("far")) };
            let size =
                contact(&Parameters { b, ..parameters }, [y, f0 - 2.0 * xi * y], d, Some(side))
                    .size;
            let value = 4.0 * margin * size;
            let Some([y, b]) = aim(value) else { return Err(TestCaseError::reject("far")) };
            parameters.b = b;
            let q = f0 - 2.0 * xi * y;
            let planted = contact(&parameters, [y, q], d, Some(side));
            prop_assume!((planted.excess - value).abs() <= planted.noise());
            let around = 1e-3 / omega.max(1.0).max(2.0 * xi);
            let slope = |t: f64| contact(&parameters, [y, q], t, Some(side)).slope;
            prop_assume!(around < d && slope(d - around) > 0.0 && slope(d + around) < 0.0);
            let Some((segment, ..)) = first_segment(parameters, state(q + 0.02, y, q)) else {
                return Err(TestCaseError::reject("start not accepted"));
            };
            prop_assume!(segment.phase() == Phase::Contact);
            let guard = |t: f64| contact(&parameters, [y, q], t, None);
            let finding = examine(&segment, guard, d, 24)?;
            if value > 0.0 {
                prop_assert!(
                    segment.duration() <= d,
                    "passed: {:?}",
                    (parameters, [y, q], d, segment.duration())
                );
            }
            count(if finding == Finding::Earlier { &tally.earlier } else { &tally.recovered }, 1);
            Ok(())
        };
    runner(3000, 24).run(&strategy, test).unwrap();
    println!("missed {} hit {}", tally.recovered.get(), tally.earlier.get());
    assert!(tally.recovered.get() > 200 && tally.earlier.get() > 200);
}
