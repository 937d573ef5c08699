//! Values of flags, with errors that say what is accepted.

use percuss::Phase;
use regex::Regex;

/// A number; its range is checked where its meaning is known.
pub(super) fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "accepted is a number".to_owned())
}

/// A cycle's number.
pub(super) fn cycle(text: &str) -> Result<i64, String> {
    text.parse().map_err(|_| "accepted is an integer, -2^53 to 2^53".to_owned())
}

/// A phase's token.
pub(super) fn phase(text: &str) -> Result<Phase, String> {
    text.parse().map_err(|_| "accepted are no-contact, contact, progression".to_owned())
}

/// A regular expression on names.
pub(super) fn pattern(text: &str) -> Result<Regex, String> {
    Regex::new(text).map_err(|_| "accepted is a regular expression".to_owned())
}
