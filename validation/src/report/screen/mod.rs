//! The first screen of `validate`: which integrator, at what tolerance, at what cost, and what goes
//! wrong with the others.
//!
//! It has at most [`MAX_LINES`] lines; every line fits [`WIDTH`](super::WIDTH) columns. A terminal
//! shows the last lines, so rows and details stand above it.

mod advice;
mod derivatives;
mod details;
mod engines;
mod names;
mod remark;

use super::notes::power;
use super::table::{one_line, reasons, row_table, setting, wrap};
use super::{Report, ReportEvidence, ReportRow};
use crate::score::Verdict;
use advice::advice;
use details::details;
use engines::EngineTable;

pub(super) use details::figure;

/// The most lines of the first screen, beside what got worse than a baseline.
pub const MAX_LINES: usize = 30;
/// The most unexpected failures that the screen names.
const MAX_FAILURES: usize = 3;

/// What is printed besides the first screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenParts {
    /// Every row.
    pub rows: bool,
    /// Kinds of trouble, what was not run, failing cases by engine, and all reasons.
    pub details: bool,
}

/// The screen, with the rows and the details above it where they are asked for, and with the
/// reasons of failing rows in full where either is.
#[must_use]
pub fn screen(report: &Report, evidence: &ReportEvidence, parts: ScreenParts) -> String {
    let rows = if parts.rows { row_table(&report.results) + "\n" } else { String::new() };
    let more = if parts.details { details(report, evidence, parts.rows) } else { String::new() };
    let any = parts.rows || parts.details;
    let reasons = if any { reasons(&report.results) } else { String::new() };
    let reasons = if reasons.is_empty() { reasons } else { reasons + "\n" };
    [rows, more, reasons, first_screen(report, evidence)].concat()
}

/// The blocks of the screen: what is shown in full, and what gives way.
fn first_screen(report: &Report, evidence: &ReportEvidence) -> String {
    let above = lines_above_table(report);
    let advice = advice(report);
    let derivatives = derivatives::gradient_lines(&report.gradients);
    let below: Vec<String> = power(evidence).into_iter().chain([counts(report)]).collect();
    let bad = unexpected_rows(report);
    let table = EngineTable::new(report);
    let fixed = above.len() + table.header_lines() + advice.len() + derivatives.len() + below.len();
    let room = MAX_LINES.saturating_sub(fixed);
    // Failures keep two lines however many engines there are.
    let engines = table.lines(room - bad.len().min(2).min(room));
    let failures = failures(&bad, room.saturating_sub(engines.len() - table.header_lines()));
    let blocks = [above, engines, advice, derivatives, failures, below];
    let lines: usize = blocks.iter().map(Vec::len).sum();
    let filled = blocks.iter().filter(|block| !block.is_empty());
    let spaced = lines + filled.clone().count() <= MAX_LINES;
    let between = if spaced { "\n\n" } else { "\n" };
    let text = filled.map(|it| it.join("\n")).collect::<Vec<_>>().join(between);
    [text, "\n".to_owned(), worse(evidence), cost_note(evidence)].concat()
}

/// The rows that nothing excuses, the first of each engine before the others.
fn unexpected_rows(report: &Report) -> Vec<&ReportRow> {
    let (mut first, mut others) = (Vec::<&ReportRow>::new(), Vec::new());
    for row in report.results.iter().filter(|row| row.is_unexpected()) {
        let is_known = first.iter().any(|it| it.engine == row.engine);
        if is_known { others.push(row) } else { first.push(row) }
    }
    [first, others].concat()
}

/// What stands above the table: that little was answered, and the question.
fn lines_above_table(report: &Report) -> Vec<String> {
    let unanswered = report
        .unanswered()
        .map(|it| format!("More than half is missing: {} (--allow-unanswered)", it.sentence()));
    let title = engines::title(report);
    unanswered.into_iter().chain([title]).map(|it| one_line(&it)).collect()
}

/// The first unexpected failures, each in one line, and how many more there are.
fn failures(bad: &[&ReportRow], room: usize) -> Vec<String> {
    let all = bad.len() <= room.min(MAX_FAILURES);
    let shown = if all { bad.len() } else { MAX_FAILURES.min(room.saturating_sub(1)) };
    let line = |row: &&ReportRow| {
        let (verdict, case, engine) = (row.verdict.as_str(), &row.case, row.engine);
        one_line(&format!("{verdict}: {case} {engine} {}: {}", setting(row), row.why))
    };
    let more = (!all).then(|| format!("and {} more: --details", bad.len() - shown));
    bad.iter().take(shown).map(line).chain(more).collect()
}

fn worse(evidence: &ReportEvidence) -> String {
    let lines = evidence.worse.iter();
    lines.map(|it| wrap(&format!("worse than the baseline: {it}"))).collect()
}

fn cost_note(evidence: &ReportEvidence) -> String {
    match evidence.dearer.as_slice() {
        [] => String::new(),
        rows => wrap(&format!("right-hand sides beside the baseline: {}", rows.join("; "))),
    }
}

/// The rows of each class; classes without a row are left out, but for failures and errors.
fn counts(report: &Report) -> String {
    let count = |it: Verdict| report.results.iter().filter(|row| row.verdict == it).count();
    let told = |it: &Verdict| count(*it) > 0 || matches!(it, Verdict::Fail | Verdict::Error);
    let classes = Verdict::ALL.into_iter().rev().filter(told);
    let classes: Vec<_> =
        classes.map(|class| format!("{} {}", count(class), class.as_str())).collect();
    one_line(&format!("{} rows: {}", report.results.len(), classes.join(", ")))
}

#[cfg(test)]
mod tests;
