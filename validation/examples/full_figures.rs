//! Puts the figures of a run of the full suite into README.md.
//!
//! ```sh
//! cargo run --release -- validate --suite full --out target/full |
//!   cargo run --release -p percuss-validation --example full_figures -- target/full/report.json README.md
//! ```

use anyhow::{Context, Result, ensure};
use serde_json::Value;
use std::fmt::Write;
use std::io::Read;

const BEGIN: &str = "<!-- begin: full suite -->\n";
const END: &str = "<!-- end: full suite -->";
/// What the rows say together, at the end of the table for people.
const TOLD: [&str; 4] = ["not run: ", "order: ", "valid horizon: ", "power: "];

fn main() -> Result<()> {
    let usage =
        "takes the report.json of a full run and the README.md to write; its table on stdin";
    let [report, readme]: [String; 2] =
        std::env::args().skip(1).collect::<Vec<_>>().try_into().ok().context(usage)?;
    let mut table = String::new();
    std::io::stdin().read_to_string(&mut table)?;
    let text = std::fs::read_to_string(&report).with_context(|| report.clone())?;
    let block = block(&serde_json::from_str(&text)?, &table)?;
    let old = std::fs::read_to_string(&readme).with_context(|| readme.clone())?;
    let (before, rest) =
        old.split_once(BEGIN).context("README.md has no block of the full suite")?;
    let (_, after) = rest.split_once(END).context("the block does not end")?;
    std::fs::write(&readme, format!("{before}{BEGIN}{block}{END}{after}"))?;
    Ok(())
}

fn block(report: &Value, table: &str) -> Result<String> {
    ensure!(report["suite"] == "full", "the report is not of the full suite");
    let results = report["results"].as_array().context("no results")?;
    let mut cases: Vec<_> = results.iter().filter_map(|row| row["case"].as_str()).collect();
    cases.dedup();
    let engines = report["engines"].as_array().map_or(0, Vec::len);
    let mut block = String::from("```text\n");
    let [version, commit] = [&report["percuss"], &report["commit"]].map(|it| it.as_str());
    let (version, commit) = (version.unwrap_or_default(), commit.unwrap_or("unknown"));
    writeln!(
        block,
        "percuss {version} at {commit}, on {}",
        report["cpu"].as_str().unwrap_or_default()
    )?;
    writeln!(block, "{} rows: {engines} engines on {} cases", results.len(), cases.len())?;
    block.push_str(&exact(results)?);
    let summary = table.lines().last().context("no table on stdin")?;
    let told = table.lines().filter(|line| TOLD.iter().any(|word| line.starts_with(word)));
    for line in told.chain([summary]) {
        writeln!(block, "{line}")?;
    }
    block.push_str("```\n");
    Ok(block)
}

/// The largest figures of the exact solver over all cases.
fn exact(results: &[Value]) -> Result<String> {
    let rows: Vec<_> = results.iter().filter(|row| row["engine"] == "exact").collect();
    let bound = |quantity: &str, statistic: &str| {
        let bounds = rows.iter().flat_map(|row| row["bounds"].as_array().into_iter().flatten());
        let own = bounds.filter(|it| it["quantity"] == quantity && it["statistic"] == statistic);
        own.filter_map(|it| it["value"].as_f64()).fold(f64::NAN, f64::max)
    };
    let sum = |key: &str| rows.iter().filter_map(|row| row[key].as_u64()).sum::<u64>();
    let restarts = rows.iter().filter_map(|row| row["restart"]["with_impact"].as_u64());
    let mut text = String::new();
    writeln!(
        text,
        "exact: {} switches, {} missed, {} invented; errors at switches up to {:.2}, at samples up to {:.2} eps \
         (1 + |value|) growth switches",
        sum("events_expected"),
        sum("events_missed"),
        sum("events_spurious"),
        bound("event_constant", "max"),
        bound("state_constant", "max"),
    )?;
    writeln!(
        text,
        "exact: {} restarts with an impact; largest median of a case {:.2}, largest of all {:.2} eps \
         (1 + |value|) growth",
        restarts.sum::<u64>(),
        bound("restart_error", "median"),
        bound("restart_error", "max"),
    )?;
    Ok(text)
}
