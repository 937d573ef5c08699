//! The state of a sweep, as JSON and for people.

use crate::cli::shared::output::Destination;
use crate::sweep::{Plan, ShardState, SweepStatus};
use clap::ValueEnum;
use serde::Serialize;
use std::time::Duration;

/// What the state is written as; a table where a person reads it on a terminal, JSON elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    Json,
    /// One line per state, for reading
    #[value(alias = "txt")]
    Table,
}

/// The default format: a table on a terminal, JSON elsewhere.
pub(super) fn usual(destination: &Destination) -> Format {
    if destination.is_terminal() { Format::Table } else { Format::Json }
}

#[derive(Serialize)]
pub(super) struct StatusJson {
    schema: u32,
    percuss: &'static str,
    verb: String,
    plan: String,
    shards: u32,
    complete: bool,
    done: Vec<u32>,
    running: Vec<u32>,
    missing: Vec<u32>,
    damaged: Vec<DamagedJson>,
    seconds_to_end: Option<f64>,
}

#[derive(Serialize)]
struct DamagedJson {
    shard: u32,
    reason: String,
}

impl StatusJson {
    pub(super) fn new(plan: &Plan, status: &SweepStatus) -> Self {
        let damaged = (0..).zip(&status.shards).filter_map(|(shard, state)| match state {
            ShardState::Damaged(why) => Some(DamagedJson { shard, reason: why.clone() }),
            _ => None,
        });
        Self {
            schema: 1,
            percuss: env!("CARGO_PKG_VERSION"),
            verb: plan.verb.clone(),
            plan: plan.hash.clone(),
            shards: plan.shards,
            complete: status.is_complete(),
            done: status.numbers(|it| *it == ShardState::Done),
            running: status.numbers(|it| *it == ShardState::Running),
            missing: status.numbers(|it| *it == ShardState::Missing),
            damaged: damaged.collect(),
            seconds_to_end: status.seconds_to_end,
        }
    }
}

/// Lines for people: how many shards are in each state, and which.
pub(super) fn table(plan: &Plan, status: &SweepStatus) -> String {
    let rows = [
        ("done", status.numbers(|it| *it == ShardState::Done)),
        ("running", status.numbers(|it| *it == ShardState::Running)),
        ("missing", status.numbers(|it| *it == ShardState::Missing)),
        ("damaged", status.numbers(|it| matches!(it, ShardState::Damaged(_)))),
    ];
    let mut lines = vec![format!("{} shards of {}", plan.shards, plan.verb)];
    for (name, numbers) in rows {
        let which = if numbers.is_empty() { String::new() } else { ranges(&numbers) };
        lines.push(format!("{name:8} {:6}  {which}", numbers.len()).trim_end().to_owned());
    }
    if let Some(seconds) = status.seconds_to_end.filter(|_| !status.is_complete()) {
        let left = Duration::from_secs_f64(seconds.ceil());
        lines.push(format!("about {} to the end", indicatif::HumanDuration(left)));
    }
    lines.push(String::new());
    lines.join("\n")
}

/// Numbers as ranges, which array jobs take: 0-3,7.
fn ranges(numbers: &[u32]) -> String {
    let mut ranges: Vec<[u32; 2]> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == *number => *last = *number,
            _ => ranges.push([*number; 2]),
        }
    }
    let shown = |[from, to]: &[u32; 2]| {
        if from == to { from.to_string() } else { format!("{from}-{to}") }
    };
    ranges.iter().map(shown).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::ranges;

    #[test]
    fn numbers_in_a_row_are_a_range() {
        assert_eq!(ranges(&[0, 1, 2, 5, 7, 8]), "0-2,5,7-8");
        assert_eq!(ranges(&[4]), "4");
    }
}
