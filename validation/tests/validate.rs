//! `validate` through the real binary: exit codes, bounds and shortcomings as data.

#![allow(clippy::expect_used, reason = "a panic is a failed test")]

mod support;

use std::fs;
use std::path::Path;
use support::{run, stdout, text};

/// A few regimes serve here, unoptimised: CI runs the whole suite in a release build.
#[test]
fn every_engine_is_within_its_bounds() {
    let cases = "^(chaos-from-rest|table1-first-row|graze-overlap-1e-6|stiff-xi-0-03|cycle-1e8)$";
    let table = stdout(&["validate", "-c", cases]);
    for library in ["exact", "diffsol-", "ode_solvers-", "differential-equations-"] {
        assert!(table.contains(library), "{table}");
    }
    assert!(table.contains(" 0 fail, 0 error"), "{table}");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let columns = |threads: &str| {
        let folder = tempfile::tempdir().expect("a folder");
        stdout(&[
            "validate",
            "-c",
            "fig7",
            "--threads",
            threads,
            "--out",
            &folder.path().display().to_string(),
        ]);
        let csv = fs::read_to_string(folder.path().join("errors.csv")).expect("read");
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let wall = reader.headers().expect("a header").iter().position(|name| name == "wall_ns");
        let kept = |(i, field): (usize, &str)| (Some(i) != wall).then(|| field.to_owned());
        let rows = reader.records().map(|row| row.expect("a row"));
        rows.map(|row| row.iter().enumerate().filter_map(kept).collect::<Vec<_>>())
            .collect::<Vec<_>>()
    };
    assert_eq!(columns("1"), columns("3"));
}

#[test]
fn without_out_no_file_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = support::percuss(&["validate", "-c", "small-b", "-e", "exact"]);
    assert!(command.current_dir(folder.path()).output().expect("ran").status.success());
    assert_eq!(fs::read_dir(folder.path()).map(Iterator::count).ok(), Some(0));
}

/// A row that would cost too much says so, and is no lack of an engine.
#[test]
fn a_row_beyond_the_budget_is_not_run() {
    let arguments = ["validate", "-c", "^resonance$", "-e", "rk4", "--require"];
    let output = run(&arguments);
    let table = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{table}");
    assert!(table.contains("not run: ") && table.contains("3 unavailable"), "{table}");
}

/// `small-b` with more said about it.
fn validate_with(more: &str) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/small-b.toml");
    let case = fs::read_to_string(case).expect("read") + more;
    fs::write(folder.path().join("small-b.toml"), case).expect("written");
    let output =
        run(&["validate", "--cases", &folder.path().display().to_string(), "-e", "exact|dopri5"]);
    (output.status.code(), text(&output.stdout))
}

#[test]
fn a_bound_that_is_passed_is_exit_1() {
    let bound = "[[bounds]]\nengine = \"exact\"\nquantity = \"state_error\"\nstatistic = \"max\"\nlimit = 1e-30\nwhy = \"test\"\n";
    let (code, table) = validate_with(bound);
    assert_eq!(code, Some(1), "{table}");
    assert!(
        table.contains("fail: small-b exact -: state error") && table.contains("1 fail"),
        "{table}"
    );
}

#[test]
fn a_shortcoming_that_shows_is_expected_and_one_that_does_not_is_out_of_date() {
    let shortcoming = |at_least: &str| {
        format!(
            "[[shortcomings]]\nengine = \"ode_solvers-dopri5\"\ntolerance = 1e-9\nquantity = \"state_error\"\n\
             statistic = \"max\"\nat_least = {at_least}\nwhy = \"test\"\n\
             [[bounds]]\nengine = \"ode_solvers-dopri5\"\ntolerance = 1e-9\nquantity = \"state_error\"\n\
             statistic = \"max\"\nlimit = 1e-12\nwhy = \"test\"\n"
        )
    };
    let (code, table) = validate_with(&shortcoming("1e-12"));
    assert_eq!(code, Some(0), "{table}");
    assert!(table.contains("1 of them as known shortcomings"), "{table}");
    let (code, table) = validate_with(&shortcoming("1.0"));
    assert_eq!(code, Some(1), "{table}");
    assert!(table.contains("the data are out of date"), "{table}");
}

#[test]
fn a_report_is_no_worse_than_itself_and_worse_than_a_better_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let chosen = ["validate", "-c", "^small-b$", "-e", "exact|dopri5$"];
    let first = run(&[&chosen[..], &["--out", &out]].concat());
    assert_eq!(first.status.code(), Some(0), "{}", text(&first.stderr));
    let report = folder.path().join("report.json");
    let against = |path: &Path| {
        let output = run(&[&chosen[..], &["--baseline", &path.display().to_string()]].concat());
        (output.status.code(), text(&output.stderr))
    };
    assert_eq!(against(&report), (Some(0), String::new()));

    let mut better: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&report).expect("read")).expect("JSON");
    for row in better["results"].as_array_mut().expect("rows") {
        if row["engine"] != "exact" {
            row["state_error"]["max"] = 1e-13.into();
        }
    }
    let path = folder.path().join("better.json");
    fs::write(&path, better.to_string()).expect("written");
    let (code, said) = against(&path);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("worse than the baseline: small-b ode_solvers-dopri5"), "{said}");
    assert!(!said.contains("small-b exact"), "{said}");
}
