//! Engines' names in few columns.

use crate::report::Report;
use std::collections::BTreeMap;

/// The names of a report's engines without their libraries' where that is unique: so each of them
/// still finds its engine with `-e`.
pub(super) fn short_names(report: &Report) -> BTreeMap<&'static str, &'static str> {
    let rest = |engine: &'static str, library: &str| {
        let rest = engine.strip_prefix(library).and_then(|it| it.strip_prefix('-'));
        rest.unwrap_or(engine)
    };
    let all: Vec<_> =
        report.engines.iter().map(|it| (it.name, rest(it.name, it.library))).collect();
    let is_unique = |short: &str| all.iter().filter(|it| it.1 == short).count() == 1;
    all.iter().map(|(name, short)| (*name, if is_unique(short) { short } else { *name })).collect()
}

/// A name in at most so many columns.
pub(super) fn fit(name: &str, room: usize) -> String {
    if name.chars().count() <= room {
        return name.to_owned();
    }
    let kept = name.chars().take(room.saturating_sub(1));
    kept.chain(['\u{2026}']).collect()
}
