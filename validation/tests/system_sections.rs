//! `poincare SYSTEM`: returns to sections, as tables, arrays and what is said of those that end.

use crate::support::{run, stdout, text};

/// The rows of a table, without its header.
fn rows(table: &str) -> Vec<Vec<String>> {
    let rows = table.lines().skip(1);
    rows.map(|row| row.split(',').map(str::to_owned).collect()).collect()
}

fn number(cell: &str) -> f64 {
    cell.parse().expect("a number")
}

/// The strobes of the paper's oscillator are those of its own verb: the one carries a phase by the
/// forcing's cycle, the other by the time, which is rounded to 1e-13 after 200 periods. The motion
/// settles on an orbit whose exponents are below -0.15 a period, so that no error grows.
#[test]
fn the_oscillators_section_is_that_of_its_own_verb() {
    let own = ["--xi", "0.5", "--omega", "1.4", "--transient", "200", "--periods", "6"];
    let own = stdout(&[&["poincare"][..], &own].concat());
    let system = ["percussive-oscillator", "--set", "xi=0.5", "--set", "frequency=1.4"];
    let counts = ["--transient", "200", "--returns", "6"];
    let as_system = stdout(&[&["poincare"][..], &system, &counts].concat());
    assert!(as_system.starts_with("n,time,mode,p,y,q,v\n"), "{as_system}");
    let (own, as_system) = (rows(&own), rows(&as_system));
    assert_eq!((own.len(), as_system.len()), (6, 6));
    for (own, row) in own.iter().zip(&as_system) {
        for (a, b) in own[1..].iter().zip(&row[3..]) {
            assert!((number(a) - number(b)).abs() < 1e-12, "{own:?} {row:?}");
        }
    }
}

/// A strobe at the start is the start itself, not what its modal co-ordinates make of it.
#[test]
fn a_strobe_at_the_start_is_the_start() {
    let first = ["percussive-oscillator", "--transient", "0", "--returns", "1"];
    let first = rows(&stdout(&[&["poincare"][..], &first].concat()));
    assert_eq!(first[0], ["0", "0", "no-contact", "0", "0", "0", "0"]);
}

#[test]
fn events_are_sections_in_a_mode_and_every_so_many() {
    let switches = |section: &str, more: &[&str]| {
        let words = ["poincare", "relay-feedback", "--transient", "4", "--section", section];
        rows(&stdout(&[&words[..], more].concat()))
    };
    let all = switches("switch-up", &["--returns", "6"]);
    assert!(all.iter().all(|row| row[2] == "up"), "{all:?}");
    let in_mode = switches("switch-up@down", &["--returns", "6"]);
    assert_eq!(all, in_mode);
    let every = rows(&stdout(&[
        "poincare",
        "relay-feedback",
        "--transient",
        "0",
        "--section",
        "switch-up",
        "--returns",
        "3",
        "--every",
        "3",
    ]));
    let each = rows(&stdout(&[
        "poincare",
        "relay-feedback",
        "--transient",
        "0",
        "--section",
        "switch-up",
        "--returns",
        "9",
    ]));
    let times: Vec<_> = each.iter().skip(2).step_by(3).map(|row| &row[1]).collect();
    assert_eq!(every.iter().map(|row| &row[1]).collect::<Vec<_>>(), times);
}

#[test]
fn a_motion_that_does_not_return_says_so() {
    let ball = ["poincare", "bouncing-ball", "--section", "impact", "--transient", "0"];
    let output = run(&[&ball[..], &["--returns", "1000"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("accumulation"), "{}", text(&output.stderr));
    assert!(rows(&text(&output.stdout)).len() > 20);
    let output = run(&[&ball[..], &["--returns", "3", "--max-time", "0.001"]].concat());
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stderr).contains("does not return"), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout).lines().count(), 1);
}
