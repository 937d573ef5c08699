//! Events at which the next mode is decided by a value close to zero.
//!
//! An engine whose error may be larger than that value cannot be asked for the mode that the model
//! says, and what follows depends on it.

use super::rule::ErrorRule;
use crate::system::CheckedSystem;
use crate::truth::{Truth, TruthRow};

/// An event whose successor is decided by the sign of a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// Time of the event since the start.
    pub elapsed: f64,
    /// The size of the value.
    pub margin: f64,
    /// Largest error of the value that one unit of error may have become.
    pub growth: f64,
}

/// The decisions of a true run: where a value decides what follows, and where events of one instant
/// have an order that matters, which no error leaves decided.
#[must_use]
pub fn decisions(system: &CheckedSystem, truth: &Truth, rule: &ErrorRule) -> Vec<Decision> {
    let mut found = by_value(system, truth, rule);
    let together = truth
        .events
        .windows(2)
        .filter(|pair| truth.ordered && pair[1].elapsed.minus(pair[0].elapsed).value() == 0.0);
    let tie = |pair: &[TruthRow]| pair[0].elapsed.value();
    found.extend(together.map(|it| Decision { elapsed: tie(it), margin: 0.0, growth: 1.0 }));
    found
}

fn by_value(system: &CheckedSystem, truth: &Truth, rule: &ErrorRule) -> Vec<Decision> {
    let mut mode = truth.start.mode;
    let mut found = Vec::new();
    for (n, row) in truth.events.iter().enumerate() {
        let elapsed = row.elapsed.value();
        let after: Vec<f64> = row.state.iter().map(|it| it.value()).collect();
        for (deciding, [value, rate]) in system.decisions((mode, row.event), elapsed, &after) {
            let by_state = rule.guard_growth(&deciding, row, &after);
            let size = row.size_of_time(rule.time_scale);
            let by_time = rate.abs() * rule.time_scale * size * row.growth_time;
            let growth = by_state.max(by_time) * (n + 1) as f64;
            found.push(Decision { elapsed, margin: value.abs(), growth });
        }
        mode = row.mode;
    }
    found
}
