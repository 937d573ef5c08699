//! Errors in a system, each with the place of a file or the item that it is about.

use std::fmt;
use std::ops::Range;

/// An error in a system: in its file, in its builder, or in one that was made or changed by hand.
///
/// The text of an error is one line that names the place or the item, what is wrong and what is
/// accepted.
///
/// ```
/// use percuss::affine::{System, SystemError};
///
/// let mut system = System::parse("ball.system.toml", r#"
///     schema = 1
///     name = "ball"
///     states = ["x", "v"]
///     [[mode]]
///     name = "flight"
///     equations = ["x' = v", "v' = -10"]
/// "#)?;
/// system.modes[0].matrix[1].pop();
/// assert!(matches!(system.check(), Err(SystemError::Length { found: 2, accepted: 3, .. })));
/// # Ok::<(), SystemError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SystemError {
    /// An error at a place of a file, such as `ball.system.toml:7`, or of an item of a builder.
    Place {
        /// The file and its line, or the item.
        place: String,
        /// What is wrong there, and what is accepted.
        what: String,
    },
    /// A list of coefficients, of rows or of states that is too long or too short.
    Length {
        /// The item, such as `mode "flight", until "impact", guard`.
        item: String,
        /// The number of entries that are there.
        found: usize,
        /// The number of entries that are accepted.
        accepted: usize,
    },
    /// Too many or too few states, modes, events or successors.
    Count {
        /// The item that has them, with what they are: `mode "flight", events`.
        item: String,
        /// The number of them.
        found: usize,
        /// The least number that is accepted.
        least: usize,
        /// The largest number that is accepted.
        most: usize,
    },
    /// A name that is not accepted or not the only one of its kind.
    Name {
        /// The item.
        item: String,
        /// What is wrong with its name, and what is accepted.
        what: String,
    },
    /// A number beyond the accepted range.
    Number {
        /// The item.
        item: String,
        /// What is wrong with it, and what is accepted.
        what: String,
    },
    /// A mode of a forced system whose matrix has not the rows of cos theta and sin theta: without
    /// them the forcing would stand still.
    Clock {
        /// The item, such as `mode "flight"`.
        item: String,
    },
    /// A mode whose matrix makes the last entry of z change, which is always 1.
    LastRow {
        /// The item, such as `mode "flight"`.
        item: String,
    },
    /// A reset that changes an entry of z that no reset may change: cos theta, sin theta or 1.
    Reset {
        /// The item, such as `mode "flight", until "impact"`.
        item: String,
        /// The entry: `cos`, `sin` or `1`.
        entry: &'static str,
    },
    /// An index that is that of no mode.
    UnknownMode {
        /// The item: a successor, or a start.
        item: String,
        /// The index.
        index: usize,
        /// The number of modes.
        modes: usize,
    },
    /// An `until` whose last successor has a condition, or one before it has none.
    Successors {
        /// The item, such as `mode "flight", until "impact"`.
        item: String,
    },
    /// A system without a start, where one is asked for.
    NoStart {
        /// The name of the system.
        system: String,
    },
    /// A system or a start whose structural zeros cannot be decided.
    Undecidable {
        /// The name of the system, or a start of it.
        item: String,
    },
}

impl SystemError {
    /// An error at a place, such as `ball.system.toml:7` or `--set`.
    pub(super) fn at(place: &str, what: &str) -> Self {
        let what = what.split_whitespace().collect::<Vec<_>>().join(" ");
        Self::Place { place: place.to_owned(), what }
    }
}

impl fmt::Display for SystemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Place { place: item, what }
            | Self::Name { item, what }
            | Self::Number { item, what } => write!(f, "{item}: {what}"),
            Self::Length { item, found, accepted } => {
                write!(f, "{item}: {found} entries are not accepted: {accepted} are")
            }
            Self::Count { item, found, least, most } => {
                write!(f, "{item}: {found} are not accepted: {least} to {most} are")
            }
            Self::Clock { item } => write!(
                f,
                "{item}: the matrix has not the rows of the forcing: cos' = -omega sin and \
                 sin' = omega cos are accepted"
            ),
            Self::LastRow { item } => {
                write!(
                    f,
                    "{item}: the last row of the matrix, that of 1, is accepted as zeros only"
                )
            }
            Self::Reset { item, entry } => {
                write!(f, "{item}: the reset changes {entry}: accepted is one that changes states")
            }
            Self::UnknownMode { item, index, modes } => {
                write!(f, "{item}: there is no mode {index}: accepted are indices below {modes}")
            }
            Self::Successors { item } => write!(
                f,
                "{item}: every successor but the last has a condition, and the last has none"
            ),
            Self::NoStart { system } => write!(f, "{system} has no start"),
            Self::Undecidable { item } => {
                write!(f, "the structural zeros of {item} cannot be decided")
            }
        }
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
