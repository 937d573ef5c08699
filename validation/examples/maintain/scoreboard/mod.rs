//! The scoreboard of one report or several: `cargo maintain scoreboard`.

pub(crate) mod board;
pub(crate) mod page;
pub(crate) mod read;

use super::blocks;
use anyhow::{Context, Result};
use board::Board;
use std::path::PathBuf;

/// The name of the page's block.
pub(crate) const BLOCK: &str = "scoreboard";

/// Put the scoreboard of reports into docs/SCOREBOARD.md, and make its HTML page
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The Markdown page to write
    markdown: PathBuf,
    /// The HTML page to make
    html: PathBuf,
    /// The report.json of each run
    #[arg(required = true)]
    reports: Vec<PathBuf>,
}

pub(crate) fn run(Arguments { markdown, html, reports }: &Arguments) -> Result<()> {
    let reports = reports.iter().map(|it| read::report(it)).collect::<Result<Vec<_>>>()?;
    let board = Board::new(&reports)?;
    std::fs::write(html, page::html(&board)?).with_context(|| html.display().to_string())?;
    blocks::replace(markdown, &[(BLOCK, page::markdown(&board))])
}
