//! Verbs of periodic orbits: `orbit` finds one, `continue` follows it.

pub(super) mod find;
pub(super) mod follow;
pub(super) mod json;

use clap::ValueEnum;

/// The output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    Json,
}

/// A period as it is accepted.
fn period(text: &str) -> Result<u32, String> {
    let largest = percuss::dynamics::orbit::LARGEST_PERIOD;
    let period = text.parse().ok().filter(|period| (1..=largest).contains(period));
    period.ok_or_else(|| format!("accepted is an integer, 1 to {largest}"))
}
