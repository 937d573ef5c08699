//! What a text answers that should name one of a type's values and does not.

use std::fmt;

/// A text that names none of the values of a type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownName {
    /// What the text should name.
    pub what: &'static str,
    /// The text that was given.
    pub given: String,
    /// The names that are accepted.
    pub accepted: Vec<&'static str>,
}

impl UnknownName {
    /// The one of `all` values that has this name.
    pub(crate) fn find<T: Copy>(
        what: &'static str,
        all: &[T],
        name: fn(T) -> &'static str,
        given: &str,
    ) -> Result<T, Self> {
        let found = all.iter().find(|it| name(**it) == given).copied();
        let accepted = || all.iter().map(|it| name(*it)).collect();
        found.ok_or_else(|| Self { what, given: given.to_owned(), accepted: accepted() })
    }
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, given, accepted } = self;
        write!(f, "{given:?} is no {what}: accepted are {}", accepted.join(", "))
    }
}

impl std::error::Error for UnknownName {}
