//! The verb `gradient`: closed forms, differences of runs that know nothing of it, refusals, and
//! the page docs/GRADIENTS.md.
//!
//! `PERCUSS_SPLICE=1 cargo test --test harness gradient::` writes the page's examples anew.

mod differences;

use crate::support::{number, refused, rows, run, stdout, text, transcripts};

/// The rows of a name, as numbers from the time's derivative on; no row is empty.
fn cells(words: &[&str], name: &str) -> Vec<Vec<f64>> {
    let all = rows(&stdout(&[&["gradient"], words, &["--wrt", name]].concat()));
    all.iter().map(|row| row[5..].iter().map(|it| number(it)).collect()).collect()
}

/// A printed number of 17 digits is off by half a unit of its last place, and so is its f64.
fn is_near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 4.0 * f64::EPSILON * expected.abs()
}

/// The n-th impact comes at (2 v/g)(1 + e + ... + e^(n - 1)), and leaves the speed e^n v.
#[test]
fn a_bouncing_ball_has_its_derivatives_in_closed_form() {
    let (g, e, v) = (2.0_f64, 0.5_f64, 1.5_f64);
    let ball = ["bouncing-ball", "--events", "6"];
    let [by_g, by_e, by_v] = ["g", "e", "start.v"].map(|name| cells(&ball, name));
    assert_eq!([by_g.len(), by_e.len(), by_v.len()], [7, 7, 7]);
    for n in 0..=6_i32 {
        let flights: f64 = (0..n).map(|k| e.powi(k)).sum();
        let slope: f64 = (1..n).map(|k| f64::from(k) * e.powi(k - 1)).sum();
        let (time, row) = (2.0 * v / g * flights, n as usize);
        let speed_by_e = if n == 0 { 0.0 } else { f64::from(n) * e.powi(n - 1) * v };
        let expected = [
            (&by_g, [-time / g, 0.0, 0.0]),
            (&by_e, [2.0 * v / g * slope, 0.0, speed_by_e]),
            (&by_v, [time / v, 0.0, e.powi(n)]),
        ];
        for (found, expected) in expected {
            let pairs = || found[row].iter().zip(expected);
            assert!(pairs().all(|(a, b)| is_near(*a, b)), "{n}: {:?} {expected:?}", found[row]);
        }
    }
}

/// Between the first two impacts x = e v s - g s^2/2 with s = t - 2 v/g, and at a fixed time t the
/// derivative of s by g is 2 v/g^2.
#[test]
fn the_end_is_at_a_fixed_time() {
    let csv = stdout(&["gradient", "bouncing-ball", "--until", "2", "--wrt", "g"]);
    let last = rows(&csv).pop().expect("rows");
    assert_eq!(last[..6], ["2", "end", "flight", "g", "", "0"]);
    let (s, by_g) = (0.5, 0.75);
    let expected = [0.75 * by_g - 2.0 * s * by_g - s * s / 2.0, -s - 2.0 * by_g];
    assert_eq!([number(&last[6]), number(&last[7])], expected);
}

/// A relay whose output is its state: x' = -x + 1 up to d, then x' = -x - 1 down to -d, and so on.
/// From 0 the first switch comes after -ln(1 - d), each later one after ln((1 + d)/(1 - d)).
#[test]
fn a_relay_has_its_derivatives_in_closed_form() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("relay.system.toml");
    let text = r#"
schema = 1
name = "relay"
states = ["x"]
[parameters]
d = 0.25
[[mode]]
name = "up"
equations = ["x' = 1 - x"]
until = [{ name = "down", guard = "x > d", next = [{ mode = "down" }] }]
[[mode]]
name = "down"
equations = ["x' = -1 - x"]
until = [{ name = "up", guard = "x < -d", next = [{ mode = "up" }] }]
[start]
mode = "up"
x = 0
"#;
    std::fs::write(&path, text).expect("written");
    let path = path.to_str().expect("UTF-8");
    let found = cells(&[path, "--events", "4"], "d");
    let d = 0.25;
    for (n, row) in found.iter().enumerate().skip(1) {
        let time = 1.0 / (1.0 - d) + (n - 1) as f64 * 2.0 / (1.0 - d * d);
        let state = if n % 2 == 1 { 1.0 } else { -1.0 };
        assert!(is_near(row[0], time) && row[1] == state, "{n}: {row:?}");
    }
}

/// The second mode has the guard at which the first one ends, and ends at the same instant.
#[test]
fn an_event_at_once_on_entry_has_the_time_of_the_entry() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("at-once.system.toml");
    let text = r#"
schema = 1
name = "at-once"
states = ["x", "y"]
[parameters]
p = 3
[[mode]]
name = "first"
equations = ["x' = 2", "y' = 1"]
until = [{ name = "one", guard = "x > p", reset = ["y = p*y"], next = [{ mode = "second" }] }]
[[mode]]
name = "second"
equations = ["x' = 1", "y' = 0"]
until = [{ name = "two", guard = "x > p", reset = ["y = y + 5*p"], next = [{ mode = "last" }] }]
[[mode]]
name = "last"
equations = ["x' = 0", "y' = 0"]
[start]
mode = "first"
x = 0
y = 0
"#;
    std::fs::write(&path, text).expect("written");
    let path = path.to_str().expect("UTF-8");
    let found = cells(&[path, "--until", "9"], "p");
    // At p/2 the time is y, and y becomes p^2/2, then p^2/2 + 5 p.
    let expected = [[0.0; 3], [0.5, 1.0, 3.0], [0.5, 1.0, 8.0], [0.0, 1.0, 8.0]];
    assert_eq!(found, expected);
}

/// From the height g/2 a ball falls for the time 1, whatever g is, and arrives at the speed g.
#[test]
fn a_start_has_the_derivatives_of_its_expressions() {
    let found = cells(&["bouncing-ball", "--events", "1", "--at", "x=g/2", "--at", "v=0"], "g");
    assert_eq!(found[0], [0.0, 0.5, 0.0]);
    assert!(found[1][0].abs() < 1e-25 && found[1][1] == 0.0 && found[1][2] == 0.5, "{found:?}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("start.toml");
    std::fs::write(&path, "[start]\nmode = \"flight\"\nx = \"g/2\"\nv = 0\n").expect("written");
    let path = path.to_str().expect("UTF-8");
    assert_eq!(cells(&["bouncing-ball", "--events", "1", "--start", path], "g"), found);
}

/// The exit code, the rows and the messages of a run.
fn run_gradient(words: &[&str]) -> (Option<i32>, Vec<Vec<String>>, String) {
    let output = run(&[&["gradient"], words].concat());
    (output.status.code(), rows(&text(&output.stdout)), text(&output.stderr))
}

/// The first row without derivatives; all after it are empty, too, and none before it.
fn first_empty(rows: &[Vec<String>]) -> usize {
    let is_empty = |row: &Vec<String>| row[5..].iter().all(String::is_empty);
    let is_full = |row: &Vec<String>| row[5..].iter().all(|it| !it.is_empty());
    let first = rows.iter().position(is_empty).expect("a row without derivatives");
    assert!(rows[first..].iter().all(is_empty) && rows[..first].iter().all(is_full), "{rows:?}");
    first
}

/// The start is on the table: moved up the ball falls later, moved down it is nowhere. From the
/// height x it comes down after (v + sqrt(v^2 + 2 g x))/g, at the speed sqrt(v^2 + 2 g x).
#[test]
fn a_start_on_a_guard_has_the_derivatives_of_one_side() {
    let ball = ["bouncing-ball", "--events", "2", "--wrt"];
    let (code, rows, said) = run_gradient(&[&ball[..], &["start.x"]].concat());
    let places: Vec<_> = rows.iter().map(|it| (it[0].as_str(), it[4].as_str())).collect();
    assert_eq!(places, [("0", ""), ("1", "-"), ("1", "+"), ("2", "-"), ("2", "+")]);
    assert!(rows.iter().filter(|it| it[4] == "-").all(|it| it[5..].iter().all(String::is_empty)));
    let above: Vec<f64> = rows[2][5..].iter().map(|it| number(it)).collect();
    // 1/v, and e g/v of the speed.
    let expected = [1.0 / 1.5, 0.0, 1.0 / 1.5];
    assert!(above.iter().zip(expected).all(|(a, b)| is_near(*a, b)), "{above:?}");
    let wanted =
        "from row 1 on, no derivative by start.x below its value: the run has other events";
    assert!(said.contains(wanted) && said.lines().count() == 1 && code == Some(1), "{said}");
    // Other names keep theirs.
    let (code, rows, said) = run_gradient(&[&ball[..], &["start.x,g"]].concat());
    let by_g =
        rows.iter().filter(|it| it[3] == "g").all(|it| !it[5].is_empty() && it[4].is_empty());
    assert!(code == Some(1) && by_g && rows.len() == 8 && said.lines().count() == 1, "{said}");
}

/// A clock that starts where it strikes, at once; set back it strikes later by as much.
#[test]
fn an_event_at_once_has_the_derivatives_of_the_side_on_which_it_is_later() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("clock.system.toml");
    let text = r#"
schema = 1
name = "clock"
states = ["x", "y"]
[[mode]]
name = "on"
equations = ["x' = 2", "y' = 3"]
until = [{ name = "strike", guard = "x > 1", reset = ["x = x - 1"] }]
[start]
mode = "on"
x = 1
y = 0
"#;
    std::fs::write(&path, text).expect("written");
    let path = path.to_str().expect("UTF-8");
    let (code, rows, said) = run_gradient(&[path, "--until", "0.25", "--wrt", "start.x"]);
    let cells: Vec<_> = rows.iter().map(|it| it[4..].join(" ")).collect();
    // Just after it x is 0 and y is 3/2 (1 - x); at the end x = 1 - 1 + 1/2 moves with the start.
    let expected = [" 0 1 0", "- -0.5 0 -1.5", "+   ", "- 0 1 0", "+   "];
    let padded = |it: &String| {
        let cells =
            it.split(' ').map(|it| it.parse::<f64>().map_or(it.to_owned(), |it| it.to_string()));
        cells.collect::<Vec<_>>().join(" ")
    };
    assert_eq!(cells.iter().map(padded).collect::<Vec<_>>(), expected, "{said}");
    assert!(said.contains("by start.x above its value") && code == Some(1), "{said}");
}

#[test]
fn cells_are_empty_from_where_there_is_no_derivative() {
    // An impact at the end.
    let (code, rows, said) = run_gradient(&["bouncing-ball", "--until", "1.5", "--wrt", "g"]);
    assert_eq!((code, first_empty(&rows)), (Some(1), 2), "{said}");
    assert!(said.contains("from row 2 on") && said.contains("horizon"), "{said}");
    // What the run itself says comes with its own line, and keeps its exit code.
    let (code, rows, said) = run_gradient(&["bouncing-ball", "--until", "9", "--wrt", "g"]);
    assert_eq!((code, rows.last().map(|it| it[1].as_str())), (Some(0), Some("accumulation")));
    assert!(said.contains("infinitely many impacts accumulate"), "{said}");
    // The row of the ending has the time and the state of the last impact.
    let [.., impact, end] = &rows[..] else { panic!("rows") };
    assert_eq!(impact[5..], end[5..]);
}

#[test]
fn names_are_known_and_the_time_lies_ahead() {
    let accepted = "accepted are e, g, start.x, start.v";
    refused(
        &["gradient", "bouncing-ball", "--until", "1", "--wrt", "e,q"],
        &["--wrt e,q", "q is not known", accepted],
    );
    refused(
        &["gradient", "bouncing-ball", "--until", "-1", "--wrt", "e"],
        &["--until -1", "at or after the start at 0"],
    );
    refused(&["gradient", "bouncing-ball", "--until", "1"], &["--wrt"]);
}

#[test]
fn the_page_shows_what_is_printed() {
    let folder = tempfile::tempdir().expect("a folder");
    transcripts::hold(&transcripts::page("GRADIENTS.md"), folder.path(), "gradient::");
}
