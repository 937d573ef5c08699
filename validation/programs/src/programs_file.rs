//! The file that names the programs: nothing foreign is started without one.

use percuss_engines::case::{FileError, Shortcoming, read_text, shortcomings_of};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::time::Duration;
use toml::Spanned;

/// The default time within which a program has to answer, in seconds.
const DEFAULT_TIMEOUT_SECONDS: f64 = 60.0;
/// The longest time that a file may give a program for an answer, in seconds.
const MAX_TIMEOUT_SECONDS: f64 = 86_400.0;
/// The accepted names of programs, set-ups and engines in files.
pub const ACCEPTED_NAMES: &str =
    "a name of 1 to 40 characters: lower-case letters, digits, '-', '_', '.', '+'";

/// A program that can be run as an engine, as its file names it.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The program's name, with which the names of its engines begin.
    pub name: String,
    /// The command that starts the program, with its arguments.
    pub command: Vec<String>,
    /// The time within which the program has to answer.
    pub timeout: Duration,
    /// The folder in which it is started, which is that of the file.
    pub folder: PathBuf,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Wire {
    shortcomings: Option<PathBuf>,
    #[serde(default)]
    program: Vec<Spanned<OneWire>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OneWire {
    name: Option<Spanned<String>>,
    command: Option<Spanned<Vec<String>>>,
    timeout_s: Option<Spanned<f64>>,
}

/// The programs that a file names; its form is in `docs/PROTOCOL.md`.
///
/// # Errors
/// The first mistake in the file, with its line and what is accepted.
pub fn read(path: &Path) -> Result<Vec<Program>, FileError> {
    let text = read_text(path)?;
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    parse(&path.display().to_string(), &text, folder)
}

/// The expected failures of the programs that a file names: those of the file that it names for
/// them, if it does.
///
/// # Errors
/// The first mistake in either file, with its line and what is accepted.
pub fn shortcomings(path: &Path) -> Result<Vec<Shortcoming>, FileError> {
    let text = read_text(path)?;
    let wire: Wire = toml::from_str(&text)
        .map_err(|error| FileError::toml(&path.display().to_string(), &text, &error))?;
    let beside = |file: PathBuf| path.parent().unwrap_or(Path::new("")).join(file);
    wire.shortcomings.map_or_else(|| Ok(Vec::new()), |file| shortcomings_of(&beside(file)))
}

fn parse(file: &str, text: &str, folder: &Path) -> Result<Vec<Program>, FileError> {
    let source = ProgramsFile { file, text };
    let wire: Wire = toml::from_str(text).map_err(|error| FileError::toml(file, text, &error))?;
    if wire.program.is_empty() {
        return Err(FileError::new(file, "names no program; accepted is a [[program]] or more"));
    }
    let mut programs: Vec<Program> = Vec::new();
    for one in wire.program {
        let begin = one.span().start;
        let program = source.program(begin, one.into_inner(), folder, &programs)?;
        programs.push(program);
    }
    Ok(programs)
}

struct ProgramsFile<'a> {
    file: &'a str,
    text: &'a str,
}

impl ProgramsFile<'_> {
    fn program(
        &self,
        begin: usize,
        wire: OneWire,
        folder: &Path,
        others: &[Program],
    ) -> Result<Program, FileError> {
        let missing = |key: &str, what: &str| {
            self.error(begin, &format!("{key} is missing; accepted is {what}"))
        };
        let name = wire.name.ok_or_else(|| missing("name", ACCEPTED_NAMES))?;
        let command =
            wire.command.ok_or_else(|| missing("command", "a list: a program, its arguments"))?;
        let name = self.name(&name, others)?;
        let command = self.command(command)?;
        let timeout = self.timeout(wire.timeout_s)?;
        Ok(Program { name, command, timeout, folder: folder.to_owned() })
    }

    fn name(&self, given: &Spanned<String>, others: &[Program]) -> Result<String, FileError> {
        let name = given.as_ref();
        let refused = |why: &str| {
            self.error(given.span().start, &format!("name {name:?} is not accepted: {why}"))
        };
        if !is_name(name) {
            return Err(refused(ACCEPTED_NAMES));
        }
        if others.iter().any(|other| other.name == *name) {
            return Err(refused("another program has it"));
        }
        Ok(name.clone())
    }

    fn command(&self, given: Spanned<Vec<String>>) -> Result<Vec<String>, FileError> {
        let begin = given.span().start;
        let command = given.into_inner();
        let has_zero = command.iter().any(|word| word.contains('\0'));
        if command.first().is_none_or(String::is_empty) || has_zero {
            let what = "command is not accepted: a list that begins with a program, without zeros";
            return Err(self.error(begin, what));
        }
        Ok(command)
    }

    fn timeout(&self, given: Option<Spanned<f64>>) -> Result<Duration, FileError> {
        let Some(given) = given else {
            return Ok(Duration::from_secs_f64(DEFAULT_TIMEOUT_SECONDS));
        };
        let seconds = *given.as_ref();
        if !(0.001..=MAX_TIMEOUT_SECONDS).contains(&seconds) {
            let what = format!(
                "timeout_s = {seconds} is not accepted: 0.001 to {MAX_TIMEOUT_SECONDS} seconds"
            );
            return Err(self.error(given.span().start, &what));
        }
        Ok(Duration::from_secs_f64(seconds))
    }

    fn error(&self, offset: usize, what: &str) -> FileError {
        let before = self.text.bytes().take(offset);
        let line = 1 + before.filter(|byte| *byte == b'\n').count();
        FileError::new(&format!("{}:{line}", self.file), what)
    }
}

/// Whether a program or a set-up may be called so.
#[must_use]
pub fn is_name(name: &str) -> bool {
    let is_accepted = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-_.+".contains(c);
    (1..=40).contains(&name.len()) && name.chars().all(is_accepted)
}

#[cfg(test)]
#[path = "programs_file_tests.rs"]
mod tests;
