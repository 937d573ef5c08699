//! `junit.xml`: one suite per case, one test per row, for services that show test results.

use super::{Exporter, Report, ReportEvidence, ReportRow};
use crate::score::Verdict;
use quick_junit::{NonSuccessKind, TestCase, TestCaseStatus, TestSuite};
use std::io::{self, Write};
use std::time::Duration;

pub(super) struct Junit;

impl Exporter for Junit {
    fn file_name(&self) -> &'static str {
        "junit.xml"
    }

    fn write(
        &self,
        report: &Report,
        evidence: &ReportEvidence,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let mut whole = quick_junit::Report::new("percuss validate");
        for rows in report.results.chunk_by(|a, b| a.case == b.case) {
            whole.add_test_suite(suite(rows));
        }
        if !evidence.worse.is_empty() {
            whole.add_test_suite(baseline(&evidence.worse));
        }
        whole.serialize(out).map_err(io::Error::other)
    }
}

fn suite(rows: &[ReportRow]) -> TestSuite {
    let mut suite = TestSuite::new(rows.first().map_or("", |row| &row.case));
    suite.set_time(rows.iter().map(wall).sum());
    suite.add_test_cases(rows.iter().map(test));
    suite
}

/// A failing test for each line of what got worse than in the baseline.
fn baseline(worse: &[String]) -> TestSuite {
    let mut suite = TestSuite::new("baseline");
    let test = |line: &String| {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
        status.set_message(line.as_str()).set_type("worse");
        let mut test = TestCase::new(line.as_str(), status);
        test.set_classname("baseline");
        test
    };
    suite.add_test_cases(worse.iter().map(test));
    suite
}

fn test(row: &ReportRow) -> TestCase {
    let mut status = match row.verdict {
        Verdict::Pass | Verdict::Known | Verdict::Undecidable => TestCaseStatus::success(),
        Verdict::Fail => TestCaseStatus::non_success(NonSuccessKind::Failure),
        Verdict::Error => TestCaseStatus::non_success(NonSuccessKind::Error),
        Verdict::NotScored | Verdict::NotRun | Verdict::Unavailable => TestCaseStatus::skipped(),
    };
    let word = row.verdict.as_str();
    let succeeds = matches!(status, TestCaseStatus::Success { .. });
    if !succeeds {
        status.set_message(row.why.as_str()).set_type(word);
    }
    let mut test = TestCase::new(row.who(), status);
    test.set_classname(row.case.as_str()).set_time(wall(row));
    if succeeds && row.verdict != Verdict::Pass {
        test.set_system_out(format!("{word}: {}", row.why));
    }
    test
}

fn wall(row: &ReportRow) -> Duration {
    Duration::from_nanos(row.wall_ns.unwrap_or(0))
}
