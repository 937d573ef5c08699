//! Switches that are planted: chosen first, start and parameters derived from them, then recovered.
//!
//! The guards are linear in the entry data and in a and b, so that value and slope at a chosen
//! instant fix two of them. A claimed end is held against the guard written down a second time
//! (`support/plant.rs`): the excess there is zero to its rounding, so that the duration is right to
//! (rounding of the guard's terms)/slope. A crossing before the planted one is legitimate if it is
//! one by that measure; one after it never is.

use crate::support::draw::{
    Setting, Tally, count, first_segment, log, margin, runner, setting, state,
};
use crate::support::plant::{Finding, examine, flight, flight_from_surface, harmonic, is_steep};
use percuss::{Exit, Parameters, Phase, Start};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use std::f64::consts::TAU;

/// The start of a flight whose guard has this value and slope after d.
fn aim(parameters: &Parameters, q: f64, d: f64, value: f64, slope: f64) -> [f64; 3] {
    let still = flight(parameters, [0.0, 0.0, q], d);
    let y = slope - still.slope;
    let p = value - (flight(parameters, [0.0, y, q], d).excess);
    [p, y, q]
}

#[test]
fn impacts_are_recovered() {
    let tally = Tally::default();
    let strategy = (setting(), log(1e-6, 1.0), log(1e-3, 1e2));
    let test = |((xi, omega, periods, phi, u, v), slope, kick): (Setting, f64, f64)| {
        let d = periods * TAU / omega;
        let (a, b) = (kick * slope * omega, (2.0 * u - 0.5) * slope / d);
        let parameters = Parameters { a, b, xi, omega, g: 0.02, phi };
        let [p, y, q] = aim(&parameters, v, d, 0.0, slope);
        let guard = |t: f64| flight(&parameters, [p, y, q], t);
        prop_assume!(is_steep(
            &guard(d),
            a + b.abs() + q / (4.0 * xi * xi) * (-d / (2.0 * xi)).exp()
        ));
        let Some((segment, ..)) = first_segment(parameters, state(p, y, q)) else {
            return Err(TestCaseError::reject("start not accepted"));
        };
        // Within four units in the last place of the surface a start is on it.
        prop_assume!(segment.phase() == Phase::NoContact);
        tally
            .take(examine(&segment, guard, d, 200)?, (parameters, [p, y, q], d, segment.duration()))
    };
    runner(20_000, 11).run(&strategy, test).unwrap();
    println!("recovered {} earlier {}", tally.recovered.get(), tally.earlier.get());
    assert!(tally.recovered.get() > 1500);
}

#[test]
fn flights_that_nearly_graze_are_decided() {
    let tally = Tally::default();
    let strategy = (setting(), margin(), log(1e-2, 1e2), 0.0..0.9_f64);
    let test = |((xi, omega, periods, tilt, u, v), margin, a, down): (Setting, f64, f64, f64)| {
        let d = periods * TAU / omega;
        // Near the trough of the force, so that h is concave at the plant.
        let phi = (std::f64::consts::PI + 0.2 * (tilt - 3.0) - omega * d).rem_euclid(TAU);
        let b = a * (down * 0.9 - 0.5 * u);
        let parameters = Parameters { a, b, xi, omega, g: 0.02, phi };
        let size = flight(&parameters, aim(&parameters, v, d, 0.0, 0.0), d).size;
        let start = aim(&parameters, v, d, margin * size, 0.0);
        let guard = |t: f64| flight(&parameters, start, t);
        prop_assume!(b + a * harmonic(&parameters, d).force < -0.05 * a);
        let Some((segment, ..)) = first_segment(parameters, state(start[0], start[1], start[2]))
        else {
            return Err(TestCaseError::reject("start not accepted"));
        };
        // Within four units in the last place of the surface a start is on it.
        prop_assume!(segment.phase() == Phase::NoContact);
        let finding = examine(&segment, guard, d, 200)?;
        if margin > 0.0 {
            prop_assert!(
                segment.duration() <= d,
                "passed: {:?}",
                (parameters, start, d, segment.duration())
            );
        }
        count(if finding == Finding::Earlier { &tally.earlier } else { &tally.recovered }, 1);
        Ok(())
    };
    runner(20_000, 12).run(&strategy, test).unwrap();
    println!("missed {} hit {}", tally.recovered.get(), tally.earlier.get());
    assert!(tally.recovered.get() > 500 && tally.earlier.get() > 500);
}

#[test]
fn touches_within_the_rounding_are_counted_and_passed() {
    let tally = Tally::default();
    let strategy = (setting(), -2.0..2.0_f64, log(1e-2, 1e2));
    let test = |((xi, omega, periods, _, u, v), ulps, a): (Setting, f64, f64)| {
        let d = periods.min(2.0) * TAU / omega;
        let phi = (std::f64::consts::PI - omega * d).rem_euclid(TAU);
        let parameters = Parameters { a, b: 0.5 * a * u, xi, omega, g: 0.02, phi };
        let size = flight(&parameters, aim(&parameters, v, d, 0.0, 0.0), d).size;
        let start = aim(&parameters, v, d, ulps * f64::EPSILON * size, 0.0);
        let guard = |t: f64| flight(&parameters, start, t);
        let Some((segment, counters, rest)) =
            first_segment(parameters, state(start[0], start[1], start[2]))
        else {
            return Err(TestCaseError::reject("start not accepted"));
        };
        examine(&segment, guard, d, 200)?;
        count(&tally.undecidable, counters.undecidable);
        prop_assert!(rest.take(20).all(|segment| !segment.duration().is_nan()));
        Ok(())
    };
    runner(1000, 13).run(&strategy, test).unwrap();
    println!("undecidable {}", tally.undecidable.get());
    assert!(tally.undecidable.get() > 0);
}

#[test]
fn flights_after_separation_are_recovered() {
    let tally = Tally::default();
    let strategy = (setting(), log(1e-3, 1e1));
    let test = |((xi, omega, periods, phi, u, _), a): (Setting, f64)| {
        let d = periods * TAU / omega;
        let mut parameters = Parameters { a, b: a * (u - 0.5), xi, omega, g: 0.02, phi };
        parameters.b = parameters.b.min(a / (1.0 + periods * periods));
        // h is linear in the velocity at separation.
        let (unit, rest) = (
            flight_from_surface(&Parameters { a: 0.0, b: 0.0, ..parameters }, 1.0, d),
            flight_from_surface(&parameters, 0.0, d),
        );
        let y = -rest.excess / unit.excess;
        let guard = |t: f64| flight_from_surface(&parameters, y, t);
        let at = guard(d);
        prop_assume!(y.abs() < 1e6 && at.slope > 0.0);
        let bend = a + parameters.b.abs() + y.abs() / (2.0 * xi);
        prop_assume!(is_steep(&at, bend));
        let q = -2.0 * xi * y;
        let Some((segment, ..)) = first_segment(parameters, state(q + 0.02, y, q)) else {
            return Err(TestCaseError::reject("start not accepted"));
        };
        prop_assume!(segment.phase() == Phase::NoContact);
        tally.take(examine(&segment, guard, d, 200)?, (parameters, y, d, segment.duration()))
    };
    runner(20_000, 14).run(&strategy, test).unwrap();
    println!("recovered {} earlier {}", tally.recovered.get(), tally.earlier.get());
    assert!(tally.recovered.get() > 1000);
}

/// An impact whose force is `force`: below 1 contact follows, from 1 on progression.
#[test]
fn impacts_choose_the_phase_by_their_force() {
    let tally = Tally::default();
    let near =
        (log(1e-12, 1e-1), any::<bool>()).prop_map(|(e, up)| if up { 1.0 + e } else { 1.0 - e });
    let strategy = (setting(), prop_oneof![3 => near, 1 => log(1e-3, 1e2)], log(1e-3, 1.0));
    let test = |((xi, omega, periods, phi, u, v), force, kick): (Setting, f64, f64)| {
        let (d, slope) = (periods * TAU / omega, force / (2.0 * xi));
        let (a, b) = (kick * slope * omega, (u - 0.25) * slope / d);
        let parameters = Parameters { a, b, xi, omega, g: 0.02, phi };
        let [p, y, q] = aim(&parameters, v, d, 0.0, slope);
        let guard = |t: f64| flight(&parameters, [p, y, q], t);
        prop_assume!(p.abs() < 1e9 && y.abs() < 1e9 && a < 1e9);
        let Some((segment, ..)) = first_segment(parameters, state(p, y, q)) else {
            return Err(TestCaseError::reject("start not accepted"));
        };
        let finding = examine(&segment, guard, d, 200)?;
        tally.take(finding, (parameters, [p, y, q], d, segment.duration()))?;
        let Exit::Switch(next) = segment.exit() else { unreachable!() };
        // The slope is known to the roundings of its terms, and moves with the crossing.
        let bend = a + b.abs() + v / (4.0 * xi * xi);
        let terms = y.abs() + (b * d).abs() + a / omega * (omega * d).min(1.0) + slope;
        let unsure = 2.0 * xi * f64::EPSILON * 16.0 * (terms + bend * guard(d).size / slope);
        if finding == Finding::Recovered && (force - 1.0).abs() > unsure {
            let expected = if force > 1.0 { Phase::Progression } else { Phase::Contact };
            prop_assert_eq!(next.phase(), expected, "{:?}", (parameters, [p, y, q], d, force));
        }
        Ok(())
    };
    runner(20_000, 15).run(&strategy, test).unwrap();
    println!("recovered {} earlier {}", tally.recovered.get(), tally.earlier.get());
    assert!(tally.recovered.get() > 1500);
}

/// Strong damping, slow forcing: the trial force follows its steady part and falls below zero by a
/// little, once a period. Its derivatives must not be made by the stiff equations of motion, which
/// multiply the rounding of f by 2 xi each: the excursion would be lost in them.
#[test]
fn short_separations_under_strong_damping_are_found() {
    let strategy = (log(2.0, 1e4), log(1e-4, 0.3), log(1e-9, 1e-2), 0.1..0.4_f64, 0.0..0.5_f64);
    let test = |(xi, omega, depth, a, early): (f64, f64, f64, f64, f64)| {
        // f - b = a Re(H exp(i (omega tau + phi))), q - b = a Re(R exp(..)), with R = 1/P.
        let (stiffness, damping) = (1.0 - omega * omega, 2.0 * xi * omega);
        let square = stiffness * stiffness + damping * damping;
        let size = ((1.0 + damping * damping) / square).sqrt();
        let lag = damping.atan() - damping.atan2(stiffness);
        let b = a * size * (1.0 - depth);
        prop_assume!(b + a * size < 0.95);
        // The start lies up to half a turn before the trough of f.
        let from = std::f64::consts::PI * early;
        let phi = from - lag;
        let (sin, cos) = phi.sin_cos();
        let q = b + a * (cos * stiffness + sin * damping) / square;
        let y = a * omega * (cos * damping - sin * stiffness) / square;
        let parameters = Parameters { a, b, xi, omega, g: 0.02, phi };
        let start =
            Start { p: q + 0.02, y, q: Some(q), phase: Some(Phase::Contact), ..Start::default() };
        let Some((segment, counters, _)) = first_segment(parameters, start) else {
            return Err(TestCaseError::reject("start not accepted"));
        };
        let falls = ((depth - 1.0).acos() - from) / omega;
        let width = (2.0 * depth).sqrt() / omega;
        let room = 0.02 * width + 1e-3 / omega * depth.sqrt();
        prop_assert!(
            (segment.duration() - falls).abs() < room,
            "{} for {falls}",
            segment.duration()
        );
        prop_assert!(counters.evaluations < 100, "{counters:?}");
        Ok(())
    };
    runner(20_000, 17).run(&strategy, test).unwrap();
}
