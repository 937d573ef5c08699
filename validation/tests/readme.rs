//! README.md is short, its commands work, its figures are those of docs/RESULTS.md, and its picture
//! is what its command makes.
//!
//! `PERCUSS_SPLICE=1 cargo test --test harness readme::` writes the transcript, the figures and the
//! picture anew.

use crate::support::transcripts::{self, is_splicing, is_the_pages_platform};
use crate::support::{percuss, text};
use percuss_validation::case::embedded;
use percuss_validation::cli::command;
use percuss_validation::integrators::all;
use std::path::PathBuf;

const MAX_LINES: usize = 150;
/// The commands to copy end before this line.
const FIRST_SCREEN_LINES: usize = 40;
const BEGIN: &str = "<!-- begin: five set-ups -->\n";
const END: &str = "<!-- end: five set-ups -->";

fn page() -> PathBuf {
    transcripts::page("../README.md")
}

/// The commands `percuss ...` of the page's shell blocks, with the line that each is on.
fn commands(page: &str) -> Vec<(usize, Vec<String>)> {
    let mut in_shell = false;
    let mut found = Vec::new();
    for (n, line) in page.lines().enumerate() {
        if line.starts_with("```") {
            in_shell = line == "```sh";
        } else if in_shell && line.starts_with("percuss ") {
            let command = line.split(" #").next().unwrap_or_default();
            found.push((n + 1, transcripts::words(command)));
        }
    }
    found
}

#[test]
fn it_is_short_and_its_commands_come_first() {
    let readme = transcripts::read(&page());
    let lines = readme.lines().count();
    assert!(lines <= MAX_LINES, "{lines} lines");
    let commands = commands(&readme);
    assert!(commands.len() >= 3, "{commands:?}");
    for (line, words) in commands {
        assert!(line < FIRST_SCREEN_LINES, "{words:?} is on line {line}");
        let parsed = command().try_get_matches_from(&words);
        assert!(parsed.is_ok(), "{words:?}: {:?}", parsed.err());
        // All engines on all cases are a job of their own in CI.
        if words.len() > 2 {
            let arguments: Vec<&str> = words[1..].iter().map(String::as_str).collect();
            let output = percuss(&arguments).output().expect("it runs");
            assert!(output.status.success(), "{words:?}: {}", text(&output.stderr));
        }
    }
}

/// A row of the table with the figures of the same engine in the summary of all.
fn row(row: &str, summary: &str) -> String {
    let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
    let [engine, .., cause] = &cells[..] else { panic!("{row}") };
    let name = engine.trim_matches('`');
    let mut lines = summary.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let found = lines.find(|words| words.len() == 12 && words[1] == name);
    let found = found.unwrap_or_else(|| panic!("{name} is not in the summary"));
    let [_, _, judged, missed, spurious, ..] = &found[..] else { panic!("{found:?}") };
    let failing =
        summary.split_once(&format!("\n  {name}: ")).and_then(|it| it.1.split(' ').next());
    let fail = failing.unwrap_or("0");
    format!("| {engine} | {judged} | {missed} | {spurious} | {fail} | {cause} |\n")
}

/// The page with the figures of a summary in its table.
fn with_figures(page: &str, summary: &str) -> String {
    let (before, rest) = page.split_once(BEGIN).expect("a table");
    let (table, after) = rest.split_once(END).expect("it ends");
    let lines: Vec<&str> = table.lines().collect();
    let [heading, rule, rows @ ..] = &lines[..] else { panic!("{table}") };
    assert_eq!(rows.len(), 5, "{table}");
    let rows: String = rows.iter().map(|it| row(it, summary)).collect();
    format!("{before}{BEGIN}{heading}\n{rule}\n{rows}{END}{after}")
}

#[test]
fn its_figures_are_those_of_the_results_and_its_transcript_of_the_program() {
    let readme = transcripts::read(&page());
    let results = transcripts::read(&transcripts::page("RESULTS.md"));
    let (_, summary) = results.split_once("<!-- begin: details -->").expect("a summary");
    let (summary, _) = summary.split_once("<!-- end: details -->").expect("it ends");
    let whole = with_figures(&readme, summary);
    if is_splicing() {
        std::fs::write(page(), whole).expect("written");
    } else {
        assert!(readme == whole, "PERCUSS_SPLICE=1 cargo test --test harness readme::\n{whole}");
    }
    let exact = row("| `exact` | | | | | |", summary);
    let said = exact.split(" | ").nth(1).map(|checked| format!("is checked on {checked} events"));
    assert!(
        exact.contains(" | 0 | 0 | 0 | ") && readme.contains(&said.expect("events")),
        "{exact}"
    );
    let cases = embedded().expect("the cases are read").len();
    let of = format!(
        "Five of the {} engines that `percuss validate` runs on {cases} cases",
        all().len()
    );
    assert!(readme.contains(&of), "{of}");
    let folder = tempfile::tempdir().expect("a folder");
    transcripts::hold(&page(), folder.path(), "readme::");
}

#[test]
fn its_picture_is_what_its_command_makes() {
    let readme = transcripts::read(&page());
    let (_, caption) = readme.split_once("Made by `").expect("a command");
    let words = transcripts::words(caption.split('`').next().expect("it ends"));
    let folder = tempfile::tempdir().expect("a folder");
    let arguments: Vec<&str> = words[1..].iter().map(String::as_str).collect();
    percuss(&arguments).current_dir(folder.path()).output().expect("it runs");
    let made = folder.path().join("report/events/small-b__diffsol-tsit45__1e-6.svg");
    let made = std::fs::read(made).expect("the command makes it");
    let kept = transcripts::page("missed-contact.svg");
    if is_splicing() {
        std::fs::write(kept, made).expect("written");
    } else if is_the_pages_platform() {
        assert!(std::fs::read(kept).ok() == Some(made), "it is not as it is made");
    }
}
