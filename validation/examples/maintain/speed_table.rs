//! Puts the figures of a bench into a page: `cargo maintain speed-table`.

use super::blocks;
use anyhow::Result;
use percuss_validation::bench::{Bench, summary};
use std::path::PathBuf;

/// Put the figures of percuss bench into docs/SPEED.md or docs/PERFORMANCE.md
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The bench.json of a bench
    bench: PathBuf,
    /// The page to write
    page: PathBuf,
}

pub(crate) fn run(Arguments { bench, page }: &Arguments) -> Result<()> {
    blocks::replace(page, &[("bench", block(&blocks::read_json(bench)?))])
}

/// The block of a page: which program ran where, and the summary that `bench` prints.
fn block(bench: &Bench) -> String {
    let build = &bench.build;
    format!(
        "```text\npercuss {} at {}, {}, on {}, {} rounds\n{}```\n",
        build.percuss,
        build.commit.as_deref().unwrap_or("unknown"),
        build.rustc,
        build.cpu,
        bench.rounds,
        summary(bench)
    )
}
