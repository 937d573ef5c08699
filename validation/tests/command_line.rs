//! docs/COMMAND_LINE.md has a section for every verb and no other, names every flag and no other,
//! and its examples print what they show.
//!
//! `PERCUSS_SPLICE=1 cargo test --test harness command_line::` writes the examples' output anew. A
//! line `...` stands for any number of lines; splicing keeps as many lines before and after it as
//! there are.

use crate::support::{percuss, text};
use clap::Command;
use percuss_validation::cli::command;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const GAP: &str = "...";

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/COMMAND_LINE.md")
}

fn read() -> String {
    std::fs::read_to_string(page()).expect("the page is there")
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
    let model = model.get_arguments().filter(|it| it.get_help_heading() == Some("Model and start"));
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

/// The commands of a text's transcripts.
fn commands(text: &str) -> Vec<String> {
    text.lines().filter_map(|line| line.strip_prefix("$ ")).map(str::to_owned).collect()
}

/// The words of a command as a shell has them; quotation marks are single ones.
fn words(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (i, part) in command.split('\'').enumerate() {
        if i % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

/// What a command prints in a folder: messages, then data. `> FILE` keeps the data.
fn printed(command: &str, folder: &Path, code: i32) -> String {
    let words = words(command);
    let (words, file) = match words.iter().position(|it| it == ">") {
        Some(end) => (&words[..end], words.get(end + 1)),
        None => (&words[..], None),
    };
    assert_eq!(words[0], "percuss", "{command}");
    let arguments: Vec<&str> = words[1..].iter().map(String::as_str).collect();
    let output = percuss(&arguments).current_dir(folder).output().expect("it runs");
    let (data, said) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(code), "{command}: {said}");
    match file {
        Some(file) => {
            std::fs::write(folder.join(file), data).expect("written");
            said
        }
        None => said + &data,
    }
}

/// What is printed with the gap that the shown text has.
fn with_gap(printed: &str, shown: &str) -> String {
    let shown: Vec<&str> = shown.lines().collect();
    let Some(gap) = shown.iter().position(|line| *line == GAP) else { return printed.to_owned() };
    let lines: Vec<&str> = printed.lines().collect();
    let after = shown.len() - gap - 1;
    assert!(lines.len() >= gap + after, "{printed} is too short for its gap");
    let tail = &lines[lines.len() - after..];
    let kept = [&lines[..gap], &[GAP], tail].concat();
    kept.join("\n") + "\n"
}

/// A transcript with today's output.
fn spliced(transcript: &str, folder: &Path, code: i32) -> String {
    let mut whole = String::new();
    let mut lines = transcript.lines().peekable();
    while let Some(line) = lines.next() {
        let command = line.strip_prefix("$ ").unwrap_or_else(|| panic!("{line} has no command"));
        let mut shown = String::new();
        while let Some(line) = lines.next_if(|it| !it.starts_with("$ ")) {
            shown += &format!("{line}\n");
        }
        whole += &format!("$ {command}\n{}", with_gap(&printed(command, folder, code), &shown));
    }
    whole
}

/// Every example is run, in the page's order and in one folder; a block of TOML or CSV whose first
/// line is the comment `# NAME` is written there. The last digits are those of one platform's sine.
#[test]
fn examples_print_what_they_show() {
    let folder = tempfile::tempdir().expect("a folder");
    let page_text = read();
    let parts = page_text.split("```").enumerate().map(|(i, part)| {
        let (language, block) = part.split_once('\n').unwrap_or((part, ""));
        match (i % 2 == 1, language) {
            (true, "console" | "console exit=1") => {
                let code = i32::from(language.ends_with('1'));
                format!("{language}\n{}", spliced(block, folder.path(), code))
            }
            (true, "toml" | "csv") => {
                write_file(folder.path(), block, language == "toml");
                part.to_owned()
            }
            _ => part.to_owned(),
        }
    });
    let whole = parts.collect::<Vec<_>>().join("```");
    if std::env::var_os("PERCUSS_SPLICE").is_some() {
        std::fs::write(page(), &whole).expect("written");
    } else if cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        assert!(
            page_text == whole,
            "PERCUSS_SPLICE=1 cargo test --test harness command_line:::\n{whole}"
        );
    }
}

/// A block whose first line is the comment `# NAME`, as a file; CSV has no comments.
fn write_file(folder: &Path, block: &str, with_name: bool) {
    let (line, rest) = block.split_once('\n').expect("a line");
    let name = line.strip_prefix("# ").expect("a name");
    let block = if with_name { block } else { rest };
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
    std::fs::write(path, block).expect("written");
}
