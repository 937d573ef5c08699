//! `bench history`: the history as a picture.

use super::super::help;
use crate::bench::history::{self, History};
use crate::bench::history_picture;
use crate::cli::shared::format::OutputFlags;
use crate::picture::{png, svg};
use anyhow::{Result, anyhow, bail};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Draw the history of the recorded versions
#[derive(Args)]
#[command(after_long_help = help::BENCH_HISTORY)]
pub(in super::super) struct Arguments {
    /// The history
    #[arg(long, value_name = "FILE", default_value = history::FILE)]
    history: PathBuf,
    #[command(flatten)]
    output: OutputFlags<Format>,
}

/// The picture's format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in super::super) enum Format {
    Png,
    Svg,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let format = arguments.output.format(Format::Svg)?;
    let history = History::read(&arguments.history).map_err(|what| anyhow!("--history {what}"))?;
    if history.records.is_empty() {
        bail!("--history {} holds no record: bench record makes one", arguments.history.display());
    }
    let picture = history_picture(&history);
    let bytes = match format {
        Format::Png => png(&picture)?,
        Format::Svg => svg(&picture).into_bytes(),
    };
    arguments.output.destination().write(|out| Ok(out.write_all(&bytes)?))
}
