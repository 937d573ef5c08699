//! Every flag and field of the contract out of its range, not a number, infinite, missing,
//! contradictory; files that cannot be read or written: exit 2 and one line that names the culprit.

use crate::support::{refused, run};

/// Flag, and what is beyond its range on either side.
const RANGES: [(&str, &[&str]); 11] = [
    ("--a", &["-1", "1.1e9"]),
    ("--b", &["-1.1e9", "1.1e9"]),
    ("--xi", &["0", "-0.1", "9e-9", "1.1e4"]),
    ("--omega", &["0", "-1", "9e-7", "1.1e6"]),
    ("--g", &["-1e-300", "1.1e9"]),
    ("--phi", &["-1.1e15", "1.1e15"]),
    ("--tau", &["-1.1e15", "1.1e15"]),
    ("--p", &["-1.1e9", "1.1e9"]),
    ("--y", &["-1.1e9", "1.1e9"]),
    ("--q", &["-1.1e9", "1.1e9"]),
    ("--v", &["-1.1e9", "1.1e9"]),
];

fn simulate<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["simulate", "--periods", "1"], more].concat()
}

#[test]
fn numbers_out_of_range_or_not_finite() {
    for (flag, values) in RANGES {
        for value in values.iter().chain(&["nan", "inf", "-inf", "NaN", "infinity"]) {
            refused(&simulate(&[flag, value]), &[flag, "is not accepted: "]);
            refused(&simulate(&[&format!("{flag}={value}")]), &[flag, "is not accepted"]);
        }
        for value in ["", "x", "1,5", "0x10", "1e", "--", "one"] {
            refused(&simulate(&[&format!("{flag}={value}")]), &[flag, value]);
        }
        refused(&simulate(&[flag]), &[flag]);
        refused(&simulate(&[flag, "0.5", flag, "0.5"]), &[flag]);
    }
}

#[test]
fn cycles_and_phases() {
    for value in ["9007199254740993", "-9007199254740993"] {
        refused(&simulate(&["--cycle", value]), &["--cycle", "2^53"]);
    }
    for value in ["1.5", "nan", "1e300", "9223372036854775808", ""] {
        refused(&simulate(&[&format!("--cycle={value}")]), &["--cycle", value, "integer"]);
    }
    for value in ["flight", "Contact", "", "end"] {
        refused(
            &simulate(&[&format!("--phase={value}")]),
            &["--phase", value, "no-contact, contact, progression"],
        );
    }
}

#[test]
fn contradictory_starts() {
    refused(&simulate(&["--p", "1", "--q", "0.5"]), &["--p", "q + g"]);
    refused(
        &simulate(&["--p", "0.5", "--q", "0", "--phase", "contact"]),
        &["--phase", "by more than 1e-4"],
    );
    refused(
        &simulate(&["--p", "0.02", "--q", "0", "--y", "200", "--phase", "contact"]),
        &["--phase", "y"],
    );
    refused(
        &simulate(&["--p", "0.02", "--q", "0", "--y", "-1", "--phase", "progression"]),
        &["--phase", "y"],
    );
    refused(
        &simulate(&["--p", "0.52", "--q", "0.5", "--y", "1", "--phase", "no-contact"]),
        &["--phase"],
    );
}

#[test]
fn lengths_of_a_run() {
    refused(&["simulate"], &["--events", "--periods", "--until"]);
    refused(&["simulate", "--events", "3", "--periods", "2"], &["--events", "--periods"]);
    refused(&["simulate", "--until", "3", "--periods", "2"], &["--until", "--periods"]);
    refused(&["simulate", "--until", "3", "--events", "2"], &["--until", "--events"]);
    for value in ["-1", "1.5", "1000000001", "nan", "inf", ""] {
        refused(&["simulate", &format!("--periods={value}")], &["--periods", value]);
    }
    for value in ["-1", "1.5", "nan", ""] {
        refused(&["simulate", &format!("--events={value}")], &["--events", value]);
    }
    for value in ["-0.001", "nan", "inf", "-inf", "1e300", "1e10"] {
        refused(
            &["simulate", &format!("--until={value}")],
            &["--until", "is not accepted", "at or after the start"],
        );
    }
    refused(&["simulate", "--until", "5", "--tau", "5.001"], &["--until 5 is", "5.001"]);
    for value in ["0", "-1", "1.5", "x", "4294967296"] {
        refused(
            &["simulate", "--periods", "1", &format!("--samples={value}")],
            &["--samples", value],
        );
        let max_periods =
            format!("--max-periods={}", if value == "4294967296" { "1000000001" } else { value });
        refused(&["simulate", "--events", "1", &max_periods], &["--max-periods"]);
    }
    for value in ["0", "-1", "x", "1.5", "100000"] {
        refused(&simulate(&[&format!("--threads={value}")]), &["--threads", value]);
    }
}

#[test]
fn problem_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |text: &str| {
        let path = folder.path().join("problem.toml");
        std::fs::write(&path, text).expect("written");
        path.display().to_string()
    };
    let names = [
        ("parameters", "a", "-1.0"),
        ("parameters", "b", "2e9"),
        ("parameters", "xi", "0"),
        ("parameters", "omega", "nan"),
        ("parameters", "g", "-0.1"),
        ("parameters", "phi", "inf"),
        ("start", "tau", "1e16"),
        ("start", "p", "-inf"),
        ("start", "y", "1e10"),
        ("start", "q", "nan"),
        ("start", "v", "1e10"),
        ("start", "cycle", "9007199254740993"),
    ];
    for (table, name, value) in names {
        let path = file(&format!("# a comment\n[{table}]\n{name} = {value}\n"));
        refused(
            &simulate(&["--problem", &path]),
            &[&format!("problem.toml:3: {name} ="), "is not accepted"],
        );
        let path = file(&format!("[{table}]\n{name} = \"text\"\n"));
        refused(&simulate(&["--problem", &path]), &["problem.toml:2:", name, "text"]);
        let path = file(&format!("[{table}]\n\n{name} = 0.5\n{name} = 0.5\n"));
        refused(&simulate(&["--problem", &path]), &["problem.toml:4:", name]);
    }
    refused(
        &simulate(&["--problem", &file("[start]\nphase = \"flight\"\n")]),
        &["problem.toml:2:", "flight", "no-contact"],
    );
    refused(&simulate(&["--problem", &file("[start]\ncycle = 1.5\n")]), &["problem.toml:2:"]);
    refused(
        &simulate(&["--problem", &file("[start]\np = 1.0\nq = 0.0\n")]),
        &["problem.toml:2:", "q + g"],
    );
    refused(
        &simulate(&["--problem", &file("[parameters]\nomga = 1.0\n")]),
        &["problem.toml:2:", "omga", "omega"],
    );
    refused(&simulate(&["--problem", &file("[start]\nx = 1.0\n")]), &["problem.toml:2:", "x"]);
    refused(&simulate(&["--problem", &file("[model]\na = 1.0\n")]), &["problem.toml:1:", "model"]);
    refused(&simulate(&["--problem", &file("a = 1.0\n")]), &["problem.toml:1:", "a"]);
    refused(&simulate(&["--problem", &file("[parameters\n")]), &["problem.toml:1:"]);
    refused(&simulate(&["--problem", &file("parameters = 3\n")]), &["problem.toml:1:"]);
    std::fs::write(folder.path().join("latin.toml"), b"# \xe9\n").expect("written");
    let latin = folder.path().join("latin.toml").display().to_string();
    refused(&simulate(&["--problem", &latin]), &["latin.toml", "UTF-8"]);
    refused(
        &simulate(&["--problem", "/no/such.toml"]),
        &["--problem", "/no/such.toml", "cannot be read"],
    );
    refused(&simulate(&["--problem", "/"]), &["--problem", "cannot be read"]);
    refused(&simulate(&["--problem"]), &["--problem"]);
}

#[test]
fn outputs() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    refused(
        &simulate(&["--output", "/no/such/folder/run.csv"]),
        &["/no/such/folder/run.csv", "cannot be written"],
    );
    refused(&simulate(&["--output", &at("run.xls")]), &["--output", "xls", "csv, json, png, svg"]);
    refused(
        &simulate(&["--output", &at("run.csv"), "--format", "json"]),
        &["--format json", "csv"],
    );
    refused(&simulate(&["--format", "xml"]), &["--format", "xml", "csv"]);
    refused(
        &simulate(&["--output", &folder.path().display().to_string(), "--format", "csv"]),
        &["cannot be written"],
    );
    refused(&simulate(&["--output"]), &["--output"]);
    refused(
        &["simulate", "--periods", "6000", "--output", &at("run.png")],
        &["--output", "forcing periods"],
    );
    refused(&["engines", "--format", "xml"], &["--format", "xml"]);
    refused(
        &["engines", "--output", "/no/such/folder/list"],
        &["/no/such/folder/list", "cannot be written"],
    );
    assert_eq!(
        std::fs::read_dir(folder.path()).map(Iterator::count).ok(),
        Some(0),
        "nothing is left behind"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device() {
    refused(
        &simulate(&["--output", "/dev/full", "--format", "csv"]),
        &["/dev/full", "cannot be written"],
    );
}

#[test]
fn verbs_and_flags_that_do_not_exist() {
    refused(&[], &["no verb", "simulate"]);
    refused(&["simulat"], &["simulat"]);
    refused(&["simulate", "--periods", "1", "--omga", "1"], &["--omga"]);
    refused(&["simulate", "--periods", "1", "stray"], &["stray"]);
    refused(&["validate", "--omega", "1"], &["--omega"]);
    for arguments in [
        &["--help"][..],
        &["simulate", "--help"],
        &["validate", "-h"],
        &["engines", "--help"],
        &["--version"],
    ] {
        assert!(run(arguments).status.success(), "{arguments:?}");
    }
}

#[test]
fn selections_that_match_nothing() {
    refused(&["validate", "-e", "sundials"], &["--engine sundials", "percuss engines"]);
    refused(&["validate", "-e", "difsol-bdf"], &["--engine difsol-bdf", "nearest", "diffsol-bdf"]);
    refused(&["validate", "-c", "no-such-case"], &["--case no-such-case", "percuss cases"]);
    refused(&["validate", "-c", "^grase-miss"], &["--case ^grase-miss", "graze-miss-1e-3"]);
    refused(&["bench", "-c", "tabel1"], &["--case tabel1", "table1-from-rest"]);
    refused(&["bench", "-e", "dopri9"], &["--engine dopri9", "ode_solvers-dopri5"]);
    refused(
        &["reproduce", "--out", "x", "--only", "figur-7"],
        &["--only figur-7", "nearest", "figure-7"],
    );
    refused(&["validate", "-e", "("], &["--engine", "(", "regular expression"]);
    refused(&["validate", "-c", "["], &["--case", "[", "regular expression"]);
    refused(&["validate", "--suite", "slow"], &["--suite", "slow", "quick, full"]);
    refused(&["validate", "--threads", "0"], &["--threads", "0"]);
    refused(&["validate", "--cases", "/no/such"], &["--cases", "/no/such", "cannot be read"]);
    refused(
        &["validate", "--reference", "/no/such"],
        &["--reference", "/no/such", "cannot be read"],
    );
    refused(&["validate", "--baseline", "/no/such.json"], &["--baseline", "/no/such.json"]);
    refused(&["validate", "-c", "small-b", "--out", "/proc/nowhere"], &["--out", "/proc/nowhere"]);
}
