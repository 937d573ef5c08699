//! Periodic orbits: they map to themselves, and their multipliers are those of the map.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a panic is a failed test")]

use percuss::dynamics::orbit::Orbit;
use percuss::dynamics::strobe::{Point, StrobeMap};
use percuss::{Instant, Model, Parameters};

fn map(xi: f64, omega: f64) -> StrobeMap {
    let model = Model::new(Parameters { xi, omega, ..Parameters::default() }).unwrap();
    StrobeMap::new(model, Instant::at(omega, 0.0, 0))
}

/// The strobe of the motion from `start` after many periods.
fn settled(map: &StrobeMap, start: Point, periods: u64) -> Point {
    map.strobes(map.entry(start).unwrap(), periods).last().unwrap().point()
}

#[test]
fn table_1_settles_on_period_two() {
    let map = map(0.01, 0.1);
    let orbit = Orbit::find(&map, settled(&map, [0.0; 3], 100), 8).unwrap();
    assert_eq!(orbit.period(), 2);
    assert!(orbit.is_stable());
}
