//! The block of `validate`'s summary that says on which cases each engine fails.

use super::table::wrap;
use super::{Ranked, Report, ReportEvidence, ReportRow};
use crate::score::Verdict;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// An engine's cases are named where that takes at most this many lines, else counted by system.
const MAX_NAMED_LINES: usize = 3;

/// The cases on which each engine fails, with expected failures told apart; `all_names`: however
/// many they are.
pub(super) fn failing_cases(report: &Report, evidence: &ReportEvidence, all_names: bool) -> String {
    let failing: Vec<_> = report.ranking.iter().filter(|it| !it.fails_on.is_empty()).collect();
    if failing.is_empty() {
        return "no engine fails on any case\n\n".to_owned();
    }
    let mut any_counted = false;
    let mut lines = String::new();
    for it in failing {
        let head =
            format!("  {}: {} of {}", it.engine, it.fails_on.len(), report.number_of_cases());
        let names = wrap(&format!("{head}: {}", marked_names(report, it).join(", ")));
        let is_short = all_names || names.lines().count() <= MAX_NAMED_LINES;
        let groups = if is_short { Vec::new() } else { by_system(report, evidence, it) };
        any_counted |= !groups.is_empty();
        let unexpected: Vec<_> =
            marked_names(report, it).into_iter().filter(|it| it.ends_with('!')).collect();
        lines += &match groups[..] {
            [] => names,
            _ => wrap(&format!("{head}: {}", [unexpected, groups].concat().join(", "))),
        };
    }
    let all = match any_counted {
        true => "; many are counted by system here and named by --rows and in report.html",
        false => "",
    };
    let title = format!("fails on (expected failures; ! marks an unexpected one{all}):");
    format!("{}{lines}\n", wrap(&title))
}

/// The names of an engine's failing cases, with a mark where nothing excuses a row.
fn marked_names(report: &Report, it: &Ranked) -> Vec<String> {
    let name = |case: &String| {
        if is_unexpected(report, it, case) { format!("{case}!") } else { case.clone() }
    };
    it.fails_on.iter().map(name).collect()
}

/// Whether nothing excuses a row of an engine on a case.
fn is_unexpected(report: &Report, it: &Ranked, case: &str) -> bool {
    let own = |row: &&ReportRow| row.engine == it.engine && row.case == case;
    let unexpected = |row: &ReportRow| matches!(row.verdict, Verdict::Fail | Verdict::Error);
    report.results.iter().filter(own).any(unexpected)
}

/// The number of cases of a system, of those that an engine fails, and of unexpected failures.
#[derive(Clone, Copy, Default)]
struct SystemCount {
    all: usize,
    failing: usize,
    unexpected: usize,
}

/// How many of each system's cases an engine fails on, from the most down.
fn by_system(report: &Report, evidence: &ReportEvidence, it: &Ranked) -> Vec<String> {
    let mut systems: BTreeMap<&str, SystemCount> = BTreeMap::new();
    for note in &evidence.cases {
        let own = |row: &&ReportRow| row.engine == it.engine && row.case == note.name;
        if report.results.iter().any(|row| own(&row)) {
            let count = systems.entry(&note.system).or_default();
            count.failing += usize::from(it.fails_on.contains(&note.name));
            count.unexpected += usize::from(is_unexpected(report, it, &note.name));
            count.all += 1;
        }
    }
    let mut systems: Vec<_> = systems.into_iter().filter(|it| it.1.failing > 0).collect();
    // The one case of a system that is named already is not counted as well.
    systems.retain(|(_, it)| it.all > 1 || it.unexpected == 0);
    systems.sort_by_key(|it| Reverse(it.1.failing));
    let shown =
        |(system, it): (&str, SystemCount)| format!("{system} {} of {}", it.failing, it.all);
    systems.into_iter().map(shown).collect()
}
