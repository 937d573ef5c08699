//! Systems that go on after an accumulation, at the command line.

use crate::support::{rows, run, text};
use std::path::Path;

/// With v = 10, g = 10 and e = 1/2 the ball rests at 4, and is lifted where its table moves.
const BALL: &str = r#"
schema = 1
name = "ball-at-rest"
states = ["x", "v"]
parameters = { g = 10, e = 0.5 }
[[mode]]
name = "flight"
equations = ["x' = v", "v' = -g"]
[[mode.until]]
name = "impact"
guard = "x < 0"
reset = ["x = 0", "v = -e*v"]
accumulates_to = { reset = ["x = 0", "v = 0"], next = "rest" }
[[mode]]
name = "rest"
equations = ["x' = 0", "v' = 0"]
[start]
mode = "flight"
x = 0
v = 10
"#;

/// The exit code, the rows and the messages of a verb for a system's text.
fn verb(verb: &str, system: &str, flags: &[&str]) -> (Option<i32>, Vec<Vec<String>>, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ball.system.toml");
    std::fs::write(&path, system).expect("written");
    let path = path.to_str().expect("UTF-8");
    let output = run(&[&[verb, path], flags].concat());
    (output.status.code(), rows(&text(&output.stdout)), text(&output.stderr))
}

#[test]
fn events_and_simulate_have_a_row_for_the_limit_and_go_on() {
    for name in ["events", "simulate"] {
        let (code, rows, said) = verb(name, BALL, &["--until", "5"]);
        assert_eq!((code, said.as_str()), (Some(0), ""), "{name}");
        let [.., last, limit, end] = &rows[..] else { panic!("too few rows") };
        assert_eq!((last[2].as_str(), last[3].as_str()), ("impact", "flight"));
        assert_eq!((limit[2].as_str(), limit[3].as_str()), ("accumulation", "rest"));
        assert_eq!(limit[1].parse::<f64>(), Ok(4.0));
        assert_eq!((limit[4].as_str(), limit[5].as_str()), ("0", "0"));
        assert_eq!(end[2], "end");
        // The rows before it are those of a run that ends there.
        let short = BALL.replace("accumulates_to = {", "# {");
        let (code, ended, _) = verb(name, &short, &["--until", "5"]);
        assert_eq!(code, Some(0));
        assert_eq!(ended[..ended.len() - 1], rows[..rows.len() - 2]);
    }
}

#[test]
fn check_says_what_follows_a_limit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ball.system.toml");
    std::fs::write(&path, BALL).expect("written");
    let said = text(&run(&["check", path.to_str().expect("UTF-8")]).stdout);
    assert!(
        said.contains("    where it accumulates:\n    x = 0\n    v = 0\n    to rest\n"),
        "{said}"
    );
}

#[test]
fn gradient_stops_at_the_limit_and_says_so() {
    let (code, rows, said) = verb("gradient", BALL, &["--until", "5", "--wrt", "e"]);
    assert_eq!(code, Some(1));
    assert!(said.contains("accumulation of impacts"), "{said}");
    assert_eq!(rows.last().map(|it| it[5..].concat()), Some(String::new()));
}

#[test]
fn mistakes_are_named_with_their_line() {
    let table = "{ reset = [\"x = 0\", \"v = 0\"], next = \"rest\" }";
    for (wrong, expected) in [
        ("\"rset\"", "13: there is no mode \"rset\": accepted is one of flight, rest"),
        ("{ reset = [] }", "13: next is missing here"),
        ("{ next = \"rest\", modes = 1 }", "13: unknown field `modes`"),
        ("{ next = [], reset = [] }", "13: 0 successors are not accepted: 1 to 64 are"),
        ("{ next = [{ when = \"x > 0\", mode = \"rest\" }] }", "the last has none"),
        ("{ next = \"rest\", reset = [\"y = 0\"] }", "13: \"y\""),
        ("{ next = \"rest\", reset = [\"x = 0\", \"x = 1\"] }", "13: x is assigned twice"),
        ("5", "expected the name of a mode, or a table"),
    ] {
        let (code, _, said) = verb("events", &BALL.replace(table, wrong), &["--until", "5"]);
        assert_eq!(code, Some(2), "{wrong}: {said}");
        assert!(said.contains(expected), "{wrong}: {said}");
    }
}

#[test]
fn cases_refuse_the_key_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("written");
    };
    write("ball-at-rest.system.toml", BALL);
    write(
        "rests.toml",
        "[case]\nname = \"rests\"\nsystem = \"ball-at-rest\"\nwhy = \"It goes on.\"\n\
         [horizon]\nuntil = 5.0\n",
    );
    let cases = folder.path().to_str().expect("UTF-8");
    let out = folder.path().join("out");
    let flags = ["export", "--cases", cases, "--out", out.to_str().expect("UTF-8")];
    let output = run(&flags);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("until \"impact\": accumulates_to is not accepted in a case"), "{said}");
}

/// A cell as an integer of so many decimal places.
fn decimal(cell: &str, places: u32) -> i128 {
    let (number, exponent) = cell.split_once('e').unwrap_or((cell, "0"));
    let (whole, part) = number.split_once('.').unwrap_or((number, ""));
    let digits: i128 = format!("{whole}{part}").parse().expect("digits");
    let exponent: i32 = exponent.parse().expect("an exponent");
    let power = places as i32 + exponent - part.len() as i32;
    digits * 10_i128.pow(u32::try_from(power).expect("enough places"))
}

/// Whether a proved number of 25 digits rounds to a cell that may have fewer.
fn is_rounded(cell: &str, proved: &str) -> bool {
    /// Numbers of up to 99 have 36 places in 128 bits.
    const DECIMAL_PLACES: u32 = 36;
    let (number, exponent) = cell.split_once('e').unwrap_or((cell, "0"));
    let own = number.split_once('.').map_or(0, |(_, part)| part.len() as i32);
    let exponent: i32 = exponent.parse().expect("an exponent");
    let unit =
        10_i128.pow(u32::try_from(DECIMAL_PLACES as i32 + exponent - own).expect("enough places"));
    2 * (decimal(cell, DECIMAL_PLACES) - decimal(proved, DECIMAL_PLACES)).abs() <= unit
}

#[test]
fn proved_rows_are_met_through_limits() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference_data/limits");
    let systems = std::fs::read_dir(&folder).expect("the folder");
    let files = systems.map(|it| it.expect("an entry").file_name().into_string().expect("UTF-8"));
    let names: Vec<_> =
        files.filter_map(|it| Some(it.strip_suffix(".system.toml")?.to_owned())).collect();
    assert_eq!(names.len(), 6);
    for name in names {
        let system = folder.join(format!("{name}.system.toml"));
        let content = std::fs::read_to_string(&system).expect("a system");
        let until = content.lines().next().and_then(|it| it.strip_prefix("# until = "));
        let until = until.expect("the horizon");
        let proved = std::fs::read_to_string(folder.join(format!("{name}.csv"))).expect("rows");
        let proved = rows(&proved);
        assert!(proved.iter().any(|row| row[2] == "accumulation"));
        let path = system.to_str().expect("UTF-8");
        let found = run(&["events", path, "--until", until, "--digits", "25"]);
        let found = rows(&text(&found.stdout));
        assert_eq!(found.len(), proved.len(), "{name}");
        for (found, proved) in found.iter().zip(&proved) {
            assert_eq!((&found[2], &found[3]), (&proved[2], &proved[3]), "{name}");
            let cells = found[1..2].iter().chain(&found[4..]);
            for (cell, proved) in cells.zip(proved[1..2].iter().chain(&proved[4..])) {
                assert!(is_rounded(cell, proved), "{name}: {found:?} for {proved:?}");
            }
        }
    }
}
