//! `score`: derivatives through events in files.

use crate::support::{run, text};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

const CASE: &str = "torchdiffeq-208";

fn reference(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference_data/gradients").join(file)
}

/// The proved table as an answer: `n,event,wrt,dtime` and the states.
fn proved_table() -> String {
    let table = fs::read_to_string(reference(&format!("{CASE}.csv"))).expect("a table");
    let lines = table.lines().filter(|it| !it.starts_with('#'));
    let cells = lines.map(|it| it.split(',').collect::<Vec<_>>());
    let line = |it: Vec<&str>| [&[it[0], it[1], it[3]], &it[5..]].concat().join(",") + "\n";
    cells.map(line).collect()
}

/// The exit code, stderr, and the names, verdicts and reasons of `score` on a file of derivatives.
fn score(gradients: &str) -> (Option<i32>, String, Vec<[String; 3]>) {
    score_with(&[], Some(gradients))
}

/// What [`score`] gives with further flags; there may be no file of derivatives.
fn score_with(flags: &[&str], gradients: Option<&str>) -> (Option<i32>, String, Vec<[String; 3]>) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let system = reference(&format!("{CASE}.system.toml"));
    let events = run(&["events", system.to_str().expect("UTF-8"), "--until", "4"]);
    fs::write(path(&format!("{CASE}.events.csv")), &events.stdout).expect("written");
    if let Some(gradients) = gradients {
        fs::write(path(&format!("{CASE}.gradients.csv")), gradients).expect("written");
    }
    let (answers, out) = (path("").display().to_string(), path("out").display().to_string());
    let asked = ["score", "--name", "mine", "--tolerance", "1e-9", "--answers", &answers];
    let output = run(&[&asked[..], &["-c", CASE, "--out", &out], flags].concat());
    let report = fs::read(path("out").join("report.json")).ok();
    let report: Value = report.map_or(Value::Null, |it| serde_json::from_slice(&it).expect("JSON"));
    let word = |it: &Value, key: &str| it[key].as_str().expect("a word").to_owned();
    let rows = report["gradients"].as_array().into_iter().flatten();
    let verdicts = rows.map(|it| ["wrt", "verdict", "why"].map(|key| word(it, key))).collect();
    (output.status.code(), text(&output.stderr), verdicts)
}

fn verdicts(gradients: &str) -> Vec<String> {
    let (code, said, found) = score(gradients);
    assert_eq!(code, Some(0), "{said}");
    let names: Vec<&str> = found.iter().map(|it| it[0].as_str()).collect();
    assert_eq!(names, ["bound", "collapse", "drift", "leak"]);
    found.into_iter().map(|[_, verdict, _]| verdict).collect()
}

#[test]
fn proved_derivatives_are_right_and_others_are_named() {
    let proved = proved_table();
    assert_eq!(verdicts(&proved), ["right"; 4]);
    // By one name all are zero, and by another there is no end.
    let change = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        match (cells[1], cells[2]) {
            (_, "bound") => Some([&cells[..3], &["0", "0", "0"]].concat().join(",")),
            ("end", "drift") => None,
            _ => Some(line.to_owned()),
        }
    };
    let changed: Vec<String> = proved.lines().filter_map(change).collect();
    assert_eq!(verdicts(&changed.join("\n")), ["zero", "right", "refused", "right"]);
    // Derivatives of the end alone leave those of the events out.
    let is_kept = |it: &&str| it.starts_with("n,") || it.contains(",end,");
    let ends: Vec<&str> = proved.lines().filter(is_kept).collect();
    assert_eq!(verdicts(&ends.join("\n")), ["right"; 4]);
}

/// Some step of differences explains the thousandth by which one cell is off: it is named where the
/// answers are said to be differences.
#[test]
fn a_step_is_a_cause_where_the_answers_are_differences() {
    let proved = proved_table();
    let end = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        (cells[1] == "end").then(|| {
            let slope: f64 = cells[4].parse().expect("a number");
            [&cells[..4], &[&(slope * 1.001).to_string(), cells[5]]].concat().join(",")
        })
    };
    let header = proved.lines().next().map(str::to_owned);
    let answer: Vec<String> = header.into_iter().chain(proved.lines().filter_map(end)).collect();
    let answer = answer.join("\n");
    for (flags, is_named) in [(&["--differences"][..], true), (&[], false)] {
        let (code, said, found) = score_with(flags, Some(&answer));
        assert_eq!(code, Some(0), "{said}");
        let named = found.iter().filter(|it| it[2].contains("differences over a step of"));
        assert_eq!(named.count() > 0, is_named, "{flags:?}: {found:?}");
    }
}

#[test]
fn differences_without_derivatives_are_refused() {
    let (code, said, _) = score_with(&["--differences"], None);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("--differences") && said.contains("CASE.gradients.csv"), "{said}");
}

#[test]
fn mistakes_are_named_with_their_line() {
    let header = "n,event,wrt,dtime,dx,dclock\n";
    for (lines, expected) in [
        ("1,collapse,bond,0,0,0", "line 2: wrt is \"bond\"; accepted are bound, collapse"),
        ("1,collapse,bound,x,0,0", "line 2: dtime is \"x\"; accepted is a finite number"),
        ("1,collapse,bound,0,0,NaN", "line 2: dclock is \"NaN\""),
        ("-1,collapse,bound,0,0,0", "line 2: n is \"-1\"; accepted is a whole number"),
        ("1,a,bound,0,0,0\n1,a,bound,0,0,0", "line 3: event 1 comes after event 1"),
        ("2,end,bound,0,0,0\n3,a,bound,0,0,0", "line 3: a line by \"bound\" after its end"),
        ("1,collapse,bound,0,0", "line 2: 5 columns; accepted are 6"),
    ] {
        let (code, said, found) = score(&format!("{header}{lines}\n"));
        assert_eq!(code, Some(0), "{said}");
        assert!(found.iter().all(|it| it[1] == "refused"), "{lines}: {found:?}");
        assert!(found.iter().all(|it| it[2].contains(expected)), "{lines}: {found:?}");
    }
}
