//! Phases that last very long cost little: what cannot happen is proved, not waited for.

use percuss::{Endless, Exit, Instant, Model, Parameters, Segment, Start};

fn first_segment(parameters: Parameters, start: Start, periods: u64) -> (Segment, u64) {
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    let horizon: Instant = entry.instant.after_periods(periods, 1);
    let mut run = model.trajectory(entry).until(horizon);
    let segment = run.next().unwrap();
    (segment, run.counters().evaluations)
}

/// A window of search a bound's zero, and some jumps to get there.
const MAX_EVALUATIONS: u64 = 300;

#[test]
fn a_weak_force_in_resonance_takes_its_time() {
    // The amplitude grows by a/2 a unit of time: f reaches 1 or 0 only after 1e8 of them.
    let parameters =
        Parameters { a: 1.2e-8, b: 0.5, xi: 1e-8, omega: 1.0, g: 0.0, ..Default::default() };
    let start = Start { p: 0.5, q: Some(0.5), ..Default::default() };
    let (segment, evaluations) = first_segment(parameters, start, 1_000_000_000);
    assert!(matches!(segment.exit(), Exit::Switch(_)));
    // |f - b| = 0.6 (1 - exp(-xi d)) reaches 0.5 at d = ln(6)/xi; within an oscillation of that.
    let expected = 6.0_f64.ln() / 1e-8;
    assert!((segment.duration() - expected).abs() < 10.0, "{} {expected}", segment.duration());
    assert!(evaluations < MAX_EVALUATIONS, "{evaluations}");
}

#[test]
fn flights_stay_cheap_as_the_static_force_vanishes() {
    for exponent in 2..=20 {
        let b = 10.0_f64.powi(-exponent);
        // The last start has no mean velocity: the crests of its gap rise by less a period than the
        // gap is known to, once y0 d is 1e9; some 400 periods around the impact are undecidable.
        for (y, limit) in [(-1.0, 1), (-1e-3, 1), (0.0, 1), (0.1, 1), (0.214_285_714_285_714_3, 3)]
        {
            let parameters = Parameters { b, ..Default::default() };
            let start = Start { p: -1.0, y, q: Some(0.0), ..Default::default() };
            let (_, evaluations) = first_segment(parameters, start, 1_000_000_000);
            assert!(evaluations < limit * MAX_EVALUATIONS, "b = {b:e}, y = {y}: {evaluations}");
        }
    }
}

#[test]
fn endless_phases_are_proved_so() {
    let chaos = Parameters::default();
    let resting = Parameters { a: 0.05, b: 0.5, xi: 0.1, omega: 0.7, ..chaos };
    for (parameters, y, endless) in [
        (Parameters { b: -0.1, ..chaos }, -1.0, Endless::NeverReturns),
        (Parameters { b: 0.0, ..chaos }, -1.0, Endless::NeverReturns),
        (Parameters { b: 1.2, ..chaos }, 0.0, Endless::NeverStops),
        (resting, 0.0, Endless::RestsForEver),
    ] {
        let model = Model::new(parameters).unwrap();
        let entry = model.start(&Start { y, ..Start::default() }).unwrap();
        let last = model.trajectory(entry).take(1000).last().unwrap();
        assert_eq!(*last.exit(), Exit::Endless(endless));
    }
}
