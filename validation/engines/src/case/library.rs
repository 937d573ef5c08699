//! Reads cases from inside the binary or from a folder.

use super::Case;
use super::bound::Shortcoming;
use super::expectations::{Defaults, read_bounds};
use super::located::{FileError, read_text};
use super::shortcomings::read_shortcomings;
use super::system_case::{SystemCase, is_of_a_system, parse_system_case};
use super::wire::parse_case;
use include_dir::{Dir, include_dir};
use std::path::{Path, PathBuf};

static CASES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/cases");
const BOUNDS: &str = include_str!("../../bounds.toml");
const SHORTCOMINGS: &str = include_str!("../../shortcomings.toml");

/// Cases of the oscillator and of other systems, each by name.
#[derive(Clone, Debug, Default)]
pub struct Cases {
    /// The cases of the oscillator.
    pub oscillator: Vec<Case>,
    /// The cases of other systems.
    pub systems: Vec<SystemCase>,
}

impl Cases {
    /// The cases inside the binary.
    ///
    /// # Errors
    /// [`FileError`]; a test shows that there is none.
    pub fn embedded() -> Result<Self, FileError> {
        let mut cases = Self::default();
        cases.collect(&CASES)?;
        cases.ordered()
    }

    /// The cases of a folder and the folders in it; the systems' files are beside their cases, or
    /// inside the binary.
    ///
    /// # Errors
    /// [`FileError`] for the first file that cannot be read or understood, or a folder without
    /// cases.
    pub fn from_directory(folder: &Path) -> Result<Self, FileError> {
        let mut cases = Self::default();
        for path in case_files(folder)? {
            let text = read_text(&path)?;
            cases.read(&path.display().to_string(), &text, path.parent())?;
        }
        if cases.names().next().is_none() {
            return Err(FileError::of(&folder.display().to_string(), "holds no case (*.toml)"));
        }
        cases.ordered()
    }

    /// The names of all cases.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let systems = self.systems.iter().map(|it| it.name.as_str());
        self.oscillator.iter().map(|it| it.name.as_str()).chain(systems)
    }

    /// Keeps the cases whose names are wanted.
    pub fn retain(&mut self, wanted: impl Fn(&str) -> bool) {
        self.oscillator.retain(|it| wanted(&it.name));
        self.systems.retain(|it| wanted(&it.name));
    }

    fn collect(&mut self, folder: &Dir<'_>) -> Result<(), FileError> {
        for file in folder.files().filter(|file| is_case(file.path())) {
            let name = format!("cases/{}", file.path().display());
            let text = file.contents_utf8().ok_or_else(|| FileError::of(&name, "not UTF-8"))?;
            self.read(&name, text, None)?;
        }
        folder.dirs().try_for_each(|inner| self.collect(inner))
    }

    fn read(&mut self, name: &str, text: &str, folder: Option<&Path>) -> Result<(), FileError> {
        if is_of_a_system(text) {
            self.systems.push(parse_system_case(name, text, folder)?);
        } else {
            self.oscillator.push(parse_case(name, text)?);
        }
        Ok(())
    }

    fn ordered(mut self) -> Result<Self, FileError> {
        self.oscillator.sort_by(|a, b| a.name.cmp(&b.name));
        self.systems.sort_by(|a, b| a.name.cmp(&b.name));
        let mut names: Vec<_> = self.names().collect();
        names.sort_unstable();
        match names.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(FileError(format!("two cases are called {:?}", pair[0]))),
            None => Ok(self),
        }
    }
}

/// The oscillator's cases inside the binary, by name.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn embedded() -> Result<Vec<Case>, FileError> {
    Ok(Cases::embedded()?.oscillator)
}

/// The oscillator's cases of a folder and the folders in it, by name.
///
/// # Errors
/// Fails as [`Cases::from_directory`] does, and where no case is of the oscillator.
pub fn from_directory(folder: &Path) -> Result<Vec<Case>, FileError> {
    let cases = Cases::from_directory(folder)?.oscillator;
    if cases.is_empty() {
        let what = "holds no case of the oscillator (*.toml)";
        return Err(FileError::of(&folder.display().to_string(), what));
    }
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
    Ok(Defaults { shortcomings, ..read_bounds("bounds.toml", BOUNDS)? })
}

/// The expected failures in a file of their own, as of engines that are not of this program.
///
/// # Errors
/// [`FileError`] for a file that cannot be read or understood.
pub fn shortcomings_of(path: &Path) -> Result<Vec<Shortcoming>, FileError> {
    let text = read_text(path)?;
    read_shortcomings(&path.display().to_string(), &text)
}

/// What is expected on a case of a user's own: the bounds alone, because the shortcomings that are
/// known were seen on the cases inside the binary.
///
/// # Errors
/// [`FileError`]; a test shows that there is none.
pub fn defaults_of_own_cases() -> Result<Defaults, FileError> {
    read_bounds("bounds.toml", BOUNDS)
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
