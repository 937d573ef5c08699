//! All faults of the chosen files, with their edits.

use crate::fault::{Change, Fault, Operator};
use crate::operators::instead_of_float;
use crate::places::{Named, Places};
use crate::rewrite::Edit;
use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A source file and the edits of its faults.
pub struct Source {
    /// Its text without faults.
    pub text: String,
    /// The edits of all faults in it.
    pub edits: Vec<Edit>,
}

/// All faults.
pub struct Catalogue {
    /// In the order of the sources.
    pub faults: Vec<Fault>,
    /// By path relative to the root of the repository.
    pub sources: BTreeMap<String, Source>,
}

impl Catalogue {
    /// Reads the target files and folders.
    pub fn read(root: &Path, targets: &[String]) -> Result<Self> {
        let mut files = Vec::new();
        for target in targets {
            collect(&root.join(target), &mut files)?;
        }
        let mut catalogue = Self { faults: Vec::new(), sources: BTreeMap::new() };
        let mut constants = Vec::new();
        let mut uses = Vec::new();
        for path in files {
            let name = path.strip_prefix(root)?.to_string_lossy().into_owned();
            let text = std::fs::read_to_string(&path).with_context(|| name.clone())?;
            let places = Places::find(&text).with_context(|| name.clone())?;
            let (changes, defined) = (places.changes, places.constants);
            uses.extend(places.uses.into_iter().map(|(used, at)| (name.clone(), used, at)));
            constants.extend(defined.into_iter().map(|(it, value)| (name.clone(), it, value)));
            catalogue.sources.insert(name.clone(), Source { text, edits: Vec::new() });
            changes.into_iter().for_each(|change| catalogue.add(&name, change));
        }
        for (file, constant, named) in &constants {
            // A constant of the same name in the file itself is the one meant there.
            let own = |at: &str| constants.iter().any(|(f, c, _)| f == at && c == constant);
            let meant = |at: &str| at == file || !own(at);
            let places: Vec<_> =
                uses.iter().filter(|(at, used, _)| used == constant && meant(at)).collect();
            catalogue.add_constant(file, constant, named, &places);
        }
        Ok(catalogue)
    }

    fn add(&mut self, file: &str, change: Change) {
        let Change { place, operator, replacement } = change;
        let number = self.record(file, place.clone(), operator, &replacement);
        if let Some(source) = self.sources.get_mut(file) {
            source.edits.push(Edit { place, number, replacement });
        }
    }

    /// A constant changes wherever it is used at run time.
    fn add_constant(
        &mut self,
        file: &str,
        name: &str,
        named: &Named,
        places: &[&(String, String, std::ops::Range<usize>)],
    ) {
        let instead = |text: &str| {
            if named.is_float {
                instead_of_float(text, false)
            } else {
                vec![format!("({text} + 1)")]
            }
        };
        if places.is_empty() {
            return;
        }
        for (kind, replacement) in instead(name).into_iter().enumerate() {
            let number = self.record(file, named.value.clone(), Operator::Constant, &replacement);
            for (at, _, place) in places {
                let Some(source) = self.sources.get_mut(at) else { continue };
                let text = source.text[place.clone()].to_owned();
                let replacement = instead(&text).swap_remove(kind);
                source.edits.push(Edit { place: place.clone(), number, replacement });
            }
        }
    }

    fn record(
        &mut self,
        file: &str,
        place: std::ops::Range<usize>,
        operator: Operator,
        replacement: &str,
    ) -> u32 {
        let number = self.faults.len() as u32 + 1;
        let text = self.sources.get(file).map_or("", |source| source.text.as_str());
        let line = text[..place.start].matches('\n').count() + 1;
        let context = one_line(text.lines().nth(line - 1).unwrap_or_default());
        let original = one_line(&text[place]);
        let (file, replacement) = (file.to_owned(), one_line(replacement));
        let alike = |it: &&Fault| {
            (&it.file, it.operator) == (&file, operator)
                && (&it.original, &it.replacement) == (&original, &replacement)
                && it.context == context
        };
        let alike = self.faults.iter().filter(alike).count();
        self.faults.push(Fault {
            number,
            file,
            line,
            operator,
            original,
            replacement,
            context,
            alike,
        });
        number
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    if path.is_dir() {
        let entries = std::fs::read_dir(path)?.map(|it| Ok(it?.path()));
        let mut entries: Vec<_> = entries.collect::<Result<_>>()?;
        entries.sort();
        entries.iter().try_for_each(|entry| collect(entry, files))?;
    } else if !path.exists() {
        anyhow::bail!("there is no {}", path.display());
    } else if path.extension().is_some_and(|it| it == "rs") && !is_tests(path) {
        files.push(path.to_owned());
    }
    Ok(())
}

/// Unit tests in a file of their own.
fn is_tests(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| {
        let stem = stem.to_string_lossy();
        stem == "tests" || stem.ends_with("_tests")
    })
}
