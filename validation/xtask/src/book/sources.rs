//! The sources of the book: pages with their links made good, and what pages show.

use super::links;
use super::reference::{self, KEYS, VERBS};
use crate::process::Folder;
use anyhow::{Context, Result, bail, ensure};
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

/// The order of the pages, and the folder that its links are relative to.
const SUMMARY: &str = "docs/SUMMARY.md";

/// The folders whose pages have to have a place.
const FOLDERS: [&str; 3] = ["", "docs", "docs/archive"];

/// The folder whose files that are no pages the book has too, such as pictures.
const FILE_FOLDER: &str = "docs";

/// The settings of mdBook, by their names in the repository and in the book's folder.
const SETTINGS: [[&str; 2]; 2] = [["docs/book.toml", "book.toml"], ["docs/wide.css", "wide.css"]];

/// The page that the book opens with, and its name there: mdBook renames it, and not what links it.
const FIRST_PAGE: [&str; 2] = ["README.md", "index.md"];

/// The branch whose files links lead to.
const BRANCH: &str = "main";

/// The sources of the book, by their paths from the repository's root.
pub struct Sources {
    /// The address of the repository's site.
    site: String,
    summary: String,
    pages: Vec<(PathBuf, String)>,
    shown: BTreeSet<PathBuf>,
}

impl Sources {
    /// Reads the pages; fails where one has no place, or a link leads nowhere.
    pub fn collect(root: &Folder) -> Result<Self> {
        let folder = Path::new(FILE_FOLDER);
        let summary = root.read(SUMMARY)?;
        let order = links::targets(&summary)?;
        let order: Vec<PathBuf> = order.iter().map(|page| below_root(folder, page)).collect();
        complete(root, &order)?;
        let mut sources = Self {
            site: site(root)?,
            summary: links::replaced(&summary, |page| {
                Ok(book_path(&slashed(&below_root(folder, page))))
            })?,
            pages: Vec::new(),
            shown: BTreeSet::new(),
        };
        for path in order.iter().filter(|path| !is_generated(path)) {
            let text = root.read(&slashed(path))?;
            sources.add(root, (path, &order), &text)?;
        }
        Ok(sources)
    }

    /// Adds the pages that are generated, for which the program is built and run.
    pub fn generate(&mut self, root: &Folder) -> Result<()> {
        for (path, text) in [(VERBS, reference::verbs(root)?), (KEYS, reference::keys(root)?)] {
            self.add(root, (Path::new(path), &[]), &text)?;
        }
        Ok(())
    }

    /// Adds a page with its links made good.
    fn add(&mut self, root: &Folder, (page, order): (&Path, &[PathBuf]), text: &str) -> Result<()> {
        let moved = |target: &str| self.moved(root, (page, order), target);
        let text = links::replaced(text, moved).with_context(|| slashed(page))?;
        self.pages.push((page.to_owned(), text));
        Ok(())
    }

    /// Writes the sources and the settings into a folder.
    pub fn write(&self, root: &Folder, book: &Path) -> Result<()> {
        let source = book.join("src");
        let file = |path: &Path| -> Result<PathBuf> {
            let file = source.join(path);
            let folder = file.parent().context("a file has a folder")?;
            std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
            Ok(file)
        };
        std::fs::write(file(Path::new("SUMMARY.md"))?, &self.summary)?;
        for (path, text) in &self.pages {
            let path = book_path(&slashed(path));
            std::fs::write(file(Path::new(&path))?, text).context(path)?;
        }
        for path in &self.shown {
            std::fs::copy(root.path(&slashed(path)), file(path)?).with_context(|| slashed(path))?;
        }
        for [from, to] in SETTINGS {
            std::fs::copy(root.path(from), book.join(to)).with_context(|| from.to_owned())?;
        }
        Ok(())
    }

    /// The target of a page's link, as the book has it.
    fn moved(
        &mut self,
        root: &Folder,
        (page, order): (&Path, &[PathBuf]),
        target: &str,
    ) -> Result<String> {
        let (path, anchor) = target.split_once('#').map_or((target, None), |(p, a)| (p, Some(a)));
        let path = match path {
            "" => page.to_owned(),
            path => below_root(page.parent().unwrap_or(Path::new("")), path),
        };
        if is_generated(&path) {
            return Ok(target.to_owned());
        }
        let there = root.path(&slashed(&path));
        ensure!(there.exists(), "the link to {target} leads nowhere");
        if order.contains(&path) {
            let anchors = links::anchors(&root.read(&slashed(&path))?);
            let leads = anchor.is_none_or(|anchor| anchors.contains(anchor));
            ensure!(leads, "the link to {target} leads to no heading");
            return Ok(book_path(target));
        }
        if path.starts_with(FILE_FOLDER) && there.is_file() {
            self.shown.insert(path);
            return Ok(target.to_owned());
        }
        let kind = if there.is_dir() { "tree" } else { "blob" };
        let anchor = anchor.map(|it| format!("#{it}")).unwrap_or_default();
        Ok(format!("{}/{kind}/{BRANCH}/{}{anchor}", self.site, slashed(&path)))
    }
}

/// Whether a page is generated when the book is built.
fn is_generated(page: &Path) -> bool {
    [VERBS, KEYS].contains(&slashed(page).as_str())
}

/// A path with slashes on every platform.
fn slashed(path: &Path) -> String {
    let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
    parts.join("/")
}

/// The path of a page as the book names it.
fn book_path(page: &str) -> String {
    page.replace(FIRST_PAGE[0], FIRST_PAGE[1])
}

/// The path from the root of what is linked from a folder.
fn below_root(folder: &Path, target: &str) -> PathBuf {
    let mut path = PathBuf::new();
    for part in folder.join(target).components() {
        match part {
            Component::ParentDir => {
                path.pop();
            }
            Component::Normal(name) => path.push(name),
            _ => {}
        }
    }
    path
}

/// Fails where a page of the folders has no place in the order, or has two.
fn complete(root: &Folder, order: &[PathBuf]) -> Result<()> {
    let placed: BTreeSet<&PathBuf> = order.iter().collect();
    ensure!(placed.len() == order.len(), "{SUMMARY} names a page twice");
    for folder in FOLDERS {
        let entries = std::fs::read_dir(root.path(folder)).with_context(|| folder.to_owned())?;
        for entry in entries {
            let path = Path::new(folder).join(entry?.file_name());
            let is_page = path.extension().is_some_and(|it| it == "md");
            if is_page && slashed(&path) != SUMMARY && !placed.contains(&path) {
                bail!("{} has no place in {SUMMARY}", slashed(&path));
            }
        }
    }
    Ok(())
}

/// The address of the repository's site.
fn site(root: &Folder) -> Result<String> {
    let manifest: toml_edit::DocumentMut = root.read("Cargo.toml")?.parse()?;
    let site = manifest["workspace"]["package"]["repository"].as_str();
    Ok(site.context("Cargo.toml names no repository")?.to_owned())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    #[test]
    fn every_page_has_its_place_and_every_link_leads_somewhere() {
        let sources = Sources::collect(&Folder::of_the_repository().unwrap()).unwrap();
        let site = "https://github.com/percuss/percuss/blob/main/";
        assert!(sources.pages.iter().any(|(_, text)| text.contains(site)));
        assert!(sources.summary.contains("](docs/RIG.md)"), "{}", sources.summary);
        assert!(sources.summary.contains("](BIAS.md)"), "{}", sources.summary);
        assert!(sources.shown.contains(Path::new("docs/rig-basins.png")));
    }

    fn repository(summary: &str, page: &str) -> (tempfile::TempDir, Folder) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("docs/archive")).unwrap();
        let write = |path: &str, text: &str| std::fs::write(folder.path().join(path), text);
        write("Cargo.toml", "[workspace.package]\nrepository = \"https://site\"\n").unwrap();
        write(SUMMARY, summary).unwrap();
        write("README.md", page).unwrap();
        write("docs/A.md", "# A").unwrap();
        let root = Folder::at(folder.path());
        (folder, root)
    }

    const SOUND_README: &str = "[r](../README.md)\n\n- [a](A.md)\n";

    #[test]
    fn what_the_book_has_not_is_on_the_site() {
        let (_held, root) = repository(SOUND_README, "[a](docs/A.md) [c](Cargo.toml#L1) [d](docs)");
        let sources = Sources::collect(&root).unwrap();
        let text = "[a](docs/A.md) [c](https://site/blob/main/Cargo.toml#L1) \
                    [d](https://site/tree/main/docs)";
        assert_eq!(sources.pages[0].1, text);
    }

    #[test]
    fn errors_name_the_page() {
        for (summary, page, error) in [
            ("[r](../README.md)\n", "", "docs/A.md has no place in docs/SUMMARY.md"),
            (SOUND_README, "[b](docs/B.md)", "README.md: the link to docs/B.md leads nowhere"),
            (
                SOUND_README,
                "[b](docs/A.md#c)",
                "README.md: the link to docs/A.md#c leads to no heading",
            ),
            ("[r](../README.md)\n\n- [a](A.md)\n- [a](A.md)\n", "", "names a page twice"),
        ] {
            let (_held, root) = repository(summary, page);
            let said = Sources::collect(&root).err().map(|error| format!("{error:#}"));
            assert!(said.as_ref().is_some_and(|said| said.contains(error)), "{said:?}");
        }
    }
}
