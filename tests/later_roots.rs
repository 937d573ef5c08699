//! A crossing that is not the first is never proved to be: the certificates are asked about the
//! later ones.
//!
//! The search hands a certificate the first crossing nearly always, and so hardly tests what it
//! refuses.

use percuss::insides::Constants;
use percuss::insides::crossing::{Guarded, Proof, ThresholdEnds};
use percuss::insides::flow::forcing::EntryAngle;
use percuss::insides::flow::no_contact::NoContact;
use percuss::insides::flow::progression::Progression;
use percuss::insides::flow::steps::Steps;
use percuss::{Parameters, State};
use std::f64::consts::TAU;

use crate::support::random::Draw;

/// Places at which the guard is looked at.
const PLACES: u32 = 400;

/// The least height of an excursion that counts: the roundings that a certificate allows for, in
/// the guard's largest term, which are SLACK at both ends of the evaluation and of the certificate.
const MIN_EXCURSION: f64 = 16.0 * f64::EPSILON;

fn excess<G: Guarded>(phase: &G, d: f64) -> (f64, f64) {
    let guard = phase.at(d).guard;
    (phase.corridor().excess(guard.orders[0]), guard.largest_term)
}

/// Crossings outwards up to a time, after the guard has been outside already by more than rounding.
fn later_roots<G: Guarded>(phase: &G, until: f64) -> Vec<f64> {
    let place = |k: u32| until * f64::from(k) / f64::from(PLACES);
    let mut roots = Vec::new();
    let mut has_been_outside = false;
    for k in 1..PLACES {
        let (mut inside, mut outside) = (place(k), place(k + 1));
        let (value, terms) = excess(phase, inside);
        has_been_outside |= value > MIN_EXCURSION * terms;
        if has_been_outside && value <= 0.0 && excess(phase, outside).0 > 0.0 {
            for _ in 0..60 {
                let middle = 0.5 * (inside + outside);
                if excess(phase, middle).0 > 0.0 { outside = middle } else { inside = middle }
            }
            roots.push(outside);
        }
    }
    roots
}

/// How many later roots there are; none of them may be proved.
fn ask<G: Guarded>(phase: &G, steps: &Steps, until: f64, about: &impl std::fmt::Debug) -> usize {
    let roots = later_roots(phase, until);
    for root in &roots {
        let ends = ThresholdEnds { right: true, ..phase.imposed() };
        let verdict = phase.certify(steps, &phase.entry(), &phase.at(*root), ends);
        assert_ne!(verdict, Proof::Inside, "{about:?}: {root:e} is not the first crossing");
    }
    roots.len()
}

fn setting(draw: &mut Draw) -> (Parameters, EntryAngle<f64>) {
    let (a, omega) = (draw.decades(0.1, 10.0), draw.decades(0.1, 10.0));
    let xi = draw.decades(1e-3, 10.0);
    let radians = draw.between(0.0, TAU);
    let (sin, cos) = radians.sin_cos();
    let parameters = Parameters { a, b: 0.0, xi, omega, g: 0.02, phi: 0.0 };
    (parameters, EntryAngle { radians, sin, cos })
}

#[test]
fn later_impacts_are_not_proved() {
    let mut draw = Draw(2026);
    let mut roots = 0;
    for _ in 0..50_000 {
        let (mut parameters, angle) = setting(&mut draw);
        let Parameters { a, omega, xi, .. } = parameters;
        let b = a * draw.between(-0.15, 0.1);
        parameters.b = b;
        // The guard must fall: the spring holds what the force pushes, and more.
        let spring = 1.001 * (a * angle.cos + b).max(0.0);
        let y = -2.0 * xi * spring - a / omega * draw.decades(1e-3, 1.5);
        let q = -2.0 * xi * y;
        let entry = State { p: q + parameters.g, y, q };
        let constants = Constants::new(&parameters);
        let flight = NoContact { constants, entry, angle, surface: Some(0.0) };
        let until = draw.decades(0.5, 60.0) / omega;
        roots += ask(&flight, &Steps::new(&parameters), until, &(parameters, entry, angle));
    }
    println!("{roots} later impacts");
    assert!(roots > 1000, "{roots}");
}

#[test]
fn later_stops_are_not_proved() {
    let mut draw = Draw(2027);
    let mut roots = 0;
    for _ in 0..20_000 {
        let (mut parameters, angle) = setting(&mut draw);
        let Parameters { a, omega, xi, .. } = parameters;
        parameters.b = 1.0 - a * draw.between(-0.1, 0.3);
        let closing = draw.decades(1e-4, 3.0);
        let drift_rate = a / omega * draw.decades(1e-3, 2.0);
        let q = 1.0 - 2.0 * xi * closing;
        let entry = State { p: q + parameters.g, y: closing + drift_rate, q };
        let constants = Constants::new(&parameters);
        let slip = Progression { constants, entry, angle, drift_rate, closing };
        let until = draw.decades(0.5, 60.0) / omega;
        roots += ask(&slip, &Steps::new(&parameters), until, &(parameters, entry, angle));
    }
    println!("{roots} later stops");
    assert!(roots > 1000, "{roots}");
}
