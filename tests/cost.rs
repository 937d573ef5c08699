//! The cost of a switch, and that endless phases are recognised at once.

use percuss::{Counters, Endless, Exit, Model, Parameters, Segment, Start};

fn first(parameters: Parameters, start: &Start) -> (Segment, Counters) {
    let model = Model::new(parameters).unwrap();
    let mut trajectory = model.trajectory(model.start(start).unwrap());
    let segment = trajectory.next().unwrap();
    (segment, trajectory.counters())
}

/// omega, xi and the evaluations a switch allowed: one next to the guess, from which a series leads
/// to the root. The rest is measured (1.06 at most) with room for another part of a chaotic run:
/// guesses that lead past an earlier crossing or too far from theirs for the series, and near
/// misses, which a certificate decides by a division at the crest. Where the run is periodic there
/// are none.
const REGIMES: [(f64, f64, f64); 8] = [
    (1.4, 0.01, 1.1),
    (0.1, 0.01, 1.01),
    (1.6, 0.1, 1.1),
    (1.4, 0.1, 1.1),
    (1.4, 5.0, 1.01),
    (1.4, 1.0, 1.01),
    (1.56, 0.1, 1.1),
    (1.7, 0.1, 1.1),
];

#[test]
fn a_switch_takes_one_evaluation_and_a_little() {
    for (omega, xi, most) in REGIMES {
        let model = Model::new(Parameters { omega, xi, ..Parameters::default() }).unwrap();
        let mut trajectory = model.trajectory(model.start(&Start::default()).unwrap());
        assert_eq!(trajectory.by_ref().take(100_000).count(), 100_000);
        let Counters { switches, evaluations, divisions, undecidable } = trajectory.counters();
        let cost = evaluations as f64 / switches as f64;
        println!(
            "omega {omega}, xi {xi}: {cost:.3} evaluations a switch, {divisions} divisions, \
             {undecidable} undecidable"
        );
        assert!(cost <= most, "omega {omega}, xi {xi}: {cost}");
    }
}

#[test]
fn flights_stay_cheap_as_the_static_force_vanishes() {
    for power in 2..=20 {
        let b = 10.0_f64.powi(-power);
        for (a, y, omega) in
            [(0.3, -0.1, 1.4), (0.0, -0.1, 1.4), (0.3, -1.0, 0.1), (3.0, -2.0, 20.0)]
        {
            let start = Start { p: -0.5, y, q: Some(0.3), ..Start::default() };
            let parameters = Parameters { a, b, omega, ..Parameters::default() };
            let (segment, counters) = first(parameters, &start);
            assert!(matches!(segment.exit(), Exit::Switch(_)), "{parameters:?}");
            // The mean motion is a parabola; the harmonic moves its return by a few periods.
            let expected = 2.0 * (a / omega - y) / b;
            let periods = 5.0 * std::f64::consts::TAU / omega;
            assert!(
                (segment.duration() - expected).abs() <= periods + 1e-9 * expected,
                "{parameters:?}"
            );
            // Independent of b; a wrong step over the time without crossings let it grow like 1/b.
            assert!(
                counters.evaluations <= 150,
                "{} evaluations at {parameters:?}",
                counters.evaluations
            );
        }
    }
}

#[test]
fn endless_phases_are_said_to_be_so() {
    let cases = [
        (
            Parameters { b: -0.1, ..Parameters::default() },
            Start { p: -1.0, ..Start::default() },
            Endless::NeverReturns,
        ),
        (
            Parameters { b: 0.0, ..Parameters::default() },
            Start { p: -1.0, y: -0.3, ..Start::default() },
            Endless::NeverReturns,
        ),
        (
            Parameters { b: 0.0, a: 0.0, ..Parameters::default() },
            Start { p: -1.0, ..Start::default() },
            Endless::NeverReturns,
        ),
        (
            Parameters { b: 1.5, ..Parameters::default() },
            Start { p: 1.0, y: 5.0, q: Some(0.98), ..Start::default() },
            Endless::NeverStops,
        ),
        (
            Parameters { b: 1.0, a: 0.0, ..Parameters::default() },
            Start { p: 1.02, y: 5.0, q: Some(1.0), ..Start::default() },
            Endless::NeverStops,
        ),
        (
            Parameters { a: 0.05, b: 0.5, xi: 0.1, omega: 0.7, ..Parameters::default() },
            Start { p: 0.52, q: Some(0.5), ..Start::default() },
            Endless::RestsForEver,
        ),
        (
            Parameters { a: 0.0, b: 0.5, ..Parameters::default() },
            Start { p: 0.32, q: Some(0.3), ..Start::default() },
            Endless::RestsForEver,
        ),
    ];
    for (parameters, start, expected) in cases {
        let (segment, counters) = first(parameters, &start);
        assert_eq!(*segment.exit(), Exit::Endless(expected), "{parameters:?} {start:?}");
        assert!(
            counters.evaluations <= 100,
            "{} evaluations at {parameters:?}",
            counters.evaluations
        );
    }
}
