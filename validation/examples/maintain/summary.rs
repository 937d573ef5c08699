//! Puts the summary of a run into docs/RESULTS.md: `cargo maintain summary`.

use super::blocks;
use anyhow::{Context, Result};
use serde_json::Value;
use std::io::Read;
use std::path::PathBuf;

/// The words with which the first screen begins.
const FIRST_SCREEN_HEADING: &str = "Which integrator, at what tolerance?";

/// Put the summary of `validate --details --power`, read from stdin, into docs/RESULTS.md
///
/// The first screen goes into one block, the details that are printed above it into another.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The report.json of the run
    report: PathBuf,
    /// The page to write
    page: PathBuf,
}

pub(crate) fn run(Arguments { report, page }: &Arguments) -> Result<()> {
    let mut printed = String::new();
    std::io::stdin().read_to_string(&mut printed)?;
    let place = printed.find(FIRST_SCREEN_HEADING).context("no summary on stdin")?;
    let (details, ranking) = printed.split_at(place);
    let ranking = headline(&blocks::read_json(report)?) + ranking;
    let fenced = |text: &str| format!("```text\n{text}\n```\n");
    let ranking = ("summary", fenced(ranking.trim_end_matches('\n')));
    blocks::replace(page, &[ranking, ("details", fenced(details.trim_end()))])
}

/// The digits of the commit that a headline shows; all of them stand in the report.
const COMMIT_DIGITS: usize = 12;

/// The line that says which version ran where.
fn headline(report: &Value) -> String {
    let text = |key: &str| report[key].as_str().unwrap_or("unknown").to_owned();
    let (version, commit, suite, cpu) =
        (text("percuss"), text("commit"), text("suite"), text("cpu"));
    let commit: String = commit.chars().take(COMMIT_DIGITS).collect();
    format!("percuss {version} at {commit}, suite {suite}, on {cpu}\n")
}
