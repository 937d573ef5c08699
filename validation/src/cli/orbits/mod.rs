//! Verbs of periodic orbits: `orbit` finds one, `continue` follows it.

pub(super) mod find;
pub(super) mod follow;
mod json;

use super::output::Destination;
use anyhow::{Result, bail};
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::path::Path;

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    Json,
}

/// Refuses an extension that is no format.
fn check_extension(output: Option<&Path>, stated: Option<Format>) -> Result<()> {
    let extension = output.and_then(Path::extension).and_then(|extension| extension.to_str());
    let special = output.is_some_and(|path| path.exists() && !path.is_file());
    match extension {
        Some(extension) if extension != "json" && stated.is_none() && !special => {
            bail!("--output: extension {extension} is not accepted: json, or --format")
        }
        _ => Ok(()),
    }
}

fn write(output: Option<&Path>, value: &impl Serialize) -> Result<()> {
    Destination::new(output).write(|out| {
        serde_json::to_writer_pretty(&mut *out, value).map_err(std::io::Error::from)?;
        Ok(writeln!(out)?)
    })
}

/// A bar on stderr for a share of 0 to 1; nothing where that is no terminal.
fn progress() -> ProgressBar {
    const PARTS: u64 = 1000;
    let bar = ProgressBar::new(PARTS);
    match ProgressStyle::with_template("{bar:40} {percent} %, {eta} to go") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Where the bar stands at a share.
fn place(bar: &ProgressBar, share: f64) {
    bar.set_position((share * 1000.0) as u64);
}

/// A period as it is accepted.
fn period(text: &str) -> Result<u32, String> {
    let largest = percuss::dynamics::orbit::LARGEST_PERIOD;
    let period = text.parse().ok().filter(|period| (1..=largest).contains(period));
    period.ok_or_else(|| format!("accepted is an integer, 1 to {largest}"))
}
