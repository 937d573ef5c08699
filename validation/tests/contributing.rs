//! The transcripts of CONTRIBUTING.md, done as they say.

use crate::support::{percuss, text};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// What stands under a heading of CONTRIBUTING.md.
fn section(heading: &str) -> String {
    let page = read("CONTRIBUTING.md");
    let (_, rest) = page.split_once(&format!("## {heading}\n")).expect("the heading is there");
    rest.split("\n## ").next().unwrap_or_default().to_owned()
}

/// The fenced blocks, with the language that each is in.
fn blocks(section: &str) -> Vec<(String, String)> {
    let fenced = section.split("\n```").skip(1).step_by(2);
    let block = |text: &str| text.split_once('\n').map(|(a, b)| (a.to_owned(), format!("{b}\n")));
    fenced.filter_map(block).collect()
}

fn block(section: &str, language: &str) -> String {
    let own: Vec<_> = blocks(section).into_iter().filter(|it| it.0 == language).collect();
    assert_eq!(own.len(), 1, "one block in {language}");
    own.into_iter().map(|it| it.1).collect()
}

/// The words of a command, without quotation marks.
fn words(command: &str) -> Vec<String> {
    command.split_whitespace().map(|word| word.trim_matches('\'').to_owned()).collect()
}

/// The commands of a transcript, with what each prints.
fn console(section: &str) -> Vec<(String, String)> {
    let mut done: Vec<(String, String)> = Vec::new();
    for line in block(section, "console").lines() {
        match (line.strip_prefix("$ "), done.last_mut()) {
            (Some(command), _) => done.push((command.to_owned(), String::new())),
            (None, Some((_, printed))) => *printed += &format!("{line}\n"),
            (None, None) => panic!("{line} comes before any command"),
        }
    }
    done
}

/// The last digits of an error are those of one platform's sine.
fn agree(printed: &str, shown: &str) {
    if cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        assert_eq!(printed, shown);
    }
}

#[test]
fn adding_a_case() {
    let section = section("Add a case");
    let case = block(&section, "toml");
    let path = case.lines().next().and_then(|line| line.strip_prefix("# ")).expect("a path");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(path);
    std::fs::create_dir_all(file.parent().expect("a parent")).expect("made");
    std::fs::write(&file, &case).expect("written");
    let commands = console(&section);
    assert!(!commands.is_empty());
    for (command, shown) in commands {
        let arguments = command.strip_prefix("cargo run --release -- ").expect("a run of percuss");
        let arguments = words(arguments);
        let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
        let output = percuss(&arguments).current_dir(folder.path()).output().expect("it runs");
        let (printed, said) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.code(), Some(0), "{command}: {printed}{said}");
        agree(&(said + &printed), &shown);
    }
}

/// Making the tables takes Python, which no test does; the scripts and flags that are named are
/// there.
#[test]
fn the_tables_of_a_case_are_made_as_is_said() {
    for line in block(&section("Add a case"), "sh").lines() {
        let words = words(line);
        match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
            ["cd", folder] => assert!(root().join(folder).is_dir(), "{folder}"),
            ["pip", "install", "-r", file] => {
                assert!(root().join("reference_data").join(file).is_file(), "{file}");
            }
            ["python", script, "--case", _] => {
                assert!(read(&format!("reference_data/{script}")).contains("\"--case\""));
            }
            ["python", script] => {
                assert!(root().join("reference_data").join(script).is_file(), "{script}");
            }
            _ => panic!("{line}: not known here"),
        }
    }
}

/// What its command prints is compared in the test `own_engine`, which runs it as a program of its
/// own.
#[test]
fn adding_an_engine() {
    let section = section("Add an engine");
    assert!(section.contains("(validation/examples/engine.rs)"), "{section}");
    let commands = console(&section);
    let [(command, _)] = &commands[..] else { panic!("one command: {commands:?}") };
    assert!(command.starts_with("cargo run --release -p percuss-validation --example engine -- "));
}
