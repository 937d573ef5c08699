//! The scoreboard of a small report.

use crate::maintain::blocks::replaced;
use crate::maintain::scoreboard::board::Board;
use crate::maintain::scoreboard::{BLOCK, page};
use serde_json::{Value, json};

fn row(engine: &str, case: &str, trouble: &[&str], found: Option<[u64; 2]>) -> Value {
    json!({
        "case": case, "trouble": trouble, "engine": engine, "tolerance": 1e-6, "events_total": 10,
        "events_judged": found.map(|it| 10 + it[1]), "events_right": found.map(|it| it[0]),
        "events_undecidable": found.map(|_| 0), "events_spurious": found.map(|it| it[1]),
        "rhs_evaluations": 500, "wall_ns": 90_000, "own_ns": 40_000,
        "verdict": if found.is_some() { "pass" } else { "error" },
        "defect": {"sample": {"max": if found.is_some() { Some(0.5) } else { None }}},
    })
}

fn report(version: &str) -> Value {
    let engine = |name: &str| json!({"name": name, "library": "Lib", "version": version, "method": "m", "language": "C 17"});
    json!({
        "percuss": "0.1.0", "commit": null, "cpu": "a processor",
        "engines": [engine("lib-bdf-default"), engine("lib-bdf")],
        "results": [
            row("lib-bdf-default", "a", &["jump", "chatter"], Some([7, 2])),
            row("lib-bdf", "a", &["jump", "chatter"], Some([10, 0])),
            row("lib-bdf-default", "b", &[], None),
            row("lib-bdf", "b", &[], Some([9, 0])),
        ],
    })
}

fn board(reports: &[Value]) -> anyhow::Result<Board> {
    let read = |it: &Value| serde_json::from_value(it.clone()).expect("a report");
    Board::new(&reports.iter().map(read).collect::<Vec<_>>())
}

#[test]
fn a_default_stands_beside_its_expert() {
    let board = board(&[report("1.0")]).expect("a board");
    assert_eq!(board.kinds, ["chatter", "jump", "oscillator"]);
    let text = page::markdown(&board);
    for line in [
        "2 cases at 1e-6; percuss 0.1.0 at no commit, on a processor.\n",
        "| lib-bdf 1.0 | Lib | C 17 | 100 | 50! | 95 | 31 | 0 | 2 | 50 | 50 | 4.0 | 5.0 |\n",
        "| lib-bdf 1.0 | 100 / 58 | 100 / 58 | 90 / 0 |\n",
    ] {
        assert!(text.contains(line), "{line} is not in {text}");
    }
    let html = page::html(&board).expect("a page");
    assert!(html.contains("--share: 90%\">90<") && html.contains("--share: 0%\">0<"), "{html}");
    assert!(!html.contains("http://") && !html.contains("https://"), "it loads nothing");
}

/// What is not installed has nothing to compare.
#[test]
fn an_engine_that_is_not_installed_has_no_line() {
    let mut without = report("1.0");
    for at in [0, 2] {
        without["results"][at]["verdict"] = json!("unavailable");
    }
    let text = page::markdown(&board(&[without]).expect("a board"));
    assert!(text.contains("| lib-bdf 1.0 | Lib | C 17 | 100 | \u{2013} |"), "{text}");
}

/// The order is that of the ranking: no unexpected failure, then what is wholly right.
#[test]
fn a_line_with_an_unexpected_failure_stands_below() {
    let mut failing = report("1.0");
    failing["results"][3]["verdict"] = json!("fail");
    let mut poor = report("2.0");
    for at in [1, 3] {
        poor["results"][at]["verdict"] = json!("known");
    }
    let board = board(&[failing, poor]).expect("a board");
    let lines: Vec<_> = board.lines.iter().map(|it| it.version.as_str()).collect();
    assert_eq!(lines, ["2.0", "1.0"]);
}

#[test]
fn versions_stand_side_by_side_and_none_is_there_twice() {
    let both = board(&[report("1.0"), report("2.0")]).expect("a board");
    let lines: Vec<_> = both.lines.iter().map(|it| it.version.as_str()).collect();
    assert_eq!(lines, ["1.0", "2.0"]);
    let twice = board(&[report("1.0"), report("1.0")]);
    assert!(
        twice
            .is_err_and(|it| it.to_string() == "lib-bdf-default 1.0 has a in more than one report")
    );
}

#[test]
fn portions_of_other_cases_are_one_run() {
    let mut portion = report("1.0");
    portion["results"] = json!([row("lib-bdf", "c", &["jump"], Some([3, 0]))]);
    let both = board(&[report("1.0"), portion]).expect("a board");
    let text = page::markdown(&both);
    assert!(text.contains("3 cases at 1e-6;"), "{text}");
    // 22 of 30, and by default 7 of 22.
    assert!(text.contains("| lib-bdf 1.0 | Lib | C 17 | 100 | 50! | 73 | 31 | 0 | 2 |"), "{text}");
}

#[test]
fn the_block_takes_the_place_of_the_old_one() {
    let page = "a\n<!-- begin: scoreboard -->\nold\n<!-- end: scoreboard -->\nb\n";
    let new = replaced(page, BLOCK, "new\n").expect("spliced");
    assert_eq!(new, page.replace("old", "new"));
    assert!(replaced("no block", BLOCK, "new").is_err());
}
