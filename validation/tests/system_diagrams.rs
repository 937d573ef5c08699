//! `bifurcation SYSTEM`: tables, pictures, and what is said of values that are left out.

use crate::support::{number, rows, run, stdout, text};

/// A diagram of the rigid impact oscillator over its stop.
fn rig(more: &[&str]) -> Vec<String> {
    let usual = ["bifurcation", "rigid-impact-oscillator", "--parameter", "d", "--transient", "30"];
    usual.iter().chain(more).map(|it| (*it).to_owned()).collect()
}

fn borrowed(words: &[String]) -> Vec<&str> {
    words.iter().map(String::as_str).collect()
}

#[test]
fn rows_have_the_value_the_mode_and_the_states() {
    let words = rig(&[
        "--from",
        "0.2",
        "--to",
        "0.3",
        "--steps",
        "3",
        "--returns",
        "4",
        "--section",
        "impact",
    ]);
    let table = stdout(&borrowed(&words));
    assert!(table.starts_with("parameter,n,mode,x,v\n"), "{table}");
    let rows = rows(&table);
    assert_eq!(rows.len(), 12);
    for (k, row) in rows.iter().enumerate() {
        // Just after an impact the mass is at its stop, which is the parameter.
        assert_eq!((&row[1], row[2].as_str(), &row[3]), (&(k % 4).to_string(), "free", &row[0]));
        assert!(number(&row[4]) < 0.0, "{row:?}");
    }
    assert_eq!([&rows[0][0], &rows[4][0], &rows[11][0]].map(|it| number(it)), [0.2, 0.25, 0.3]);
}

#[test]
fn threads_change_nothing() {
    let with = |threads: &str, how: &str| {
        let more = ["--from", "0.2", "--to", "0.3", "--steps", "70", "--returns", "3"];
        let more = [&more[..], &["--threads", threads, how]].concat();
        stdout(&borrowed(&rig(&more)))
    };
    for how in ["--carry", "--reset"] {
        assert_eq!(with("1", how), with("3", how));
    }
}

/// The stop moves towards the mass, which was left at it.
#[test]
fn values_that_are_left_out_are_counted() {
    let more = ["--from", "0.2", "--to", "0.1", "--steps", "3", "--returns", "2"];
    let more = [&more[..], &["--section", "impact"]].concat();
    let output = run(&borrowed(&rig(&more)));
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("2 of 3 values are left out (first: d = 0.15"), "{said}");
    assert!(said.contains("starts from the last that is not"), "{said}");
    assert_eq!(text(&output.stdout).lines().count(), 3);
    assert_eq!(stdout(&borrowed(&rig(&[&more[..], &["--reset"]].concat()))).lines().count(), 7);
}

#[test]
fn pictures_are_pictures() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["d.png", "d.svg"] {
        let path = folder.path().join(name);
        let more = ["--from", "0.2", "--to", "0.3", "--steps", "9", "--returns", "9", "--output"];
        stdout(&borrowed(&rig(&[&more[..], &[path.to_str().unwrap()]].concat())));
        let bytes = std::fs::read(path).unwrap();
        assert!(bytes.starts_with(b"\x89PNG") || bytes.starts_with(b"<"), "{name}");
    }
}

/// The forcing's frequency is what its file says, and an unknown name says which.
#[test]
fn the_forcing_is_set_by_its_parameter() {
    let words = ["bifurcation", "rigid-impact-oscillator", "--parameter", "omega"];
    let more = ["--from", "2", "--to", "3", "--steps", "2", "--transient", "1", "--returns", "1"];
    let output = run(&[&words[..], &more].concat());
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("omega is frequency") && said.lines().count() == 1, "{said}");
}
