//! Expected failures held against a row: each excuses the one quantity that it names.

use super::mismatch::Excused;
use super::scored::{Checked, ScoredRun, Verdict};
use crate::case::Shortcoming;
use crate::number::brief;

/// The state of an expected failure on a row.
pub(super) enum Answer {
    /// The figure lies in the stated range; the reason of the failure.
    Shows(String),
    /// The figure lies elsewhere; what is out of date.
    OutOfDate(String),
}

/// Holds a shortcoming against a row; a bound that fails as stated becomes known.
///
/// It shows if the bound on its quantity fails with a figure in the range that it states.
/// What was not measured shows nothing.
pub(super) fn answer(
    known: &Shortcoming,
    run: &ScoredRun<'_>,
    excused: &Excused,
    checked: &mut [Checked],
) -> Answer {
    let value = run.decidable(known.quantity, known.statistic, excused);
    let stated = format!("{} to {}", brief(known.at_least), brief(known.at_most));
    let words = known.quantity.words_of(known.statistic);
    let out_of_date = |what: &str| {
        Answer::OutOfDate(format!(
            "the data are out of date: {words} {} {what} (stated: {stated}): {}",
            brief(value),
            known.why
        ))
    };
    let failing = checked.iter_mut().find(|it| {
        it.quantity == known.quantity
            && it.statistic == known.statistic
            && it.verdict == Verdict::Fail
    });
    match failing {
        Some(bound) if known.at_least <= value && value <= known.at_most => {
            bound.verdict = Verdict::Known;
            Answer::Shows(format!("{words} {} (stated: {stated}): {}", brief(value), known.why))
        }
        Some(_) if value > known.at_most => out_of_date("is worse than the stated shortcoming"),
        _ => out_of_date("no longer shows the stated shortcoming"),
    }
}
