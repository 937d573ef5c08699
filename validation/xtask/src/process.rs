//! Other programs (git, cargo, bash), started in the repository's folder.

use anyhow::{Context, Result, bail};
use std::path::PathBuf;
use std::process::{Command, ExitStatus};

/// The root of the repository.
pub struct Folder(PathBuf);

impl Folder {
    pub fn of_the_repository() -> Result<Self> {
        Ok(Self(PathBuf::from(
            Self(PathBuf::from(".")).output("git", &["rev-parse", "--show-toplevel"])?,
        )))
    }

    #[cfg(test)]
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self(path.into())
    }

    pub fn path(&self, relative: &str) -> PathBuf {
        self.0.join(relative)
    }

    pub fn read(&self, relative: &str) -> Result<String> {
        std::fs::read_to_string(self.path(relative)).with_context(|| relative.to_owned())
    }

    /// Runs a program, whose lines go to the terminal, and says how it ended.
    pub fn status(&self, program: &str, arguments: &[&str]) -> Result<ExitStatus> {
        println!("$ {}", command_line(program, arguments));
        let status = self.command(program, arguments).status();
        status.with_context(|| format!("{program} cannot be started"))
    }

    /// Runs a program, whose lines go to the terminal, and fails where the program does.
    pub fn run(&self, program: &str, arguments: &[&str]) -> Result<()> {
        let status = self.status(program, arguments)?;
        if !status.success() {
            bail!("`{}` ended with {status}", command_line(program, arguments));
        }
        Ok(())
    }

    /// What a program prints, without white space around it.
    pub fn output(&self, program: &str, arguments: &[&str]) -> Result<String> {
        let output = self.command(program, arguments).output();
        let output = output.with_context(|| format!("{program} cannot be started"))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            bail!(
                "`{}` ended with {}: {}",
                command_line(program, arguments),
                output.status,
                said.trim()
            );
        }
        Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    }

    /// Whether a program is there and succeeds; what it prints is dropped.
    pub fn succeeds(&self, program: &str, arguments: &[&str]) -> bool {
        self.command(program, arguments).output().is_ok_and(|output| output.status.success())
    }

    fn command(&self, program: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.args(arguments).current_dir(&self.0);
        command
    }
}

/// A command as one would type it; a text of several lines is cut after the first one.
fn command_line(program: &str, arguments: &[&str]) -> String {
    let first_line = |text: &&str| {
        let line = text.lines().next().unwrap_or_default().to_owned();
        if line.contains(' ') { format!("'{line}'") } else { line }
    };
    let words: Vec<String> = [program].iter().chain(arguments).map(first_line).collect();
    words.join(" ")
}
