//! Where cases come from: inside the binary, or a folder.

use super::Case;
use super::expectations::{Defaults, read_bounds};
use super::known::read_shortcomings;
use super::located::FileError;
use super::wire::parse_case;
use include_dir::{Dir, include_dir};
use std::path::{Path, PathBuf};

static CASES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/cases");
const BOUNDS: &str = include_str!("../../bounds.toml");
const SHORTCOMINGS: &str = include_str!("../../shortcomings.toml");

/// The cases inside the binary, by name.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn embedded() -> Result<Vec<Case>, FileError> {
    let mut cases = Vec::new();
    collect(&CASES, &mut cases)?;
    ordered(cases)
}

fn collect(folder: &Dir<'_>, cases: &mut Vec<Case>) -> Result<(), FileError> {
    for file in folder.files().filter(|file| is_case(file.path())) {
        let name = format!("cases/{}", file.path().display());
        let text = file.contents_utf8().ok_or_else(|| FileError::of(&name, "not UTF-8"))?;
        cases.push(parse_case(&name, text)?);
    }
    folder.dirs().try_for_each(|inner| collect(inner, cases))
}

/// The cases of a folder and the folders in it, by name.
///
/// # Errors
/// [`FileError`] for the first file that cannot be read or understood, or a folder without cases.
pub fn from_directory(folder: &Path) -> Result<Vec<Case>, FileError> {
    let mut cases = Vec::new();
    for path in case_files(folder)? {
        let text =
            std::fs::read_to_string(&path).map_err(|error| FileError::unreadable(&path, &error))?;
        cases.push(parse_case(&path.display().to_string(), &text)?);
    }
    if cases.is_empty() {
        return Err(FileError::of(&folder.display().to_string(), "holds no case (*.toml)"));
    }
    ordered(cases)
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

fn is_case(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "toml")
}

fn ordered(mut cases: Vec<Case>) -> Result<Vec<Case>, FileError> {
    cases.sort_by(|a, b| a.name.cmp(&b.name));
    match cases.windows(2).find(|pair| pair[0].name == pair[1].name) {
        Some(pair) => Err(FileError(format!("two cases are called {:?}", pair[0].name))),
        None => Ok(cases),
    }
}

/// What is expected on every case inside the binary, after what the case says itself.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn defaults() -> Result<Defaults, FileError> {
    let bounds = read_bounds("bounds.toml", BOUNDS)?;
    Ok(Defaults { bounds, shortcomings: read_shortcomings("shortcomings.toml", SHORTCOMINGS)? })
}

/// What is expected on a case of a user's own: the bounds alone, because the shortcomings that are
/// known were seen on the cases inside the binary.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn defaults_of_own_cases() -> Result<Defaults, FileError> {
    Ok(Defaults { bounds: read_bounds("bounds.toml", BOUNDS)?, ..Defaults::default() })
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
