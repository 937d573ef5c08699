//! Reads cases from inside the binary or from a folder.

use super::Case;
use super::bound::Shortcoming;
use super::classes::read_classes;
use super::expectations::{Defaults, read_bounds};
use super::located::{FileError, read_text};
use super::shortcomings::read_shortcomings;
use super::system_case::{is_of_a_system, parse_system_case};
use super::wire::parse_oscillator_case;
use include_dir::{Dir, include_dir};
use std::path::{Path, PathBuf};

static CASES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/cases");
const BOUNDS: &str = include_str!("../../bounds.toml");
const CLASSES: &str = include_str!("../../classes.toml");
const SHORTCOMINGS: &str = include_str!("../../shortcomings.toml");

/// The cases inside the binary: those in the oscillator's own words, then those of systems, each by
/// name.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn embedded() -> Result<Vec<Case>, FileError> {
    let mut cases = Vec::new();
    collect(&CASES, &mut cases)?;
    ordered(cases)
}

/// The cases of a folder and the folders in it, in the order of [`embedded`]; the systems' files
/// are beside their cases, or inside the binary.
///
/// # Errors
/// [`FileError`] for the first file that cannot be read or understood, or a folder without cases.
pub fn from_directory(folder: &Path) -> Result<Vec<Case>, FileError> {
    let read =
        |path: PathBuf| parse_case(&path.display().to_string(), &read_text(&path)?, path.parent());
    let cases = case_files(folder)?.into_iter().map(read).collect::<Result<Vec<_>, _>>()?;
    if cases.is_empty() {
        return Err(FileError::new(&folder.display().to_string(), "holds no case (*.toml)"));
    }
    ordered(cases)
}

fn collect(folder: &Dir<'_>, cases: &mut Vec<Case>) -> Result<(), FileError> {
    for file in folder.files().filter(|file| is_case(file.path())) {
        let name = format!("cases/{}", file.path().display());
        let text = file.contents_utf8().ok_or_else(|| FileError::new(&name, "not UTF-8"))?;
        cases.push(parse_case(&name, text, None)?);
    }
    folder.dirs().try_for_each(|inner| collect(inner, cases))
}

/// Reads one case; `file` is what errors call it, and `folder` holds the systems' files that are
/// not inside the binary.
///
/// # Errors
/// [`FileError`] names the file's line, the field, its value and what is accepted.
pub fn parse_case(file: &str, text: &str, folder: Option<&Path>) -> Result<Case, FileError> {
    if is_of_a_system(text) {
        parse_system_case(file, text, folder)
    } else {
        parse_oscillator_case(file, text)
    }
}

fn ordered(mut cases: Vec<Case>) -> Result<Vec<Case>, FileError> {
    let mut names: Vec<_> = cases.iter().map(|it| it.name.as_str()).collect();
    names.sort_unstable();
    if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(FileError(format!("two cases are called {:?}", pair[0])));
    }
    cases.sort_by(|a, b| {
        a.oscillator.is_none().cmp(&b.oscillator.is_none()).then(a.name.cmp(&b.name))
    });
    Ok(cases)
}

fn case_files(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    let unreadable = |error: std::io::Error| {
        FileError(format!(
            "{}: cannot be read ({error}); accepted is a folder of cases",
            folder.display()
        ))
    };
    let mut files = Vec::new();
    for item in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = item.map_err(unreadable)?.path();
        if path.is_dir() {
            files.extend(case_files(&path)?);
        } else if is_case(&path) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// Whether a file is a case; that of a system is none.
fn is_case(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    name.ends_with(".toml") && !name.ends_with(".system.toml")
}

/// The bounds and expected failures on cases inside the binary, which come after a case's own.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn defaults() -> Result<Defaults, FileError> {
    let shortcomings = read_shortcomings("shortcomings.toml", SHORTCOMINGS)?;
    Ok(Defaults { shortcomings, ..bounds_alone()? })
}

/// The expected failures in a file of their own, as of engines that are not of this program.
///
/// # Errors
/// [`FileError`] for a file that cannot be read or understood.
pub fn shortcomings_of(path: &Path) -> Result<Vec<Shortcoming>, FileError> {
    let text = read_text(path)?;
    read_shortcomings(&path.display().to_string(), &text)
}

/// The bounds alone, for a user's own cases and for answers in files: an expected failure is of one
/// engine, in the version that is built in, on the cases inside the binary.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn bounds_alone() -> Result<Defaults, FileError> {
    let classes = read_classes("classes.toml", CLASSES)?;
    Ok(Defaults { classes, ..read_bounds("bounds.toml", BOUNDS)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn embedded_cases_and_bounds_are_accepted() {
        let cases = embedded().map_err(|error| error.to_string());
        assert!(cases.as_ref().is_ok_and(|cases| cases.len() >= 16), "{cases:?}");
        assert_eq!(defaults().map(|_| ()), Ok(()));
    }
}
