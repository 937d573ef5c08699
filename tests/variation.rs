//! The derivative of the motion over impacts and other switches, against differences of the motion.

use percuss::TwoWord;
use percuss::variation::{ANGLE, IDENTITY, Matrix, P, Q, V, Y, product};
use percuss::{Exit, Model, Parameters, Phase, Start};

/// A start in free flight, where p, y and q may vary on their own.
const FLIGHT: Start =
    Start { tau: 0.3, cycle: 0, p: -0.4, y: 0.2, q: Some(0.05), v: 0.0, phase: None };

/// Differences of 1e-5 are good to about 1e-10 x third derivatives and 1e-11 of rounding.
const STEP: f64 = 1e-5;
const DERIVATIVE_TOLERANCE: f64 = 1e-6;

/// The derivative along the run, the kinds of its impacts, and p, y, q and v a time `span` after
/// the start.
struct Run {
    derivative: Matrix,
    impacts: Vec<Phase>,
    end: [f64; 4],
}

fn run(parameters: Parameters, start: Start, span: f64) -> Run {
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    let horizon = entry.instant.after(TwoWord::new(span), parameters.omega);
    let mut run = Run { derivative: IDENTITY, impacts: Vec::new(), end: [f64::NAN; 4] };
    for segment in model.trajectory(entry).until(horizon) {
        let within = segment.variation(segment.duration());
        let step = match segment.exit() {
            Exit::Switch(next) => {
                if segment.phase() == Phase::NoContact {
                    run.impacts.push(next.phase());
                }
                product(&segment.saltation(), &within)
            }
            _ => within,
        };
        run.derivative = product(&step, &run.derivative);
        let end = segment.at_instant(&horizon);
        run.end = [end.state.p, end.state.y, end.state.q, end.v];
    }
    run
}

fn varied_start(start: Start, omega: f64, direction: usize, step: f64) -> Start {
    match direction {
        ANGLE => Start { tau: start.tau + step / omega, ..start },
        P => Start { p: start.p + step, ..start },
        Y => Start { y: start.y + step, ..start },
        Q => Start { q: start.q.map(|q| q + step), ..start },
        _ => Start { v: start.v + step, ..start },
    }
}

/// Checks every entry at every eighth of a unit of time, so that some lie just after each switch.
fn assert_derivatives(parameters: Parameters, flight: Start, last: f64) -> Vec<Phase> {
    let mut impacts = Vec::new();
    for span in (1..).map(|k| 0.125 * f64::from(k)).take_while(|span| *span <= last) {
        let Run { derivative, impacts: so_far, .. } = run(parameters, flight, span);
        for direction in [ANGLE, P, Y, Q, V] {
            let ends = [STEP, -STEP].map(|step| {
                run(parameters, varied_start(flight, parameters.omega, direction, step), span).end
            });
            for (k, row) in [P, Y, Q, V].into_iter().enumerate() {
                let difference = (ends[0][k] - ends[1][k]) / (2.0 * STEP);
                let exact = derivative[row][direction];
                assert!(
                    (difference - exact).abs() <= DERIVATIVE_TOLERANCE * (1.0 + exact.abs()),
                    "row {row}, direction {direction} after {span}: {difference} {exact}"
                );
            }
        }
        impacts = so_far;
    }
    impacts
}

#[test]
fn over_impacts_into_contact() {
    let parameters = Parameters { xi: 0.1, ..Parameters::default() };
    let impacts = assert_derivatives(parameters, FLIGHT, 12.0);
    assert!(!impacts.is_empty() && impacts.iter().all(|it| *it == Phase::Contact), "{impacts:?}");
}

#[test]
fn over_impacts_into_progression() {
    // The trial force at the impact is about 1.4.
    let parameters = Parameters { xi: 0.6, ..Parameters::default() };
    let impacts = assert_derivatives(parameters, Start { y: 1.2, ..FLIGHT }, 8.0);
    assert!(impacts.contains(&Phase::Progression), "{impacts:?}");
}
