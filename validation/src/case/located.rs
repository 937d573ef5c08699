//! Errors that say where: which flag, or which field of which file on which line.

use percuss::InputError;
use std::collections::BTreeMap;
use std::path::Path;
use toml::Spanned;

/// An error in a file, in one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct FileError(pub String);

impl FileError {
    /// `file: what`.
    pub(crate) fn of(file: &str, what: impl std::fmt::Display) -> Self {
        Self(format!("{file}: {}", one_line(&what.to_string())))
    }

    /// What the TOML reader objects to, with its line.
    pub(crate) fn toml(file: &str, text: &str, error: &toml::de::Error) -> Self {
        let message = one_line(error.message());
        match error.span() {
            Some(span) => {
                let line = line_of(text, span.start);
                let shown = text.lines().nth(line - 1).unwrap_or_default();
                Self(one_line(&format!("{file}:{line}: {message}: {shown}")))
            }
            None => Self(format!("{file}: {message}")),
        }
    }

    /// The file cannot be read.
    pub(crate) fn unreadable(path: &Path, error: &std::io::Error) -> Self {
        Self(format!(
            "{}: cannot be read ({error}); accepted is a readable file in UTF-8",
            path.display()
        ))
    }
}

/// A text with its file's name, for errors.
pub(super) struct Source<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
}

impl Source<'_> {
    pub(super) fn parse<T: serde::de::DeserializeOwned>(&self) -> Result<T, FileError> {
        toml::from_str(self.text).map_err(|error| FileError::toml(self.file, self.text, &error))
    }

    pub(super) fn place<T>(&self, item: &Spanned<T>) -> String {
        format!("{}:{}", self.file, line_of(self.text, item.span().start))
    }

    pub(super) fn error<T>(&self, item: &Spanned<T>, what: &str) -> FileError {
        FileError(format!("{}: {}", self.place(item), one_line(what)))
    }
}

/// Everything on one line.
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The line, counted from 1, that holds byte `offset`.
pub(crate) fn line_of(text: &str, offset: usize) -> usize {
    1 + text.bytes().take(offset).filter(|byte| *byte == b'\n').count()
}

/// Where each name's value came from: `--xi`, or `file.toml:7: xi`.
#[derive(Clone, Debug, Default)]
pub struct Origins(BTreeMap<&'static str, String>);

impl Origins {
    /// Remembers that `name` was given at `place`.
    pub fn set(&mut self, name: &'static str, place: String) {
        self.0.insert(name, place);
    }

    /// Whether `name` was given at all.
    #[must_use]
    pub fn is_set(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    fn of(&self, name: &str) -> &str {
        self.0.get(name).map_or("its default", String::as_str)
    }

    /// The error in one line that names the culprit's flag or file and line.
    #[must_use]
    pub fn explain(&self, error: &InputError) -> String {
        match error {
            InputError::OutOfRange { name, value, accepted } => {
                format!("{} {value:?} is not accepted: {accepted}", self.place(name))
            }
            InputError::Penetrates { .. } => self.in_place("p", error),
            InputError::FarFromPhase { .. } => self.in_place("phase", error),
            _ => error.to_string(),
        }
    }

    /// The error with the place for the name it begins with.
    fn in_place(&self, name: &str, error: &InputError) -> String {
        let text = error.to_string();
        let rest = text.strip_prefix(name).and_then(|text| text.strip_prefix(" = "));
        rest.map_or(text.clone(), |rest| format!("{} {rest}", self.place(name)))
    }

    fn place(&self, name: &str) -> String {
        match self.of(name) {
            "its default" => format!("{name} (by default)"),
            place => place.to_owned(),
        }
    }
}
