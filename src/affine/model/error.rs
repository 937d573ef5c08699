//! Errors in a system, each with the place of a file or the item that it is about.

use std::fmt;

/// An error in a system: in its file, in its builder, or in one that was made or changed by hand.
///
/// The text of an error is one line that names the place or the item, what is wrong and what is
/// accepted.
///
/// ```
/// use percuss::{System, SystemError};
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
    /// Forcing periods are asked for of a system that has none.
    NoForcing {
        /// The name of the system.
        system: String,
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
            Self::NoForcing { system } => {
                write!(f, "{system} has no forcing, and so no periods")
            }
            Self::NoStart { system } => write!(f, "{system} has no start"),
            Self::Undecidable { item } => {
                write!(f, "the structural zeros of {item} cannot be decided")
            }
        }
    }
}

impl std::error::Error for SystemError {}
