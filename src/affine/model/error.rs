//! Errors in a system's file, each with its place.

use std::fmt;
use std::ops::Range;

/// An error in a system's file, in one line: file, line, culprit and what is accepted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SystemError(String);

impl SystemError {
    /// An error at a place, such as `ball.system.toml:7` or `--set`.
    #[must_use]
    pub fn at(place: &str, what: &str) -> Self {
        Self(format!("{place}: {}", what.split_whitespace().collect::<Vec<_>>().join(" ")))
    }
}

impl fmt::Display for SystemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for SystemError {}

/// The text of a file, with the file's name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    pub file: &'a str,
    pub text: &'a str,
}

impl Source<'_> {
    /// The text's tables.
    pub fn parse<T: serde::de::DeserializeOwned>(&self) -> Result<T, SystemError> {
        toml::from_str(self.text).map_err(|error| match error.span() {
            Some(span) => self.error(&span, &self.explained(error.message(), &span)),
            None => SystemError::at(self.file, error.message()),
        })
    }

    /// The file and the line in which a span begins.
    pub fn place(&self, span: &Range<usize>) -> String {
        let before = self.text.bytes().take(span.start);
        format!("{}:{}", self.file, 1 + before.filter(|byte| *byte == b'\n').count())
    }

    pub fn error(&self, span: &Range<usize>, what: &str) -> SystemError {
        SystemError::at(&self.place(span), what)
    }

    /// The message of the TOML reader, with the line of the file that it means.
    fn explained(&self, message: &str, span: &Range<usize>) -> String {
        let message = match message.strip_prefix("missing field `") {
            Some(key) => missing(key.trim_end_matches('`')),
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
fn missing(key: &str) -> String {
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
