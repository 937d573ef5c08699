//! Messages, colours, tables for people, completions and manual pages.

use crate::support::{percuss, run, stdout, text};
use percuss_validation::cli::command;

/// A run that ends early and says so.
const NOTED_COMMAND: [&str; 5] = ["simulate", "--events", "3", "--b", "-0.1"];

#[test]
fn quiet_says_nothing_but_errors() {
    let said = |arguments: &[&str]| text(&run(arguments).stderr);
    assert!(said(&NOTED_COMMAND).contains("never returns"));
    assert_eq!(said(&[&NOTED_COMMAND[..], &["--quiet"]].concat()), "");
    assert_eq!(said(&[&["--quiet"], &NOTED_COMMAND[..]].concat()), "");
    assert!(said(&["simulate", "--periods", "1", "--xi", "0", "--quiet"]).contains("--xi 0"));
    // Why the exit code is 1 is no note.
    let none = ["orbit", "--period", "2", "--b=-0.1", "--quiet"];
    assert!(said(&none).contains("no orbit"), "{}", said(&none));
    let loud = stdout(&["simulate", "--events", "3"]);
    assert_eq!(stdout(&["simulate", "--events", "3", "--quiet"]), loud);
}

#[test]
fn colours_are_as_asked() {
    const ESCAPE: char = '\u{1b}';
    let said = |arguments: &[&str], no_color: Option<&str>| {
        let mut command = percuss(arguments);
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").env_remove("CI");
        if let Some(value) = no_color {
            command.env("NO_COLOR", value);
        }
        let output = command.output().expect("it runs");
        text(&output.stdout) + &text(&output.stderr)
    };
    for usual in [&NOTED_COMMAND[..], &["--help"], &["simulate", "--xi", "0", "--periods", "1"]] {
        let with = |color: &'static str| [usual, &["--color", color]].concat();
        // These streams are no terminals.
        assert!(!said(usual, None).contains(ESCAPE), "{usual:?}");
        assert!(!said(&with("auto"), None).contains(ESCAPE), "{usual:?}");
        assert!(!said(&with("never"), None).contains(ESCAPE), "{usual:?}");
        assert!(said(&with("always"), None).contains(ESCAPE), "{usual:?}");
        // A flag is stronger than the environment.
        assert!(said(&with("always"), Some("1")).contains(ESCAPE), "{usual:?}");
        assert!(!said(&with("auto"), Some("1")).contains(ESCAPE), "{usual:?}");
    }
    let data = stdout(&["simulate", "--events", "3", "--color", "always"]);
    assert_eq!(data, stdout(&["simulate", "--events", "3"]));
}

/// The verbs that a user sees.
fn verbs() -> Vec<String> {
    command().get_subcommands().map(|it| it.get_name().to_owned()).collect()
}

#[test]
fn completions_know_every_verb() {
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = stdout(&["completions", shell]);
        for verb in verbs() {
            assert!(script.contains(&verb), "{shell}: {verb}");
        }
        for flag in ["max-periods", "quiet", "instructions"] {
            assert!(script.contains(flag), "{shell}: {flag}");
        }
    }
}

#[test]
fn a_manual_page_for_every_verb() {
    let folder = tempfile::tempdir().expect("a folder");
    let man = folder.path().join("man1");
    assert_eq!(stdout(&["man", "--out", &man.display().to_string()]), "");
    let page = |name: &str| std::fs::read_to_string(man.join(name)).expect("a page");
    assert!(page("percuss.1").contains(".TH percuss"));
    for verb in verbs() {
        let page = page(&format!("percuss-{verb}.1"));
        assert!(page.contains(".TH") && page.contains(&verb), "{verb}");
        assert!(page.contains("quiet"), "{verb}: the flags of all verbs are missing");
    }
    assert!(page("percuss-bench-compare.1").contains("slowdown"));
}

#[test]
fn attractors_as_a_table() {
    let grid = ["--grid", "12x12", "--window", "-3,1.2,-1.5,1.5", "--transient", "60"];
    let model = ["--xi", "0.1", "--omega", "1.6"];
    let usual = [&["attractors"], &grid[..], &model].concat();
    let json: serde_json::Value = serde_json::from_str(&stdout(&usual)).expect("JSON");
    let table = stdout(&[&usual[..], &["--format", "table"]].concat());
    let lines: Vec<&str> = table.lines().collect();
    let attractors = json["attractors"].as_array().expect("a list");
    assert_eq!(lines.len(), 2 + attractors.len(), "{table}");
    assert!(lines.iter().all(|line| line.chars().count() <= 100), "{table}");
    for (line, attractor) in lines[1..].iter().zip(attractors) {
        let words: Vec<&str> = line.split_whitespace().collect();
        assert_eq!(words[0], attractor["id"].to_string());
        assert_eq!(Some(words[1]), attractor["kind"].as_str());
        let share = 100.0 * attractor["fraction"].as_f64().expect("a share");
        assert!(line.contains(&format!("{share:.2}")), "{line}");
    }
    // `basins` says the same of the same starts.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("b.npz").display().to_string();
    let basins = [&["basins"], &grid[..], &model, &["--output", &file]].concat();
    assert_eq!(stdout(&[&basins[..], &["--format", "table"]].concat()), table);
    assert_eq!(stdout(&[&basins[..], &["--format", "npz", "--format", "table"]].concat()), table);
    let shown: serde_json::Value = serde_json::from_str(&stdout(&basins)).expect("JSON");
    assert_eq!(shown, json);
}

/// Starts that escape have a line too; their id is that of the JSON.
#[test]
fn what_escapes_is_in_the_table() {
    let grid = ["--grid", "2x2", "--window", "-1,1,-1,1", "--transient", "5", "--b=-0.1"];
    let table = stdout(&[&["attractors"], &grid[..], &["--format", "table"]].concat());
    assert!(table.contains("-2  escaping"), "{table}");
    assert!(table.ends_with("2 x 2 starts, 0.00 % unresolved\n"), "{table}");
}

/// One of several patterns that selects nothing is said, and the others count.
#[test]
fn a_pattern_without_a_match_is_noted() {
    let usual = ["validate", "-e", "^exact$", "-c", "^small-b$"];
    let output = run(&[&usual[..], &["-c", "grase-miss"]].concat());
    assert_eq!(output.status.code(), Some(0));
    let said = text(&output.stderr);
    assert!(said.contains("--case grase-miss matches no case") && said.contains("graze-miss-1e-3"));
    assert_eq!(text(&output.stdout), stdout(&usual));
}
