//! The blocks of a page that are generated: each between `<!-- begin: NAME -->` and
//! `<!-- end: NAME -->`.

use anyhow::{Context, Result};
use serde::de::DeserializeOwned;
use std::path::Path;

/// Writes a page anew with other blocks.
pub(crate) fn replace(page: &Path, blocks: &[(&str, String)]) -> Result<()> {
    let old = read(page)?;
    let new = blocks.iter().try_fold(old, |text, (name, block)| replaced(&text, name, block));
    let shown = || page.display().to_string();
    std::fs::write(page, new.with_context(shown)?).with_context(shown)
}

/// The text of a page with another block, which ends with a line's end.
pub(crate) fn replaced(page: &str, name: &str, block: &str) -> Result<String> {
    let (begin, end) = (format!("<!-- begin: {name} -->\n"), format!("<!-- end: {name} -->"));
    let lacks = || format!("the page has no block `{name}`");
    let (before, rest) = page.split_once(&begin).with_context(lacks)?;
    let (_, after) = rest.split_once(&end).with_context(lacks)?;
    Ok(format!("{before}{begin}{block}{end}{after}"))
}

/// The text of a file.
pub(crate) fn read(file: &Path) -> Result<String> {
    std::fs::read_to_string(file).with_context(|| file.display().to_string())
}

/// The value that a file of JSON holds.
pub(crate) fn read_json<T: DeserializeOwned>(file: &Path) -> Result<T> {
    serde_json::from_str(&read(file)?).with_context(|| file.display().to_string())
}
