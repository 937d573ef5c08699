//! Each closed form against the differential equations (11)-(13) that it solves, in 106 bits.
//!
//! The form at d + s must be what the equations make of the form at d, for any d and a short s, and
//! at d = 0 it must be the entry state. Together that is the definition of the solution.

use crate::support::draws::{Form, REGIMES};
use crate::support::random::Draw;
use crate::support::taylor::{MAX_STEP, fastest_rate, series};
use percuss::affine::DoubleDouble;
use percuss::insides::flow::Point;
use percuss::number::Number;
use percuss::{Phase, State};

/// Phases drawn from each regime.
const DRAWS: usize = 2000;

/// Errors in units of 2^-106 (1 + size): both sides carry some tens of roundings, and the forms'
/// remainders lose up to 35 units next to resonance (SOLVING: the divided difference, 5 eps).
const ALLOWED_UNITS: f64 = 200.0;

const PHASES: [Phase; 3] = [Phase::NoContact, Phase::Contact, Phase::Progression];

fn words(point: &Point<DoubleDouble>) -> [DoubleDouble; 4] {
    let State { p, y, q } = point.state;
    [p, y, q, point.drift]
}

/// Sine and cosine of the forcing angle a time `elapsed` into the phase.
fn angle(form: &Form<DoubleDouble>, elapsed: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let (_, entry) = form.entry();
    let (sin, cos) = (form.constants().omega * elapsed).sin_cos();
    (entry.sin * cos + entry.cos * sin, entry.cos * cos - entry.sin * sin)
}

/// The size of what is added up in a state: the whole motion up to now, and its rates.
fn size(form: &Form<DoubleDouble>, point: &Point<DoubleDouble>) -> f64 {
    let d = point.elapsed.to_f64();
    let constants = form.constants();
    let (entry, _) = form.entry();
    let forces = 1.0 + constants.a.to_f64() + constants.b.to_f64().abs();
    let travel = if form.phase() == Phase::Contact { 0.0 } else { d };
    let largest = entry.p.abs().to_f64() + entry.q.abs().to_f64() + entry.y.abs().to_f64();
    (1.0 + largest + forces * (1.0 + travel)) * (1.0 + travel)
}

#[derive(Default)]
struct Worst {
    flow: f64,
    guard: f64,
}

fn compare(form: &Form<DoubleDouble>, elapsed: f64, step: f64, worst: &mut Worst) {
    let (phase, constants) = (form.phase(), form.constants());
    let d = DoubleDouble::exact(elapsed);
    let here = form.at(d);
    let solution = series(phase, constants, &here.state, angle(form, d));
    let unit = DoubleDouble::UNIT * size(form, &here);

    let fastest = fastest_rate(phase, constants);
    let step = DoubleDouble::exact(step / fastest);
    let there = form.at(d + step);
    let mut expected = solution.at(step);
    expected[3] = expected[3] + here.drift;
    for (found, expected) in words(&there).into_iter().zip(expected) {
        worst.flow = worst.flow.max((found - expected).abs().to_f64() / unit);
    }

    let expected = solution.guard(phase, constants, form.reference());
    for (k, (found, expected)) in here.guard.orders.into_iter().zip(expected).enumerate() {
        // In progression the guard holds q/(2 xi), else q itself.
        let order = k as i32 + i32::from(phase == Phase::Progression);
        let error = (found - expected).abs().to_f64() / (unit * fastest.powi(order));
        worst.guard = worst.guard.max(error);
    }
}

#[test]
fn every_form_solves_its_differential_equations() {
    let mut draw = Draw(1);
    for phase in PHASES {
        for regime in &REGIMES {
            let mut worst = Worst::default();
            for _ in 0..DRAWS {
                let pair = regime.pair(phase, &mut draw);
                let step = draw.between(0.0, MAX_STEP);
                compare(&pair.exact, pair.elapsed, step, &mut worst);
                compare(&pair.exact, 0.0, step, &mut worst);
            }
            let Worst { flow, guard } = worst;
            println!("{phase} {}: flow {flow:.1}, guard {guard:.1} units", regime.name);
            assert!(flow <= ALLOWED_UNITS, "{phase} {}: flow {flow}", regime.name);
            assert!(guard <= ALLOWED_UNITS, "{phase} {}: guard {guard}", regime.name);
        }
    }
}

#[test]
fn every_form_begins_at_its_entry() {
    let mut draw = Draw(2);
    for phase in PHASES {
        for regime in &REGIMES {
            for _ in 0..DRAWS {
                let form = regime.pair(phase, &mut draw).exact;
                let point = form.at(DoubleDouble::zero());
                let (entry, _) = form.entry();
                let differences = [
                    point.state.p - entry.p,
                    point.state.y - entry.y,
                    point.state.q - entry.q,
                    point.drift,
                ];
                let unit = DoubleDouble::UNIT * size(&form, &point);
                for difference in differences {
                    // p is q + g on the surface, and 1 - (1 - q0) is q0: two roundings.
                    assert!(difference.abs().to_f64() <= 8.0 * unit, "{form:?}");
                }
            }
        }
    }
}
