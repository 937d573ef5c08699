//! `completions`: prints shell completion scripts.

use super::command;
use super::shared::output::Destination;
use anyhow::Result;
use clap::Args;
use clap_complete::{Shell, generate};

/// Print the completions of a shell
#[derive(Args)]
#[command(
    after_help = "Examples:\n  bash        percuss completions bash > ~/.local/share/bash-completion/completions/percuss\n  zsh         percuss completions zsh > ~/.zfunc/_percuss\n  fish        percuss completions fish > ~/.config/fish/completions/percuss.fish\n  powershell  percuss completions powershell >> $PROFILE"
)]
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
