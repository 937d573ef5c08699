//! `junit.xml` and annotations, through the real binary.

use crate::support::{percuss, text};
use quick_junit::{NonSuccessKind, Report, TestCaseStatus};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// `small-b`, where no engine is accurate enough; the reason holds what formats have to escape.
fn failing_case(folder: &Path) -> PathBuf {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/small-b.toml");
    let bound = "[[bounds]]\nengine = \"exact\"\nquantity = \"state_error\"\nstatistic = \"max\"\n\
                 limit = 1e-30\nwhy = \"50 % of <it>, & so\\non: \\\"x\\\"\"\n";
    let cases = folder.join("cases");
    fs::create_dir(&cases).expect("made");
    fs::write(cases.join("small-b.toml"), fs::read_to_string(case).expect("read") + bound)
        .expect("written");
    cases
}

#[test]
fn junit_says_what_the_summary_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = failing_case(folder.path()).display().to_string();
    let out = folder.path().join("out");
    let arguments = ["validate", "--cases", &cases, "--out", &out.display().to_string()];
    assert_eq!(percuss(&arguments).output().expect("ran").status.code(), Some(1));
    let report: Value =
        serde_json::from_slice(&fs::read(out.join("report.json")).expect("read")).expect("JSON");
    let junit = fs::read_to_string(out.join("junit.xml")).expect("read");
    let junit = Report::deserialize_from_str(&junit).expect("JUnit");
    let rows = report["results"].as_array().map_or(0, Vec::len);
    assert_eq!((junit.tests, junit.test_suites.len()), (rows, 1));
    assert_eq!(report["summary"]["fail"], junit.failures);
    assert_eq!(report["summary"]["error"], junit.errors);
    let failed = junit.test_suites[0].test_cases.iter().find_map(|test| match &test.status {
        TestCaseStatus::NonSuccess { kind: NonSuccessKind::Failure, message, .. } => {
            Some((test.name.as_str(), message.as_ref().map_or("", |it| it.as_str())))
        }
        _ => None,
    });
    let (name, message) = failed.expect("a failure");
    assert_eq!(name, "exact");
    assert!(message.contains("50 % of <it>, & so") && message.contains("\"x\""), "{message}");
}

#[test]
fn failures_are_annotated_under_the_service_only() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = failing_case(folder.path()).display().to_string();
    let arguments = ["validate", "--cases", &cases, "-e", "^exact$"];
    let quiet = percuss(&arguments).env_remove("GITHUB_ACTIONS").output().expect("ran");
    let annotated = percuss(&arguments).env("GITHUB_ACTIONS", "true").output().expect("ran");
    assert_eq!((quiet.status.code(), annotated.status.code()), (Some(1), Some(1)));
    assert_eq!(quiet.stdout, annotated.stdout);
    assert_eq!(text(&quiet.stderr), "");
    let said = text(&annotated.stderr);
    assert_eq!(said.lines().count(), 1, "{said}");
    let file = Path::new(&cases).join("small-b.toml").display().to_string();
    let begin = format!("::error file={file},title=small-b%3A 1 row out of bounds::fail: exact: ");
    assert!(said.starts_with(&begin) && said.contains("50 %25 of <it>, & so%0Aon"), "{said}");
}

#[test]
fn a_case_inside_the_binary_is_annotated_at_its_place_in_the_repository() {
    let case = percuss_validation::case::embedded().expect("cases").swap_remove(0);
    let note = percuss_validation::report::CaseNote::new(&case, true);
    assert!(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(&note.file).is_file(),
        "{note:?}"
    );
}
