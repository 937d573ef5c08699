//! Error messages that name the flag, or the file, line and field, at fault.

use super::accepted::accepted;
use percuss::InputError;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// An error in a file, as one line of text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct FileError(pub String);

impl FileError {
    /// `file: what`.
    pub fn new(file: &str, what: impl std::fmt::Display) -> Self {
        Self(format!("{file}: {}", one_line(&what.to_string())))
    }

    /// What the TOML reader objects to, with its line; of a wrong type the key, the value as typed
    /// and what is accepted.
    pub fn toml(file: &str, text: &str, error: &toml::de::Error) -> Self {
        let message = one_line(error.message());
        let Some(span) = error.span() else { return Self(format!("{file}: {message}")) };
        let line = line_of(text, span.start);
        if let Some(table) = missing_table(&message) {
            return Self(format!("{file}:{}: {table}", last_line(text)));
        }
        let what = match message.split_once(", expected ") {
            Some((found, expected)) if found.starts_with("invalid type: ") => {
                wrong_type(text, span, expected)
            }
            _ => match message.strip_prefix("missing field `") {
                Some(key) => missing(key.trim_end_matches('`')),
                None => format!("{message}: {}", text.lines().nth(line - 1).unwrap_or_default()),
            },
        };
        Self(one_line(&format!("{file}:{line}: {what}")))
    }

    /// A table that a file lacks, with its last line; `accepted` says what the table holds.
    #[must_use]
    pub fn lacks(file: &str, text: &str, table: &str, accepted: &str) -> Self {
        let line = last_line(text);
        Self::new(&format!("{file}:{line}"), missing_key(table, accepted))
    }

    /// The file cannot be read.
    pub fn unreadable(path: &Path, error: &std::io::Error) -> Self {
        Self(format!(
            "{}: cannot be read ({error}); accepted is a readable file in UTF-8",
            path.display()
        ))
    }
}

/// The text of a file.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, and with its line for a byte that is no UTF-8.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    let bytes = std::fs::read(path).map_err(|error| FileError::unreadable(path, &error))?;
    String::from_utf8(bytes).map_err(|error| {
        let (at, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
        let line = 1 + bytes.iter().take(at).filter(|byte| **byte == b'\n').count();
        let byte = bytes.get(at).copied().unwrap_or_default();
        let what = format!("the byte 0x{byte:02x} is not accepted: a text in UTF-8 is");
        FileError(format!("{}:{line}: {what}", path.display()))
    })
}

/// A text with the name of its file, for error messages.
pub(super) struct FileText<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
}

impl FileText<'_> {
    pub(super) fn parse<T: serde::de::DeserializeOwned>(&self) -> Result<T, FileError> {
        toml::from_str(self.text).map_err(|error| FileError::toml(self.file, self.text, &error))
    }

    pub(super) fn place<T>(&self, item: &Spanned<T>) -> String {
        format!("{}:{}", self.file, line_of(self.text, item.span().start))
    }

    /// The error for a value of a key that is out of range.
    pub(super) fn refused<T>(&self, key: &str, item: &Spanned<T>) -> FileError {
        let accepted = accepted(key).unwrap_or("a value in its range");
        self.error(item, &format!("{key} = {} is not accepted: {accepted}", self.typed(item)))
    }

    /// The text of a value, as the file has it.
    pub(super) fn typed<T>(&self, item: &Spanned<T>) -> &str {
        self.text.get(item.span()).unwrap_or_default()
    }

    pub(super) fn error<T>(&self, item: &Spanned<T>, what: &str) -> FileError {
        FileError(format!("{}: {}", self.place(item), one_line(what)))
    }
}

/// A table that the whole file lacks; the reader names its first line, which says nothing.
fn missing_table(message: &str) -> Option<String> {
    let key = message.strip_prefix("missing field `")?.trim_end_matches('`');
    let accepted = match key {
        "case" => "[case] with name, why, and regime or system",
        "horizon" => "[horizon] with periods or until",
        _ => return None,
    };
    Some(missing_key(key, accepted))
}

fn missing_key(table: &str, accepted: &str) -> String {
    format!("[{table}] is missing: accepted after this line, the last, is {accepted}")
}

/// The number of the last line, counted from 1.
fn last_line(text: &str) -> usize {
    text.lines().count().max(1)
}

/// A key that has to be there, with what it takes.
fn missing(key: &str) -> String {
    let accepted = accepted(key).unwrap_or(match key {
        "rows" => "a list of rows",
        "quantity" | "statistic" => "a string, one of its names",
        _ => "a string",
    });
    format!("{key} is missing here; accepted is {accepted}")
}

/// `key = value is not accepted: a type`, with the range where the key has one.
fn wrong_type(text: &str, span: Range<usize>, expected: &str) -> String {
    let before = text.get(..span.start).unwrap_or_default();
    let before = before.rsplit('\n').next().unwrap_or_default();
    let value = text.get(span).unwrap_or_default().lines().next().unwrap_or_default();
    let key = before.rsplit(['{', ',', '[']).next().unwrap_or_default();
    let name = key.trim().trim_end_matches('=').trim().trim_matches('"');
    let expected = match (accepted(name), expected) {
        (Some(range), "f64") if !range.contains("number") => format!("a number, {range}"),
        (Some(range), _) => range.to_owned(),
        (None, "f64") => "a number".to_owned(),
        (None, "i64") => "an integer".to_owned(),
        (None, "a sequence") => "a list".to_owned(),
        (None, "a boolean") => "a boolean, true or false".to_owned(),
        (None, it) if it.starts_with("struct ") => "a table, in single brackets".to_owned(),
        (None, other) => other.to_owned(),
    };
    format!("{} {value} is not accepted: {expected}", key.trim())
}

/// The text with its line breaks replaced by spaces.
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The line, counted from 1, that holds byte `offset`.
pub(crate) fn line_of(text: &str, offset: usize) -> usize {
    1 + text.bytes().take(offset).filter(|byte| *byte == b'\n').count()
}

/// The place from which each name's value came, `--xi` or `file.toml:7: xi =`, and how it was typed
/// there.
#[derive(Clone, Debug, Default)]
pub struct Origins(BTreeMap<&'static str, Origin>);

#[derive(Clone, Debug)]
struct Origin {
    place: String,
    typed: String,
}

impl Origins {
    /// Remembers that `name` was given at `place`, as the text `typed`.
    pub fn set(&mut self, name: &'static str, place: String, typed: &str) {
        self.0.insert(name, Origin { place, typed: typed.to_owned() });
    }

    /// Whether `name` was given at all.
    #[must_use]
    pub fn is_set(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// The error in one line that names the culprit's flag or file and line, and its value as
    /// typed.
    #[must_use]
    pub fn explain(&self, error: &InputError) -> String {
        match error {
            InputError::OutOfRange { name, value, accepted } => {
                format!(
                    "{} is not accepted: {accepted}",
                    self.place_and_value(name, format!("{value:?}"))
                )
            }
            InputError::Penetrates { p, limit } => {
                let given = self.place_and_value("p", format!("{p:?}"));
                format!("{given} is not accepted: p <= q + g = {limit:?}")
            }
            InputError::FarFromPhase { phase, name, from, to } => format!(
                "{} is not accepted: it would move {name} from {from:?} to {to:?}, by more than 1e-4",
                self.place_and_value("phase", phase.to_string())
            ),
            _ => error.to_string(),
        }
    }

    /// The flag or the place in a file, and the value.
    fn place_and_value(&self, name: &str, value: String) -> String {
        match self.0.get(name) {
            Some(Origin { place, typed }) => format!("{place} {typed}"),
            None => format!("{name} (by default) {value}"),
        }
    }
}
