//! `attractors` and `basins`: where the starts of a grid lead.

mod draw;
mod json;
mod npz;

use super::model::ModelFlags;
use super::output::Destination;
use super::{format, parse, work};
use crate::case::Problem;
use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use percuss::dynamics::attractor::{Basins, Grid, Window};
use percuss::dynamics::strobe::StrobeMap;
use std::path::PathBuf;

/// Attractors that a grid of starts reaches
#[derive(Args)]
pub(super) struct AttractorArguments {
    #[command(flatten)]
    grid: GridFlags,
    /// Where the JSON goes, - is stdout
    #[arg(long, value_name = "PATH")]
    output: Option<PathBuf>,
    #[command(flatten)]
    model: ModelFlags,
}

/// Basins of attraction: which start of a grid reaches which attractor
#[derive(Args)]
pub(super) struct BasinArguments {
    #[command(flatten)]
    grid: GridFlags,
    /// Where the labels go; its extension (npz, png) is its format
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Format where --output has no extension
    #[arg(long, value_enum)]
    format: Option<Format>,
    #[command(flatten)]
    model: ModelFlags,
}

/// Which starts, and how long they are followed.
#[derive(Args, Clone, Debug)]
struct GridFlags {
    /// Cells along p and along y; starts are their centres
    #[arg(long, value_name = "NXxNY", value_parser = parse::grid)]
    grid: [u32; 2],
    /// What the cells fill
    #[arg(long, value_name = "pmin,pmax,ymin,ymax", value_parser = parse::window, allow_hyphen_values = true)]
    window: Window,
    /// Forcing periods that a start is followed before it is examined; doubled up to three times where
    /// that does not settle it, and cut short as soon as it does
    #[arg(long, value_name = "M", value_parser = clap::value_parser!(u64).range(1..=MAX_TRANSIENT))]
    transient: u64,
}

/// What labels are written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Npz,
    Png,
}

/// The longest transient, in forcing periods: with its extensions fifteen times that.
const MAX_TRANSIENT: u64 = 10_000_000;

/// A surveyed grid.
struct Survey {
    problem: Problem,
    transient: u64,
    basins: Basins,
}

pub(super) fn attractors(arguments: &AttractorArguments, threads: Option<u16>) -> Result<()> {
    let survey = arguments.grid.survey(&arguments.model, threads)?;
    Destination::new(arguments.output.as_deref()).json(&json::Json::of(&survey))
}

pub(super) fn basins(arguments: &BasinArguments, threads: Option<u16>) -> Result<()> {
    let Some(output) = &arguments.output else {
        bail!("--output is missing: accepted is a file that ends in .npz or .png");
    };
    if output.as_os_str() == "-" {
        bail!(
            "--output - is not accepted: stdout is for the JSON; accepted is a file that ends in .npz or .png"
        );
    }
    let format = format::chosen(Some(output), arguments.format, Format::Npz)?;
    let survey = arguments.grid.survey(&arguments.model, threads)?;
    let json = json::Json::of(&survey);
    let bytes = match format {
        Format::Npz => npz::bytes(&survey, &json)?,
        Format::Png => draw::bytes(&survey)?,
    };
    Destination::new(Some(output)).write(|out| Ok(out.write_all(&bytes)?))?;
    Destination::Stdout.json(&json)
}

impl GridFlags {
    fn survey(&self, model: &ModelFlags, threads: Option<u16>) -> Result<Survey> {
        let problem = model.problem()?;
        let map = StrobeMap::new(problem.model, problem.entry.instant);
        let grid = Grid {
            window: self.window,
            columns: self.grid[0],
            rows: self.grid[1],
            q: problem.start.q.unwrap_or(0.0),
        };
        let bar = work::bar(grid.len() as u64, "starts");
        let seen = |count| bar.inc(count);
        let basins =
            work::pool(threads)?.install(|| Basins::of(&map, &grid, self.transient, &seen));
        bar.finish_and_clear();
        Ok(Survey { problem, transient: self.transient, basins })
    }
}
