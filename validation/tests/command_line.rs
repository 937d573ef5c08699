//! docs/COMMAND_LINE.md has a section for every verb and no other, names every flag and no other,
//! and its examples print what they show.
//!
//! `PERCUSS_SPLICE=1 cargo test --test harness command_line::` writes the examples' output anew.

use crate::support::transcripts::{self, commands, words};
use clap::Command;
use percuss_validation::cli::command;
use std::collections::BTreeSet;
use std::path::PathBuf;

fn page() -> PathBuf {
    transcripts::page("COMMAND_LINE.md")
}

fn read() -> String {
    transcripts::read(&page())
}

/// The section of a verb: from its heading to the next.
fn section(page: &str, verb: &str) -> String {
    let heading = format!("\n## `{verb}`");
    let (_, rest) =
        page.split_once(&heading).unwrap_or_else(|| panic!("{verb} has no section of its own"));
    rest.split("\n## ").next().unwrap_or_default().to_owned()
}

/// The flags of a command and of its subcommands, with their leading hyphens.
fn flags(command: &Command) -> BTreeSet<String> {
    let own = command.get_arguments().filter_map(|it| it.get_long());
    let own = own.map(|long| format!("--{long}"));
    command.get_subcommands().flat_map(flags).chain(own).collect()
}

/// The words of a text that are flags.
fn named_flags(text: &str) -> BTreeSet<String> {
    let part = |c: char| !(c.is_ascii_alphanumeric() || c == '-');
    let is_flag = |word: &&str| {
        word.strip_prefix("--")
            .is_some_and(|name| name.starts_with(|c: char| c.is_ascii_lowercase()))
    };
    text.split(part).filter(is_flag).map(str::to_owned).collect()
}

#[test]
fn every_verb_has_a_section_and_no_other_has() {
    let page = read();
    let verbs: BTreeSet<String> =
        command().get_subcommands().map(|it| it.get_name().to_owned()).collect();
    let headings = page.lines().filter_map(|line| line.strip_prefix("## `"));
    let described: Vec<String> =
        headings.filter_map(|it| it.split('`').next()).map(str::to_owned).collect();
    assert_eq!(described.iter().cloned().collect::<BTreeSet<_>>(), verbs);
    assert_eq!(described.len(), verbs.len(), "a section each");
    for verb in verbs {
        let examples = commands(&section(&page, &verb));
        let own = examples.iter().filter(|it| words(it).get(1) == Some(&verb)).count();
        assert!(own >= 2, "{verb} has {own} examples");
    }
}

#[test]
fn flags_are_those_of_the_program() {
    let page = read();
    let mut command = command();
    command.build();
    let shared = flags(&Command::new("shared").args(command.get_arguments().cloned()));
    let model = command.find_subcommand("simulate").expect("a verb");
    let common = ["Model and start", "SYSTEM and its start", "Pictures"];
    let model = model
        .get_arguments()
        .filter(|it| it.get_help_heading().is_some_and(|heading| common.contains(&heading)));
    let model = flags(&Command::new("model").args(model.cloned()));
    let common = &page[..page.find("\n## `").expect("verbs follow")];
    for flag in shared.iter().chain(&model).filter(|it| *it != "--help" && *it != "--version") {
        assert!(common.contains(flag.as_str()), "{flag} is not described");
    }
    let all: BTreeSet<String> = flags(&command);
    // Building the command adds the verb `help`.
    for verb in command.get_subcommands().filter(|it| it.get_name() != "help") {
        let section = section(&page, verb.get_name());
        let own = flags(verb);
        let named = named_flags(&section);
        for flag in own.iter().filter(|it| !shared.contains(*it) && !model.contains(*it)) {
            assert!(named.contains(flag), "{} {flag} is not described", verb.get_name());
        }
        for flag in named {
            assert!(own.contains(&flag) || all.contains(&flag), "{} {flag}", verb.get_name());
        }
    }
}

/// The examples of a command's long help, without where a shell sends their output.
fn help_examples(command: &Command) -> Vec<String> {
    let help = command.get_after_long_help().map(ToString::to_string).unwrap_or_default();
    let whole = help.replace(" \\\n     ", "");
    let lines = whole.lines().filter_map(|line| line.strip_prefix("  percuss "));
    lines.map(|line| format!("percuss {}", line.split(" >").next().unwrap_or_default())).collect()
}

/// Every example parses, and one of each verb is run as an example of the page.
#[test]
fn the_help_of_every_verb_has_an_example_that_works() {
    let page = read();
    let shown: BTreeSet<String> = commands(&page)
        .iter()
        .map(|it| it.split(" >").next().unwrap_or_default().to_owned())
        .collect();
    for verb in command().get_subcommands() {
        let examples = help_examples(verb);
        assert!(examples.iter().any(|it| shown.contains(it)), "{}: {examples:?}", verb.get_name());
        // What answers `bench compare` is started by it alone.
        let inner: Vec<Vec<String>> = verb
            .get_subcommands()
            .filter(|it| it.get_name() != "worker")
            .map(help_examples)
            .collect();
        assert!(inner.iter().all(|it| !it.is_empty()), "{}: {inner:?}", verb.get_name());
        for example in inner.into_iter().flatten().chain(examples) {
            let parsed = command().try_get_matches_from(words(&example));
            assert!(parsed.is_ok(), "{example}: {:?}", parsed.err());
        }
    }
}

/// A terminal of 80 columns shows help as it is laid out, and a manual page, which is indented by
/// seven columns and fills its lines, keeps examples and words apart.
#[test]
fn help_fits_where_it_is_shown() {
    /// The columns of a terminal, which no line of the help exceeds.
    const TERMINAL_COLUMNS: usize = 80;
    /// The columns of the examples below the help, which manual pages indent.
    const EXAMPLE_COLUMNS: usize = 72;
    let widest = |text: String| text.lines().map(|line| line.chars().count()).max();
    for verb in command().get_subcommands() {
        let about = verb.get_long_about().map(ToString::to_string).unwrap_or_default();
        let after = verb.get_after_long_help().map(ToString::to_string).unwrap_or_default();
        let (_, answer) = about.split_once("\n\n").unwrap_or_default();
        assert!(widest(answer.to_owned()) <= Some(TERMINAL_COLUMNS), "{}", verb.get_name());
        assert!(widest(after) <= Some(EXAMPLE_COLUMNS), "{}", verb.get_name());
    }
}

/// The last digits are those of one platform's sine.
#[test]
fn examples_print_what_they_show() {
    let folder = tempfile::tempdir().expect("a folder");
    transcripts::hold(&page(), folder.path(), "command_line::");
}
