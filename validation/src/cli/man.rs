//! `man`: the manual, a page a verb.

use super::command;
use super::help;
use super::shared::output::{make_folder, write_whole};
use anyhow::{Context, Result};
use clap::{Args, Command};
use clap_mangen::Man;
use std::path::{Path, PathBuf};

/// Write the manual pages into a folder
///
/// Answers the same as --help, as pages for `man`: one per verb.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::MAN)]
pub(super) struct Arguments {
    /// The folder, as ~/.local/share/man/man1
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    make_folder(&arguments.out)?;
    let mut command = command().disable_help_subcommand(true);
    // Names of pages and the flags that all verbs share are known after this.
    command.build();
    write(&command, &arguments.out)
}

fn write(command: &Command, folder: &Path) -> Result<()> {
    let page = Man::new(command.clone());
    let path = folder.join(page.get_filename());
    write_whole(&path, |out| {
        let mut text = Vec::new();
        page.render(&mut text)?;
        Ok(out.write_all(&text)?)
    })
    .context("--out")?;
    command.get_subcommands().try_for_each(|verb| write(verb, folder))
}
