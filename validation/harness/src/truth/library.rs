//! The reference data inside the binary or in a folder, with their hashes checked.

use super::Truth;
use crate::case::{Case, FileError};
use include_dir::{Dir, include_dir};
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

// Folder by folder: the generators beside them have no business in the binary.
static EVENTS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/reference_data/events");
static SAMPLES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/reference_data/samples");
static MANIFEST: &str = include_str!("../../reference_data/manifest.json");

#[derive(Deserialize)]
struct Manifest {
    files: BTreeMap<String, ListedFile>,
}

#[derive(Deserialize)]
struct ListedFile {
    sha256: String,
}

/// A set of reference data.
pub struct Library {
    /// A folder on disk; `None`: inside the binary.
    folder: Option<PathBuf>,
    manifest: Manifest,
    replays: bool,
}

impl Library {
    /// The data inside the binary.
    ///
    /// # Errors
    /// [`FileError`] if the manifest cannot be understood; a test shows that it can.
    pub fn embedded() -> Result<Self, FileError> {
        let manifest = parse("reference_data/manifest.json", MANIFEST)?;
        Ok(Self { folder: None, manifest, replays: false })
    }

    /// The data in a folder.
    ///
    /// # Errors
    /// [`FileError`] if its manifest cannot be read or understood.
    pub fn from_directory(folder: &Path) -> Result<Self, FileError> {
        let path = folder.join("manifest.json");
        let text =
            std::fs::read_to_string(&path).map_err(|error| FileError::unreadable(&path, &error))?;
        Ok(Self {
            manifest: parse(&path.display().to_string(), &text)?,
            folder: Some(folder.to_owned()),
            replays: false,
        })
    }

    /// The truths of cases, where cases without tables are run again in 106 bits instead of being
    /// refused: for cases of a user's own, before their tables are made.
    #[must_use]
    pub fn replaying(self) -> Self {
        Self { replays: true, ..self }
    }

    /// Whether a case's truth is a run made again, for want of tables.
    #[must_use]
    pub fn is_replayed(&self, case: &str) -> bool {
        let listed = |kind| self.manifest.files.contains_key(&format!("{kind}/{case}.csv"));
        self.replays && !["events", "samples"].into_iter().any(listed)
    }

    /// The file of a case's event table; `None` where its truth is a run made again.
    #[must_use]
    pub fn table(&self, case: &str) -> Option<String> {
        (!self.is_replayed(case)).then(|| self.full_name(&format!("events/{case}.csv")))
    }

    /// The truth of a case.
    ///
    /// # Errors
    /// [`FileError`] names a file that is missing, altered (its hash differs), malformed, or of
    /// another case; or a case that has no table and that 106 bits do not decide.
    pub fn truth(&self, case: &Case) -> Result<Truth, FileError> {
        if self.is_replayed(&case.name) {
            return match &case.oscillator {
                Some(own) => Truth::of_oscillator(case, own),
                None => Truth::of_system(case),
            };
        }
        let [events, samples] = self.tables(&case.name)?;
        Truth::read(case, (&events.0, &events.1), (&samples.0, &samples.1))
            .map_err(|error| self.of_another(&case.name, error))
    }

    /// An error in tables inside the binary, where a case of a user's own may have their name.
    fn of_another(&self, case: &str, error: FileError) -> FileError {
        if !self.replays || self.folder.is_some() {
            return error;
        }
        FileError(format!(
            "{error}; {case} is a case inside percuss: accepted is that case as it is, or another name"
        ))
    }

    /// The tables of a case's events and samples, each with its file's name.
    fn tables(&self, case: &str) -> Result<[(String, Cow<'static, str>); 2], FileError> {
        let table = |kind: &str| {
            let name = format!("{kind}/{case}.csv");
            Ok((self.full_name(&name), self.text(&name)?))
        };
        Ok([table("events")?, table("samples")?])
    }

    fn full_name(&self, name: &str) -> String {
        let folder = self.folder.as_deref().unwrap_or(Path::new("reference_data"));
        folder.join(name).display().to_string()
    }

    fn text(&self, name: &str) -> Result<Cow<'static, str>, FileError> {
        let full_name = self.full_name(name);
        let listed = self.manifest.files.get(name);
        let listed = listed.ok_or_else(|| FileError::new(&full_name, "is not in the manifest"))?;
        let bytes = self.bytes(name, &full_name)?;
        let found: String =
            Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        if found != listed.sha256 {
            let what =
                format!("SHA-256 {found} is not accepted: the manifest says {}", listed.sha256);
            return Err(FileError::new(&full_name, what));
        }
        let not_text = || FileError::new(&full_name, "is not UTF-8");
        match bytes {
            Cow::Borrowed(bytes) => {
                std::str::from_utf8(bytes).map(Cow::Borrowed).map_err(|_| not_text())
            }
            Cow::Owned(bytes) => String::from_utf8(bytes).map(Cow::Owned).map_err(|_| not_text()),
        }
    }

    fn bytes(&self, name: &str, full_name: &str) -> Result<Cow<'static, [u8]>, FileError> {
        if let Some(folder) = &self.folder {
            let path = folder.join(name);
            return std::fs::read(&path)
                .map(Cow::Owned)
                .map_err(|error| FileError::unreadable(&path, &error));
        }
        let (folder, file) = match name.split_once('/') {
            Some(("events", file)) => (&EVENTS, file),
            Some(("samples", file)) => (&SAMPLES, file),
            _ => return Err(FileError::new(full_name, "is not inside the binary")),
        };
        let file = folder
            .get_file(file)
            .ok_or_else(|| FileError::new(full_name, "is not inside the binary"))?;
        Ok(Cow::Borrowed(file.contents()))
    }
}

fn parse(name: &str, text: &str) -> Result<Manifest, FileError> {
    serde_json::from_str(text).map_err(|error| FileError::new(name, error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::embedded;

    #[test]
    fn every_embedded_case_has_its_tables() {
        let Ok(library) = Library::embedded() else { unreachable!("the manifest is read") };
        for case in embedded().unwrap_or_default() {
            let truth = library.truth(&case).map(|truth| truth.span);
            assert!(truth.as_ref().is_ok_and(|span| *span > 0.0), "{truth:?}");
        }
    }
}
