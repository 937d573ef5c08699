//! Puts the summary of a run of `validate --details` into docs/RESULTS.md: the first screen in one
//! block, the details that are printed above it in another.
//!
//! ```sh
//! cargo run --release -- validate --details --power --out target/quick |
//!   cargo run --release -p percuss-validation --example summary_block -- \
//!   target/quick/report.json docs/RESULTS.md
//! ```

use anyhow::{Context, Result};
use serde_json::Value;
use std::io::Read;

const SUMMARY: &str = "summary";
const DETAILS: &str = "details";
/// The words with which the first screen begins.
const FIRST_SCREEN: &str = "Which integrator, at what tolerance?";

fn main() -> Result<()> {
    let usage = "takes the report.json of a run and the page to write; its summary on stdin";
    let [report, page_file]: [String; 2] =
        std::env::args().skip(1).collect::<Vec<_>>().try_into().ok().context(usage)?;
    let mut summary = String::new();
    std::io::stdin().read_to_string(&mut summary)?;
    let text = std::fs::read_to_string(&report).with_context(|| report.clone())?;
    let place = summary.find(FIRST_SCREEN).context("no summary on stdin")?;
    let (details, ranking) = summary.split_at(place);
    let ranking = headline(&serde_json::from_str(&text)?) + ranking;
    let page = std::fs::read_to_string(&page_file).with_context(|| page_file.clone())?;
    let page = spliced(&page, SUMMARY, &ranking)?;
    std::fs::write(&page_file, spliced(&page, DETAILS, &format!("{}\n", details.trim_end()))?)?;
    Ok(())
}

/// A page with the text of one of its blocks made anew.
fn spliced(page: &str, block: &str, text: &str) -> Result<String> {
    let (begin, end) = (format!("<!-- begin: {block} -->\n"), format!("<!-- end: {block} -->"));
    let lacks = || format!("the page has no block `{block}`");
    let (before, rest) = page.split_once(&begin).with_context(lacks)?;
    let (_, after) = rest.split_once(&end).with_context(lacks)?;
    Ok(format!("{before}{begin}```text\n{text}```\n{end}{after}"))
}

/// The digits of the commit that a headline shows; all of them stand in the report.
const COMMIT_DIGITS: usize = 12;

/// What was run where.
fn headline(report: &Value) -> String {
    let text = |key: &str| report[key].as_str().unwrap_or("unknown").to_owned();
    let (version, commit, suite, cpu) =
        (text("percuss"), text("commit"), text("suite"), text("cpu"));
    let commit: String = commit.chars().take(COMMIT_DIGITS).collect();
    format!("percuss {version} at {commit}, suite {suite}, on {cpu}\n")
}
