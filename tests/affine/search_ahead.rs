//! Searches beyond the horizon: a run that stops at many times, and searches ahead of each, has the
//! events and the states of runs that do not stop before.

use super::random;
use percuss::affine::{Ending, Event, Place, Solver, System, Time, What};
use percuss::gallery;

/// The time that runs take.
const HORIZON: f64 = 16.0;

/// The most events of a run.
const MAX_EVENTS: usize = 400;

/// A reach beyond all segments: each crossing is searched as in a run that does not stop.
const FAR_REACH: f64 = 1e3;

/// The rounding of a crossing that was searched from another time on, as it grows until the end of
/// a run: e^16 for the fastest growth of the random systems, a unit per unit of time.
const GROWN_ROUNDING: f64 = 1e-8;

macro_rules! system {
    ($name:literal) => {
        include_str!(concat!("../../validation/systems/", $name, ".system.toml"))
    };
}

const SYSTEMS: [&str; 9] = [
    gallery::IMPACT_OSCILLATOR,
    gallery::BOUNCING_BALL,
    gallery::THERMOSTAT,
    system!("watched-impact-oscillator"),
    system!("percussive-oscillator"),
    system!("relay-feedback"),
    system!("buck-converter"),
    system!("dry-friction-oscillator"),
    super::PLASTIC,
];

/// The events of a run that does not stop before a time, its ending the last of them, and the
/// number of choices that rounding left open.
fn whole_run(solver: &Solver<f64>, place: &Place<f64>, until: Time<f64>) -> (Vec<Event<f64>>, u64) {
    let mut run = solver.run_at(place, until);
    let events = run.by_ref().take(MAX_EVENTS).collect();
    (events, run.work().undecidable)
}

/// The events of a run that stops at each of these times, and searches so far ahead.
fn stopped_run(
    solver: &Solver<f64>,
    place: &Place<f64>,
    stops: &[Time<f64>],
    reach: f64,
) -> (Vec<Event<f64>>, u64) {
    let mut run = solver.run_at(place, stops[0]);
    run.search_ahead(reach);
    let mut events = Vec::new();
    for stop in stops {
        run.go_on_to(*stop);
        events.extend(run.by_ref().take(MAX_EVENTS));
    }
    (events, run.work().undecidable)
}

fn is_stop(event: &Event<f64>) -> bool {
    event.what == What::End(Ending::Horizon)
}

fn solver_and_place(system: &System) -> (Solver<f64>, Place<f64>) {
    let solver = Solver::<f64>::new(system).unwrap();
    let place = solver.place(system.start.as_ref().unwrap()).unwrap();
    (solver, place)
}

/// Whether times or states are the same but for rounding.
fn is_near(found: f64, expected: f64) -> bool {
    (found - expected).abs() < GROWN_ROUNDING * (1.0 + expected.abs())
}

/// Holds a run that stops at these times against runs that end there, unless rounding leaves
/// something open or the run ends before; gives the number of events.
fn check(solver: &Solver<f64>, place: &Place<f64>, stops: &[Time<f64>]) -> usize {
    let name = &solver.system().name;
    let (expected, open) = whole_run(solver, place, *stops.last().unwrap());
    if open > 0 || !expected.last().is_some_and(is_stop) {
        return 0;
    }
    // A search that ends between two events goes on from there.
    for reach in [FAR_REACH, 0.3 * solver.system().time_scale] {
        let (found, open) = stopped_run(solver, place, stops, reach);
        assert_eq!(open, 0, "{name}");
        let between: Vec<_> = found.iter().filter(|it| !is_stop(it)).collect();
        assert_eq!(between.len(), expected.len() - 1, "{name}: {between:?} {expected:?}");
        for (event, other) in between.iter().zip(&expected) {
            let same = event.what == other.what && event.mode == other.mode;
            let is_near = is_near(event.time.value(), other.time.value());
            assert!(same && is_near, "{name}: {event:?} {other:?}");
        }
        // At an event rounding decides which side of it a stop is on.
        let is_clear = |it: &&Event<f64>| {
            let apart = |other: &Event<f64>| (other.time.value() - it.time.value()).abs();
            is_stop(it) && between.iter().all(|other| apart(other) > GROWN_ROUNDING)
        };
        for stop in found.iter().filter(is_clear) {
            let (there, _) = whole_run(solver, place, stop.time);
            let there = there.last().unwrap();
            assert_eq!(stop.mode, there.mode, "{name} {:?}", stop.time);
            let entries = stop.state.iter().zip(&there.state);
            assert!(entries.into_iter().all(|(a, b)| is_near(*a, *b)), "{name} {:?}", stop.time);
        }
    }
    expected.len()
}

fn at(times: impl IntoIterator<Item = f64>) -> Vec<Time<f64>> {
    times.into_iter().map(|high| Time { high, low: 0.0 }).collect()
}

#[test]
fn a_run_that_stops_has_the_events_of_one_that_does_not() {
    let mut events = 0;
    for text in SYSTEMS {
        let system = System::parse("test.system.toml", text).unwrap();
        let (solver, place) = solver_and_place(&system);
        for step in [0.03125, 0.7, 3.0] {
            let (count, step) = ((HORIZON / step) as u32, step * system.time_scale);
            let stops = at((1..=count).map(|n| place.time.value() + step * f64::from(n)));
            events += check(&solver, &place, &stops);
        }
    }
    assert!(events > 200, "{events}");
}

#[test]
fn a_run_that_stops_at_its_events_has_each_once() {
    let mut stopped_at = 0;
    for text in SYSTEMS {
        let system = System::parse("test.system.toml", text).unwrap();
        let (solver, place) = solver_and_place(&system);
        let (events, _) = whole_run(&solver, &place, place.time.after(HORIZON * system.time_scale));
        let mut stops: Vec<_> = events.iter().map(|it| it.time).collect();
        stops.push(place.time.after((HORIZON + 1.0) * system.time_scale));
        stops.dedup_by(|a, b| a.value() <= b.value());
        stopped_at += check(&solver, &place, &stops);
    }
    assert!(stopped_at > 80, "{stopped_at}");
}

#[test]
fn random_runs_that_stop_have_the_events_of_those_that_do_not() {
    let mut events = 0;
    for seed in 1..=150 {
        let system = System::parse("random.system.toml", &random::system(seed)).unwrap();
        let (solver, place) = solver_and_place(&system);
        let stops = at((1..=40).map(|n| place.time.value() + 0.4 * f64::from(n)));
        events += check(&solver, &place, &stops);
    }
    assert!(events > 1_000, "{events}");
}
