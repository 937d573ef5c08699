//! Failures as annotations on a run of the public CI service, which reads them off the log.
//!
//! The service shows a few annotations per step and drops the rest, so there is one per case.

use super::{Report, ReportEvidence, ReportRow};
use crate::score::Verdict;

/// Whether this runs under the service.
#[must_use]
pub fn under_the_service() -> bool {
    std::env::var("GITHUB_ACTIONS").is_ok_and(|value| value == "true")
}

/// A line for each case with a row that fails or errs; with `require` also where an engine is
/// unavailable.
#[must_use]
pub fn annotations(report: &Report, evidence: &ReportEvidence, require: bool) -> Vec<String> {
    let wanted = |row: &&ReportRow| match row.verdict {
        Verdict::Fail | Verdict::Error => true,
        Verdict::Unavailable => require,
        _ => false,
    };
    let of_case = |rows: &[ReportRow]| {
        let bad: Vec<&ReportRow> = rows.iter().filter(wanted).collect();
        let case = &bad.first()?.case;
        let file = evidence.cases.iter().find(|note| note.name == *case).map(|note| &note.file);
        Some(line(case, file.map(String::as_str), &bad))
    };
    let cases = report.results.chunk_by(|a, b| a.case == b.case).filter_map(of_case);
    cases.chain(worse(&evidence.worse)).collect()
}

/// An annotation for all that got worse than in the baseline.
fn worse(worse: &[String]) -> Option<String> {
    let count = worse.len();
    let title = property(&format!("{count} figures are worse than in the baseline"));
    (count > 0).then(|| format!("::error title={title}::{}", message(&worse.join("\n"))))
}

fn line(case: &str, file: Option<&str>, bad: &[&ReportRow]) -> String {
    let file = file.map_or(String::new(), |file| format!("file={},", property(file)));
    let rows = if bad.len() == 1 { "row" } else { "rows" };
    let title = property(&format!("{case}: {} {rows} out of bounds", bad.len()));
    let reasons: Vec<_> = bad
        .iter()
        .map(|row| format!("{}: {}: {}", row.verdict.as_str(), row.who(), row.why))
        .collect();
    format!("::error {file}title={title}::{}", message(&reasons.join("\n")))
}

/// What a line's last part needs to stay on its line.
fn message(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// What a property needs besides, which ends at a comma or at two colons.
fn property(text: &str) -> String {
    message(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_end_a_part_is_escaped() {
        assert_eq!(message("50 %\r\nof it, a::b"), "50 %25%0D%0Aof it, a::b");
        assert_eq!(property("a,b::c\n1 %"), "a%2Cb%3A%3Ac%0A1 %25");
        assert_eq!(property("%0A"), "%250A");
    }
}
