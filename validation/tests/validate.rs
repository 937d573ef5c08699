//! `validate` through the real binary: exit codes, bounds and shortcomings as data.

use crate::support;
use crate::support::{run, stdout, text};
use std::fs;
use std::path::Path;

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
            "^(fig7d-period-6|fig7f-chaos|graze-miss|relay-1e)",
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
    let arguments = ["validate", "-c", "^resonance$", "-e", "rk4", "--require", "--details"];
    let output = run(&arguments);
    let table = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{table}");
    assert!(table.contains("not run: ") && table.contains("3 not-run"), "{table}");
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
        table.contains("fail: small-b exact -: largest state error") && table.contains("1 fail"),
        "{table}"
    );
}

/// A stated shortcoming of dopri5 on a bound that it fails.
fn with_shortcoming(quantity: &str, at_least: &str, at_most: &str) -> (Option<i32>, String) {
    validate_with(&format!(
        "[[shortcomings]]\nengine = \"ode_solvers-dopri5\"\ntolerance = 1e-9\nquantity = \"{quantity}\"\n\
         statistic = \"max\"\nat_least = {at_least}\nat_most = {at_most}\nwhy = \"test\"\n\
         [[bounds]]\nengine = \"ode_solvers-dopri5\"\ntolerance = 1e-9\nquantity = \"state_error\"\n\
         statistic = \"max\"\nlimit = 1e-12\nwhy = \"test\"\n"
    ))
}

#[test]
fn a_shortcoming_is_known_within_its_range_alone() {
    let (code, table) = with_shortcoming("state_error", "1e-12", "1e-3");
    assert_eq!(code, Some(0), "{table}");
    assert!(table.contains(" 1 known, 0 fail"), "{table}");
    for (at_least, at_most) in [("1e-2", "1.0"), ("1e-13", "1.1e-12")] {
        let (code, table) = with_shortcoming("state_error", at_least, at_most);
        assert_eq!(code, Some(1), "{table}");
        assert!(table.contains("the data are out of date"), "{table}");
    }
}

#[test]
fn a_shortcoming_excuses_no_other_quantity() {
    let (code, table) = with_shortcoming("event_time_error", "1e-15", "1.0");
    assert_eq!(code, Some(1), "{table}");
    assert!(table.contains("state error") && table.contains(" 1 fail"), "{table}");
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
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    };
    let (code, said, _) = against(&report);
    assert_eq!(code, Some(0), "{said}");
    assert!(!said.contains("baseline"), "{said}");

    let mut better: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&report).expect("read")).expect("JSON");
    for row in better["results"].as_array_mut().expect("rows") {
        if row["engine"] != "exact" {
            row["state_error"]["max"] = 1e-13.into();
        }
    }
    let path = folder.path().join("better.json");
    fs::write(&path, better.to_string()).expect("written");
    let (code, said, _) = against(&path);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("worse than the baseline: small-b ode_solvers-dopri5"), "{said}");
    assert!(!said.contains("baseline: small-b exact"), "{said}");
}

/// A report of two engines on one case, and what a baseline with changed rows makes of it.
fn against_changed(
    change: impl Fn(&mut Vec<serde_json::Value>),
    more: &[&str],
) -> (Option<i32>, String) {
    changed(&["validate", "-c", "^small-b$", "-e", "exact|dopri5$"], change, more)
}

/// A report of chosen rows, and what a baseline with changed rows makes of it.
fn changed(
    chosen: &[&str],
    change: impl Fn(&mut Vec<serde_json::Value>),
    more: &[&str],
) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    run(&[chosen, &["--out", &out]].concat());
    let report = fs::read_to_string(folder.path().join("report.json")).expect("read");
    let mut earlier: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    change(earlier["results"].as_array_mut().expect("rows"));
    let path = folder.path().join("earlier.json").display().to_string();
    fs::write(&path, earlier.to_string()).expect("written");
    let output = run(&[chosen, &["--baseline", &path], more].concat());
    (output.status.code(), text(&output.stdout) + &text(&output.stderr))
}

#[test]
fn an_error_over_half_as_large_again_is_worse() {
    let scaled = |factor: f64| {
        move |rows: &mut Vec<serde_json::Value>| {
            for row in rows.iter_mut().filter(|row| row["engine"] != "exact") {
                let error = row["state_error"]["max"].as_f64().expect("a number");
                row["state_error"]["max"] = (error / factor).into();
            }
        }
    };
    assert_eq!(against_changed(scaled(1.45), &[]).0, Some(0));
    assert_eq!(against_changed(scaled(1.55), &[]).0, Some(1));
    let failed_before = |rows: &mut Vec<serde_json::Value>| rows[0]["verdict"] = "error".into();
    assert_eq!(against_changed(failed_before, &[]).0, Some(0));
}

/// Of several baselines the best counts, figure by figure: an error that grows by less than half
/// from each release to the next is seen beside the first.
#[test]
fn the_best_of_several_baselines_counts() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let chosen = ["validate", "-c", "^small-b$", "-e", "exact|dopri5$"];
    run(&[&chosen[..], &["--out", &out]].concat());
    let report = fs::read_to_string(folder.path().join("report.json")).expect("read");
    let earlier = |name: &str, factor: f64| {
        let mut report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        for row in report["results"].as_array_mut().expect("rows") {
            let error = row["state_error"]["max"].as_f64().expect("a number");
            row["state_error"]["max"] = (error / factor).into();
        }
        let path = folder.path().join(name).display().to_string();
        fs::write(&path, report.to_string()).expect("written");
        path
    };
    let (first, last) = (earlier("first.json", 1.9), earlier("last.json", 1.4));
    let against = |baselines: &[&str]| {
        let flags = baselines.iter().flat_map(|path| ["--baseline", path]);
        let output = run(&chosen.into_iter().chain(flags).collect::<Vec<_>>());
        (output.status.code(), text(&output.stdout))
    };
    assert_eq!(against(&[&last]).0, Some(0));
    for order in [[&first, &last], [&last, &first]] {
        let (code, said) = against(&order.map(String::as_str));
        assert_eq!(code, Some(1), "{said}");
        assert!(said.contains("worse than the baseline: small-b ode_solvers-dopri5"), "{said}");
    }
}

/// Rows that take over 1.2 times as many right-hand sides are named, and are no failure.
#[test]
fn a_row_that_has_become_dearer_is_named() {
    for (factor, is_named) in [(1.15, false), (1.25, true)] {
        let cheaper = move |rows: &mut Vec<serde_json::Value>| {
            for row in rows.iter_mut() {
                let now = row["rhs_evaluations"].as_u64().expect("a count");
                row["rhs_evaluations"] = ((now as f64 / factor).round() as u64).into();
            }
        };
        let (code, said) = against_changed(cheaper, &[]);
        assert_eq!(code, Some(0), "{said}");
        assert_eq!(
            said.contains("right-hand sides beside the baseline: small-b "),
            is_named,
            "{said}"
        );
    }
}

#[test]
fn one_more_missed_or_spurious_event_is_worse() {
    for (case, key, word) in [
        ("^graze-overlap-1e-3$", "events_missed", "missed"),
        ("^height-missed$", "events_spurious", "spurious"),
    ] {
        let chosen = ["validate", "-c", case, "-e", "^diffsol-|-events$"];
        let one_less = |rows: &mut Vec<serde_json::Value>| {
            let wrong = rows.iter_mut().find(|row| row[key].as_u64() > Some(0));
            let wrong = wrong.unwrap_or_else(|| panic!("{case}: no event is {word}"));
            wrong[key] = (wrong[key].as_u64().expect("a count") - 1).into();
        };
        assert_eq!(changed(&chosen, |_| (), &[]).0, Some(0), "{case}");
        let (code, said) = changed(&chosen, one_less, &[]);
        assert_eq!(code, Some(1), "{said}");
        let on_one_line = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(on_one_line.contains(&format!("events {word}, ")), "{said}");
    }
}

#[test]
fn a_row_that_is_gone_is_named_unless_that_is_allowed() {
    let more = |rows: &mut Vec<serde_json::Value>| {
        let mut row = rows[1].clone();
        row["engine"] = "ode_solvers-gone-dopri5".into();
        rows.push(row);
    };
    let (code, said) = against_changed(more, &[]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("ode_solvers-gone-dopri5") && said.contains("--allow-missing"), "{said}");
    assert_eq!(against_changed(more, &["--allow-missing"]).0, Some(0));
    // Another case was not asked for.
    let other = |rows: &mut Vec<serde_json::Value>| {
        let mut row = rows[1].clone();
        row["case"] = "no-gap".into();
        rows.push(row);
    };
    assert_eq!(against_changed(other, &[]).0, Some(0));
    let (code, said) = against_changed(|rows| rows.clear(), &[]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("no row in common"), "{said}");
}

/// A run that is given up at its limit of calls is an error.
#[test]
fn a_run_that_is_given_up_is_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let case = "[case]\nname = \"stiff\"\nregime = \"test\"\nwhy = \"stiffer than any explicit method\"\n\
                [parameters]\nxi = 1e-8\n[start]\nq = 0.5\n[horizon]\nperiods = 1\n";
    fs::write(folder.path().join("stiff.toml"), case).expect("written");
    let folder = folder.path().display().to_string();
    let output = run(&["validate", "--cases", &folder, "-e", "^ode_solvers-dopri5$"]);
    let table = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{table}");
    assert!(table.contains("3 error") && table.contains("gave up after"), "{table}");
}

/// A run without a result is an error, and an error is exit 1. Cases of one's own have no expected
/// failures.
#[test]
fn a_row_without_a_result_is_exit_1() {
    let folder = tempfile::tempdir().expect("a folder");
    for file in ["cases/systems/ball-forty-impacts.toml", "systems/bouncing-ball.system.toml"] {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let to = folder.path().join(from.file_name().expect("a name"));
        fs::copy(&from, to).expect("copied");
    }
    let folder = folder.path().display().to_string();
    let chosen = ["validate", "--cases", &folder, "-e", "^diffsol-bdf$", "--tolerance", "1e-9"];
    let output = run(&chosen);
    let table = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{table}");
    assert!(table.contains("1 error") && table.contains("error: ball-forty-impacts"), "{table}");
    // An error is worse than anything but an error.
    let was = |verdict: &'static str| {
        let change = move |rows: &mut Vec<serde_json::Value>| rows[0]["verdict"] = verdict.into();
        changed(&chosen, change, &[]).1
    };
    for verdict in ["pass", "known", "fail"] {
        assert!(was(verdict).contains(&format!("error, was {verdict}")), "{verdict}");
    }
    assert!(!was("error").contains("worse than the baseline"));
}

#[test]
fn every_line_of_the_summary_fits_a_hundred_columns() {
    let output = run(&["validate", "-c", "^(small-b|no-gap|resonance|stiff-xi-0-3)$"]);
    let said = text(&output.stdout);
    let widest = said.lines().map(|line| line.chars().count()).max();
    assert!(widest.is_some_and(|widest| widest <= 100), "{said}");
    assert!(said.lines().count() <= 30 && said.starts_with("Which integrator, "), "{said}");
    let details = ["validate", "-c", "^(small-b|no-gap|resonance|stiff-xi-0-3)$", "--details"];
    let said = text(&run(&details).stdout);
    let widest = said.lines().map(|line| line.chars().count()).max();
    assert!(widest.is_some_and(|widest| widest <= 100), "{said}");
    // A terminal shows the last lines: the first screen with nothing below.
    let order = ["not run: ", "rank (#): ", "fails on ", "Which integrator, ", " rows: "];
    let places = order.map(|word| said.find(word).unwrap_or_else(|| panic!("{word}: {said}")));
    assert!(places.is_sorted(), "{places:?} {said}");
    let few = stdout(&["validate", "-c", "^small-b$", "-e", "exact"]);
    assert!(few.contains("right/ mis-  ri-  bad"), "{few}");
}

/// The rows of every engine fit, those with the longest names and with steps among them.
#[test]
fn rows_fit_a_hundred_columns() {
    let said = stdout(&["validate", "-c", "^small-b$", "--rows"]);
    let rows = said.lines().take_while(|line| !line.is_empty());
    let widest = rows.map(|line| line.chars().count()).max();
    assert!(widest.is_some_and(|widest| widest <= 100), "{said}");
    for word in ["differential-equations-rkv655e-original", " 1/64 ", " 6/6 ", " not-run"] {
        assert!(said.contains(word), "{word}: {said}");
    }
}

/// Many failing cases are counted by system; rows and the other formats name them all.
#[test]
fn failing_cases_are_named_or_counted_by_system() {
    let cases =
        "^(graze-miss|cycle|fast-forcing|fig7[def]|never-stops|no-gap|resonance$|rigid-chaos)";
    let chosen = ["validate", "-e", "^(ode_solvers-dop853|diffsol-tsit45)$", "-c", cases];
    let json = stdout(&[&chosen[..], &["--format", "json"]].concat());
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let failing = |engine: &str| -> Vec<String> {
        let ranking = json["ranking"].as_array().expect("a ranking");
        let own = ranking.iter().find(|it| it["engine"] == engine).expect("the engine");
        let cases = own["fails_on"].as_array().expect("cases").iter();
        cases.map(|it| it.as_str().expect("a name").to_owned()).collect()
    };
    let (few, many) = (failing("diffsol-tsit45"), failing("ode_solvers-dop853"));
    assert!(!few.is_empty() && few.len() < 4 && many.len() > 15, "{few:?} {many:?}");
    let of_rigid = many.iter().filter(|it| it.starts_with("rigid-")).count();
    let block = |said: &str| {
        let (_, block) = said.split_once("\nfails on (").expect("a block");
        block.split("\n\n").next().map(|it| it.split_whitespace().collect::<Vec<_>>().join(" "))
    };
    let short = block(&stdout(&[&chosen[..], &["--details"]].concat())).expect("a block");
    assert!(
        short.contains(&format!("diffsol-tsit45: {} of 19: {}", few.len(), few.join(", "))),
        "{short}"
    );
    let counted = format!(
        "ode_solvers-dop853: {} of 19: oscillator {} of 17, rigid-impact-oscillator {} of 2",
        many.len(),
        many.len() - of_rigid,
        of_rigid
    );
    assert!(short.contains(&counted), "{counted}: {short}");
    let whole = block(&stdout(&[&chosen[..], &["--rows", "--details"]].concat())).expect("a block");
    let named = format!("ode_solvers-dop853: {} of 19: {}", many.len(), many.join(", "));
    assert!(whole.contains(&named), "{named}: {whole}");
}

#[test]
fn the_summary_has_other_formats() {
    let chosen = ["validate", "-c", "^small-b$", "-e", "exact|dopri5$", "--format"];
    let markdown = stdout(&[&chosen[..], &["markdown"]].concat());
    assert!(markdown.starts_with("| # | engine |"), "{markdown}");
    let csv = stdout(&[&chosen[..], &["csv"]].concat());
    assert_eq!(csv.lines().count(), 3, "{csv}");
    let json = stdout(&[&chosen[..], &["json"]].concat());
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["ranking"][0]["engine"], "exact");
    assert_eq!(json["summary"]["pass"], 4);
}
