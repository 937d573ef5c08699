//! Names that nothing is called: what the user may have meant.

use super::terminal::note;
use anyhow::{Result, bail};
use regex::Regex;
use std::path::Path;
use strsim::normalized_damerau_levenshtein;

/// A name less similar than this is no help.
const MIN_SIMILARITY: f64 = 0.5;
/// The most names that are suggested.
const MAX_SUGGESTIONS: usize = 3;

/// A flag that selects things by patterns on their names.
pub(in crate::cli) struct Selection<'a> {
    /// The flag.
    pub(in crate::cli) flag: &'a str,
    /// The kind of things that are named.
    pub(in crate::cli) what: &'a str,
    /// The command that lists all names.
    pub(in crate::cli) listed: &'a str,
}

/// The most names of a user's own that are all shown.
const MAX_LISTED_OWN: usize = 8;

/// `--case`, of the cases inside the binary.
pub(in crate::cli) const CASES: Selection<'_> =
    Selection { flag: "--case", what: "case", listed: "percuss cases lists all" };
/// `--engine`, of all engines.
pub(in crate::cli) const ENGINES: Selection<'_> =
    Selection { flag: "--engine", what: "engine", listed: "percuss engines lists all" };

/// What a folder of a user's own holds: its cases by name where they are few.
pub(in crate::cli) fn held_by(folder: &Path, names: &[&str]) -> String {
    let folder = folder.display();
    match names {
        [] => format!("{folder} holds none"),
        few if few.len() <= MAX_LISTED_OWN => format!("{folder} holds {}", few.join(", ")),
        [first, .., last] => format!("{folder} holds {} from {first} to {last}", names.len()),
        [one] => format!("{folder} holds {one}"),
    }
}

impl Selection<'_> {
    /// Refuses patterns that select nothing together; a note says which of several select nothing.
    pub(in crate::cli) fn check<'n>(
        &self,
        patterns: &[Regex],
        names: impl IntoIterator<Item = &'n str>,
    ) -> Result<()> {
        let names: Vec<&str> = names.into_iter().collect();
        let idle = |pattern: &&Regex| !names.iter().any(|name| pattern.is_match(name));
        let idle: Vec<&Regex> = patterns.iter().filter(idle).collect();
        let lines: Vec<_> = idle.iter().map(|it| self.no_match(it.as_str(), &names)).collect();
        match lines.first() {
            Some(_) if idle.len() == patterns.len() => bail!("{}", lines.join("; ")),
            _ => lines.iter().for_each(|line| note(line)),
        }
        Ok(())
    }

    /// The error for a pattern that matches nothing.
    pub(in crate::cli) fn no_match(&self, pattern: &str, names: &[&str]) -> String {
        let Self { flag, what, listed } = self;
        let near = match nearest_names(pattern, names.iter().copied()) {
            near if near.is_empty() => String::new(),
            near => format!("the nearest names are {}; ", near.join(", ")),
        };
        format!("{flag} {pattern} matches no {what}: {near}{listed}")
    }
}

/// The names most like what was typed, best first; a part of a name between hyphens or underscores
/// counts as much as the whole.
pub(in crate::cli) fn nearest_names<'n>(
    typed: &str,
    names: impl IntoIterator<Item = &'n str>,
) -> Vec<&'n str> {
    let plain: String =
        typed.chars().filter(|it| it.is_alphanumeric() || "-_.".contains(*it)).collect();
    let plain = plain.to_lowercase();
    let mut scored: Vec<(f64, f64, &str)> = names
        .into_iter()
        .map(|name| (likeness(&plain, name), normalized_damerau_levenshtein(&plain, name), name))
        .filter(|it| it.0 >= MIN_SIMILARITY)
        .collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)));
    scored.into_iter().take(MAX_SUGGESTIONS).map(|it| it.2).collect()
}

/// How like `typed` the most similar run of a name's parts is, from 0 to 1.
fn likeness(typed: &str, name: &str) -> f64 {
    let is_gap = |it: &char| matches!(it, '-' | '_');
    let gaps: Vec<usize> = name.char_indices().filter(|it| is_gap(&it.1)).map(|it| it.0).collect();
    let begins = std::iter::once(0).chain(gaps.iter().map(|gap| gap + 1));
    let ends = gaps.iter().copied().chain([name.len()]).collect::<Vec<_>>();
    let runs = begins.flat_map(|begin| ends.iter().map(move |end| (begin, *end)));
    runs.filter_map(|(begin, end)| name.get(begin..end))
        .map(|run| normalized_damerau_levenshtein(typed, &run.to_lowercase()))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 6] = [
        "graze-miss-1e-6",
        "graze-overlap-1e-6",
        "table1-from-rest",
        "diffsol-bdf",
        "differential-equations-bdf",
        "ode_solvers-dopri5",
    ];

    #[test]
    fn the_nearest_come_first() {
        assert_eq!(nearest_names("grase-miss", NAMES).first(), Some(&"graze-miss-1e-6"));
        assert_eq!(nearest_names("^tabel1", NAMES), ["table1-from-rest"]);
        assert_eq!(nearest_names("difsol-bdf", NAMES).first(), Some(&"diffsol-bdf"));
        assert_eq!(nearest_names("dopri4", NAMES).first(), Some(&"ode_solvers-dopri5"));
        assert_eq!(nearest_names("Diffsol-BFD", NAMES).first(), Some(&"diffsol-bdf"));
    }

    #[test]
    fn what_is_like_nothing_has_no_neighbour() {
        assert!(nearest_names("qqqqqqqq", NAMES).is_empty());
        assert!(nearest_names("", NAMES).is_empty());
    }
}
