//! Puts the figures of a `bench` into a page that has a block for them.
//!
//! ```sh
//! cargo run --release -- bench --out target/bench
//! cargo run --release -p percuss-validation --example speed_table -- \
//!   target/bench/bench.json docs/SPEED.md
//! ```

use anyhow::{Context, Result};
use percuss_validation::bench::{Bench, summary};
use std::path::Path;

const BEGIN: &str = "<!-- begin: bench -->\n";
const END: &str = "<!-- end: bench -->";

fn main() -> Result<()> {
    let usage = "takes the bench.json of a bench and the page to write";
    let [bench, page]: [String; 2] =
        std::env::args().skip(1).collect::<Vec<_>>().try_into().ok().context(usage)?;
    let block = block(&read(Path::new(&bench))?);
    let old = std::fs::read_to_string(&page).with_context(|| page.clone())?;
    let without = || format!("{page} has no block of the bench");
    let (before, rest) = old.split_once(BEGIN).with_context(without)?;
    let (_, after) = rest.split_once(END).context("the block does not end")?;
    std::fs::write(&page, format!("{before}{BEGIN}{block}{END}{after}"))?;
    Ok(())
}

/// A bench that was written before.
pub fn read(file: &Path) -> Result<Bench> {
    let text = std::fs::read_to_string(file).with_context(|| file.display().to_string())?;
    serde_json::from_str(&text).with_context(|| file.display().to_string())
}

/// The block of a page: which program ran where, and the summary that `bench` prints.
pub fn block(bench: &Bench) -> String {
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
