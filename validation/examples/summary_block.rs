//! Puts the summary of a run of `validate` into README.md.
//!
//! ```sh
//! cargo run --release -- validate --out target/quick |
//!   cargo run --release -p percuss-validation --example summary_block -- \
//!   target/quick/report.json README.md
//! ```

use anyhow::{Context, Result, ensure};
use serde_json::Value;
use std::io::Read;

const BEGIN: &str = "<!-- begin: summary -->\n";
const END: &str = "<!-- end: summary -->";

fn main() -> Result<()> {
    let usage = "takes the report.json of a run and the README.md to write; its summary on stdin";
    let [report, readme]: [String; 2] =
        std::env::args().skip(1).collect::<Vec<_>>().try_into().ok().context(usage)?;
    let mut summary = String::new();
    std::io::stdin().read_to_string(&mut summary)?;
    let text = std::fs::read_to_string(&report).with_context(|| report.clone())?;
    let block = block(&serde_json::from_str(&text)?, &summary)?;
    let old = std::fs::read_to_string(&readme).with_context(|| readme.clone())?;
    let (before, rest) = old.split_once(BEGIN).context("README.md has no block of the summary")?;
    let (_, after) = rest.split_once(END).context("the block does not end")?;
    std::fs::write(&readme, format!("{before}{BEGIN}{block}{END}{after}"))?;
    Ok(())
}

fn block(report: &Value, summary: &str) -> Result<String> {
    ensure!(summary.starts_with("#  engine"), "no summary on stdin");
    let text = |key: &str| report[key].as_str().unwrap_or("unknown").to_owned();
    let (version, commit, suite, cpu) =
        (text("percuss"), text("commit"), text("suite"), text("cpu"));
    Ok(format!("```text\npercuss {version} at {commit}, suite {suite}, on {cpu}\n{summary}```\n"))
}
