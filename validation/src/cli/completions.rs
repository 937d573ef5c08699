//! `completions`: prints shell completion scripts.

use super::command;
use super::help;
use super::shared::output::Destination;
use anyhow::Result;
use clap::Args;
use clap_complete::{Shell, generate};

/// Print the completions of a shell
#[derive(Args)]
#[command(after_long_help = help::COMPLETIONS)]
pub(super) struct Arguments {
    /// The shell
    #[arg(value_name = "SHELL", value_enum)]
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let mut script = Vec::new();
    generate(arguments.shell, &mut command(), "percuss", &mut script);
    Destination::Stdout.write(|out| Ok(out.write_all(&script)?))
}
