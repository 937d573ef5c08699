//! What `validate` and `events` write of a user's own cases and systems.

use crate::support::{refused, run, stdout, text};
use std::path::Path;

/// A body between two walls: none of the repository's systems, and no name of the oscillator's.
const SHUTTLE: &str = "schema = 1
name = \"shuttle\"
states = [\"place\", \"speed\"]
[[mode]]
name = \"free\"
equations = [\"place' = speed\", \"speed' = 0\"]
[[mode.until]]
name = \"right\"
guard = \"place > 1\"
reset = [\"speed = -speed\"]
[[mode.until]]
name = \"left\"
guard = \"place < -1\"
reset = [\"speed = -speed\"]
[start]
mode = \"free\"
place = 0
speed = 1
";
const THERE_AND_BACK: &str = "[case]
name = \"there-and-back\"
system = \"shuttle\"
why = \"Each wall is met twice.\"
[horizon]
until = 8.0
";

fn shuttle_folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = folder.path().join("cases");
    std::fs::create_dir(&cases).expect("made");
    std::fs::write(cases.join("shuttle.system.toml"), SHUTTLE).expect("written");
    std::fs::write(cases.join("there-and-back.toml"), THERE_AND_BACK).expect("written");
    folder
}

fn path(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().expect("UTF-8").to_owned()
}

#[test]
fn the_report_of_own_cases_speaks_of_them() {
    let folder = shuttle_folder();
    let (cases, out) = (path(folder.path(), "cases"), path(folder.path(), "out"));
    let engines = "^(exact|ode_solvers-dopri5)$";
    let output = run(&["validate", "--cases", &cases, "-e", engines, "--out", &out]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let html = std::fs::read_to_string(folder.path().join("out/report.html")).expect("written");
    // The scripts serve every report; what they are given, and the page itself, are of this one.
    let (page, rest) = html.split_once("<script type=").expect("data");
    let (data, _) = rest.split_once("</script>").expect("an end");
    for part in [
        "Integrators on cases of your own, of the system shuttle,",
        "2 engines on 1 case.",
        "there are no tables of these cases",
        "run made again in 106 bits",
        "|difference| of a state (place, speed) over its scale",
        "a guard is crossed in its direction",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(data.contains("largest error of place, speed"), "{data}");
    for part in ["|dp|", "impact oscillator", "25 proved digits, made once", "the slider", "Fig. 6"]
    {
        assert!(!page.contains(part) && !data.contains(part), "{part}");
    }
    for section in ["grazing", "error-growth", "restarts", "attractors", "power"] {
        assert!(!page.contains(&format!("\"{section}\"")), "{section}");
        assert!(!page.contains(&format!("#{section}\"")), "{section}");
    }
}

/// A ball that is dropped from a million and a half.
const HIGH: &str = "schema = 1
name = \"high\"
states = [\"height\", \"speed\"]
[[mode]]
name = \"air\"
equations = [\"height' = speed\", \"speed' = -2000000\"]
[[mode.until]]
name = \"ground\"
guard = \"height < 0\"
reset = [\"speed = -speed\"]
[start]
mode = \"air\"
height = 1500000
speed = 0
";

#[test]
fn labels_of_large_states_share_a_power_of_ten() {
    let folder = tempfile::tempdir().expect("a folder");
    let [file, picture] = ["high.system.toml", "high.svg"].map(|it| folder.path().join(it));
    std::fs::write(&file, HIGH).expect("written");
    let [file, picture] = [&file, &picture].map(|it| it.to_str().expect("UTF-8"));
    stdout(&["events", file, "--until", "4", "--output", picture]);
    let svg = std::fs::read_to_string(picture).expect("written");
    // Each state names its power beside its own panel and in the plane of both.
    for (name, count) in [("height, in 10\u{2076}", 2), ("speed, in 10\u{2076}", 2), ("time", 1)] {
        assert_eq!(svg.lines().filter(|line| *line == name).count(), count, "{name}");
    }
    let longest = svg.lines().filter(|it| it.parse::<f64>().is_ok()).map(str::len).max();
    assert!(longest.is_some_and(|it| it <= 4), "{longest:?}");
}

/// The folder of the shuttle and its case, one of whose files is changed.
fn spoiled_folder(name: &str, change: impl Fn(Vec<u8>) -> Vec<u8>) -> tempfile::TempDir {
    let folder = shuttle_folder();
    let file = folder.path().join("cases").join(name);
    let bytes = std::fs::read(&file).expect("read");
    std::fs::write(&file, change(bytes)).expect("written");
    folder
}

fn replace(bytes: &[u8], from: &str, to: &str) -> Vec<u8> {
    let whole = text(bytes);
    assert!(whole.contains(from), "{from}");
    whole.replace(from, to).into_bytes()
}

#[test]
fn mistakes_in_cases_name_their_line_and_what_is_accepted() {
    let case = "there-and-back.toml";
    let wrong = [
        ("until = 8.0", "until = 1e400", vec![":6:", "1e400"]),
        ("until = 8.0", "until = \"8\"", vec![":6: until = \"8\"", "a number"]),
        ("until = 8.0", "until = 8.0\nsamples = 99999999999999999999", vec![":7:", "99999999999"]),
        (
            "until = 8.0",
            "until = 8.0\nsamples = 2.5",
            vec![":7: samples = 2.5", "an integer, 1 to"],
        ),
        ("[horizon]\nuntil = 8.0\n", "", vec![":4: [horizon] is missing", "[horizon] with"]),
    ];
    for (from, to, parts) in wrong {
        let folder = spoiled_folder(case, |bytes| replace(&bytes, from, to));
        let cases = path(folder.path(), "cases");
        refused(&["validate", "--cases", &cases], &[[case].as_slice(), &parts].concat());
    }
}

#[test]
fn bytes_that_are_no_utf8_have_their_line() {
    for (name, line) in [("there-and-back.toml", 7), ("shuttle.system.toml", 19)] {
        let folder = spoiled_folder(name, |bytes| [&bytes[..], b"# \xe9\n"].concat());
        let cases = path(folder.path(), "cases");
        let place = format!("{name}:{line}: the byte 0xe9 is not accepted: a text in UTF-8 is");
        refused(&["validate", "--cases", &cases], &[&place]);
        let file = path(folder.path(), &format!("cases/{name}"));
        if name.ends_with(".system.toml") {
            refused(&["events", &file, "--until", "1"], &[&place]);
        }
    }
}

#[test]
fn a_missing_start_names_the_last_line_and_what_it_holds() {
    let start = "[start]\nmode = \"free\"\nplace = 0\nspeed = 1\n";
    let folder = spoiled_folder("shuttle.system.toml", |bytes| replace(&bytes, start, ""));
    let accepted = "[start] is missing: accepted after this line, the last, is one with mode and \
                    the states place, speed";
    let cases = path(folder.path(), "cases");
    refused(&["validate", "--cases", &cases], &["there-and-back.toml:6: ", accepted]);
    let file = path(folder.path(), "cases/shuttle.system.toml");
    refused(&["events", &file, "--until", "1"], &["shuttle.system.toml:14: ", accepted, "--start"]);
}

#[test]
fn a_pattern_without_cases_names_those_of_the_folder() {
    let folder = shuttle_folder();
    let cases = path(folder.path(), "cases");
    let held = format!("matches no case: {cases} holds there-and-back");
    refused(&["validate", "--cases", &cases, "--case", "nosuch"], &["--case nosuch", &held]);
    refused(&["validate", "--case", "nosuch"], &["percuss cases lists all"]);
}

/// Three guards of which rounding cannot say which is crossed first.
const TIE: &str = "schema = 1
name = \"tie\"
states = [\"x\", \"y\"]
[[mode]]
name = \"go\"
equations = [\"x' = -x\", \"y' = -2*y\"]
[[mode.until]]
name = \"first\"
guard = \"x < 1\"
reset = [\"x = 2\"]
[[mode.until]]
name = \"second\"
guard = \"y < 1\"
reset = [\"y = 4\"]
[[mode.watch]]
name = \"third\"
guard = \"x + y < 2\"
[start]
mode = \"go\"
x = 2
y = 4
";

#[test]
fn guards_that_tie_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = path(folder.path(), "tie.system.toml");
    std::fs::write(&file, TIE).expect("written");
    let output = run(&["events", &file, "--until", "5"]);
    assert_eq!(output.status.code(), Some(1));
    let said = text(&output.stderr);
    let open = "came to about 0.693147, where rounding leaves open which of the guards of \"first\", \
                \"second\" and \"third\" crosses first";
    assert!(said.contains(open), "{said}");
    // Without a tie nothing is said of one.
    let alone = text(TIE.as_bytes()).replace("y < 1", "y < 1/8").replace("< 2", "< 1/8");
    std::fs::write(&file, alone).expect("written");
    assert!(!stdout(&["events", &file, "--until", "1"]).contains("undecided"));
}
