//! Case files and reference data that are wrong: exit 2, one line, with file and line.

use crate::support::{refused, run};
use std::fs;
use std::path::{Path, PathBuf};

fn package() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// A folder with the one case `small-b` as changed by `change`.
fn changed(folder: &Path, change: impl Fn(String) -> String) -> String {
    let text = fs::read_to_string(package().join("cases/small-b.toml")).expect("read");
    fs::write(folder.join("small-b.toml"), change(text)).expect("written");
    folder.display().to_string()
}

#[test]
fn fields_that_are_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let wrong: [(&str, &str, &[&str]); 13] = [
        ("xi = ", "xi = -", &["small-b.toml:", "xi =", "1e-8 <= xi"]),
        ("periods = ", "periods = -", &["small-b.toml:", "periods = -60"]),
        ("periods = 60", "periods = 1000000001", &["periods = 1000000001"]),
        ("periods = 60", "until = -1.0", &["until = -1.0", "at or after the start"]),
        ("periods = 60", "until = nan", &["until = nan"]),
        ("periods = 60", "periods = 60\nuntil = 3.0", &["exactly one of periods and until"]),
        ("periods = 60", "", &["exactly one of periods and until"]),
        ("[horizon]", "[horizons]", &["horizons"]),
        ("regime = ", "regimen = ", &["regimen"]),
        ("name = \"small-b\"", "name = \"../small b\"", &["small-b.toml:2:", "name"]),
        (
            "[horizon]",
            "[[bounds]]\nengine = \"(\"\nquantity = \"state_error\"\nstatistic = \"max\"\nlimit = 1\nwhy = \"-\"\n[horizon]",
            &["small-b.toml:", "engine = \"(\" is not accepted: a string, a regular expression"],
        ),
        (
            "[horizon]",
            "[[shortcomings]]\nengine = \"x\"\nwhy = \"-\"\n[horizon]",
            &["quantity is missing here; accepted is a string, one of its names"],
        ),
        (
            "[horizon]",
            "[[shortcomings]]\nengine = \"x\"\nquantity = \"state_error\"\nat_least = 2\nat_most = 1\nwhy = \"-\"\n[horizon]",
            &["at_least = 2.0 and at_most = 1.0 are not accepted", "at_least is at most at_most"],
        ),
    ];
    for (from, to, wanted) in wrong {
        let cases = changed(folder.path(), |text| text.replacen(from, to, 1));
        refused(&["validate", "--cases", &cases], wanted);
    }
    let bound = "[[bounds]]\nengine = \"x\"\nquantity = \"state_error\"\nstatistic = \"max\"\nlimit = LIMIT\nwhy = \"-\"\n";
    for (from, to, wanted) in [
        ("LIMIT", "nan", "limit = nan is not accepted: a number"),
        ("limit = LIMIT\n", "", "limit is missing here; accepted is a number"),
        ("why = \"-\"\n", "", "why is missing here; accepted is a string"),
        ("max", "mean", "mean"),
        ("state_error", "speed", "speed"),
    ] {
        let bound = bound.replace(from, to).replace("LIMIT", "1");
        let cases = changed(folder.path(), |text| text + &bound);
        refused(&["validate", "--cases", &cases], &["small-b.toml:", wanted]);
    }
}

#[test]
fn a_wrong_key_of_a_bound_is_named_with_its_own_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let bound = "[[bounds]]\nengine = \"x\"\nquantity = \"state_error\"\nstatistic = \"max\"\nlimit = 1\nwhy = \"-\"\n";
    for (key, from, to) in [("engine", "\"x\"", "\"(\""), ("limit", "= 1", "= nan")] {
        let wrong = bound.replacen(from, to, 1);
        let cases = changed(folder.path(), |text| text + &wrong);
        let text = fs::read_to_string(folder.path().join("small-b.toml")).expect("read");
        let lines: Vec<_> = text.lines().collect();
        let place = lines.iter().rposition(|line| line.starts_with(key)).expect("the key");
        let wanted = format!("small-b.toml:{}: {key} = ", place + 1);
        refused(&["validate", "--cases", &cases], &[&wanted]);
    }
}

#[test]
fn folders_that_are_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    refused(&["validate", "--cases", &folder.path().display().to_string()], &["holds no case"]);
    let cases = changed(folder.path(), |text| text);
    fs::copy(folder.path().join("small-b.toml"), folder.path().join("again.toml")).expect("copied");
    refused(&["validate", "--cases", &cases], &["two cases", "small-b"]);
}

#[test]
fn reference_data_that_were_altered() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["manifest.json", "events/small-b.csv", "samples/small-b.csv"] {
        let target = folder.path().join(name);
        fs::create_dir_all(target.parent().expect("a parent")).expect("made");
        fs::copy(package().join("../reference_data").join(name), target).expect("copied");
    }
    let reference = folder.path().display().to_string();
    let validate = ["validate", "-c", "^small-b$", "-e", "^exact$", "--reference", &reference];
    assert_eq!(run(&validate).status.code(), Some(0));
    let table = folder.path().join("samples/small-b.csv");
    let whole = fs::read_to_string(&table).expect("read");
    fs::write(&table, whole.replacen("1,no-contact", "1,contact", 1)).expect("written");
    refused(&validate, &["samples/small-b.csv", "SHA-256", "manifest"]);
    fs::remove_file(&table).expect("removed");
    refused(&validate, &["samples/small-b.csv", "cannot be read"]);
    fs::write(folder.path().join("manifest.json"), "{\"files\": {}}").expect("written");
    refused(&validate, &["events/small-b.csv", "manifest"]);
    fs::write(folder.path().join("manifest.json"), "{").expect("written");
    refused(&validate, &["manifest.json", "line 1"]);
}

#[test]
fn a_table_of_another_problem() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = changed(folder.path(), |text| text.replacen("a = 0.3", "a = 0.31", 1));
    refused(&["validate", "--cases", &cases], &["events/small-b.csv", "a = 0.3", "0.31"]);
}

#[test]
fn a_margin_is_a_number() {
    let folder = tempfile::tempdir().expect("a folder");
    let with = |margin: &str| {
        let stated = format!("[case]\nmargin = {margin}");
        changed(folder.path(), |text| text.replacen("[case]", &stated, 1))
    };
    refused(&["validate", "--cases", &with("nan")], &["small-b.toml:2:", "margin = nan"]);
    refused(&["validate", "--cases", &with("\"wide\"")], &["small-b.toml:2:"]);
    let cases = with("-1e-3");
    assert_eq!(run(&["validate", "--cases", &cases, "-e", "^exact$"]).status.code(), Some(0));
}

#[test]
fn probes_are_what_is_known() {
    let folder = tempfile::tempdir().expect("a folder");
    let with =
        |probes: &str| changed(folder.path(), |text| format!("{text}\n[probes]\n{probes}\n"));
    for (probes, wanted) in [
        ("valid_within = 0", &["small-b.toml:", "valid_within = 0", "1 to 1000"][..]),
        ("valid_within = 1001", &["valid_within = 1001"]),
        ("integrators = 3", &["small-b.toml:", "boolean"]),
        ("restarts = true", &["small-b.toml:", "restarts"]),
        // Errors do not grow on a periodic orbit.
        ("valid_within = 20", &["small-b.toml", "valid_within = 20", "grow from eps to 1e-3"]),
    ] {
        refused(&["validate", "--cases", &with(probes)], wanted);
    }
    let cases = with("integrators = true");
    assert_eq!(run(&["validate", "--cases", &cases, "-e", "^exact$"]).status.code(), Some(0));
}
