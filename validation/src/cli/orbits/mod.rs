//! Verbs of periodic orbits: `orbit` finds one, `continue` follows it.

pub(super) mod find;
pub(super) mod follow;
pub(super) mod json;
mod of_system;
mod table;

use clap::ValueEnum;

/// The output format of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    Json,
    Png,
    Svg,
}
