//! The sources of a system's tables: a text, or the items of a builder.

use super::error::SystemError;
use std::ops::Range;

/// The source to which the spans of a system's tables refer.
#[derive(Clone, Debug)]
pub(super) enum Source {
    Text(SourceText),
    /// The items of a builder: a span begins at the index of its item.
    Items(Vec<String>),
}

impl Source {
    /// The file and the line in which a span begins, or the item.
    pub fn place(&self, span: &Range<usize>) -> String {
        match self {
            Self::Text(text) => text.place(span),
            Self::Items(items) => items.get(span.start).cloned().unwrap_or_default(),
        }
    }

    /// The keys that a start has before its states, each followed by a comma; a builder has none.
    pub fn keys_of_a_start(&self) -> &'static str {
        match self {
            Self::Text(_) => "mode, t, ",
            Self::Items(_) => "",
        }
    }

    pub fn error(&self, span: &Range<usize>, what: &str) -> SystemError {
        SystemError::at(&self.place(span), what)
    }
}

/// A text with tables, with the name of its file if it has one.
#[derive(Clone, Debug)]
pub(super) struct SourceText {
    pub file: Option<String>,
    pub text: String,
}

impl SourceText {
    /// The text of a file.
    pub fn of_file(file: &str, text: &str) -> Self {
        Self { file: Some(file.to_owned()), text: text.to_owned() }
    }

    /// The text's tables.
    pub fn parse<T: serde::de::DeserializeOwned>(&self) -> Result<T, SystemError> {
        toml::from_str(&self.text).map_err(|error| match error.span() {
            Some(span) => {
                SystemError::at(&self.place(&span), &self.explain(error.message(), &span))
            }
            None => SystemError::at(self.file.as_deref().unwrap_or("text"), error.message()),
        })
    }

    /// The file and the line in which a span begins.
    pub fn place(&self, span: &Range<usize>) -> String {
        let before = self.text.bytes().take(span.start);
        let line = 1 + before.filter(|byte| *byte == b'\n').count();
        match &self.file {
            Some(file) => format!("{file}:{line}"),
            None => format!("line {line}"),
        }
    }

    /// The message of the TOML reader, with the line of the file that it means.
    fn explain(&self, message: &str, span: &Range<usize>) -> String {
        let message = match message.strip_prefix("missing field `") {
            Some(key) => missing_key(key.trim_end_matches('`')),
            None => {
                let message = message.replace("invalid type: ", "not accepted: ");
                message.replace("expected a sequence", "accepted is an array")
            }
        };
        let start = self.text.get(..span.start).map_or(0, |it| it.rfind('\n').map_or(0, |n| n + 1));
        let line = self.text.get(start..).and_then(|it| it.lines().next()).unwrap_or_default();
        format!("{message}, in `{}`", line.trim())
    }
}

/// The message for a key that is missing.
fn missing_key(key: &str) -> String {
    let accepted = match key {
        "schema" => "1",
        "states" => "an array of names, such as [\"x\", \"v\"]",
        "omega" | "phi" => "a number, or an expression of parameters",
        "equations" => "an array with an equation of each state, such as [\"x' = v\"]",
        "guard" => "a comparison, such as \"x > 0\"",
        "mode" => "the name of a mode",
        _ => "a string",
    };
    format!("{key} is missing here: accepted is {accepted}")
}
