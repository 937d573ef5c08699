//! What goes wrong with an engine, in a few words.

use crate::case::Quantity;
use crate::report::{Ranked, Report, ReportRow};
use crate::score::Verdict;
use std::collections::BTreeMap;

/// Kinds of failures, the gravest first: of equally frequent ones the first is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Failing {
    NoResult,
    Misses,
    Invents,
    WrongModes,
    Late,
    Coarse,
}

impl Failing {
    const fn words(self) -> &'static str {
        match self {
            Self::NoResult => "runs without a result",
            Self::Misses => "misses events",
            Self::Invents => "invents events",
            Self::WrongModes => "wrong modes",
            Self::Late => "locates events late",
            Self::Coarse => "less exact than its class",
        }
    }

    /// The kind of failure that a bound on a quantity tells.
    const fn new(quantity: Quantity) -> Self {
        match quantity {
            Quantity::RunsFailed | Quantity::RestartsFailed => Self::NoResult,
            Quantity::EventsMissed => Self::Misses,
            Quantity::EventsSpurious => Self::Invents,
            Quantity::EventsWrongMode | Quantity::Inconsistency | Quantity::PhaseSequence => {
                Self::WrongModes
            }
            Quantity::Location => Self::Late,
            _ => Self::Coarse,
        }
    }
}

/// The kinds of failures of a row, each once; errors that come of wrong events are none besides.
fn kinds(row: &ReportRow) -> Vec<Failing> {
    let failing = |verdict| matches!(verdict, Verdict::Fail | Verdict::Known);
    let bounds = row.bounds.iter().filter(|it| failing(it.verdict));
    let mut kinds: Vec<Failing> = bounds.map(|it| Failing::new(it.quantity)).collect();
    kinds.extend((row.status == "failed").then_some(Failing::NoResult));
    kinds.sort();
    kinds.dedup();
    if kinds.len() > 1 {
        kinds.retain(|it| *it != Failing::Coarse);
    }
    kinds
}

/// The kind of failure that an engine has on most cases.
fn most_frequent(rows: &[&ReportRow]) -> Option<Failing> {
    let mut cases: BTreeMap<Failing, Vec<&str>> = BTreeMap::new();
    for row in rows {
        for kind in kinds(row) {
            let of_kind = cases.entry(kind).or_default();
            if !of_kind.contains(&row.case.as_str()) {
                of_kind.push(&row.case);
            }
        }
    }
    // `max_by_key` takes the last of equals, so the gravest kind comes last.
    cases.into_iter().rev().max_by_key(|it| it.1.len()).map(|it| it.0)
}

/// The remark on an engine: what goes wrong, or that it shares its rank.
pub(super) fn remark(report: &Report, it: &Ranked, rows: &[&ReportRow]) -> &'static str {
    let shares = report.ranking.iter().filter(|other| other.rank == it.rank).count() > 1;
    match (it.rank, most_frequent(rows)) {
        (None, _) => "not installed",
        (Some(0), _) => "the reference",
        (_, Some(kind)) => kind.words(),
        (_, None) if shares => "tied",
        (_, None) => "",
    }
}
