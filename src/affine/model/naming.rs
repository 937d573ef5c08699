//! The names that states, modes and events may have.

use super::ending::Ending;

/// Names that expressions cannot give to anything else.
const RESERVED_NAMES: [&str; 4] = ["cos", "sin", "omega", "phi"];

/// Keys of a start beside the states.
const START_KEYS: [&str; 2] = ["t", "mode"];

/// Refuses what is no name of a state, of a parameter or of a `[let]`.
pub(super) fn check_symbol(name: &str, is_state: bool) -> Result<(), String> {
    if is_state && START_KEYS.contains(&name) {
        Err(format!("{name} is no name of a state: a start holds a {name} beside the states"))
    } else if RESERVED_NAMES.contains(&name) {
        Err(format!("{name} is reserved for theta = omega t + phi"))
    } else if !is_symbol(name) {
        Err(format!("{name:?} is no name: a letter, then letters, digits and underscores are"))
    } else {
        Ok(())
    }
}

/// Whether a text is a name that an expression can use.
fn is_symbol(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Refuses what is no name of lower-case words that are joined by hyphens.
pub(super) fn check_kebab(name: &str) -> Result<(), String> {
    let word = |word: &str| {
        let belongs = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
        !word.is_empty() && word.chars().all(belongs)
    };
    if name.split('-').all(word) {
        return Ok(());
    }
    Err(format!("{name:?} is not accepted: lower-case words joined by hyphens are"))
}

/// Refuses what is no name of an event.
pub(super) fn check_event(name: &str) -> Result<(), String> {
    if name.parse::<Ending>().is_ok() {
        return Err(format!("{name:?} is the name of an ending"));
    }
    check_kebab(name)
}

/// The error of a name that is that of no mode.
pub(super) fn unknown_mode<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let accepted = known.collect::<Vec<_>>().join(", ");
    format!("there is no mode {name:?}: accepted is one of {accepted}")
}
