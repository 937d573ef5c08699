//! What the tests of the command share.

pub mod synthetic;
pub mod transcripts;

use assert_cmd::Command;
use std::process::Output;

pub fn percuss(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("percuss").expect("the binary is built");
    command.args(arguments);
    command
}

pub fn run(arguments: &[&str]) -> Output {
    percuss(arguments).output().expect("the binary runs")
}

/// stdout of a run that succeeds and says nothing else.
pub fn stdout(arguments: &[&str]) -> String {
    let output = run(arguments);
    let said = text(&output.stderr);
    assert!(
        output.status.success() && said.is_empty(),
        "{arguments:?}: {:?} {said}",
        output.status
    );
    text(&output.stdout)
}

/// What a program has printed, but for lines on its progress, which hang on the machine's speed.
pub fn text(bytes: &[u8]) -> String {
    let text = String::from_utf8(bytes.to_vec()).expect("UTF-8");
    text.split_inclusive('\n').filter(|line| !line.starts_with("percuss: so far ")).collect()
}

/// Exit 2, nothing on stdout, and one line on stderr that holds all of `wanted`.
pub fn refused(arguments: &[&str], wanted: &[&str]) {
    let output = run(arguments);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    assert_eq!(said.lines().count(), 1, "{arguments:?}: {said}");
    assert!(said.starts_with("percuss: "), "{arguments:?}: {said}");
    assert!(output.stdout.is_empty(), "{arguments:?} wrote to stdout");
    for part in wanted {
        assert!(said.contains(part), "{arguments:?}: {part:?} is not in {said}");
    }
}

/// The rows of a CSV without its header.
pub fn rows(csv: &str) -> Vec<Vec<String>> {
    csv.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

pub fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("{text:?} is no number"))
}
