//! The search for events on guards that are made up as functions of time.

use super::*;
use crate::engine::Limits;
use crate::integration::field::{GUARDS, Oscillator};
use percuss::Parameters;

/// Contact with a trial force as given and no velocity, so that q is the force.
fn first(force: fn(f64) -> f64, rate: fn(f64) -> f64) -> Option<GuardRise> {
    searched(force, rate).0
}

/// The crossing, and how many states inside the step the search has asked for.
fn searched(force: fn(f64) -> f64, rate: fn(f64) -> f64) -> (Option<GuardRise>, u32) {
    let parameters = Parameters { a: 0.0, b: 0.0, ..Parameters::default() };
    let meter = Meter::new(&Limits::default());
    let equations = Made { oscillator: Oscillator::new(&parameters, 0.0), force, rate };
    let from = Moment::start(&equations, 1, [0.0; 4]);
    let search = GuardSearch::new(equations, &from, &meter);
    let mut looks = 0;
    let mut state_at = |t| {
        looks += 1;
        Ok([t, 0.0, 0.0, 0.0])
    };
    let [left, right] = [0.0, 1.0].map(|t| search.guards_at(t, &[t, 0.0, 0.0, 0.0]));
    let found = search.between(&left, &right, &mut state_at, &mut Vec::new());
    (found.ok().flatten(), looks)
}

/// Guards made up as functions of time, which the state carries.
#[derive(Clone, Copy)]
struct Made {
    oscillator: Oscillator,
    force: fn(f64) -> f64,
    rate: fn(f64) -> f64,
}

impl Equations for Made {
    type State = [f64; 4];
    type Guards = [f64; GUARDS];
    fn dimension(&self) -> usize {
        4
    }
    fn most_guards(&self) -> usize {
        GUARDS
    }
    fn count(&self, mode: usize) -> usize {
        self.oscillator.count(mode)
    }
    fn derivatives(&self, mode: usize, t: f64, u: &[f64], du: &mut [f64]) {
        self.oscillator.derivatives(mode, t, u, du);
    }
    fn jacobian_product(&self, mode: usize, w: &[f64], dw: &mut [f64]) {
        self.oscillator.jacobian_product(mode, w, dw);
    }
    fn guards(&self, _: usize, _: f64, u: &[f64]) -> [f64; GUARDS] {
        [(self.force)(u[0]) - 1.0, -(self.force)(u[0])]
    }
    fn rates(&self, _: usize, t: f64, _: &[f64]) -> [f64; GUARDS] {
        [(self.rate)(t), -(self.rate)(t)]
    }
    fn after_event(&self, mode: usize, guard: usize, t: f64, u: &[f64; 4]) -> (usize, [f64; 4]) {
        self.oscillator.after_event(mode, guard, t, u)
    }
    fn settle(&self, entered: Entered, u: &[f64], guards: &mut [f64; GUARDS]) {
        self.oscillator.settle(entered, u, guards);
    }
}

#[test]
fn a_crossing_is_found_to_a_few_roundings_of_its_time() {
    let found = first(|t| 0.3 + t, |_| 1.0);
    assert!(found.is_some_and(|it| it.guard == 0 && (it.t - 0.7).abs() <= 4.0 * f64::EPSILON));
}

#[test]
fn a_touch_between_two_looks_is_found() {
    let found = first(|t| 1.0 + 1e-12 - (t - 0.7).powi(2), |t| -2.0 * (t - 0.7));
    assert!(found.is_some_and(|it| it.guard == 0 && (it.t - (0.7 - 1e-6)).abs() < 1e-9));
    assert_eq!(first(|t| 1.0 - 1e-12 - (t - 0.7).powi(2), |t| -2.0 * (t - 0.7)), None);
}

#[test]
fn of_two_crossings_between_two_looks_the_first_counts() {
    let force = |t: f64| 0.5 + 1e3 * (t - 0.99) * (0.999 - t) * 60.0 + 0.4;
    let rate = |t: f64| 6e4 * (0.99 + 0.999 - 2.0 * t);
    assert!(first(force, rate).is_some_and(|it| it.guard == 0 && it.t > 0.99));
}

/// The rates at both ends are positive, and yet the guard rises above zero and falls below it again
/// between them.
#[test]
fn a_crossing_that_no_end_shows_is_found() {
    let force = |t: f64| 0.6 + 0.5 * (4.5 * t + 0.2).sin() + 0.05 * t;
    let rate = |t: f64| 2.25 * (4.5 * t + 0.2).cos() + 0.05;
    assert!(force(0.0) < 1.0 && force(1.0) < 1.0 && rate(0.0) > 0.0 && rate(1.0) > 0.0);
    let found = first(force, rate);
    assert!(found.is_some_and(|it| it.guard == 0 && (force(it.t) - 1.0).abs() < 1e-14));
}

/// A guard that stays well inside costs no look between a step's ends, one that peaks near zero one
/// or two, and a crossing a few.
#[test]
fn a_step_is_looked_into_where_that_may_show_something() {
    let calm = searched(|t| 0.5 + 0.1 * t.sin(), |t| 0.1 * t.cos());
    assert_eq!(calm, (None, 0));
    let peaks = |t: f64| 0.99 - 0.3 * (t - 0.4).powi(2) * (1.0 + 0.1 * t);
    let rate = |t: f64| -0.6 * (t - 0.4) * (1.0 + 0.1 * t) - 0.03 * (t - 0.4).powi(2);
    let (near, looks) = searched(peaks, rate);
    assert!(near.is_none() && (1..=2).contains(&looks), "{looks}");
    let (crossing, looks) = searched(|t| 0.4 + t.sin(), |t| t.cos());
    assert!(crossing.is_some() && looks <= 4, "{looks}");
}

#[test]
fn a_start_on_the_surface_is_no_crossing() {
    assert_eq!(first(|t| 1.0 - 0.5 * t, |_| -0.5), None);
}
