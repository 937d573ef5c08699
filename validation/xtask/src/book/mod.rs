//! The book: the repository's pages in the order of docs/SUMMARY.md, built by mdBook.
//!
//! Pages stay where they are read on the repository's site too. A link in them that leads to a
//! source file, which the book does not have, leads to the repository's site there.
//!
//! [`links`] finds the links of a page, [`sources`] makes them good, [`reference`] writes the pages
//! that are generated. Read `sources` first.

mod links;
mod reference;
mod sources;

use crate::process::Folder;
use anyhow::{Context, Result, ensure};
use sources::Sources;

/// The folder of the book: `src` has its sources, `html` its pages.
const BOOK_FOLDER: &str = "target/book";

/// Build the book of all pages into target/book/html
///
/// The order of the pages is that of docs/SUMMARY.md. It is an error where a page has no place in
/// it, and where a link leads to no file or no heading. The reference is generated: the program is
/// built for its help.
#[derive(clap::Args)]
pub struct Arguments {}

pub fn run(root: &Folder, Arguments {}: &Arguments) -> Result<()> {
    let mut sources = Sources::collect(root)?;
    ensure!(root.succeeds("mdbook", &["--version"]), "needs `cargo install mdbook --locked`");
    sources.generate(root)?;
    let book = root.path(BOOK_FOLDER);
    if book.exists() {
        std::fs::remove_dir_all(&book).with_context(|| BOOK_FOLDER.to_owned())?;
    }
    sources.write(root, &book)?;
    root.run("mdbook", &["build", BOOK_FOLDER])
}
