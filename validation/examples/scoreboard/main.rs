//! Puts the scoreboard of one report or several into docs/SCOREBOARD.md, and makes its HTML page.
//!
//! ```sh
//! cargo run --release -p percuss-validation --example scoreboard -- \
//!   docs/SCOREBOARD.md docs/scoreboard.html target/full/report.json...
//! ```

pub(crate) mod board;
pub(crate) mod page;
pub(crate) mod read;

use anyhow::{Context, Result, bail};
use board::Board;

const BEGIN: &str = "<!-- begin: scoreboard -->\n";
const END: &str = "<!-- end: scoreboard -->";

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [markdown, html, reports @ ..] = words.as_slice() else {
        bail!("takes the Markdown page to write, the HTML page, and the report.json of runs");
    };
    if reports.is_empty() {
        bail!("takes the report.json of one run or more after the two pages");
    }
    let old = std::fs::read_to_string(markdown).with_context(|| markdown.clone())?;
    let board = Board::of(&reports.iter().map(|it| read::report(it)).collect::<Result<Vec<_>>>()?)?;
    std::fs::write(html, page::html(&board)?).with_context(|| html.clone())?;
    std::fs::write(markdown, spliced(&old, &page::markdown(&board))?)
        .with_context(|| markdown.clone())
}

/// A page with another block between the marks.
pub(crate) fn spliced(old: &str, block: &str) -> Result<String> {
    let (before, rest) =
        old.split_once(BEGIN).context("the page has no block of the scoreboard")?;
    let (_, after) = rest.split_once(END).context("the block does not end")?;
    Ok(format!("{before}{BEGIN}{block}{END}{after}"))
}
