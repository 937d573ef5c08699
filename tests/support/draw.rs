//! The strategies and the counters of the planted tests.

use super::plant::Finding;
use percuss::{Counters, Model, Parameters, Segment, Start, Trajectory};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestCaseError, TestRunner};
use std::cell::Cell;
use std::f64::consts::TAU;

pub type Outcome = Result<(), TestCaseError>;

/// The outcomes of the cases of one test, counted.
#[derive(Default)]
pub struct Tally {
    pub recovered: Cell<u32>,
    pub earlier: Cell<u32>,
    pub undecidable: Cell<u64>,
}

pub fn count<T: Copy + std::ops::Add<Output = T>>(cell: &Cell<T>, more: T) {
    cell.set(cell.get() + more);
}

impl Tally {
    /// A planted crossing must not be passed.
    pub fn take(&self, finding: Finding, what: impl std::fmt::Debug) -> Outcome {
        match finding {
            Finding::Recovered => count(&self.recovered, 1),
            Finding::Earlier => count(&self.earlier, 1),
            Finding::Later => return Err(TestCaseError::fail(format!("passed: {what:?}"))),
        }
        Ok(())
    }
}

pub fn runner(cases: u32, seed: u64) -> TestRunner {
    TestRunner::new(Config {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(seed),
        max_global_rejects: 1_000_000,
        ..Config::default()
    })
}

/// Uniform in the logarithm.
pub fn log(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

pub fn damping() -> impl Strategy<Value = f64> {
    let near_1 =
        (log(1e-15, 1e-3), any::<bool>()).prop_map(|(e, up)| if up { 1.0 + e } else { 1.0 - e });
    prop_oneof![4 => log(1e-4, 1e2), 1 => Just(1.0), 1 => near_1]
}

/// From 1e-9 to 50 forcing periods.
pub fn phase_length() -> impl Strategy<Value = f64> {
    prop_oneof![2 => log(1e-9, 1.0), 3 => log(0.05, 5.0), 1 => log(1.0, 50.0)]
}

/// Margins of a graze in units of the guard's terms: from well above the rounding up to 1e-3.
pub fn margin() -> impl Strategy<Value = f64> {
    (log(64.0 * f64::EPSILON, 1e-3), any::<bool>()).prop_map(|(m, hit)| if hit { m } else { -m })
}

/// xi, omega, periods, forcing angle at the plant, two free choices in 0..1.
pub type Setting = (f64, f64, f64, f64, f64, f64);

pub fn setting() -> impl Strategy<Value = Setting> {
    (damping(), log(0.01, 50.0), phase_length(), 0.0..TAU, 0.0..1.0_f64, 0.0..1.0_f64)
}

pub fn first_segment(
    parameters: Parameters,
    start: Start,
) -> Option<(Segment, Counters, Trajectory)> {
    let model = Model::new(parameters).ok()?;
    let entry = model.start(&start).ok()?;
    let mut trajectory = model.trajectory(entry).until(entry.instant.after_periods(200, 1));
    let segment = trajectory.next()?;
    Some((segment, trajectory.counters(), trajectory))
}

pub fn state(p: f64, y: f64, q: f64) -> Start {
    Start { p, y, q: Some(q), ..Start::default() }
}
